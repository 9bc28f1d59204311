//! A damper whose rate changes at a velocity.

use strut_model::{Real, Variables};

/// A damper with the rate d₁ up to a velocity v_k and d₂ beyond it (docs/effects.md, 05).
///
/// The force is `d₁ (v + ρ dz(v))` with `ratio` ρ = d₂/d₁ − 1 and the dead zone dz, which is zero up to ±v_k and
/// has slope one beyond. The corner is sharp; the derivative there is a slope of one of its sides.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Knee<R> {
    /// Rate beyond the knee over the rate before it, less one (d_2/d_1 − 1); zero switches it off
    #[var(unit = ONE, start = 0.0, min = -0.99)]
    pub ratio: R,
    /// Velocity of the knee (v_k)
    #[var(unit = M_PER_S, start = 0.1, min = 1e-6)]
    pub velocity: R,
}

/// `x` less what is within ±`half_width` of zero.
#[inline]
pub fn dead_zone<R: Real>(x: R, half_width: R) -> R {
    x - x.clamp(-half_width, half_width)
}

impl<R: Real> Knee<R> {
    /// The velocity that a damper without knee would need for the same force.
    #[inline]
    pub fn effective(&self, velocity: R) -> R {
        if self.ratio.vanishes() {
            return velocity;
        }
        velocity + self.ratio * dead_zone(velocity, self.velocity)
    }

    /// The velocity of which `effective` is made.
    #[inline]
    pub fn velocity_of(&self, effective: R) -> R {
        if self.ratio.vanishes() {
            return effective;
        }
        effective - self.ratio / (self.ratio + 1.0) * dead_zone(effective, self.velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    #[test]
    fn a_digressive_damper_has_a_third_of_its_rate_beyond_the_knee() {
        let knee = Knee { ratio: -2.0 / 3.0, velocity: 0.1 };
        assert_eq!(knee.effective(0.1), 0.1);
        assert!((knee.effective(0.4) - 0.2).abs() < 1e-15);
    }

    #[test]
    fn neither_rest_nor_the_knee_lacks_a_derivative() {
        let knee = Knee { ratio: Dual64::from(1.0), velocity: Dual64::from(0.1) };
        let slope = |v: f64| knee.effective(Dual64::new(v, 1.0)).eps;
        assert_eq!((slope(0.0), slope(0.05), slope(0.2), slope(-0.2)), (1.0, 1.0, 2.0, 2.0));
        assert!([1.0, 2.0].contains(&slope(0.1)));
    }

    proptest! {
        #[test]
        fn it_is_odd_takes_energy_and_grows(v in -5.0..5.0_f64, ratio in -0.99..3.0_f64) {
            let knee = Knee { ratio, velocity: 0.1 };
            prop_assert_eq!(knee.effective(-v), -knee.effective(v));
            prop_assert!(knee.effective(v) * v >= 0.0 && knee.effective(v + 1e-3) > knee.effective(v));
        }

        #[test]
        fn its_inverse_leads_back(v in -5.0..5.0_f64, ratio in -0.9..3.0_f64) {
            let knee = Knee { ratio, velocity: 0.1 };
            prop_assert!((knee.velocity_of(knee.effective(v)) - v).abs() < 1e-12);
        }

        #[test]
        fn without_ratio_it_is_absent(v in -5.0..5.0_f64) {
            let knee = Knee { ratio: 0.0, velocity: 0.1 };
            prop_assert_eq!((knee.effective(v), knee.velocity_of(v)), (v, v));
        }
    }
}
