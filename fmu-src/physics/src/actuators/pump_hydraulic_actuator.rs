//! The pump actuator of Ajala: a shock absorber with two gas accumulators, and a pump across it.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::elements::{Gas, PistonWithPreload, PumpWithLosses, Valve, Valves};
use crate::signals::{Pressures, Torque, TravelRate};

/// Cylinder, two valves, two accumulators, pump and motor: Ajala eq. 1–16.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpHydraulicActuator {
    locked: bool,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// The pump is held, whatever the motor does: the passive actuator
    #[set(name = "pump.locked", start = false)]
    pub(super) locked: bool,
}

/// What the actuator is made of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Pump
    pub pump: PumpWithLosses<R>,
    /// Motor
    pub motor: Rotor<R>,
    /// Piston
    pub piston: PistonWithPreload<R>,
    /// Gas
    pub gas: Gas<R>,
    /// Valve
    pub valve: Valves<R>,
}

/// What turns.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Rotor<R> {
    /// Moment of inertia of motor and pump (J_m)
    #[var(unit = KG_M2, start = 3.3e-4, min = 1e-9)]
    pub inertia: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Motor
    pub motor: Torque<R>,
    /// Suspension
    pub suspension: TravelRate<R>,
}

/// What goes on inside: the x̂ of eq. 17, which is zero at rest whatever the charge pressure.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Motor
    pub motor: Speed<R>,
    /// Pressure above that at rest
    pub overpressure: Overpressure<R>,
}

/// Of the motor.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Speed<R> {
    /// Speed of motor and pump, positive if the pump fills the compression side (ω_m)
    #[var(unit = RAD_PER_S, nominal = 10.0, output)]
    pub speed: R,
}

/// Of the gas.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Overpressure<R> {
    /// In the accumulator that compression fills (p_ks − p_0)
    #[var(unit = PA, nominal = 1e5)]
    pub compression: R,
    /// In the accumulator that rebound fills (p_rs − p_0)
    #[var(unit = PA, nominal = 1e5)]
    pub rebound: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Force that pushes body and wheel apart, less the static one (F_a − F_a0)
    #[var(unit = N)]
    pub force: R,
    /// Force that pushes body and wheel apart (F_a)
    #[var(unit = N)]
    pub total_force: R,
    /// Pressure of the gas, absolute
    pub pressure: Pressures<R>,
    /// Pressure on the piston, absolute; the model is at its end where it falls to zero
    pub chamber: Pressures<R>,
    /// Motor
    pub motor: Power<R>,
}

/// What the motor gives.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Power<R> {
    /// Mechanical power, negative where the pump drives the motor (T_m ω_m)
    #[var(unit = W)]
    pub power: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Force at rest, which helps to carry the body ((A_k − A_r) p_0)
    #[var(unit = N)]
    pub static_force: R,
}

impl Model for PumpHydraulicActuator {
    const ABOUT: About = About {
        name: "PumpHydraulicActuator",
        summary: "Shock absorber with two gas accumulators, two valve characteristics and a motor-driven pump \
            across it",
        kind: Kind::Actuator,
        equations: &[
            Equation {
                text: "q_k = q_m - v A_k - q_l, q_r = -q_m + v A_r + q_l, q_m = V_c/2pi omega + q_0, v = \
                    suspension.velocity",
                source: "Ajala eq. 5, 9 with z_e' = -v; leak: below; q_0: port of diagnosis",
            },
            Equation {
                text: "q_l = C_l (p_k - p_r), p_k and p_r with q_l = 0",
                source: "docs/effects.md: 30; law: Konieczny eq. 2.11",
            },
            Equation {
                text: "p_ks' = kappa q_k p_ks/V_ks, p_rs' = kappa q_r p_rs/V_rs, V = V_0 (p_0/p)^(1/kappa)",
                source: "Ajala eq. 2, 3, 46",
            },
            Equation {
                text: "p_k = p_ks + dp_k(q_k), p_r = p_rs + dp_r(q_r)",
                source: "Ajala eq. 7, 8; dp from tables",
            },
            Equation {
                text: "J_m omega' = T_m - V_c/2pi (p_k - p_r) - T_f tanh(omega/omega_f) - T_0",
                source: "Ajala eq. 4; friction, docs/effects.md 32c: TUM eq. 12; T_0: port of diagnosis",
            },
            Equation {
                text: "F_a = p_k A_k - p_r A_r - F_0, force = F_a - (A_k - A_r) p_0",
                source: "Ajala eq. 6; F_0: port of diagnosis",
            },
        ],
        notes: &[
            "Ajala's deflection z_e counts positive in compression (eq. 26, 27: wheel minus body); \
             suspension.velocity here counts positive in rebound.",
            "The rig's static equilibrium has the static force in it already: what a rig takes is `force`, \
             its deviation. The states are deviations from rest as well (x̂ of eq. 17): zero is rest, \
             whatever the charge pressure.",
            "Ajala eq. 6 has absolute pressures (eq. 1 needs them) and leaves out the atmosphere on the rod, \
             some (A_k - A_r) 1e5 Pa = 16 N less in total_force. It is constant and not part of `force`.",
            "Ajala calls both pressure equations of the linearised model dependent and then lets A_k = A_r \
             (2.2); they are dependent only because of that: the rates stand as (q_m + z_e' A_k) to (q_m + \
             z_e' A_r). This model keeps both pressures, and the locked actuator has the static rate kappa \
             p_0 (A_k^2/V_k0 + A_r^2/V_r0).",
            "The document gives no values. Those declared are for the corner of a mid-size car with soft \
             valves; the reasons stand in the parameter sets.",
            "Both tables have the same slope on either side of rest, so that the c_k0, c_r0 of the \
             linearised model (17) exist. With a kink at rest they would not.",
            "Oil does not compress. Ajala's pump neither leaks nor rubs, nor does this one with the start \
             values of pump.leakage and pump.coulomb. The pressure difference that drives the leak is that \
             without it, or there would be an algebraic loop: the leak is too large by C_l (c_k + c_r) times \
             itself, a few per cent at 1e-11 m5/(N.s). A locked pump leaks, too. motor.power is that of the \
             motor's torque, before friction.",
            "A locked pump holds the speed it starts with, which is zero unless said otherwise.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            tolerance: 1e-7,
            stimuli: &[
                ("suspension.velocity", Stimulus::Sine { amplitude: 0.3, frequency: 1.5 }),
                ("motor.torque", Stimulus::Step { at: 1.0, height: 1.0 }),
            ],
            plot: &["force", "motor.speed", "pressure.compression", "pressure.rebound"],
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
        let rod = p.piston.ideal.compression_area - p.piston.ideal.rebound_area;
        Derived { static_force: rod * p.gas.charge_pressure }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.valve.check("valve")?;
        p.pump.check("pump", p.valve.compression.steepest() + p.valve.rebound.steepest())
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p) = (now.state, now.input, now.parameters);
        let (area, gas, speed) = (p.piston.ideal, p.gas, x.motor.speed);
        let closing = -u.suspension.velocity;

        let compression = |flow| Side {
            flow,
            overpressure: x.overpressure.compression,
            volume_at_rest: gas.compression_volume,
            valve: &p.valve.compression,
        };
        let rebound = |flow| Side {
            flow,
            overpressure: x.overpressure.rebound,
            volume_at_rest: gas.rebound_volume,
            valve: &p.valve.rebound,
        };
        let pumped = p.pump.pumped(speed);
        let tight = [pumped + closing * area.compression_area, -pumped - closing * area.rebound_area];
        let [into_compression, into_rebound] =
            p.pump.leaked(tight, || compression(tight[0]).on_piston() - rebound(tight[1]).on_piston());
        let (compression, rebound) = (compression(into_compression), rebound(into_rebound));
        let (on_compression, on_rebound) = (compression.on_piston(), rebound.on_piston());

        let torque = u.motor.torque - p.pump.resistance(|| on_compression - on_rebound, speed);
        let acceleration = if self.locked { R::from(0.0) } else { torque / p.motor.inertia };
        let rates = State {
            motor: Speed { speed: acceleration },
            overpressure: Overpressure { compression: compression.rate(&gas), rebound: rebound.rate(&gas) },
        };

        let force = p.piston.force(on_compression, on_rebound);
        let absolute = |compression, rebound| Pressures {
            compression: gas.charge_pressure + compression,
            rebound: gas.charge_pressure + rebound,
        };
        let output = Output {
            force,
            total_force: now.derived.static_force + force,
            pressure: absolute(x.overpressure.compression, x.overpressure.rebound),
            chamber: absolute(on_compression, on_rebound),
            motor: Power { power: u.motor.torque * speed },
        };
        (rates, output)
    }
}

/// A chamber of the cylinder with its valve and its accumulator.
struct Side<'a, R> {
    flow: R,
    overpressure: R,
    volume_at_rest: R,
    valve: &'a Valve<R>,
}

impl<R: Real> Side<'_, R> {
    /// Pressure on the piston above that at rest (eq. 7).
    #[inline]
    fn on_piston(&self) -> R {
        self.overpressure + self.valve.pressure_drop(self.flow)
    }

    /// How fast the pressure of the gas rises (eq. 2, 3).
    #[inline]
    fn rate(&self, gas: &Gas<R>) -> R {
        gas.exponent * self.flow * gas.pressure_per_volume(self.overpressure, self.volume_at_rest)
    }
}

#[cfg(test)]
mod tests;
