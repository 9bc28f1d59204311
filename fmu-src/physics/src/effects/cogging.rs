//! A force that repeats itself over the stroke.

use std::f64::consts::TAU;

use strut_model::{Real, Variables};

/// Cogging of a linear motor, or the error of a spindle's pitch (docs/effects.md, 27): `F = A sin(2π x/p + φ)`.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Cogging<R> {
    /// Amplitude (A); zero switches it off
    #[var(unit = N, start = 0.0)]
    pub force: R,
    /// Stroke after which it repeats itself (p)
    #[var(unit = M, start = 0.024, min = 1e-5)]
    pub period: R,
    /// Phase at position zero (φ)
    #[var(unit = RAD, start = 0.0)]
    pub phase: R,
}

impl<R: Real> Cogging<R> {
    /// The force against positive positions at a position.
    #[inline]
    pub fn force(&self, position: R) -> R {
        if self.force.vanishes() {
            return self.force;
        }
        self.force * (position / self.period * TAU + self.phase).sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COGGING: Cogging<f64> = Cogging { force: 6.0, period: 0.024, phase: 0.3 };

    #[test]
    fn a_quarter_of_the_period_takes_it_from_zero_to_its_amplitude() {
        let motor = Cogging { phase: 0.0, ..COGGING };
        assert_eq!(motor.force(0.0), 0.0);
        assert!((motor.force(0.006) - 6.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn it_repeats_itself_and_does_no_work_over_a_period(x in -0.2..0.2_f64) {
            prop_assert!((COGGING.force(x) - COGGING.force(x + 0.024)).abs() < 1e-9);
            prop_assert!((COGGING.force(x) + COGGING.force(x + 0.012)).abs() < 1e-9);
        }

        #[test]
        fn without_force_it_is_absent(x in -0.2..0.2_f64) {
            prop_assert_eq!(Cogging { force: 0.0, ..COGGING }.force(x), 0.0);
        }
    }
}
