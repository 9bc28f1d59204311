//! The force control with two degrees of freedom, for the nonlinear actuator.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{About, Equation, Instant, Kind, Model, NoVariables, Real, Variables, bundles};

use crate::elements::{Gas, Piston, Pump, Valves};
use crate::signals::{Pressures, Pushing, Speed, Torque, Travel};

use super::filters::{self, LowPassRate, MAX_ORDER, Pid, PidMemory, Section, waiting};
use super::force_pid::{Limit, Output};
use super::force_two_dof::{Disturbance, ForceTwoDof, Options};

/// The controller of [`ForceTwoDof`] with a model that is scheduled by what is measured: Ajala 4,
/// Fig. 5, eq. 45 and 46.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceTwoDofLpv {
    order: usize,
}

/// Model of the actuator, filters and gains. The declared values fit the declared actuator (assumed).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
    /// Disturbance controller
    pub disturbance: Disturbance<R>,
    /// Feedback of the force
    pub force: ForceGain<R>,
    /// Feedback of the motor's speed
    pub speed: SpeedGain<R>,
    /// Limit of the torque
    pub torque: Limit<R>,
    /// Pump of the actuator
    pub pump: Pump<R>,
    /// Piston of the actuator
    pub piston: Piston<R>,
    /// Gas of the actuator
    pub gas: Gas<R>,
    /// Valve of the actuator
    pub valve: Valves<R>,
}

/// From force error to speed (K_ss).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ForceGain<R> {
    /// Of the error itself
    #[var(unit = RAD_PER_S_N, start = 0.025, min = 0.0)]
    pub proportional: R,
    /// Of its integral
    #[var(unit = RAD_PER_S2_N, start = 0.0075, min = 0.0)]
    pub integral: R,
}

/// From speed error to torque.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct SpeedGain<R> {
    /// Of the error itself
    #[var(unit = N_M_S_PER_RAD, start = 0.1, min = 0.0)]
    pub proportional: R,
    /// Of its integral
    #[var(unit = N_M_PER_RAD, start = 4.0, min = 0.0)]
    pub integral: R,
    /// Of its derivative
    #[var(unit = N_M_S2_PER_RAD, start = 0.0, min = 0.0)]
    pub derivative: R,
    /// Lag of the derivative
    #[var(unit = S, start = 2e-3, min = 1e-6)]
    pub derivative_lag: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Force that is wanted, positive if it pushes body and wheel apart, less the static one (F_a,ref)
    #[var(unit = N)]
    pub force_reference: R,
    /// Actuator
    pub actuator: Pushing<R>,
    /// Suspension
    pub suspension: Travel<R>,
    /// Motor
    pub motor: Speed<R>,
    /// Pressure of the gas, absolute
    pub pressure: Pressures<R>,
}

/// What is held between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Motor
    pub motor: Torque<R>,
    /// Force of the gas in the inverse model
    #[var(unit = N)]
    pub gas_force: R,
    /// Of the chain of high-passes
    #[var(unit = M)]
    pub disturbance: [R; MAX_ORDER],
    /// Of the integral of the force error
    #[var(unit = RAD_PER_S)]
    pub force: R,
    /// Of the speed loop
    pub speed: PidMemory<R>,
}

/// The frozen actuator: force per pump flow and per rate of compression, at once and with time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scheduled<R> {
    /// c_k A_k + c_r A_r.
    flow_damping: R,
    /// κ (A_k p_ks/V_ks + A_r p_rs/V_rs).
    flow_stiffness: R,
    /// c_k A_k² + c_r A_r².
    damping: R,
    /// κ (A_k² p_ks/V_ks + A_r² p_rs/V_rs).
    stiffness: R,
}

impl Model for ForceTwoDofLpv {
    const ABOUT: About = About {
        name: "ForceTwoDofLpv",
        summary: "Force controller of the nonlinear pump actuator: two degrees of freedom, scheduled by gas \
            pressures and valve flows",
        kind: Kind::Controller,
        equations: &[
            Equation {
                text: "p_ks/V_ks, p_rs/V_rs from the pressures; c_k(q_k), c_r(q_r) with q_k = V_c/2pi omega + A_k \
                    z_e', q_r = -V_c/2pi omega - A_r z_e', z_e' = -suspension.velocity",
                source: "Ajala eq. 9, 46",
            },
            Equation {
                text: "F = f + (c_k A_k + c_r A_r) q + (c_k A_k^2 + c_r A_r^2) w",
                source: "Ajala eq. 15, 45; solved for q with F = F_ref",
            },
            Equation {
                text: "f' = kappa (A_k p_ks/V_ks + A_r p_rs/V_rs) q + kappa (A_k^2 p_ks/V_ks + A_r^2 p_rs/V_rs) w",
                source: "Ajala eq. 10, 11, 45",
            },
            Equation {
                text: "w = K_dd z_e, K_dd = s (1 - G^n), G = s/(s + 2pi f_c)",
                source: "Ajala eq. 32, 41, 42",
            },
            Equation {
                text: "omega_ref = 2pi/V_c q + (K_p + K_i/s) (F_ref - F_a), T_m = PID(omega_ref - omega), |T_m| <= \
                    limit",
                source: "Ajala Fig. 5; gains positive, see ForceTwoDof",
            },
        ],
        notes: &[
            "The flowchart (Fig. 5) is lost; the law is the inverse of the parameter-varying model (45), driven \
             by the reference and the low-passed rate of compression w. With constant parameters it is q = \
             s/(C s + K) F_ref - s (C' s + K')/(C s + K) G_tp z_e, and with A_k = A_r eq. 33.",
            "The inverse keeps the force of the gas as its state and not the flow: it then stays exact while \
             the parameters vary. It is discretised by the bilinear transform (trapezoidal rule).",
            "Ajala 4 refers to eq. 43 and 44 where it means 45 and 46, and section 5 to the control law (27) \
             where it means 28.",
            "Reference and measured force are deviations from the static force. A pressure below a hundredth of \
             the charge pressure is taken for that. Limits act as in ForceTwoDof.",
        ],
        experiment: ForceTwoDof::ABOUT.experiment,
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, input: Input, memory: Memory, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { order: filters::order(options.order)? })
    }

    fn check(&self, p: &Parameters<f64>, _: &NoVariables) -> Result<(), String> {
        p.valve.check("valve")
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (u, p, before) = (now.input, now.parameters, now.memory);
        let scheduled = scheduled(u, p);
        // More than the motor can hold would lead the inverse model away from the actuator.
        let area = (p.piston.compression_area + p.piston.rebound_area) * 0.5;
        let limit = p.torque.limit / p.pump.per_radian() * area;
        let reference = u.force_reference.clamp(-limit, limit);

        let rate = LowPassRate { order: self.order, omega: p.disturbance.cut_off * TAU };
        let (yielding, disturbance) = rate.step(&before.disturbance, -u.suspension.deflection, p.period);
        let (flow, gas_force) = scheduled.inverse(before.gas_force, reference, yielding, p.period);

        let error = reference - u.actuator.force;
        let integral = Section::integrator(p.force.integral, p.period);
        let (integral, integrated) = integral.step(before.force, error);
        let wanted = flow / p.pump.per_radian() + p.force.proportional * error + integral;

        let pid = Pid {
            proportional: p.speed.proportional,
            integral: p.speed.integral,
            derivative: p.speed.derivative,
            lag: p.speed.derivative_lag,
        };
        let action = pid.step(&before.speed, wanted - u.motor.speed, p.torque.limit, p.period);
        Memory {
            motor: Torque { torque: action.output },
            gas_force,
            disturbance,
            force: waiting(action.excess * error, before.force, integrated),
            speed: action.memory,
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { motor: now.memory.motor })
    }
}

/// ρ of eq. 46, and what the matrices of eq. 45 are made of.
fn scheduled<R: Real>(u: &Input<R>, p: &Parameters<R>) -> Scheduled<R> {
    let (ak, ar, gas) = (p.piston.compression_area, p.piston.rebound_area, p.gas);
    let per_volume = |pressure: R, volume_at_rest: R| {
        let pressure = pressure.max(gas.charge_pressure * 0.01);
        gas.exponent * gas.pressure_per_volume(pressure - gas.charge_pressure, volume_at_rest)
    };
    let k = per_volume(u.pressure.compression, gas.compression_volume);
    let r = per_volume(u.pressure.rebound, gas.rebound_volume);
    let (pumped, closing) = (p.pump.per_radian() * u.motor.speed, -u.suspension.velocity);
    let ck = p.valve.compression.resistance(pumped + closing * ak);
    let cr = p.valve.rebound.resistance(-pumped - closing * ar);
    Scheduled {
        flow_damping: ck * ak + cr * ar,
        flow_stiffness: k * ak + r * ar,
        damping: ck * ak.squared() + cr * ar.squared(),
        stiffness: k * ak.squared() + r * ar.squared(),
    }
}

impl<R: Real> Scheduled<R> {
    /// The pump flow that makes `force` while the actuator is compressed at `rate`, and what is to be remembered of
    /// the force of the gas.
    fn inverse(&self, memory: R, force: R, rate: R, period: R) -> (R, R) {
        // With f = memory + T/2 f' the force is implicit in the flow.
        let half = period * 0.5;
        let flow = (force - memory - (self.damping + half * self.stiffness) * rate)
            / (self.flow_damping + half * self.flow_stiffness);
        let growth = self.flow_stiffness * flow + self.stiffness * rate;
        (flow, memory + period * growth)
    }
}

#[cfg(test)]
mod tests;
