//! Lines in the spectrum of one signal alone: hum, or what is faster than half the sampling rate and is folded by it.
//!
//! What moves a rig shows in its inputs, and what resonates in it is wider than a line. Where an input has lines itself (sines,
//! repeated pseudo-random sequences) every bend in the rig makes more of them, and nothing is reported.

use std::f64::consts::TAU;
use std::ops::Range;

use super::{Channel, GAP, Problems, Record, number};
use crate::check::DataProblem;
use crate::noise::median;
use crate::uniform::median_period;
use strut_signal::spectral::{filled, periodogram};

/// Samples that are transformed at most.
const MOST: usize = 1 << 17;
/// Bins to each side over which Hann's window spreads a line, and up to which the spectrum around it is looked at.
const SPREAD: usize = 3;
const AROUND: usize = 18;
/// Power of a line over the median around it, which neither noise nor a resonance of a hundredth of critical damping has.
const ABOVE: f64 = 150.0;
/// The same below which a signal has nothing there.
const NOTHING: f64 = 10.0;
/// Share of a signal's power that is at one frequency if it is a sine, however few of its periods were recorded.
const MOSTLY: f64 = 0.3;
/// Factor between the amplitudes of a sine in the halves of a record from which it is no hum, but what rings down or is stirred.
const STEADY: f64 = 2.0;
/// Lines of one signal at most: what has more is meant to have them.
const HUM: usize = 3;

/// A line in a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    bin: usize,
    /// Amplitude of the sine, in the signal's unit.
    amplitude: f64,
}

/// Tells of every signal that has lines while neither what drives the rig nor any other signal has some there; `drives` tells
/// what does by its name.
#[must_use]
pub fn lines(record: &Record, drives: impl Fn(&str) -> bool) -> Vec<DataProblem> {
    let mut problems = Problems { record: &record.name, found: Vec::new() };
    let (driving, shown): (Vec<&Channel>, Vec<&Channel>) =
        record.channels.iter().partition(|it| drives(&it.name));
    let even = |step: f64| record.time.windows(2).all(|pair| pair[1] - pair[0] <= GAP * step);
    let Some(step) = median_period(&record.time).filter(|step| !driving.is_empty() && even(*step)) else {
        return problems.found;
    };
    let of = |channels: &[&Channel]| -> Vec<Spectrum> {
        channels.iter().map(|it| Spectrum::of(&it.values)).collect()
    };
    let (driving, spectra) = (of(&driving), of(&shown));
    if driving.iter().any(Spectrum::is_periodic) {
        return problems.found;
    }
    for (index, (channel, spectrum)) in shown.iter().zip(&spectra).enumerate() {
        let lines = spectrum.lines();
        let others = spectra.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, it)| it);
        let nowhere = |of: &Spectrum| lines.iter().all(|line| of.above(line.bin) < NOTHING);
        let Some(largest) = lines.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)) else { continue };
        let steady = is_steady(&channel.values, spectrum.frequency(largest.bin));
        if lines.len() > HUM || !steady || !others.chain(&driving).all(nowhere) {
            continue;
        }
        let text = format!(
            "has a sine of {} {} at {} Hz that no other signal has: hum, or something faster than {} Hz, half the \
             sampling rate, which is folded to there; record once more at another rate, where only what is folded is \
             elsewhere, and with a filter before the converter",
            number(largest.amplitude),
            channel.unit,
            number(spectrum.frequency(largest.bin) / step),
            number(0.5 / step)
        );
        problems.add(&channel.name, false, text);
    }
    problems.found
}

/// Whether a sine, at a frequency in units of the sampling rate, is as large in the first half of a signal as in the second.
fn is_steady(values: &[f64], frequency: f64) -> bool {
    let Some(values) = filled(&values[..values.len().min(MOST)]) else { return false };
    let (first, second) = values.split_at(values.len() / 2);
    let amplitude = |half: &[f64]| {
        let part = |wave: fn(f64) -> f64| -> f64 {
            let terms = half.iter().enumerate().map(|(k, y)| {
                let window = 1.0 - (TAU * k as f64 / half.len() as f64).cos();
                window * y * wave(TAU * frequency * k as f64)
            });
            terms.sum()
        };
        part(f64::cos).hypot(part(f64::sin)) / half.len().max(1) as f64
    };
    let (first, second) = (amplitude(first), amplitude(second));
    first.max(second) < STEADY * first.min(second)
}

/// The power of a signal behind Hann's window.
struct Spectrum {
    power: Vec<f64>,
    samples: usize,
}

impl Spectrum {
    fn of(values: &[f64]) -> Self {
        let values = filled(&values[..values.len().min(MOST)]).unwrap_or_default();
        Self { power: periodogram(&values), samples: values.len() }
    }

    /// In units of the sampling rate.
    fn frequency(&self, bin: usize) -> f64 {
        bin as f64 / self.samples as f64
    }

    /// Power of a bin over the median around it, on the side where that is more.
    fn above(&self, bin: usize) -> f64 {
        let side = |bins: Range<usize>| median(&mut self.power.get(bins)?.to_vec());
        let below = bin.checked_sub(AROUND).and_then(|from| side(from..bin - SPREAD));
        let beyond = side(bin + SPREAD + 1..bin + AROUND + 1);
        let (Some(below), Some(beyond)) = (below, beyond) else { return 0.0 };
        self.power[bin] / below.max(beyond).max(f64::MIN_POSITIVE)
    }

    /// Whether it repeats itself, so that every bend in the rig makes lines of it.
    fn is_periodic(&self) -> bool {
        let near: f64 = self.power.windows(2 * SPREAD + 1).map(|it| it.iter().sum()).fold(0.0, f64::max);
        near > MOSTLY * self.power.iter().sum::<f64>() || !self.lines().is_empty()
    }

    fn lines(&self) -> Vec<Line> {
        let peak = |bin: &usize| {
            let near = &self.power[bin.saturating_sub(SPREAD)..(bin + SPREAD + 1).min(self.power.len())];
            near.iter().all(|it| *it <= self.power[*bin]) && self.above(*bin) > ABOVE
        };
        // A sine has half of its power on this side, wherever it is between two bins; the window passes 3/8.
        let amplitude = |bin: usize| {
            let power: f64 = self.power[bin - SPREAD..=bin + SPREAD].iter().sum();
            (4.0 / 0.375 * power).sqrt() / self.samples as f64
        };
        (0..self.power.len()).filter(peak).map(|bin| Line { bin, amplitude: amplitude(bin) }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strut_signal::random::white;

    const STEP: f64 = 1e-3;
    const COUNT: usize = 12_000;

    /// The problems of signals of which the first one drives the others.
    fn told(signals: &[Vec<f64>]) -> Vec<DataProblem> {
        let time: Vec<f64> = (0..signals[0].len()).map(|k| STEP * k as f64).collect();
        let channel = |(number, values): (usize, &Vec<f64>)| Channel {
            name: number.to_string(),
            unit: "m".into(),
            values: values.clone(),
        };
        let channels: Vec<Channel> = signals.iter().enumerate().map(channel).collect();
        lines(&Record { name: "record".into(), time, channels, ..Record::default() }, |name| name == "0")
    }

    fn with_sine(signal: &[f64], amplitude: f64, frequency: f64) -> Vec<f64> {
        let sine = |k: usize| amplitude * (TAU * frequency * STEP * k as f64 + 0.4).sin();
        signal.iter().enumerate().map(|(k, y)| y + sine(k)).collect()
    }

    /// A quarter of a per cent of critical damping: what rings down over a record has a line, too.
    #[test]
    fn what_rings_down_is_no_hum() {
        let ringing: Vec<f64> = (0..COUNT)
            .map(|k| (-0.0025 * TAU * 16.0 * STEP * k as f64).exp() * (TAU * 16.0 * STEP * k as f64).sin())
            .collect();
        let noise = |seed: u64| -> Vec<f64> { white(seed, COUNT).iter().map(|it| 1e-3 * it).collect() };
        let sum: Vec<f64> = ringing.iter().zip(noise(8)).map(|(y, noise)| y + noise).collect();
        assert!(told(&[noise(9), sum]).is_empty());
        assert_eq!(told(&[noise(9), with_sine(&noise(8), 1.0, 16.0)]).len(), 1);
    }

    /// A mass on a spring of 40 Hz, with a hundredth of critical damping, shaken at random.
    fn resonating(seed: u64) -> Vec<f64> {
        let (pole, decay) = (TAU * 40.0 * STEP, (-0.01 * TAU * 40.0 * STEP).exp());
        let mut last = [0.0; 2];
        let shaken = white(seed, COUNT).into_iter().map(|force| {
            let next = 2.0 * decay * pole.cos() * last[0] - decay * decay * last[1] + force;
            last = [next, last[0]];
            next
        });
        shaken.collect()
    }

    #[test]
    fn noise_and_resonances_have_no_lines() {
        for seed in 0..40 {
            let signals = [white(seed, COUNT), resonating(seed + 100)];
            assert_eq!(told(&signals), [], "{seed}");
        }
    }

    /// 1163 Hz sampled a thousand times a second.
    #[test]
    fn what_is_folded_is_told_with_its_size_and_place() {
        let signals = [white(1, COUNT), with_sine(&resonating(2), 0.5, 1163.0), resonating(3)];
        let found = told(&signals);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].signal, "1");
        assert!(found[0].text.contains(" m at 163 Hz that no other signal has"), "{}", found[0].text);
    }

    #[test]
    fn a_line_s_size_does_not_depend_on_where_it_is_between_bins() {
        for part in 0..10 {
            let frequency = 1163.0 + f64::from(part) / (10.0 * COUNT as f64 * STEP);
            let lines = Spectrum::of(&with_sine(&white(7, COUNT), 0.5, frequency)).lines();
            assert!(lines.len() == 1 && (lines[0].amplitude / 0.5 - 1.0).abs() < 0.05, "{lines:?}");
        }
    }

    #[test]
    fn a_sine_that_others_have_or_that_drives_the_rig_is_none_of_a_sensor() {
        let [driving, shaken] = [white(1, COUNT), with_sine(&white(2, COUNT), 0.5, 37.0)];
        assert_eq!(told(&[driving.clone(), shaken.clone(), resonating(3)]).len(), 1);
        assert_eq!(told(&[driving, shaken.clone(), with_sine(&white(3, COUNT), 0.5, 37.0)]), []);
        assert_eq!(told(&[shaken, with_sine(&white(3, COUNT), 0.5, 111.0)]), []);
    }

    #[test]
    fn what_is_missing_has_no_lines() {
        assert_eq!(told(&[white(1, COUNT), vec![f64::NAN; COUNT]]), []);
        assert_eq!(told(&[vec![], vec![]]), []);
    }

    /// Seven periods, and friction's third harmonic in the force.
    #[test]
    fn harmonics_of_what_drives_the_rig_are_none_of_a_sensor() {
        let few = |amplitude: f64, frequency: f64| with_sine(&white(1, COUNT), amplitude, frequency);
        assert_eq!(told(&[few(20.0, 0.6), few(3.0, 1.8)]), []);
        assert_eq!(told(&[white(2, COUNT), few(3.0, 1.8)]).len(), 1);
    }
}
