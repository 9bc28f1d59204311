//! What drives the plant in a part of a record.

use std::ops::Range;
use std::sync::Arc;

use crate::plant::{Between, Drive};
use crate::signal::derivative;
use crate::signal::distortion::{Correction, Samples};
use crate::signal::spectral::{FINER, in_band, refined};

use super::recorded::{Dataset, Source};

impl Dataset {
    /// How many values of an input there are in a step of what drives the plant: where signals go along curves, a cubic
    /// through the record's own samples would lose a tenth of what is halfway to half the sampling rate.
    fn finer(&self) -> usize {
        match (&self.wide, self.between) {
            (Some(wide), _) => wide.finer,
            (None, Between::Lines) => 1,
            (None, Between::Curves) => FINER,
        }
    }

    /// The same with the rates of inputs that are known in a wider band, over each whole section.
    #[must_use]
    pub fn with_rates(mut self) -> Self {
        let Some(mut wide) = self.wide.clone() else { return self };
        let own = Arc::make_mut(&mut wide);
        for (index, source) in self.inputs.iter().enumerate() {
            let Some(other) = source.motion().filter(|it| own.has(*it)) else { continue };
            let rates = self.sections.iter().flat_map(|section| {
                let mut rate = self.rate(&own.part(other, section), source);
                rate.resize(own.finer * section.len(), rate.last().copied().unwrap_or_default());
                rate
            });
            own.inputs[index] = rates.collect();
        }
        self.wide = Some(wide);
        self
    }

    /// Whether nothing was done to the motion that an input is a rate of.
    fn is_plain(&self, input: usize, corrections: &[Correction]) -> bool {
        corrections[input].is_neutral()
            && self.inputs[input].motion().is_none_or(|it| self.is_plain(it, corrections))
    }

    /// The values of a measured input that drive the plant in a section.
    fn driving(&self, input: usize, values: &[f64], section: &Range<usize>) -> Vec<f64> {
        match (&self.wide, self.between) {
            (Some(wide), _) => wide.part(input, section),
            (None, Between::Lines) => values[section.clone()].to_vec(),
            (None, Between::Curves) => refined(&values[section.clone()]),
        }
    }

    /// The same corrected. A late signal at the section's begin is what came before: the record has it, unless it begins there, too.
    fn corrected(&self, input: usize, values: &[f64], section: &Range<usize>, by: &Correction) -> Vec<f64> {
        let Some(last) = section.len().checked_sub(1) else { return Vec::new() };
        let finer = self.finer();
        let (before, after) = by.reach(self.samples(section), section.len());
        let whole = self.recorded_around(section);
        let around =
            section.start.saturating_sub(before).max(whole.start)..(section.end + after).min(whole.end);
        let samples = Samples { step: self.step / finer as f64, first: finer * around.start };
        let signal = by.applied(&self.driving(input, values, &around), samples);
        signal[finer * (section.start - around.start)..][..=finer * last].to_vec()
    }

    /// The longest part of the record without a gap that has a part of a section in it.
    fn recorded_around(&self, part: &Range<usize>) -> Range<usize> {
        let own = |it: &Range<usize>| it.start <= part.start && part.end <= it.end;
        let whole = self.joined().sections.into_iter().find(own);
        whole.unwrap_or_else(|| part.clone())
    }

    /// What drives the plant in a section, the inputs' signals being corrected.
    pub fn drive(&self, section: &Range<usize>, corrections: &[Correction]) -> Drive {
        let finer = self.finer();
        let mut inputs: Vec<Vec<f64>> = Vec::with_capacity(self.inputs.len());
        for (index, (source, correction)) in self.inputs.iter().zip(corrections).enumerate() {
            inputs.push(match source {
                Source::Measured(values) if correction.is_neutral() => self.driving(index, values, section),
                Source::Measured(values) => self.corrected(index, values, section, correction),
                Source::Constant(value) => vec![*value; finer * section.len().saturating_sub(1) + 1],
                Source::DerivativeOf(_) | Source::RateOf(_) => Vec::new(),
            });
        }
        for (index, source) in self.inputs.iter().enumerate() {
            if let Some(other) = source.motion() {
                inputs[index] = match &self.wide {
                    Some(wide) if wide.has(index) && self.is_plain(other, corrections) => {
                        wide.part(index, section)
                    }
                    _ => self.rate(&inputs[other], source),
                };
            }
        }
        Drive {
            start: section.start as f64 * self.step,
            step: self.step,
            inputs,
            finer,
            between: self.between,
            filtered: self.wide.is_some(),
        }
    }

    /// The derivative of an input: as a file's reader takes it, nearly that of the curve through the samples, or that of the
    /// signal in the band of its samples.
    fn rate(&self, signal: &[f64], source: &Source) -> Vec<f64> {
        let step = self.step / self.finer() as f64;
        if matches!(source, Source::RateOf(_)) {
            let needed = self.wide.as_ref().map_or(1, |wide| wide.needed);
            return in_band(signal, step, 0.5 * needed as f64 / self.step, 1);
        }
        let mut rate = derivative(signal, step);
        if self.between == Between::Curves {
            for (rate, near) in rate.iter_mut().skip(3).zip(signal.windows(7)) {
                let odd = |reach: usize| near[3 + reach] - near[3 - reach];
                *rate = (45.0 * odd(1) - 9.0 * odd(2) + odd(3)) / (60.0 * step);
            }
        }
        rate
    }

    /// How the drive changes when one input's signal does.
    pub fn change(&self, input: usize, change: Vec<f64>) -> Vec<(usize, Vec<f64>)> {
        let mut changes = vec![(input, change)];
        // A derivative comes after what it is the derivative of.
        for (index, source) in self.inputs.iter().enumerate() {
            let of = changes.iter().find(|(other, _)| source.motion() == Some(*other));
            if let Some(rate) = of.map(|(_, change)| self.rate(change, source)) {
                changes.push((index, rate));
            }
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::distortion::Fault;

    /// Of 20 Hz and of 64 Hz, of which differences of the samples alone would lose 0.6 %.
    #[test]
    fn a_curves_rate_is_that_of_the_signal() {
        let step = 2.5e-3;
        let time = |k: i32| f64::from(k) * step;
        let rate = |omega: f64, between: Between| {
            let position: Vec<f64> = (0..80).map(|k| (omega * time(k)).sin()).collect();
            let inputs = vec![Source::Measured(position), Source::DerivativeOf(0)];
            let record = Dataset {
                step,
                inputs,
                between,
                sections: std::iter::once(0..80).collect(),
                ..Dataset::default()
            };
            let error = |(k, rate): (i32, &f64)| (rate / omega - (omega * time(k)).cos()).abs();
            let drive = record.drive(&(0..80), &[Correction::default(); 2]);
            assert_eq!(drive.len(), 80);
            let rates = drive.inputs[1].iter().step_by(drive.finer);
            (0..80).zip(rates).skip(10).take(60).map(error).fold(0.0, f64::max)
        };
        for omega in [125.0, 400.0] {
            assert!(rate(omega, Between::Curves) < 4e-4, "{omega}: {}", rate(omega, Between::Curves));
        }
        assert!((0.015..0.018).contains(&rate(125.0, Between::Lines)), "{}", rate(125.0, Between::Lines));
    }

    /// Corrected in parts or as a whole, a signal is the same but for what the record does not have: what came before a gap.
    #[test]
    fn a_late_signal_is_of_the_section_before() {
        let values: Vec<f64> = (0..300).map(|k| (0.1 * f64::from(k)).sin()).collect();
        for (between, fault, amount) in [
            (Between::Lines, Fault::Delay, 0.155),
            (Between::Curves, Fault::Delay, 0.155),
            (Between::Curves, Fault::Delay, -0.155),
            (Between::Lines, Fault::Lag, 0.03),
            (Between::Lines, Fault::Rate, 0.02),
        ] {
            let record = Dataset {
                step: 0.01,
                inputs: vec![Source::Measured(values.clone())],
                between,
                sections: vec![0..100, 100..200, 220..300],
                ..Dataset::default()
            };
            let mut correction = [Correction::default()];
            correction[0].set(fault, amount);
            let of = |section: Range<usize>| record.drive(&section, &correction).inputs.swap_remove(0);
            let (whole, first, second) = (of(0..200), of(0..100), of(100..200));
            let finer = record.finer();
            let nearly = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
            assert!(nearly(&whole, &first) && nearly(&whole[100 * finer..], &second), "{fault:?} {amount}");
            assert_eq!((first.len(), second.len()), (99 * finer + 1, 99 * finer + 1));
            if amount == 0.155 {
                assert!(nearly(&of(220..300)[..15 * finer], &vec![values[220]; 15 * finer]));
            }
        }
    }
}
