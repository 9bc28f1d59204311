//! Exact directional derivatives.

use num_dual::Dual64;
use strut_integrators::Array;

use crate::{
    Bundle, Error, Instant, Model,
    layout::{Layout, Section},
};

use super::{Simulation, flow::lift};

/// What the variables change by, by section and index.
struct Seeds<M: Model> {
    input: super::InputArray<M>,
    state: super::StateArray<M>,
    parameter: <M::Parameters<f64> as Bundle<f64>>::Array,
}

impl<M: Model> Simulation<M> {
    /// The change of `unknowns` (outputs, state derivatives, calculated parameters) when `knowns`
    /// (inputs, states, parameters) change by `seed` and time by `time`: the Jacobian times the seed, exactly.
    ///
    /// # Errors
    /// If a variable is not one of those, or the lengths differ.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        (knowns, seed): (&[u32], &[f64]),
        time: f64,
        derivative: &mut [f64],
    ) -> Result<(), Error> {
        self.refresh()?;
        let mut seeds =
            Seeds::<M> { input: Array::zeros(), state: Array::zeros(), parameter: Array::zeros() };
        for (reference, amount) in knowns.iter().zip(seed) {
            match Layout::<M>::locate(*reference)? {
                (Section::Input, index) => seeds.input.as_mut_slice()[index] += amount,
                (Section::State, index) => seeds.state.as_mut_slice()[index] += amount,
                (Section::Parameter, index) => seeds.parameter.as_mut_slice()[index] += amount,
                _ => {
                    return Err(Error::NotSettable {
                        name: Layout::<M>::declared().name(*reference),
                        reason: "derivatives are taken with respect to inputs, states and parameters only",
                    });
                }
            }
        }
        let (rates, output, derived) = self.varied(&seeds, time);
        for (reference, value) in unknowns.iter().zip(derivative) {
            let (section, index) = Layout::<M>::locate(*reference)?;
            *value = match section {
                Section::Output => output.as_slice()[index],
                Section::State => seeds.state.as_slice()[index],
                Section::Rate => rates.as_slice()[index],
                Section::Derived => derived.as_slice()[index],
                Section::Input | Section::Parameter | Section::Solver => {
                    return Err(Error::NotSettable {
                        name: Layout::<M>::declared().name(*reference),
                        reason: "derivatives are taken of outputs, states, state derivatives and calculated parameters only",
                    });
                }
            };
        }
        Ok(())
    }

    /// The time derivatives of outputs at the present time, exactly.
    ///
    /// # Errors
    /// If an order is not one or a variable is no output.
    pub fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), Error> {
        self.evaluate()?;
        let seeds =
            Seeds::<M> { input: self.input.rates(self.time), state: self.rates, parameter: Array::zeros() };
        let (_, output, _) = self.varied(&seeds, 1.0);
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let name = || Layout::<M>::declared().name(*reference);
            if *order != 1 {
                return Err(Error::Order {
                    name: name(),
                    order: *order,
                    supported: "outputs have the first derivative",
                });
            }
            *value = match Layout::<M>::locate(*reference)? {
                (Section::Output, index) => output.as_slice()[index],
                (Section::State, index) => self.rates.as_slice()[index],
                _ => return Err(Error::Order { name: name(), order: *order, supported: "it is no output" }),
            };
        }
        Ok(())
    }

    /// Rates, outputs and calculated parameters when everything changes by its seed.
    #[expect(clippy::type_complexity, reason = "three arrays, named in the line above")]
    fn varied(
        &self,
        seeds: &Seeds<M>,
        time: f64,
    ) -> (super::StateArray<M>, super::OutputArray<M>, <M::Derived<f64> as Bundle<f64>>::Array) {
        let varied = |values: &[f64], seeds: &[f64], i: usize| Dual64::new(values[i], seeds[i]);
        let value = self.input.at(self.time);
        let parameter = crate::bundle::to_array(&self.parameters);
        let state = Bundle::from_fn(|i| varied(self.state.as_slice(), seeds.state.as_slice(), i));
        let input = Bundle::from_fn(|i| varied(value.as_slice(), seeds.input.as_slice(), i));
        let parameters = Bundle::from_fn(|i| varied(parameter.as_slice(), seeds.parameter.as_slice(), i));
        let derived = self.model.derive(&parameters);
        let mut memory = lift(&self.memory);
        let now = Instant::<M, Dual64> {
            time: Dual64::new(self.time, time),
            state: &state,
            input: &input,
            parameters: &parameters,
            derived: &derived,
            memory: &lift(&self.memory),
            tick: self.ticks,
        };
        if self.before_first_tick() {
            memory = self.model.tick(now);
        }
        let (rates, output) = self.model.equations(Instant { memory: &memory, ..now });
        (parts(&rates), parts(&output), parts(&derived))
    }
}

/// The derivative parts.
fn parts<B: Bundle<Dual64>, A: Array>(bundle: &B) -> A {
    let mut array = A::zeros();
    bundle.for_each(|i, number| array.as_mut_slice()[i] = number.eps);
    array
}
