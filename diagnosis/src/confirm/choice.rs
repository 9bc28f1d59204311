//! Which of the terms that pass a round is told, and which others would do.

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::decision::criteria::CRITERIA;
use crate::decision::evidence::Evidence;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::lsq::Stop;
use crate::estimation::unknowns::Unknown;

use super::weighing::LATE;
use super::{Tried, contains, has_no_name, parts};

impl Baseline<'_> {
    /// The best of those with a name that pass; without any, the best table.
    pub(super) fn chosen<'b>(&self, base: &Fitted, passing: &[&'b Tried]) -> Option<&'b Tried> {
        let named = passing.iter().find(|it| !has_no_name(it.term));
        named.map(|it| self.simplest(base, it, passing)).or_else(|| passing.first().copied())
    }

    /// One that is simpler than the best, a part of it with fewer parameters or at fewer places, unless what the best one adds
    /// to it passes the gates on its own.
    fn simplest<'b>(&self, base: &Fitted, best: &'b Tried, passing: &[&'b Tried]) -> &'b Tried {
        let mut chosen = best;
        for other in passing {
            let (Ok(fitted), Ok(simpler)) = (&chosen.fitted, &other.fitted) else { continue };
            let (more, fewer) = (self.claims(fitted), self.claims(simpler));
            let is_part = contains(chosen.term, other.term, &more, &fewer) && fewer.len() < more.len();
            if is_part || self.is_one_of(other.term, chosen.term) {
                let added = self.evidence(chosen.term, base, simpler, fitted);
                // Whether it is common does not matter beside a part of itself.
                if (Evidence { background: false, ..added }).refusal().is_some() {
                    chosen = other;
                }
            }
        }
        chosen
    }

    /// Unknowns of a fit that are claims about the rig. The usual timing of a channel is not: every fit has it, and with it a delay
    /// would be a part of a lag. One that is late beyond that is a claim, whichever term it comes with.
    fn claims(&self, fitted: &Fitted) -> BTreeSet<Unknown> {
        self.claimed(&fitted.terms, parts(fitted).into_iter().map(|it| (it, fitted.point.get(it))))
    }

    fn claimed(&self, terms: &[Term], changed: impl Iterator<Item = (Unknown, f64)>) -> BTreeSet<Unknown> {
        let is_claim = |(unknown, value): &(Unknown, f64)| {
            self.usual(*unknown).is_none_or(|deviation| value.abs() > LATE * deviation)
        };
        let own = terms.iter().flat_map(|term| self.own_coordinates(*term)).map(|it| it.handle);
        changed.filter(is_claim).map(|(unknown, _)| unknown).chain(own).collect()
    }

    /// Whether a fit explains the data as well as the best one.
    pub(crate) fn as_good(&self, base: &Fitted, best: &Fitted, other: &Fitted) -> bool {
        self.apart_by_events(best, other) < CRITERIA.paired_t
            || self.left(base, other) < CRITERIA.same * self.left(base, best)
    }

    /// A fit that is nearly as good as the best one, as closely as that one before they are told apart; another as it is.
    pub(super) fn closely(
        &self,
        base: &Fitted,
        fitted: Result<Fitted, String>,
        best: &Fitted,
    ) -> Result<Fitted, String> {
        let fitted = fitted?;
        if self.left(base, &fitted) < CRITERIA.near * self.left(base, best) {
            return self.fitted(&fitted.terms, std::slice::from_ref(&fitted.point), Stop::NOISY);
        }
        Ok(fitted)
    }

    /// Those that explain the data as well as the chosen one, or better and are only too common to be named, and are not the
    /// same with something more. What is nearly as good is fitted as closely as the chosen one
    /// before it is told apart.
    pub(super) fn rivals(
        &self,
        base: &Fitted,
        chosen: &Tried,
        close: &Fitted,
        passing: &[&Tried],
    ) -> Vec<Term> {
        let Ok(best) = &chosen.fitted else { return Vec::new() };
        let own = self.claims(best);
        let rival = |other: &&&Tried| {
            let Ok(fitted) = &other.fitted else { return false };
            let more = contains(other.term, chosen.term, &self.claims(fitted), &own);
            let fewer = self.is_one_of(other.term, chosen.term);
            if other.term == chosen.term || has_no_name(other.term) || more || fewer {
                return false;
            }
            let closer = self.closely(base, Ok(fitted.clone()), best);
            let closer_is = || closer.as_ref().is_ok_and(|it| self.as_good(base, close, it));
            let as_good = self.as_good(base, best, fitted) || closer_is();
            let fitted = closer.as_ref().unwrap_or(fitted);
            // If its amount may be zero, something that every fit has explains the data, as the usual timing of a channel.
            as_good && !self.is_another_law(other.term, fitted) && self.is_sized_in(other.term, fitted, base)
        };
        passing.par_iter().filter(rival).map(|it| it.term).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::split::Split;
    use crate::diagnosis::Options;
    use crate::rig::Rig;
    use crate::signal::distortion::Fault;

    #[test]
    fn a_delay_is_no_part_of_a_lag_though_every_fit_has_the_usual_one() {
        let rig = Rig::published("quarter-car").unwrap();
        let records = Split::of_nothing();
        let baseline = Baseline::new(&rig, &records, Options::default());
        let [delay, lag] = [Fault::Delay, Fault::Lag].map(|fault| Unknown::Output(0, fault));
        let mass = Unknown::Parameter(0);
        let with = |term: Unknown, changed: &[Unknown], late: f64| {
            baseline.claimed(&[Term::Fault(term)], changed.iter().map(|it| (*it, late)))
        };
        let (of_lag, of_delay) = (with(lag, &[mass, delay, lag], 1e-5), with(delay, &[mass, delay], 1e-5));
        assert_eq!((of_lag, of_delay), ([mass, lag].into(), [mass, delay].into()));
        // Beyond the usual timing, it is a delay and something more.
        assert_eq!(with(lag, &[mass, delay, lag], 9e-3), [mass, lag, delay].into());
    }
}
