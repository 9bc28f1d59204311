//! Files on disk, through every stage that their data go through.

use std::fs;
use std::path::{Path, PathBuf};
use strut_diagnosis::data::check::check;
use strut_diagnosis::data::map::{Map, Wanted};
use strut_diagnosis::data::uniform::uniform;
use strut_diagnosis::data::{Reading, read};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn wanted(name: &str, unit: &str, aliases: &[&str]) -> Wanted {
    Wanted {
        name: name.into(),
        unit: unit.into(),
        aliases: aliases.iter().map(|&alias| alias.into()).collect(),
    }
}

#[test]
fn one_signal_in_three_formats() {
    let mdf = read(&fixture("deflate.mf4"), &Reading::default()).unwrap();
    let matlab = read(&fixture("struct.mat"), &Reading::default()).unwrap();
    assert_eq!(mdf.name, "deflate.mf4");
    assert_eq!(mdf.time.len(), matlab.time.len());
    for (a, b) in mdf.channels[0].values.iter().zip(&matlab.channels[0].values) {
        assert!((a - b).abs() < 1e-12);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("copy.csv");
    strut_diagnosis::data::csv::write(&mdf, fs::File::create(&path).unwrap()).unwrap();
    let copy = read(&path, &Reading::default()).unwrap();
    assert_eq!(copy.time, mdf.time);
    assert_eq!(copy.channels[0], mdf.channels[0]);
}

#[test]
fn from_a_foreign_file_to_an_even_record() {
    let mut text = String::from("# Prüfstand 3\nZeit;Weg [mm];Kraft [kN];Reserve\n");
    for i in 0..400 {
        let t = 0.5 * f64::from(i);
        let cell = |v: f64| if i == 300 { String::new() } else { format!("{v:.6}").replace('.', ",") };
        let (x, f) = (20.0 * (0.1 * t).sin() + 0.01 * (7.1 * t).cos(), 1.5 * (0.17 * t).cos());
        text += &format!("{};{};{};0\n", format!("{t:.1}").replace('.', ","), cell(x), cell(f));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.csv");
    fs::write(&path, text).unwrap();

    let map = "time = { column = \"Zeit\", unit = \"ms\" }\n\
               [signals]\ndeflection = { column = \"Weg\", scale = -1.0 }\n";
    let map = Map::parse(map).unwrap();
    let record = read(&path, &map.reading).unwrap();
    let signals = [wanted("deflection", "m", &[]), wanted("strut.force", "N", &["kraft"])];
    let mapped = map.apply(record, &signals).unwrap();
    assert_eq!(mapped.unused.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["Reserve"]);
    assert!(mapped.missing.is_empty());

    let problems = check(&mapped.record).problems;
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(
        problems.iter().all(|problem| !problem.fatal && problem.text.starts_with("1 samples are missing"))
    );

    let (even, repaired) = uniform(&mapped.record).unwrap();
    assert_eq!((even.step, even.len()), (5e-4, 400));
    assert_eq!(repaired.len(), 2);
    assert_eq!(even.segments.first(), Some(&(0..400)));
    let force = &even.channels[1];
    assert_eq!((force.name.as_str(), force.unit.as_str()), ("strut.force", "N"));
    assert!((force.values[100] - 1500.0 * 8.5_f64.cos()).abs() < 1e-2);
    assert!((even.channels[0].values[100] + 0.02 * 5.0_f64.sin()).abs() < 2e-5);
}

#[test]
fn a_file_that_is_not_there() {
    let message = read(&fixture("none.csv"), &Reading::default()).unwrap_err().to_string();
    assert!(message.contains("none.csv: cannot be read"), "{message}");
}
