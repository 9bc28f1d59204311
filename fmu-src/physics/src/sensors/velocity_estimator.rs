//! A velocity from a measured acceleration.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use crate::signals::{Acceleration, Velocity};

/// Leaky integration of a body's acceleration behind a high-pass filter, sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityEstimator;

/// What the estimator is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Corner frequency below which the integration forgets; zero makes it a pure integration
    #[var(unit = HZ, start = 0.1, min = 0.0)]
    pub leak_frequency: R,
    /// Corner frequency of the high-pass filter, which keeps an offset out; zero switches it off
    #[var(unit = HZ, start = 0.1, min = 0.0)]
    pub high_pass_frequency: R,
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Body
    pub body: Acceleration<R>,
}

/// What is remembered from one sample to the next.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Acceleration behind the high-pass filter
    #[var(unit = M_PER_S2)]
    pub passed: R,
    /// Velocity
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// What is estimated.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body
    pub body: Velocity<R>,
}

impl Model for VelocityEstimator {
    const ABOUT: About = About {
        name: "VelocityEstimator",
        summary: "Velocity of a body from its measured acceleration: high-pass filter and leaky integration, sampled",
        kind: Kind::Sensor,
        equations: &[Equation {
            text: "v/a = s/((s + w_h)(s + w_l)), s = (2/T)(z - 1)/(z + 1)",
            source: "a law of control practice; TUM 4.3.4 and [7, 8] only name such observers",
        }],
        notes: &[
            "TUM and Ajala feed their controllers with the body's velocity, which no sensor of the rig measures (3.1). \
             This is the simplest way to it. Above both corner frequencies it is the integral of the acceleration; it \
             leads by atan(f_l/f) + atan(f_h/f), 7.6 degrees at 1.5 Hz with the declared 0.1 Hz.",
            "An offset b of the acceleration alone would leave a velocity of b/w_l (1.47 m/s2, 3 % of the range of the \
             rig's accelerometer: 2.3 m/s at 0.1 Hz). Behind the high-pass filter it dies out, having passed through \
             a largest velocity of b/(e w).",
            "Sampled by the bilinear transform, which keeps the filter stable for every period.",
        ],
        experiment: Experiment {
            stop: 5.0,
            step: 1e-3,
            stimuli: &[("body.acceleration", Stimulus::Cosine { amplitude: 2.0, frequency: 1.5 })],
            plot: &["body.velocity"],
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
        let (p, before, acceleration) = (now.parameters, now.memory, now.input.body.acceleration);
        let rate = R::from(2.0) / p.period;
        let (leak, high_pass) = (p.leak_frequency * TAU, p.high_pass_frequency * TAU);
        let passed = (rate * (acceleration - before.acceleration) + (rate - high_pass) * before.passed)
            / (rate + high_pass);
        let velocity = (passed + before.passed + (rate - leak) * before.velocity) / (rate + leak);
        Memory { acceleration, passed, velocity }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { body: Velocity { velocity: now.memory.velocity } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Bench, harmonic};
    use proptest::prelude::*;

    type Estimator = Bench<VelocityEstimator>;

    /// Velocities after each tick.
    fn estimate(mut estimator: Estimator, acceleration: impl Fn(f64) -> f64, count: usize) -> Vec<f64> {
        (0..count)
            .map(|k| {
                estimator.set("body.acceleration", acceleration(k as f64 * 1e-3));
                estimator.step(1e-3);
                estimator.get("body.velocity")
            })
            .collect()
    }

    #[test]
    fn at_the_body_mode_it_is_the_integral_but_for_the_corners() {
        let omega = TAU * 1.5;
        let found = estimate(Estimator::new().initialized(), |t| omega * (omega * t).cos(), 40_000);
        // The start has died out (0.1 Hz: a time constant of 1.6 s); 20 s are 30 periods.
        let (gain, phase) = harmonic(&found[20_000..], 20.0, 1e-3, 1.5);
        let corner: f64 = 0.1 / 1.5;
        assert!((gain * (1.0 + corner * corner) - 1.0).abs() < 1e-4, "{gain}");
        assert!((phase - 2.0 * corner.atan()).abs() < 1e-4, "{phase}");
    }

    #[test]
    fn an_offset_dies_out_behind_the_high_pass_filter_alone() {
        let found = estimate(Estimator::new().initialized(), |_| 1.47, 30_000);
        let largest = found.iter().copied().fold(0.0, f64::max);
        assert!((largest - 1.47 / (TAU * 0.1) / 1.0_f64.exp()).abs() < 1e-3, "{largest}");
        assert!(found[29_999].abs() < 1e-4);
        let leaky = Estimator::new().start("high_pass_frequency", 0.0).initialized();
        assert!((estimate(leaky, |_| 1.47, 30_000)[29_999] - 1.47 / (TAU * 0.1)).abs() < 1e-3);
    }

    #[test]
    fn without_corners_it_is_the_trapezoidal_rule() {
        let pure =
            Estimator::new().start("high_pass_frequency", 0.0).start("leak_frequency", 0.0).initialized();
        let found = estimate(pure, |t| 3.0 * t, 1001);
        assert!((found[1000] - 1.5).abs() < 1e-12, "{}", found[1000]);
    }

    proptest! {
        #[test]
        fn it_is_linear_and_stable(a in -10.0..10.0_f64, leak in 0.01..400.0_f64, high_pass in 0.01..400.0_f64) {
            let estimator = || {
                Estimator::new().start("leak_frequency", leak).start("high_pass_frequency", high_pass).initialized()
            };
            let one = estimate(estimator(), |t| f64::from(t < 0.01), 300);
            let many = estimate(estimator(), |t| a * f64::from(t < 0.01), 300);
            for (x, y) in one.iter().zip(&many) {
                prop_assert!((a * x - y).abs() < 1e-12 && x.abs() < 0.011);
            }
        }
    }
}
