//! A damper between the body and the sky.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use crate::signals::{Command, Velocity};

/// Skyhook control, Ajala eq. 28: `F_a,ref = −ż_a C_SH`, sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skyhook;

/// What the controller is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Damping rate of the damper to the sky (C_SH)
    #[var(unit = N_S_PER_M, start = 1500.0, min = 0.0)]
    pub damping: R,
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Body
    pub body: Velocity<R>,
}

impl Model for Skyhook {
    const ABOUT: About = About {
        name: "Skyhook",
        summary: "Skyhook controller: the force of a damper between the body and the sky",
        kind: Kind::Controller,
        equations: &[Equation { text: "F_ref = -C_SH z_a'", source: "Ajala eq. 28" }],
        notes: &[
            "The force is held between samples. Ajala gives no value for C_SH; the declared one is assumed.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[("body.velocity", Stimulus::Sine { amplitude: 0.2, frequency: 1.5 })],
            plot: &["force"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { parameters: Parameters, input: Input, memory: Command, output: Command }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Command<R> {
        Command { force: -(now.parameters.damping * now.input.body.velocity) }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Command<R>) {
        (NoVariables, *now.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn force(damping: f64, velocity: f64) -> f64 {
        let now = Instant {
            time: 0.0,
            state: &NoVariables,
            input: &Input { body: Velocity { velocity } },
            parameters: &Parameters { damping, period: 1e-3 },
            derived: &NoVariables,
            memory: &Command { force: 0.0 },
            tick: 0,
        };
        Skyhook.tick(now).force
    }

    #[test]
    fn it_is_equation_28() {
        assert_eq!(force(1500.0, 0.2), -300.0);
    }

    proptest! {
        #[test]
        fn it_takes_energy_from_the_body(damping in 0.0..1e4_f64, velocity in -3.0..3.0_f64) {
            prop_assert!(force(damping, velocity) * velocity <= 0.0);
        }
    }
}
