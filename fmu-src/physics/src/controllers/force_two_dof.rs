//! Force control with two degrees of freedom: reference and disturbance shaped apart.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Stimulus, Variables,
    bundles,
};

use crate::elements::Pump;
use crate::signals::{Deflection, Pushing, Speed, Torque};

use super::filters::{self, LowPassRate, MAX_ORDER, Pid, PidMemory, Section, waiting};
use super::force_pid::{Area, Limit, Output};

/// Inverse model, disturbance controller, weak force feedback and an inner velocity loop: Ajala 3.2, Fig. 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceTwoDof {
    order: usize,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Order of the high-pass with which the passive behaviour begins (n), 1 to 4
    #[set(name = "disturbance.order", start = 2)]
    pub(super) order: i32,
}

/// Model of the actuator, filters and gains. The declared values fit the declared actuator (assumed).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
    /// What the actuator is taken for
    pub plant: Plant<R>,
    /// Disturbance controller
    pub disturbance: Disturbance<R>,
    /// Feedback of the force
    pub force: ForceGain<R>,
    /// Feedback of the mass's velocity
    pub velocity: VelocityGain<R>,
    /// Pump of the actuator
    pub pump: Pump<R>,
    /// Piston of the actuator
    pub piston: Area<R>,
    /// Limit of the torque
    pub torque: Limit<R>,
}

/// The passive actuator, eq. 25.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Plant<R> {
    /// Rate of the gas (k)
    #[var(unit = N_PER_M, start = 13784.16, min = 1.0)]
    pub stiffness: R,
    /// Damping rate of the valves (c)
    #[var(unit = N_S_PER_M, start = 1413.76, min = 1e-3)]
    pub damping: R,
}

/// What is done about deflections, eq. 41 and 42.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Disturbance<R> {
    /// Frequency below which deflections make no force, above which the actuator is as if passive (f_c)
    #[var(unit = HZ, start = 2.0, min = 1e-3)]
    pub cut_off: R,
}

/// From force error to velocity (K_ss, with the sign that makes it stable).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ForceGain<R> {
    /// Of the error itself
    #[var(unit = M_PER_S_N, start = 5e-5, min = 0.0)]
    pub proportional: R,
    /// Of its integral
    #[var(unit = M_PER_S2_N, start = 1.5e-5, min = 0.0)]
    pub integral: R,
}

/// From velocity error to force.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct VelocityGain<R> {
    /// Of the error itself
    #[var(unit = N_S_PER_M, start = 24e3, min = 0.0)]
    pub proportional: R,
    /// Of its integral
    #[var(unit = N_PER_M, start = 960e3, min = 0.0)]
    pub integral: R,
    /// Of its derivative
    #[var(unit = KG, start = 0.0, min = 0.0)]
    pub derivative: R,
    /// Lag of the derivative
    #[var(unit = S, start = 2e-3, min = 1e-6)]
    pub derivative_lag: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Force that is wanted, positive if it pushes body and wheel apart (F_a,ref)
    #[var(unit = N)]
    pub force_reference: R,
    /// Actuator
    pub actuator: Pushing<R>,
    /// Suspension
    pub suspension: Deflection<R>,
    /// Motor
    pub motor: Speed<R>,
}

/// What is held between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Motor
    pub motor: Torque<R>,
    /// Of the inverse model
    #[var(unit = M_PER_S)]
    pub feed_forward: R,
    /// Of the chain of high-passes
    #[var(unit = M)]
    pub disturbance: [R; MAX_ORDER],
    /// Of the integral of the force error
    #[var(unit = M_PER_S)]
    pub force: R,
    /// Of the velocity loop
    pub velocity: PidMemory<R>,
}

impl Model for ForceTwoDof {
    const ABOUT: About = About {
        name: "ForceTwoDof",
        summary: "Force controller of the pump actuator with two degrees of freedom: inverse model and \
            disturbance controller, weak force feedback, inner velocity loop",
        kind: Kind::Controller,
        equations: &[
            Equation {
                text: "z_e = -suspension.deflection, v_m = -V_c/(2pi A_0) omega_m",
                source: "Ajala eq. 24, 26",
            },
            Equation {
                text: "v_ref = -s/(c s + k) F_ref + K_dd z_e - K_ss (F_ref - F_a), K_ss = K_p + K_i/s",
                source: "Ajala eq. 33, 36; sign of K_ss",
            },
            Equation {
                text: "K_dd = s (1 - G^n) = w (G + .. + G^n), G = s/(s + w), w = 2pi f_c",
                source: "Ajala eq. 32, 41, 42",
            },
            Equation { text: "F_m = -PID(v_ref - v_m)", source: "Ajala 3.2: internal PID feedback loop" },
            Equation { text: "T_m = V_c/(2pi A_0) F_m, |T_m| <= limit", source: "Ajala eq. 24" },
        ],
        notes: &[
            "Ajala eq. 36 adds +K_ss (F_ref - F_a) to the velocity. By eq. 35 a higher velocity is a lower \
             force, so the loop is s - K_ss (c s + k) = 0 and stable for negative gains only: with K_ss = \
             K_p + K_i/s as printed, s^2 (1 - K_p c) - (K_p k + K_i c) s - K_i k. The gains here are positive \
             and the sign stands in the law; checked in the closed loop.",
            "Ajala 3.2 derives eq. 37 by \"substituting (34) in (33), and the result in (32)\"; it is (36) in \
             (35), compared with (34). Eq. 31 to 42 themselves are right.",
            "All filters are discretised by the bilinear transform. The disturbance controller differentiates \
             nothing: s (1 - G^n) is a sum of high-passes. At the torque limit both integrals wait, and a \
             reference beyond the force that the limit can hold is cut to it: the feed-forward would wind up \
             otherwise.",
            "The document gives neither order nor cut-off nor gains.",
        ],
        experiment: Experiment {
            stop: 1.0,
            step: 1e-3,
            stimuli: &[
                ("force_reference", Stimulus::Step { at: 0.1, height: 100.0 }),
                ("suspension.deflection", Stimulus::Sine { amplitude: 0.002, frequency: 2.0 }),
            ],
            plot: &["motor.torque"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, input: Input, memory: Memory, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { order: filters::order(options.order)? })
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (u, p, before) = (now.input, now.parameters, now.memory);
        let (one, zero) = (R::from(1.0), R::from(0.0));

        let torque_of_force = p.pump.per_radian() / p.piston.area;
        let limit = p.torque.limit / torque_of_force;
        // More than the motor can hold would lead the inverse model away from the actuator.
        let reference = u.force_reference.clamp(-limit, limit);

        let inverse = Section::new([-one, zero], [p.plant.damping, p.plant.stiffness], p.period);
        let (wanted, feed_forward) = inverse.step(before.feed_forward, reference);

        let rate = LowPassRate { order: self.order, omega: p.disturbance.cut_off * TAU };
        let (yielding, disturbance) = rate.step(&before.disturbance, -u.suspension.deflection, p.period);

        let error = reference - u.actuator.force;
        let integral = Section::integrator(p.force.integral, p.period);
        let (integral, integrated) = integral.step(before.force, error);
        let corrected = p.force.proportional * error + integral;

        let velocity = -(torque_of_force * u.motor.speed);
        let missing = velocity - (wanted + yielding - corrected);
        let pid = Pid {
            proportional: p.velocity.proportional,
            integral: p.velocity.integral,
            derivative: p.velocity.derivative,
            lag: p.velocity.derivative_lag,
        };
        let action = pid.step(&before.velocity, missing, limit, p.period);
        Memory {
            motor: Torque { torque: torque_of_force * action.output },
            feed_forward,
            disturbance,
            force: waiting(action.excess * error, before.force, integrated),
            velocity: action.memory,
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { motor: now.memory.motor })
    }
}

#[cfg(test)]
mod tests;
