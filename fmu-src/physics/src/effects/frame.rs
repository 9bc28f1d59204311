//! A frame that rings.

use std::f64::consts::TAU;

use strut_model::{Real, Variables};

/// A part of a body or of the frame that carries its guides, which swings beside it: a mass m_f on a spring and a damper
/// (docs/effects.md, 18). Below its natural frequency f it is but more mass.
///
/// With its deflection y against the body, `y'' + 2 ζ ω y' + ω² y = −a_s`, ω = 2π f; on the body acts
/// `m_f (ω² y + 2 ζ ω y')`.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct FrameMode<R> {
    /// Mass that swings (m_f); zero switches it off
    #[var(unit = KG, start = 0.0, min = 0.0)]
    pub mass: R,
    /// Its natural frequency, the body held (f)
    #[var(unit = HZ, start = 30.0, min = 0.1)]
    pub frequency: R,
    /// Its damping ratio (ζ)
    #[var(unit = ONE, start = 0.02, min = 0.0)]
    pub damping_ratio: R,
}

/// How the frame swings against the body.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct FrameState<R> {
    /// Deflection: frame above body (y)
    #[var(unit = M, nominal = 1e-3)]
    pub deflection: R,
    /// Its rate of change
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub velocity: R,
}

impl<R: Real> FrameMode<R> {
    /// At rest, also the rates of one that is off.
    #[inline]
    pub fn rest() -> FrameState<R> {
        let zero = R::from(0.0);
        FrameState { deflection: zero, velocity: zero }
    }

    /// Acceleration of the spring and the damper alone, `ω² y + 2 ζ ω y'`: over the mass the force that lifts the body.
    #[inline]
    pub fn pull(&self, state: FrameState<R>) -> R {
        let omega = self.frequency * TAU;
        omega * (omega * state.deflection + self.damping_ratio * 2.0 * state.velocity)
    }

    /// The state's rates on a body of this acceleration.
    #[inline]
    pub fn rates(&self, state: FrameState<R>, pull: R, acceleration: R) -> FrameState<R> {
        FrameState { deflection: state.velocity, velocity: -acceleration - pull }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MODE: FrameMode<f64> = FrameMode { mass: 2.0, frequency: 30.0, damping_ratio: 0.02 };

    #[test]
    fn on_a_body_of_steady_acceleration_it_is_more_mass() {
        // y = −a/ω² stays, and m_f (ω² y) = −m_f a.
        let omega = 30.0 * TAU;
        let state = FrameState { deflection: -3.0 / (omega * omega), velocity: 0.0 };
        let pull = MODE.pull(state);
        assert!((MODE.mass * pull + 2.0 * 3.0).abs() < 1e-12);
        assert!(MODE.rates(state, pull, 3.0).velocity.abs() < 1e-12);
    }

    proptest! {
        /// Power into spring and swinging mass is what the body gives, less what the damper takes.
        #[test]
        fn it_takes_energy(y in -0.01..0.01_f64, rate in -1.0..1.0_f64, a in -10.0..10.0_f64, body in -1.0..1.0_f64) {
            let state = FrameState { deflection: y, velocity: rate };
            let (omega, pull) = (30.0 * TAU, MODE.pull(state));
            let rates = MODE.rates(state, pull, a);
            let stored = MODE.mass
                * (omega * omega * y * rate + (body + rate) * (a + rates.velocity));
            let given = -MODE.mass * pull * body;
            prop_assert!(given - stored >= -1e-6, "{given} {stored}");
        }
    }
}
