//! A model without its type, for catalogues.

use std::path::Path;

use crate::{About, Access, Causality, Error, Interface, Model, ParameterSet, Simulation, VariableKind};

/// A model in a catalogue: what a packager needs to know of it.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The model's own words.
    pub about: About,
    interface: fn(Option<&ParameterSet>, Option<&Path>) -> Result<Interface, Error>,
    demonstrate: fn(Option<&ParameterSet>, Option<&Path>) -> Result<Trajectory, Error>,
}

/// The signals of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Times in seconds.
    pub time: Vec<f64>,
    /// Name, unit and values of each signal.
    pub signals: Vec<(String, &'static str, Vec<f64>)>,
}

impl Entry {
    /// The entry of a model.
    pub const fn of<M: Model>() -> Self {
        Self { about: M::ABOUT, interface: Interface::of::<M>, demonstrate: demonstrate::<M> }
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

    /// Runs the default experiment.
    ///
    /// # Errors
    /// If the model refuses the parameter set or the integration fails.
    pub fn demonstrate(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
    ) -> Result<Trajectory, Error> {
        (self.demonstrate)(set, resources)
    }
}

fn demonstrate<M: Model>(set: Option<&ParameterSet>, resources: Option<&Path>) -> Result<Trajectory, Error> {
    let interface = Interface::of::<M>(set, resources)?;
    let mut simulation = Simulation::<M>::new(set, resources)?;
    let experiment = M::ABOUT.experiment;
    let reference = |name: &str| interface.variable(name).map(|variable| variable.reference);
    let stimuli: Vec<_> = experiment
        .stimuli
        .iter()
        .filter_map(|(name, stimulus)| Some((reference(name)?, *stimulus)))
        .collect();
    let (inputs, outputs): (Vec<_>, Vec<_>) = interface
        .variables
        .iter()
        .filter_map(|variable| match variable.kind {
            VariableKind::Real { unit, .. } => Some((variable, unit.symbol)),
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
        for (reference, stimulus) in &stimuli {
            simulation.set_real(&[*reference], &[stimulus.at(time)], Access::Inputs)?;
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
