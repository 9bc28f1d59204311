//! Signals that are later than any measurement makes them, or causes that make them seem so: what friction holds follows late,
//! and a fit that may choose each signal's delay chooses that.

use crate::estimation::fit::Point;
use crate::estimation::hypothesis::{Term, World};

use super::choice::LITTLE_MORE;
use super::{Accepted, Found};

impl World<'_> {
    /// Whether a signal is told to be late, whatever the cause, or is later than any measurement makes it.
    pub fn anything_late(&self, found: &Found, rooted: &[Accepted]) -> bool {
        let told = found.accepted.iter().chain(rooted).any(|it| it.term.delays());
        told || self.late(&found.extended) > 0
    }

    /// A point with every signal in time.
    pub fn in_time(&self, point: &Point) -> Point {
        let mut punctual = point.clone();
        for coordinate in self.coordinates(&[]) {
            if self.usual(coordinate.handle).is_some() {
                punctual.set(coordinate.handle, 0.0);
            }
        }
        punctual
    }

    /// Whether what was found with every signal in time has names, and leaves little more than what was found with some that
    /// are late; of a signal whose sensor has a response without a name, in that signal, where alone it shows.
    pub fn does_without_lateness(&self, late: &Found, punctual: &Found) -> bool {
        let named = |it: &Accepted| matches!(it.term, Term::Cause(_));
        let left = |it: &Found| self.left(&late.base, &it.extended);
        let answered = late.accepted.iter().all(|it| {
            let Term::Response(output) = it.term else { return true };
            let left = |it: &Found| self.left_of(output, &late.base, &it.extended);
            left(punctual) < LITTLE_MORE * left(late)
        });
        punctual.accepted.iter().any(named) && left(punctual) < LITTLE_MORE * left(late) && answered
    }
}
