//! A model on the bench: a simulation whose variables have names.

use std::collections::BTreeMap;

use strut_model::{Access, Error, Interface, Model, ParameterSet, Simulation, Value};

use crate::PARAMETER_SETS;

/// A simulation whose variables have names.
pub struct Bench<M: Model> {
    simulation: Simulation<M>,
    references: BTreeMap<String, u32>,
}

impl<M: Model> Bench<M> {
    /// A model with its declared start values.
    pub fn new() -> Self {
        Self::from(None)
    }

    /// A model with a published parameter set.
    pub fn published(set: &str) -> Self {
        let file = format!("{set}.toml");
        let (_, text) = PARAMETER_SETS.iter().find(|(name, _)| *name == file).expect("a published set");
        Self::from(Some(&ParameterSet::parse(text).unwrap()))
    }

    fn from(set: Option<&ParameterSet>) -> Self {
        let interface = Interface::of::<M>(set, None).unwrap();
        let references =
            interface.variables.into_iter().map(|variable| (variable.name, variable.reference)).collect();
        Self { simulation: Simulation::new(set, None).unwrap(), references }
    }

    fn reference(&self, name: &str) -> u32 {
        *self.references.get(name).unwrap_or_else(|| panic!("no variable {name}"))
    }

    /// Changes a start value.
    pub fn start(mut self, name: &str, value: f64) -> Self {
        self.simulation.set_real(&[self.reference(name)], &[value], Access::All).unwrap();
        self
    }

    /// Changes a setting; a choice is given by its number, from one.
    pub fn choose(mut self, name: &str, value: Value) -> Self {
        self.simulation.set_setting(self.reference(name), value, Access::All).unwrap();
        self
    }

    /// Initialises at time zero.
    pub fn initialized(mut self) -> Self {
        self.initialize().unwrap();
        self
    }

    /// Initialises at time zero, or tells why not.
    pub fn initialize(&mut self) -> Result<(), Error> {
        self.simulation.set_up(0.0, None).unwrap();
        self.simulation.initialize()
    }

    /// Changes an input.
    pub fn set(&mut self, name: &str, value: f64) {
        self.simulation.set_real(&[self.reference(name)], &[value], Access::Continuous).unwrap();
    }

    /// Lets an input change steadily over the next step.
    pub fn slope(&mut self, name: &str, rate: f64) {
        self.simulation.set_input_derivatives(&[self.reference(name)], &[1], &[rate]).unwrap();
    }

    /// Reads a variable.
    pub fn get(&mut self, name: &str) -> f64 {
        let mut value = [0.0];
        self.simulation.real(&[self.reference(name)], &mut value).unwrap();
        value[0]
    }

    /// The present time.
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// Takes a step.
    pub fn step(&mut self, size: f64) {
        self.simulation.step(self.simulation.time(), size).unwrap();
    }

    /// An input follows a function of time in steps of `size`; what `read` makes of each step's end.
    pub fn follow<T>(
        &mut self,
        input: &str,
        command: impl Fn(f64) -> f64,
        size: f64,
        count: usize,
        mut read: impl FnMut(&mut Self) -> T,
    ) -> Vec<T> {
        (0..count)
            .map(|_| {
                // The mean over the step, nearly: what is held is then not late.
                self.set(input, command(self.time() + 0.5 * size));
                self.step(size);
                read(self)
            })
            .collect()
    }
}

/// Amplitude and phase of the part of a frequency in evenly spaced values over whole periods; the first is at `start`.
pub fn harmonic(values: &[f64], start: f64, spacing: f64, frequency: f64) -> (f64, f64) {
    let omega = std::f64::consts::TAU * frequency;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let angle = omega * (start + k as f64 * spacing);
        sine += value * angle.sin();
        cosine += value * angle.cos();
    }
    let n = values.len() as f64;
    (2.0 / n * sine.hypot(cosine), cosine.atan2(sine))
}

/// Root of the mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}
