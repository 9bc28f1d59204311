//! A quarter car on a hydropneumatic strut: a gas spring with a damper, and a stop in compression.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, Real, Stimulus, Variables, unit,
};

/// Parameters
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Body's mass on this wheel (m_s)
    #[var(unit = unit::KG, start = 300.0, min = 1.0)]
    sprung_mass: R,
    /// Wheel's mass (m_u)
    #[var(unit = unit::KG, start = 40.0, min = 1.0)]
    unsprung_mass: R,
    /// Stiffness of the gas at rest (k); all of its force at rest carries the body
    #[var(unit = unit::N_PER_M, start = 12000.0, min = 1.0)]
    stiffness: R,
    /// Length that the gas would have in a cylinder as wide as the piston (l)
    #[var(unit = unit::M, start = 0.4, min = 0.2)]
    gas_length: R,
    /// Polytropic exponent (n)
    #[var(unit = unit::ONE, start = 1.3, min = 1.0, max = 1.7)]
    exponent: R,
    /// Damping rate (d)
    #[var(unit = unit::N_S_PER_M, start = 1400.0, min = 0.0)]
    damping: R,
    /// Compression at which the stop begins (c)
    #[var(unit = unit::M, start = 0.05, min = 0.0)]
    clearance: R,
    /// Stiffness of the stop (k_s)
    #[var(unit = unit::N_PER_M, start = 60000.0, min = 0.0)]
    stop_stiffness: R,
    /// Tyre's stiffness (k_t)
    #[var(unit = unit::N_PER_M, start = 190000.0, min = 0.0)]
    tire_stiffness: R,
}

/// The road under the tyre
#[derive(Variables, Clone, Copy)]
pub struct Road<R> {
    /// Height of the road (z_r)
    #[var(unit = unit::M)]
    position: R,
}

/// Inputs
#[derive(Variables, Clone, Copy)]
pub struct Input<R> {
    /// Road; a field that is a group names its variables `road.position` and so on.
    road: Road<R>,
    /// Further force between body and wheel that lifts the body (u)
    #[var(unit = unit::N)]
    strut_force: R,
}

/// A body that moves up and down
#[derive(Variables, Clone, Copy)]
pub struct Motion<R> {
    /// Height above rest (z)
    #[var(unit = unit::M, nominal = 0.01)]
    position: R,
    /// Velocity
    #[var(unit = unit::M_PER_S, nominal = 0.1)]
    velocity: R,
}

/// States
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// The car's body on this wheel
    body: Motion<R>,
    /// The wheel
    wheel: Motion<R>,
}

/// What an accelerometer measures
#[derive(Variables, Clone, Copy)]
pub struct Accelerometer<R> {
    /// Acceleration
    #[var(unit = unit::M_PER_S2)]
    acceleration: R,
}

/// The strut
#[derive(Variables, Clone, Copy)]
pub struct Suspension<R> {
    /// Deflection (x = z_s - z_u)
    #[var(unit = unit::M)]
    deflection: R,
    /// Rate of the deflection
    #[var(unit = unit::M_PER_S)]
    velocity: R,
}

/// Outputs
#[derive(Variables, Clone, Copy)]
pub struct Output<R> {
    /// The car's body
    body: Accelerometer<R>,
    /// The wheel
    wheel: Accelerometer<R>,
    /// The strut
    suspension: Suspension<R>,
}

/// The model.
pub struct HydropneumaticQuarterCar;

impl Model for HydropneumaticQuarterCar {
    const ABOUT: About = About {
        name: "HydropneumaticQuarterCar",
        summary: "Quarter car on a gas spring with a damper and a stop",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "F = k l / n ((l / (l + x))^n - 1) + k_s max(-x - c, 0) - d x'",
                source: "Bauer 2011, ch. 2",
            },
            Equation { text: "m_s z_s'' = F + u", source: "momentum" },
            Equation { text: "m_u z_u'' = k_t (z_r - z_u) - F - u", source: "momentum" },
        ],
        experiment: Experiment {
            stop: 3.0,
            step: 0.01,
            stimuli: &[("road.position", Stimulus::Step { at: 0.5, height: 0.03 })],
            plot: &["body.acceleration", "suspension.deflection"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };
    strut_model::bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (p, road) = (now.parameters, now.input.road);
        let State { body, wheel } = now.state;
        let suspension = Suspension {
            deflection: body.position - wheel.position,
            velocity: body.velocity - wheel.velocity,
        };
        let pressure =
            (p.gas_length / (p.gas_length + suspension.deflection)).powf(p.exponent) - R::from(1.0);
        let gas = p.stiffness * p.gas_length / p.exponent * pressure;
        let stop = p.stop_stiffness * (-suspension.deflection - p.clearance).max(R::from(0.0));
        let force = gas + stop - p.damping * suspension.velocity + now.input.strut_force;
        let lifted = force / p.sprung_mass;
        let pushed = (p.tire_stiffness * (road.position - wheel.position) - force) / p.unsprung_mass;
        let rates = State {
            body: Motion { position: body.velocity, velocity: lifted },
            wheel: Motion { position: wheel.velocity, velocity: pushed },
        };
        let output = Output {
            body: Accelerometer { acceleration: lifted },
            wheel: Accelerometer { acceleration: pushed },
            suspension,
        };
        (rates, output)
    }
}

strut_fmi::export_fmu!(HydropneumaticQuarterCar);
