//! A spring and a damper in series.

use strut_model::{Real, Variables};

/// A Maxwell branch beside the strut, `F = k₁ ξ`, `ξ' = v − ξ/τ` (docs/effects.md, 07).
///
/// ξ is the deflection of its spring; its damper has the rate k₁ τ.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Maxwell<R> {
    /// Rate of its spring (k_1); zero switches it off
    #[var(unit = N_PER_M, start = 0.0, min = 0.0)]
    pub stiffness: R,
    /// Time over which its force wears off (τ)
    #[var(unit = S, start = 0.01, min = 1e-5)]
    pub time: R,
}

/// What a Maxwell branch remembers.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct MaxwellState<R> {
    /// Deflection of the spring (ξ)
    #[var(unit = M, nominal = 1e-3)]
    pub deflection: R,
}

impl<R: Real> Maxwell<R> {
    /// The force that pulls together, and the state's rate.
    #[inline]
    pub fn force(&self, state: MaxwellState<R>, velocity: R) -> (R, MaxwellState<R>) {
        if self.stiffness.vanishes() {
            let zero = R::from(0.0);
            return (zero, MaxwellState { deflection: zero });
        }
        let rate = velocity - state.deflection / self.time;
        (self.stiffness * state.deflection, MaxwellState { deflection: rate })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BRANCH: Maxwell<f64> = Maxwell { stiffness: 2e4, time: 0.02 };

    #[test]
    fn in_steady_motion_it_is_its_damper() {
        // ξ = v τ stays; the force is k₁ τ v.
        let (force, rate) = BRANCH.force(MaxwellState { deflection: 0.3 * 0.02 }, 0.3);
        assert!((force - 2e4 * 0.02 * 0.3).abs() < 1e-9 && rate.deflection.abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn what_it_does_not_store_it_takes(deflection in -0.05..0.05_f64, v in -2.0..2.0_f64) {
            let (force, rate) = BRANCH.force(MaxwellState { deflection }, v);
            let stored = BRANCH.stiffness * deflection * rate.deflection;
            prop_assert!(force * v - stored >= -1e-9);
        }

        #[test]
        fn it_is_odd(deflection in -0.05..0.05_f64, v in -2.0..2.0_f64) {
            let ((a, b), (c, d)) = (
                BRANCH.force(MaxwellState { deflection }, v),
                BRANCH.force(MaxwellState { deflection: -deflection }, -v),
            );
            prop_assert_eq!((a, b.deflection), (-c, -d.deflection));
        }

        #[test]
        fn without_stiffness_it_is_absent(deflection in -0.05..0.05_f64, v in -2.0..2.0_f64) {
            let (force, rate) = Maxwell { stiffness: 0.0, ..BRANCH }.force(MaxwellState { deflection }, v);
            prop_assert_eq!((force, rate.deflection), (0.0, 0.0));
        }
    }
}
