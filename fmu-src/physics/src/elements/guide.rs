//! The guides of a rig's body and wheel, which keep them upright, and of a drive's carriage.

use strut_model::{Real, Variables};

use crate::effects::{Cogging, Coulomb, Stribeck, VelocityCurve, switched_on};

/// The vertical guide of a body: a force that resists its absolute velocity, TUM 4.3.3 and eq. 12; damping and
/// unnamed force after docs/effects.md, 15, 16 and G; a constant force as a port of diagnosis.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Guide<R> {
    /// Friction
    pub coulomb: Coulomb<R>,
    /// Damping rate
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0)]
    pub damping: R,
    /// Constant force between body and ground, opposing upward motion
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Unnamed force
    pub curve: VelocityCurve<R>,
}

impl<R: Real> Guide<R> {
    /// Another force and what the guide resists `velocity` with; `further` is zero if only Coulomb friction is on.
    #[inline]
    pub fn added_to(&self, other: impl FnOnce() -> R, velocity: R, further: R) -> R {
        if further.vanishes() {
            return self.coulomb.added_to(other, velocity);
        }
        let passive = || other() + self.damping * velocity + self.curve.force(velocity) + self.preload;
        self.coulomb.added_to(passive, velocity)
    }

    /// How many effects are on beside Coulomb friction.
    pub fn active_effects(&self) -> R {
        switched_on([self.damping, self.curve.scale, self.preload])
    }
}

/// The vertical guide of a wheel (docs/effects.md, 15 and 17), with a constant force as a port of diagnosis.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelGuide<R> {
    /// Damping rate
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0)]
    pub damping: R,
    /// Constant force between wheel and ground, opposing upward motion
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Friction
    pub coulomb: Coulomb<R>,
}

impl<R: Real> WheelGuide<R> {
    /// The force that resists the wheel's absolute velocity, and the constant one.
    #[inline]
    pub fn resistance(&self, velocity: R) -> R {
        self.coulomb.added_to(|| self.damping * velocity + self.preload, velocity)
    }

    /// How many effects are on.
    pub fn active_effects(&self) -> R {
        switched_on([self.damping, self.preload, self.coulomb.force])
    }
}

/// The guide of a drive's carriage: TUM eq. 12, and docs/effects.md, 02, 15, 16, 27 and G.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct DriveGuide<R> {
    /// Friction
    pub coulomb: Coulomb<R>,
    /// Breakaway
    pub stribeck: Stribeck<R>,
    /// Viscous friction, eddy currents included
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0)]
    pub damping: R,
    /// Cogging
    pub cogging: Cogging<R>,
    /// Unnamed force
    pub curve: VelocityCurve<R>,
}

impl<R: Real> DriveGuide<R> {
    /// The force against a motion.
    #[inline]
    pub fn resistance(&self, position: R, velocity: R) -> R {
        let sliding = self.coulomb.force + self.stribeck.excess(velocity);
        let friction = Coulomb { force: sliding, ..self.coulomb };
        let passive = || self.damping * velocity + self.cogging.force(position) + self.curve.force(velocity);
        friction.added_to(passive, velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::POINTS;
    use proptest::prelude::*;

    fn guide(damping: f64, scale: f64) -> Guide<f64> {
        let curve = VelocityCurve {
            scale,
            velocity_range: 0.5,
            over_velocity: std::array::from_fn(|i| 8.0 * (i as f64 - (POINTS / 2) as f64)),
        };
        Guide { coulomb: Coulomb { force: 20.0, velocity: 0.008 }, damping, preload: 0.0, curve }
    }

    fn wheel_guide(damping: f64, force: f64) -> WheelGuide<f64> {
        WheelGuide { damping, preload: 0.0, coulomb: Coulomb { force, velocity: 0.008 } }
    }

    #[test]
    fn a_preload_is_added_whatever_the_velocity() {
        let (body, wheel) = (Guide { preload: 7.0, ..guide(0.0, 0.0) }, wheel_guide(0.0, 0.0));
        let wheel = WheelGuide { preload: -3.0, ..wheel };
        assert_eq!((body.active_effects(), wheel.active_effects()), (1.0, 1.0));
        assert_eq!(body.added_to(|| 5.0, 0.0, 1.0), 12.0);
        assert_eq!([-1.0, 0.0, 1.0].map(|v| wheel.resistance(v)), [-3.0; 3]);
    }

    proptest! {
        #[test]
        fn it_adds_damping_friction_and_curve_to_another_force(v in -0.5..0.5_f64, other in -1e3..1e3_f64) {
            let guide = guide(60.0, 0.5);
            let found = guide.added_to(|| other, v, guide.active_effects());
            // The curve is a straight line of 80 N.s/m.
            let expected = other + 20.0 * (v / 0.008).tanh() + (60.0 + 0.5 * 80.0) * v;
            prop_assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }

        #[test]
        fn with_neutral_effects_it_is_friction_alone(v in -0.5..0.5_f64, other in -1e3..1e3_f64) {
            let guide = guide(0.0, 0.0);
            prop_assert_eq!(guide.active_effects(), 0.0);
            let alone = guide.coulomb.added_to(|| other, v);
            prop_assert_eq!(guide.added_to(|| other, v, 0.0), alone);
            prop_assert_eq!(guide.added_to(|| other, v, 1.0), alone);
        }

        #[test]
        fn the_wheel_s_guide_is_odd_and_takes_energy(v in -5.0..5.0_f64) {
            let guide = wheel_guide(50.0, 20.0);
            prop_assert!(guide.resistance(v) * v >= 0.0);
            prop_assert_eq!(guide.resistance(-v), -guide.resistance(v));
        }

        #[test]
        fn the_wheel_s_guide_is_absent_without_damping_and_friction(v in -5.0..5.0_f64) {
            let guide = wheel_guide(0.0, 0.0);
            prop_assert_eq!((guide.resistance(v), guide.active_effects()), (0.0, 0.0));
        }
    }
}
