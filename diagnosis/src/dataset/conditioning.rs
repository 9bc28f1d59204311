//! Records made ready for the search: inputs without the noise of their measurement, and no more samples than needed.
//!
//! A road that is measured with noise would shake the simulated tyre with it: noise of 50 µm is 8 N at 150 N/mm. Each
//! measured input is therefore passed through Wiener's filter without phase, made from the signal's own spectrum and
//! the level of its noise. Above some 400 samples a second the records of suspensions hold noise only; they are thinned
//! to 400 to 800, behind a filter without phase, the same for every signal. The inputs then have nothing above four fifths of half
//! the sampling rate, and what they were between the samples follows from these.

use std::ops::Range;
use std::sync::Arc;

use crate::data::Channel;
use crate::data::check::noise_floor;
use crate::dataset::recorded::{Dataset, Measured, Source, Wide};
use crate::plant::Between;
use crate::signal::random::with_noise;
use crate::signal::spectral::{
    Complex, FINER, KEPT, Line, about_line, decimated, filled, left_of_noise, refined,
};

/// Samples a second that are enough.
const ENOUGH: f64 = 400.0;
/// Values of the motion in a sample of the record when the reported model is fitted, if there are as many: backlash in a damper closes
/// within a millisecond.
const FINER_MOTION: usize = 2;
/// Samples of a signal whose spectrum tells noise from it, at least.
const SHORTEST: usize = 16;
/// New periods over which the filter spreads a sample.
const SPREAD: usize = 2;
/// Bins to each side over which a spectrum is smoothed before it is compared to the noise.
const SMOOTHING: usize = 20;
/// Power over that of the noise below which a smoothed bin holds no signal: noise alone is above it once in six thousand (χ² of as many
/// degrees of freedom). What is let through of it would count where a model takes the derivative of a measured position.
const BEYOND_CHANCE: f64 = 2.0;

impl Dataset {
    /// The record without its inputs' noise, and thinned; where its motion is imposed, driven by all of it that is known.
    pub fn conditioned(&self) -> Self {
        let thinned = self.without_noise();
        let is_thinner = thinned.step > self.step;
        if self.imposed && is_thinner {
            self.thinned(1, 0.0).behind(thinned, 1).with_rates()
        } else {
            thinned
        }
    }

    /// The conditioned record with motion that is computed at twice its rate, the outputs behind the filter of the measured ones; as it
    /// is where there are no more samples, or all of them are seen already.
    #[must_use]
    pub fn with_finer_motion(&self, conditioned: &Self) -> Self {
        let factor = (conditioned.step / self.step).round() as usize;
        if factor < FINER_MOTION || conditioned.wide.is_some() {
            return conditioned.clone();
        }
        self.thinned(factor / FINER_MOTION, 0.0).behind(conditioned.clone(), 1).with_rates()
    }

    /// The record below a frequency in Hz, thinned. All signals pass the same filter: whatever it takes away of a motion, it
    /// takes away of the force that made it.
    pub fn below(&self, top: f64) -> Self {
        self.thinned(self.decimation(2.0 * top / KEPT), f64::INFINITY)
    }

    /// The record below a frequency in Hz, driven by its inputs as far as they are known above it, too.
    pub fn compared_below(&self, top: f64) -> Self {
        if self.between == Between::Curves {
            return self.below(top);
        }
        let factor = self.decimation(2.0 * top / KEPT);
        // A whole number of the samples that are known makes one that is compared: in steps of their own, both would end in a wider band.
        let most = self.decimation(ENOUGH).min(factor);
        let finer = (1..=most).rev().find(|it| factor.is_multiple_of(*it)).unwrap_or(1);
        let known = self.thinned(finer, top);
        let banded = known.thinned(factor / finer, f64::INFINITY);
        if finer < factor { known.behind(banded, FINER) } else { banded }
    }

    /// A thinned copy of this record that is driven by all of this one's inputs, its outputs being behind the filter of the copy. Where
    /// a sample of the copy is fewer than `least` of this record's, these are refined.
    fn behind(&self, thinned: Self, least: usize) -> Self {
        let needed = (thinned.step / self.step).round() as usize;
        let refining = if needed < least { FINER } else { 1 };
        let finer = needed * refining;
        let laid = |values: &[f64]| -> Vec<f64> {
            let of = |(known, thinned): (&Range<usize>, &Range<usize>)| {
                let part = &values[known.clone()];
                let mut part = if refining == 1 { part.to_vec() } else { refined(part) };
                let last = part.last().copied().unwrap_or_default();
                part.resize(finer * thinned.len(), last);
                part
            };
            self.sections.iter().zip(&thinned.sections).flat_map(of).collect()
        };
        let inputs = self.inputs.iter().map(|it| it.measured().map(laid).unwrap_or_default()).collect();
        let errors = self.errors.iter().map(|it| if it.is_empty() { Vec::new() } else { laid(it) }).collect();
        Self { wide: Some(Arc::new(Wide { finer, needed, inputs, errors })), ..thinned }
    }

    /// The record without its inputs' noise, and thinned.
    fn without_noise(&self) -> Self {
        // In a record that is thinned to its band already, noise and signal look alike.
        if self.between == Between::Curves {
            return self.clone();
        }
        let factor = self.decimation(ENOUGH);
        // A whole number of the finer samples makes one.
        let factor = if factor < FINER_MOTION { factor } else { factor - factor % FINER_MOTION };
        self.thinned(factor, 0.0)
    }

    /// Number of samples of which one is enough at `rate` samples a second.
    fn decimation(&self, rate: f64) -> usize {
        ((1.0 / (self.step * rate)).floor() as usize).max(1)
    }

    /// The record with one of `factor` samples, without frequencies above four fifths of half the new rate; without the
    /// inputs' noise above the frequency `quiet` in Hz.
    fn thinned(&self, factor: usize, quiet: f64) -> Self {
        let mut sections: Vec<Range<usize>> = Vec::new();
        for section in &self.sections {
            let first = sections.last().map_or(0, |before: &Range<usize>| before.end);
            sections.push(first..first + section.len().div_ceil(factor));
        }
        let known = |values: &[f64]| -> Vec<f64> {
            self.sections.iter().flat_map(|it| values[it.clone()].to_vec()).collect()
        };
        let filter = |noise: f64| Filter { noise, quiet: quiet * self.step, factor };
        let through = |values: &[f64], noise: f64| -> Vec<f64> {
            self.sections.iter().flat_map(|it| filter(noise).over_gaps(&values[it.clone()])).collect()
        };
        let inputs = self.inputs.iter().map(|source| match source {
            Source::Measured(values) => Source::Measured(through(values, noise_floor(&known(values)))),
            other => other.clone(),
        });
        let errors = (1..).zip(&self.inputs).map(|(channel, source)| match source {
            Source::Measured(values) => {
                let filter = filter(noise_floor(&known(values)));
                self.sections.iter().flat_map(|it| filter.error(&values[it.clone()], channel)).collect()
            }
            _ => Vec::new(),
        });
        let measured = self.measured.iter().map(|measured| Measured {
            output: measured.output,
            values: through(&measured.values, 0.0),
            noise_floor: measured.noise_floor * left_of_noise(factor),
        });
        let others = self.others.iter().map(|it| Channel { values: through(&it.values, 0.0), ..it.clone() });
        Self {
            name: self.name.clone(),
            step: self.step * factor as f64,
            inputs: inputs.collect(),
            errors: errors.collect(),
            between: Between::Curves,
            wide: None,
            imposed: self.imposed,
            measured: measured.collect(),
            others: others.collect(),
            sections,
        }
    }
}

/// A filter without phase, and how many samples become one behind it.
#[derive(Clone, Copy, Debug)]
struct Filter {
    /// Standard deviation of the white noise that it takes away, by Wiener's gains.
    noise: f64,
    /// From which frequency on it does, in cycles a sample.
    quiet: f64,
    /// Of how many samples one is left.
    factor: usize,
}

impl Filter {
    /// A signal through the filter, missing where it was missing or where the filter brings in what was.
    fn over_gaps(self, values: &[f64]) -> Vec<f64> {
        let bridged = match filled(values) {
            Some(bridged) if values.iter().any(|it| !it.is_finite()) => bridged,
            _ => return self.filtered(values),
        };
        let thin = self.filtered(&bridged).into_iter().enumerate();
        let reach = SPREAD * (self.factor - 1);
        thin.map(|(k, value)| {
            let middle = k * self.factor;
            let near = &values[middle.saturating_sub(reach)..(middle + reach + 1).min(values.len())];
            if near.iter().all(|it| it.is_finite()) { value } else { f64::NAN }
        })
        .collect()
    }

    /// A signal through the filter, and every `factor`-th sample of it.
    fn filtered(self, values: &[f64]) -> Vec<f64> {
        if self.noise == 0.0 || self.quiet.is_infinite() || values.len() < SHORTEST {
            return decimated(values, self.factor);
        }
        let (line, deviation) =
            about_line(values, &mut |spectrum| self.gains(spectrum).into_iter().map(Complex::from).collect());
        self.thinned(line, deviation)
    }

    /// Its noise behind the gains that a signal has.
    fn error(self, values: &[f64], channel: u64) -> Vec<f64> {
        if self.noise == 0.0 || values.len() < SHORTEST {
            return vec![0.0; values.len().div_ceil(self.factor)];
        }
        let mut own = Vec::new();
        let signal = filled(values).unwrap_or_else(|| values.to_vec());
        about_line(&signal, &mut |spectrum| {
            own = self.gains(spectrum);
            own.iter().map(Complex::from).collect()
        });
        let drawn = with_noise(&vec![0.0; values.len()], self.noise, channel);
        let (line, deviation) = about_line(&drawn, &mut |_| own.iter().map(Complex::from).collect());
        self.thinned(line, deviation)
    }

    fn thinned(self, line: Line, mut deviation: Vec<f64>) -> Vec<f64> {
        deviation.iter_mut().enumerate().for_each(|(k, value)| *value += line.at(k));
        decimated(&deviation, self.factor)
    }

    /// The gain of each bin: what of its power is no noise.
    fn gains(self, spectrum: &[Complex<f64>]) -> Vec<f64> {
        let len = spectrum.len();
        let power: Vec<f64> = spectrum.iter().map(Complex::norm_sqr).collect();
        let level = len as f64 * self.noise * self.noise;
        (0..len)
            .map(|bin| {
                if (bin.min(len - bin) as f64) < self.quiet * len as f64 {
                    return 1.0;
                }
                let around = (0..=2 * SMOOTHING).map(|offset| power[(bin + len + offset - SMOOTHING) % len]);
                let mean = around.sum::<f64>() / (2 * SMOOTHING + 1) as f64;
                if mean > BEYOND_CHANCE * level { 1.0 - level / mean } else { 0.0 }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(k: usize) -> f64 {
        let t = k as f64 * 1e-3;
        (6.0 * t).sin() + 0.3 * (50.0 * t + 1.0).sin() + 0.2 * t
    }

    fn filter(noise: f64, factor: usize) -> Filter {
        Filter { noise, quiet: 0.0, factor }
    }

    #[test]
    fn noise_goes_and_the_signal_stays() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let noisy: Vec<f64> = (0..5000).map(|k| signal(k) + 0.1 * random()).collect();
        let clean = filter(0.1 / 12.0_f64.sqrt(), 1).filtered(&noisy);
        let error = |values: &[f64]| -> f64 {
            let squares = values.iter().enumerate().map(|(k, value)| (value - signal(k)).powi(2));
            (squares.sum::<f64>() / values.len() as f64).sqrt()
        };
        assert!(error(&clean) < 0.3 * error(&noisy), "{} {}", error(&clean), error(&noisy));
    }

    /// The remaining noise of a filtered signal, and another draw of it.
    #[test]
    fn an_inputs_error_is_as_large_as_what_its_noise_leaves() {
        let white = crate::signal::random::white(7, 20_000);
        let noisy: Vec<f64> = white.iter().enumerate().map(|(k, noise)| signal(k) + 0.01 * noise).collect();
        let rms =
            |values: &[f64]| (values.iter().map(|it| it * it).sum::<f64>() / values.len() as f64).sqrt();
        let kept: Vec<f64> = filter(0.01, 2)
            .filtered(&noisy)
            .iter()
            .enumerate()
            .map(|(k, value)| value - signal(2 * k))
            .collect();
        let drawn = filter(0.01, 2).error(&noisy, 3);
        assert_eq!(drawn.len(), kept.len());
        let ratio = rms(&drawn) / rms(&kept);
        assert!((0.5..2.0).contains(&ratio) && rms(&drawn) < 0.005, "{ratio}, {}", rms(&drawn));
        // A filter that only ends the band leaves all noise below its end.
        let plain = rms(&Filter { quiet: f64::INFINITY, ..filter(0.01, 2) }.error(&noisy, 3));
        assert!((plain / (0.01 * left_of_noise(2)) - 1.0).abs() < 0.05, "{plain}");
        assert!(filter(0.0, 2).error(&noisy, 3).iter().all(|it| *it == 0.0));
    }

    /// Of a damper on a bench the force is that of the velocity, which is derived from a noisy position.
    #[test]
    fn the_derivative_of_a_noisy_position_is_a_velocity() {
        let white = crate::signal::random::white(5, 20_000);
        let noisy: Vec<f64> = white.iter().enumerate().map(|(k, noise)| signal(k) + 0.01 * noise).collect();
        let rates = |values: &[f64], step: f64| crate::signal::derivative(values, step);
        let clean: Vec<f64> = (0..20_000).map(signal).collect();
        let apart = |values: &[f64]| {
            let (rate, wanted) = (rates(values, 2e-3), rates(&clean, 1e-3));
            let squares = (500..9500).map(|k| (rate[k] - wanted[2 * k]).powi(2));
            (squares.sum::<f64>() / 9000.0).sqrt()
        };
        // With all bins in which noise happens to be above its mean it is 0.6, and unfiltered 3.
        let found = apart(&filter(0.01, 2).filtered(&noisy));
        assert!(found < 0.25, "{found}");
    }

    /// What is compared ends where it was judged whether the motion is known.
    #[test]
    fn a_record_is_compared_in_the_band_that_was_asked_for() {
        for step in [1e-3, 2e-3, 5e-4, 2.5e-3] {
            let values: Vec<f64> = (0..4000).map(signal).collect();
            let record = Dataset {
                step,
                measured: vec![Measured { output: 0, values, noise_floor: 0.0 }],
                sections: std::iter::once(0..4000).collect(),
                ..Dataset::default()
            };
            for top in [8.0, 20.0, 45.0, 93.0, 116.0, 140.0, 190.0] {
                assert_eq!(record.compared_below(top).step, record.below(top).step, "{top} Hz of {step} s");
            }
        }
    }

    #[test]
    fn a_clean_signal_is_thinned_without_delay() {
        let values: Vec<f64> = (0..5000).map(signal).collect();
        let thin = filter(0.0, 4).filtered(&values);
        assert_eq!(thin.len(), 1250);
        for (k, value) in thin.iter().enumerate().skip(20).take(1210) {
            assert!((value - signal(4 * k)).abs() < 2e-3, "{k}");
        }
    }

    #[test]
    fn what_is_missing_stays_missing_and_spoils_nothing_else() {
        let mut values: Vec<f64> = (0..5000).map(signal).collect();
        values[2000..2010].fill(f64::NAN);
        values[0] = f64::NAN;
        let thin = filter(0.0, 4).over_gaps(&values);
        let missing: Vec<usize> = (0..thin.len()).filter(|k| thin[*k].is_nan()).collect();
        assert_eq!(missing, [0, 1, 499, 500, 501, 502, 503]);
        for (k, value) in thin.iter().enumerate().skip(20).take(1210).filter(|(_, value)| value.is_finite()) {
            assert!((value - signal(4 * k)).abs() < 2e-3, "{k}");
        }
    }
}
