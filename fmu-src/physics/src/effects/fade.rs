//! A damper that loses rate as it warms up.

use strut_model::{Real, Variables};

/// A damping rate that falls over time, `d (1 − α (1 − exp(−t/τ)))` (docs/effects.md, 10).
///
/// Time counts from zero; before it the damper is cold.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Fade<R> {
    /// Share of the damping rate that is lost in the end (α); zero switches it off
    #[var(unit = ONE, start = 0.0, max = 0.95)]
    pub ratio: R,
    /// Time over which it is lost (τ)
    #[var(unit = S, start = 100.0, min = 1e-3)]
    pub time: R,
}

impl<R: Real> Fade<R> {
    /// What of the damping rate `rate` is left at a time.
    #[inline]
    pub fn left_of(&self, rate: R, time: R) -> R {
        if self.ratio.vanishes() {
            return rate;
        }
        let lost = R::from(1.0) - (-time.max(R::from(0.0)) / self.time).exp();
        rate * (R::from(1.0) - self.ratio * lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn after_its_time_constant_63_percent_of_the_loss_are_there() {
        let fade = Fade { ratio: 0.5, time: 100.0 };
        assert_eq!((fade.left_of(1000.0, 0.0), fade.left_of(1000.0, -5.0)), (1000.0, 1000.0));
        let expected = 1000.0 * (1.0 - 0.5 * (1.0 - (-1.0_f64).exp()));
        assert!((fade.left_of(1000.0, 100.0) - expected).abs() < 1e-9);
        assert!((fade.left_of(1000.0, 1e5) - 500.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn a_damper_remains_a_damper(ratio in -1.0..0.95_f64, time in 0.0..1e4_f64) {
            let fade = Fade { ratio, time: 100.0 };
            prop_assert!(fade.left_of(1000.0, time) > 0.0);
        }

        #[test]
        fn without_ratio_it_is_absent(rate in 0.0..5e3_f64, time in 0.0..1e4_f64) {
            prop_assert_eq!(Fade { ratio: 0.0, time: 100.0 }.left_of(rate, time), rate);
        }
    }
}
