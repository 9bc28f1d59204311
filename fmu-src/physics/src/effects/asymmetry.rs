//! A damper that is stiffer in one direction than in the other.

use strut_model::{Real, Variables};

/// Different damping rates in rebound and compression, joined smoothly.
///
/// TUM Fig. 15 shows the characteristic, which is lost; Table 9 gives its two rates, compression d₋ and
/// rebound d₊. Two straight lines with those slopes are `d (v + α |v|)` with the mean rate
/// `d = (d₊ + d₋)/2` and `ratio` α = (d₊ − d₋)/(d₊ + d₋). The corner at rest is rounded here over the
/// velocity `smoothing` = ε, `|v| → √(v² + ε²) − ε`, so that derivatives exist; this is derived, not printed.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Asymmetry<R> {
    /// Difference of the rates in rebound and compression over their sum (α); zero switches the asymmetry off
    #[var(unit = ONE, start = 0.0, min = -0.99, max = 0.99)]
    pub ratio: R,
    /// Velocity over which the rates change into one another (ε)
    #[var(unit = M_PER_S, start = 0.005, min = 1e-6)]
    pub smoothing: R,
}

impl<R: Real> Asymmetry<R> {
    /// The velocity that a symmetric damper would need for the same force.
    #[inline]
    pub fn effective(&self, velocity: R) -> R {
        if self.ratio.vanishes() {
            return velocity;
        }
        velocity + self.ratio * ((velocity.squared() + self.smoothing.squared()).sqrt() - self.smoothing)
    }

    /// The velocity of which `effective` is made.
    ///
    /// Of `(w − u)² = α² (u² + ε²)` with w = effective + α ε it is the root that is zero where `effective` is.
    #[inline]
    pub fn velocity_of(&self, effective: R) -> R {
        if self.ratio.vanishes() {
            return effective;
        }
        let shifted = effective + self.ratio * self.smoothing;
        let remainder = R::from(1.0) - self.ratio.squared();
        let root = (shifted.squared() + remainder * self.smoothing.squared()).sqrt();
        (shifted - self.ratio * root) / remainder
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 9, measured.
    const COMPRESSION: f64 = 521.0;
    const REBOUND: f64 = 994.0;

    fn measured() -> Asymmetry<f64> {
        Asymmetry { ratio: (REBOUND - COMPRESSION) / (REBOUND + COMPRESSION), smoothing: 0.005 }
    }

    #[test]
    fn fast_motion_sees_the_rates_of_table_9() {
        let mean = 0.5 * (REBOUND + COMPRESSION);
        let slope = |v: f64| mean * (measured().effective(v + 1e-4) - measured().effective(v - 1e-4)) / 2e-4;
        assert!((slope(0.5) - REBOUND).abs() < 0.02);
        assert!((slope(-0.5) - COMPRESSION).abs() < 0.02);
    }

    proptest! {
        #[test]
        fn it_takes_energy_and_grows_with_velocity(v in -5.0..5.0_f64, ratio in -0.99..0.99_f64) {
            let asymmetry = Asymmetry { ratio, smoothing: 0.005 };
            prop_assert!(asymmetry.effective(v) * v >= 0.0);
            prop_assert!(asymmetry.effective(v + 1e-3) > asymmetry.effective(v));
        }

        #[test]
        fn its_inverse_leads_back(v in -5.0..5.0_f64, ratio in -0.9..0.9_f64) {
            let asymmetry = Asymmetry { ratio, smoothing: 0.005 };
            prop_assert!((asymmetry.velocity_of(asymmetry.effective(v)) - v).abs() < 1e-12);
        }

        #[test]
        fn without_ratio_it_is_absent(v in -5.0..5.0_f64) {
            let asymmetry = Asymmetry { ratio: 0.0, smoothing: 0.005 };
            prop_assert_eq!((asymmetry.effective(v), asymmetry.velocity_of(v)), (v, v));
        }
    }

    #[test]
    fn rest_stays_rest() {
        assert_eq!(measured().effective(0.0), 0.0);
    }
}
