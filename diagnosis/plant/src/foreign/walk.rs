//! A model of another maker on its way through a record, by the classical Runge–Kutta method.

use nalgebra::DMatrix;

use crate::Drive;
use crate::pace::{ACCURATE, LONGEST_STEP, MOST_STEPS};

use super::beside::{Beside, Set};
use super::exchange::Session;

/// An instance with the elements beside it.
pub struct Walk<'a> {
    session: Session,
    beside: (&'a Beside, Set),
    /// How many states are the instance's.
    own: usize,
    /// Time of the first sample for the elements; the instance has a time of its own, as it begins anew.
    start: f64,
    inputs: Vec<f64>,
    /// Slopes of a step's stages.
    slopes: [Vec<f64>; 4],
    middle: Vec<f64>,
}

impl<'a> Walk<'a> {
    /// Of an instance whose parameters are set.
    pub fn new(session: Session, beside: (&'a Beside, Set), states: usize, start: f64) -> Self {
        let own = states - beside.0.states.len();
        let slopes = std::array::from_fn(|_| vec![0.0; states]);
        Self { session, beside, own, start, inputs: Vec::new(), slopes, middle: vec![0.0; states] }
    }

    /// Takes other parameters of the elements, and gives its own.
    pub fn exchange(&mut self, set: &mut Set) {
        std::mem::swap(&mut self.beside.1, set);
    }

    /// Rates at a time with a number of inputs, and the outputs on request.
    pub fn look(
        &mut self,
        time: f64,
        state: &[f64],
        (input, inputs): (&dyn Fn(usize) -> f64, usize),
        rates: &mut [f64],
        outputs: Option<&mut [f64]>,
    ) {
        self.inputs.clear();
        self.inputs.extend((0..inputs).map(input));
        let (own, memory) = state.split_at(self.own);
        self.session.place(time, own, &self.inputs);
        let (rates, of_memory) = rates.split_at_mut(self.own);
        let (beside, set) = &self.beside;
        beside.act(set, self.start + time, &mut self.session, (&mut self.inputs, memory, of_memory));
        // Outputs first: after rates, OpenModelica's FMUs take outputs that follow from states for known, and give old ones.
        if let Some(outputs) = outputs {
            self.session.outputs(outputs);
        }
        self.session.rates(rates);
    }

    /// Goes from a sample to the next in a number of steps; `first` are the rates there, `input` an input at a share of the way.
    pub fn advance(
        &mut self,
        (sample, steps): (usize, usize),
        drive: &Drive,
        state: &mut [f64],
        first: &[f64],
        input: &dyn Fn(usize, f64) -> f64,
    ) {
        let (count, h) = (drive.inputs.len(), drive.step / steps as f64);
        let mut slopes = std::mem::take(&mut self.slopes);
        let mut middle = std::mem::take(&mut self.middle);
        for part in 0..steps {
            let share = |offset: f64| (part as f64 + offset) / steps as f64;
            let time = |offset: f64| (sample as f64 + share(offset)) * drive.step;
            if part == 0 {
                slopes[0].copy_from_slice(first);
            } else {
                self.look(time(0.0), state, (&|i| input(i, share(0.0)), count), &mut slopes[0], None);
            }
            for (stage, offset) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
                for ((middle, state), slope) in middle.iter_mut().zip(&*state).zip(&slopes[stage - 1]) {
                    *middle = state + offset * h * slope;
                }
                self.look(
                    time(offset),
                    &middle,
                    (&|i| input(i, share(offset)), count),
                    &mut slopes[stage],
                    None,
                );
            }
            for (index, state) in state.iter_mut().enumerate() {
                let [k1, k2, k3, k4] = [0, 1, 2, 3].map(|stage: usize| slopes[stage][index]);
                *state += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            }
        }
        (self.slopes, self.middle) = (slopes, middle);
    }

    /// Takes a sample that was reached as the end of a step; whether there was an event, so that states and rates may have
    /// jumped.
    pub fn settle(&mut self, state: &mut [f64]) -> bool {
        self.session.settle(&mut state[..self.own])
    }

    /// Number of steps to the next sample: `least`, or more where an element moves fast, as its memory then changes fast.
    pub fn paced(&self, least: usize, drive: &Drive, outputs: &[f64]) -> usize {
        let (beside, set) = &self.beside;
        beside.steps(set, drive.step, outputs).max(least).min(MOST_STEPS as usize)
    }

    /// Steps between two samples that the fastest mode about a state asks for.
    pub fn steps(&mut self, state: &[f64], drive: &Drive) -> usize {
        let (states, inputs) = (state.len(), drive.inputs.len());
        let input = |i: usize| drive.inputs[i].first().copied().unwrap_or(0.0);
        let (mut rest, mut moved) = (vec![0.0; states], vec![0.0; states]);
        self.look(0.0, state, (&input, inputs), &mut rest, None);
        let mut jacobian = DMatrix::<f64>::zeros(states, states);
        let mut displaced = state.to_vec();
        for column in 0..states {
            let by = 1e-7 * state[column].abs().max(1e-2);
            displaced[column] = state[column] + by;
            self.look(0.0, &displaced, (&input, inputs), &mut moved, None);
            displaced[column] = state[column];
            for row in 0..states {
                jacobian[(row, column)] = (moved[row] - rest[row]) / by;
            }
        }
        let finite = jacobian.iter().all(|it| it.is_finite());
        let eigenvalues = (finite && states > 0).then(|| jacobian.complex_eigenvalues());
        let fastest = eigenvalues.map_or(0.0, |all| all.iter().map(|it| it.norm()).fold(0.0, f64::max));
        (drive.step * (fastest / ACCURATE).max(1.0 / LONGEST_STEP)).ceil().clamp(1.0, MOST_STEPS) as usize
    }
}
