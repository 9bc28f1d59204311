//! A mass alone on its springs.

use std::f64::consts::TAU;

use strut_model::{Real, Variables};

/// A mass that moves alone, as TUM's Tables 7, 9 and 10 have it.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Mode<R> {
    /// Undamped natural frequency, uncoupled
    #[var(unit = HZ)]
    pub natural_frequency: R,
    /// Damping ratio, uncoupled
    #[var(unit = ONE)]
    pub damping_ratio: R,
}

impl<R: Real> Mode<R> {
    /// `√(k/m)/2π` and `d/(2√(k m))`. The tables use the strut's damping with the stiffness of both springs for a
    /// wheel's ratio, and the tyre's alone for its frequency.
    pub fn of(mass: R, frequency_stiffness: R, ratio_stiffness: R, damping: R) -> Self {
        Self {
            natural_frequency: (frequency_stiffness / mass).sqrt() / TAU,
            damping_ratio: damping / ((ratio_stiffness * mass).sqrt() * 2.0),
        }
    }
}
