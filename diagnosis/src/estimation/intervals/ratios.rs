//! What records disagree on where they tell only ratios.
//!
//! Without a force, masses, stiffnesses and dampings have a common scale that no record tells: each may move all of them. So
//! records are compared with one of these parameters the same in all of them.

use crate::decision::disagreement::{Wishes, yardstick};

use super::Interval;
use super::excitations::{Excitation, Opinion, opinions, wishes};

/// Lets records be compared at a common scale of some of the coordinates.
pub(super) fn compare(intervals: &mut [Interval], scaled: &[usize], excitations: &[Excitation]) {
    let beside = |held: &usize| -> (usize, Vec<Wishes>) {
        let said = opinions(excitations, Some(*held));
        let of = |(index, interval): (usize, &Interval)| {
            let own: Vec<Opinion> = said.iter().map(|excitation| excitation[index]).collect();
            (interval.value, wishes(interval.value, &own))
        };
        (*held, intervals.iter().enumerate().map(of).collect())
    };
    let all: Vec<(usize, Vec<Wishes>)> = scaled.iter().map(beside).collect();
    let Some(held) = yardstick(&all) else { return };
    let (handle, chosen) = (intervals[held].handle, all.into_iter().find(|(it, _)| *it == held));
    for (interval, (_, wishes)) in intervals.iter_mut().zip(chosen.map_or(vec![], |(_, it)| it)) {
        (interval.wishes, interval.yardstick) = (wishes, Some(handle));
    }
}
