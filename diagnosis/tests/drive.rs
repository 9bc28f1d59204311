//! A positioning drive of which nothing was known.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use serde_json::Value;

use crate::common::noise;
use crate::simulated::{DAMPING, FRICTION, MASS, diagnosed, plain, record, sines, strokes};

/// Position, velocity and acceleration at a time in s, from amplitudes in m and frequencies in Hz.
fn along(sines: [(f64, f64); 3], time: f64) -> [f64; 3] {
    let of = |(size, hertz): (f64, f64)| {
        let (rate, phase) = (TAU * hertz, TAU * hertz * time + hertz);
        [size * phase.sin(), size * rate * phase.cos(), -size * rate * rate * phase.sin()]
    };
    sines.map(of).into_iter().fold([0.0; 3], |sum, it| std::array::from_fn(|i| sum[i] + it[i]))
}

#[test]
fn friction_is_found_in_a_drive_of_which_nothing_was_known() {
    let report = plain();
    let list = |key: &str| report[key].as_array().unwrap().clone();
    let mut named: Vec<String> =
        list("effects").iter().map(|it| it["id"].as_str().unwrap().to_owned()).collect();
    named.sort();
    assert!(
        ["identified", "ambiguous"].contains(&report["verdict"].as_str().unwrap()),
        "{}",
        report["verdict"]
    );
    // Damping and the slope are nominal parameters, told as such.
    assert_eq!(named, ["16"]);
    let parameters = list("effects").into_iter().flat_map(|it| it["parameters"].as_array().unwrap().clone());
    let of = |name: &str, values: &[Value], key: &str| {
        values.iter().find(|it| it["name"] == name).and_then(|it| it[key].as_f64()).unwrap_or(f64::NAN)
    };
    let parameters: Vec<Value> = parameters.collect();
    let base = list("nominal_parameters");
    for (found, there) in [
        (of("moving_mass", &base, "after"), MASS),
        (of("guide.damping", &base, "after"), DAMPING),
        (of("guide.coulomb.force", &parameters, "value"), FRICTION),
    ] {
        assert!((found / there - 1.0).abs() < 0.03, "{found} for {there}");
    }
    // The motion is given and the force compared: the remaining error is the transition of the friction.
    let force = &report["signals"][0];
    assert_eq!(force["name"], "motor.force");
    assert!(force["fit_after"].as_f64().unwrap() > 0.94, "{force}");
}

/// A mass with a damper, moved along sines; its position has the noise of 0.03 mm. In the report's force, that is a hundred times the
/// noise of a load cell.
#[test]
fn what_noise_of_the_motion_makes_of_a_force_is_noise() {
    const SINES: [(f64, f64); 3] = [(0.08, 0.4), (0.03, 1.3), (0.01, 3.1)];
    let mut normal = noise(5);
    let mut record = |seconds: f64, later: f64| {
        let mut text = "time [s],motor.force [N],position [m]\n".to_owned();
        for t in (0..(500.0 * seconds) as usize).map(|k| k as f64 / 500.0) {
            let [x, v, a] = along(SINES, t + later);
            let force = MASS * a + DAMPING * v + 3e-3 * normal();
            writeln!(text, "{t:.3},{force:.6},{:.8}", x + 3e-5 * normal()).unwrap();
        }
        text
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("train.csv"), record(20.0, 0.0)).unwrap();
    fs::write(folder.path().join("test.csv"), record(20.0, 31.7)).unwrap();
    let report = diagnosed(folder.path(), "2");
    assert_eq!(report["effects"].as_array().unwrap().len(), 0, "{}", report["summary"]);
    let force = &report["signals"][0];
    let [left, noise] = ["rms_fitted", "noise_floor"].map(|key| force[key].as_f64().unwrap());
    assert!((0.8..1.25).contains(&(left / noise)) && noise > 0.3, "{left} N beside {noise} N");
}

/// A mass with a spring and a damper whose force acts 150 ms after its command: a sixteenth of the slowest period.
#[test]
fn a_command_that_acts_late_is_found_however_slow_the_motion_is() {
    const SINES: [(f64, f64); 3] = [(0.08, 0.4), (0.04, 0.7), (0.02, 1.2)];
    const DELAY: f64 = 0.15;
    let mut normal = noise(7);
    let mut record = |seconds: f64, later: f64| {
        let mut text = "time [s],motor.force [N],position [m]\n".to_owned();
        for t in (0..(200.0 * seconds) as usize).map(|k| k as f64 / 200.0) {
            let force = |[x, v, a]: [f64; 3]| MASS * a + DAMPING * v + 1500.0 * x;
            let command = force(along(SINES, t + later + DELAY)) + 0.1 * normal();
            writeln!(text, "{t:.3},{command:.6},{:.8}", along(SINES, t + later)[0] + 1e-5 * normal())
                .unwrap();
        }
        text
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("train.csv"), record(20.0, 0.0)).unwrap();
    fs::write(folder.path().join("test.csv"), record(15.0, 31.7)).unwrap();
    let report = diagnosed(folder.path(), "2");
    let effects = report["effects"].as_array().unwrap();
    let values = effects.iter().flat_map(|it| it["parameters"].as_array().unwrap());
    let delays: Vec<f64> = values
        .filter(|it| it["name"].as_str().is_some_and(|name| name.ends_with(".delay")))
        .map(|it| it["value"].as_f64().unwrap().abs())
        .collect();
    assert_eq!((effects.len(), delays.len()), (1, 1), "{}", report["summary"]);
    assert!((delays[0] / DELAY - 1.0).abs() < 0.02, "{delays:?}");
}

/// A mass on a spring that was let go: nothing pushes, so that all forces have the mass as their scale.
#[test]
fn what_swings_freely_has_a_spring() {
    swings_freely(7.0, 0.08, 12.0);
}

/// Of four seconds it swings for one: that is where all of the error is, and where the spring explains it.
#[test]
fn what_swings_a_few_times_and_rests_has_a_spring() {
    swings_freely(14.0, 2.5, 4.0);
}

/// The spring's stiffness and the damping over the mass come out of a frequency in rad/s and a decay in 1/s.
fn swings_freely(rate: f64, decay: f64, seconds: f64) {
    let record = |size: f64, phase: f64, seed: u64| {
        let mut normal = noise(seed);
        let mut text = "time [s],motor.force [N],position [m]\n".to_owned();
        for t in (0..(200.0 * seconds) as usize).map(|k| k as f64 / 200.0) {
            let position = size * (-decay * t).exp() * (rate * t + phase).cos();
            writeln!(text, "{t:.3},0,{:.7}", position + 2e-5 * normal()).unwrap();
        }
        text
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("train.csv"), record(0.05, 0.3, 1)).unwrap();
    fs::write(folder.path().join("test.csv"), record(0.03, 2.1, 2)).unwrap();
    let report = diagnosed(folder.path(), "2");
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.iter().map(|it| it["id"].as_str().unwrap()).collect::<Vec<_>>(), ["08"]);
    let stiffness = effects[0]["parameters"][0]["value"].as_f64().unwrap();
    let after = |name: &str| {
        let parameters = report["nominal_parameters"].as_array().unwrap();
        parameters.iter().find(|it| it["name"] == name).unwrap()["after"].as_f64().unwrap()
    };
    let (mass, damping) = (after("moving_mass"), after("guide.damping"));
    // The undamped frequency, and twice the decay.
    assert!((stiffness / mass / (rate.powi(2) + decay.powi(2)) - 1.0).abs() < 5e-3, "{stiffness} {mass}");
    assert!((damping / mass / (2.0 * decay) - 1.0).abs() < 0.1, "{damping} {mass}");
}

/// A logger's second difference of the position says nothing that the position does not.
#[test]
fn a_computed_acceleration_changes_nothing() {
    let with_differences = |text: &str| {
        let mut lines = text.lines();
        let mut result = format!("{},acceleration [m/s2]\n", lines.next().unwrap());
        let rows: Vec<&str> = lines.collect();
        let at = |row: &str| row.rsplit(',').next().unwrap().parse::<f64>().unwrap();
        for (index, row) in rows.iter().enumerate() {
            let near = index.clamp(1, rows.len() - 2);
            let second = at(rows[near - 1]) - 2.0 * at(rows[near]) + at(rows[near + 1]);
            writeln!(result, "{row},{:.4}", second / 1e-6).unwrap();
        }
        result
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("train.csv"), with_differences(&record(strokes, 20.0))).unwrap();
    fs::write(folder.path().join("test.csv"), with_differences(&record(sines, 12.0))).unwrap();
    let report = diagnosed(folder.path(), "2");
    assert_eq!(report["effects"], plain()["effects"]);
}

/// Longer than a pole of any linear motor: a wheel with few teeth. Its curve over the position has more turns than free features have.
#[test]
fn cogging_over_a_long_pitch_is_found() {
    const STROKES: [(f64, f64); 3] = [(0.16, 0.17), (0.05, 0.41), (0.02, 1.1)];
    const FORCE: f64 = 14.0;
    const PITCH: f64 = 0.11;
    let record = |later: f64, seed: u64| {
        let mut normal = noise(seed);
        let mut text = "time [s],motor.force [N],position [m]\n".to_owned();
        for t in (0..5000).map(|k| f64::from(k) / 250.0) {
            let [x, v, a] = along(STROKES, t + later);
            let force = MASS * a + DAMPING * v + FORCE * (TAU * x / PITCH + 0.6).sin() + 0.2 * normal();
            writeln!(text, "{t:.3},{force:.6},{:.8}", x + 1e-6 * normal()).unwrap();
        }
        text
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("train.csv"), record(0.0, 3)).unwrap();
    fs::write(folder.path().join("test.csv"), record(33.0, 4)).unwrap();
    let report = diagnosed(folder.path(), "2");
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.iter().map(|it| it["id"].as_str().unwrap()).collect::<Vec<_>>(), ["27"]);
    for (number, truth) in [FORCE, PITCH].into_iter().enumerate() {
        let value = effects[0]["parameters"][number]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.02, "{value} for {truth}");
    }
}
