//! A model of another maker as equations whose derivatives are differences: of the very integration, with its steps kept.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use strut_model::Declaration;

use crate::{Drive, Dynamics, Follower, Linearised, Seed, Seen, Signals};

use super::beside::Beside;
use super::exchange::Fmu;
use super::lanes::Lanes;
use super::walk::{Given, Walk, Way};

/// Smallest change of a parameter, relative to its value or its typical magnitude, that a difference is made with.
const SMALL: f64 = 1e-6;
/// Share of the outputs' magnitude that a change has to make, so that rounding is a millionth of it.
const SEEN: f64 = 1e-8;
/// Share that a change is made anew for if it was not seen, or was too large to be a derivative.
const WANTED: f64 = 1e-6;

/// Share of a change of the states at the start below which it is forgotten: differences are no better.
const FORGOTTEN: f64 = 1e-7;

/// A run through a record.
struct Run {
    outputs: Signals,
    /// Steps between the samples.
    steps: Vec<usize>,
    /// States at the samples, one sample after another.
    states: Vec<f64>,
    /// Inputs between the samples; none if there are events.
    given: Option<Vec<f64>>,
}

/// An FMU with the elements beside it.
#[derive(Clone, Debug)]
pub struct Differences {
    pub(super) fmu: Arc<Fmu>,
    pub(super) beside: Beside,
    /// Declared start or typical magnitude of each parameter, and of each state.
    typical: [Vec<f64>; 2],
    /// Changes that were found to be seen, by what was changed.
    changes: Arc<Mutex<HashMap<(u8, usize), f64>>>,
}

/// What differs from the model as it is.
pub(super) struct Changed<'a> {
    pub parameters: Vec<f64>,
    /// The states at the start, or their change.
    pub start: Vec<f64>,
    inputs: &'a [(usize, Vec<f64>)],
    by: f64,
    /// Whether nothing else differs than the states at the start.
    is_at_the_start: bool,
}

impl Changed<'_> {
    /// Nothing yet.
    fn none(parameters: &[f64], start: &[f64]) -> Self {
        Self {
            parameters: parameters.to_vec(),
            start: start.to_vec(),
            inputs: &[],
            by: 0.0,
            is_at_the_start: false,
        }
    }

    pub fn input(&self, drive: &Drive, index: usize, sample: usize, share: f64) -> f64 {
        let own = drive.value(&drive.inputs[index], sample, share);
        let change = self.inputs.iter().find(|(input, _)| *input == index);
        own + change.map_or(0.0, |(_, signal)| self.by * drive.value(signal, sample, share))
    }
}

impl Differences {
    pub fn new(fmu: Arc<Fmu>, beside: Beside, parameters: &[Declaration], states: &[Declaration]) -> Self {
        // Of a variable without one, FMI takes a nominal value of 1.
        let of = |it: &Declaration| if it.start == 0.0 { it.nominal.unwrap_or(1.0) } else { it.start.abs() };
        let typical = [parameters, states].map(|all| all.iter().map(of).collect());
        Self { fmu, beside, typical, changes: Arc::default() }
    }

    /// Refuses an element whose force changes a motion at once.
    pub fn refuse_loops(&self) -> Result<(), String> {
        let motions = self.beside.motions();
        if motions.is_empty() {
            return Ok(());
        }
        let parameters: Vec<f64> = self.fmu.parameters.iter().map(|it| it.start).collect();
        let mut session = self
            .fmu
            .open(&parameters, 0.0)
            .ok_or_else(|| format!("{} refuses its own start values", self.fmu.name))?;
        let start: Vec<f64> = self.fmu.states.iter().map(|it| it.start).collect();
        let rest: Vec<f64> = self.fmu.inputs.iter().map(|it| it.start).collect();
        session.place(0.0, &start, &rest);
        let mut moved = |values: &[f64]| -> Vec<f64> {
            session.drive(values);
            motions.iter().flat_map(|output| session.some([*output])).collect()
        };
        let before = moved(&rest);
        for (name, inputs) in self.beside.acts_on() {
            let mut pushed = rest.clone();
            inputs.for_each(|input| pushed[input] += 1.0);
            if moved(&pushed) != before {
                return Err(format!(
                    "{}: the force of the {name} changes a deflection or velocity at once (an algebraic loop); name outputs \
                     that follow from states",
                    self.fmu.name
                ));
            }
        }
        Ok(())
    }

    /// A model on its way, with these parameters; none if it refuses them.
    pub(super) fn walk<'a>(&'a self, parameters: &[f64], start: f64) -> Option<Walk<'a>> {
        let (own, further) = parameters.split_at(self.fmu.parameters.len());
        let beside = (&self.beside, self.beside.set(further));
        Some(Walk::new(self.fmu.open(own, start)?, beside, self.typical[1].len(), start))
    }

    /// The run of a model that is changed, its outputs not a number from where it cannot be run; in the steps of the run without the
    /// change, if there is one. As soon as a change of the start is forgotten, the outputs are those of that run.
    fn run<'a>(&'a self, changed: &Changed<'_>, drive: &Drive, plain: Option<&'a Run>) -> Run {
        let count = self.fmu.outputs.len();
        let mut signals = vec![Vec::with_capacity(drive.len()); count];
        let mut state = changed.start.clone();
        let mut walk = self.walk(&changed.parameters, drive.start);
        let mut pace = walk.as_mut().filter(|_| plain.is_none()).map(|walk| walk.pace(&state, drive));
        let mut made = Vec::with_capacity(drive.len());
        let mut states = Vec::new();
        let smooth = plain.filter(|it| it.given.is_some());
        let fading = smooth.filter(|_| changed.is_at_the_start);
        let fading = fading.map(|plain| (plain, self.apart(&state, plain, 0)));
        if let Some(walk) = &mut walk {
            let again = smooth.filter(|_| changed.inputs.is_empty()).and_then(|it| it.given.as_deref());
            let kept = if plain.is_none() { Given::Kept(Vec::new()) } else { Given::Anew };
            walk.give_on_the_way(again.map_or(kept, Given::Again));
        }
        let (mut rates, mut outputs) = (vec![0.0; state.len()], vec![f64::NAN; count]);
        for sample in 0..drive.len() {
            match fading {
                Some((plain, first)) if self.apart(&state, plain, sample) < FORGOTTEN * first => {
                    let rest = |(signal, own): (&mut Vec<f64>, &Vec<f64>)| signal.extend(&own[sample..]);
                    signals.iter_mut().zip(&plain.outputs).for_each(rest);
                    break;
                }
                _ => {}
            }
            if plain.is_none() {
                states.extend_from_slice(&state);
            }
            if let Some(walk) = &mut walk {
                let input = |i: usize| changed.input(drive, i, sample, 0.0);
                let (time, inputs) = (sample as f64 * drive.step, drive.inputs.len());
                walk.look(time, &state, (&input, inputs), &mut rates, Some(&mut outputs));
                if walk.settle(time, &mut state) {
                    walk.look(time, &state, (&input, inputs), &mut rates, None);
                }
                if sample + 1 < drive.len() {
                    let input = |i: usize, share: f64| changed.input(drive, i, sample, share);
                    let steps = match &mut pace {
                        Some(pace) => walk.advance_at(
                            pace,
                            (sample, drive, &input),
                            (&mut state, &rates, &outputs),
                            true,
                        ),
                        None => {
                            let steps = plain.and_then(|it| it.steps.get(sample)).copied().unwrap_or(1);
                            let way = Way { sample, steps, drive, input: &input };
                            walk.advance(&way, &mut state, &rates, true, None);
                            steps
                        }
                    };
                    made.push(steps);
                }
            }
            signals.iter_mut().zip(&outputs).for_each(|(signal, value)| signal.push(*value));
        }
        let given = walk.and_then(|mut it| match it.give_on_the_way(Given::Anew) {
            Given::Kept(all) => Some(all),
            Given::Anew | Given::Again(_) => None,
        });
        Run { outputs: signals, steps: made, states, given }
    }

    /// How far states are from those of a run at a sample, in typical magnitudes.
    fn apart(&self, state: &[f64], run: &Run, sample: usize) -> f64 {
        let own = run.states.chunks_exact(state.len().max(1)).nth(sample).unwrap_or_default();
        let each = state.iter().zip(own).zip(&self.typical[1]);
        each.map(|((a, b), typical)| ((a - b) / typical).powi(2)).sum::<f64>().sqrt()
    }

    /// What a seed is kept under, and the change to begin with.
    fn change(&self, seed: &Seed, parameters: &[f64], start: &[f64]) -> ((u8, usize), f64) {
        let of =
            |value: f64, typical: f64| SMALL * if value == 0.0 { typical.max(SMALL) } else { value.abs() };
        let (key, first) = match seed {
            Seed::Parameter(index) => ((0, *index), of(parameters[*index], self.typical[0][*index])),
            Seed::State(index) => ((1, *index), of(start[*index], self.typical[1][*index])),
            Seed::Inputs(changes) => ((2, changes.first().map_or(0, |it| it.0)), SMALL),
        };
        let kept = self.changes.lock().unwrap_or_else(PoisonError::into_inner).get(&key).copied();
        (key, kept.unwrap_or(first))
    }

    fn changed<'a>(parameters: &[f64], start: &[f64], seed: &'a Seed, by: f64) -> Changed<'a> {
        let mut changed = Changed { by, ..Changed::none(parameters, start) };
        match seed {
            Seed::Parameter(index) => changed.parameters[*index] += by,
            Seed::State(index) => {
                changed.start[*index] += by;
                changed.is_at_the_start = true;
            }
            Seed::Inputs(changes) => changed.inputs = changes,
        }
        changed
    }

    /// Slopes of the outputs with respect to a seed.
    fn slopes(
        &self,
        (parameters, start): (&[f64], &[f64]),
        drive: &Drive,
        seed: &Seed,
        plain: &Run,
    ) -> Signals {
        let (key, mut by) = self.change(seed, parameters, start);
        let (mut moved, mut seen) = (Vec::new(), 0.0);
        for attempt in 0..4 {
            moved = self.run(&Self::changed(parameters, start, seed, by), drive, Some(plain)).outputs;
            seen = share(&plain.outputs, &moved);
            if attempt == 3 || (SEEN..=1e3 * WANTED).contains(&seen) {
                break;
            }
            by *= if seen == 0.0 { 1e4 } else { (WANTED / seen).clamp(1e-6, 1e8) };
        }
        // What no output sees would be changed by more in every call, until it is no number.
        if seen > 0.0 {
            self.changes.lock().unwrap_or_else(PoisonError::into_inner).insert(key, by);
        }
        for (moved, base) in moved.iter_mut().zip(&plain.outputs) {
            moved.iter_mut().zip(base).for_each(|(moved, base)| *moved = (*moved - base) / by);
        }
        moved
    }
}

/// Largest change of an output, in shares of its magnitude.
fn share(base: &Signals, moved: &Signals) -> f64 {
    let of = |(base, moved): (&Vec<f64>, &Vec<f64>)| {
        let largest = base.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        let change = base.iter().zip(moved).fold(0.0_f64, |most, (a, b)| most.max((b - a).abs()));
        if largest > 0.0 { change / largest } else { 0.0 }
    };
    base.iter().zip(moved).map(of).fold(0.0, f64::max)
}

impl Dynamics for Differences {
    fn outputs(&self, parameters: &[f64], start: &[f64], drive: &Drive) -> Signals {
        self.run(&Changed::none(parameters, start), drive, None).outputs
    }

    fn linearised(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        seeds: &[Seed],
        wanted: &[usize],
    ) -> Linearised {
        let plain = self.run(&Changed::none(parameters, start), drive, None);
        let only = |signals: &Signals| wanted.iter().map(|output| signals[*output].clone()).collect();
        let of = |seed: &Seed| only(&self.slopes((parameters, start), drive, seed, &plain));
        let slopes = seeds.par_iter().map(of).collect();
        Linearised { outputs: only(&plain.outputs), slopes }
    }

    fn followed(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        (seeds, wanted): (&[Seed], &[usize]),
        follower: &mut dyn Follower,
    ) {
        let changes: Vec<f64> = seeds.iter().map(|seed| self.change(seed, parameters, start).1).collect();
        let none = vec![0.0; start.len()];
        let plain = Changed::none(parameters, &none);
        let changed =
            seeds.iter().zip(&changes).map(|(seed, by)| Self::changed(parameters, &none, seed, *by));
        let Some(mut lanes) = Lanes::new(self, std::iter::once(plain).chain(changed), drive) else { return };
        let mut state = start.to_vec();
        let Some(mut pace) = lanes.pace(&state) else { return };
        let count = seeds.len();
        let (mut values, mut slopes) = (vec![0.0; wanted.len()], vec![0.0; wanted.len() * count]);
        let mut advanced = vec![0.0; state.len() * count];
        for sample in 0..drive.len() {
            follower.state(sample, &mut state);
            lanes.look(sample, &state);
            for (row, output) in wanted.iter().enumerate() {
                values[row] = lanes.output(0, *output);
                for (seed, by) in changes.iter().enumerate() {
                    slopes[row * count + seed] = (lanes.output(seed + 1, *output) - values[row]) / by;
                }
            }
            follower.seen(
                sample,
                Seen { outputs: &values, slopes: &slopes, rates: lanes.rates() },
                &mut state,
            );
            if sample + 1 == drive.len() {
                return;
            }
            lanes.look(sample, &state);
            lanes.advance(sample, &mut pace);
            state.copy_from_slice(lanes.next(0));
            for (index, value) in state.iter().enumerate() {
                for (seed, by) in changes.iter().enumerate() {
                    advanced[index * count + seed] = (lanes.next(seed + 1)[index] - value) / by;
                }
            }
            follower.advanced(sample, &state, &advanced);
        }
    }

    fn check(&self, parameters: &[f64]) -> Result<(), String> {
        self.beside.check(&parameters[self.fmu.parameters.len()..])
    }
}
