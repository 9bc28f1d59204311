//! A contact that can push but not pull.

use strut_model::Real;

/// A tyre leaves the road when its total force, static load included, would be below zero.
///
/// TUM does not say what its model does there; on the rig the wheel load is measured by a cell below the
/// wheel (3.1), which the wheel can leave. The condition stands on the deflection and not only on the
/// force, because the parabola of a quadratic tyre turns up again further out (beyond −27 mm for Table 10).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiftOff<R> {
    /// Static load F0.
    pub load: R,
    /// Compression c_l at which the spring alone carries nothing.
    pub compression: R,
}

impl<R: Real> LiftOff<R> {
    /// `force` in contact; never below `-load`, and just that in the air.
    #[inline]
    pub fn applied(&self, force: R, compression: R) -> R {
        (compression - self.compression).select(force.max(-self.load), -self.load)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TIRE: LiftOff<f64> = LiftOff { load: 1160.0, compression: -0.0107 };

    proptest! {
        #[test]
        fn the_road_never_pulls(force in -1e4..1e4_f64, compression in -0.05..0.05_f64) {
            prop_assert!(TIRE.applied(force, compression) >= -TIRE.load);
        }

        #[test]
        fn in_firm_contact_it_is_absent(force in -1159.0..1e4_f64, compression in -0.0106..0.05_f64) {
            prop_assert_eq!(TIRE.applied(force, compression), force);
        }
    }

    #[test]
    fn in_the_air_there_is_no_force_at_all() {
        // The parabola has turned up again: it must not be believed.
        assert_eq!(TIRE.applied(500.0, -0.03), -1160.0);
        assert_eq!(TIRE.applied(500.0, TIRE.compression), -1160.0);
    }
}
