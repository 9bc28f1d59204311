//! A spring whose rate changes over its deflection.

use strut_model::{Real, Variables};

/// What a curved spring adds to a straight one, `F = k₂ x² + k₃ x³` (docs/effects.md, 08).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Progression<R> {
    /// Quadratic rate (k_2); zero switches it off
    #[var(unit = N_PER_M2, start = 0.0)]
    pub quadratic: R,
    /// Cubic rate (k_3); zero switches it off
    #[var(unit = N_PER_M3, start = 0.0)]
    pub cubic: R,
}

impl<R: Real> Progression<R> {
    /// The force at a deflection.
    #[inline]
    pub fn force(&self, deflection: R) -> R {
        (self.quadratic + self.cubic * deflection) * deflection.squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ten_millimetres_of_both_rates() {
        let spring = Progression { quadratic: 1e5, cubic: 1e7 };
        assert!((spring.force(0.01) - 20.0).abs() < 1e-12);
        assert!(spring.force(-0.01).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_quadratic_part_is_even_and_the_cubic_one_odd(x in -0.1..0.1_f64, rate in -1e6..1e6_f64) {
            let (even, odd) =
                (Progression { quadratic: rate, cubic: 0.0 }, Progression { quadratic: 0.0, cubic: rate });
            prop_assert_eq!(even.force(x), even.force(-x));
            prop_assert_eq!(odd.force(x), -odd.force(-x));
        }

        #[test]
        fn without_rates_it_is_absent(x in -0.1..0.1_f64) {
            prop_assert_eq!(Progression { quadratic: 0.0, cubic: 0.0 }.force(x), 0.0);
        }
    }
}
