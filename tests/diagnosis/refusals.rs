//! Records that cannot be used are refused in words, and nothing is left behind.

use std::fs;
use std::path::Path;
use std::process::Output;

use super::{RIG, diagnose, folder, report};
use crate::tables::with_column;

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
        says: &["word.csv, road.position: `much` in line 3 is not a number: leave missing samples empty"],
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
        name: "a known parameter that cannot be",
        arguments: &[
            "--rig",
            RIG,
            "--known",
            "sprung_mass=-94.4±0.5",
            "--train",
            "@good.csv",
            "--test",
            "@good.csv",
        ],
        says: &["--known sprung_mass=-94.4±0.5", "has to be at least 0.001 kg"],
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
        says: &[
            "undriven.csv",
            "no column says what drove the rig",
            "road.position",
            "strut alone",
            "wheel.acceleration",
        ],
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
        name: "a hidden delay that cannot be",
        arguments: &["simulate", "--hide", "body.acceleration.delay=1e16"],
        says: &["body.acceleration.delay has to be from -3600 to 3600 s"],
    },
    Refused {
        name: "a hidden limit that cannot be",
        arguments: &["simulate", "--hide", "body.acceleration.limit=-2"],
        says: &["body.acceleration.limit has to be at least 0"],
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
    write("word.csv", good.replacen("\n0.001,", "\n0.001,much,", 1).lines().take(5).map(drop_last).collect());
    write("unit.csv", good.replacen("body.acceleration [m/s2]", "body.acceleration [kg]", 1));
    write("mute.csv", part(&|title| title.starts_with("time") || driven(title)));
    // Not even how the wheel or the suspension moves.
    let moved = |title: &str| title.starts_with("wheel") || title.starts_with("suspension");
    write("undriven.csv", part(&|title| !driven(title) && !moved(title)));
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
