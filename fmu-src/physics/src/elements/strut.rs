//! The passive strut between body and wheel: spring, damper and friction.

use strut_model::{Real, Variables};

use crate::effects::{Asymmetry, Coulomb};

/// Spring and damper, TUM eq. 2 and 14: c_c = `stiffness`, d_c = `damping`; with an asymmetric damper
/// (4.3.1, Table 9) and Coulomb friction F_f,1 (eq. 12).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Strut<R> {
    /// Spring rate (c_c, K_s, k_2, k_a)
    #[var(unit = N_PER_M, start = 22e3, min = 1.0)]
    pub stiffness: R,
    /// Damping rate, mean of rebound and compression (d_c, B_s, b_2)
    #[var(unit = N_S_PER_M, start = 1500.0, min = 0.0)]
    pub damping: R,
    /// Asymmetric damper
    pub asymmetry: Asymmetry<R>,
    /// Friction
    pub coulomb: Coulomb<R>,
}

impl<R: Real> Strut<R> {
    /// The force that pulls body and wheel together.
    #[inline]
    pub fn force(&self, deflection: R, velocity: R) -> R {
        if self.asymmetry.ratio.vanishes() & self.coulomb.force.vanishes() {
            // One question for both effects: one each would be felt in a step of the linear rig.
            return self.stiffness * deflection + self.damping * velocity;
        }
        let passive = || self.stiffness * deflection + self.damping * self.asymmetry.effective(velocity);
        self.coulomb.added_to(passive, velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn strut(ratio: f64, force: f64) -> Strut<f64> {
        Strut {
            stiffness: 8400.0,
            damping: 707.0,
            asymmetry: Asymmetry { ratio, smoothing: 0.005 },
            coulomb: Coulomb { force, velocity: 0.008 },
        }
    }

    #[test]
    fn the_spring_alone_is_equation_14() {
        assert_eq!(strut(0.3, 115.0).force(0.05, 0.0), 8400.0 * 0.05);
    }

    proptest! {
        #[test]
        fn with_neutral_effects_it_is_linear(x in -0.1..0.1_f64, v in -2.0..2.0_f64) {
            prop_assert_eq!(strut(0.0, 0.0).force(x, v), 8400.0 * x + 707.0 * v);
        }

        #[test]
        fn what_is_not_spring_takes_energy(x in -0.1..0.1_f64, v in -2.0..2.0_f64, ratio in -0.9..0.9_f64) {
            let strut = strut(ratio, 115.0);
            prop_assert!((strut.force(x, v) - strut.force(x, 0.0)) * v >= 0.0);
        }
    }
}
