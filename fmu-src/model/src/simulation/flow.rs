//! The equations as the integrator sees them.

use num_dual::Dual64;
use strut_integrators::{Array, Square, System};

use crate::{
    Bundle, Instant, Model,
    bundle::{from_slice, to_array},
    layout::{InputArray, Layout, OutputArray, StateArray},
};

use super::input::InputPath;

/// A model with everything but time and states held; keeps what its last evaluation gave.
pub(super) struct Flow<'a, M: Model> {
    pub model: &'a M,
    pub parameters: &'a M::Parameters<f64>,
    pub derived: &'a M::Derived<f64>,
    pub memory: &'a M::Memory<f64>,
    pub input: &'a InputPath<InputArray<M>>,
    pub tick: u64,
    pub rates: &'a mut StateArray<M>,
    pub output: &'a mut OutputArray<M>,
}

impl<M: Model> System<StateArray<M>> for Flow<'_, M> {
    #[inline(always)]
    fn rates(&mut self, t: f64, x: &StateArray<M>) -> StateArray<M> {
        let (state, input) = (from_slice(x.as_slice()), from_slice(self.input.at(t).as_slice()));
        let (rates, output) = self.model.equations(Instant {
            time: t,
            state: &state,
            input: &input,
            parameters: self.parameters,
            derived: self.derived,
            memory: self.memory,
            tick: self.tick,
        });
        let rates = to_array(&rates);
        *self.rates = rates;
        *self.output = to_array(&output);
        rates
    }

    fn jacobian(&mut self, t: f64, x: &StateArray<M>) -> (<StateArray<M> as Array>::Square, StateArray<M>) {
        let (value, slope) = (self.input.at(t), self.input.rates(t));
        let (value, slope) = (value.as_slice(), slope.as_slice());
        let parameters = lift(self.parameters);
        let derived = lift(self.derived);
        let memory = lift(self.memory);
        // One direction at a time: column `seed` by a state, the last one by time.
        let direction = |seed: usize| -> StateArray<M> {
            let timely = f64::from(seed == Layout::<M>::STATES);
            let state = Bundle::from_fn(|i| Dual64::new(x.as_slice()[i], f64::from(i == seed)));
            let input = Bundle::from_fn(|i| Dual64::new(value[i], timely * slope[i]));
            let (rates, _) = self.model.equations(Instant::<M, Dual64> {
                time: Dual64::new(t, timely),
                state: &state,
                input: &input,
                parameters: &parameters,
                derived: &derived,
                memory: &memory,
                tick: self.tick,
            });
            let mut column = StateArray::<M>::zeros();
            rates.for_each(|i, rate| column.as_mut_slice()[i] = rate.eps);
            column
        };
        let mut matrix = <StateArray<M> as Array>::Square::zeros();
        for column in 0..Layout::<M>::STATES {
            let entries = direction(column);
            for (row, entry) in entries.as_slice().iter().enumerate() {
                *matrix.at_mut(row, column) = *entry;
            }
        }
        (matrix, direction(Layout::<M>::STATES))
    }
}

/// The same numbers as constants of another scalar.
pub(super) fn lift<A: Bundle<f64>, B: Bundle<Dual64>>(bundle: &A) -> B {
    from_slice(to_array(bundle).as_slice())
}
