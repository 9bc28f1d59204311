//! Coulomb friction with a smooth zero crossing.

use strut_model::{Real, Variables};

/// Dry friction, TUM eq. 12: `F = F̂_f tanh(Δv k_f)` with `force` = F̂_f and `velocity` = 1/k_f.
///
/// Without force it costs one question and no tanh.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Coulomb<R> {
    /// Friction force once the motion is fast (F̂_f); zero switches the friction off
    #[var(unit = N, start = 0.0, min = 0.0)]
    pub force: R,
    /// Velocity at which 76 % of the force is reached (1/k_f)
    #[var(unit = M_PER_S, start = 0.008, min = 1e-6)]
    pub velocity: R,
}

impl<R: Real> Coulomb<R> {
    /// Another force and the friction that resists `velocity`.
    ///
    /// Not the friction alone: a zero to be added would be waited for. And the other force comes second: what it
    /// is made of need not be kept while the tanh is computed.
    #[inline]
    pub fn added_to(&self, other: impl FnOnce() -> R, velocity: R) -> R {
        if self.force.vanishes() {
            return other();
        }
        let friction = self.resistance(velocity);
        other() + friction
    }

    /// The force that resists `velocity`.
    #[inline]
    pub fn resistance(&self, velocity: R) -> R {
        // The reciprocal is ready before the velocity is known: the sum waits for a product, not for a quotient.
        self.force * (velocity * (R::from(1.0) / self.velocity)).tanh()
    }
}

/// The same law between parts that turn: a torque that resists a relative speed.
///
/// Without torque it costs one question, as [`Coulomb`] does.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct RotaryCoulomb<R> {
    /// Friction torque once the motion is fast; zero switches the friction off
    #[var(unit = N_M, start = 0.0, min = 0.0)]
    pub torque: R,
    /// Speed at which 76 % of the torque is reached
    #[var(unit = RAD_PER_S, start = 0.05, min = 1e-6)]
    pub speed: R,
}

impl<R: Real> RotaryCoulomb<R> {
    /// Another torque and the friction that resists `speed`.
    #[inline]
    pub fn added_to(&self, other: impl FnOnce() -> R, speed: R) -> R {
        Coulomb { force: self.torque, velocity: self.speed }.added_to(other, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 10: 115 N, k_f = 125 s/m.
    const STRUT: Coulomb<f64> = Coulomb { force: 115.0, velocity: 1.0 / 125.0 };

    #[test]
    fn at_one_over_k_f_it_is_tanh_of_one() {
        assert!((STRUT.resistance(0.008) - 115.0 * 1.0_f64.tanh()).abs() < 1e-12);
        assert_eq!(STRUT.resistance(0.0), 0.0);
    }

    proptest! {
        #[test]
        fn it_is_odd_bounded_and_takes_energy(v in -5.0..5.0_f64) {
            let force = STRUT.resistance(v);
            prop_assert_eq!(force, -STRUT.resistance(-v));
            prop_assert!(force.abs() <= 115.0 && force * v >= 0.0);
        }

        #[test]
        fn without_force_it_is_absent(v in -5.0..5.0_f64) {
            prop_assert_eq!(Coulomb { force: 0.0, velocity: 0.008 }.added_to(|| v, v), v);
            prop_assert_eq!(RotaryCoulomb { torque: 0.0, speed: 0.05 }.added_to(|| v, v), v);
        }

        #[test]
        fn turning_parts_rub_as_sliding_ones_do(speed in -5.0..5.0_f64, other in -10.0..10.0_f64) {
            let bearing = RotaryCoulomb { torque: 115.0, speed: 0.008 };
            prop_assert_eq!(bearing.added_to(|| other, speed), STRUT.added_to(|| other, speed));
        }
    }
}
