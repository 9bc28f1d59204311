//! The diagnosis through its command line: a hidden effect is found and the extended model keeps what the report
//! promises, what cannot be used is refused in words, and real records are explained.

mod records;
mod refusals;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

const RIG: &str = "tum-linear-measured-quarter-car";

/// The command, at the root.
fn diagnose() -> Command {
    let mut command = Command::new(strut::program("diagnose"));
    command.current_dir(strut::root());
    command
}

/// The command that makes records of a virtual rig. Half of its usual length is enough for what is hidden here.
fn simulate() -> Command {
    let mut command = diagnose();
    command.args(["simulate", "--duration", "10"]);
    command
}

/// An empty folder of a test.
fn folder(name: &str) -> PathBuf {
    let folder = strut::target().join("tested-diagnosis").join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("the target folder is ours");
    }
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

fn report(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("report.json")).expect("there is a report");
    serde_json::from_str(&text).expect("the report is JSON")
}

/// Numbers and parameters of the effects that a report names.
fn named(report: &Value) -> Vec<&str> {
    let effects = report["effects"].as_array().expect("a list");
    effects.iter().filter_map(|effect| effect["id"].as_str()).collect()
}

#[test]
fn a_hidden_friction_is_found_and_the_extended_model_has_the_errors_that_are_told() {
    let folder = folder("hidden");
    let (records, out) = (folder.join("records"), folder.join("report"));
    strut::run(simulate().args(["--hide", "strut.coulomb.force=60", "--out"]).arg(&records));
    let output = strut::run(
        diagnose()
            .args(["--rig", RIG, "--train"])
            .arg(records.join("train.csv"))
            .arg("--test")
            .arg(records.join("test.csv"))
            .arg("--out")
            .arg(&out),
    );
    let terminal = String::from_utf8_lossy(&output.stdout);
    assert!(terminal.starts_with("IDENTIFIED: The model lacks Coulomb friction in the strut."), "{terminal}");

    let report = report(&out);
    assert_eq!(report["verdict"], "identified", "{terminal}");
    assert_eq!(named(&report), ["01"]);
    let force = &report["effects"][0]["parameters"][0];
    assert_eq!(force["name"], "strut.coulomb.force");
    let number = |field: &str| force[field].as_f64().expect("a number");
    assert!(number("low") <= 60.0 && 60.0 <= number("high"), "{force}");
    assert!((number("value") / 60.0 - 1.0).abs() < 0.02, "{force}");
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
    replayed(&out.join("extended.fmu"));
    looked_at(&out.join("report.html"));
}

/// Who gets the FMU alone finds the stated errors; and would not with another measured value, or another library's output.
fn replayed(fmu: &Path) {
    let check = |fmu: &Path| crate::subject::check(&[fmu.to_owned()], &["--no-fmpy", "--replay"]);
    let (code, answers) = check(fmu);
    let done = answers[0]["report"]["done"].to_string();
    assert_eq!((code, crate::subject::problems(&answers[0])), (0, Vec::new()));
    assert!(
        done.contains("replay of `validation`") && done.contains("the 6 stated errors come out"),
        "{done}"
    );
    assert!(crate::tables::files(fmu).iter().any(|(name, _)| name.ends_with("fmi-ls-ref/report.json")));
    let altered = fmu.with_file_name("altered.fmu");
    for (file, column) in
        [("validation-out.csv", "body.acceleration"), ("validation-in.csv", "road.position")]
    {
        crate::tables::scaled_in(fmu, file, column, 1.01, &altered);
        let (code, answers) = check(&altered);
        let problems = crate::subject::problems(&answers[0]);
        assert_eq!(code, 1);
        assert!(problems.iter().all(|it| it.starts_with("related.replay.agreement: ")), "{problems:?}");
    }
    fs::remove_file(altered).expect("it is ours");
}

/// A sensor's wrong gain lies outside of the extended model, and the report gives it so that the errors come out all the same.
#[test]
fn a_sensor_s_gain_is_beside_the_extended_model() {
    let folder = folder("outside");
    let (records, out) = (folder.join("records"), folder.join("report"));
    strut::run(simulate().arg("--out").arg(&records));
    for name in ["train.csv", "test.csv"] {
        let path = records.join(name);
        let text = fs::read_to_string(&path).expect("it was just made");
        fs::write(&path, crate::tables::scaled(&text, "body.acceleration", 1.2)).expect("it is ours");
    }
    let mut command = diagnose();
    command.args(["--rig", RIG, "--effects", "23,34", "--train"]).arg(records.join("train.csv"));
    let output = strut::run(command.arg("--test").arg(records.join("test.csv")).arg("--out").arg(&out));
    let terminal = String::from_utf8_lossy(&output.stdout);
    let report = report(&out);
    let mut names = named(&report);
    names.sort_unstable();
    assert_eq!(names, ["34"], "{terminal}");
    let parameters = report["effects"].as_array().expect("a list").iter().map(|it| &it["parameters"][0]);
    let amount = |name: &str| {
        let found = parameters.clone().find(|it| it["name"] == name).expect(name);
        found["value"].as_f64().expect("a number")
    };
    assert!((amount("body.acceleration.gain") - 0.2).abs() < 0.01, "{terminal}");
    let distortions = report["distortions"].as_array().expect("a list");
    let outside: Vec<&str> = distortions.iter().filter_map(|it| it["signal"].as_str()).collect();
    assert_eq!(outside, ["body.acceleration"], "{terminal}");
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
}

/// A sensor that shows nothing of what is slow has a response without a name. It lies outside of the model, and is
/// reported so that the errors come out.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn a_sensor_s_response_without_a_name_is_told_by_its_curve() {
    let folder = folder("response");
    let (records, out) = (folder.join("records"), folder.join("report"));
    // A curve over a tenth of a second takes longer records than an effect with a name.
    strut::run(diagnose().args(["simulate", "--out"]).arg(&records));
    for name in ["train.csv", "test.csv"] {
        let path = records.join(name);
        let text = fs::read_to_string(&path).expect("it was just made");
        fs::write(&path, high_passed(&text, "body.acceleration", 0.2)).expect("it is ours");
    }
    let mut command = diagnose();
    command.args(["--rig", RIG, "--effects", "33,34,35,36,40,G5", "--train"]).arg(records.join("train.csv"));
    let output = strut::run(command.arg("--test").arg(records.join("test.csv")).arg("--out").arg(&out));
    let terminal = String::from_utf8_lossy(&output.stdout);
    let report = report(&out);
    assert_eq!(report["verdict"], "unmodelled", "{terminal}");
    assert!(named(&report).is_empty(), "{terminal}");
    let curve = &report["unmodelled"][0]["curve"];
    assert_eq!((&curve["location"], &curve["variable"]), (&"body.acceleration".into(), &"time".into()));
    let list = |field: &str| {
        let values = curve[field].as_array().expect("a list").iter();
        values.map(|it| it.as_f64().expect("a number")).collect::<Vec<f64>>()
    };
    let slow: Vec<_> = list("x").into_iter().zip(list("y")).filter(|(after, _)| *after > 0.02).collect();
    assert!(slow.len() > 8, "{terminal}");
    for (after, value) in slow {
        assert!((value - (-after / 0.2).exp()).abs() < 0.08, "{after} s: {value}\n{terminal}");
    }
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
    looked_at(&out.join("report.html"));
}

/// A column as of a first-order high-pass with a time constant in s, at 1 kHz.
fn high_passed(text: &str, name: &str, time_constant: f64) -> String {
    crate::tables::with_column(text, name, |values| {
        let mut slow = 0.0;
        let pass = |value: &f64| {
            slow += (value - slow) * (1e-3 / time_constant);
            value - slow
        };
        values.iter().map(pass).collect()
    })
}

/// Opens a page in a browser: nothing sticks out of a desk's or a phone's window, and there is something to be seen.
fn looked_at(page: &Path) {
    let Some(browser) = strut::Browser::installed() else { return };
    for window in [1280, 390] {
        assert_eq!(browser.width(page, window), window, "{} sticks out", page.display());
    }
    let picture = page.with_extension("png");
    browser.picture(page, (1280, 2400), &picture);
    let bytes = fs::read(&picture).expect("the picture can be read");
    // Of an empty page there are a few kilobytes.
    assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 50_000, "{} bytes", bytes.len());
}
