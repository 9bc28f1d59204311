//! The pump actuator of Ajala about rest, with two states.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{About, Equation, Experiment, Instant, Kind, Model, Real, Variables, bundles};

use crate::elements::{Gas, Pump};

use super::pump_hydraulic_actuator::{Input, Options, Power, PumpHydraulicActuator, Rotor, Speed};

/// The linearised and reduced actuator, Ajala eq. 18: a mass on a spring and a damper (eq. 25, 26).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpHydraulicActuatorLinear {
    locked: bool,
}

/// What the actuator is made of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Pump
    pub pump: Pump<R>,
    /// Motor
    pub motor: Rotor<R>,
    /// Piston
    pub piston: Piston<R>,
    /// Gas
    pub gas: Gas<R>,
    /// Valve
    pub valve: Valves<R>,
}

/// The piston, its rod being on both sides.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Piston<R> {
    /// Area in both chambers (A_0)
    #[var(unit = M2, start = 9.4e-4, min = 1e-6)]
    pub area: R,
}

/// Between the chambers and their accumulators.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Valves<R> {
    /// Resistance of the valve on the compression side at rest (c_k0)
    #[var(unit = PA_S_PER_M3, start = 8e8, min = 0.0)]
    pub compression_resistance: R,
    /// Resistance of the valve on the rebound side at rest (c_r0)
    #[var(unit = PA_S_PER_M3, start = 8e8, min = 0.0)]
    pub rebound_resistance: R,
}

impl<R: Real> Valves<R> {
    /// c_k0 + c_r0, all that counts in eq. 18.
    #[inline]
    fn resistance(&self) -> R {
        self.compression_resistance + self.rebound_resistance
    }
}

/// What goes on inside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Motor
    pub motor: Speed<R>,
    /// Pressure of the gas
    pub pressure: Difference<R>,
}

/// Between the sides.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Difference<R> {
    /// On the side that compression fills above that on the other (Δp = p_ks − p_rs)
    #[var(unit = PA, nominal = 1e5, output)]
    pub difference: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Force that pushes body and wheel apart, less the static one (F_a − F_a0)
    #[var(unit = N)]
    pub force: R,
    /// Motor
    pub motor: Power<R>,
}

/// What follows from the parameters: the equivalent mechanical system.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Mass that motor and pump are, seen from the piston (m)
    #[var(unit = KG)]
    pub mass: R,
    /// Rate of the gas (k)
    #[var(unit = N_PER_M)]
    pub stiffness: R,
    /// Damping rate of the valves (c)
    #[var(unit = N_S_PER_M)]
    pub damping: R,
    /// Undamped natural frequency of the mass with the piston held (ω_0/2π)
    #[var(unit = HZ)]
    pub natural_frequency: R,
    /// Damping ratio of the mass with the piston held (ζ)
    #[var(unit = ONE)]
    pub damping_ratio: R,
    /// Angle that the pump turns by for a way of the piston; the force of a torque (2π A_0/V_c)
    #[var(unit = RAD_PER_M)]
    pub gear: R,
}

impl Model for PumpHydraulicActuatorLinear {
    const ABOUT: About = About {
        name: "PumpHydraulicActuatorLinear",
        summary: "The pump actuator about rest: pressure difference and motor speed, or a mass on a spring and \
            a damper",
        kind: Kind::Actuator,
        equations: &[
            Equation {
                text: "q = V_c/2pi omega - A_0 v, v = suspension.velocity = -z_e'",
                source: "Ajala eq. 9",
            },
            Equation { text: "Dp' = kappa (p_0/V_k0 + p_0/V_r0) q", source: "Ajala eq. 18" },
            Equation { text: "P = Dp + (c_k0 + c_r0) q", source: "Ajala eq. 7, 18" },
            Equation { text: "J_m omega' = T_m - V_c/2pi P", source: "Ajala eq. 18" },
            Equation { text: "F = A_0 P", source: "Ajala eq. 18" },
            Equation {
                text: "m = (2pi A_0/V_c)^2 J_m, k = kappa A_0^2 (p_0/V_k0 + p_0/V_r0), c = A_0^2 (c_k0 + c_r0)",
                source: "Ajala eq. 25",
            },
            Equation {
                text: "F = c (z_e - z_m)' + k (z_e - z_m), m z_m'' = F - F_m, z_m' = -V_c/(2pi A_0) omega, F_m \
                    = 2pi A_0/V_c T_m",
                source: "Ajala eq. 24, 26: the same, as a mechanical system",
            },
        ],
        notes: &[
            "Ajala's deflection z_e counts positive in compression; suspension.velocity counts positive in \
             rebound.",
            "The force is the deviation from the static one; with equal areas there is no static force.",
            "Ajala calls both pressure equations dependent before it lets A_k = A_r = A_0 (2.2). They are \
             dependent only because of that, and their difference is a state of its own only then.",
            "Eq. 26b has the mass pushed down by the force and up by F_m when z_m counts as z_e does: m z_m'' \
             = F_a - F_m. Signs of (24) and (26) are right as printed; checked against (18).",
            "The document gives no values. Those declared make m = 79.9 kg, k = 13.8 kN/m, c = 1414 N.s/m, \
             2.09 Hz and a damping ratio of 0.67; the reasons stand in the parameter set.",
        ],
        experiment: Experiment {
            plot: &["force", "motor.speed", "pressure.difference"],
            ..PumpHydraulicActuator::ABOUT.experiment
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Input,
        state: State,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { locked: options.locked })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let gear = p.piston.area / p.pump.per_radian();
        let mass = gear.squared() * p.motor.inertia;
        let stiffness = p.gas.exponent * p.piston.area.squared() * p.gas.pressure_per_volumes_at_rest();
        let damping = p.piston.area.squared() * p.valve.resistance();
        Derived {
            mass,
            stiffness,
            damping,
            natural_frequency: (stiffness / mass).sqrt() / TAU,
            damping_ratio: damping / ((stiffness * mass).sqrt() * 2.0),
            gear,
        }
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p) = (now.state, now.input, now.parameters);
        let flow = p.pump.per_radian() * x.motor.speed - p.piston.area * u.suspension.velocity;
        let pressure = x.pressure.difference + p.valve.resistance() * flow;
        let torque = u.motor.torque - p.pump.per_radian() * pressure;
        let acceleration = if self.locked { R::from(0.0) } else { torque / p.motor.inertia };
        let rates = State {
            motor: Speed { speed: acceleration },
            pressure: Difference { difference: p.gas.exponent * p.gas.pressure_per_volumes_at_rest() * flow },
        };
        let output = Output {
            force: p.piston.area * pressure,
            motor: Power { power: u.motor.torque * x.motor.speed },
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
