//! The states at the start of each section, the parameters being what they are.

use std::ops::Range;

use nalgebra::DVector;
use rayon::prelude::*;

use crate::dataset::recorded::Dataset;
use crate::estimation::unknowns::Estimate;

use super::Fit;
use super::normal::{Elimination, Section};

/// Steps at most.
const STEPS: usize = 6;
/// Halvings of a step that leads uphill.
const HALVINGS: i32 = 4;
/// Relative fall of the cost below which they have settled.
const SETTLED: f64 = 1e-5;

impl Fit<'_> {
    /// The same point with the states at the start of each section that fit best.
    pub fn settled(&self, point: Estimate) -> Estimate {
        let (plant, dynamics, records) = (self.plant, self.dynamics, self.records);
        let bare = Self::new(plant, dynamics, records, Vec::new(), self.sigma.clone());
        let sections = bare.sections().into_par_iter();
        let starts = sections.map(|(index, record, section)| {
            bare.settled_section(&point, point.starts[index].clone(), record, section)
        });
        Estimate { starts: starts.collect(), ..point }
    }

    /// Gauss and Newton's steps in one section, each as long as it leads downhill.
    fn settled_section(
        &self,
        point: &Estimate,
        mut start: Vec<f64>,
        record: &Dataset,
        section: &Range<usize>,
    ) -> Vec<f64> {
        for _ in 0..STEPS {
            let Section { elimination, .. } = self.section(point, &start, record, section, (&[], &[]));
            if elimination.is_settled() {
                break;
            }
            let Some((cost, share)) = self.downhill(point, &start, (record, section), &elimination) else {
                break;
            };
            start = self.gone(&start, &(share * &elimination.constant));
            if elimination.cost - cost < SETTLED * elimination.cost {
                break;
            }
        }
        start
    }

    /// The cost of a section after its own step, and the share of the step that leads there; none if it leads uphill.
    fn downhill(
        &self,
        point: &Estimate,
        start: &[f64],
        (record, section): (&Dataset, &Range<usize>),
        elimination: &Elimination,
    ) -> Option<(f64, f64)> {
        let shares = (0..=HALVINGS).map(|halvings| 0.5_f64.powi(halvings));
        let tried = shares.map(|share| {
            let gone = self.gone(start, &(share * &elimination.constant));
            (self.section_cost(point, &gone, record, section), share)
        });
        tried.into_iter().find(|(cost, _)| *cost < elimination.cost)
    }

    /// States at a start after a step of those that are estimated.
    pub(super) fn gone(&self, start: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let mut gone = start.to_vec();
        for (state, change) in self.states.iter().zip(step.iter()) {
            gone[*state] -= change;
        }
        gone
    }

    /// Each section's own step as far as it leads downhill. Where a body sticks, its start hardly shows: there the linearisation may
    /// lead anywhere, and with it every step of the coordinates.
    pub(super) fn hold_sections_back(&self, point: &Estimate, eliminations: &mut [Elimination]) {
        let sections = self.sections().into_par_iter().zip(eliminations);
        sections.for_each(|((index, record, section), it)| {
            let downhill = || self.downhill(point, &point.starts[index], (record, section), it);
            let share = if it.is_settled() { None } else { downhill() };
            it.constant *= share.map_or(0.0, |(_, share)| share);
        });
    }
}

impl Elimination {
    /// Whether the states are where they fit best.
    fn is_settled(&self) -> bool {
        self.fall < SETTLED * self.cost
    }
}
