//! A frequency that holds much of a signal's power.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Share of a signal's power that its line has to hold.
const LINE: f64 = 0.4;
/// Bins to both sides of a line that belong to it.
const WIDTH: usize = 3;
/// Periods in the longest signal from which it is a line: what drifts has most of its power in the lowest bins.
const PERIODS: usize = 4 * WIDTH;

/// The frequency in Hz at which signals have most of their power, each of them and all together, if it is a line. Each has its step
/// in seconds, all the same, and its samples.
pub fn line(signals: &[(f64, Vec<f64>)]) -> Option<f64> {
    let (step, _) = signals.first()?;
    let longest = signals.iter().map(|(_, values)| values.len()).max()?;
    let resolution = 1.0 / (step * longest as f64);
    let powers: Vec<Vec<f64>> = signals.iter().map(|(_, values)| power(values, longest)).collect();
    let all = |bin: usize| powers.iter().map(|power| power[bin]).sum::<f64>();
    let best = (1..longest / 2).max_by(|a, b| all(*a).total_cmp(&all(*b)))?;
    let near = best.saturating_sub(WIDTH)..(best + WIDTH + 1).min(longest / 2);
    // Another excitation has its power elsewhere; what is periodic by itself does not.
    let is_line =
        |power: &Vec<f64>| power[near.clone()].iter().sum::<f64>() > LINE * power.iter().sum::<f64>();
    (best >= PERIODS && powers.iter().all(is_line)).then_some(best as f64 * resolution)
}

/// Power of each bin of a signal's spectrum, its mean aside; zeros follow it up to a number of samples.
fn power(values: &[f64], length: usize) -> Vec<f64> {
    let mut bins: Vec<Complex<f64>> = values.iter().map(|it| Complex::from(*it)).collect();
    bins.resize(length, Complex::from(0.0));
    FftPlanner::new().plan_fft_forward(length).process(&mut bins);
    let mut power: Vec<f64> = bins[..length / 2].iter().map(Complex::norm_sqr).collect();
    if let Some(mean) = power.first_mut() {
        *mean = 0.0;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(of: impl Fn(f64) -> f64) -> Vec<(f64, Vec<f64>)> {
        vec![(0.01, (0..1000).map(|k| of(0.01 * f64::from(k))).collect())]
    }

    #[test]
    fn a_sine_is_a_line_and_pulses_and_drifts_are_none() {
        let sine = signal(|t| (2.0 * std::f64::consts::PI * 7.3 * t + 1.0).sin());
        assert!((line(&sine).unwrap() - 7.3).abs() < 0.1);
        assert!(line(&signal(|t| if t.fract() < 0.05 { 1.0 } else { 0.0 })).is_none());
        // A drift has few bins, and another record may have none of the line.
        assert!(line(&signal(|t| (0.2 * t).cos())).is_none());
        let both = [sine, signal(|t| (2.0 * std::f64::consts::PI * 2.9 * t).sin())].concat();
        assert!(line(&both).is_none() && line(&both[..1]).is_some());
    }
}
