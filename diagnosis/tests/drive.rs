//! A positioning drive in closed loop, from a simulation of its own: friction that sticks, a set point that stops.

use std::fmt::Write;
use std::fs;
use std::process::Command;

use serde_json::Value;

const MASS: f64 = 95.0;
const DAMPING: f64 = 200.0;
const FRICTION: f64 = 20.0;
/// A force towards positive positions, as of a table that is not level.
const PULL: f64 = 3.0;
const STEP: f64 = 1e-3;
const SUBSTEPS: usize = 20;

/// Strokes with constant acceleration and deceleration, with stops between them.
fn strokes(t: f64) -> f64 {
    const STOPS: [f64; 8] = [0.05, 0.12, 0.03, 0.15, 0.0, 0.1, 0.2, 0.0];
    const ACCELERATION: f64 = 0.3;
    let (mut at, mut left) = (0.0, t);
    for stop in STOPS.iter().cycle() {
        let distance: f64 = stop - at;
        let half = (distance.abs() / ACCELERATION).sqrt();
        if left < 2.0 * half {
            let covered = if left < half {
                0.5 * ACCELERATION * left * left
            } else {
                distance.abs() - 0.5 * ACCELERATION * (2.0 * half - left).powi(2)
            };
            return at + covered * distance.signum();
        }
        at = *stop;
        left -= 2.0 * half;
        if left < 0.3 {
            return at;
        }
        left -= 0.3;
    }
    at
}

fn sines(t: f64) -> f64 {
    t.min(1.0) * (0.1 + 0.05 * (1.9 * t).sin() + 0.02 * (5.7 * t + 1.0).sin())
}

/// A record of force and position behind a PD loop.
fn record(set_point: impl Fn(f64) -> f64, seconds: f64) -> String {
    let mut text = "time [s],motor.force [N],position [m]\n".to_owned();
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    for k in 0..(seconds / STEP) as usize {
        let t = k as f64 * STEP;
        let force = 95.0 * (60.0 * (set_point(t) - x) - v);
        // An encoder of two micrometres.
        writeln!(text, "{t:.4},{force:.6},{:.6}", (x / 2e-6).round() * 2e-6).unwrap();
        let h = STEP / SUBSTEPS as f64;
        for _ in 0..SUBSTEPS {
            let driving = force + PULL - DAMPING * v;
            if v == 0.0 && driving.abs() <= FRICTION {
                continue;
            }
            let direction = if v == 0.0 { driving.signum() } else { v.signum() };
            let next = v + h * (driving - FRICTION * direction) / MASS;
            // What changes its direction sticks first.
            v = if next * v < 0.0 { 0.0 } else { next };
            x += h * v;
        }
    }
    text
}

#[test]
fn friction_is_found_in_a_drive_of_which_nothing_was_known() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("train.csv"), record(strokes, 20.0)).unwrap();
    fs::write(path("test.csv"), record(sines, 12.0)).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_diagnose"));
    command.args(["--rig", "linear-drive", "--no-fmu", "--train"]).arg(path("train.csv"));
    let output =
        command.arg("--test").arg(path("test.csv")).arg("--out").arg(path("report")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value =
        serde_json::from_str(&fs::read_to_string(path("report/report.json")).unwrap()).unwrap();
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
    let base = list("base_parameters");
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
    assert!(force["phi_after"].as_f64().unwrap() > 0.94, "{force}");
}
