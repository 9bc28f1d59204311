//! Filters without phase, over a whole signal.

use std::cell::RefCell;
use std::f64::consts::{PI, TAU};

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// The straight line through a signal's ends.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    first: f64,
    /// Per sample.
    slope: f64,
}

impl Line {
    /// Its value at a sample.
    pub fn at(&self, sample: usize) -> f64 {
        self.first + self.slope * sample as f64
    }
}

thread_local! {
    /// The rate of a delayed motion is taken in every step of a fit: the plan of a length is made once.
    static PLANNER: RefCell<FftPlanner<f64>> = RefCell::new(FftPlanner::new());
}

/// Chooses the gain of each bin of a spectrum.
pub type Gains<'a> = &'a mut dyn FnMut(&[Complex<f64>]) -> Vec<Complex<f64>>;

/// The line through a signal's ends, and the deviation from it with each bin of its spectrum multiplied by a gain.
///
/// The deviation is reflected about the ends, so that it neither jumps nor bends there when it is taken as periodic.
///
/// # Panics
/// If there are fewer than two samples.
pub fn about_line(values: &[f64], gains: Gains<'_>) -> (Line, Vec<f64>) {
    let n = values.len();
    let line = Line { first: values[0], slope: (values[n - 1] - values[0]) / (n - 1) as f64 };
    let mut buffer: Vec<Complex<f64>> = Vec::with_capacity(2 * n - 2);
    buffer.extend(values.iter().enumerate().map(|(k, value)| Complex::from(value - line.at(k))));
    for k in (1..n - 1).rev() {
        buffer.push(-buffer[k]);
    }
    let len = buffer.len();
    let (forward, inverse) =
        PLANNER.with_borrow_mut(|it| (it.plan_fft_forward(len), it.plan_fft_inverse(len)));
    forward.process(&mut buffer);
    let gains = gains(&buffer);
    for (bin, gain) in buffer.iter_mut().zip(gains) {
        *bin *= gain / len as f64;
    }
    inverse.process(&mut buffer);
    (line, buffer[..n].iter().map(|bin| bin.re).collect())
}

/// A derivative of a signal below a frequency `top` in hertz; the signal itself for order 0. At `top`, half of the
/// amplitude passes; a fifth beyond, nothing.
pub fn in_band(values: &[f64], step: f64, top: f64, order: i32) -> Vec<f64> {
    if values.len() < 2 {
        return vec![0.0; values.len()];
    }
    let (line, deviation) = about_line(values, &mut |spectrum| {
        let len = spectrum.len();
        let gain = |bin: usize| {
            let bin = if 2 * bin > len { bin as f64 - len as f64 } else { bin as f64 };
            let frequency = bin / (len as f64 * step);
            let place = (frequency.abs() / top - 0.8) / 0.4;
            Complex::new(0.0, TAU * frequency).powi(order) * (0.5 + 0.5 * (PI * place.clamp(0.0, 1.0)).cos())
        };
        (0..len).map(gain).collect()
    });
    let add = |(k, value): (usize, f64)| match order {
        0 => value + line.at(k),
        1 => value + line.slope / step,
        _ => value,
    };
    deviation.into_iter().enumerate().map(add).collect()
}

/// A signal with straight lines where samples are missing, its ends held; none if no sample is there.
pub fn filled(values: &[f64]) -> Option<Vec<f64>> {
    let known: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_finite()).collect();
    let (first, last) = (*known.first()?, *known.last()?);
    let mut filled = values.to_vec();
    filled[..first].fill(values[first]);
    filled[last..].fill(values[last]);
    for pair in known.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let line =
            |step: usize| values[from] + (step + 1) as f64 / (to - from) as f64 * (values[to] - values[from]);
        filled[from + 1..to].iter_mut().enumerate().for_each(|(step, value)| *value = line(step));
    }
    Some(filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-3;

    fn sampled(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..6000).map(|k| of(k as f64 * STEP)).collect()
    }

    #[test]
    fn derivatives_of_what_lies_in_the_band_are_exact_away_from_the_ends() {
        let signal = sampled(|t| 0.3 + 2.0 * t + (40.0 * t).sin());
        let expected: [fn(f64) -> f64; 3] = [
            |t| 0.3 + 2.0 * t + (40.0 * t).sin(),
            |t| 2.0 + 40.0 * (40.0 * t).cos(),
            |t| -1600.0 * (40.0 * t).sin(),
        ];
        for (order, expected) in expected.iter().enumerate() {
            let found = in_band(&signal, STEP, 25.0, order as i32);
            let scale = 40.0_f64.powi(order as i32);
            for (k, found) in found.iter().enumerate().take(5000).skip(1000) {
                let expected = expected(k as f64 * STEP);
                assert!((found - expected).abs() < 2e-2 * scale, "{order} {k}: {found} {expected}");
            }
        }
    }

    #[test]
    fn what_lies_beyond_the_band_is_gone() {
        let found = in_band(&sampled(|t| (TAU * 40.0 * t).sin()), STEP, 25.0, 2);
        let largest = found[500..5500].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(largest < 1e-3 * (TAU * 40.0_f64).powi(2), "{largest}");
    }

    #[test]
    fn gaps_are_bridged() {
        let nan = f64::NAN;
        assert_eq!(filled(&[nan, 1.0, nan, nan, 4.0, nan]).unwrap(), [1.0, 1.0, 2.0, 3.0, 4.0, 4.0]);
        assert_eq!(filled(&[nan, nan]), None);
    }
}
