//! The states at the start of each section, the parameters being what they are.

use std::ops::Range;

use rayon::prelude::*;

use crate::dataset::recorded::Dataset;
use crate::estimation::unknowns::Estimate;

use super::Fit;
use super::normal::Section;

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
            let Section { cost, elimination, .. } = self.section(point, &start, record, section, (&[], &[]));
            if elimination.fall < SETTLED * cost {
                break;
            }
            let step = elimination.constant;
            let tried = (0..=HALVINGS).map(|halvings| {
                let mut moved = start.clone();
                for (state, change) in self.states.iter().zip(step.iter()) {
                    moved[*state] -= change * 0.5_f64.powi(halvings);
                }
                (self.section_cost(point, &moved, record, section), moved)
            });
            let Some((better, moved)) = tried.into_iter().find(|(better, _)| *better < cost) else { break };
            start = moved;
            if cost - better < SETTLED * cost {
                break;
            }
        }
        start
    }
}
