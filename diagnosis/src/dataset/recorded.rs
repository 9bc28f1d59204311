//! A record as a plant sees it: what drives it, what was measured of it.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use crate::data::Channel;
use strut_model::unit::Unit;

use crate::plant::{Between, Drive, Plant};
use crate::screening::rms;
use crate::signal::derivative;
use crate::signal::distortion::{Correction, Samples};
use crate::signal::spectral::{FINER, in_band, refined};

/// A record on a plant's inputs and outputs, evenly sampled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dataset {
    /// The file's name.
    pub name: String,
    /// Time between two samples in seconds.
    pub step: f64,
    /// Where each input comes from.
    pub inputs: Vec<Source>,
    /// Possible errors of each measured input: another draw of its measurement's noise, behind the same filters. Empty until a
    /// record is filtered.
    pub errors: Vec<Vec<f64>>,
    /// How the inputs go on between the samples.
    pub between: Between,
    /// The inputs in a wider band than that in which the record is compared, if they are known there.
    pub wide: Option<Arc<Wide>>,
    /// Whether the rig's motion is imposed by its inputs.
    pub imposed: bool,
    /// What was measured.
    pub measured: Vec<Measured>,
    /// Columns that no signal of the rig is.
    pub others: Vec<Channel>,
    /// Ranges of samples that are simulated in one go, each with states of its own at the start.
    pub sections: Vec<Range<usize>>,
}

/// Inputs that are known in a wider band than the outputs are compared in: a law that bends has to see all of the motion, and what
/// follows goes through the filter of the measured signals.
#[derive(Clone, Debug, PartialEq)]
pub struct Wide {
    /// Values of an input in a sample of the record.
    pub finer: usize,
    /// Values in a sample that the inputs' band needs: their rates have nothing above half that rate.
    pub needed: usize,
    /// Values of each measured input and of its rates, `finer` for every sample of the record; none of other inputs. The rates are of
    /// whole sections: at the ends of a part, a derivative in a band would not know what comes before or after.
    pub inputs: Vec<Vec<f64>>,
    /// Possible errors of what was measured.
    pub errors: Vec<Vec<f64>>,
}

impl Wide {
    /// Whether it knows an input.
    fn has(&self, input: usize) -> bool {
        !self.inputs[input].is_empty()
    }

    /// The values of an input in some samples of the record.
    fn part(&self, input: usize, samples: &Range<usize>) -> Vec<f64> {
        if samples.is_empty() {
            return Vec::new();
        }
        self.inputs[input][self.finer * samples.start..=self.finer * (samples.end - 1)].to_vec()
    }
}

/// Where an input comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// It was measured.
    Measured(Vec<f64>),
    /// It is the time derivative of another input, by its index.
    DerivativeOf(usize),
    /// The same where all of the signal is in the band of its samples: the second derivative of a curve through samples would
    /// be that of the curve, and not of the signal.
    RateOf(usize),
    /// It rests.
    Constant(f64),
}

impl Source {
    /// The samples, if it was measured.
    pub fn measured(&self) -> Option<&[f64]> {
        match self {
            Self::Measured(values) => Some(values),
            Self::DerivativeOf(_) | Self::RateOf(_) | Self::Constant(_) => None,
        }
    }

    /// The input that it is the derivative of.
    pub fn motion(&self) -> Option<usize> {
        match self {
            Self::DerivativeOf(other) | Self::RateOf(other) => Some(*other),
            Self::Measured(_) | Self::Constant(_) => None,
        }
    }
}

/// A measured output.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Index among the plant's outputs.
    pub output: usize,
    /// Values, NaN where they are missing.
    pub values: Vec<f64>,
    /// Root mean square of the measurement's noise.
    pub noise_floor: f64,
}

/// Samples beside the ends of a part in which the outputs' filter lacks what comes before or after: four periods of the band's end …
const ENDS: usize = 10;
/// … but the eighth of the part at most.
const PARTS: usize = 8;

/// Root mean square of the noise of a measured output's sensor, by its row, over some records.
pub fn noise_floor(records: &[Dataset], row: usize) -> f64 {
    let squares = records.iter().map(|it| it.measured[row].noise_floor.powi(2));
    (squares.sum::<f64>() / records.len().max(1) as f64).sqrt()
}

/// Length of a short stretch of data in seconds, over which no model goes far astray.
pub const SHORT: f64 = 1.0;

/// Length of the blocks of time over which errors and scores are summed, in seconds: longer than the residuals' memory.
pub const BLOCK: f64 = 0.5;

impl Dataset {
    /// Number of samples in such a block.
    pub fn block(&self) -> usize {
        ((BLOCK / self.step).round() as usize).max(4)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.measured.first().map_or(0, |measured| measured.values.len())
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The largest of its signals in a unit, as a root mean square about its mean; zero if it has none.
    pub fn magnitude(&self, plant: &Plant, unit: Unit) -> f64 {
        let outputs = self.measured.iter().map(|it| (plant.outputs[it.output].unit, &it.values));
        let inputs = self.inputs.iter().zip(&plant.inputs).filter_map(|(source, declared)| match source {
            Source::Measured(values) => Some((declared.unit, values)),
            Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => None,
        });
        let own = outputs.chain(inputs).filter(|(of, _)| *of == unit);
        own.map(|(_, values)| rms(values)).fold(0.0, f64::max)
    }

    /// What is left of a measured output's values without the straight line through each section: of a plant that drifts, a
    /// model has that from the states at the section's start.
    pub fn bent(&self, row: usize) -> Vec<f64> {
        let values = &self.measured[row].values;
        self.sections.iter().flat_map(|section| without_line(&values[section.clone()])).collect()
    }

    /// The same with these errors on its inputs; none without noise.
    pub fn disturbed(&self) -> Option<Self> {
        let mut disturbed = self.clone();
        let mut is_disturbed = false;
        let mut disturb = |values: &mut [f64], errors: &[f64]| {
            is_disturbed |= errors.iter().any(|it| *it != 0.0);
            values.iter_mut().zip(errors).for_each(|(value, error)| *value += error);
        };
        for (source, errors) in disturbed.inputs.iter_mut().zip(&self.errors) {
            if let Source::Measured(values) = source {
                disturb(values, errors);
            }
        }
        if let Some(wide) = &mut disturbed.wide {
            let Wide { inputs, errors, .. } = Arc::make_mut(wide);
            inputs.iter_mut().zip(&*errors).for_each(|(values, errors)| disturb(values, errors));
        }
        is_disturbed.then(|| disturbed.with_rates())
    }

    /// The same with neighbouring sections in one: a filter needs no new start where a simulation does.
    #[must_use]
    pub fn joined(&self) -> Self {
        let mut sections: Vec<Range<usize>> = Vec::new();
        for section in &self.sections {
            match sections.last_mut() {
                Some(last) if last.end == section.start => last.end = section.end,
                _ => sections.push(section.clone()),
            }
        }
        Self { sections, ..self.clone() }
    }

    /// Which samples those of a section are.
    pub fn samples(&self, section: &Range<usize>) -> Samples {
        Samples { step: self.step, first: section.start }
    }

    /// What was measured of an output in a part of a section, by its row; behind a filter, without the samples at the part's ends.
    pub fn compared(&self, row: usize, part: &Range<usize>) -> Cow<'_, [f64]> {
        let values = &self.measured[row].values[part.clone()];
        if self.wide.is_none() {
            return Cow::Borrowed(values);
        }
        let ends = ENDS.min(values.len() / PARTS);
        let mut inner = values.to_vec();
        inner[..ends].fill(f64::NAN);
        inner[values.len() - ends..].fill(f64::NAN);
        Cow::Owned(inner)
    }

    /// The same without the samples at the ends of its sections.
    #[must_use]
    pub fn without_ends(mut self) -> Self {
        for row in 0..self.measured.len() {
            for section in &self.sections {
                let inner = self.compared(row, section).into_owned();
                self.measured[row].values[section.clone()].copy_from_slice(&inner);
            }
        }
        self
    }

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

    /// What drives the plant in a section, the inputs' signals being corrected.
    pub fn drive(&self, section: &Range<usize>, corrections: &[Correction]) -> Drive {
        let finer = self.finer();
        let samples = Samples { step: self.step / finer as f64, first: finer * section.start };
        let mut inputs: Vec<Vec<f64>> = Vec::with_capacity(self.inputs.len());
        for (index, (source, correction)) in self.inputs.iter().zip(corrections).enumerate() {
            inputs.push(match source {
                Source::Measured(values) if correction.is_neutral() => self.driving(index, values, section),
                Source::Measured(values) => {
                    correction.applied(&self.driving(index, values, section), samples)
                }
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

    /// The derivative of a signal at the record's samples: exact where the record ends at its band, by differences elsewhere,
    /// since the fast part is noise.
    pub fn rate_of(&self, signal: &[f64]) -> Vec<f64> {
        match self.inputs.iter().any(|source| matches!(source, Source::RateOf(_))) {
            true => in_band(signal, self.step, 0.5 / self.step, 1),
            false => derivative(signal, self.step),
        }
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

/// The known values without the straight line that is nearest to them.
pub(super) fn without_line(values: &[f64]) -> Vec<f64> {
    let known: Vec<(f64, f64)> =
        (0..).map(f64::from).zip(values.iter().copied()).filter(|(_, value)| value.is_finite()).collect();
    let n = known.len().max(1) as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| known.iter().map(of).sum::<f64>() / n;
    let (at, height) = (mean(&|it| it.0), mean(&|it| it.1));
    let (spread, both) = (mean(&|it| (it.0 - at).powi(2)), mean(&|it| (it.0 - at) * (it.1 - height)));
    let slope = if spread > 0.0 { both / spread } else { 0.0 };
    known.into_iter().map(|(time, value)| value - height - slope * (time - at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_has_nothing_bent() {
        let bent = without_line(&[1.0, f64::NAN, 2.0, 2.5, f64::INFINITY]);
        assert!(bent.len() == 3 && bent.iter().all(|value| value.abs() < 1e-15), "{bent:?}");
        assert_eq!(without_line(&[3.0, 4.0, 7.0, 12.0]), [1.0, -1.0, -1.0, 1.0]);
        assert_eq!((without_line(&[7.0]), without_line(&[f64::NAN])), (vec![0.0], vec![]));
    }

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
}
