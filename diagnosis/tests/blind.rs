//! A few cases of the blind benchmark: effects that another program has hidden, with noise and small effects that no model
//! knows, are found through the command line. The whole list is a command of its own (`tests/blind`).

use std::fs;
use std::path::Path;
use std::process::Command;

use strut_blind::score::{Outcome, Score};
use strut_blind::{cases, files, generate};

/// All of a case's records.
const ALL: usize = usize::MAX;

/// The score of a case, diagnosed with its first estimation records and as many of its first validation records.
fn diagnosed(name: &str, records: usize) -> Score {
    let all = cases::compact().into_iter().chain(cases::full(1000..1001));
    let case = all.into_iter().find(|case| case.name == name).expect("a case of that name");
    let below = tempfile::tempdir().unwrap();
    let folder = files::write(&generate(&case).unwrap(), below.path()).unwrap();
    let data = folder.join("data");
    let of = |kind: &str| {
        let mut paths: Vec<_> = fs::read_dir(&data).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with(kind));
        paths.sort();
        paths.truncate(records);
        paths
    };
    let mut command = Command::new(Path::new(env!("CARGO_BIN_EXE_diagnose")));
    command.arg("--parameters").arg(data.join("start.toml")).arg("--train").args(of("train"));
    command.arg("--test").args(of("test")).arg("--out").arg(folder.join("report")).arg("--no-fmu");
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
    files::judge(&folder).unwrap()
}

/// Named, or one of two that are told to be alike.
fn named(name: &str, records: usize) {
    let score = diagnosed(name, records);
    assert!(matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo), "{score:?}");
}

macro_rules! named {
    ($($(#[$attribute:meta])* $test:ident: $case:literal, $records:expr;)*) => {$(
        #[test]
        $(#[$attribute])*
        fn $test() {
            named($case, $records);
        }
    )*};
}

named! {
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    coulomb_friction: "single-01", 1;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    play_in_a_damper_bush: "single-12", 1;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    a_curved_spring_on_an_unmeasured_road: "roadless-08", 1;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    play_in_a_damper_bush_on_an_unmeasured_road: "roadless-12", 1;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    friction_and_a_nonlinear_spring: "pair-01-08", 1;
    friction_of_a_drive: "drive-16", ALL;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    a_mass_on_a_hardening_spring: "mass-08n", ALL;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    the_overlap_of_a_pneumatic_valve: "pneumatic-28c-1000", 1;
    #[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
    the_leakage_of_a_pneumatic_cylinder: "pneumatic-30c-1000", ALL;
}

/// Nothing is there, or nothing that matters: no effect is claimed.
#[test]
fn nothing_is_claimed_where_nothing_is_hidden() {
    let score = diagnosed("none-cluttered", 1);
    assert_eq!(score.outcome, Outcome::Correct, "{score:?}");
}

/// What is in no catalogue gets no name, and is found in its place with what it depends on.
fn gets_no_name(name: &str) {
    let score = diagnosed(name, ALL);
    assert!(matches!(score.outcome, Outcome::Correct | Outcome::Unnamed), "{score:?}");
    assert_eq!((score.location_right, score.variable_right), (Some(true), Some(true)), "{score:?}");
}

/// An inertial coupling, an absorber and drop-outs.
#[test]
#[ignore = "further diagnoses: `scripts/long-tests diagnosis`"]
fn what_is_in_no_catalogue_gets_no_name() {
    ["unnamed-U7", "unnamed-U9", "unnamed-U10"].into_iter().for_each(gets_no_name);
}
