//! What stands between models of different conventions.

use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, NoVariables, Real, Settings, Stimulus,
    Variables, bundles,
};

/// Makes of one model's signal what another model wants: another unit or sign, its rate of change, its integral.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalAdapter {
    operation: Operation,
}

/// What becomes of the signal before factor and offset.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// It stays what it is
    Value,
    /// Its rate of change: a velocity of a position
    Derivative,
    /// Its integral: a velocity of an acceleration
    Integral,
    /// What a sensor with the time constant `filter` shows of it
    Lag,
}

/// What becomes of the signal.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What becomes of the signal before factor and offset
    #[set(start = Operation::Value)]
    pub operation: Operation,
}

/// The conventions' difference.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Factor: negative for the other sign, 1e-3 from millimetres to metres
    #[var(unit = ANY, start = 1.0)]
    pub factor: R,
    /// What is added after the factor, in the output's unit
    #[var(unit = ANY, start = 0.0)]
    pub offset: R,
    /// Integral at the start, before factor and offset
    #[var(unit = ANY, start = 0.0, fixed)]
    pub initial: R,
    /// Time constant of the lag, and of the filter of the rate of change
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub filter: R,
    /// Sampling period of rate of change, integral and lag: the communication step
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
}

/// What comes in.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Signal, in whatever unit it has
    #[var(unit = ANY)]
    pub input: R,
    /// What is added to it, in the output's unit: another part of the same force
    #[var(unit = ANY)]
    pub added: R,
}

/// What is remembered from one sample to the next.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Signal at the last sample
    #[var(unit = ANY)]
    pub signal: R,
    /// Its rate of change
    #[var(unit = ANY)]
    pub rate: R,
    /// Its integral
    #[var(unit = ANY)]
    pub integral: R,
    /// What a sensor with a lag shows of it
    #[var(unit = ANY)]
    pub lagged: R,
}

/// What goes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Signal as the other model wants it
    #[var(unit = ANY)]
    pub output: R,
}

impl Model for SignalAdapter {
    const ABOUT: About = About {
        name: "SignalAdapter",
        summary: "Between models of different conventions: factor and offset of a signal, its rate of change, its integral \
            or its lag, and the sum of two",
        kind: Kind::Other,
        equations: &[
            Equation {
                text: "value: y = factor u + offset + added",
                source: "SSP 1.0, LinearTransformation",
            },
            Equation {
                text: "derivative: y = factor w_k + offset + added, w_k = (tau w_(k-1) + u_k - u_(k-1))/(tau + T)",
                source: "backward difference",
            },
            Equation {
                text: "integral: y = factor I_k + offset + added, I_k = I_(k-1) + T (u_k + u_(k-1))/2",
                source: "trapezoidal rule",
            },
            Equation {
                text: "lag: y = factor z_k + offset + added, z_k = (tau z_(k-1) + T u_k)/(tau + T)",
                source: "backward Euler method",
            },
        ],
        notes: &[
            "It has no unit of its own. One that `build-fmu --system` puts between two components declares the units of \
             both; its parameter set gives them.",
            "Some masters pass over the LinearTransformation of a connection in an SSP without a word. A component is \
             something that every master runs.",
            "The value passes through without a delay of its own. A master that takes the same step with every \
             component (Jacobi) still passes it on one step later than a direct connection: so does every component in \
             between.",
            "The rate of change is a mean over the last period, half a period late, and rough where the signal is: \
             `filter` smooths it. A model that puts out its velocity is better asked for it.",
            "A communication step may be shorter than the period, not longer: between two exchanges the signal rests, and \
             its rate is zero.",
            "The first sample has no predecessor: its rate is zero. The integral drifts with an offset of the signal; \
             VelocityEstimator does not.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[("input", Stimulus::Sine { amplitude: 1.0, frequency: 1.0 })],
            plot: &["output"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, input: Input, memory: Memory, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { operation: options.operation })
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (p, before, signal) = (now.parameters, now.memory, now.input.input);
        if now.tick == 0 {
            return Memory { signal, rate: R::from(0.0), integral: p.initial, lagged: signal };
        }
        Memory {
            signal,
            rate: (p.filter * before.rate + signal - before.signal) / (p.filter + p.period),
            integral: before.integral + p.period * 0.5 * (signal + before.signal),
            lagged: (p.filter * before.lagged + p.period * signal) / (p.filter + p.period),
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        let (p, memory) = (now.parameters, now.memory);
        let signal = match self.operation {
            Operation::Value => now.input.input,
            Operation::Derivative => memory.rate,
            Operation::Integral => memory.integral,
            Operation::Lag => memory.lagged,
        };
        (NoVariables, Output { output: p.factor * signal + p.offset + now.input.added })
    }
}

#[cfg(test)]
mod tests {
    use strut_model::Value;

    use super::*;
    use crate::testing::Bench;

    fn adapter(operation: i32) -> Bench<SignalAdapter> {
        Bench::new().choose("operation", Value::Integer(operation))
    }

    /// Outputs after each step, the input being set at its begin.
    fn outputs(mut adapter: Bench<SignalAdapter>, signal: impl Fn(f64) -> f64, count: usize) -> Vec<f64> {
        (0..count)
            .map(|k| {
                adapter.set("input", signal(k as f64 * 1e-3));
                adapter.step(1e-3);
                adapter.get("output")
            })
            .collect()
    }

    #[test]
    fn a_value_passes_through_at_once() {
        let mut adapter = adapter(1).start("factor", -1e-3).start("offset", 0.5).initialized();
        adapter.set("input", 20.0);
        assert_eq!(adapter.get("output"), 0.48);
        adapter.set("added", 1.5);
        assert_eq!(adapter.get("output"), 1.98);
    }

    #[test]
    fn a_ramp_has_its_slope_from_the_second_sample_on() {
        let found = outputs(adapter(2).start("factor", 2.0).initialized(), |t| 7.0 + 0.25 * t, 50);
        assert_eq!(found[0], 0.0);
        assert!(found[1..].iter().all(|rate| (rate - 0.5).abs() < 1e-11), "{found:?}");
        // A filter delays the same slope: after ten time constants it is there.
        let slow = outputs(adapter(2).start("filter", 4e-3).initialized(), |t| 0.25 * t, 50);
        assert!(slow[2] < 0.2 && (slow[49] - 0.25).abs() < 1e-4, "{slow:?}");
    }

    #[test]
    fn a_lag_follows_a_step_as_an_exponential() {
        let lag = adapter(4).start("filter", 0.05).initialized();
        let found = outputs(lag, |t| f64::from(t > 0.0), 201);
        assert_eq!(found[0], 0.0);
        // After one time constant, and after four; a step of a fiftieth of it is off by a hundredth.
        for (sample, value) in [(50, 1.0 - (-1.0_f64).exp()), (200, 1.0 - (-4.0_f64).exp())] {
            assert!((found[sample] - value).abs() < 5e-3, "{}", found[sample]);
        }
        // Without a time constant it is the signal itself.
        assert_eq!(outputs(adapter(4).initialized(), |t| t, 3), [0.0, 1e-3, 2e-3]);
    }

    #[test]
    fn the_integral_of_a_ramp_is_exact_and_begins_where_it_is_told() {
        let found = outputs(adapter(3).start("initial", 3.0).initialized(), |t| 4.0 * t, 1001);
        assert!((found[0] - 3.0).abs() < 1e-15);
        assert!((found[1000] - 5.0).abs() < 1e-12, "{}", found[1000]);
    }
}
