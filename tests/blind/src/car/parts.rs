//! Parts of a car beyond its masses, strut and tyre.

use std::f64::consts::TAU;

/// A state feedback: it runs at 1 kHz and holds its force meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regulator {
    /// Force against the strut's deflection in N/m, the body's velocity in N s/m, the tyre's deflection in N/m and the wheel's
    /// velocity in N s/m.
    pub gains: [f64; 4],
}

impl Regulator {
    /// Steps of the integration in one of its own.
    pub(super) const HELD: usize = 20;

    pub(super) fn force(&self, [body, body_velocity, wheel, wheel_velocity]: [f64; 4], road: f64) -> f64 {
        let state = [body - wheel, body_velocity, wheel - road, wheel_velocity];
        -self.gains.iter().zip(state).map(|(gain, x)| gain * x).sum::<f64>()
    }
}

/// A mode of the frame: a mass on a spring and a damper on the body, beside the sprung mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// In kg.
    pub mass: f64,
    /// Of the mass on the body held fast, in Hz.
    pub frequency: f64,
    /// Damping over the critical one.
    pub damping_ratio: f64,
}

impl Frame {
    /// The acceleration of its mass that is `y` m above its place on the body and rises over it by `rate` m/s.
    pub(crate) fn acceleration(&self, y: f64, rate: f64) -> f64 {
        let omega = TAU * self.frequency;
        -omega * (omega * y + 2.0 * self.damping_ratio * rate)
    }
}

/// From the commanded force to the one that acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// In s, exact.
    pub delay: f64,
    /// Time constant in s; zero is none.
    pub lag: f64,
    /// Force for a commanded newton.
    pub gain: f64,
    /// Largest force to each side, in N.
    pub limit: f64,
    /// Largest rate at which the force changes, in N/s.
    pub slew: f64,
}

impl Actuator {
    /// The force that it makes of a command in N, before its lag.
    pub fn made_of(&self, command: f64) -> f64 {
        (self.gain * command).clamp(-self.limit, self.limit)
    }

    /// The force `after` seconds later than it was `before`, on its way to what is made of the command.
    pub(super) fn reached(&self, before: f64, made: f64, after: f64) -> f64 {
        made.clamp(before - self.slew * after, before + self.slew * after)
    }
}

impl Default for Actuator {
    fn default() -> Self {
        Self { delay: 0.0, lag: 0.0, gain: 1.0, limit: f64::INFINITY, slew: f64::INFINITY }
    }
}

/// A second path of the commanded force: through a hose or the frame it reaches the body alone, later.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crosstalk {
    /// Newton on the body for a commanded newton.
    pub gain: f64,
    /// In s, exact.
    pub delay: f64,
}
