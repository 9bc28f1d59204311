//! A verdict does not change with what says nothing of the rig: rate, length, redundant columns, threads.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::simulated::{DAMPING, FRICTION, MASS, diagnosed, plain, record, sines, strokes};

/// Lines of a record, each changed; the first is the header.
fn changed(record: &str, change: impl Fn(usize, &str) -> Option<String>) -> String {
    record
        .lines()
        .enumerate()
        .filter_map(|(number, line)| change(number, line))
        .map(|line| line + "\n")
        .collect()
}

/// The diagnosis of the drive, its records changed.
fn of(threads: &str, change: impl Fn(usize, &str) -> Option<String>) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        fs::write(Path::new(folder.path()).join(name), changed(text, &change)).unwrap();
    };
    write("train.csv", &record(strokes, 20.0));
    write("test.csv", &record(sines, 12.0));
    diagnosed(folder.path(), threads)
}

fn as_it_is(_: usize, line: &str) -> Option<String> {
    Some(line.to_owned())
}

/// The verdict, the effects and whether mass, damping and friction are those of the drive.
fn said(report: &Value) -> (String, Vec<String>, Vec<bool>) {
    let effects = report["effects"].as_array().unwrap();
    let own = effects.iter().flat_map(|it| it["parameters"].as_array().unwrap());
    let all: Vec<&Value> = report["nominal_parameters"].as_array().unwrap().iter().chain(own).collect();
    let is_right = |(name, key, there): (&str, &str, f64)| {
        let found = all.iter().find(|it| it["name"] == name).and_then(|it| it[key].as_f64());
        found.is_some_and(|found| (found / there - 1.0).abs() < 0.05)
    };
    let values = [
        ("moving_mass", "after", MASS),
        ("guide.damping", "after", DAMPING),
        ("guide.coulomb.force", "value", FRICTION),
    ];
    let named = effects.iter().map(|it| it["id"].as_str().unwrap().to_owned()).collect();
    (report["verdict"].as_str().unwrap().to_owned(), named, values.map(is_right).to_vec())
}

#[test]
fn a_verdict_is_the_same_at_another_rate_over_another_time_and_beside_redundant_columns() {
    let plain = said(plain());
    assert_eq!((&plain.1[..], &plain.2[..]), (&["16".to_owned()][..], &[true; 3][..]));
    let every_second = |number: usize, line: &str| (number % 2 < 1 || number == 0).then(|| line.to_owned());
    assert_eq!(said(&of("2", every_second)), plain, "at half the rate");
    let shorter = |number: usize, line: &str| (number < 9000).then(|| line.to_owned());
    assert_eq!(said(&of("2", shorter)), plain, "over nine seconds");
    let redundant = |number: usize, line: &str| {
        let more = if number == 0 {
            "temperature [degC],spare [m]".to_owned()
        } else {
            let position = line.rsplit(',').next()?;
            format!("{:.2},{position}", 21.0 + 0.01 * (number / 4000) as f64)
        };
        Some(format!("{line},{more}"))
    };
    assert_eq!(said(&of("2", redundant)), plain, "beside a temperature and a copy of the position");
}

#[test]
fn a_report_is_the_same_by_any_number_of_threads() {
    // What a run says of itself, its time and its command, is its own.
    let findings = |mut report: Value| {
        report["seconds"] = Value::Null;
        report["provenance"] = Value::Null;
        report
    };
    assert_eq!(findings(of("1", as_it_is)), findings(plain().clone()));
}
