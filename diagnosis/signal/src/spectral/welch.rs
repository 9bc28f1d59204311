//! Welch's method: means over windowed segments that overlap by half.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Samples of a segment at most: a power of two.
const SEGMENT: usize = 2048;
/// Segments that a coherence is a mean of at least: of one alone it is 1 whatever the signals are.
const AVERAGED: usize = 16;
/// Chance with which signals that have nothing to do with each other exceed the limit of a coherence.
const CHANCE: f64 = 0.05;

/// Magnitude-squared coherence of two signals.
#[derive(Clone, Debug)]
pub struct Coherence {
    /// In hertz.
    pub frequency: Vec<f64>,
    /// Share of one signal's power that follows from the other linearly, 0 to 1.
    pub share: Vec<f64>,
    /// One-sided power spectral density of the second signal.
    pub drive: Vec<f64>,
    /// What unrelated signals exceed with a chance of 5 %.
    pub limit: f64,
}

/// Frequencies in hertz and one-sided power spectral density.
pub fn power_spectrum(signal: &[f64], step: f64) -> (Vec<f64>, Vec<f64>) {
    let segments = Segments::of(signal, longest(signal.len(), 1));
    (segments.frequency(step), segments.density(step))
}

/// Power of each bin of a whole signal below half the sampling rate, behind Hann's window: squares of its transform.
pub fn periodogram(signal: &[f64]) -> Vec<f64> {
    // Of no samples there is no transform.
    let whole = Segments::of(signal, signal.len().max(1));
    let bins = whole.transforms.iter().flat_map(|transform| &transform[..signal.len() / 2]);
    bins.map(Complex::norm_sqr).collect()
}

/// Frequency in hertz below which signals, each with the time between its samples, have a share of their power about their means;
/// none where they have none.
pub fn below(signals: &[(f64, Vec<f64>)], share: f64) -> Option<f64> {
    let mut bins: Vec<(f64, f64)> = Vec::new();
    for (step, values) in signals {
        let resolution = 1.0 / (step * values.len() as f64);
        let powers = periodogram(values).into_iter().enumerate();
        bins.extend(powers.map(|(bin, power)| (resolution * bin as f64, power)));
    }
    bins.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let total: f64 = bins.iter().map(|(_, power)| power).sum();
    let mut sum = 0.0;
    bins.into_iter().find_map(|(frequency, power)| {
        sum += power;
        (sum > share * total).then_some(frequency)
    })
}

/// The coherence of a signal with one that may drive it, `|S_xy|²/(S_xx S_yy)`.
///
/// The limit is that of as many independent segments (G. C. Carter, Coherence and time delay estimation, Proc. IEEE
/// 75, 1987); Hann windows that overlap by half are correlated by a sixth.
pub fn coherence(signal: &[f64], drive: &[f64], step: f64) -> Coherence {
    let length = longest(signal.len().min(drive.len()), AVERAGED);
    let (signal, drive) = (Segments::of(signal, length), Segments::of(drive, length));
    let (of_signal, of_drive) = (signal.density(step), drive.density(step));
    let share = (1..length / 2).map(|bin| {
        let pairs = signal.transforms.iter().zip(&drive.transforms);
        let cross: Complex<f64> = pairs.map(|(x, y)| x[bin].conj() * y[bin]).sum();
        let scale = signal.scale(step);
        let powers = of_signal[bin - 1] * of_drive[bin - 1];
        if powers > 0.0 { ((scale * cross.norm()).powi(2) / powers).min(1.0) } else { 0.0 }
    });
    let count = signal.transforms.len() as f64;
    let independent = count / (1.0 + (count - 1.0).max(0.0) / (18.0 * count.max(1.0)));
    Coherence {
        share: share.collect(),
        frequency: signal.frequency(step),
        limit: 1.0 - CHANCE.powf(1.0 / (independent - 1.0).max(1e-3)),
        drive: of_drive,
    }
}

/// The longest segment, a power of two, of which there are at least `count` in the samples.
fn longest(samples: usize, count: usize) -> usize {
    let mut length = SEGMENT;
    while length > 2 && (count + 1) * length > 2 * samples {
        length /= 2;
    }
    length
}

/// The transforms of a signal's segments behind Hann windows, each about its mean; missing samples are zero.
struct Segments {
    transforms: Vec<Vec<Complex<f64>>>,
    length: usize,
    /// Sum of the window's squares.
    window: f64,
}

impl Segments {
    fn of(signal: &[f64], length: usize) -> Self {
        let known: Vec<f64> =
            signal.iter().map(|value| if value.is_finite() { *value } else { 0.0 }).collect();
        let window: Vec<f64> =
            (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
        let fft = FftPlanner::new().plan_fft_forward(length);
        let transforms = known.windows(length).step_by((length / 2).max(1)).map(|part| {
            let mean = part.iter().sum::<f64>() / length as f64;
            let mut buffer: Vec<Complex<f64>> =
                part.iter().zip(&window).map(|(value, w)| ((value - mean) * w).into()).collect();
            fft.process(&mut buffer);
            buffer
        });
        Self { transforms: transforms.collect(), length, window: window.iter().map(|w| w * w).sum() }
    }

    /// Of every bin but that of the mean, up to half the sampling rate.
    fn frequency(&self, step: f64) -> Vec<f64> {
        (1..self.length / 2).map(|bin| bin as f64 / (self.length as f64 * step)).collect()
    }

    /// What makes a density of a sum of squares over the segments.
    fn scale(&self, step: f64) -> f64 {
        2.0 * step / (self.window * self.transforms.len().max(1) as f64)
    }

    fn density(&self, step: f64) -> Vec<f64> {
        let power = |bin: usize| self.transforms.iter().map(|it| it[bin].norm_sqr()).sum::<f64>();
        (1..self.length / 2).map(|bin| self.scale(step) * power(bin)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::white;

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn the_density_of_white_noise_is_its_variance_over_the_band() {
        let (frequency, density) = power_spectrum(&white(1, 100_000), 1e-3);
        assert_eq!(frequency.len(), density.len());
        // One-sided over 500 Hz.
        assert!((mean(&density) * 500.0 - 1.0).abs() < 0.02, "{}", mean(&density) * 500.0);
    }

    /// Of two sines of 2 and 7 Hz with three quarters and a quarter of the power, whatever the mean is.
    #[test]
    fn half_of_the_power_is_below_the_larger_sine() {
        let sines = |t: f64| 100.0 + (2.0 * TAU * t).sin() + (7.0 * TAU * t).sin() / 3.0_f64.sqrt();
        let signals = vec![(0.01, (0..1000).map(|k| sines(0.01 * f64::from(k))).collect())];
        for (share, frequency) in [(0.5, 2.0), (0.7, 2.0), (0.8, 7.0)] {
            assert!((below(&signals, share).unwrap() - frequency).abs() < 0.11, "{share}");
        }
        assert!(below(&[(0.01, vec![3.0; 50])], 0.5).is_none() && below(&[], 0.5).is_none());
    }

    /// Of y = h * x + e, the share that follows from x is that of the signal's power: SNR/(1 + SNR) at each frequency.
    #[test]
    fn coherence_is_the_share_of_what_follows_from_the_drive() {
        let (drive, noise) = (white(2, 400_000), white(3, 400_000));
        for ratio in [0.25, 1.0, 9.0_f64] {
            // A filter of two taps and a delay: at each frequency its gain is |0.6 + 0.4 e^(-iω)|.
            let answer: Vec<f64> =
                (0..drive.len()).map(|k| 0.6 * drive[k.max(7) - 7] + 0.4 * drive[k.max(8) - 8]).collect();
            let signal: Vec<f64> = answer.iter().zip(&noise).map(|(y, e)| y + e / ratio.sqrt()).collect();
            let found = coherence(&signal, &drive, 1e-3);
            for (band, share) in found.frequency.chunks(100).zip(found.share.chunks(100)) {
                let gain = |f: &f64| 0.36 + 0.16 + 0.48 * (TAU * f * 1e-3).cos();
                let expected: Vec<f64> =
                    band.iter().map(|f| gain(f) * ratio / (1.0 + gain(f) * ratio)).collect();
                let (found, expected) = (mean(share), mean(&expected));
                assert!((found - expected).abs() < 0.02, "{ratio}: {found} instead of {expected}");
            }
        }
    }

    #[test]
    fn unrelated_signals_exceed_the_limit_of_coherence_by_chance_only() {
        let (mut above, mut all) = (0, 0);
        for seed in 0..20 {
            let found = coherence(&white(seed, 5000), &white(seed + 100, 5000), 2e-3);
            above += found.share.iter().filter(|share| **share > found.limit).count();
            all += found.share.len();
        }
        let chance = f64::from(above as u32) / f64::from(all as u32);
        assert!((0.03..0.08).contains(&chance), "{chance}");
    }

    #[test]
    fn signals_of_a_few_samples_have_spectra_without_surprises() {
        for count in 0..20 {
            let signal = white(1, count);
            let (frequency, density) = power_spectrum(&signal, 1e-3);
            assert_eq!(frequency.len(), density.len());
            let found = coherence(&signal, &signal, 1e-3);
            assert!(found.share.iter().all(|share| share.is_finite()) && found.limit <= 1.0);
        }
    }
}
