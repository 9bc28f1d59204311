//! A strut that is not moved as far as the wheel.

use strut_model::{Real, Variables};

/// A motion ratio that changes over the travel, `i(x) = 1 + i₁ x` (docs/effects.md, 14).
///
/// It is the strut's travel over the wheel's: `x_s = ∫ i dx = x + i₁ x²/2` and `v_s = i v`. What the strut does
/// with the force F it does at the wheel with `i F`, so that the powers are the same, `F v_s = (i F) v`. All that
/// belongs to the strut is in front of the linkage, the actuator is not.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Linkage<R> {
    /// Change of the motion ratio with deflection (i_1); zero switches it off
    #[var(unit = PER_M, start = 0.0)]
    pub slope: R,
}

impl<R: Real> Linkage<R> {
    /// The strut's travel over the wheel's.
    #[inline]
    pub fn ratio(&self, deflection: R) -> R {
        self.slope * deflection + 1.0
    }

    /// The strut's own deflection.
    #[inline]
    pub fn deflection(&self, deflection: R) -> R {
        deflection + self.slope * deflection.squared() * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_ratio_is_the_slope_of_the_travel(x in -0.1..0.1_f64, slope in -5.0..5.0_f64) {
            let (linkage, h) = (Linkage { slope }, 1e-5);
            let difference = (linkage.deflection(x + h) - linkage.deflection(x - h)) / (2.0 * h);
            prop_assert!((linkage.ratio(x) - difference).abs() < 1e-9);
        }

        #[test]
        fn without_slope_it_is_absent(x in -0.1..0.1_f64) {
            let linkage = Linkage { slope: 0.0 };
            prop_assert_eq!((linkage.ratio(x), linkage.deflection(x)), (1.0, x));
        }
    }
}
