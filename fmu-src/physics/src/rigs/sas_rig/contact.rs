//! The wheel between its arm and the eccentric.

use strut_model::{Real, Variables};

use crate::effects::{CompressionCurve, Coulomb, LiftOff, with_constant};
use crate::elements::Tire;

use super::Parameters;

/// The wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Wheel<R> {
    /// Radius of the rim (r)
    #[var(unit = M, start = 0.075, min = 1e-3)]
    pub rim_radius: R,
    /// Thickness of the tyre without load (l_t0)
    #[var(unit = M, start = 0.02, min = 1e-4)]
    pub tire_thickness: R,
}

/// The tyre of [`elements`](crate::elements) with this rig's values.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelTire<R> {
    /// Rate, without load (k_t = a_1 I_1/R; printed 1.09e5)
    #[var(unit = N_PER_M, start = 1.08e5 * 0.2116 / 0.21, min = 1.0)]
    pub stiffness: R,
    /// Quadratic rate; zero makes the tyre linear
    #[var(unit = N_PER_M2, start = 0.0)]
    pub quadratic: R,
    /// Damping rate (b_t/(R cos(beta - alpha_1)) with b_t = a_2 I_1 in N.s, printed 305.27)
    #[var(unit = N_S_PER_M, start = 1595.557, min = 0.0)]
    pub damping: R,
    /// Constant force that pushes wheel and eccentric apart
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Friction
    pub coulomb: Coulomb<R>,
}

impl<R: Real> WheelTire<R> {
    /// The force with which it presses on the eccentric.
    #[inline]
    pub fn force(&self, compression: R, thinning: R, lift_off: bool) -> R {
        let force = self.element().force(compression, thinning, self.preload);
        if !lift_off {
            return force;
        }
        // Its load is not counted from rest here: nothing is left of it where nothing is compressed.
        LiftOff { load: R::from(0.0), compression: R::from(0.0) }.applied(force, compression)
    }

    /// The force at rest.
    #[inline]
    pub fn static_force(&self, compression: R) -> R {
        with_constant(self.element().spring().force(compression), self.preload)
    }

    #[inline]
    fn element(&self) -> Tire<R> {
        let Self { stiffness, quadratic, damping, preload, coulomb } = *self;
        Tire { stiffness, quadratic, damping, preload, coulomb, curve: CompressionCurve::none() }
    }
}

/// Where the eccentric turns.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Eccentric<R> {
    /// How far its axis is below the pivot (H)
    #[var(unit = M, start = 0.22, min = 1e-3)]
    pub depth: R,
}

/// Where the wheel stands on the eccentric.
pub struct Contact<R> {
    /// Cosine of the angle by which the wheel's centre is below the horizontal.
    pub cosine: R,
    /// Distance of the tyre's force from the pivot.
    pub lever: R,
    /// By how much the tyre is compressed.
    pub compression: R,
}

impl<R: Real> Contact<R> {
    /// With the wheel arm at an angle and the eccentric at a height, Kogut eq. 14.
    #[inline]
    pub fn new(p: &Parameters<R>, angle: R, eccentric_height: R) -> Self {
        let below = p.wheel_arm.offset - angle;
        let cosine = below.cos();
        let room =
            p.eccentric.depth - p.wheel.rim_radius - eccentric_height - p.wheel_arm.length * below.sin();
        Self { cosine, lever: p.wheel_arm.length * cosine, compression: p.wheel.tire_thickness - room }
    }
}
