//! A positioning drive in closed loop, from a simulation of its own: friction that sticks, a set point that stops.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

use serde_json::Value;

/// In kg.
pub const MASS: f64 = 95.0;
/// In N s/m.
pub const DAMPING: f64 = 200.0;
/// In N.
pub const FRICTION: f64 = 20.0;
/// A force towards positive positions, as of a table that is not level.
const PULL: f64 = 3.0;
const STEP: f64 = 1e-3;
const SUBSTEPS: usize = 20;

/// A set point: strokes with constant acceleration and deceleration, with stops between them.
pub fn strokes(t: f64) -> f64 {
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

/// A set point: two sines.
pub fn sines(t: f64) -> f64 {
    t.min(1.0) * (0.1 + 0.05 * (1.9 * t).sin() + 0.02 * (5.7 * t + 1.0).sin())
}

/// A record of force and position behind a PD loop.
pub fn record(set_point: impl Fn(f64) -> f64, seconds: f64) -> String {
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

/// The report of a diagnosis of the records `train.csv` and `test.csv` in a folder.
pub fn diagnosed(folder: &Path, threads: &str) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_diagnose"));
    command.env("RAYON_NUM_THREADS", threads);
    command.args(["--rig", "linear-drive", "--no-fmu", "--train"]).arg(folder.join("train.csv"));
    command.arg("--test").arg(folder.join("test.csv")).arg("--out").arg(folder.join("report"));
    let output = command.output().expect("the program runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(folder.join("report/report.json")).expect("there is a report");
    serde_json::from_str(&text).expect("the report is JSON")
}

/// The report of the drive's records as they are, by three threads: what several tests ask of.
pub fn plain() -> &'static Value {
    static REPORT: LazyLock<Value> = LazyLock::new(|| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("train.csv"), record(strokes, 20.0)).unwrap();
        fs::write(folder.path().join("test.csv"), record(sines, 12.0)).unwrap();
        diagnosed(folder.path(), "3")
    });
    &REPORT
}
