//! The yield force of a magnetorheological damper.

use strut_model::{Real, Variables};

/// A dry yield force whose zero crossing hangs behind, `F = F_y tanh(v/v_y + β x)`.
///
/// The hysteresis term of Kwok et al. (2006) with its `β v + δ sign(x)` made smooth in x: a damper that comes back
/// from rebound still pulls when its motion has turned already (docs/effects.md, 32 and section 6). It has
/// no state. With β = 0 it is dry friction; otherwise it is not passive at every moment.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct YieldForce<R> {
    /// Yield force (F_y); zero switches it off
    #[var(unit = N, start = 0.0, min = 0.0)]
    pub force: R,
    /// Velocity at which 76 % of it are reached (v_y)
    #[var(unit = M_PER_S, start = 0.02, min = 1e-6)]
    pub velocity: R,
    /// Shift of the zero crossing over deflection (β)
    #[var(unit = PER_M, start = 0.0)]
    pub slope: R,
}

impl<R: Real> YieldForce<R> {
    /// The force at a deflection and a velocity.
    #[inline]
    pub fn force(&self, deflection: R, velocity: R) -> R {
        if self.force.vanishes() {
            return self.force;
        }
        self.force * (velocity / self.velocity + self.slope * deflection).tanh()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Coulomb;
    use proptest::prelude::*;

    const YIELD: YieldForce<f64> = YieldForce { force: 120.0, velocity: 0.02, slope: 60.0 };

    #[test]
    fn at_rest_in_rebound_it_still_pulls() {
        assert!((YIELD.force(0.01, 0.0) - 120.0 * 0.6_f64.tanh()).abs() < 1e-12);
        assert!(YIELD.force(0.01, -0.6 * 0.02).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn it_is_odd_and_bounded(x in -0.1..0.1_f64, v in -5.0..5.0_f64) {
            prop_assert_eq!(YIELD.force(-x, -v), -YIELD.force(x, v));
            prop_assert!(YIELD.force(x, v).abs() <= 120.0);
        }

        #[test]
        fn without_slope_it_is_dry_friction(x in -0.1..0.1_f64, v in -5.0..5.0_f64) {
            let friction = Coulomb { force: 120.0, velocity: 0.02 };
            let force = YieldForce { slope: 0.0, ..YIELD }.force(x, v);
            prop_assert!((force - friction.resistance(v)).abs() < 1e-9 && force * v >= 0.0);
        }

        #[test]
        fn without_force_it_is_absent(x in -0.1..0.1_f64, v in -5.0..5.0_f64) {
            prop_assert_eq!(YieldForce { force: 0.0, ..YIELD }.force(x, v), 0.0);
        }
    }
}
