//! Event indicators, for an outside integrator.

use strut_integrators::Array;

use crate::{
    Bundle, Error, Instant, Model,
    bundle::to_array,
    switching::{Switching, conditions, observe},
};

use super::Simulation;

/// The value of an event indicator that stands for nothing.
const NOTHING: f64 = 1.0;

impl<M: Model> Simulation<M> {
    /// Numbers whose signs tell on which side of its kinks and jumps the model is. Those of effects that are off are
    /// constant.
    ///
    /// # Errors
    /// If the model refuses its settings, or has more kinks than there is room for.
    pub fn event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), Error> {
        self.refresh()?;
        let memory = to_array(&if self.before_first_tick() { self.ticked() } else { self.memory });
        let (parameters, derived) = (to_array(&self.parameters), to_array(&self.derived));
        let input = self.input.at(self.time);
        let now = Instant::<M, Switching> {
            time: Switching::moving(self.time),
            state: &Bundle::from_fn(|i| Switching::moving(self.state.as_slice()[i])),
            input: &Bundle::from_fn(|i| Switching::moving(input.as_slice()[i])),
            parameters: &Bundle::from_fn(|i| Switching::parameter(parameters.as_slice()[i])),
            derived: &Bundle::from_fn(|i| Switching::parameter(derived.as_slice()[i])),
            memory: &Bundle::from_fn(|i| Switching::memory(memory.as_slice()[i])),
            tick: self.ticks,
        };
        let found = observe(|| _ = self.model.equations(now));
        if found > indicators.len() {
            return Err(Error::Refused(format!(
                "{} has {found} kinks with these settings, and its description counts {}: leave them as they were",
                M::ABOUT.name,
                indicators.len()
            )));
        }
        indicators.fill(NOTHING);
        conditions(indicators);
        Ok(())
    }
}

/// How many kinks a model has if none of its effects is off.
pub(crate) fn count<M: Model>(model: &M) -> usize {
    use crate::layout::{Layout, Section};
    let starts = |section| -> Vec<f64> {
        Layout::<M>::declarations(section).iter().map(|declaration| declaration.start).collect()
    };
    let [input, state, parameters] = [Section::Input, Section::State, Section::Parameter].map(starts);
    let derived = to_array(&model.derive(&Bundle::from_fn(|i| parameters[i])));
    let memory = crate::Declarations::of::<M::Memory<f64>>();
    let now = Instant::<M, Switching> {
        time: Switching::moving(0.0),
        state: &Bundle::from_fn(|i| Switching::moving(state[i])),
        input: &Bundle::from_fn(|i| Switching::moving(input[i])),
        // As a memory's numbers: nothing vanishes because of them.
        parameters: &Bundle::from_fn(|i| Switching::memory(parameters[i])),
        derived: &Bundle::from_fn(|i| Switching::memory(derived.as_slice()[i])),
        memory: &Bundle::from_fn(|i| Switching::memory(memory[i].start)),
        tick: 0,
    };
    observe(|| _ = model.equations(now))
}
