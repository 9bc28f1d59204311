//! The methods of `methods.py` in Rust, on the same case: `hard-coupling [FOLDER OF THE FMUS]`. Prints the same lines.

mod coupled;
mod methods;
mod slave;

use std::path::{Path, PathBuf};

use coupled::{Coupled, Plan};
use methods::{Method, Relaxation};

/// Why a run has ended early.
#[derive(Debug)]
pub enum Error {
    /// An FMU cannot be used or has refused something.
    Fmi(String),
    /// The connected system has become unstable.
    RunAway {
        /// When.
        time: f64,
    },
    /// An iteration has come to no end.
    NotConverged {
        /// In the step that starts there.
        time: f64,
    },
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Fmi(what) => f.write_str(what),
            Self::RunAway { time } => {
                write!(f, "unstable at {time} s: take a shorter step or another method")
            }
            Self::NotConverged { time } => {
                write!(f, "no convergence at {time} s: a shorter step needs fewer iterations")
            }
        }
    }
}

impl std::error::Error for Error {}

const STEPS: [f64; 6] = [0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 2e-3, 5e-3];
const STOP: f64 = 0.2;
const FINEST: f64 = 0.05e-3;
/// The stimulus is a record with a row every 10 ms, a multiple of every step, and straight lines between.
const INTERVAL: f64 = 0.01;
const SIGNALS: [&str; 3] = ["rig.body.position", "rig.wheel.position", "actuator.force"];
const OF_ONE: [&str; 3] = ["one.body.position", "one.wheel.position", "one.actuator.force"];

const PAIR: Plan = Plan {
    components: &[("rig", "KoniecznyQuarterCar"), ("actuator", "KoniecznyServoHydraulicActuator")],
    connections: &[
        ("actuator.force", "rig.actuator.force", 1e3),
        ("rig.suspension.velocity", "actuator.suspension.velocity", 0.1),
    ],
    stimulus: &[
        ("actuator.voltage", voltage),
        ("rig.road.position", road),
        ("rig.road.velocity", road_velocity),
    ],
    parameters: &[],
};
/// The actuator's estimate of what it moves: m_1 m_2/(m_1 + m_2).
const MASS: f64 = 86.0 * 11.5 / (86.0 + 11.5);
const LOADED: &str = "constant inputs, load.mass";
const ONE: Plan = Plan {
    components: &[("one", "KoniecznyServoSuspension")],
    connections: &[],
    stimulus: &[("one.voltage", voltage), ("one.road.position", road)],
    parameters: &[("one.solver.tolerance", 1e-10)],
};

fn line(function: fn(f64) -> f64, time: f64) -> (f64, f64) {
    let row = (time / INTERVAL + 1e-6).floor();
    let (value, after) = (function(row * INTERVAL), function((row + 1.0) * INTERVAL));
    let slope = (after - value) / INTERVAL;
    (value + slope * (time - row * INTERVAL), slope)
}

fn voltage(time: f64) -> (f64, f64) {
    line(|time| 3.0 * (60.0 * time).sin(), time)
}

fn road(time: f64) -> (f64, f64) {
    line(|time| 5e-3 * (1.0 - (30.0 * time).cos()), time)
}

/// The slope of the record, which does not change within a step.
fn road_velocity(time: f64) -> (f64, f64) {
    (road(time).1, 0.0)
}

fn methods() -> [(&'static str, Method); 10] {
    let (rig, actuator) = (0, 1);
    [
        ("constant inputs (Jacobi)", Method::Constant),
        (LOADED, Method::Constant),
        ("input derivatives", Method::Extrapolated),
        ("Gauss–Seidel, actuator first", Method::GaussSeidel(vec![actuator, rig])),
        ("Gauss–Seidel, rig first", Method::GaussSeidel(vec![rig, actuator])),
        ("iteration, Aitken", Method::FixedPoint(Relaxation::Aitken { factor: 0.5 }, vec![actuator, rig])),
        ("iteration, Anderson", Method::FixedPoint(Relaxation::Anderson, vec![actuator, rig])),
        ("iteration, interface Jacobian", Method::Newton),
        ("interface Jacobian, constant inputs", Method::Foreseen(0)),
        ("interface Jacobian", Method::Foreseen(2)),
    ]
}

/// The largest differences of the signals, in percent of the ranges that they have, and calls of `fmi2DoStep` a step.
fn run(
    folder: &Path,
    name: &str,
    method: &mut Method,
    step: f64,
    truth: &[Vec<f64>],
) -> Result<Vec<f64>, Error> {
    let loaded = [("actuator.load.mass", MASS), ("actuator.load.interval", step)];
    let parameters = if name == LOADED { &loaded[..] } else { &[] };
    let mut system = Coupled::new(folder, &Plan { parameters, ..PAIR })?;
    let rows = system.run(method, STOP, step, &SIGNALS)?;
    let every = (step / FINEST).round() as usize;
    let mut numbers: Vec<f64> = (0..SIGNALS.len())
        .map(|signal| {
            let range = truth
                .iter()
                .fold((f64::MAX, f64::MIN), |(low, high), row| (low.min(row[signal]), high.max(row[signal])));
            let apart = rows.iter().zip(truth.iter().step_by(every));
            let largest = apart
                .fold(0.0, |largest, (row, truth)| f64::max(largest, (row[signal] - truth[signal]).abs()));
            100.0 * largest / (range.1 - range.0)
        })
        .collect();
    numbers.push(system.steps as f64 * step / STOP);
    Ok(numbers)
}

fn main() -> Result<(), Error> {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "fmus".into()));
    let truth = Coupled::new(&folder, &ONE)?.run(&mut Method::Constant, STOP, FINEST, &OF_ONE)?;
    for (name, mut method) in methods() {
        for step in STEPS {
            let text = match run(&folder, name, &mut method, step, &truth) {
                Ok(numbers) => {
                    numbers.iter().map(|number| format!("{number:.6e}")).collect::<Vec<_>>().join("|")
                }
                Err(Error::Fmi(what)) => return Err(Error::Fmi(what)),
                Err(_) => "–".into(),
            };
            println!("{name}|{}|{text}", 1e3 * step);
        }
    }
    Ok(())
}
