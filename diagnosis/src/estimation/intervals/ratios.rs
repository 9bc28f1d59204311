//! What records disagree on where they tell only ratios.
//!
//! Without a force, masses, stiffnesses and dampings have a common scale that no record tells: each may move all of them. So
//! records are compared with one of these parameters the same in all of them.

use nalgebra::DVector;

use crate::decision::disagreement::{Wishes, yardstick};
use crate::estimation::hypothesis::Fitted;
use crate::estimation::unknowns::Unknown;

use super::excitations::{Excitation, Opinion, opinions, wishes};
use super::{Interval, is_of_parameter_set};

/// Lets records be compared at a common scale.
pub(super) fn compare(intervals: &mut [Interval], fitted: &Fitted, excitations: &[Excitation]) {
    let is_scaled = |it: &Interval| it.from_parameter_set && matches!(it.handle, Unknown::Parameter(_));
    let scaled: Vec<usize> = (0..intervals.len()).filter(|it| is_scaled(&intervals[*it])).collect();
    let left: Vec<usize> = scaled.iter().map(|held| untold(fitted, &scaled, *held)).collect();
    // Beside what has another scale, or none, nothing else is known any better.
    let Some(fewest) = left.iter().copied().min().filter(|it| it + 1 < scaled.len()) else { return };
    let candidates = scaled.into_iter().zip(left).filter(|(_, left)| *left == fewest).map(|(held, _)| held);
    let beside = |held: usize| -> (usize, Vec<Wishes>) {
        let said = opinions(excitations, Some(held));
        let of = |(index, interval): (usize, &Interval)| {
            let own: Vec<Opinion> = said.iter().map(|excitation| excitation[index]).collect();
            (interval.value, wishes(interval.value, &own))
        };
        (held, intervals.iter().enumerate().map(of).collect())
    };
    let all: Vec<(usize, Vec<Wishes>)> = candidates.map(beside).collect();
    let Some(held) = yardstick(&all) else { return };
    let (handle, chosen) = (intervals[held].handle, all.into_iter().find(|(it, _)| *it == held));
    for (interval, (_, wishes)) in intervals.iter_mut().zip(chosen.map_or(vec![], |(_, it)| it)) {
        (interval.wishes, interval.yardstick) = (wishes, Some(handle));
    }
}

/// How many of these coordinates the data do not tell although another one is held.
fn untold(fitted: &Fitted, coordinates: &[usize], held: usize) -> usize {
    let linear = fitted.linear.without(held);
    let rest = |all: &[DVector<f64>]| -> Vec<DVector<f64>> {
        all.iter().map(|it| it.clone().remove_row(held)).collect()
    };
    let own = linear.robust_covariance(&rest(&fitted.trace.scores));
    let before = linear.sandwich(&rest(&fitted.priors(false)));
    let is_untold = |index: &&usize| {
        let at = *index - usize::from(**index > held);
        let variances = || [&before, &own].map(|it| it[(at, at)]);
        **index != held && is_of_parameter_set(&fitted.coordinates[**index], &fitted.point, variances())
    };
    coordinates.iter().filter(is_untold).count()
}
