//! Causes are compared to a model without them at its best. A fit may stop in a minimum of its own; where one with a cause has
//! come to other values of everything else that do better without the cause, too, what it gains is not the cause's.

use std::slice::from_ref;

use rayon::prelude::*;

use crate::estimation::fit::Point;
use crate::estimation::hypothesis::{Fitted, World};
use crate::estimation::lsq::Stop;

use super::Tried;

/// Causes from whose fits it is tried.
const LEADING: usize = 2;
/// Share of the cost by which another minimum is a better one …
const BETTER: f64 = 0.02;
/// … and of what they gain, that is gained without them.
const MOSTLY: f64 = 0.5;

impl World<'_> {
    /// A fit without any of the tried causes that gains most of what the best of them do, started from where these have come to.
    pub(super) fn resettled(&self, null: &Fitted, tried: &[Tried]) -> Option<Fitted> {
        let without = |it: &Tried| -> Option<Point> {
            let mut point = null.point.clone();
            let fitted = it.fitted.as_ref().ok()?;
            point.starts.clone_from(&fitted.point.starts);
            for coordinate in &null.coordinates {
                point.set(coordinate.handle, fitted.point.get(coordinate.handle));
            }
            Some(point)
        };
        let starts: Vec<Point> = tried.iter().filter_map(without).take(LEADING).collect();
        let costs = tried.iter().filter_map(|it| Some(it.fitted.as_ref().ok()?.cost)).take(LEADING);
        let gained = null.cost - costs.fold(null.cost, f64::min);
        let rough = self.fitted(&null.terms, &starts, Stop::ROUGH).ok()?;
        if null.cost - rough.cost < (MOSTLY * gained).max(BETTER * null.cost) {
            return None;
        }
        self.fitted(&null.terms, from_ref(&rough.point), Stop::NOISY).ok()
    }

    /// What was tried, beside another fit without it. That one is close; so are they now, or they would be no match for it.
    pub(super) fn weighed_again(&self, base: &Fitted, null: &Fitted, tried: Vec<Tried>) -> Vec<Tried> {
        let again = |it: Tried| {
            let close = |rough: Fitted| self.fitted(&rough.terms, from_ref(&rough.point), Stop::NOISY);
            self.weighed(base, null, it.term, it.fitted.and_then(close))
        };
        let mut tried: Vec<Tried> = tried.into_par_iter().map(again).collect();
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        tried
    }
}
