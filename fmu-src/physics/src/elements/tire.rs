//! The tyre between wheel and road.

use strut_model::{Real, Variables};

use crate::GRAVITY;
use crate::effects::{CompressionCurve, Coulomb, LiftOff, Quadratic, switched_on};

/// Tyre, TUM eq. 5 with the quadratic rate (4.3.2) and the friction of Table 7:
/// `F = c_w c + b c² + d_w ċ + F̂ tanh(ċ k_f)` with the compression c = x_g − x_w.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Tire<R> {
    /// Rate at static equilibrium (c_w, K_us, k_1, k_r)
    #[var(unit = N_PER_M, start = 200e3, min = 1.0)]
    pub stiffness: R,
    /// Quadratic rate; zero makes the tyre linear
    #[var(unit = N_PER_M2, start = 0.0)]
    pub quadratic: R,
    /// Damping rate (d_w, B_us, b_1)
    #[var(unit = N_S_PER_M, start = 50.0, min = 0.0)]
    pub damping: R,
    /// Constant force that pushes wheel and road apart
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Friction
    pub coulomb: Coulomb<R>,
    /// Unnamed force
    pub curve: CompressionCurve<R>,
}

/// What stands on a tyre.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Load at static equilibrium
    #[var(unit = N)]
    pub static_load: R,
    /// Deflection (wheel above road) at which the tyre's spring carries nothing
    #[var(unit = M)]
    pub lift_off_deflection: R,
}

impl<R: Real> Load<R> {
    /// Where the tyre leaves the road.
    #[inline]
    pub fn lift_off(&self) -> LiftOff<R> {
        LiftOff { load: self.static_load, compression: -self.lift_off_deflection }
    }
}

impl<R: Real> Tire<R> {
    /// The force that presses on the road, less the static load, while the tyre cannot leave it; `further` is zero
    /// if there is neither preload nor unnamed force.
    #[inline]
    pub fn force(&self, compression: R, velocity: R, further: R) -> R {
        let named = self.named(compression, velocity);
        if further.vanishes() { named } else { named + self.curve.force(compression) + self.preload }
    }

    /// How many effects are on beside the quadratic rate and Coulomb friction.
    pub fn active_effects(&self) -> R {
        switched_on([self.curve.scale, self.preload])
    }

    #[inline]
    fn named(&self, compression: R, velocity: R) -> R {
        if self.quadratic.vanishes() & self.coulomb.force.vanishes() {
            // One question for both effects: one each would be felt in a step of the linear rig.
            return self.stiffness * compression + self.damping * velocity;
        }
        let passive = || self.spring().force(compression) + self.damping * velocity;
        self.coulomb.added_to(passive, velocity)
    }

    /// The same tyre with a damping rate of zero, for those who integrate the damper's force themselves.
    #[inline]
    pub fn without_damping(&self) -> Self {
        Self { damping: R::from(0.0), ..*self }
    }

    /// What a mass of `carried` kilograms means for the tyre.
    pub fn load(&self, carried: R) -> Load<R> {
        let static_load = carried * GRAVITY;
        Load { static_load, lift_off_deflection: -self.spring().compression_at_relief(static_load) }
    }

    /// The spring alone.
    #[inline]
    pub fn spring(&self) -> Quadratic<R> {
        Quadratic { stiffness: self.stiffness, quadratic: self.quadratic }
    }
}

impl Tire<f64> {
    /// Refuses a tyre that would never leave the road; `name` is that of its parameters.
    ///
    /// # Errors
    /// The parameters, their values and their bound.
    pub fn check_lift_off(&self, name: &str, load: &Load<f64>) -> Result<(), String> {
        let Self { stiffness, quadratic, .. } = *self;
        let load = load.static_load;
        if self.spring().reaches(load) {
            return Ok(());
        }
        Err(format!(
            "the tyre would never leave the road: with {name}.stiffness = {stiffness} N/m and {name}.quadratic = \
             {quadratic} N/m2 its force never falls to the static load of {load} N below rest; lift-off needs \
             {name}.quadratic < {name}.stiffness^2 / (4 · load) = {} N/m2, or set tire.lift_off to false",
            stiffness.powi(2) / (4.0 * load)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tire(quadratic: f64, friction: f64) -> Tire<f64> {
        Tire {
            stiffness: 152_140.0,
            quadratic,
            damping: 50.0,
            preload: 0.0,
            coulomb: Coulomb { force: friction, velocity: 0.008 },
            curve: CompressionCurve::none(),
        }
    }

    #[test]
    fn table_10_lifts_off_near_10_7_millimetres() {
        let load = tire(4_075_400.0, 0.0).load(94.38 + 23.92);
        assert!((load.static_load - 1160.127).abs() < 1e-3);
        assert!((load.lift_off_deflection - 10.682e-3).abs() < 1e-6);
    }

    #[test]
    fn a_preload_presses_on_the_road() {
        let loaded = Tire { preload: 10.0, ..tire(0.0, 0.0) };
        assert_eq!(loaded.active_effects(), 1.0);
        assert_eq!(loaded.force(0.0, 0.0, loaded.active_effects()), 10.0);
    }

    proptest! {
        #[test]
        fn with_neutral_effects_it_is_equation_5(c in -0.05..0.05_f64, v in -2.0..2.0_f64) {
            prop_assert!((tire(0.0, 0.0).force(c, v, 0.0) - (152_140.0 * c + 50.0 * v)).abs() < 1e-9);
        }

        #[test]
        fn an_unnamed_force_is_added(c in -0.05..0.05_f64, v in -2.0..2.0_f64, force in -50.0..50.0_f64) {
            let named = tire(4_075_400.0, 60.0);
            let mut unnamed = named;
            unnamed.curve.scale = 2.0;
            unnamed.curve.over_deflection = [force; crate::effects::POINTS];
            prop_assert_eq!((named.active_effects(), unnamed.active_effects()), (0.0, 1.0));
            prop_assert!((unnamed.force(c, v, 1.0) - named.force(c, v, 0.0) - 2.0 * force).abs() < 1e-9);
            prop_assert_eq!(named.force(c, v, 1.0), named.force(c, v, 0.0));
        }

        #[test]
        fn what_is_not_spring_takes_energy(c in -0.05..0.05_f64, v in -2.0..2.0_f64) {
            let tire = tire(4_075_400.0, 60.0);
            prop_assert!((tire.force(c, v, 0.0) - tire.force(c, 0.0, 0.0)) * v >= 0.0);
        }
    }
}
