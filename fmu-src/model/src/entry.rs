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

    /// Runs the default experiment; its inputs, and the outputs that it plots.
    ///
    /// # Errors
    /// If the model refuses the parameter set or the integration fails.
    pub fn demonstrate(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
    ) -> Result<Trajectory, Error> {
        let Experiment { stop, step, plot, .. } = self.about.experiment;
        let interface = self.interface(set, resources)?;
        let driven = driven(&self.about.experiment, &interface);
        let shown = |name: &str| plot.is_empty() || plot.contains(&name);
        let signals = signals(&interface, &driven, shown);
        run(&mut *self.instance(set, resources)?, &driven, signals, step, stop)
    }

    /// The default experiment as an importer records it, in a limited number of communication steps: inputs are set and held, outputs are
    /// read where a step arrives. Its driven inputs, all outputs, and how many of both are inputs.
    ///
    /// # Errors
    /// If the model refuses the parameter set or the integration fails.
    pub fn record(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
        most: usize,
    ) -> Result<(Trajectory, usize), Error> {
        let Experiment { stop, step, .. } = self.about.experiment;
        let interface = self.interface(set, resources)?;
        let driven = driven(&self.about.experiment, &interface);
        let steps = ((stop / step).round() as usize).clamp(1, most.max(1));
        let mut record = Recording::new(signals(&interface, &driven, |_| true));
        let simulation = &mut *self.instance(set, resources)?;
        simulation.set_up(0.0, None)?;
        let step = stop / steps as f64;
        for index in 0..=steps {
            let time = index as f64 * step;
            if index > 0 {
                simulation.step((index - 1) as f64 * step, step)?;
                record.read(simulation, time)?;
            }
            let access = if index == 0 { Access::All } else { Access::Tunable };
            for Driven { reference, at } in &driven {
                simulation.set_real(&[*reference], &[at(time)], access)?;
                record.note(*reference, at(time));
            }
            if index == 0 {
                simulation.initialize()?;
                record.read(simulation, time)?;
            }
        }
        Ok((record.trajectory, driven.len()))
    }

    /// Simulates from zero to `stop` in communication steps of `step`, in seconds; its driven inputs and all outputs. Without
    /// `inputs`, they do what they do in the default experiment; what is not driven rests at its start value.
    ///
    /// # Errors
    /// If an input does not exist, its times do not rise, the model refuses the parameter set, or the integration fails.
    pub fn simulate(
        &self,
        set: Option<&ParameterSet>,
        resources: Option<&Path>,
        inputs: Option<&Inputs>,
        [step, stop]: [f64; 2],
    ) -> Result<Trajectory, Error> {
        let interface = self.interface(set, resources)?;
        let driven = match inputs {
            None => driven(&self.about.experiment, &interface),
            Some(inputs) => inputs.driven(&interface)?,
        };
        if !(step > 0.0 && stop >= step && stop.is_finite() && stop / step < 1e9) {
            return Err(Error::Refused(format!("a step of {step} s to {stop} s leads nowhere")));
        }
        let signals = signals(&interface, &driven, |_| true);
        run(&mut *self.instance(set, resources)?, &driven, signals, step, stop)
    }
}

/// What inputs do, as points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Times in seconds, rising.
    pub time: Vec<f64>,
    /// Name and values of each input; straight lines between the points, held before and after them.
    pub signals: Vec<(String, Vec<f64>)>,
}

impl Inputs {
    fn driven<'a>(&'a self, interface: &Interface) -> Result<Vec<Driven<'a>>, Error> {
        let is_input = |variable: &&crate::Variable| variable.causality == Causality::Input;
        let rises = self.time.windows(2).all(|pair| pair[0] < pair[1]);
        if self.time.is_empty() || !rises || !self.time.iter().all(|time| time.is_finite()) {
            return Err(Error::Refused("the times of the inputs have to rise".into()));
        }
        let of = |(name, values): &'a (String, Vec<f64>)| {
            let Some(variable) = interface.variable(name).filter(is_input) else {
                let inputs = interface.variables.iter().filter(is_input).map(|it| it.name.as_str());
                let inputs = inputs.collect::<Vec<_>>().join(", ");
                let model = interface.about.name;
                return Err(Error::Refused(format!(
                    "{model} has no input `{name}`; its inputs are {inputs}"
                )));
            };
            if values.len() != self.time.len() {
                return Err(Error::Refused(format!(
                    "the input `{name}` has {} values at {} times",
                    values.len(),
                    self.time.len()
                )));
            }
            let at = |t: f64| between(&self.time, values, t);
            Ok(Driven { reference: variable.reference, at: Box::new(at) })
        };
        self.signals.iter().map(of).collect()
    }
}

/// The value at a time on straight lines between points.
fn between(time: &[f64], values: &[f64], t: f64) -> f64 {
    let next = time.partition_point(|time| *time <= t);
    match (next.checked_sub(1), time.get(next)) {
        (None, _) => values[0],
        (Some(last), None) => values[last],
        (Some(last), Some(after)) => {
            let share = (t - time[last]) / (after - time[last]);
            values[last] + share * (values[next] - values[last])
        }
    }
}

/// What an input does.
struct Driven<'a> {
    reference: u32,
    /// Its value at a time.
    at: Box<dyn Fn(f64) -> f64 + 'a>,
}

/// What the inputs do in an experiment.
fn driven<'a>(experiment: &'a Experiment, interface: &Interface) -> Vec<Driven<'a>> {
    // A stimulus moves its input about where it starts.
    let of = |(name, stimulus): &'a (&str, crate::Stimulus)| {
        let variable = interface.variable(name)?;
        let VariableKind::Real { start, .. } = variable.kind else { return None };
        let rest = start.unwrap_or(0.0);
        Some(Driven { reference: variable.reference, at: Box::new(move |t| rest + stimulus.at(t)) })
    };
    experiment.stimuli.iter().filter_map(of).collect()
}

/// A signal that is written down.
struct Signal {
    reference: u32,
    name: String,
    unit: String,
}

/// The driven inputs, and the outputs that are to be shown.
fn signals(interface: &Interface, driven: &[Driven], shown: impl Fn(&str) -> bool) -> Vec<Signal> {
    let of = |variable: &crate::Variable| {
        let VariableKind::Real { unit, .. } = &variable.kind else { return None };
        let (reference, name) = (variable.reference, variable.name.clone());
        Some(Signal { reference, name, unit: unit.symbol.to_string() })
    };
    let is_driven = |reference| driven.iter().any(|it| it.reference == reference);
    let inputs = interface.variables.iter().filter(|it| it.causality == Causality::Input);
    let inputs = inputs.filter(|it| is_driven(it.reference));
    let outputs =
        interface.variables.iter().filter(|it| it.causality == Causality::Output && shown(&it.name));
    inputs.chain(outputs).filter_map(of).collect()
}

/// A trajectory that grows.
struct Recording {
    references: Vec<u32>,
    values: Vec<f64>,
    trajectory: Trajectory,
}

impl Recording {
    fn new(signals: Vec<Signal>) -> Self {
        let references: Vec<u32> = signals.iter().map(|signal| signal.reference).collect();
        let signals = signals.into_iter().map(|signal| (signal.name, signal.unit, Vec::new())).collect();
        let trajectory = Trajectory { time: Vec::new(), signals };
        Self { values: vec![0.0; references.len()], references, trajectory }
    }

    /// Writes down the values of now.
    fn read(&mut self, simulation: &mut dyn Instance, time: f64) -> Result<(), Error> {
        simulation.real(&self.references, &mut self.values)?;
        self.trajectory.time.push(time);
        for ((_, _, signal), value) in self.trajectory.signals.iter_mut().zip(&self.values) {
            signal.push(*value);
        }
        Ok(())
    }

    /// Writes another value of a signal over that of now.
    fn note(&mut self, reference: u32, value: f64) {
        let column = self.references.iter().position(|it| *it == reference);
        if let Some(last) = column.and_then(|column| self.trajectory.signals[column].2.last_mut()) {
            *last = value;
        }
    }
}

fn run(
    simulation: &mut dyn Instance,
    driven: &[Driven],
    signals: Vec<Signal>,
    step: f64,
    stop: f64,
) -> Result<Trajectory, Error> {
    let mut record = Recording::new(signals);
    simulation.set_up(0.0, None)?;
    simulation.initialize()?;
    // The last step is a shorter one where `stop` is no multiple of a step, but for rounding.
    let steps = (stop / step * (1.0 - 1e-9)).ceil() as usize;
    let at_step = |index: usize| if index == steps { stop } else { index as f64 * step };
    for index in 0..=steps {
        let time = at_step(index);
        for Driven { reference, at } in driven {
            simulation.set_real(&[*reference], &[at(time)], Access::Continuous)?;
        }
        record.read(simulation, time)?;
        if index < steps {
            simulation.step(time, at_step(index + 1) - time)?;
        }
    }
    Ok(record.trajectory)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_follow_straight_lines_and_are_held_outside() {
        let (time, values) = ([1.0, 2.0, 4.0], [10.0, 20.0, 0.0]);
        let at = |t| between(&time, &values, t);
        assert_eq!([0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0].map(at), [10.0, 10.0, 15.0, 20.0, 10.0, 0.0, 0.0]);
        assert_eq!(between(&[3.0], &[7.0], 0.0), 7.0);
    }
}
