//! Oil through an orifice.

use strut_model::{Real, Variables};

/// A force that grows with the square of the velocity, `F = c v |v|` (docs/effects.md, 06).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Orifice<R> {
    /// Force over velocity squared (c); zero switches it off
    #[var(unit = N_S2_PER_M2, start = 0.0, min = 0.0)]
    pub coefficient: R,
}

impl<R: Real> Orifice<R> {
    /// The force that resists `velocity`.
    #[inline]
    pub fn resistance(&self, velocity: R) -> R {
        self.coefficient * velocity * velocity.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    #[test]
    fn twice_the_velocity_is_four_times_the_force() {
        let orifice = Orifice { coefficient: 500.0 };
        assert_eq!((orifice.resistance(0.5), orifice.resistance(-1.0)), (125.0, -500.0));
    }

    #[test]
    fn its_slope_at_rest_is_zero() {
        assert_eq!(Orifice { coefficient: Dual64::from(500.0) }.resistance(Dual64::new(0.0, 1.0)).eps, 0.0);
    }

    proptest! {
        #[test]
        fn it_is_odd_and_takes_energy(v in -5.0..5.0_f64, coefficient in 0.0..5e3_f64) {
            let orifice = Orifice { coefficient };
            prop_assert_eq!(orifice.resistance(-v), -orifice.resistance(v));
            prop_assert!(orifice.resistance(v) * v >= 0.0);
        }

        #[test]
        fn without_coefficient_it_is_absent(v in -5.0..5.0_f64) {
            prop_assert_eq!(Orifice { coefficient: 0.0 }.resistance(v), 0.0);
        }
    }
}
