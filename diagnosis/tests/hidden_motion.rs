//! Masses on a moved base, by equations of this file, with something that swings and that nobody measured.

use std::f64::consts::TAU;

use strut_diagnosis::dataset::recorded::{Dataset, Measured, Source};
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::diagnosis::{Options, diagnose};
use strut_diagnosis::explain::describe::Unmodelled;
use strut_diagnosis::rig::Rig;

use crate::common::noise;

const STEP: f64 = 4e-3;
const SUBSTEPS: usize = 10;
/// Sines of the base.
const SINES: i32 = 30;

/// The mass with what hangs on it, in kg.
const MASS: f64 = 80.0;
/// In N/m.
const STIFFNESS: f64 = 9000.0;
/// In N s/m.
const DAMPING: f64 = 520.0;

/// What hangs on the mass: kg, and its own frequency in Hz. And a force of its own: N, and its frequency in Hz.
#[derive(Clone, Copy, Default)]
struct Hidden {
    load: [f64; 2],
    force: [f64; 2],
}

fn record(rig: &Rig, hidden: Hidden, count: usize, seed: u64) -> Dataset {
    let mut random = noise(seed);
    let sines: Vec<[f64; 3]> = (0..SINES)
        .map(|k| {
            let frequency = 0.5 * 1.13_f64.powi(k) * (1.0 + 0.02 * random());
            [3e-3 / frequency.max(1.5), TAU * frequency, TAU * random()]
        })
        .collect();
    let base = |t: f64| {
        let of =
            |it: &[f64; 3]| [it[0] * (it[1] * t + it[2]).sin(), it[0] * it[1] * (it[1] * t + it[2]).cos()];
        sines.iter().map(of).fold([0.0; 2], |sum, it| [sum[0] + it[0], sum[1] + it[1]])
    };
    let ([load, own], [amplitude, frequency]) = (hidden.load, hidden.force);
    let (spring, damper) = (load * (TAU * own).powi(2), 0.5 * load * TAU * own);
    let phase = TAU * random();
    let h = STEP / SUBSTEPS as f64;
    // Heights and velocities of the mass and of the load.
    let mut state = [0.0; 4];
    let slopes = |t: f64, [x, v, y, w]: [f64; 4]| {
        let [z, u] = base(t);
        let coupling = spring * (y - x) + damper * (w - v);
        let force = amplitude * (TAU * frequency * t + phase).sin();
        let acceleration = (STIFFNESS * (z - x) + DAMPING * (u - v) + coupling + force) / (MASS - load);
        [v, acceleration, w, if load > 0.0 { -coupling / load } else { 0.0 }]
    };
    let along = |x: [f64; 4], by: f64, k: [f64; 4]| std::array::from_fn(|i| x[i] + by * k[i]);
    let (mut position, mut acceleration, mut deflection) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..count {
        let t = k as f64 * STEP;
        position.push(base(t)[0] + 1e-5 * random());
        acceleration.push(slopes(t, state)[1] + 0.02 * random());
        deflection.push(state[0] - base(t)[0] + 2e-5 * random());
        for part in 0..SUBSTEPS {
            let t = t + part as f64 * h;
            let k1 = slopes(t, state);
            let k2 = slopes(t + 0.5 * h, along(state, 0.5 * h, k1));
            let k3 = slopes(t + 0.5 * h, along(state, 0.5 * h, k2));
            let k4 = slopes(t + h, along(state, h, k3));
            state = std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
    }
    let measured = |name: &str, values: Vec<f64>, noise_floor: f64| Measured {
        output: rig.plant.output(name).unwrap(),
        values,
        noise_floor,
    };
    let (motion, rate) = (rig.plant.input("motion.position").unwrap(), rig.plant.input("motion.velocity"));
    let source = |input: usize| match input {
        it if it == motion => Source::Measured(position.clone()),
        it if Some(it) == rate => Source::DerivativeOf(motion),
        _ => Source::Constant(0.0),
    };
    Dataset {
        name: seed.to_string(),
        step: STEP,
        inputs: (0..rig.plant.inputs.len()).map(source).collect(),
        sections: std::iter::once(0..count).collect(),
        measured: vec![
            measured("body.acceleration", acceleration, 0.02),
            measured("suspension.deflection", deflection, 2e-5),
        ],
        ..Dataset::default()
    }
}

/// The number of named effects, and the descriptions of the rest, from records with `count` samples.
fn found(hidden: Hidden, count: usize) -> (usize, Vec<String>) {
    let mut rig = Rig::published("sprung-mass").unwrap();
    for (name, value) in [("sprung_mass", MASS), ("strut.stiffness", STIFFNESS), ("strut.damping", DAMPING)] {
        rig.parameters[rig.plant.parameter(name).unwrap()] = value;
    }
    let records = Split::new(&[record(&rig, hidden, count, 1)], vec![record(&rig, hidden, count, 2)]);
    let diagnosis = diagnose(&rig, &records, Options::default(), &|_| ()).unwrap();
    let described = diagnosis.found.unmodelled.iter().map(Unmodelled::description).collect();
    (diagnosis.found.accepted.len(), described)
}

/// A filter follows a line by the motion that the line itself makes: that is no resonance.
#[test]
fn an_unbalance_is_periodic_in_time() {
    let (named, described) = found(Hidden { force: [60.0, 11.3], ..Hidden::default() }, 3000);
    assert_eq!(named, 0, "{described:?}");
    assert!(described[0].contains("periodic in time, at 11.") && described.len() == 1, "{described:?}");
}

/// The fits of a model without it bend any effect to it: a sensor's gain would make up for a part.
#[test]
fn beside_a_load_that_swings_no_sensor_is_at_fault() {
    let (named, described) = found(Hidden { load: [28.0, 4.6], ..Hidden::default() }, 5000);
    assert_eq!(named, 0, "{described:?}");
    assert!(
        described[0].starts_with("a force that remembers the motion, with a resonance near"),
        "{described:?}"
    );
}
