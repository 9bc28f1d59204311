//! Force control by feedback alone.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use crate::elements::Pump;
use crate::signals::{Pushing, Torque};

use super::filters::{Pid, PidMemory};

/// PID of the actuator force, Ajala 3.1 and Fig. 2a, sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForcePid;

/// Gains, and what turns a force into a torque. The declared gains are those of high bandwidth (assumed).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
    /// Gain on the force error
    pub gain: Gain<R>,
    /// Pump of the actuator
    pub pump: Pump<R>,
    /// Piston of the actuator
    pub piston: Area<R>,
    /// Limit of the torque
    pub torque: Limit<R>,
}

/// From force error to force.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Gain<R> {
    /// Of the error itself
    #[var(unit = ONE, start = 8.0, min = 0.0)]
    pub proportional: R,
    /// Of its integral
    #[var(unit = PER_S, start = 100.0, min = 0.0)]
    pub integral: R,
    /// Of its derivative
    #[var(unit = S, start = 0.025, min = 0.0)]
    pub derivative: R,
    /// Lag of the derivative
    #[var(unit = S, start = 4e-3, min = 1e-6)]
    pub derivative_lag: R,
}

/// The piston, as the controller has it.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Area<R> {
    /// Area, the mean of both sides (A_0)
    #[var(unit = M2, start = 9.4e-4, min = 1e-6)]
    pub area: R,
}

/// What the motor can do.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Limit<R> {
    /// Largest torque
    #[var(unit = N_M, start = 8.0, min = 0.0)]
    pub limit: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Force that is wanted, positive if it pushes body and wheel apart (F_a,ref)
    #[var(unit = N)]
    pub force_reference: R,
    /// Actuator
    pub actuator: Pushing<R>,
}

/// What is held between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Motor
    pub motor: Torque<R>,
    /// Force
    pub force: PidMemory<R>,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Motor
    pub motor: Torque<R>,
}

impl Model for ForcePid {
    const ABOUT: About = About {
        name: "ForcePid",
        summary: "Force controller of the pump actuator: PID of the force error, with a torque limit",
        kind: Kind::Controller,
        equations: &[
            Equation { text: "e = F_ref - F_a", source: "Ajala 3.1, Fig. 2a" },
            Equation {
                text: "F_m = K_p e + K_i integral of e + K_d s/(T_d s + 1) e",
                source: "Ajala 3.1; the lag of the derivative is ours",
            },
            Equation { text: "T_m = V_c/(2pi A_0) F_m, |T_m| <= limit", source: "Ajala eq. 24" },
        ],
        notes: &[
            "Integral and derivative are discretised by the bilinear transform. At the torque limit the \
             integral waits (anti-windup). The torque is held between samples.",
            "The document gives no gains. PID-H and PID-L are parameter sets, chosen by the shape of Fig. 2b.",
            "A force that does not depend on the deflection cannot damp the wheel: with eq. 27, which has no \
             damper, the wheel mode of an ideally controlled car is undamped. The derivative is what keeps \
             PID-H from exciting it.",
        ],
        experiment: Experiment {
            stop: 1.0,
            step: 1e-3,
            stimuli: &[
                ("force_reference", Stimulus::Step { at: 0.1, height: 100.0 }),
                ("actuator.force", Stimulus::Sine { amplitude: 50.0, frequency: 2.0 }),
            ],
            plot: &["motor.torque"],
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
        let (u, p, gain) = (now.input, now.parameters, now.parameters.gain);
        let pid = Pid {
            proportional: gain.proportional,
            integral: gain.integral,
            derivative: gain.derivative,
            lag: gain.derivative_lag,
        };
        let torque_of_force = p.pump.per_radian() / p.piston.area;
        let error = u.force_reference - u.actuator.force;
        let action = pid.step(&now.memory.force, error, p.torque.limit / torque_of_force, p.period);
        Memory { motor: Torque { torque: torque_of_force * action.output }, force: action.memory }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { motor: now.memory.motor })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations};

    fn parameters() -> Parameters<f64> {
        let declared = Declarations::of::<Parameters<f64>>();
        Bundle::from_fn(|i| declared[i].start)
    }

    fn tick(p: &Parameters<f64>, memory: &Memory<f64>, reference: f64, force: f64) -> Memory<f64> {
        ForcePid.tick(Instant {
            time: 0.0,
            state: &NoVariables,
            input: &Input { force_reference: reference, actuator: Pushing { force } },
            parameters: p,
            derived: &NoVariables,
            memory,
            tick: 0,
        })
    }

    /// Eq. 24: with a piston of A_0 and a pump of V_c, F_m = 2π A_0/V_c T_m.
    #[test]
    fn the_torque_of_a_newton_is_equation_24() {
        let mut p = parameters();
        p.gain = Gain { proportional: 1.0, integral: 0.0, derivative: 0.0, derivative_lag: 1e-3 };
        let memory = tick(&p, &Bundle::from_fn(|_| 0.0), 1000.0, 0.0);
        let expected = 1000.0 * 12e-6 / (std::f64::consts::TAU * 9.4e-4);
        assert!((memory.motor.torque - expected).abs() < 1e-12, "{}", memory.motor.torque);
    }

    /// The equivalent mechanical system (26) with the piston held: m z_m'' = F_a - F_m, F_a = -c z_m' - k z_m.
    #[test]
    fn on_the_held_actuator_the_force_comes_to_the_reference() {
        let (p, (m, k, c)) = (parameters(), (79.94, 13_784.0, 1413.8));
        let (mut memory, mut z, mut v) = (Bundle::from_fn(|_| 0.0), 0.0_f64, 0.0_f64);
        let mut force = 0.0;
        for _ in 0..2000 {
            memory = tick(&p, &memory, 500.0, force);
            let pushed = memory.motor.torque * std::f64::consts::TAU * 9.4e-4 / 12e-6;
            for _ in 0..20 {
                v += 5e-5 * (-c * v - k * z - pushed) / m;
                z += 5e-5 * v;
            }
            force = -c * v - k * z;
        }
        assert!((force - 500.0).abs() < 0.01, "{force}");
    }

    proptest! {
        #[test]
        fn the_torque_keeps_to_its_limit(forces in prop::collection::vec(-1e4..1e4_f64, 1..40)) {
            let (p, mut memory) = (parameters(), Bundle::from_fn(|_| 0.0));
            for force in forces {
                memory = tick(&p, &memory, 2000.0, force);
                prop_assert!(memory.motor.torque.abs() <= 8.0 + 1e-12);
            }
        }
    }
}
