//! Laws that contain others: a richer one explains all that its limits do, and any explains what the model does without it.
//! Where a fit says otherwise, it is in a minimum of its own.

use rayon::prelude::*;

use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::estimation::unknowns::Estimate;
use crate::explain::selection::Proposal;

use super::{Tried, comparing, contains_by_name, parts};

/// Share of a screened amount from which a law that is made again starts: near the law that it contains.
const SLIGHTLY: f64 = 0.1;
/// Costs that differ by less are the same minimum.
const SAME_MINIMUM: f64 = 1e-3;

impl Baseline<'_> {
    /// Fits once more, from a limit's minimum, what leaves more than one of its limits does or than the model without it, and
    /// keeps what leaves less.
    pub(super) fn beside_their_limits(
        &self,
        base: &Fitted,
        null: &Fitted,
        screened: &[&Proposal],
        tried: &mut [Tried],
    ) {
        let again = tried.par_iter().zip(screened).map(|(it, screened)| {
            let start = self.beside(limit(null, it, tried)?, screened)?;
            let terms = self.terms_with(&null.terms, it.term);
            let fitted = self.fitted(&terms, &[start], comparing(base, null)).ok()?;
            (fitted.cost < cost(it)).then(|| self.weighed(base, null, it.term, Ok(fitted)))
        });
        let again: Vec<Option<Tried>> = again.collect();
        replace(tried, again);
    }

    /// Fits the limits of the law that leaves least once more, from its minimum without what it has alone, and keeps what leaves less: one
    /// of them may be all that it is.
    pub(super) fn limits_of_the_best(&self, base: &Fitted, null: &Fitted, tried: &mut [Tried]) {
        let Some(best) = tried.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))) else { return };
        let Ok(at) = &best.fitted else { return };
        let again = tried.par_iter().map(|it| {
            let terms =
                contains_by_name(best.term, it.term).then(|| self.terms_with(&null.terms, it.term))?;
            let own = self.own_coordinates(it.term).into_iter().map(|it| it.handle);
            let mut start = null.point.clone();
            for handle in parts(null).into_iter().chain(own) {
                start.set(handle, at.point.get(handle));
            }
            let fitted = self.fitted(&terms, &[start], comparing(base, null)).ok()?;
            (fitted.cost < cost(it)).then(|| self.weighed(base, null, it.term, Ok(fitted)))
        });
        let again: Vec<Option<Tried>> = again.collect();
        replace(tried, again);
    }

    /// Fits laws that contain a fitted one, from its minimum: a rough shape of a richer law may promise less than its limit.
    pub fn richer(&self, base: &Fitted, null: &Fitted, limit: &Tried, screened: &[Proposal]) -> Vec<Tried> {
        let Ok(at) = &limit.fitted else { return Vec::new() };
        let fit = |it: &Proposal| {
            let start = self.beside(at, it)?;
            let terms = self.terms_with(&null.terms, it.term);
            let fitted = self.fitted(&terms, &[start], comparing(base, null));
            Some(self.weighed(base, null, it.term, fitted))
        };
        screened.par_iter().filter_map(fit).collect()
    }

    /// Where a limit is, with a little of what a law has more.
    fn beside(&self, limit: &Fitted, screened: &Proposal) -> Option<Estimate> {
        let first = &screened.start;
        let mut start = limit.point.clone();
        let known = parts(limit);
        let own = self.own_coordinates(screened.term);
        for (number, coordinate) in own.iter().enumerate().filter(|(_, own)| !known.contains(&own.handle)) {
            let (before, value) = (start.get(coordinate.handle), first.get(coordinate.handle));
            // The first is the amount, the others are its shape.
            let share = if number == 0 { SLIGHTLY } else { 1.0 };
            start.set(coordinate.handle, before + share * (value - before));
        }
        Some(start)
    }
}

/// Keeps what was fitted again.
fn replace(tried: &mut [Tried], again: Vec<Option<Tried>>) {
    for (it, again) in tried.iter_mut().zip(again) {
        if let Some(again) = again {
            *it = again;
        }
    }
}

/// The best of a law's limits that are made of its own parameters, where it leaves less than the law.
fn limit<'a>(null: &'a Fitted, it: &Tried, tried: &'a [Tried]) -> Option<&'a Fitted> {
    let own = it.fitted.as_ref().map(parts).unwrap_or_default();
    let limits = tried.iter().filter(|other| contains_by_name(it.term, other.term));
    let limits = limits.filter_map(|other| other.fitted.as_ref().ok());
    let limits = limits.filter(|limit| parts(limit).is_subset(&own)).chain([null]);
    let best = limits.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    (best.cost * (1.0 + SAME_MINIMUM) < cost(it)).then_some(best)
}

fn cost(tried: &Tried) -> f64 {
    tried.fitted.as_ref().map_or(f64::INFINITY, |fitted| fitted.cost)
}
