//! Where in frequency the errors lie, what drives them there, and whether they are white.

use crate::data::check::noise_floor;
use crate::dataset::recorded::Source;
use crate::diagnosis::Diagnosis;
use crate::report::findings::{Coherence, Periodogram, Spectrum};
use crate::signal::spectral::{coherence, cumulative_periodogram, power_spectrum};

use super::Erring;

/// Power of an input, over its largest, below which rounding drives as much as the input does.
const NOTHING: f64 = 1e-9;

/// Points of a cumulative periodogram that are shown.
const POINTS: usize = 256;

impl Erring<'_> {
    pub(super) fn spectrum(&self) -> Spectrum {
        let density = |signal: &[f64]| {
            let (mut frequency, mut density) = power_spectrum(signal, self.record.step);
            frequency.retain(|it| *it <= self.top);
            density.truncate(frequency.len());
            (frequency, density)
        };
        let (frequency, measured) = density(&self.measured.values);
        Spectrum {
            signal: self.declared.name.clone(),
            unit: self.declared.unit.symbol.into(),
            frequency,
            measured,
            before: density(self.before).1,
            after: density(self.after).1,
        }
    }

    pub(super) fn periodogram(&self) -> Periodogram {
        let of = |error: &[f64]| cumulative_periodogram(error, self.record.step, self.top);
        let (before, after) = (of(self.before), of(self.after));
        let stride = before.frequency.len().div_ceil(POINTS).max(1);
        let thin = |values: &[f64]| values.iter().copied().skip(stride - 1).step_by(stride).collect();
        Periodogram {
            signal: self.declared.name.clone(),
            frequency: thin(&before.frequency),
            before: thin(&before.share),
            after: thin(&after.share),
            distance_before: before.distance,
            distance_after: after.distance,
            limit: before.limit,
        }
    }
}

impl Diagnosis<'_> {
    /// Of a signal's errors with every input that was measured.
    pub(super) fn coherences(&self, errors: &Erring<'_>) -> Vec<Coherence> {
        let inputs = errors.record.inputs.iter().zip(&self.measured[0].inputs);
        let inputs = inputs.zip(&self.baseline.rig.plant.inputs);
        inputs
            .filter_map(|((clean, noisy), declared)| {
                let (Source::Measured(clean), Source::Measured(noisy)) = (clean, noisy) else { return None };
                let of = |error: &[f64]| coherence(error, clean, errors.record.step);
                let (before, after) = (of(errors.before), of(errors.after));
                let noise = 2.0 * self.measured[0].step * noise_floor(noisy).powi(2);
                let largest = before.drive.iter().copied().fold(0.0, f64::max);
                let least = noise.max(NOTHING * largest);
                let driven = |share: &[f64]| -> Vec<Option<f64>> {
                    share
                        .iter()
                        .zip(&before.drive)
                        .map(|(it, power)| (*power > least).then_some(*it))
                        .collect()
                };
                Some(Coherence {
                    signal: errors.declared.name.clone(),
                    input: declared.name.clone(),
                    before: driven(&before.share),
                    after: driven(&after.share),
                    limit: before.limit,
                    frequency: before.frequency,
                })
            })
            .collect()
    }
}
