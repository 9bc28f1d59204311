//! The passive strut between body and wheel: spring, damper and friction.

use strut_model::{Real, Variables};

use crate::effects::{
    Asymmetry, Coulomb, Fade, ForceCurve, Knee, Linkage, LoadDependence, Orifice, Progression, Stop,
    Stribeck, YieldForce, switched_on,
};

use super::{Hysteresis, HysteresisState};

/// Spring and damper, TUM eq. 2 and 14: c_c = `stiffness`, d_c = `damping`; with an asymmetric damper
/// (4.3.1, Table 9), Coulomb friction F_f,1 (eq. 12) and the further effects that a diagnosis looks for.
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
    /// Breakaway friction
    pub stribeck: Stribeck<R>,
    /// Friction that depends on the load
    pub load_dependence: LoadDependence<R>,
    /// Yield force
    pub r#yield: YieldForce<R>,
    /// Knee of the damper
    pub knee: Knee<R>,
    /// Orifice
    pub orifice: Orifice<R>,
    /// Fading damper
    pub fade: Fade<R>,
    /// Curved spring
    pub spring: Progression<R>,
    /// Stops
    pub stop: Stop<R>,
    /// Constant force that pulls body and wheel together
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Linkage between wheel and strut
    pub linkage: Linkage<R>,
    /// Unnamed force
    pub curve: ForceCurve<R>,
}

impl<R: Real> Strut<R> {
    /// The force that pulls body and wheel together; `further` is zero if no effect but asymmetry and Coulomb
    /// friction is on.
    #[inline(always)]
    pub fn force(&self, time: R, deflection: R, velocity: R, further: R) -> R {
        if further.vanishes() {
            return self.basic(deflection, velocity);
        }
        self.behind_linkage(deflection, velocity, |x, v| self.beside_damper(x, v) + self.damper(time, v))
    }

    /// The force that pulls body and wheel together and the rates of what the strut remembers.
    #[inline(always)]
    pub fn force_with_states(
        &self,
        hysteresis: &Hysteresis<R>,
        state: &HysteresisState<R>,
        [time, deflection, velocity]: [R; 3],
        further: R,
    ) -> (R, HysteresisState<R>) {
        let mut rates = HysteresisState::rest();
        if further.vanishes() {
            return (self.basic(deflection, velocity), rates);
        }
        let force = self.behind_linkage(deflection, velocity, |x, v| {
            let (presliding, maxwell, damper);
            (presliding, rates.presliding) = hysteresis.presliding.force(state.presliding, v);
            (maxwell, rates.maxwell) = hysteresis.maxwell.force(state.maxwell, v);
            (damper, rates.mount) = hysteresis
                .mount
                .force(state.mount, v, self.damper(time, v), |force| self.damper_velocity(time, force));
            self.beside_damper(x, v) + presliding + maxwell + damper
        });
        (force, rates)
    }

    /// How many effects are on beside asymmetry and Coulomb friction.
    pub fn active_effects(&self) -> R {
        switched_on([
            self.stribeck.force,
            self.load_dependence.slope,
            self.r#yield.force,
            self.knee.ratio,
            self.orifice.coefficient,
            self.fade.ratio,
            self.spring.quadratic,
            self.spring.cubic,
            self.stop.stiffness,
            self.preload,
            self.linkage.slope,
            self.curve.scale,
        ])
    }

    /// What there is without further effects.
    #[inline]
    fn basic(&self, deflection: R, velocity: R) -> R {
        if self.asymmetry.ratio.vanishes() & self.coulomb.force.vanishes() {
            // One question for both effects: one each would be felt in a step of the linear rig.
            return self.stiffness * deflection + self.damping * velocity;
        }
        let passive = || self.stiffness * deflection + self.damping * self.asymmetry.effective(velocity);
        self.coulomb.added_to(passive, velocity)
    }

    /// What a law in the strut's own deflection and velocity is at the wheel.
    #[inline]
    fn behind_linkage(&self, deflection: R, velocity: R, law: impl FnOnce(R, R) -> R) -> R {
        if self.linkage.slope.vanishes() {
            return law(deflection, velocity);
        }
        let ratio = self.linkage.ratio(deflection);
        ratio * law(self.linkage.deflection(deflection), ratio * velocity)
    }

    /// The damper: knee, asymmetry and fade. The rate of each side changes at the knee.
    #[inline]
    fn damper(&self, time: R, velocity: R) -> R {
        self.fade.left_of(self.damping, time) * self.asymmetry.effective(self.knee.effective(velocity))
    }

    /// The velocity of the damper under a force; there must be a damper.
    #[inline]
    fn damper_velocity(&self, time: R, force: R) -> R {
        self.knee.velocity_of(self.asymmetry.velocity_of(force / self.fade.left_of(self.damping, time)))
    }

    /// All that does not go through the damper's mount.
    #[inline]
    fn beside_damper(&self, deflection: R, velocity: R) -> R {
        let spring =
            self.stiffness * deflection + self.spring.force(deflection) + self.stop.force(deflection);
        let sliding = self.load_dependence.of(self.coulomb.force, deflection);
        let friction = Coulomb { force: sliding + self.stribeck.excess(velocity), ..self.coulomb };
        let others = || {
            spring
                + self.preload
                + self.orifice.resistance(velocity)
                + self.r#yield.force(deflection, velocity)
                + self.curve.force(deflection, velocity)
        };
        friction.added_to(others, velocity)
    }
}

#[cfg(test)]
mod tests;
