//! The examples do what they say, from Python, from Rust and for a model of one's own.

use std::ffi::OsStr;
use std::fs;
use std::process::Command;

/// Runs a Python example; returns the numbers that it prints, and checks that it draws.
fn python_example(name: &str) -> Vec<f64> {
    let out = strut::target().join("tested-pictures");
    let script = format!("examples/{name}.py");
    let arguments = ["--fmus".as_ref(), strut::fmus().as_os_str(), "--out".as_ref(), out.as_os_str()];
    let text = strut::python(&script, arguments);
    let picture = fs::metadata(out.join(name).with_extension("png")).expect("it draws a picture");
    assert!(picture.len() > 10_000, "the picture is empty");
    numbers(&text)
}

/// Runs a Rust example that uses the `fmi` crate; returns what it prints.
fn rust_example<S: AsRef<OsStr>>(name: &str, arguments: impl IntoIterator<Item = S>) -> String {
    let mut master = Command::new(strut::program_with_fmi(name));
    master.current_dir(strut::root()).args(arguments);
    String::from_utf8_lossy(&strut::run(&mut master).stdout).into_owned()
}

/// The numbers of a text that have a decimal point.
fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().filter(|word| word.contains('.')).filter_map(|word| word.parse().ok()).collect()
}

/// Each of `some` is among `all`.
fn assert_contains(all: &[f64], some: &[f64]) {
    assert!(!some.is_empty(), "no numbers are printed");
    for number in some {
        assert!(all.contains(number), "{number} of {some:?} is not among {all:?}");
    }
}

#[test]
#[ignore = "compiles the fmi crate for minutes: `scripts/long-tests examples`"]
fn the_systems_from_python_and_from_rust_are_the_same() {
    let python = [python_example("quanser_lqr"), python_example("tum_active")].concat();
    let pictures = strut::target().join("tested-pictures");
    let rust = numbers(&rust_example("rust-master", [strut::fmus(), &pictures]));
    assert_contains(&python, &rust);
}

#[test]
#[ignore = "takes a minute: `scripts/long-tests examples`"]
fn the_best_force_on_a_bump_is_found_with_exact_jacobians() {
    let text = strut::python("examples/optimal_control.py", [strut::fmus().join("TumQuarterVehicle.fmu")]);
    let [planned, apart, found, without] = numbers(&text)[..] else { panic!("not four numbers: {text}") };
    assert!(apart < 1e-8, "{text}");
    // A trapezoidal rule of 5 ms is within a twentieth of the FMU's own integration.
    assert!((planned / found - 1.0).abs() < 0.05 && found < 0.75 * without, "{text}");
}

/// Ajala Fig. 8 on the FMUs; the bounds stand in `strut-physics`' own tests.
#[test]
#[ignore = "takes a minute: `scripts/long-tests examples`"]
fn the_car_rides_as_in_figure_8() {
    let table = python_example("full_car");
    let rows: Vec<&[f64]> = table.chunks_exact(3).collect();
    assert_eq!(rows.len(), 9, "heave, roll and pitch in three bands");
    for motion in rows.chunks_exact(3) {
        let [[low_soft, low_hard, low_active], [soft, hard, active], [high_soft, high_hard, high_active]] =
            [motion[0], motion[1], motion[2]].map(|row| [row[0], row[1], row[2]]);
        assert!(low_active < low_hard && low_hard < low_soft, "{motion:?}");
        assert!(active < soft && soft < hard, "{motion:?}");
        assert!(high_active < high_hard && high_soft < high_hard, "{motion:?}");
    }
}

#[test]
fn a_model_of_ones_own_becomes_an_fmu_by_one_command() {
    let source = fs::read_to_string(strut::root().join("examples/own-model/src/lib.rs")).expect("it exists");
    assert!(source.lines().count() <= 40, "README says that 40 lines are enough");
    let out = strut::target().join("tested-own-model");
    let manifest = strut::root().join("examples/own-model/Cargo.toml");
    let build_fmu = || {
        let mut command = strut::build_fmu();
        // What it depends on is compiled there already.
        command.env("CARGO_TARGET_DIR", strut::target());
        command
    };
    let mut build = build_fmu();
    build.args(["--fmi", "2", "--fmi", "3", "--manifest-path"]).arg(&manifest).arg("--out").arg(&out);
    strut::run(&mut build);
    let told = |command: &[&str]| {
        let output = strut::run(build_fmu().args(command).arg("--manifest-path").arg(&manifest));
        // Whatever the lines are wrapped at.
        String::from_utf8_lossy(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(told(&["list"]).contains("AirSpring"));
    assert!(
        told(&["describe", "AirSpring"]).contains("Rate at which the throttle lets the pressure even out")
    );
    for check in ["validate", "starts", "rewind", "directional", "model_exchange"] {
        let output = strut::python("tests/masters/fmpy_checks.py", [check.as_ref(), out.as_os_str()]);
        assert_eq!(output.trim(), format!("{check}: AirSpring"));
    }
    for check in ["validate", "same_bits", "derivatives"] {
        let output = strut::python("tests/masters/fmi3_checks.py", [check.as_ref(), out.as_os_str()]);
        assert_eq!(output.trim(), format!("{check}: AirSpring"));
    }
}

/// The page of published numbers is what its command makes; a number that does not come out, or a claim that does not
/// hold, is an error of the command.
#[test]
#[ignore = "takes a minute: `scripts/long-tests examples`"]
fn the_reproduction_page_can_be_made_again() {
    let out = strut::target().join("tested-reproduction");
    let arguments = ["--fmus".as_ref(), strut::fmus().as_os_str(), "--out".as_ref(), out.as_os_str()];
    strut::python("examples/reproduction/reproduce.py", arguments);
    let page =
        |folder: &std::path::Path| fs::read_to_string(folder.join("README.md")).expect("there is a page");
    assert_eq!(page(&out), page(&strut::root().join("examples/reproduction")), "make the page again");
}

/// The page is what its command makes, but for the times; a method that is not within 1 % where it has to be is an error
/// of the command. Python and Rust come to the same errors and take the same number of steps.
#[test]
#[ignore = "compiles the fmi crate for minutes: `scripts/long-tests examples`"]
fn coupled_hard_the_methods_do_what_the_page_says() {
    let out = strut::target().join("tested-hard-coupling");
    let arguments = ["--fmus".as_ref(), strut::fmus().as_os_str(), "--out".as_ref(), out.as_os_str()];
    let python = strut::python("examples/hard-coupling/hard_coupling.py", arguments);
    let page = |folder: &std::path::Path| {
        let text = fs::read_to_string(folder.join("README.md")).expect("there is a page");
        let (before, rest) = text.split_once("<!-- times -->").expect("it has times");
        let (_, after) = rest.split_once("<!-- end of times -->").expect("they end");
        [before, after].concat()
    };
    assert_eq!(page(&out), page(&strut::root().join("examples/hard-coupling")), "make the page again");

    let rust = rust_example("hard-coupling", [strut::fmus()]);
    let python: Vec<&str> = python.lines().filter(|line| line.contains('|')).collect();
    assert_eq!(rust.lines().count(), python.len());
    for (ours, theirs) in rust.lines().zip(python) {
        for (index, (ours_cell, theirs_cell)) in ours.split('|').zip(theirs.split('|')).enumerate() {
            // Name, step, three errors in percent, steps; Python goes on with other calls.
            match (index, ours_cell.parse::<f64>(), theirs_cell.parse::<f64>()) {
                (2.., Ok(own), Ok(other)) => {
                    assert!((own - other).abs() < 1e-4 + 1e-2 * own, "{ours}\n{theirs}");
                }
                _ => assert_eq!(ours_cell, theirs_cell, "{ours}\n{theirs}"),
            }
        }
    }
}

/// The page shows every system that there is, and the numbers of its pictures come out again.
#[test]
fn the_gallery_shows_what_the_systems_do() {
    let arguments = ["--check".as_ref(), "1".as_ref(), "--fmus".as_ref(), strut::fmus().as_os_str()];
    print!("{}", strut::python("examples/gallery/gallery.py", arguments));
}

#[test]
#[ignore = "takes a minute: `scripts/long-tests examples`"]
fn the_notebook_runs_from_top_to_bottom() {
    let notebook = strut::root().join("examples/notebook/strut.ipynb");
    let out = strut::target().join("tested-pictures/strut.ipynb");
    let fmus = format!("STRUT_FMUS={}", strut::fmus().display());
    let diagnose = format!("STRUT_DIAGNOSE={}", strut::program("diagnose").display());
    let arguments = [notebook.as_os_str(), out.as_os_str(), fmus.as_ref(), diagnose.as_ref()];
    let text = strut::python("tests/masters/notebook.py", arguments);
    for part in
        ["actuator.force", "rig.body.position", "IDENTIFIED: The model lacks Coulomb friction in the strut."]
    {
        assert!(text.contains(part), "{part:?} is missing in\n{text}");
    }
}

#[test]
fn the_benchmark_prints_a_row_of_numbers() {
    let fmu = strut::fmus().join("TumQuarterVehicle.fmu");
    let fmu = fmu.to_str().expect("the folder's name is text");
    let text = strut::python("examples/benchmark/benchmark.py", [fmu, "--steps", "20", "--runs", "1"]);
    let row: Vec<&str> = text.lines().last().unwrap_or_default().split('|').map(str::trim).collect();
    assert_eq!(row[1], "TumQuarterVehicle", "{text}");
    let nanoseconds: f64 = row[7].parse().unwrap_or_else(|_| panic!("no time: {text}"));
    assert!(nanoseconds > 0.0, "{text}");
}

/// The script compares the outputs of both versions.
#[test]
fn a_step_of_fmi_3_leads_where_one_of_fmi_2_does() {
    let fmus = strut::fmus().to_str().expect("the folder's name is text");
    let text = strut::python("examples/benchmark/versions.py", [fmus, "QuarterCar", "KogutMrRotaryBrake"]);
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split('|').map(str::trim).collect()).collect();
    assert_eq!((rows.len(), rows[2][1], rows[3][1]), (4, "QuarterCar", "KogutMrRotaryBrake"), "{text}");
    for row in &rows[2..] {
        assert!(row[2].parse::<f64>().is_ok_and(|nanoseconds| nanoseconds > 0.0), "{text}");
    }
}

/// Both ways have the same information on every parameter, and one of them is by far cheaper; by how much, the
/// benchmark's own page tells.
#[test]
fn an_iteration_of_a_diagnosis_beside_differences_of_simulations() {
    let fmu = strut::fmus().join("TumQuarterVehicle.fmu");
    let fmu = fmu.to_str().expect("the folder's name is text");
    let linearise = strut::program("examples/linearise");
    let linearise = linearise.to_str().expect("the folder's name is text");
    let short = [fmu, "--seconds", "2", "--linearise", linearise, "--only-iteration"];
    let text = strut::python("examples/benchmark/diagnosis.py", short);
    let row =
        text.lines().find(|line| line.contains("bare calls")).unwrap_or_else(|| panic!("no row: {text}"));
    let cells: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    let [_, ratio, differs] = cells[..] else { panic!("not three numbers: {text}") };
    assert!(differs < 1e-3, "{text}");
    assert!(ratio > 10.0, "{text}");
}

/// From an empty folder to an FMU and the diagnosis of two records, as the command says.
#[test]
fn a_new_crate_agrees_with_scipy_becomes_an_fmu_and_finds_what_its_records_hide() {
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("my-rig");
    let command = |arguments: &[&str]| {
        let mut command = Command::new(strut::program("strut"));
        command.args(arguments).current_dir(&made).env("CARGO_TARGET_DIR", strut::target());
        String::from_utf8_lossy(&strut::run(&mut command).stdout).into_owned()
    };
    let mut new = Command::new(strut::program("strut"));
    strut::run(new.arg("new").arg(&made).arg("--path").arg(strut::root()));
    // In the workspace's versions, profile and target folder nearly all that it depends on is compiled already.
    fs::copy(strut::root().join("Cargo.lock"), made.join("Cargo.lock")).unwrap();
    let test = || {
        let mut command = strut::cargo();
        command.args(["test", "--release"]).current_dir(&made).env("CARGO_TARGET_DIR", strut::target());
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.success(), text(&output.stdout) + &text(&output.stderr))
    };
    let (passed, said) = test();
    assert!(passed && said.contains("the_default_experiment_agrees_with_scipy ... ok"), "{said}");
    // Another stiffness in the model alone is found.
    let source = made.join("src/lib.rs");
    let text = fs::read_to_string(&source).unwrap();
    fs::write(&source, text.replace("start = 2000.0", "start = 2001.0")).unwrap();
    let (passed, said) = test();
    assert!(!passed && said.contains("position at "), "{said}");
    fs::write(&source, text).unwrap();

    command(&["fmu", "--manifest-path", "Cargo.toml"]);
    let script = made.join("tests/records.py");
    strut::run(Command::new(strut::interpreter()).arg(script).arg(&made));
    let said = command(&["diagnose", "--rig", "rig.toml", "--train", "train.csv", "--test", "test.csv"]);
    assert!(said.contains("IDENTIFIED: The model lacks Coulomb friction in the strut."), "{said}");
    let report = fs::read_to_string(made.join("report/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let force = report["effects"][0]["parameters"][0]["value"].as_f64().unwrap();
    assert!((force - 3.0).abs() < 0.1, "{force} N of 3 N");
}

/// One command compiles the crate and names what scipy's records hide.
#[test]
fn a_rig_of_ones_own_is_diagnosed_from_its_crate() {
    let folder = tempfile::tempdir().unwrap();
    let example = strut::root().join("examples/own-model/hydropneumatic");
    strut::run(Command::new(strut::interpreter()).arg(example.join("records.py")).arg(folder.path()));
    let mut command = Command::new(strut::program("strut"));
    command
        .args(["diagnose", "--train", "train.csv", "--test", "test.csv", "--rig"])
        .arg(example.join("rig.toml"));
    command.current_dir(folder.path()).env("CARGO_TARGET_DIR", strut::target());
    let said = String::from_utf8_lossy(&strut::run(&mut command).stdout).into_owned();
    assert!(said.contains("IDENTIFIED: The model lacks Coulomb friction in the strut."), "{said}");
    let report = fs::read_to_string(folder.path().join("report/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let number = |of: &serde_json::Value, field: &str| of[field].as_f64().unwrap();
    let force = &report["effects"][0]["parameters"][0];
    assert!((number(force, "value") / 80.0 - 1.0).abs() < 0.05, "{force}");
    // The records are of other masses, springs and dampers than the model starts with.
    for (name, truth) in [("sprung_mass", 312.0), ("stiffness", 12600.0), ("damping", 1330.0)] {
        let parameters = report["nominal_parameters"].as_array().unwrap();
        let found = parameters.iter().find(|it| it["name"] == name).unwrap();
        assert!((number(found, "after") / truth - 1.0).abs() < 0.02, "{found}");
    }
}
