//! The program on data that somebody gives it in a hurry: it says what is wrong with them, and it ends in time.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const CAR: &str = "tum-linear-measured-quarter-car";

fn diagnose(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_diagnose")).args(arguments).output().unwrap()
}

/// Records of a virtual rig in a folder: of estimation and of validation.
fn simulate(folder: &Path, hidden: &[&str]) -> [String; 2] {
    let out = folder.to_str().unwrap();
    let hide: Vec<&str> = hidden.iter().flat_map(|it| ["--hide", it]).collect();
    let output = diagnose(&[&["simulate", "--rig", CAR, "--out", out], &hide[..]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    ["train.csv", "test.csv"].map(|name| folder.join(name).to_str().unwrap().to_owned())
}

/// A diagnosis that may take no time, and its report.
fn hasty(train: &str, test: &str, out: &Path) -> (Output, Value) {
    let (rig, folder) = (["--rig", CAR], out.to_str().unwrap());
    let rest = ["--no-fmu", "--time-limit", "0", "--train", train, "--test", test, "--out", folder];
    let output = diagnose(&[&rig[..], &rest[..]].concat());
    let report = fs::read_to_string(out.join("report.json")).unwrap();
    (output, serde_json::from_str(&report).unwrap())
}

fn notes(report: &Value) -> Vec<String> {
    let problems = report["data_problems"].as_array().unwrap().iter();
    problems.map(|it| it["text"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn a_limit_of_no_time_leaves_the_nominal_fit_and_says_what_was_not_done() {
    let folder = tempfile::tempdir().unwrap();
    let [train, test] =
        simulate(&folder.path().join("records"), &["sprung_mass=100", "strut.coulomb.force=60"]);
    let (output, report) = hasty(&train, &test, &folder.path().join("report"));
    let (told, printed) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{told}");
    assert!(told.contains("time limit 0 s"), "{told}");
    assert_eq!(report["verdict"], "out_of_time");
    let unfinished = report["unfinished"].as_str().unwrap();
    assert!(
        unfinished.starts_with("The time limit of 0 s was reached.")
            && unfinished.contains("effects were not")
    );
    // Lines break where they may.
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printed.starts_with("OUT OF TIME") && words(&printed).contains(unfinished), "{printed}");
    assert!(fs::read_to_string(folder.path().join("report/report.html")).unwrap().contains(unfinished));
    assert_eq!(report["effects"].as_array().unwrap().len(), 0);
    let base = report["nominal_parameters"].as_array().unwrap();
    let mass = base.iter().find(|it| it["name"] == "sprung_mass").unwrap()["after"].as_f64().unwrap();
    assert!((mass - 100.0).abs() < 5.0, "{mass}");
    assert!(folder.path().join("report/extended.toml").exists());
}

#[test]
fn a_file_that_cannot_be_written_takes_neither_the_verdict_nor_the_other_files() {
    let folder = tempfile::tempdir().unwrap();
    let [train, test] = simulate(&folder.path().join("records"), &[]);
    let out = folder.path().join("report");
    fs::create_dir_all(out.join("report.html/taken")).unwrap();
    let (output, report) = hasty(&train, &test, &out);
    let (told, printed) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(printed.starts_with("OUT OF TIME") && told.contains("report.html`"), "{printed}{told}");
    assert!(out.join("extended.toml").exists() && out.join("extended.ssv").exists());
    let provenance = &report["provenance"];
    assert!(provenance["command"].as_str().unwrap().starts_with("diagnose --rig "), "{provenance}");
    assert_eq!(provenance["records"][0]["path"], train.as_str());
    assert_eq!(provenance["records"][1]["sha256"].as_str().unwrap().len(), 64);
}

#[test]
fn one_record_for_both_is_no_validation() {
    let folder = tempfile::tempdir().unwrap();
    let [train, test] = simulate(&folder.path().join("records"), &[]);
    let (_, report) = hasty(&train, &train, &folder.path().join("same"));
    let same = notes(&report);
    assert!(same.len() == 1 && same[0].contains("they validate nothing"), "{same:?}");
    let (_, report) = hasty(&train, &test, &folder.path().join("two"));
    assert!(notes(&report).is_empty() && report["disagreements"].as_array().unwrap().is_empty(), "{report}");
}

#[test]
fn records_of_two_rigs_disagree_on_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let [train, _] = simulate(&folder.path().join("one"), &["strut.damping=600"]);
    let [_, test] = simulate(&folder.path().join("two"), &["strut.damping=800"]);
    let (_, report) = hasty(&train, &test, &folder.path().join("report"));
    let disagreements = report["disagreements"].as_array().unwrap();
    assert_eq!(disagreements[0]["name"], "strut.damping", "{disagreements:?}");
    let values = ["train.csv", "test.csv"].map(|name| {
        let records = disagreements[0]["records"].as_array().unwrap();
        records.iter().find(|it| it["record"] == name).unwrap()["value"].as_f64().unwrap()
    });
    assert!((values[0] - 600.0).abs() < 30.0 && (values[1] - 800.0).abs() < 60.0, "{values:?}");
    let summary = report["summary"].as_str().unwrap();
    assert!(summary.contains("The records disagree on strut.damping, in N·s/m:"), "{summary}");
}

#[test]
fn millimetres_without_a_unit_end_with_what_to_write() {
    let folder = tempfile::tempdir().unwrap();
    let [train, test] = simulate(&folder.path().join("records"), &["strut.coulomb.force=60"]);
    for path in [&train, &test] {
        let text = fs::read_to_string(path).unwrap();
        let column = text.lines().next().unwrap().split(',').position(|it| it == "suspension.deflection [m]");
        let cell = |(index, cell): (usize, &str)| match cell.parse::<f64>() {
            Ok(metres) if Some(index) == column => format!("{}", 1e3 * metres),
            _ if Some(index) == column => "suspension.deflection".into(),
            _ => cell.into(),
        };
        let line = |line: &str| line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",");
        fs::write(path, text.lines().map(line).collect::<Vec<_>>().join("\n")).unwrap();
    }
    let (output, report) = hasty(&train, &test, &folder.path().join("report"));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && report["verdict"] == "bad_data", "{told}");
    assert!(told.contains("suspension.deflection: its rms is 7.6 m"), "{told}");
    assert!(told.contains("Write the unit in the header, e.g. \"suspension.deflection [mm]\""), "{told}");
}
