//! A model and changed versions of it, each one sample ahead of the same state: what derivatives of predictions are made of.

use crate::Drive;
use crate::pace::Pace;

use super::beside::Set;
use super::differences::{Changed, Differences};
use super::walk::{Walk, Way};

/// The model as it is, then its changed versions.
pub struct Lanes<'a> {
    drive: &'a Drive,
    walks: Vec<Walk<'a>>,
    lanes: Vec<Lane<'a>>,
}

struct Lane<'a> {
    changed: Changed<'a>,
    set: Set,
    /// Which of the walks it goes: all that have the model's own parameters share one.
    walk: usize,
    from: Vec<f64>,
    rates: Vec<f64>,
    outputs: Vec<f64>,
    next: Vec<f64>,
}

impl<'a> Lanes<'a> {
    /// None if the model refuses the parameters of one of them.
    pub fn new(
        model: &'a Differences,
        all: impl Iterator<Item = Changed<'a>>,
        drive: &'a Drive,
    ) -> Option<Self> {
        let own = model.fmu.parameters.len();
        let (mut walks, mut lanes) = (Vec::new(), Vec::<Lane<'a>>::new());
        for changed in all {
            let same = |first: &Lane<'_>| first.changed.parameters[..own] == changed.parameters[..own];
            let walk = if lanes.first().is_some_and(same) {
                0
            } else {
                walks.push(model.walk(&changed.parameters, drive.start)?);
                walks.len() - 1
            };
            let set = model.beside.set(&changed.parameters[own..]);
            let none = vec![0.0; changed.start.len()];
            let outputs = vec![0.0; model.fmu.outputs.len()];
            lanes.push(Lane {
                changed,
                set,
                walk,
                from: none.clone(),
                rates: none.clone(),
                outputs,
                next: none,
            });
        }
        Some(Self { drive, walks, lanes })
    }

    /// The pace between samples that the model asks for.
    pub fn pace(&mut self, state: &[f64]) -> Option<Pace> {
        self.walks.first_mut().map(|walk| walk.pace(state, self.drive))
    }

    /// Puts all of them in a state at a sample, each with its own change, and computes rates and outputs there.
    pub fn look(&mut self, sample: usize, state: &[f64]) {
        let Self { drive, walks, lanes } = self;
        let mut seen = 0;
        for lane in lanes {
            let walk = &mut walks[lane.walk];
            walk.exchange(&mut lane.set);
            let changes = state.iter().zip(&lane.changed.start);
            lane.from.iter_mut().zip(changes).for_each(|(from, (state, change))| *from = state + change);
            let input = |i: usize| lane.changed.input(drive, i, sample, 0.0);
            let time = sample as f64 * drive.step;
            let inputs = drive.inputs.len();
            walk.look(time, &lane.from, (&input, inputs), &mut lane.rates, Some(&mut lane.outputs));
            let is_first = lane.walk == seen;
            // States that jump are the follower's to set.
            lane.next.copy_from_slice(&lane.from);
            if is_first && walk.settle(time, &mut lane.next) {
                walk.look(time, &lane.from, (&input, inputs), &mut lane.rates, Some(&mut lane.outputs));
            }
            seen += usize::from(is_first);
            walk.exchange(&mut lane.set);
        }
    }

    /// Goes to the next sample from where they are. All make the same number of steps: what the pace of the model as it is, the first
    /// of them, asks for there.
    pub fn advance(&mut self, sample: usize, pace: &mut Pace) {
        let Self { drive, walks, lanes } = self;
        let mut made = None;
        for lane in lanes {
            let walk = &mut walks[lane.walk];
            walk.exchange(&mut lane.set);
            lane.next.copy_from_slice(&lane.from);
            let input = |i: usize, share: f64| lane.changed.input(drive, i, sample, share);
            // Lanes that share a walk share its events, which are those of the model as it is at the samples.
            if let Some(steps) = made {
                walk.advance(
                    &Way { sample, steps, drive, input: &input },
                    &mut lane.next,
                    &lane.rates,
                    false,
                    None,
                );
            } else {
                let from = (&mut lane.next[..], &lane.rates[..], &lane.outputs[..]);
                made = Some(walk.advance_at(pace, (sample, drive, &input), from, false));
            }
            walk.exchange(&mut lane.set);
        }
    }

    /// An output of one of them.
    pub fn output(&self, lane: usize, index: usize) -> f64 {
        self.lanes[lane].outputs[index]
    }

    /// The rates of the model as it is.
    pub fn rates(&self) -> &[f64] {
        &self.lanes[0].rates
    }

    /// The states of one of them at the next sample.
    pub fn next(&self, lane: usize) -> &[f64] {
        &self.lanes[lane].next
    }
}
