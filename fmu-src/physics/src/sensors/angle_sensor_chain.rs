//! The instrumentation of the semi-active rig of Kogut.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Stimulus, Variables,
    bundles,
};

use super::encoder::{AngleEncoder, Rounding};

/// Three incremental encoders and the speeds that are reconstructed from them, Kogut 2.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleSensorChain {
    rounding: Rounding,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What the encoders' counters make of an angle between two counts
    #[set(name = "encoder.rounding", start = Rounding::Floor)]
    rounding: Rounding,
}

/// What the encoders are. Declared are encoders that do not count.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Encoder of the eccentric
    pub eccentric: AngleEncoder<R>,
    /// Encoder between frame and wheel arm
    pub wheel_arm: AngleEncoder<R>,
    /// Encoder between wheel arm and body arm
    pub relative: AngleEncoder<R>,
    /// Time constant of the filter of the speeds; zero switches it off
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub speed_filter: R,
    /// Sampling period
    #[var(unit = S, start = 0.01, min = 1e-6, fixed)]
    pub period: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Eccentric
    pub eccentric: Angle<R>,
    /// Wheel arm against the frame
    pub wheel_arm: Angle<R>,
    /// Body arm against the frame
    pub body_arm: Angle<R>,
}

/// An angle.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Angle<R> {
    /// Angle
    #[var(unit = RAD)]
    pub angle: R,
}

/// An angle and how fast it changes.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Turning<R> {
    /// Angle
    #[var(unit = RAD)]
    pub angle: R,
    /// Speed, reconstructed from the angle
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}

/// What the three encoders show.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Eccentric (α0)
    pub eccentric: Turning<R>,
    /// Wheel arm against the frame (α1)
    pub wheel_arm: Turning<R>,
    /// Body arm against the wheel arm (α2)
    pub relative: Turning<R>,
}

/// What the computer reads.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// As measured
    pub measured: Measured<R>,
}

/// What the encoders show, and what follows.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Measured<R> {
    /// Eccentric (α0)
    pub eccentric: Turning<R>,
    /// Wheel arm against the frame (α1)
    pub wheel_arm: Turning<R>,
    /// Body arm against the wheel arm (α2)
    pub relative: Turning<R>,
    /// Body arm against the frame, the sum of both (γ)
    pub body_arm: Turning<R>,
}

impl Model for AngleSensorChain {
    const ABOUT: About = About {
        name: "AngleSensorChain",
        summary: "Instrumentation of a rig with two arms and an eccentric: three encoders, reconstructed speeds, sample \
            and hold",
        kind: Kind::Sensor,
        equations: &[
            Equation { text: "floor(n (a - a_0)/(2 pi)) 2 pi/n + a_0, n = 4096", source: "Kogut 2.1" },
            Equation { text: "body arm: gamma = alpha_1 + alpha_2", source: "Kogut 3.2.2, x_3" },
            Equation {
                text: "speed: w_k = (tau w_(k-1) + a_k - a_(k-1))/(tau + T)",
                source: "Kogut 2.1 names the reconstruction only; backward difference",
            },
        ],
        notes: &[
            "Kogut's third encoder stands between the arms and measures alpha_2; the body arm's angle against the frame \
             is the sum of two readings and has their quanta both.",
            "Kogut's accuracy of 0.001534 rad is the quantum 2 pi/4096 of 4096 counts a turn: consistent. At 100 Hz it \
             is a quantum of 0.153 rad/s in the speeds, which the filter divides by 1 + tau/T.",
            "The filter is the backward Euler one and not the bilinear: without a time constant it is the plain \
             difference, where the bilinear would ring at half the sampling frequency.",
            "The first sample has no predecessor: its speeds are zero.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[
                ("eccentric.angle", Stimulus::Sine { amplitude: 3.0, frequency: 0.5 }),
                ("wheel_arm.angle", Stimulus::Sine { amplitude: 0.01, frequency: 1.35 }),
                ("body_arm.angle", Stimulus::Sine { amplitude: 0.05, frequency: 1.35 }),
            ],
            plot: &["measured.wheel_arm.angle", "measured.body_arm.angle", "measured.relative.speed"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, input: Input, memory: Memory, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { rounding: options.rounding })
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (u, p, before) = (now.input, now.parameters, now.memory);
        let turning = |encoder: &AngleEncoder<R>, angle: R, before: &Turning<R>| {
            let angle = encoder.encoder().read(self.rounding, angle);
            let speed = if now.tick == 0 {
                R::from(0.0)
            } else {
                (p.speed_filter * before.speed + angle - before.angle) / (p.speed_filter + p.period)
            };
            Turning { angle, speed }
        };
        Memory {
            eccentric: turning(&p.eccentric, u.eccentric.angle, &before.eccentric),
            wheel_arm: turning(&p.wheel_arm, u.wheel_arm.angle, &before.wheel_arm),
            relative: turning(&p.relative, u.body_arm.angle - u.wheel_arm.angle, &before.relative),
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        let Memory { eccentric, wheel_arm, relative } = *now.memory;
        let body_arm =
            Turning { angle: wheel_arm.angle + relative.angle, speed: wheel_arm.speed + relative.speed };
        (NoVariables, Output { measured: Measured { eccentric, wheel_arm, relative, body_arm } })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::testing::Bench;

    const QUANTUM: f64 = TAU / 4096.0;

    fn chain(filter: f64) -> Bench<AngleSensorChain> {
        Bench::published("SasSensorChain").start("speed_filter", filter).initialized()
    }

    fn turn(
        chain: &mut Bench<AngleSensorChain>,
        angle: impl Fn(f64) -> f64,
        count: usize,
    ) -> Vec<(f64, f64)> {
        (0..count)
            .map(|k| {
                chain.set("eccentric.angle", angle(k as f64 * 0.01));
                chain.step(0.01);
                (chain.get("measured.eccentric.angle"), chain.get("measured.eccentric.speed"))
            })
            .collect()
    }

    #[test]
    fn a_constant_speed_is_read_within_its_quantum_and_right_in_the_mean() {
        // 1.35 Hz, as in Kogut Fig. 3.
        let speed = TAU * 1.35;
        let rows = turn(&mut chain(0.0), |t| speed * t, 400);
        assert_eq!(rows[0].1, 0.0);
        let off = rows[1..].iter().map(|row| (row.1 - speed).abs()).fold(0.0, f64::max);
        assert!(off <= QUANTUM / 0.01 && off > 0.2 * QUANTUM / 0.01, "{off}");
        let mean = rows[1..].iter().map(|row| row.1).sum::<f64>() / 399.0;
        assert!((mean - speed).abs() < QUANTUM / 3.99, "{mean}");
    }

    #[test]
    fn the_filter_of_the_speeds_lags_by_its_time_constant() {
        let rows = turn(&mut chain(0.05), |t| 100.0 * t, 50);
        for (k, (_, speed)) in (0..).zip(rows) {
            let exact = 100.0 * (1.0 - (0.05_f64 / 0.06).powi(k));
            assert!((speed - exact).abs() < QUANTUM / 0.06 + 1e-9, "{k}");
        }
    }

    #[test]
    fn the_body_arm_is_the_sum_of_two_readings() {
        let mut chain = chain(0.0);
        let steps = |angle: f64| (angle / QUANTUM).round();
        chain.set("wheel_arm.angle", 10.9 * QUANTUM);
        chain.set("body_arm.angle", 31.7 * QUANTUM);
        chain.step(0.01);
        let mut read = |name: &str| steps(chain.get(name));
        assert_eq!(read("measured.wheel_arm.angle"), 10.0);
        assert_eq!(read("measured.relative.angle"), 20.0);
        // 31 counts would fit between zero and 31.7; two floors lose more than one.
        assert_eq!(read("measured.body_arm.angle"), 30.0);
    }

    #[test]
    fn a_reading_is_held_from_sample_to_sample() {
        let mut chain = chain(0.0);
        let mut angles = Vec::new();
        for k in 0..100 {
            chain.set("eccentric.angle", f64::from(k) * 0.01);
            chain.step(1e-3);
            angles.push(chain.get("measured.eccentric.angle"));
        }
        for (k, angle) in angles.iter().enumerate() {
            assert_eq!(*angle, ((k / 10 * 10) as f64 * 0.01 / QUANTUM).floor() * TAU / 4096.0, "{k}");
        }
    }
}
