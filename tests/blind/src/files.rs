//! A case on disk: the data of a case in `data`, its truth in `sealed`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::case::{Generated, Plant, Truth};
use crate::score::{Score, score};

/// Where a report may be, below a case's folder.
const REPORTS: [&str; 3] = ["report.json", "report/report.json", "data/report.json"];

/// Writes a case's files and returns the folder.
///
/// # Errors
/// If that fails.
pub fn write(made: &Generated, below: &Path) -> Result<PathBuf, String> {
    let folder = below.join(&made.truth.case.name);
    let write = |path: PathBuf, text: String| {
        let parent = path.parent().unwrap_or(below);
        std::fs::create_dir_all(parent)
            .and_then(|()| std::fs::write(&path, text))
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))
    };
    for table in made.train.iter().chain(&made.test) {
        write(folder.join("data").join(format!("{}.csv", table.name)), table.csv())?;
    }
    write(folder.join("data/start.toml"), start(made))?;
    let truth = serde_json::to_string_pretty(&made.truth).map_err(|error| error.to_string())?;
    write(folder.join("sealed/truth.json"), truth)?;
    Ok(folder)
}

/// The parameter set that the model starts with, in the form of the project's own.
fn start(made: &Generated) -> String {
    let element = "element = { value = \"Strut\", source = \"start\" }\n";
    let (fmu, model, source, choice) = match made.truth.case.plant {
        // That the tyre cannot pull is for the diagnosis to find out.
        Plant::LinearQuarter | Plant::RegulatedQuarter | Plant::PublishedQuarter => (
            "BlindQuarterVehicle",
            "QuarterCar",
            "TUM",
            "tire.lift_off = { value = false, source = \"start\" }\n",
        ),
        Plant::StrutDyno => ("BlindStrutDyno", "ElementDyno", "TUM", element),
        Plant::MrDyno => ("BlindMrDyno", "ElementDyno", "start", element),
        Plant::ServoQuarter => ("BlindServoSuspension", "ServoSuspension", "Konieczny", ""),
        Plant::LinearDrive => ("BlindLinearDrive", "LinearDrive", "start", ""),
        Plant::GuidedMass => ("BlindGuidedMass", "LinearDrive", "start", ""),
        Plant::PumpDyno => ("BlindPumpActuator", "PumpHydraulicActuator", "Ajala", ""),
        Plant::PneumaticCylinder => ("BlindPneumaticCylinder", "PneumaticCylinder", "start", ""),
        Plant::SasRig => (
            "BlindSasRig",
            "SasRig",
            "Kogut",
            "spring.lever = { value = \"Printed\", source = \"start\" }\n\
             tire.lift_off = { value = false, source = \"start\" }\n",
        ),
    };
    let mut text = format!(
        "fmu = \"{fmu}\"\nmodel = \"{model}\"\ntitle = \"What is known of the rig\"\nsource = \"{source}\"\n\n[values]\n{choice}"
    );
    // The points of a characteristic stand in one list.
    for points in made.start.chunk_by(|one, other| one.table() == other.table()) {
        let mut values: Vec<String> = points.iter().map(|point| format!("{:?}", point.value)).collect();
        if points[0].name != points[0].table() {
            values = vec![format!("[{}]", values.join(", "))];
        }
        writeln!(
            text,
            "{} = {{ value = {}, unit = \"{}\", source = \"start\" }}",
            points[0].table(),
            values.concat(),
            points[0].unit
        )
        .expect("a string takes everything");
    }
    text
}

/// Judges the report in a case's folder.
///
/// # Errors
/// If there is no truth or no report, or they cannot be read.
pub fn judge(folder: &Path) -> Result<Score, String> {
    let read = |path: &Path| {
        std::fs::read_to_string(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))
    };
    let sealed = folder.join("sealed/truth.json");
    let truth: Truth = serde_json::from_str(&read(&sealed)?)
        .map_err(|error| format!("{} is not a truth: {error}", sealed.display()))?;
    let report =
        REPORTS.iter().map(|name| folder.join(name)).find(|path| path.exists()).ok_or_else(|| {
            format!("{} has no report: run the diagnosis and put its report.json there", folder.display())
        })?;
    score(&truth, &read(&report)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, Hidden};

    #[test]
    fn a_case_goes_to_disk_and_is_judged_there() {
        let case = Case { duration: 4.0, rate: 100.0, ..Case::standard("case", vec![Hidden::new("01")], 5) };
        let made = crate::generate(&case).unwrap();
        let below = tempfile::tempdir().unwrap();
        let folder = write(&made, below.path()).unwrap();
        let csv = std::fs::read_to_string(folder.join("data/train-multisine.csv")).unwrap();
        assert_eq!(csv.lines().count(), 402);
        assert!(judge(&folder).unwrap_err().contains("no report"));
        std::fs::write(folder.join("report.json"), r#"{"verdict": "no_effect"}"#).unwrap();
        assert_eq!(judge(&folder).unwrap().outcome, crate::score::Outcome::Missed);
        let truth = std::fs::read_to_string(folder.join("sealed/truth.json")).unwrap();
        let truth: Truth = serde_json::from_str(&truth).unwrap();
        assert_eq!((&truth.case, &truth.effects[0].id), (&case, &made.truth.effects[0].id));
    }

    #[test]
    fn a_pneumatic_cylinder_starts_with_what_no_drawing_tells() {
        let plant = Plant::PneumaticCylinder;
        let case = Case { duration: 4.0, plant, ..Case::standard("case", vec![], 5) };
        let text = start(&crate::generate(&case).unwrap());
        assert!(
            text.contains("model = \"PneumaticCylinder\"") && text.matches("value = ").count() == 3,
            "{text}"
        );
        assert!(text.contains("actuator.valve.conductance = { value = 1e-8, unit = \"m5/(N.s)\""), "{text}");
    }

    #[test]
    fn a_characteristic_is_a_list_in_the_set() {
        let case = Case { duration: 4.0, plant: Plant::PumpDyno, ..Case::standard("case", vec![], 5) };
        let text = start(&crate::generate(&case).unwrap());
        let list = "valve.compression.pressure_drop = { value = [-140000.0, -100000.0, -70000.0, -40000.0, 0.0, \
                    40000.0, 160000.0, 270000.0, 390000.0], unit = \"Pa\", source = \"start\" }\n";
        assert!(text.contains(list), "{text}");
        assert!(text.contains("pump.displacement = { value = 1.2e-5, unit = \"m3\""), "{text}");
        assert_eq!(text.matches("valve.").count(), 4);
    }
}
