//! Friction that grows with what the spring carries.

use strut_model::{Real, Variables};

/// A Coulomb force that changes over the deflection, `F_c max(1 + β x, 0)` (docs/effects.md, 11).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct LoadDependence<R> {
    /// Relative change of the Coulomb force with deflection (β); zero switches it off
    #[var(unit = PER_M, start = 0.0)]
    pub slope: R,
}

impl<R: Real> LoadDependence<R> {
    /// The Coulomb force `force` at a deflection.
    #[inline]
    pub fn of(&self, force: R, deflection: R) -> R {
        force * (self.slope * deflection + 1.0).max(R::from(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ten_per_metre_are_a_tenth_more_at_ten_millimetres() {
        assert!((LoadDependence { slope: 10.0 }.of(100.0, 0.01) - 110.0).abs() < 1e-12);
        assert_eq!(LoadDependence { slope: 10.0 }.of(100.0, -0.2), 0.0);
    }

    proptest! {
        #[test]
        fn friction_never_drives(x in -1.0..1.0_f64, slope in -20.0..20.0_f64) {
            let dependence = LoadDependence { slope };
            prop_assert!(dependence.of(100.0, x) >= 0.0);
        }

        #[test]
        fn without_slope_it_is_absent(x in -1.0..1.0_f64) {
            prop_assert_eq!(LoadDependence { slope: 0.0 }.of(100.0, x), 100.0);
        }
    }
}
