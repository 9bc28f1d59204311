//! Every FMU, through FMPy: one test, one claim. What is checked stands in `masters/fmpy_checks.py` and, for FMI 3.0,
//! `masters/fmi3_checks.py`.

use std::path::{Path, PathBuf};

fn check(script: &str, name: &str) {
    let output = strut::python(script, [name.as_ref(), strut::fmus().as_os_str()]);
    print!("{output}");
    let fmus = strut::fmus().read_dir().expect("the folder exists");
    let fmus = fmus
        .filter(|entry| entry.as_ref().is_ok_and(|entry| entry.path().extension() == Some("fmu".as_ref())));
    // Ecos prints lines of its own.
    let checked = output.lines().filter(|line| line.starts_with(&format!("{name}: ")));
    assert_eq!(checked.count(), fmus.count(), "every FMU is to be checked");
}

macro_rules! checks {
    ($script:literal: $($name:ident)*) => {$(
        #[test]
        fn $name() {
            check($script, stringify!($name));
        }
    )*};
}

checks! {
    "tests/masters/fmpy_checks.py":
    validate starts rewind reset variable_step input_derivatives output_derivatives directional model_exchange threads
    bad_input no_resources
}

mod fmi3 {
    use super::check;

    checks! {
        "tests/masters/fmi3_checks.py":
        validate same_bits same_bits_in_model_exchange event_mode derivatives ecos fmutool
    }
}

#[test]
fn references() {
    print!("{}", strut::python("tests/masters/fmpy_references.py", [strut::fmus()]));
}

/// The references that the FMUs are measured against are what their script makes.
#[test]
#[ignore = "takes minutes: `scripts/long-tests references`"]
fn references_can_be_made_again() {
    print!("{}", strut::python("tests/reference/make_references.py", ["--check"]));
}

/// One of each kind that is quick: a drive, an actuator, a controller, a road, a source.
#[test]
fn some_references_can_be_made_again() {
    let some =
        ["linear-drive-force", "servo-actuator", "force-pid-h", "road-iso8608", "voltage-source-chirp"];
    let told = strut::python("tests/reference/make_references.py", ["--check"].iter().chain(&some));
    let made_again = told.lines().filter(|line| line.contains("reproduced to"));
    assert_eq!(made_again.count(), some.len(), "{told}");
}

/// The experiment that each FMU brings along comes out as it states, in both versions; and not if another result is stated.
#[test]
fn replay() {
    for folder in [strut::fmus().to_owned(), strut::fmus().join("fmi3")] {
        let fmus = folder.read_dir().expect("the folder exists").map(|entry| entry.expect("readable").path());
        let mut files: Vec<PathBuf> = fmus.filter(|path| path.extension() == Some("fmu".as_ref())).collect();
        let altered = tempfile::tempdir().expect("a folder");
        let fmu = folder.join("TumQuarterVehicle.fmu");
        files.push(altered.path().join("altered.fmu"));
        crate::tables::scaled_in(
            &fmu,
            "default-experiment-out.csv",
            "tire.deflection",
            1.01,
            &files[files.len() - 1],
        );
        let (_, answers) = crate::subject::check(&files, &["--no-fmpy", "--replay"]);
        let (altered, sound) = answers.as_array().expect("an answer each").split_last().expect("several");
        for answer in sound {
            let name =
                Path::new(answer["file"].as_str().expect("a name")).file_stem().expect("a stem").to_owned();
            let (problems, done) = (crate::subject::problems(answer), answer["report"]["done"].to_string());
            assert_eq!(problems, Vec::<String>::new(), "{}", name.display());
            assert!(done.contains("replay of `default-experiment`"), "{}: {done}", name.display());
        }
        let problems = crate::subject::problems(altered);
        assert!(
            matches!(&problems[..], [it] if it.starts_with("related.replay.agreement: ")),
            "{problems:?}"
        );
    }
}
