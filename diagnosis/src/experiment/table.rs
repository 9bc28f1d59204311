//! The experiment as tables: in the style of the records, and as a profile for a `Road`.

use std::fmt::Write;

use crate::rig::Rig;

use super::excitation::Excitation;
use super::shape::{PROFILE, Shape};

/// Name of the table.
pub const TABLE: &str = "experiment.csv";

/// Each file's name and text: time and every input that a record has, in SI; and a profile where a `Road` reads one.
pub fn files(rig: &Rig, excitation: &Excitation, step: f64, duration: f64) -> Vec<(String, String)> {
    let count = (duration / step) as usize;
    let inputs = (0..rig.plant.inputs.len()).filter(|input| {
        let declared = &rig.plant.inputs[*input];
        rig.excitation(declared).is_some() && rig.rate_of(&declared.name).is_none()
    });
    let title = |input: usize| {
        let declared = &rig.plant.inputs[input];
        format!("{} [{}]", declared.name, declared.unit.symbol)
    };
    let columns: Vec<(String, Vec<f64>)> =
        inputs.map(|input| (title(input), excitation.signal(rig, input, step, count))).collect();
    let mut files = vec![(TABLE.to_owned(), table(step, &columns))];
    let profile = excitation.waves.iter().find(|wave| {
        let declared = &rig.plant.inputs[wave.input];
        let read = matches!(wave.shape, Shape::Triangle { .. } | Shape::Multisine { .. });
        read && declared.unit.symbol == "m" && declared.start == 0.0
    });
    if let Some(wave) = profile {
        let column = ("position [m]".to_owned(), excitation.signal(rig, wave.input, step, count));
        files.push((PROFILE.to_owned(), table(step, &[column])));
    }
    files
}

fn table(step: f64, columns: &[(String, Vec<f64>)]) -> String {
    let mut text = String::from("time [s]");
    for (title, _) in columns {
        let _ = write!(text, ",{title}");
    }
    text.push('\n');
    for sample in 0..columns.first().map_or(0, |(_, values)| values.len()) {
        let _ = write!(text, "{:.6}", sample as f64 * step);
        for (_, values) in columns {
            let _ = write!(text, ",{:.7e}", values[sample]);
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::excitation::Wave;

    #[test]
    fn a_table_has_every_input_and_a_road_its_profile() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let input = |name: &str| rig.plant.input(name).unwrap();
        let wave = |name: &str, shape| Wave { input: input(name), shape, amplitude: 0.01 };
        let triangle = wave("road.position", Shape::Triangle { frequency: 1.0 });
        let both = files(&rig, &Excitation { waves: vec![triangle] }, 0.25, 1.0);
        assert_eq!(both.iter().map(|(name, _)| &name[..]).collect::<Vec<_>>(), [TABLE, PROFILE]);
        let lines: Vec<&str> = both[0].1.lines().collect();
        assert_eq!(lines[0], "time [s],road.position [m],actuator.force [N]");
        assert_eq!((lines.len(), lines[2]), (5, "0.250000,1.0000000e-2,0.0000000e0"));
        assert!(both[1].1.starts_with("time [s],position [m]\n"));
        let force = wave("actuator.force", Shape::Triangle { frequency: 1.0 });
        assert_eq!(files(&rig, &Excitation { waves: vec![force] }, 0.25, 1.0).len(), 1);
    }
}
