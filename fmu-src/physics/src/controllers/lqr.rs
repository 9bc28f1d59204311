//! The linear quadratic regulator of the Quanser rig.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Stimulus, Variables,
    bundles,
};

use crate::signals::{Command, Deflection, Velocity};

use super::riccati::Problem;

/// State feedback, Quanser 2.2.3: `F_c = −K x`, with K given or computed from plant and weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LqrController {
    enabled: bool,
    computed: bool,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// The controller works; else its force is zero (the manual switch of Quanser Fig. 3.1)
    #[set(start = true, tunable)]
    enabled: bool,
    /// The gain is computed from plant and weights; else it is the given one
    #[set(name = "gain.computed", start = true)]
    computed: bool,
}

/// Plant, weights and given gain. The declared plant is that of the quarter car; the declared weights are one
/// over the square of what is tolerable (Bryson's rule): 50 mm, 0.2 m/s, 10 mm, 1 m/s and 1000 N (assumed).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
    /// Time from which on the controller works
    #[var(unit = S, start = 0.0)]
    pub switch_on_time: R,
    /// Sprung mass of the plant (M_s)
    #[var(unit = KG, start = 350.0, min = 1e-3)]
    pub sprung_mass: R,
    /// Unsprung mass of the plant (M_us)
    #[var(unit = KG, start = 40.0, min = 1e-3)]
    pub unsprung_mass: R,
    /// Strut of the plant
    pub strut: Strut<R>,
    /// Tyre of the plant
    pub tire: Tire<R>,
    /// Weight in the cost
    pub weight: Weight<R>,
    /// Gain
    pub gain: Given<R>,
}

/// The strut, linear.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Strut<R> {
    /// Spring rate (K_s)
    #[var(unit = N_PER_M, start = 22e3, min = 1.0)]
    pub stiffness: R,
    /// Damping rate (B_s)
    #[var(unit = N_S_PER_M, start = 1500.0, min = 0.0)]
    pub damping: R,
}

/// The tyre, linear.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Tire<R> {
    /// Rate (K_us)
    #[var(unit = N_PER_M, start = 200e3, min = 1.0)]
    pub stiffness: R,
    /// Damping rate (B_us)
    #[var(unit = N_S_PER_M, start = 50.0, min = 0.0)]
    pub damping: R,
}

/// The diagonal of Q, and R, of eq. 2.22.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Weight<R> {
    /// Of the suspension deflection
    #[var(unit = PER_M2, start = 400.0, min = 0.0)]
    pub suspension_deflection: R,
    /// Of the body velocity
    #[var(unit = S2_PER_M2, start = 25.0, min = 0.0)]
    pub body_velocity: R,
    /// Of the tyre deflection
    #[var(unit = PER_M2, start = 1e4, min = 0.0)]
    pub tire_deflection: R,
    /// Of the wheel velocity
    #[var(unit = S2_PER_M2, start = 1.0, min = 0.0)]
    pub wheel_velocity: R,
    /// Of the force (R)
    #[var(unit = PER_N2, start = 1e-6, min = 1e-15)]
    pub force: R,
}

/// The gain that is used when none is computed.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Given<R> {
    /// As given
    pub given: Gain<R>,
}

/// The gain in use.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Gain in use
    pub gain: Gain<R>,
}

/// A state feedback gain K.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Gain<R> {
    /// On the suspension deflection
    #[var(unit = N_PER_M)]
    pub suspension_deflection: R,
    /// On the body velocity
    #[var(unit = N_S_PER_M)]
    pub body_velocity: R,
    /// On the tyre deflection
    #[var(unit = N_PER_M)]
    pub tire_deflection: R,
    /// On the wheel velocity
    #[var(unit = N_S_PER_M)]
    pub wheel_velocity: R,
}

/// What is measured: the state of eq. 2.10.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Suspension
    pub suspension: Deflection<R>,
    /// Body
    pub body: Velocity<R>,
    /// Tyre
    pub tire: Deflection<R>,
    /// Wheel
    pub wheel: Velocity<R>,
}

/// Largest relative residual of the Riccati equation with which a gain is believed. Rounding leaves some 1e-10.
const RESIDUAL: f64 = 1e-6;

impl Model for LqrController {
    const ABOUT: About = About {
        name: "LqrController",
        summary: "Linear quadratic regulator of a quarter car, its gain given or computed from plant and \
            weights",
        kind: Kind::Controller,
        equations: &[
            Equation {
                text: "F_c = -K x, x = (z_s - z_us, z_s', z_us - z_r, z_us')",
                source: "Quanser 2.2.3, eq. 2.10",
            },
            Equation { text: "J = integral of x' Q x + R F_c^2", source: "Quanser eq. 2.22" },
            Equation {
                text: "K = R^-1 B' X, A' X + X A - X B R^-1 B' X + Q = 0",
                source: "Riccati equation of eq. 2.22-2.23",
            },
        ],
        notes: &[
            "Quanser's Table 3.1 gives K_us = 1250 N/m, but the printed gain [24.66 48.87 -0.47 3.68] \
             belongs to 2500 N/m; with 1250 N/m it is [24.66 47.61 38.74 4.51].",
            "The force is held between samples. A sample at the switch-on time is controlled already.",
            "The gain is computed when a parameter changes. Parameters for which the Riccati equation has \
             no stabilising solution are refused.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[
                ("suspension.deflection", Stimulus::Sine { amplitude: 0.02, frequency: 1.5 }),
                ("body.velocity", Stimulus::Cosine { amplitude: 0.1, frequency: 1.5 }),
            ],
            plot: &["force"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Input,
        memory: Command,
        output: Command,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { enabled: options.enabled, computed: options.computed })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        if !self.computed {
            return Derived { gain: p.gain.given };
        }
        let problem = problem(p);
        let gain = problem.gain(&problem.solve(shift(p)));
        let [suspension_deflection, body_velocity, tire_deflection, wheel_velocity] = gain;
        Derived { gain: Gain { suspension_deflection, body_velocity, tire_deflection, wheel_velocity } }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        if !self.computed {
            return Ok(());
        }
        let problem = problem(p);
        let solution = problem.solve(shift(p));
        let residual = problem.residual(&solution);
        if residual <= RESIDUAL && problem.is_stable_with(&problem.gain(&solution)) {
            return Ok(());
        }
        Err(format!(
            "no gain stabilises the plant at least cost (relative residual of the Riccati equation \
             {residual:.1e}): with strut.damping = {} N.s/m, tire.damping = {} N.s/m and the given weights \
             a mode of the plant stays undamped; raise a weight.*, lower weight.force = {} 1/N2, or give a \
             gain and set gain.computed to false",
            p.strut.damping, p.tire.damping, p.weight.force
        ))
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Command<R> {
        let zero = R::from(0.0);
        if !self.enabled {
            return Command { force: zero };
        }
        let (k, x, p) = (&now.derived.gain, now.input, now.parameters);
        let force = -(k.suspension_deflection * x.suspension.deflection
            + k.body_velocity * x.body.velocity
            + k.tire_deflection * x.tire.deflection
            + k.wheel_velocity * x.wheel.velocity);
        // A tick that rounding puts just before the switch-on time is the one at it.
        let missing = p.switch_on_time - now.time - p.period * 1e-6;
        Command { force: missing.select(zero, force) }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Command<R>) {
        (NoVariables, *now.memory)
    }
}

/// Quanser eq. 2.22 and 2.23.
fn problem<R: Real>(p: &Parameters<R>) -> Problem<R> {
    let (ms, mus, o, one) = (p.sprung_mass, p.unsprung_mass, R::from(0.0), R::from(1.0));
    let (ks, bs, kus, bus) = (p.strut.stiffness, p.strut.damping, p.tire.stiffness, p.tire.damping);
    let w = p.weight;
    Problem {
        state: [
            [o, one, o, -one],
            [-ks / ms, -bs / ms, o, bs / ms],
            [o, o, o, one],
            [ks / mus, bs / mus, -kus / mus, -(bs + bus) / mus],
        ],
        input: [o, one / ms, o, -one / mus],
        state_weight: [w.suspension_deflection, w.body_velocity, w.tire_deflection, w.wheel_velocity],
        input_weight: w.force,
    }
}

/// The geometric mean of the uncoupled natural frequencies, in rad/s.
fn shift<R: Real>(p: &Parameters<R>) -> R {
    (p.strut.stiffness / p.sprung_mass * p.tire.stiffness / p.unsprung_mass).sqrt().sqrt()
}

#[cfg(test)]
mod tests;
