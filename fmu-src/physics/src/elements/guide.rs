//! The guides that keep body and wheel of a rig upright.

use strut_model::{Real, Variables};

use crate::effects::{Coulomb, VelocityCurve, switched_on};

/// The vertical guide of a body: a force that resists its absolute velocity, TUM 4.3.3 and eq. 12; damping and
/// unnamed force after the catalogue of diagnosis, 15, 16 and G.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Guide<R> {
    /// Friction
    pub coulomb: Coulomb<R>,
    /// Damping rate
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0)]
    pub damping: R,
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
        let passive = || other() + self.damping * velocity + self.curve.force(velocity);
        self.coulomb.added_to(passive, velocity)
    }

    /// How many effects are on beside Coulomb friction.
    pub fn further_effects(&self) -> R {
        switched_on([self.damping, self.curve.scale])
    }
}

/// The vertical guide of a wheel (catalogue of diagnosis, 15 and 17).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelGuide<R> {
    /// Damping rate
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0)]
    pub damping: R,
    /// Friction
    pub coulomb: Coulomb<R>,
}

impl<R: Real> WheelGuide<R> {
    /// The force that resists the wheel's absolute velocity.
    #[inline]
    pub fn resistance(&self, velocity: R) -> R {
        self.coulomb.added_to(|| self.damping * velocity, velocity)
    }

    /// How many effects are on.
    pub fn further_effects(&self) -> R {
        switched_on([self.damping, self.coulomb.force])
    }
}
