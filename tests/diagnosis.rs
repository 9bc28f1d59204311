//! The diagnosis through its command line: a hidden effect is found and the extended model keeps what the report
//! promises, what cannot be used is refused in words, and real records are explained.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

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
    assert!(terminal.starts_with("NAMED: The model lacks Coulomb friction in the strut."), "{terminal}");

    let report = report(&out);
    assert_eq!(report["verdict"], "named", "{terminal}");
    assert_eq!(named(&report), ["01"]);
    let force = &report["effects"][0]["parameters"][0];
    assert_eq!(force["name"], "strut.coulomb.force");
    let number = |field: &str| force[field].as_f64().expect("a number");
    assert!(number("low") <= 60.0 && 60.0 <= number("high"), "{force}");
    assert!((number("value") / 60.0 - 1.0).abs() < 0.02, "{force}");
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
    looked_at(&out.join("report.html"));
}

/// The extended model holds an actuator's delay; a sensor's wrong gain lies outside of it, and is told such that the errors
/// come out all the same.
#[test]
fn an_actuator_s_delay_is_in_the_extended_model_and_a_sensor_s_gain_is_told_beside_it() {
    let folder = folder("outside");
    let (records, out) = (folder.join("records"), folder.join("report"));
    strut::run(diagnose().args(["simulate", "--out"]).arg(&records));
    for name in ["train.csv", "test.csv"] {
        let path = records.join(name);
        let text = fs::read_to_string(&path).expect("it was just made");
        // What is commanded now was acting four samples later; the accelerometer shows a fifth too much.
        fs::write(&path, early(&scaled(&text, "body.acceleration", 1.2), "actuator.force", 4))
            .expect("it is ours");
    }
    let mut command = diagnose();
    command.args(["--rig", RIG, "--effects", "23,34", "--train"]).arg(records.join("train.csv"));
    let output = strut::run(command.arg("--test").arg(records.join("test.csv")).arg("--out").arg(&out));
    let terminal = String::from_utf8_lossy(&output.stdout);
    let report = report(&out);
    let mut names = named(&report);
    names.sort_unstable();
    assert_eq!(names, ["23", "34"], "{terminal}");
    let parameters = report["effects"].as_array().expect("a list").iter().map(|it| &it["parameters"][0]);
    let amount = |name: &str| {
        let found = parameters.clone().find(|it| it["name"] == name).expect(name);
        found["value"].as_f64().expect("a number")
    };
    assert!((amount("actuator.delay") - 4e-3).abs() < 2e-4, "{terminal}");
    assert!((amount("body.acceleration.gain") - 0.2).abs() < 0.01, "{terminal}");
    let corrections = report["corrections"].as_array().expect("a list");
    let outside: Vec<&str> = corrections.iter().filter_map(|it| it["signal"].as_str()).collect();
    assert_eq!(outside, ["body.acceleration"], "{terminal}");
    print!("{}", strut::python("tests/masters/diagnosed.py", [&out, &records]));
}

/// A sensor that shows nothing of what is slow has a response without a name. It lies outside of the model, and is told such
/// that the errors come out.
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
    assert_eq!(report["verdict"], "unnamed", "{terminal}");
    assert!(named(&report).is_empty(), "{terminal}");
    let curve = &report["unnamed"];
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

/// A column some samples early; the last values are held.
fn early(text: &str, name: &str, samples: usize) -> String {
    with_column(text, name, |values| {
        (0..values.len()).map(|index| values[(index + samples).min(values.len() - 1)]).collect()
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

/// What a record is to be like to be refused, and what the refusal has to say.
struct Refused {
    name: &'static str,
    arguments: &'static [&'static str],
    says: &'static [&'static str],
}

/// Arguments stand for themselves, but for files of the folder, which begin with `@`.
const REFUSED: &[Refused] = &[
    Refused {
        name: "a file that is not there",
        arguments: &["--rig", RIG, "--train", "@missing.csv", "--test", "@good.csv"],
        says: &["missing.csv", "cannot be read", "check the path"],
    },
    Refused {
        name: "a record without time",
        arguments: &["--rig", RIG, "--train", "@timeless.csv", "--test", "@good.csv"],
        says: &["timeless.csv", "no column of time among road.position", "call it `time [s]`"],
    },
    Refused {
        name: "a record with a word among its numbers",
        arguments: &["--rig", RIG, "--train", "@good.csv", "--test", "@word.csv"],
        says: &[
            "word.csv, line 3, column 2",
            "`much` in `road.position` is not a number",
            "leave missing samples empty",
        ],
    },
    Refused {
        name: "an unknown rig",
        arguments: &["--rig", "tum-quarter-vehicel", "--train", "@good.csv", "--test", "@good.csv"],
        says: &["no rig `tum-quarter-vehicel`", "did you mean `tum-quarter-vehicle`?"],
    },
    Refused {
        name: "no rig at all",
        arguments: &["--train", "@good.csv", "--test", "@good.csv"],
        says: &["which rig?", "--rig", RIG],
    },
    Refused {
        name: "a unit that does not fit",
        arguments: &["--rig", RIG, "--train", "@unit.csv", "--test", "@good.csv"],
        says: &["unit.csv, body.acceleration", "`kg`", "wanted in m/s2", "correct the header"],
    },
    Refused {
        name: "a misspelt known parameter",
        arguments: &[
            "--rig",
            RIG,
            "--known",
            "sprungmass=94.4±0.5",
            "--train",
            "@good.csv",
            "--test",
            "@good.csv",
        ],
        says: &["--known sprungmass=94.4±0.5", "did you mean `sprung_mass`?"],
    },
    Refused {
        name: "a known parameter without its deviation",
        arguments: &[
            "--rig",
            RIG,
            "--known",
            "sprung_mass=94.4",
            "--train",
            "@good.csv",
            "--test",
            "@good.csv",
        ],
        says: &["--known sprung_mass=94.4", "NAME=VALUE±DEVIATION"],
    },
    Refused {
        name: "an effect that is not in the catalogue",
        arguments: &["--rig", RIG, "--effects", "01,99", "--train", "@good.csv", "--test", "@good.csv"],
        says: &["--effects 99", "01, "],
    },
    Refused {
        name: "a record of what drove the rig only",
        arguments: &["--rig", RIG, "--train", "@mute.csv", "--test", "@good.csv"],
        says: &["mute.csv", "no column says what the rig did", "body.acceleration"],
    },
    Refused {
        name: "a record of what the rig did only",
        arguments: &["--rig", RIG, "--train", "@undriven.csv", "--test", "@good.csv"],
        says: &["undriven.csv", "no column says what drove the rig", "road.position"],
    },
    Refused {
        name: "records of different signals",
        arguments: &["--rig", RIG, "--train", "@one.csv", "--test", "@other.csv"],
        says: &["no output in common", "records of the same signals"],
    },
    Refused {
        name: "a map of a column that is not there",
        arguments: &["--rig", RIG, "--map", "@map.toml", "--train", "@good.csv", "--test", "@good.csv"],
        says: &["good.csv, Weg", "there is no such column"],
    },
    Refused {
        name: "a map that is none",
        arguments: &["--rig", RIG, "--map", "@word.csv", "--train", "@good.csv", "--test", "@good.csv"],
        says: &["word.csv", "map"],
    },
    Refused {
        name: "a report where a file is",
        arguments: &["--rig", RIG, "--train", "@good.csv", "--test", "@good.csv", "--out", "@good.csv"],
        says: &["good.csv` is a file", "--out"],
    },
    Refused {
        name: "a hidden parameter that is none",
        arguments: &["simulate", "--hide", "strut.coulomb.forse=60"],
        says: &["strut.coulomb.forse", "did you mean `strut.coulomb.force`?"],
    },
    Refused {
        name: "a hidden value that cannot be",
        arguments: &["simulate", "--hide", "sprung_mass=-4"],
        says: &["--hide sprung_mass=-4", "sprung_mass has to be at least"],
    },
];

/// A record in the project's own format of which some rows and columns are left.
fn excerpt(text: &str, rows: usize, wanted: impl Fn(&str) -> bool) -> String {
    let header: Vec<&str> = text.lines().next().unwrap_or_default().split(',').collect();
    let line = |line: &str| {
        let cells = line.split(',').zip(&header).filter(|(_, title)| wanted(title));
        cells.map(|(cell, _)| cell).collect::<Vec<_>>().join(",") + "\n"
    };
    text.lines().take(rows + 1).map(line).collect()
}

/// Puts a good record and several bad ones into a folder.
fn make_records(folder: &Path) {
    strut::run(diagnose().args(["simulate", "--out"]).arg(folder));
    let good = fs::read_to_string(folder.join("train.csv")).expect("it was just made");
    let write = |name: &str, text: String| fs::write(folder.join(name), text).expect("the folder is ours");
    let driven = |title: &str| title.starts_with("road") || title.starts_with("actuator");
    let part = |wanted: &dyn Fn(&str) -> bool| excerpt(&good, usize::MAX - 1, wanted);
    write("good.csv", good.clone());
    write("timeless.csv", part(&|title| !title.starts_with("time")));
    write(
        "word.csv",
        good.replacen("\n0.0010,", "\n0.0010,much,", 1).lines().take(5).map(drop_last).collect(),
    );
    write("unit.csv", good.replacen("body.acceleration [m/s2]", "body.acceleration [kg]", 1));
    write("mute.csv", part(&|title| title.starts_with("time") || driven(title)));
    write("undriven.csv", part(&|title| !driven(title)));
    write("one.csv", part(&|title| title.starts_with("time") || driven(title) || title.starts_with("body")));
    write(
        "other.csv",
        part(&|title| title.starts_with("time") || driven(title) || title.starts_with("tire")),
    );
    write("short.csv", excerpt(&good, 150, |_| true));
    write(
        "flat.csv",
        clipped(
            &part(&|title| title.starts_with("time") || driven(title) || title.starts_with("body.a")),
            "body.acceleration",
        ),
    );
    write("map.toml", "[signals]\n\"suspension.deflection\" = \"Weg\"\n".into());
}

/// The line without a surplus cell at its end.
fn drop_last(line: &str) -> String {
    let cells: Vec<&str> = line.split(',').collect();
    cells[..cells.len().min(9)].join(",") + "\n"
}

/// The same with a column limited to its root mean square, so that a third is flat.
fn clipped(text: &str, name: &str) -> String {
    with_column(text, name, |values| {
        let limit = (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt();
        values.iter().map(|value| value.clamp(-limit, limit)).collect()
    })
}

/// Exit code 1, words on stderr, no panic.
fn refused(output: &Output, name: &str) -> String {
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{name}: {error}");
    assert!(!error.contains("panicked"), "{name}: {error}");
    error
}

#[test]
fn what_cannot_be_used_is_refused_in_words_and_leaves_nothing_behind() {
    let folder = folder("refused");
    make_records(&folder);
    let before = fs::read_dir(&folder).expect("it is there").count();
    for case in REFUSED {
        let arguments = case.arguments.iter().map(|argument| match argument.strip_prefix('@') {
            Some(file) => folder.join(file).into_os_string(),
            None => argument.into(),
        });
        let mut command = diagnose();
        command.args(arguments);
        if !case.arguments.contains(&"--out") {
            command.arg("--out").arg(folder.join("out"));
        }
        let output = command.output().expect("it can be started");
        let error = refused(&output, case.name);
        assert!(error.starts_with("error: "), "{}: {error}", case.name);
        for words in case.says {
            assert!(error.contains(words), "{}: no `{words}` in {error}", case.name);
        }
        assert!(output.stdout.is_empty(), "{}: {}", case.name, String::from_utf8_lossy(&output.stdout));
        let after = fs::read_dir(&folder).expect("it is there").count();
        assert_eq!(before, after, "{}: something is left behind", case.name);
    }
}

/// Bad data gets a report that says what is wrong, and no model.
#[test]
fn a_record_that_cannot_be_used_is_refused_with_a_report() {
    let folder = folder("unusable");
    make_records(&folder);
    for (record, what) in [
        ("short.csv", "only 150 samples: at least 200 are needed"),
        ("flat.csv", "no output is left to compare with the model"),
    ] {
        let out = folder.join("out");
        let mut command = diagnose();
        command.args(["--rig", RIG, "--train"]).arg(folder.join(record));
        command.arg("--test").arg(folder.join("good.csv")).arg("--out").arg(&out);
        let output = command.output().expect("it can be started");
        let error = refused(&output, record);
        for words in [record, what, "report.html"] {
            assert!(error.contains(words), "no `{words}` in {error}");
        }
        let mut names: Vec<_> =
            fs::read_dir(&out).expect("there is a report").map(|it| it.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["report.html", "report.json"]);
        let report = report(&out);
        assert_eq!(report["verdict"], "bad_data");
        let problems = report["data_problems"].as_array().expect("a list");
        let fatal = problems.iter().filter(|it| it["fatal"] == true);
        assert!(fatal.clone().all(|it| it["record"] == record) && fatal.count() == 1, "{problems:?}");
    }
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

/// By hand 80 % and 79 % were reached on the two held-out records, with presliding friction.
#[test]
fn the_friction_damper_is_explained() {
    let Some(records) = real("friction-damper") else { return };
    let test = ["1Hz30lbtension0.5amplitude.csv", "0.25Hz30lbtension1.5amplitude.csv"];
    let (report, phi) = diagnose_element("friction", &records, "0.5Hz30lbtension1amplitude.csv", &test);
    assert!(phi >= 0.79, "Φ = {phi}");
    let named = named(&report);
    assert!(named.iter().any(|id| ["03", "12", "32f"].contains(id)), "{named:?} has no hysteresis");
}
