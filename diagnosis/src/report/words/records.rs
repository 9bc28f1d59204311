//! What was read of a record, in words.

use super::digits;
use crate::report::findings::RecordRead;

/// What was read of a file: its size and rate; then a line each on the columns that are used, those that are not, those that
/// are left out, and the rest.
pub fn read(it: &RecordRead) -> (String, Vec<String>) {
    let size = format!("{} samples, {} s at {} Hz", it.samples, digits(it.seconds, 4), digits(it.rate, 5));
    let column = |column: &crate::report::findings::ColumnRead| {
        let unit = match (column.unit.as_str(), column.unit_assumed) {
            ("" | "1", _) => String::new(),
            (unit, true) => format!(" [{unit}, assumed]"),
            (unit, false) => format!(" [{unit}]"),
        };
        match column.signal == column.column {
            true => format!("{}{unit}", column.signal),
            false => format!("{} from {}{unit}", column.signal, column.column),
        }
    };
    let columns: Vec<String> = it.columns.iter().map(column).collect();
    let mut lines = vec![format!("used: {}", columns.join(", "))];
    if !it.unused.is_empty() {
        lines.push(format!("no signal of the rig: {}", it.unused.join(", ")));
    }
    lines.extend(it.left_out.iter().map(|text| format!("left out: {text}")));
    lines.extend(it.notes.iter().cloned());
    (size, lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::ColumnRead;

    #[test]
    fn every_column_has_its_place() {
        let column = |signal: &str, column: &str, unit: &str, unit_assumed| ColumnRead {
            signal: signal.into(),
            column: column.into(),
            unit: unit.into(),
            unit_assumed,
        };
        let record = RecordRead {
            record: "run.csv".into(),
            samples: 3001,
            seconds: 10.0,
            rate: 300.0,
            columns: vec![
                column("motion.position", "Weg", "mm", false),
                column("force", "force", "N", true),
                column("duty", "duty", "1", true),
            ],
            unused: vec!["Temp [degC]".into()],
            left_out: vec!["Remark: `Start` in line 2 is not a number".into()],
            notes: vec![],
        };
        let (size, lines) = read(&record);
        assert_eq!(size, "3001 samples, 10.00 s at 300.00 Hz");
        assert_eq!(
            lines,
            [
                "used: motion.position from Weg [mm], force [N, assumed], duty",
                "no signal of the rig: Temp [degC]",
                "left out: Remark: `Start` in line 2 is not a number",
            ]
        );
    }
}
