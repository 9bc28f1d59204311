//! The cumulative periodogram: whether a signal is white.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// A signal's share of power up to each frequency.
#[derive(Clone, Debug)]
pub struct Cumulative {
    /// In hertz.
    pub frequency: Vec<f64>,
    /// Share of the power up to there, 0 to 1.
    pub share: Vec<f64>,
    /// How far white noise strays from the straight line in 95 % of all cases.
    pub limit: f64,
    /// How far the signal strays from it at most.
    pub distance: f64,
}

/// The normalised cumulative periodogram up to a frequency, about the mean; missing samples are zero. White noise stays
/// along the straight line, by Kolmogorov and Smirnov's statistic (M. S. Bartlett, An introduction to stochastic
/// processes, 1955; the factor for few frequencies is that of M. A. Stephens, J. R. Stat. Soc. B 32, 1970).
pub fn cumulative_periodogram(signal: &[f64], step: f64, top: f64) -> Cumulative {
    let known: Vec<f64> = signal.iter().copied().filter(|value| value.is_finite()).collect();
    let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let mut buffer: Vec<Complex<f64>> = signal
        .iter()
        .map(|value| if value.is_finite() { (value - mean).into() } else { 0.0.into() })
        .collect();
    FftPlanner::new().plan_fft_forward(buffer.len()).process(&mut buffer);
    let width = 1.0 / (buffer.len().max(1) as f64 * step);
    let count = ((top / width) as usize).min(buffer.len().saturating_sub(1) / 2);
    let mut sum = 0.0;
    let mut share: Vec<f64> = (1..=count)
        .map(|bin| {
            sum += buffer[bin].norm_sqr();
            sum
        })
        .collect();
    share.iter_mut().for_each(|it| *it /= if sum > 0.0 { sum } else { 1.0 });
    let line = |index: usize| (index + 1) as f64 / count as f64;
    let root = (count.saturating_sub(1) as f64).sqrt();
    Cumulative {
        frequency: (1..=count).map(|bin| bin as f64 * width).collect(),
        limit: 1.358 / (root + 0.12 + 0.11 / root.max(1.0)),
        distance: share.iter().enumerate().map(|(k, it)| (it - line(k)).abs()).fold(0.0, f64::max),
        share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::white;

    #[test]
    fn white_noise_stays_within_the_band_in_all_but_some_cases() {
        let strays = (0..200)
            .filter(|seed| {
                let found = cumulative_periodogram(&white(*seed, 2000), 1e-3, 400.0);
                assert_eq!(found.share.len(), 800);
                assert!((found.share[799] - 1.0).abs() < 1e-12);
                found.distance > found.limit
            })
            .count();
        // 5 % of 200, by three standard deviations.
        assert!((1..=19).contains(&strays), "{strays}");
    }

    #[test]
    fn a_sine_jumps_at_its_frequency() {
        let sine = |k: usize| (std::f64::consts::TAU * 50.0 * k as f64 * 1e-3).sin();
        let signal: Vec<f64> = white(1, 4000).iter().enumerate().map(|(k, e)| e + 2.0 * sine(k)).collect();
        let found = cumulative_periodogram(&signal, 1e-3, 500.0);
        let at = |f: f64| found.share[found.frequency.partition_point(|it| *it < f)];
        // Two thirds of the power are the sine's.
        assert!((at(51.0) - at(49.0) - 2.0 / 3.0).abs() < 0.03, "{} {}", at(49.0), at(51.0));
        assert!(found.distance > 10.0 * found.limit, "{} {}", found.distance, found.limit);
    }

    #[test]
    fn nothing_and_constants_have_no_power() {
        for signal in [vec![], vec![3.0; 1], vec![3.0; 50], vec![f64::NAN; 50]] {
            let found = cumulative_periodogram(&signal, 1e-3, 500.0);
            assert!(found.share.iter().all(|share| share.abs() < 1e-9) && found.limit.is_finite());
        }
    }
}
