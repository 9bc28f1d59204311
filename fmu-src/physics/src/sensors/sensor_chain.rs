//! The instrumentation of a quarter-car rig.

use std::path::Path as FilePath;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::signals::{Acceleration, Deflection, WheelMotion};

use super::analog::{
    AccelerationChannel, AnalogState, Channel, CurrentChannel, Draw, Dynamics, ForceChannel, Path,
};
use super::encoder::{PositionEncoder, Rounding};

/// Accelerometers, load cell, current sensor and two encoders, read by one computer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorChain {
    options: Options,
}

/// What can be chosen.
#[derive(Settings, Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How the accelerometer of the body follows
    #[set(name = "body_acceleration.dynamics", start = Dynamics::FirstOrder)]
    body_acceleration: Dynamics,
    /// How the accelerometer of the wheel follows
    #[set(name = "wheel_acceleration.dynamics", start = Dynamics::FirstOrder)]
    wheel_acceleration: Dynamics,
    /// How the load cell and its amplifier follow
    #[set(name = "wheel_force.dynamics", start = Dynamics::FirstOrder)]
    wheel_force: Dynamics,
    /// How the current sensor follows
    #[set(name = "actuator_current.dynamics", start = Dynamics::FirstOrder)]
    actuator_current: Dynamics,
    /// Filter in front of the converters: there is one
    #[set(name = "filter.enabled", start = true)]
    filter: bool,
    /// What the encoders' counters make of a position between two counts
    #[set(name = "encoder.rounding", start = Rounding::Floor)]
    rounding: Rounding,
    /// Seed of the noise: equal seeds give equal noise
    #[set(start = 1)]
    seed: i32,
}

/// What the channels are. Declared is an instrumentation without errors; published ones are parameter sets.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Accelerometer of the body
    pub body_acceleration: AccelerationChannel<R>,
    /// Accelerometer of the wheel
    pub wheel_acceleration: AccelerationChannel<R>,
    /// Load cell below the wheel
    pub wheel_force: ForceChannel<R>,
    /// Current of the actuator
    pub actuator_current: CurrentChannel<R>,
    /// Encoder of the suspension
    pub suspension_deflection: PositionEncoder<R>,
    /// Encoder of the road
    pub road_position: PositionEncoder<R>,
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Accelerometer of the body
    pub body_acceleration: Natural<R>,
    /// Accelerometer of the wheel
    pub wheel_acceleration: Natural<R>,
    /// Load cell below the wheel
    pub wheel_force: Natural<R>,
    /// Current of the actuator
    pub actuator_current: Natural<R>,
}

/// Of a sensor.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Natural<R> {
    /// Natural frequency with which a sensor of second order has its bandwidth
    #[var(unit = HZ)]
    pub natural_frequency: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Signals<R> {
    /// Body
    pub body: Acceleration<R>,
    /// Wheel
    pub wheel: WheelMotion<R>,
    /// Suspension
    pub suspension: Deflection<R>,
    /// Road
    pub road: Road<R>,
    /// Actuator
    pub actuator: Actuator<R>,
}

/// The road.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Road<R> {
    /// Height
    #[var(unit = M)]
    pub position: R,
}

/// The actuator.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Actuator<R> {
    /// Current
    #[var(unit = A)]
    pub current: R,
}

/// The voltages.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Accelerometer of the body
    pub body_acceleration: AnalogState<R>,
    /// Accelerometer of the wheel
    pub wheel_acceleration: AnalogState<R>,
    /// Load cell below the wheel
    pub wheel_force: AnalogState<R>,
    /// Current of the actuator
    pub actuator_current: AnalogState<R>,
}

/// What the computer reads.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// As measured
    pub measured: Signals<R>,
}

impl Model for SensorChain {
    const ABOUT: About = About {
        name: "SensorChain",
        summary: "Instrumentation of a quarter-car rig: sensors with bandwidth, noise and errors, filters, converters, \
            encoders, sample and hold",
        kind: Kind::Sensor,
        equations: &[
            Equation {
                text: "sensor: y'' = w^2 (S x - y) - 2 d w y' or y' = w_b (S x - y), u = (1 + e) y + u_0, |u| <= full \
                    scale",
                source: "TUM 3.1, Table 1 and 2",
            },
            Equation { text: "filter: f' = 2 pi f_c (u - f)", source: "TUM 3.5: first order, 380 Hz" },
            Equation {
                text: "converter: q round(((1 + e_c) (f + noise) + u_c)/q) between -range and range - q",
                source: "TUM 3.5, Table 4",
            },
            Equation {
                text: "encoder: floor(n (x - x_0) (1 + e))/n + x_0",
                source: "TUM 3.1: 12 pulses per mm",
            },
        ],
        notes: &[
            "What is measured has the same names as the inputs, with measured in front. It is held between samples.",
            "Noise is what arrives at the converter, the filter's work included, and independent from sample to sample. \
             Through a filter of 380 Hz neighbouring samples of white noise at 1 kHz correlate by 0.09.",
            "TUM Table 1 prints 32 µg and 158 µg rms of noise. With 800 mV/g and 160 mV/g that would be 26 µV and 25 µV, \
             a twelfth of a 16-bit step and 35 and 63 times below what Table 5 prints as measured. As densities (per \
             root hertz, as data sheets give them) they make 0.45 mV and 0.54 mV behind sensor and filter. With the \
             0.71 mV that Table 4 allows a 16-bit converter the first is 70.6 dB below full scale, with the 1.41 mV that \
             rounding to 12 bits makes the second is 65.5 dB: Table 5's 70 and 65 dB.",
            "TUM Table 5 does not say what its signal-to-noise ratios refer to. Taken as a sine of full scale (4 V for \
             the accelerometers, 10 V for the load cell) over noise, both root mean square, 70, 65 and 75 dB are 0.89, \
             1.59 and 1.26 mV. The first and the third are less than rounding to 12 bits alone makes, so these channels \
             have 16 bits; 65 dB is what 12 bits leave of a signal that moves.",
            "TUM Table 5's peak-to-peak values, 40, 40, 50 and 100 mV, are measured with the drives on. As Gaussian \
             noise (6.6 times its rms) they are 6.1 to 15 mV rms, seven times that of the first column: what the \
             inverters disturb. The set TumSensorChain has the quiet rig, TumLiveSensorChain the live one, \
             TumUncalibratedSensorChain the live one with every error at its limit.",
            "TUM Table 1 prints a maximum absolute deviation of 0.75 g for both accelerometers. Offset and range make \
             that 3 % of 25 g; for 5 g the same 3 % are 0.15 g.",
            "A filter of 380 Hz hardly keeps aliases out at 1 kHz: 3.0 dB at 380 Hz, 4.4 dB at 500 Hz, and what folds \
             to 100 Hz stands at 900 Hz with 8.2 dB.",
            "An accelerometer at rest shows gravity. The 1 g and the static wheel load count as compensated: inputs \
             and readings are those of the motion.",
        ],
        experiment: Experiment {
            stop: 1.0,
            step: 1e-3,
            stimuli: &[
                ("body.acceleration", Stimulus::Sine { amplitude: 2.0, frequency: 3.0 }),
                ("wheel.acceleration", Stimulus::Sine { amplitude: 20.0, frequency: 12.0 }),
                ("wheel.force", Stimulus::Sine { amplitude: 400.0, frequency: 12.0 }),
                ("suspension.deflection", Stimulus::Sine { amplitude: 0.01, frequency: 3.0 }),
            ],
            plot: &[
                "measured.body.acceleration",
                "measured.wheel.acceleration",
                "measured.wheel.force",
                "measured.suspension.deflection",
            ],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Signals,
        state: State,
        memory: Signals,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&FilePath>) -> Result<Self, String> {
        Ok(Self { options: *options })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let natural = |channel: Channel<R>| Natural { natural_frequency: channel.sensor.natural_frequency() };
        Derived {
            body_acceleration: natural(p.body_acceleration.channel()),
            wheel_acceleration: natural(p.wheel_acceleration.channel()),
            wheel_force: natural(p.wheel_force.channel()),
            actuator_current: natural(p.actuator_current.channel()),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.body_acceleration.channel().check("body_acceleration")?;
        p.wheel_acceleration.channel().check("wheel_acceleration")?;
        p.wheel_force.channel().check("wheel_force")?;
        p.actuator_current.channel().check("actuator_current")
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Signals<R> {
        let (x, u, p, options) = (now.state, now.input, now.parameters, self.options);
        // Each channel draws from a stream of its own.
        let read = |stream, channel: Channel<R>, dynamics, quantity, state| {
            let draw = Draw { seed: options.seed, stream, tick: now.tick };
            channel.sample(self.path(dynamics), quantity, state, draw)
        };
        Signals {
            body: Acceleration {
                acceleration: read(
                    0,
                    p.body_acceleration.channel(),
                    options.body_acceleration,
                    u.body.acceleration,
                    &x.body_acceleration,
                ),
            },
            wheel: WheelMotion {
                acceleration: read(
                    1,
                    p.wheel_acceleration.channel(),
                    options.wheel_acceleration,
                    u.wheel.acceleration,
                    &x.wheel_acceleration,
                ),
                force: read(2, p.wheel_force.channel(), options.wheel_force, u.wheel.force, &x.wheel_force),
            },
            suspension: Deflection {
                deflection: p.suspension_deflection.encoder().read(options.rounding, u.suspension.deflection),
            },
            road: Road { position: p.road_position.encoder().read(options.rounding, u.road.position) },
            actuator: Actuator {
                current: read(
                    3,
                    p.actuator_current.channel(),
                    options.actuator_current,
                    u.actuator.current,
                    &x.actuator_current,
                ),
            },
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p, derived, options) = (now.state, now.input, now.parameters, now.derived, self.options);
        let rates = |channel: Channel<R>, dynamics, natural: Natural<R>, quantity, state| {
            channel.rates(self.path(dynamics), natural.natural_frequency, quantity, state)
        };
        let rates = State {
            body_acceleration: rates(
                p.body_acceleration.channel(),
                options.body_acceleration,
                derived.body_acceleration,
                u.body.acceleration,
                &x.body_acceleration,
            ),
            wheel_acceleration: rates(
                p.wheel_acceleration.channel(),
                options.wheel_acceleration,
                derived.wheel_acceleration,
                u.wheel.acceleration,
                &x.wheel_acceleration,
            ),
            wheel_force: rates(
                p.wheel_force.channel(),
                options.wheel_force,
                derived.wheel_force,
                u.wheel.force,
                &x.wheel_force,
            ),
            actuator_current: rates(
                p.actuator_current.channel(),
                options.actuator_current,
                derived.actuator_current,
                u.actuator.current,
                &x.actuator_current,
            ),
        };
        (rates, Output { measured: *now.memory })
    }
}

impl SensorChain {
    fn path(&self, dynamics: Dynamics) -> Path {
        Path { dynamics, filtered: self.options.filter }
    }
}

#[cfg(test)]
mod tests;
