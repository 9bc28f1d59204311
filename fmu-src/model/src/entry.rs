//! A model without its type, for catalogues.

use std::path::Path;

use crate::{
    About, Access, Causality, Error, Experiment, Interface, Model, ParameterSet, Simulation, Value,
    VariableKind,
};

/// A model in a catalogue: what a packager needs to know of it.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The model's own words.
    pub about: About,
    interface: Make<Interface>,
    instance: Make<Box<dyn Instance>>,
}

/// Makes something of a model with a parameter set and a folder of resources.
type Make<T> = fn(Option<&ParameterSet>, Option<&Path>) -> Result<T, Error>;

/// A model that runs, without its type: see [`Simulation`], whose functions these are.
#[allow(missing_docs, reason = "they are documented there")]
#[allow(clippy::missing_errors_doc, reason = "they are documented there")]
pub trait Instance {
    fn set_up(&mut self, start: f64, tolerance: Option<f64>) -> Result<(), Error>;
    fn initialize(&mut self) -> Result<(), Error>;
    fn time(&self) -> f64;
    fn set_real(&mut self, references: &[u32], values: &[f64], access: Access) -> Result<(), Error>;
    fn set_setting(&mut self, reference: u32, value: Value, access: Access) -> Result<(), Error>;
    fn real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error>;
    fn step(&mut self, from: f64, size: f64) -> Result<(), Error>;
}

impl<M: Model> Instance for Simulation<M> {
    fn set_up(&mut self, start: f64, tolerance: Option<f64>) -> Result<(), Error> {
        self.set_up(start, tolerance)
    }
    fn initialize(&mut self) -> Result<(), Error> {
        self.initialize()
    }
    fn time(&self) -> f64 {
        self.time()
    }
    fn set_real(&mut self, references: &[u32], values: &[f64], access: Access) -> Result<(), Error> {
        self.set_real(references, values, access)
    }
    fn set_setting(&mut self, reference: u32, value: Value, access: Access) -> Result<(), Error> {
        self.set_setting(reference, value, access)
    }
    fn real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        self.real(references, values)
    }
    fn step(&mut self, from: f64, size: f64) -> Result<(), Error> {
        self.step(from, size)
    }
}

/// The signals of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Times in seconds.
    pub time: Vec<f64>,
    /// Name, unit and values of each signal.
    pub signals: Vec<(String, String, Vec<f64>)>,
}

impl Entry {
    /// The entry of a model.
    pub const fn of<M: Model>() -> Self {
        Self {
            about: M::ABOUT,
            interface: Interface::of::<M>,
            instance: |set, resources| Ok(Box::new(Simulation::<M>::new(set, resources)?)),
        }
    }

    /// The interface with a parameter set.
    ///
    /// # Errors
    /// If the parameter set does not fit the declarations or the model refuses it.
    pub fn interface(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
    ) -> Result<Interface, Error> {
        (self.interface)(set, resources)
    }

    /// An instance, not yet initialised.
    ///
    /// # Errors
    /// If the parameter set does not fit the declarations or the model refuses it.
    pub fn instance(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
    ) -> Result<Box<dyn Instance>, Error> {
        (self.instance)(set, resources)
    }

    /// Runs the default experiment.
    ///
    /// # Errors
    /// If the model refuses the parameter set or the integration fails.
    pub fn demonstrate(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
    ) -> Result<Trajectory, Error> {
        let interface = self.interface(set, resources)?;
        demonstrate(&self.about.experiment, &interface, &mut *self.instance(set, resources)?)
    }
}

fn demonstrate(
    experiment: &Experiment,
    interface: &Interface,
    simulation: &mut dyn Instance,
) -> Result<Trajectory, Error> {
    // A stimulus moves its input about where it starts.
    let stimuli: Vec<_> = experiment
        .stimuli
        .iter()
        .filter_map(|(name, stimulus)| {
            let variable = interface.variable(name)?;
            let VariableKind::Real { start, .. } = variable.kind else { return None };
            Some((variable.reference, start.unwrap_or(0.0), *stimulus))
        })
        .collect();
    let (inputs, outputs): (Vec<_>, Vec<_>) = interface
        .variables
        .iter()
        .filter_map(|variable| match &variable.kind {
            VariableKind::Real { unit, .. } => Some((variable, unit.symbol.to_string())),
            _ => None,
        })
        .filter(|(variable, _)| {
            let stimulated = experiment.stimuli.iter().any(|(name, _)| *name == variable.name);
            let plotted = experiment.plot.is_empty() || experiment.plot.contains(&variable.name.as_str());
            stimulated || (variable.causality == Causality::Output && plotted)
        })
        .partition(|(variable, _)| variable.causality == Causality::Input);
    let shown: Vec<_> = inputs.into_iter().chain(outputs).collect();
    let references: Vec<u32> = shown.iter().map(|(variable, _)| variable.reference).collect();
    let mut values = vec![0.0; references.len()];
    let mut trajectory = Trajectory {
        time: Vec::new(),
        signals: shown
            .into_iter()
            .map(|(variable, unit)| (variable.name.clone(), unit, Vec::new()))
            .collect(),
    };
    simulation.set_up(0.0, None)?;
    simulation.initialize()?;
    let steps = (experiment.stop / experiment.step).round() as usize;
    for index in 0..=steps {
        let time = index as f64 * experiment.step;
        for (reference, start, stimulus) in &stimuli {
            simulation.set_real(&[*reference], &[start + stimulus.at(time)], Access::Continuous)?;
        }
        simulation.real(&references, &mut values)?;
        trajectory.time.push(time);
        for ((_, _, signal), value) in trajectory.signals.iter_mut().zip(&values) {
            signal.push(*value);
        }
        if index < steps {
            simulation.step(time, experiment.step)?;
        }
    }
    Ok(trajectory)
}
