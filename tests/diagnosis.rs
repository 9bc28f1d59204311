//! The diagnosis through its command line: a hidden effect is found and the extended model keeps what the report
//! promises, what cannot be used is refused in words, and real records are explained.

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
    strut::run(diagnose().args(["simulate", "--hide", "strut.coulomb.force=60", "--out"]).arg(&records));
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
    looked_at(&out.join("report.html"));
}

/// A sensor's wrong gain lies outside of the extended model, and the report gives it so that the errors come out all the same.
#[test]
fn a_sensor_s_gain_is_beside_the_extended_model() {
    let folder = folder("outside");
    let (records, out) = (folder.join("records"), folder.join("report"));
    strut::run(diagnose().args(["simulate", "--out"]).arg(&records));
    for name in ["train.csv", "test.csv"] {
        let path = records.join(name);
        let text = fs::read_to_string(&path).expect("it was just made");
        fs::write(&path, scaled(&text, "body.acceleration", 1.2)).expect("it is ours");
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
    let corrections = report["corrections"].as_array().expect("a list");
    let outside: Vec<&str> = corrections.iter().filter_map(|it| it["signal"].as_str()).collect();
    assert_eq!(outside, ["body.acceleration"], "{terminal}");
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
}

/// A sensor that shows nothing of what is slow has a response without a name. It lies outside of the model, and is
/// reported so that the errors come out.
#[test]
fn a_sensor_s_response_without_a_name_is_told_by_its_curve() {
    let folder = folder("response");
    let (records, out) = (folder.join("records"), folder.join("report"));
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

/// A table with another function of one of its columns.
fn with_column(text: &str, name: &str, change: impl Fn(&[f64]) -> Vec<f64>) -> String {
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let column = rows[0].iter().position(|title| title.starts_with(name)).expect(name);
    let values: Vec<f64> = rows[1..].iter().map(|row| row[column].parse().expect("a number")).collect();
    let changed = change(&values);
    let row = |(row, value): (&Vec<&str>, &f64)| {
        let value = value.to_string();
        let cells =
            row.iter().enumerate().map(|(index, cell)| if index == column { value.as_str() } else { *cell });
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    rows[0].join(",") + "\n" + &rows[1..].iter().zip(&changed).map(row).collect::<String>()
}

fn scaled(text: &str, name: &str, factor: f64) -> String {
    with_column(text, name, |values| values.iter().map(|value| factor * value).collect())
}

/// A column as of a first-order high-pass with a time constant in s, at 1 kHz.
fn high_passed(text: &str, name: &str, time_constant: f64) -> String {
    with_column(text, name, |values| {
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

/// Records of real rigs, which others have measured; they are no part of the project.
fn real(folder: &str) -> Option<PathBuf> {
    let folder = strut::root().join("../shared/data").join(folder);
    if !folder.is_dir() {
        strut::tell(&format!("skipped: the records of {} are not here", folder.display()));
        return None;
    }
    Some(folder)
}

/// Diagnoses a force element from records of one and judges it by others; the report, and Φ of the force.
fn diagnose_element(name: &str, records: &Path, train: &str, test: &[&str]) -> (Value, f64) {
    let out = folder(name);
    let mut command = diagnose();
    command.args(["--rig", "element-dyno", "--no-fmu", "--train"]).arg(records.join(train));
    for record in test {
        command.arg("--test").arg(records.join(record));
    }
    let output = strut::run(command.arg("--out").arg(&out));
    print!("{}", String::from_utf8_lossy(&output.stdout));
    let report = report(&out);
    let signal = &report["signals"][0];
    assert_eq!(signal["name"], "force");
    let phi = signal["phi_after"].as_f64().expect("a number");
    (report, phi)
}

/// By hand 86 % were reached on another record of the same letter, with a dry yield force and hysteresis.
#[test]
fn the_magnetorheological_damper_is_explained() {
    let Some(records) = real("mr-damper") else { return };
    for (name, train, test) in [("mr-a", "A.2.csv", "A.1.csv"), ("mr-b", "B.1.csv", "B.3.csv")] {
        let (report, phi) = diagnose_element(name, &records, train, &[test]);
        assert!(phi >= 0.86, "{test}: Φ = {phi}");
        let named = named(&report);
        assert!(named.iter().any(|id| ["32f", "03"].contains(id)), "{train}: {named:?} has no yield force");
    }
}

/// By hand 80 % and 79 % were reached on the two validation records, with presliding friction. The damper has a backlash, as its
/// makers say, and pulls harder in one direction.
#[test]
fn the_friction_damper_is_explained() {
    let Some(records) = real("friction-damper") else { return };
    let test = ["1Hz30lbtension0.5amplitude.csv", "0.25Hz30lbtension1.5amplitude.csv"];
    let (report, phi) = diagnose_element("friction", &records, "0.5Hz30lbtension1amplitude.csv", &test);
    assert!(phi >= 0.80, "Φ = {phi}");
    let named = named(&report);
    assert!(named.contains(&"03b"), "{named:?} lacks the backlash");
}

/// Diagnoses a drive from records of one and judges it by others.
fn diagnose_drive(name: &str, records: &Path, [train, test]: [&str; 2], more: &[&str]) -> Value {
    let out = folder(name);
    let mut command = diagnose();
    command.args(["--rig", "linear-drive", "--no-fmu", "--train"]).arg(records.join(train));
    command.arg("--test").arg(records.join(test)).args(more);
    let output = strut::run(command.arg("--out").arg(&out));
    print!("{}", String::from_utf8_lossy(&output.stdout));
    report(&out)
}

/// Value and interval of a nominal parameter.
fn nominal(report: &Value, name: &str) -> [f64; 3] {
    let all = report["base_parameters"].as_array().expect("a list");
    let found = all.iter().find(|it| it["name"] == name).expect(name);
    ["after", "low", "high"].map(|field| found[field].as_f64().expect("a number"))
}

/// Text of all that is to be said about the data.
fn notes(report: &Value) -> String {
    let all = report["data_problems"].as_array().expect("a list").iter();
    all.filter_map(|it| it["text"].as_str()).collect::<Vec<_>>().join("\n")
}

/// By hand: an offset of 252 N and a friction of 145 N; fit 0.58 of a linear law, 0.72 with presliding friction.
#[test]
fn a_load_cell_that_was_not_zeroed_hides_no_friction() {
    let Some(records) = real("real/mr-damper-sweep") else { return };
    let (report, phi) = diagnose_element("sweep", &records, "tr.csv", &["te.csv"]);
    assert!(phi >= 0.72, "Φ = {phi}");
    assert_eq!(named(&report), ["01"]);
    let force = &report["effects"][0]["parameters"][0];
    let [low, high] = ["low", "high"].map(|field| force[field].as_f64().expect("a number"));
    assert!(low < 145.0 && 145.0 < high && low > 40.0, "{force}");
    let [_, low, high] = nominal(&report, "strut.preload");
    assert!(low < 252.0 && 252.0 < high && low > 200.0, "{low} … {high}");
}

/// By hand, the force follows the coil's voltage, a column that no signal of the rig is: fit 0.60 without it, 0.76 with it.
#[test]
fn a_force_that_follows_another_column_is_told() {
    let Some(records) = real("real/mr-damper-random") else { return };
    let (report, phi) = diagnose_element("random", &records, "a.csv", &["b.csv"]);
    assert!(phi >= 0.60, "Φ = {phi}");
    let unmodelled = report["unmodelled"].as_array().expect("a list");
    let voltage = unmodelled.iter().find(|it| it["depends_on"][0] == "column voltage").expect("the voltage");
    assert_eq!(voltage["place"], "strut");
    assert!(voltage["validated"].as_f64().expect("a number") > 0.5, "{voltage}");
}

/// By hand: 25.1 kg and 44 N s/m. One stroke of half a second is both estimation and validation record.
#[test]
fn one_stroke_tells_a_mass_and_is_no_second_witness() {
    let Some(records) = real("real/rack-and-pinion") else { return };
    let report = diagnose_drive("rack", &records, ["stroke.csv", "stroke.csv"], &[]);
    assert!((nominal(&report, "moving_mass")[0] - 25.1).abs() < 0.5);
    assert!((nominal(&report, "guide.damping")[0] - 44.0).abs() < 15.0);
    assert!(named(&report).is_empty());
    let notes = notes(&report);
    assert!(notes.contains("same data") && notes.contains("0.54 s long"), "{notes}");
}

/// Made with 142122 N/m and 22.6 N s/m. The motion is given, and the spring is a nominal parameter of the balance.
#[test]
fn a_spring_to_the_ground_is_found_at_sixty_hertz() {
    let Some(records) = real("real/spring-60-hz") else { return };
    let more = ["--known", "moving_mass=1.0±0.05", "--effects", "08,15"];
    let report = diagnose_drive("spring", &records, ["tr.csv", "te.csv"], &more);
    assert!(named(&report).is_empty(), "{:?}", named(&report));
    let stiffness = nominal(&report, "ground_spring.stiffness")[0];
    assert!((stiffness / 142_122.0 - 1.0).abs() < 0.02, "{stiffness}");
    assert!((nominal(&report, "guide.damping")[0] / 22.6 - 1.0).abs() < 0.1);
}
