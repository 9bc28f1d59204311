//! Records made ready for the search: inputs without the noise of their measurement, and no more samples than needed.
//!
//! A road that is measured with noise would shake the simulated tyre with it: noise of 50 µm is 8 N at 150 N/mm. Each
//! measured input is therefore passed through Wiener's filter without phase, made from the signal's own spectrum and
//! the level of its noise. Above some 400 samples a second the records of suspensions hold noise only; they are thinned
//! to that, behind a filter without phase, the same for every signal. The inputs then have nothing above four fifths of half
//! the sampling rate, and what they were between the samples follows from these.

use std::ops::Range;

use crate::data::Channel;
use crate::data::check::noise_floor;
use crate::dataset::recorded::{Dataset, Measured, Source};
use crate::plant::Between;
use crate::signal::random::with_noise;
use crate::signal::spectral::{Complex, KEPT, about_line, filled};

/// Samples a second that are enough.
const ENOUGH: f64 = 400.0;
/// New periods over which the filter spreads a sample.
const SPREAD: usize = 2;
/// Bins to each side over which a spectrum is smoothed before it is compared to the noise.
const SMOOTHING: usize = 20;
/// Power over that of the noise below which a smoothed bin holds no signal: noise alone is above it once in fifty.
/// What is let through of it would count where a model takes the derivative of a measured position.
const BEYOND_CHANCE: f64 = 1.5;

impl Dataset {
    /// The record without its inputs' noise, and thinned.
    pub fn conditioned(&self) -> Self {
        // In a record that is thinned to its band already, noise and signal look alike.
        if self.between == Between::Curves { self.clone() } else { self.thinned(ENOUGH, true) }
    }

    /// The record below a frequency in Hz, thinned. All signals pass the same filter: whatever it takes away of a motion, it
    /// takes away of the force that made it.
    pub fn below(&self, top: f64) -> Self {
        self.thinned(2.0 * top / KEPT, false)
    }

    /// The record with at least `rate` samples a second, without frequencies above four fifths of half of them; without the
    /// inputs' noise, if `denoised`.
    fn thinned(&self, rate: f64, denoised: bool) -> Self {
        let factor = ((1.0 / (self.step * rate)).floor() as usize).max(1);
        let mut sections: Vec<Range<usize>> = Vec::new();
        for section in &self.sections {
            let first = sections.last().map_or(0, |before: &Range<usize>| before.end);
            sections.push(first..first + section.len().div_ceil(factor));
        }
        let through = |values: &[f64], noise: f64| -> Vec<f64> {
            let parts = self.sections.iter().map(|section| present(&values[section.clone()], noise, factor));
            parts.flatten().collect()
        };
        let known = |values: &[f64]| -> Vec<f64> {
            self.sections.iter().flat_map(|it| values[it.clone()].to_vec()).collect()
        };
        let inputs = self.inputs.iter().map(|source| match source {
            Source::Measured(values) => {
                Source::Measured(through(values, if denoised { noise_floor(&known(values)) } else { 0.0 }))
            }
            other => other.clone(),
        });
        let errors = (1..).zip(&self.inputs).map(|(channel, source)| match source {
            Source::Measured(values) => {
                let noise = noise_floor(&known(values));
                let parts = self
                    .sections
                    .iter()
                    .map(|it| error(&values[it.clone()], noise, (denoised, factor), channel));
                parts.flatten().collect()
            }
            _ => Vec::new(),
        });
        let measured = self.measured.iter().map(|measured| Measured {
            output: measured.output,
            values: through(&measured.values, 0.0),
            noise_floor: measured.noise_floor / (factor as f64 / KEPT.min(factor as f64)).sqrt().max(1.0),
        });
        let others = self.others.iter().map(|it| Channel { values: through(&it.values, 0.0), ..it.clone() });
        Self {
            name: self.name.clone(),
            step: self.step * factor as f64,
            inputs: inputs.collect(),
            errors: errors.collect(),
            between: Between::Curves,
            measured: measured.collect(),
            others: others.collect(),
            sections,
        }
    }
}

/// A signal through the filter, missing where it was missing or where the filter brings in what was.
fn present(values: &[f64], noise: f64, factor: usize) -> Vec<f64> {
    let bridged = match filled(values) {
        Some(bridged) if values.iter().any(|it| !it.is_finite()) => bridged,
        _ => return filtered(values, noise, factor),
    };
    let thin = filtered(&bridged, noise, factor).into_iter().enumerate();
    let reach = SPREAD * (factor - 1);
    thin.map(|(k, value)| {
        let middle = k * factor;
        let near = &values[middle.saturating_sub(reach)..(middle + reach + 1).min(values.len())];
        if near.iter().all(|it| it.is_finite()) { value } else { f64::NAN }
    })
    .collect()
}

/// A signal through Wiener's filter for white noise of a standard deviation, and every `factor`-th sample of it.
fn filtered(values: &[f64], noise: f64, factor: usize) -> Vec<f64> {
    if (noise == 0.0 && factor == 1) || values.len() < 16 {
        return values.to_vec();
    }
    let (line, deviation) = about_line(values, &mut |spectrum| {
        gains(spectrum, noise, factor).into_iter().map(Complex::from).collect()
    });
    (0..values.len()).step_by(factor).map(|k| deviation[k] + line.at(k)).collect()
}

/// White noise of a standard deviation behind a signal's own filter.
fn error(values: &[f64], noise: f64, (denoised, factor): (bool, usize), channel: u64) -> Vec<f64> {
    if noise == 0.0 || values.len() < 16 {
        return vec![0.0; values.len().div_ceil(factor)];
    }
    let mut own = Vec::new();
    let signal = filled(values).unwrap_or_else(|| values.to_vec());
    about_line(&signal, &mut |spectrum| {
        own = gains(spectrum, if denoised { noise } else { 0.0 }, factor);
        own.iter().map(Complex::from).collect()
    });
    let drawn = with_noise(&vec![0.0; values.len()], noise, channel);
    let (line, deviation) = about_line(&drawn, &mut |_| own.iter().map(Complex::from).collect());
    (0..values.len()).step_by(factor).map(|k| deviation[k] + line.at(k)).collect()
}

/// The gain of each bin: what of its power is no noise, and nothing above the kept band.
fn gains(spectrum: &[Complex<f64>], noise: f64, factor: usize) -> Vec<f64> {
    let len = spectrum.len();
    let power: Vec<f64> = spectrum.iter().map(Complex::norm_sqr).collect();
    let level = len as f64 * noise * noise;
    let cut = KEPT * 0.5 / factor as f64;
    (0..len)
        .map(|bin| {
            let frequency = bin.min(len - bin) as f64 / len as f64;
            if factor > 1 && frequency > cut {
                return 0.0;
            }
            if noise == 0.0 {
                return 1.0;
            }
            let around = (0..=2 * SMOOTHING).map(|offset| power[(bin + len + offset - SMOOTHING) % len]);
            let mean = around.sum::<f64>() / (2 * SMOOTHING + 1) as f64;
            if mean > BEYOND_CHANCE * level { 1.0 - level / mean } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(k: usize) -> f64 {
        let t = k as f64 * 1e-3;
        (6.0 * t).sin() + 0.3 * (50.0 * t + 1.0).sin() + 0.2 * t
    }

    #[test]
    fn noise_goes_and_the_signal_stays() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let noisy: Vec<f64> = (0..5000).map(|k| signal(k) + 0.1 * random()).collect();
        let clean = filtered(&noisy, 0.1 / 12.0_f64.sqrt(), 1);
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
        let kept: Vec<f64> =
            filtered(&noisy, 0.01, 2).iter().enumerate().map(|(k, value)| value - signal(2 * k)).collect();
        let drawn = error(&noisy, 0.01, (true, 2), 3);
        assert_eq!(drawn.len(), kept.len());
        let ratio = rms(&drawn) / rms(&kept);
        assert!((0.5..2.0).contains(&ratio) && rms(&drawn) < 0.005, "{ratio}, {}", rms(&drawn));
        // A filter that only ends the band leaves all noise below its end.
        let plain = rms(&error(&noisy, 0.01, (false, 2), 3));
        assert!((plain / (0.01 * (KEPT / 2.0).sqrt()) - 1.0).abs() < 0.05, "{plain}");
        assert!(error(&noisy, 0.0, (true, 2), 3).iter().all(|it| *it == 0.0));
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
        let found = apart(&filtered(&noisy, 0.01, 2));
        assert!(found < 0.25, "{found}");
    }

    #[test]
    fn a_clean_signal_is_thinned_without_delay() {
        let values: Vec<f64> = (0..5000).map(signal).collect();
        let thin = filtered(&values, 0.0, 4);
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
        let thin = present(&values, 0.0, 4);
        let missing: Vec<usize> = (0..thin.len()).filter(|k| thin[*k].is_nan()).collect();
        assert_eq!(missing, [0, 1, 499, 500, 501, 502, 503]);
        for (k, value) in thin.iter().enumerate().skip(20).take(1210).filter(|(_, value)| value.is_finite()) {
            assert!((value - signal(4 * k)).abs() < 2e-3, "{k}");
        }
    }
}
