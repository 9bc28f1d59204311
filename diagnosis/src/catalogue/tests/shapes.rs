//! Whether the shapes in which laws are tried out leave holes: whatever size a shape has, one of them looks so much like it that
//! the law is fitted.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::decision::criteria::CRITERIA;
use crate::plant::{Drive, Dynamics, models};
use crate::screening::rms;

const SAMPLES: usize = 4000;
const STEP: f64 = 2e-3;

/// A bench that moves a strut, and the force that a plain one has on it.
struct Bench {
    plant: Plant,
    dynamics: Box<dyn Dynamics>,
    drive: Drive,
    force: Vec<f64>,
    typical: Typical,
    /// Orthonormal: what a spring and a damper make of the motion, and a constant.
    nominal: DMatrix<f64>,
}

impl Bench {
    fn new() -> Self {
        let plant = models::named("ElementDyno").unwrap();
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let wave = |k: usize, of: fn(f64) -> f64, rate: f64| -> f64 {
            let lines = [(0.9, 8e-3), (2.3, 3e-3), (5.9, 1e-3)];
            let line = |(frequency, amplitude): (f64, f64)| {
                let omega = std::f64::consts::TAU * frequency;
                amplitude * omega.powf(rate) * of(omega * k as f64 * STEP)
            };
            lines.into_iter().map(line).sum()
        };
        let position: Vec<f64> = (0..SAMPLES).map(|k| wave(k, f64::sin, 0.0)).collect();
        let velocity: Vec<f64> = (0..SAMPLES).map(|k| wave(k, f64::cos, 1.0)).collect();
        let mut inputs = vec![vec![0.0; SAMPLES]; plant.inputs.len()];
        inputs[plant.input("motion.position").unwrap()].clone_from(&position);
        inputs[plant.input("motion.velocity").unwrap()].clone_from(&velocity);
        let drive = Drive::sampled(STEP, inputs);
        let columns = [&vec![1.0; SAMPLES], &position, &velocity].map(|it| DVector::from_column_slice(it));
        let nominal = DMatrix::from_columns(&columns).qr().q();
        let mut bench = Self {
            typical: Typical { force: 1.0, deflection: rms(&position), velocity: rms(&velocity), pitch: 1.0 },
            force: vec![0.0; SAMPLES],
            plant,
            dynamics,
            drive,
            nominal,
        };
        bench.force = bench.force_with(&[]);
        bench.typical.force = rms(&bench.force);
        bench
    }

    fn force_with(&self, values: &[(&str, f64)]) -> Vec<f64> {
        let mut parameters: Vec<f64> = self.plant.parameters.iter().map(|it| it.start).collect();
        for (name, value) in values {
            parameters[self.plant.parameter(name).unwrap()] = *value;
        }
        let start: Vec<f64> = self.plant.states.iter().map(|it| it.start).collect();
        let mut outputs = self.dynamics.outputs(&parameters, &start, &self.drive);
        outputs.swap_remove(self.plant.output("force").unwrap())
    }

    /// What a law adds to the force that no spring and no damper does.
    fn shape(&self, values: &[(&str, f64)]) -> DVector<f64> {
        let with = self.force_with(values);
        let added = DVector::from_iterator(SAMPLES, with.iter().zip(&self.force).map(|(a, b)| a - b));
        &added - &self.nominal * (self.nominal.transpose() * &added)
    }
}

/// All combinations of one value for each part.
fn combined<'p>(parts: &[(&'p str, Vec<f64>)]) -> Vec<Vec<(&'p str, f64)>> {
    parts.iter().fold(vec![Vec::new()], |all, (name, values)| {
        let with = |one: &Vec<(&'p str, f64)>| -> Vec<Vec<(&'p str, f64)>> {
            values.iter().map(|value| [&one[..], &[(*name, *value)]].concat()).collect()
        };
        all.iter().flat_map(with).collect()
    })
}

#[test]
fn a_shape_between_those_that_are_tried_looks_like_one_of_them() {
    let bench = Bench::new();
    for id in ["03", "03b", "05", "07", "12"] {
        let effect = all().find(|it| it.id == id && it.element == Element::STRUT).unwrap();
        let scaled = |part: &Part, values: &[f64]| {
            (part.parameter, values.iter().map(|it| it * part.scale.of(&bench.typical)).collect::<Vec<_>>())
        };
        // Halfway between two of them, and as far before the first.
        let others = |probes: &[f64]| match probes {
            [one] => vec![*one],
            _ => {
                let ratio = (probes[1] / probes[0]).sqrt();
                let between = probes.windows(2).map(|pair| (pair[0] * pair[1]).sqrt());
                std::iter::once(probes[0] / ratio).chain(between).collect()
            }
        };
        let tried: Vec<_> = effect.parts.iter().map(|it| scaled(it, it.probes)).collect();
        let others: Vec<_> = effect.parts.iter().map(|it| scaled(it, &others(it.probes))).collect();
        let tried: Vec<DVector<f64>> = combined(&tried).iter().map(|it| bench.shape(it)).collect();
        for values in combined(&others) {
            let shape = bench.shape(&values);
            let alike = |it: &DVector<f64>| (it.dot(&shape) / (it.norm() * shape.norm())).powi(2);
            let best = tried.iter().map(alike).fold(0.0, f64::max);
            assert!(best > CRITERIA.rough, "{id} {values:?}: {best:.2}");
        }
    }
}
