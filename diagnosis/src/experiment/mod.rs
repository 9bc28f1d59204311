//! The deciding experiment: where rivals explain the records as well as the chosen effect, the excitation that separates them
//! best within limits of stroke, force, rate, frequency and time.
//!
//! Every excitation is simulated with the chosen model and each rival. The distance of two predictions counts in the errors
//! that the records have left, beyond what a wrong model can follow with its own parameters ([`separation`]).

mod bounds;
mod contest;
mod excitation;
pub mod separation;
mod shape;
mod table;

use rayon::prelude::*;

use crate::confirm::has_no_name;
use crate::diagnosis::Diagnosis;
use crate::estimation::hypothesis::{Fitted, Term};
use crate::report::findings::DecidingExperiment;

pub use bounds::{Bounds, InputBounds, Limits};
pub use contest::{Contest, Rival, Trial};
pub use excitation::{Excitation, Wave, excitations};
pub use separation::Separation;
pub use shape::Shape;
pub use table::{TABLE, files};

use separation::rank;
use shape::PROFILE;

/// Names of the files that an experiment is written to.
pub const FILES: [&str; 2] = [TABLE, PROFILE];

/// Excitations whose separations are computed with fitted rivals.
const FINALISTS: usize = 3;

impl<'a> Diagnosis<'a> {
    /// The chosen model and each of its rivals, fitted to the estimation records; none without rivals.
    ///
    /// # Errors
    /// If a rival's model refuses its settings or diverges.
    pub fn contest(&self, limits: Limits) -> Result<Option<Contest<'_>>, String> {
        let chosen = &self.found.extended;
        let ambiguous = self.found.accepted.iter().filter(|it| !has_no_name(it.term));
        let mut models = Vec::new();
        for (accepted, rival) in ambiguous.flat_map(|it| it.rivals.iter().map(move |rival| (it.term, *rival)))
        {
            if models.is_empty() {
                models.push(self.rival(accepted, accepted, chosen.clone())?);
            }
            let fitted = self.baseline.in_place_of(&self.found, accepted, rival)?;
            models.push(self.rival(rival, accepted, fitted)?);
        }
        let bounds = self.baseline.bounds(limits, chosen);
        Ok(Contest::new(&self.baseline, models, bounds))
    }

    fn rival(&self, term: Term, in_place_of: Term, fitted: Fitted) -> Result<Rival, String> {
        let dynamics = self.baseline.dynamics(&fitted.terms)?;
        Ok(Rival { term, in_place_of, fitted, dynamics })
    }

    /// The experiment that separates the chosen effects from their rivals best within the limits; none without rivals.
    ///
    /// # Errors
    /// If a rival's model refuses its settings or diverges.
    pub fn deciding_experiment(&self, limits: Limits) -> Result<Option<DecidingExperiment>, String> {
        let Some(contest) = self.contest(limits)? else { return Ok(None) };
        let all = excitations(&contest.bounds);
        let trials: Vec<Trial> = all.par_iter().filter_map(|it| contest.tried(it)).collect();
        let best = contest.best(&trials);
        Ok(Some(self.told(&contest, trials.len(), best.as_ref())))
    }
}

impl Contest<'_> {
    /// The best of the trials, the first ones with their rivals fitted.
    pub fn best(&self, trials: &[Trial]) -> Option<Trial> {
        let order = |a: &Trial, b: &Trial| {
            let [a, b] = [a, b].map(|it| rank(&it.separations));
            b.0.cmp(&a.0).then(b.1.total_cmp(&a.1))
        };
        let mut ranked: Vec<&Trial> = trials.iter().collect();
        ranked.sort_by(|a, b| order(a, b));
        let finalists: Vec<&Trial> = ranked.into_iter().take(FINALISTS).collect();
        let mut fitted: Vec<Trial> = finalists.par_iter().filter_map(|it| self.fitted(it)).collect();
        fitted.sort_by(order);
        fitted.into_iter().next()
    }
}
