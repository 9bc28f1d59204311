//! Signals that may drive an input, and the source FMU that makes them.
//!
//! Sine, square and chirp are the waveforms of the sources themselves, so that an FMU and a table hold the same signal.

use std::f64::consts::{PI, TAU};

use strut_physics::waveform::{Chirp, sine, square};

/// Ratio of two neighbouring frequencies of a multisine: a third of an octave.
const SPACING: f64 = 1.26;
/// Time in seconds over which a multisine grows from rest.
const GROWING: f64 = 0.5;
/// Shortest edge of a square wave in seconds.
const EDGE: f64 = 0.02;
/// Longest edge as a share of the period.
const LONGEST_EDGE: f64 = 0.25;

/// The shape of a signal about its rest; all but multisine and triangle are those of the source FMUs. Frequencies in Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Sine.
    Sine {
        /// Its frequency.
        frequency: f64,
    },
    /// Steps up and down in turn.
    Square {
        /// Its frequency.
        frequency: f64,
        /// Duration of an edge in seconds.
        edge: f64,
    },
    /// Sine whose frequency grows linearly over the whole duration.
    Chirp {
        /// Frequency at the start.
        from: f64,
        /// Frequency at the end.
        to: f64,
    },
    /// Straight up and down.
    Triangle {
        /// Its frequency.
        frequency: f64,
    },
    /// Sines a third of an octave apart, the slow ones larger.
    Multisine {
        /// Lowest frequency.
        from: f64,
        /// Highest frequency.
        to: f64,
    },
}

impl Shape {
    /// Its name in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sine { .. } => "sine",
            Self::Square { .. } => "square wave",
            Self::Chirp { .. } => "chirp",
            Self::Triangle { .. } => "triangle",
            Self::Multisine { .. } => "multisine",
        }
    }

    /// Its frequencies in Hz: the only one, or the first and the last.
    pub fn frequencies(self) -> (f64, Option<f64>) {
        match self {
            Self::Sine { frequency } | Self::Square { frequency, .. } | Self::Triangle { frequency } => {
                (frequency, None)
            }
            Self::Chirp { from, to } | Self::Multisine { from, to } => (from, Some(to)),
        }
    }

    /// The signal of an amplitude at so many samples.
    pub fn signal(self, amplitude: f64, step: f64, count: usize) -> Vec<f64> {
        let duration = step * count as f64;
        let time = (0..count).map(|k| step * k as f64);
        match self {
            Self::Sine { frequency } => {
                time.map(|t| sine(amplitude, TAU * frequency * t, TAU * frequency)[0]).collect()
            }
            Self::Square { frequency, edge } => {
                time.map(|t| square(t, amplitude, frequency, edge)[0]).collect()
            }
            Self::Chirp { from, to } => {
                let chirp = Chirp { start_frequency: from, end_frequency: to, duration };
                time.map(|t| chirp.at(t, amplitude)[0]).collect()
            }
            Self::Triangle { frequency } => {
                time.map(|t| amplitude * 2.0 / PI * (TAU * frequency * t).sin().asin()).collect()
            }
            Self::Multisine { from, to } => {
                multisine(time, (from, to), duration).map(|it| amplitude * it).collect()
            }
        }
    }

    /// The same shape, or a gentler one, and the amplitude with which its rate stays within a bound, in units per second.
    pub fn within_rate(self, amplitude: f64, rate: f64, duration: f64) -> (Self, f64) {
        let steepest = match self {
            Self::Square { frequency, .. } => {
                // A cosine half wave of height 2 A has the rate π A/T in its middle.
                let edge = (PI * amplitude / rate).clamp(EDGE, LONGEST_EDGE / frequency);
                return (Self::Square { frequency, edge }, amplitude.min(rate * edge / PI));
            }
            Self::Sine { frequency } => TAU * frequency,
            Self::Chirp { from, to } => TAU * from.max(to),
            Self::Triangle { frequency } => 4.0 * frequency,
            Self::Multisine { from, to } => {
                let time: Vec<f64> = moments(duration, 0.01 / to).collect();
                let signal: Vec<f64> = multisine(time.iter().copied(), (from, to), duration).collect();
                let rate = |(t, y): (&[f64], &[f64])| (y[1] - y[0]).abs() / (t[1] - t[0]);
                time.windows(2).zip(signal.windows(2)).map(rate).fold(0.0, f64::max)
            }
        };
        (self, amplitude.min(rate / steepest))
    }
}

/// Moments of a duration, no further apart than a step, to its very end: a signal may be largest or steepest there.
fn moments(duration: f64, step: f64) -> impl Iterator<Item = f64> {
    let count = (duration / step).ceil();
    (0..=count as usize).map(move |k| duration * k as f64 / count)
}

/// Sines with the phases of M. R. Schroeder, Synthesis of low-peak-factor signals and binary sequences with low
/// autocorrelation, IEEE Transactions on Information Theory 16 (1970), from rest; its largest value over the duration is one.
fn multisine(
    time: impl Iterator<Item = f64>,
    (from, to): (f64, f64),
    duration: f64,
) -> impl Iterator<Item = f64> {
    let count = ((to / from).ln() / SPACING.ln()).floor().max(0.0) as i32 + 1;
    let line = |k: i32| {
        let phase = -PI * f64::from(k) * f64::from(k + 1) / f64::from(count);
        (from * SPACING.powi(k), SPACING.powf(-0.5 * f64::from(k)), phase)
    };
    let lines: Vec<(f64, f64, f64)> = (0..count).map(line).collect();
    let value = move |t: f64| {
        let grown = (t / GROWING).min(1.0);
        let sum: f64 = lines.iter().map(|(f, a, phase)| a * (TAU * f * t + phase).sin()).sum();
        grown * grown * (3.0 - 2.0 * grown) * sum
    };
    // The peak is that between the samples, too: it must not depend on how often it is sampled.
    let peak = moments(duration, 5e-3 / to).map(|t| value(t).abs()).fold(f64::MIN_POSITIVE, f64::max);
    time.map(move |t| value(t) / peak)
}

/// What makes a signal outside of the diagnosis.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// The FMU: `Road`, or `VoltageSource`.
    pub fmu: &'static str,
    /// Its settings, by name.
    pub settings: Vec<(&'static str, String)>,
    /// Its parameters: name, value and unit.
    pub parameters: Vec<(&'static str, f64, String)>,
    /// Whether a `SignalAdapter` of factor one has to stand behind it: a source's signal is a voltage.
    pub adapter: bool,
}

/// Name of the file with the profile of a `Road`.
pub const PROFILE: &str = "experiment-profile.csv";

impl Shape {
    /// The FMU that makes this signal for an input of a unit that rests at `rest`; none if only a table does.
    pub fn source(self, (amplitude, rest): (f64, f64), unit: &str, duration: f64) -> Option<Source> {
        let hertz = |name, value| (name, value, "Hz".to_owned());
        let chirp = |from, to| {
            let ends = [hertz("chirp.start_frequency", from), hertz("chirp.end_frequency", to)];
            ends.into_iter().chain([("chirp.duration", duration, "s".to_owned())])
        };
        if unit == "m" && rest == 0.0 {
            let kind = match self {
                Self::Sine { .. } => "Sine",
                Self::Square { .. } => "Square",
                Self::Chirp { .. } => "Chirp",
                Self::Triangle { .. } | Self::Multisine { .. } => "Recorded",
            };
            let mut settings = vec![("kind", kind.to_owned())];
            let mut parameters = vec![("amplitude", amplitude, unit.to_owned())];
            match self {
                Self::Sine { frequency } => parameters.push(hertz("frequency", frequency)),
                Self::Square { frequency, edge } => {
                    parameters.extend([hertz("frequency", frequency), ("edge_time", edge, "s".into())]);
                }
                Self::Chirp { from, to } => parameters.extend(chirp(from, to)),
                Self::Triangle { .. } | Self::Multisine { .. } => {
                    settings.push(("file", PROFILE.into()));
                    parameters.clear();
                }
            }
            return Some(Source { fmu: "Road", settings, parameters, adapter: false });
        }
        let volts = |name, value| (name, value, "V".to_owned());
        let mut parameters = vec![volts("offset", rest), volts("amplitude", amplitude)];
        let shape = match self {
            Self::Sine { frequency } => {
                parameters.push(hertz("swing_frequency", frequency));
                "Sine"
            }
            Self::Square { frequency, edge } => {
                parameters.extend([hertz("swing_frequency", frequency), ("edge_time", edge, "s".into())]);
                "Square"
            }
            Self::Chirp { from, to } => {
                parameters.extend(chirp(from, to));
                "Chirp"
            }
            Self::Triangle { .. } | Self::Multisine { .. } => return None,
        };
        let settings = vec![("shape", shape.to_owned())];
        Some(Source { fmu: "VoltageSource", settings, parameters, adapter: unit != "V" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shapes(low: f64, high: f64) -> [Shape; 5] {
        [
            Shape::Sine { frequency: high },
            Shape::Square { frequency: low, edge: EDGE },
            Shape::Chirp { from: low, to: high },
            Shape::Triangle { frequency: low },
            Shape::Multisine { from: low, to: high },
        ]
    }

    proptest! {
        #[test]
        fn signals_start_at_rest_and_keep_their_amplitude_and_rate(
            low in 0.2..1.0_f64, ratio in 2.0..20.0_f64, amplitude in 0.01..10.0_f64, rate in 0.1..100.0_f64,
        ) {
            for shape in shapes(low, low * ratio) {
                let (shape, amplitude) = shape.within_rate(amplitude, rate, 10.0);
                let signal = shape.signal(amplitude, 1e-3, 10_000);
                prop_assert!(signal[0].abs() < 1e-12 * amplitude, "{shape:?}");
                prop_assert!(signal.iter().all(|it| it.abs() <= 1.001 * amplitude), "{shape:?}");
                let fastest = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 1e-3).fold(0.0, f64::max);
                prop_assert!(fastest <= 1.02 * rate, "{shape:?}: {fastest} beyond {rate}");
            }
        }

        #[test]
        fn a_signal_does_not_depend_on_how_often_it_is_sampled(low in 0.2..1.0_f64, ratio in 2.0..20.0_f64) {
            for shape in shapes(low, low * ratio) {
                let (coarse, fine) = (shape.signal(1.0, 4e-3, 2500), shape.signal(1.0, 1e-3, 10_000));
                for (k, value) in coarse.iter().enumerate() {
                    prop_assert!((value - fine[4 * k]).abs() < 5e-3, "{shape:?} at {k}");
                }
            }
        }
    }

    #[test]
    fn every_input_has_a_source_that_its_shape_needs() {
        let chirp = Shape::Chirp { from: 0.5, to: 15.0 };
        let road = chirp.source((0.01, 0.0), "m", 20.0).unwrap();
        assert_eq!((road.fmu, road.adapter, &road.settings[0].1[..]), ("Road", false, "Chirp"));
        assert!(road.parameters.contains(&("chirp.end_frequency", 15.0, "Hz".into())));
        let force = chirp.source((100.0, 5.0), "N", 20.0).unwrap();
        assert_eq!((force.fmu, force.adapter), ("VoltageSource", true));
        assert!(force.parameters.contains(&("offset", 5.0, "V".into())));
        let triangle = Shape::Triangle { frequency: 0.2 };
        assert_eq!(triangle.source((0.01, 0.0), "m", 20.0).unwrap().settings[1].1, PROFILE);
        assert_eq!(triangle.source((1.0, 0.0), "N", 20.0), None);
    }
}
