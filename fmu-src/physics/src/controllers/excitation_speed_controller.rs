//! The controller that keeps the eccentric of the semi-active rig at its frequency.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use super::filters::{PidMemory, Section, waiting};

/// Position tracking and a PID controller of the velocity, Kogut 2.2, sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationSpeedController;

/// What the controller is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Position tracking
    pub position: Position<R>,
    /// Velocity stabilisation
    pub velocity: Velocity<R>,
    /// Largest duty cycle to either side
    #[var(unit = ONE, start = 1.0, min = 1e-3, max = 1.0)]
    pub duty_limit: R,
    /// Sampling period
    #[var(unit = S, start = 0.01, min = 1e-6, fixed)]
    pub period: R,
}

/// The angle follows that of a perfect eccentric.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Position<R> {
    /// Speed that is added for an angle that is missing; zero switches the tracking off
    #[var(unit = PER_S, start = 10.0, min = 0.0)]
    pub gain: R,
    /// How far the perfect eccentric may get away; then it waits
    #[var(unit = RAD, start = 1.0, min = 1e-3)]
    pub limit: R,
}

/// The speed follows the one that is wanted.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Velocity<R> {
    /// Duty cycle for a speed that is wanted, without load
    #[var(unit = S_PER_RAD, start = 0.0175, min = 0.0)]
    pub feedforward: R,
    /// Duty cycle for a speed that is missing (P)
    #[var(unit = S_PER_RAD, start = 0.03, min = 0.0)]
    pub proportional: R,
    /// The same for the integral of the speed that is missing (I)
    #[var(unit = PER_RAD, start = 0.8, min = 0.0)]
    pub integral: R,
    /// The same for its derivative (D)
    #[var(unit = S2_PER_RAD, start = 0.0, min = 0.0)]
    pub derivative: R,
    /// Time constant of the derivative's filter
    #[var(unit = S, start = 0.02, min = 1e-6)]
    pub derivative_filter: R,
}

/// What is wanted and what is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Frequency that is wanted
    #[var(unit = HZ)]
    pub frequency_reference: R,
    /// Eccentric
    pub eccentric: Turning<R>,
}

/// What the encoder says.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Turning<R> {
    /// Angle, growing from turn to turn (alpha_0)
    #[var(unit = RAD)]
    pub angle: R,
    /// Speed
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}

/// What is remembered from sample to sample.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Angle of the perfect eccentric
    #[var(unit = RAD)]
    pub angle: R,
    /// Frequency that was wanted
    #[var(unit = HZ)]
    pub frequency: R,
    /// Velocity stabilisation
    pub velocity: PidMemory<R>,
    /// Duty cycle
    #[var(unit = ONE)]
    pub duty: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Duty cycle of the motor
    #[var(unit = ONE)]
    pub duty: R,
}

impl Model for ExcitationSpeedController {
    const ABOUT: About = About {
        name: "ExcitationSpeedController",
        summary: "Controller of an eccentric's frequency: position tracking and a PID controller of the velocity, \
            sampled",
        kind: Kind::Controller,
        equations: &[
            Equation {
                text: "p' = 2 pi f_ref, |p - a_0| <= limit; w_ref = 2 pi f_ref + K (p - a_0)",
                source: "Kogut 2.2: position set-point tracking; law assumed",
            },
            Equation {
                text: "duty = F 2 pi f_ref + P e + I integral of e + D e', e = w_ref - w",
                source: "Kogut 2.2: velocity stabilisation with PID; law assumed",
            },
        ],
        notes: &[
            "Kogut 2.2 describes the controller in words and refers to a conference paper in Polish for the rest: a \
             heuristic combination of position set-point tracking and velocity stabilisation, PID included, at 100 Hz \
             (2.1). Here the position controller corrects the set point of the velocity controller. Structure and \
             gains are assumed: the integral's time, 38 ms, is about the time constant of the declared EccentricDrive, so \
             that the loop is nearly an integrator; it crosses over at 53 rad/s, half of where sample and hold would \
             make it swing, so that there is room for encoders and their differences. On the rig at 1.6 Hz it leaves \
             0.26 Hz between the largest and the smallest frequency of a turn, where a constant duty cycle leaves \
             1.3 Hz.",
            "Integral and phase by the trapezoidal rule, the derivative's filter by the bilinear transform. While the \
             duty cycle is at its limit the integral waits, and the perfect eccentric waits when it is too far ahead.",
            "At the first sample the perfect eccentric stands where the eccentric stands.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-2,
            stimuli: &[
                ("frequency_reference", Stimulus::Step { at: 0.5, height: 0.1 }),
                ("eccentric.speed", Stimulus::Sine { amplitude: 0.5, frequency: 1.0 }),
            ],
            plot: &["duty"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { parameters: Parameters, input: Input, memory: Memory, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (u, p, before) = (now.input, now.parameters, now.memory);
        let frequency = u.frequency_reference;

        let turned = before.angle + p.period * (before.frequency + frequency) * PI;
        let angle = if now.tick == 0 { u.eccentric.angle } else { turned };
        let ahead = (angle - u.eccentric.angle).clamp(-p.position.limit, p.position.limit);
        let missing = frequency * TAU + p.position.gain * ahead - u.eccentric.speed;

        let v = p.velocity;
        let integrator = Section::integrator(v.integral, p.period);
        let (integral, integrated) = integrator.step(before.velocity.integral, missing);
        let differentiator = Section::derivative(v.derivative, v.derivative_filter, p.period);
        let (derivative, derived) = differentiator.step(before.velocity.derivative, missing);
        let wanted = v.feedforward * frequency * TAU + v.proportional * missing + integral + derivative;
        let duty = wanted.clamp(-p.duty_limit, p.duty_limit);
        // The load and the feedforward count as well: it is the sum that is limited.
        let integral = waiting((wanted - duty) * missing, before.velocity.integral, integrated);
        let velocity = PidMemory { integral, derivative: derived };
        Memory { angle: u.eccentric.angle + ahead, frequency, velocity, duty }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { duty: now.memory.duty })
    }
}

#[cfg(test)]
mod tests;
