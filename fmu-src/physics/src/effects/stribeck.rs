//! Friction that breaks away: more at rest than in motion.

use strut_model::{Real, Variables};

/// Stribeck's addition to Coulomb friction (docs/effects.md, 02).
///
/// Dry friction with a breakaway force is `[F_c + (F_s − F_c) exp(−(v/v_s)²)] tanh(v/v_0)`. `force` is F_s − F_c,
/// so that it is neutral at zero whatever F_c is; v_0 is that of [`Coulomb`](super::Coulomb).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Stribeck<R> {
    /// Breakaway force above that of sliding (F_s − F_c); zero switches it off
    #[var(unit = N, start = 0.0, min = 0.0)]
    pub force: R,
    /// Velocity over which it wears off (v_s)
    #[var(unit = M_PER_S, start = 0.01, min = 1e-6)]
    pub velocity: R,
}

impl<R: Real> Stribeck<R> {
    /// What is added to the sliding friction's force at a velocity, before its zero crossing is made smooth.
    #[inline]
    pub fn excess(&self, velocity: R) -> R {
        if self.force.vanishes() {
            return self.force;
        }
        self.force * (-(velocity / self.velocity).squared()).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn at_rest_it_is_whole_and_at_its_velocity_one_over_e() {
        let stribeck = Stribeck { force: 40.0, velocity: 0.01 };
        assert_eq!(stribeck.excess(0.0), 40.0);
        assert!((stribeck.excess(-0.01) - 40.0 * (-1.0_f64).exp()).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn it_is_even_and_wears_off(v in 0.0..5.0_f64) {
            let stribeck = Stribeck { force: 40.0, velocity: 0.01 };
            prop_assert_eq!(stribeck.excess(v), stribeck.excess(-v));
            prop_assert!(stribeck.excess(v) >= stribeck.excess(1.1 * v) && stribeck.excess(v) >= 0.0);
        }

        #[test]
        fn without_force_it_is_absent(v in -5.0..5.0_f64) {
            prop_assert_eq!(Stribeck { force: 0.0, velocity: 0.01 }.excess(v), 0.0);
        }
    }
}
