//! How a least-squares fit starts, and when it stops.

use std::time::Instant;

/// How to start and when to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Damping of the first step: the larger, the more careful.
    pub damping: f64,
    /// Linearisations at most.
    pub iterations: usize,
    /// Relative fall of the cost below which it ends.
    pub cost: f64,
    /// Change of the residuals that a step may make, in shares of the residuals, below which it ends.
    pub step: f64,
    /// Cost that has to come in sight: it ends where neither the linearisation has its minimum below, nor as many steps as
    /// are left lead there if each gains as much as the last one.
    pub below: f64,
    /// When it ends at the latest, with a step behind it.
    pub until: Option<Instant>,
}

impl Stop {
    /// To the last digit.
    pub const EXACT: Self =
        Self { damping: 100.0, iterations: 2000, cost: 0.0, step: 1e-14, below: f64::INFINITY, until: None };
    /// As closely as noise deserves.
    pub const NOISY: Self =
        Self { damping: 1e-3, iterations: 30, cost: 1e-5, step: 1e-6, below: f64::INFINITY, until: None };
    /// Well enough to compare effects.
    pub const ROUGH: Self =
        Self { damping: 1e-3, iterations: 10, cost: 2e-3, step: 1e-4, below: f64::INFINITY, until: None };

    /// Whether the time is up.
    pub(super) fn is_late(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }
}
