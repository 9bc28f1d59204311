//! A model of another maker on its way through a record, by the classical Runge–Kutta method.

use nalgebra::DMatrix;

use crate::Drive;
use crate::pace::{ACCURATE, LONGEST_STEP, MOST_STEPS, Pace};

use super::beside::{Beside, Set};
use super::crossing::{between, root};
use super::exchange::Session;

/// Events in a step beyond which the rest of it is made in one go.
const MOST_EVENTS: usize = 30;

/// An instance with the elements beside it.
pub struct Walk<'a> {
    session: Session,
    beside: (&'a Beside, Set),
    /// How many states are the instance's.
    own: usize,
    /// Time of the first sample in the record, for the elements.
    start: f64,
    /// Inputs as they are given, and with the elements' forces.
    given: Vec<f64>,
    given_on_the_way: Given<'a>,
    inputs: Vec<f64>,
    /// Slopes of a step's stages, and at its end.
    slopes: [Vec<f64>; 5],
    middle: Vec<f64>,
    /// Memory of states and rates that is used again.
    next: Vec<f64>,
    unused: Vec<f64>,
    before: Vec<f64>,
}

/// Inputs between the samples, in the order in which a run without events asks for them: interpolating them takes longer than many a
/// model's equations.
pub enum Given<'a> {
    /// Not kept.
    Anew,
    /// Kept for further runs in the same steps.
    Kept(Vec<f64>),
    /// Those of an earlier run that are still to come.
    Again(&'a [f64]),
}

/// The way between two samples; positions on it are counted in steps.
pub struct Way<'w> {
    pub sample: usize,
    pub steps: usize,
    pub drive: &'w Drive,
    /// An input at a share of the way.
    pub input: &'w dyn Fn(usize, f64) -> f64,
}

impl Way<'_> {
    /// Time of a position since the first sample.
    fn time(&self, position: f64) -> f64 {
        (self.sample as f64 + position / self.steps as f64) * self.drive.step
    }

    fn position(&self, time: f64) -> f64 {
        (time / self.drive.step - self.sample as f64) * self.steps as f64
    }

    /// Time that a step takes.
    fn size(&self) -> f64 {
        self.drive.step / self.steps as f64
    }
}

impl<'a> Walk<'a> {
    /// Of an instance whose parameters are set.
    pub fn new(session: Session, beside: (&'a Beside, Set), states: usize, start: f64) -> Self {
        let own = states - beside.0.states.len();
        let slopes = std::array::from_fn(|_| vec![0.0; states]);
        Self {
            session,
            beside,
            own,
            start,
            given: Vec::new(),
            given_on_the_way: Given::Anew,
            inputs: Vec::new(),
            slopes,
            middle: vec![0.0; states],
            next: vec![0.0; states],
            unused: vec![0.0; states],
            before: vec![0.0; states],
        }
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
        self.given.clear();
        self.given.extend((0..inputs).map(input));
        self.look_given(time, state, rates, outputs);
    }

    /// The same with the inputs that were given last.
    fn look_given(&mut self, time: f64, state: &[f64], rates: &mut [f64], outputs: Option<&mut [f64]>) {
        self.place(time, state, rates);
        let (rates, _) = rates.split_at_mut(self.own);
        // Outputs first: after rates, OpenModelica's FMUs take outputs that follow from states for known, and give old ones.
        if let Some(outputs) = outputs {
            self.session.outputs(outputs);
        }
        self.session.rates(rates);
    }

    /// Puts it at a time with the inputs that were given last, and computes the rates of the elements' memory there.
    fn place(&mut self, time: f64, state: &[f64], rates: &mut [f64]) {
        self.inputs.clone_from(&self.given);
        let (own, memory) = state.split_at(self.own);
        self.session.place(time, own, &self.inputs);
        let (_, of_memory) = rates.split_at_mut(self.own);
        let (beside, set) = &self.beside;
        beside.act(set, self.start + time, &mut self.session, (&mut self.inputs, memory, of_memory));
    }

    /// Gives the inputs at a position between two samples.
    fn give(&mut self, way: &Way<'_>, position: f64) {
        let (share, inputs) = (position / way.steps as f64, way.drive.inputs.len());
        self.given.clear();
        if let Given::Again(rest) = &mut self.given_on_the_way {
            let (next, further) = rest.split_at(inputs);
            self.given.extend_from_slice(next);
            *rest = further;
            return;
        }
        self.given.extend((0..inputs).map(|i| (way.input)(i, share)));
        if let Given::Kept(all) = &mut self.given_on_the_way {
            all.extend_from_slice(&self.given);
        }
    }

    /// Takes or keeps inputs between the samples; gives what was kept.
    pub fn give_on_the_way(&mut self, given: Given<'a>) -> Given<'a> {
        std::mem::replace(&mut self.given_on_the_way, given)
    }

    /// The slopes of a stage, at a position between two samples whose inputs are given.
    fn look_there(&mut self, way: &Way<'_>, position: f64, state: &[f64], stage: usize) {
        let mut slopes = std::mem::take(&mut self.slopes[stage]);
        self.look_given(way.time(position), state, &mut slopes, None);
        self.slopes[stage] = slopes;
    }

    /// The slopes of a stage, at a position between two samples.
    fn look_on(&mut self, way: &Way<'_>, position: f64, state: &[f64], stage: usize) {
        self.give(way, position);
        self.look_there(way, position, state, stage);
    }

    /// Puts it at a position between two samples.
    fn put(&mut self, way: &Way<'_>, position: f64, state: &[f64]) {
        let mut unused = std::mem::take(&mut self.unused);
        self.give(way, position);
        self.place(way.time(position), state, &mut unused);
        self.unused = unused;
    }

    /// Goes from a sample to the next in as many steps as the pace asks for, and the elements' memory; gives their number. Where a step
    /// was too long, all are repeated, unless there may be events. Events are handled as by [`Self::advance`].
    pub fn advance_at(
        &mut self,
        pace: &mut Pace,
        (sample, drive, input): (usize, &Drive, &dyn Fn(usize, f64) -> f64),
        (state, first, outputs): (&mut [f64], &[f64], &[f64]),
        to_events: bool,
    ) -> usize {
        let mut before = std::mem::take(&mut self.before);
        before.copy_from_slice(state);
        // An event cannot be undone, so that no step may turn out too long.
        if self.has_events() {
            pace.tighten();
        }
        state.iter().enumerate().for_each(|(index, value)| pace.reach_value(index, *value));
        let (beside, set) = &self.beside;
        let least = beside.steps(set, drive.step, outputs).min(MOST_STEPS as usize);
        let kept = if let Given::Kept(all) = &self.given_on_the_way { all.len() } else { 0 };
        let made = loop {
            pace.steps = pace.steps.max(least);
            let way = Way { sample, steps: pace.steps, drive, input };
            let need = self.advance(&way, state, first, to_events, Some(pace));
            if !pace.refuse(need) {
                break way.steps;
            }
            state.copy_from_slice(&before);
            if let Given::Kept(all) = &mut self.given_on_the_way {
                all.truncate(kept);
            }
        };
        self.before = before;
        made
    }

    /// Goes from a sample to the next; `first` are the rates there. Events on the way are handled where they are, `to_events`, or
    /// not at all. The largest need of the steps at a pace, as [`Pace::need`].
    pub fn advance(
        &mut self,
        way: &Way<'_>,
        state: &mut [f64],
        first: &[f64],
        to_events: bool,
        pace: Option<&Pace>,
    ) -> f64 {
        let to_events = to_events && self.has_events();
        // An event moves the positions at which inputs are asked for.
        if to_events {
            self.given_on_the_way = Given::Anew;
        }
        let (mut next, mut need) = (std::mem::take(&mut self.next), 0.0_f64);
        self.slopes[0].copy_from_slice(first);
        for part in 0..way.steps {
            let from = part as f64;
            if to_events {
                self.through_events(way, from, state, &mut next);
                continue;
            }
            if part > 0 {
                self.look_on(way, from, state, 0);
            }
            self.step(way, (from, from + 1.0), state, &mut next);
            if let Some(pace) = pace {
                let slopes = |state: usize| std::array::from_fn(|stage| self.slopes[stage][state]);
                need = need.max(pace.need_of(way.size(), (0..next.len()).map(slopes)));
            }
            state.copy_from_slice(&next);
        }
        self.next = next;
        need
    }

    fn has_events(&self) -> bool {
        self.session.indicates() || self.session.next_event().is_finite()
    }

    /// A step of the classical method between two positions, from the slopes at the first.
    fn step(&mut self, way: &Way<'_>, (from, to): (f64, f64), state: &[f64], next: &mut [f64]) {
        let h = (to - from) * way.size();
        let mut middle = std::mem::take(&mut self.middle);
        for (stage, offset) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
            let position = from + offset * (to - from);
            for ((middle, state), slope) in middle.iter_mut().zip(state).zip(&self.slopes[stage - 1]) {
                *middle = state + offset * h * slope;
            }
            // Both stages in the middle have the same inputs.
            if stage != 2 {
                self.give(way, position);
            }
            self.look_there(way, position, &middle, stage);
        }
        self.middle = middle;
        for (index, (next, state)) in next.iter_mut().zip(state).enumerate() {
            let [k1, k2, k3, k4] = [0, 1, 2, 3].map(|stage: usize| self.slopes[stage][index]);
            *next = state + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        }
    }

    /// A step that ends at each event within it, and goes on behind; `next` is memory for its ends.
    fn through_events(&mut self, way: &Way<'_>, from: f64, state: &mut [f64], next: &mut [f64]) {
        let (mut at, end) = (from, from + 1.0);
        for event in 0.. {
            let may = event < MOST_EVENTS;
            let due = Some(way.position(self.session.next_event())).filter(|it| may && *it > at && *it < end);
            let mut to = due.unwrap_or(end);
            self.step(way, (at, to), state, next);
            self.look_on(way, to, next, 4);
            self.session.sense();
            if let Some(index) = self.session.crossed().filter(|_| may) {
                to = self.located(way, (at, to), (state, next), index);
            }
            state.copy_from_slice(next);
            if self.session.settle(way.time(to), &mut state[..self.own]) {
                self.look_on(way, to, state, 0);
            } else {
                self.slopes.swap(0, 4);
            }
            if to >= end {
                return;
            }
            at = to;
        }
    }

    /// The place on a step where the first indicator crosses zero; `next` becomes the state there instead of at the step's end.
    fn located(
        &mut self,
        way: &Way<'_>,
        (from, to): (f64, f64),
        (state, next): (&[f64], &mut [f64]),
        mut index: usize,
    ) -> f64 {
        let mut middle = std::mem::take(&mut self.middle);
        let end = std::mem::take(&mut self.slopes[4]);
        let (h, mut last) = ((to - from) * way.size(), 1.0);
        // Each place is before the last one, so that this ends.
        loop {
            last = root(self.session.indicator(index), last, |share| {
                for (row, middle) in middle.iter_mut().enumerate() {
                    let ends = [state[row], next[row]];
                    *middle = between(share, ends, [h * self.slopes[0][row], h * end[row]]);
                }
                self.put(way, from + share * (to - from), &middle);
                self.session.sense();
                self.session.indicator(index).1
            });
            match self.session.crossed() {
                Some(earlier) if earlier != index => index = earlier,
                _ => break,
            }
        }
        next.copy_from_slice(&middle);
        self.middle = middle;
        self.slopes[4] = end;
        from + last * (to - from)
    }

    /// Takes a sample where it was looked at as the end of a step; whether there was an event, so that states and rates may have
    /// jumped.
    pub fn settle(&mut self, time: f64, state: &mut [f64]) -> bool {
        self.session.sense();
        self.session.settle(time, &mut state[..self.own])
    }

    /// The pace between samples: as many steps as the fastest mode about a state needs, where friction is stiffest, and fewer where it
    /// slides.
    pub fn pace(&mut self, state: &[f64], drive: &Drive) -> Pace {
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
        let steps =
            |rate: f64| (drive.step * rate.max(1.0 / LONGEST_STEP)).ceil().clamp(1.0, MOST_STEPS) as usize;
        Pace::between(steps(0.0), steps(fastest / ACCURATE), states)
    }
}
