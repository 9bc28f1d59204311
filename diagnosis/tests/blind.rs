//! The compact blind benchmark: causes that another program has hidden, with noise and small effects that no model
//! knows, are found through the command line.

use std::fs;
use std::path::Path;
use std::process::Command;

use strut_blind::score::{Outcome, Score};
use strut_blind::{cases, files, generate};

fn diagnosed(name: &str) -> Score {
    let case = cases::compact().into_iter().find(|case| case.name == name).expect("a case of that name");
    let below = tempfile::tempdir().unwrap();
    let folder = files::write(&generate(&case).unwrap(), below.path()).unwrap();
    let data = folder.join("data");
    let of = |kind: &str| {
        let mut paths: Vec<_> = fs::read_dir(&data).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with(kind));
        paths.sort();
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
fn named(name: &str) {
    let score = diagnosed(name);
    assert!(matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo), "{score:?}");
}

macro_rules! named {
    ($($test:ident: $case:literal;)*) => {$(
        #[test]
        fn $test() {
            named($case);
        }
    )*};
}

named! {
    coulomb_friction: "single-01";
    an_asymmetric_damper: "single-04";
    a_damper_knee: "single-05";
    a_maxwell_branch: "single-07";
    a_maxwell_branch_that_is_no_bush_with_play: "common-07";
    a_nonlinear_spring: "single-08";
    a_bump_stop: "single-09";
    an_actuator_delay: "single-23";
    friction_and_a_nonlinear_spring: "pair-01-08";
    an_offset_that_drifts: "sensor-33";
    a_clock_that_is_off: "sensor-36";
    a_sampling_rate_that_is_off: "sensor-40";
    a_saturated_actuator: "single-26";
    a_force_that_cannot_change_fast: "single-26s";
    a_limited_voltage: "servo-26v";
    a_pump_that_leaks: "pump-30p";
    an_overlapped_valve: "servo-28";
    a_valve_with_hysteresis: "servo-28h";
    a_force_cell_with_hysteresis: "sensor-41h";
    friction_on_a_dyno: "dyno-01";
    breakaway_friction_of_a_drive: "drive-02g";
    plain_friction_of_a_drive: "drive-16";
    cogging_of_a_drive: "drive-27";
    friction_of_a_drive_and_a_constant_force: "drive-16-33g";
    a_frame_s_mode_behind_a_late_command: "behind-18";
    a_late_deflection_behind_a_curved_spring: "behind-36";
    a_lag_whose_work_another_cause_had_done: "behind-35";
    breakaway_friction_that_is_no_plain_friction_besides: "resized-02g";
    friction_of_a_strut_whose_position_is_noisy: "noisy-01";
    friction_behind_play: "single-03b";
    friction_of_a_guide_under_state_feedback: "regulated-16";
}

/// Nothing is there, or nothing that matters: no cause is claimed.
#[test]
fn nothing_is_claimed_where_nothing_is_hidden() {
    for name in ["none", "none-cluttered", "mismatch"] {
        let score = diagnosed(name);
        assert_eq!(score.outcome, Outcome::Correct, "{score:?}");
    }
}

/// A cause that is in no catalogue gets no name, and is found in its place: in the strut, and in a sensor.
#[test]
fn a_cause_without_a_name_gets_none() {
    for name in ["unnamed-U1", "driven-U1", "unnamed-U5", "answering-U6"] {
        let score = diagnosed(name);
        assert!(matches!(score.outcome, Outcome::Correct | Outcome::Unnamed), "{score:?}");
        assert_eq!((score.location_right, score.variable_right), (Some(true), Some(true)), "{score:?}");
    }
}
