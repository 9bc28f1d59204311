//! A record as a plant sees it: what drives it, what was measured of it.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use crate::data::Channel;
use strut_model::unit::Unit;

use crate::plant::{Between, Plant};
use crate::screening::rms;
use crate::signal::derivative;
use crate::signal::distortion::Samples;
use crate::signal::spectral::in_band;

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
    pub(super) fn has(&self, input: usize) -> bool {
        !self.inputs[input].is_empty()
    }

    /// The values of an input in some samples of the record.
    pub(super) fn part(&self, input: usize, samples: &Range<usize>) -> Vec<f64> {
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

    /// The derivative of a signal at the record's samples: exact where the record ends at its band, by differences elsewhere,
    /// since the fast part is noise.
    pub fn rate_of(&self, signal: &[f64]) -> Vec<f64> {
        match self.inputs.iter().any(|source| matches!(source, Source::RateOf(_))) {
            true => in_band(signal, self.step, 0.5 / self.step, 1),
            false => derivative(signal, self.step),
        }
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
}
