//! One of several samples of a signal, behind a filter without phase.

use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::rc::Rc;

use super::KEPT;

/// Share of the kept band that passes as it is.
const FLAT: f64 = 0.75;
/// Reach of the filter to each side in samples that are left: with this edge and this [`SHAPE`], what is stopped is 60 dB down.
const REACH: usize = 18;
/// Shape of Kaiser's window (J. F. Kaiser, Nonrecursive digital filter design using the I0-sinh window function, IEEE ISCAS 1974).
const SHAPE: f64 = 5.65;
/// Products that are summed beside each other.
const LANES: usize = 8;

thread_local! {
    /// Outputs of a model are filtered in every step of a fit: the weights of a factor are made once.
    static WEIGHTS: RefCell<HashMap<usize, Rc<[f64]>>> = RefCell::default();
}

/// One of `factor` samples of a signal, the first one among them. Of half the new rate, [`KEPT`] passes, its last quarter more and more
/// weakly. Beyond its ends, the signal is continued by its reflection, which is a guess: it counts within a few new samples of an end.
pub fn decimated(values: &[f64], factor: usize) -> Vec<f64> {
    let n = values.len();
    if factor == 1 || n < 2 {
        return values.iter().step_by(factor).copied().collect();
    }
    let weights = WEIGHTS.with_borrow_mut(|all| all.entry(factor).or_insert_with(|| weights(factor)).clone());
    let reach = REACH * factor;
    let longer = reflected(values, reach, weights.len());
    let starts = (0..n).step_by(factor);
    starts.map(|start| product(&longer[start..start + weights.len()], &weights)).collect()
}

/// Root mean square of decimated white noise whose own is one.
pub fn left_of_noise(factor: usize) -> f64 {
    if factor == 1 { 1.0 } else { weights(factor).iter().map(|it| it * it).sum::<f64>().sqrt() }
}

/// A signal that is continued by `reach` samples before its first one, and behind its last one as far as the filter for that one
/// reaches: reflected at its ends about the line through them, as often as necessary.
fn reflected(values: &[f64], reach: usize, weights: usize) -> Vec<f64> {
    let last = values.len() - 1;
    let slope = (values[last] - values[0]) / last as f64;
    let at = |place: isize| -> f64 {
        let folded = place.rem_euclid(2 * last as isize) as usize;
        let (inside, sign) = if folded > last { (2 * last - folded, -1.0) } else { (folded, 1.0) };
        values[0] + slope * place as f64 + sign * (values[inside] - values[0] - slope * inside as f64)
    };
    let before = (1..=reach as isize).rev().map(|place| at(-place));
    let behind = (1..=(weights - reach) as isize).map(|place| at(last as isize + place));
    before.chain(values.iter().copied()).chain(behind).collect()
}

/// The filter's weights for the sample in the middle and `REACH · factor` to each side, with zeros behind them.
fn weights(factor: usize) -> Rc<[f64]> {
    let reach = (REACH * factor) as f64;
    // In cycles a sample, in the middle of the edge.
    let end = 0.5 * KEPT * (0.5 + 0.5 * FLAT) / factor as f64;
    let weight = |from_middle: f64| {
        let angle = 2.0 * PI * end * from_middle;
        let sinc = if angle == 0.0 { 1.0 } else { angle.sin() / angle };
        sinc * bessel(SHAPE * (1.0 - (from_middle / reach).powi(2)).max(0.0).sqrt())
    };
    let mut all: Vec<f64> = (0..=2 * REACH * factor).map(|k| weight(k as f64 - reach)).collect();
    let sum: f64 = all.iter().sum();
    all.iter_mut().for_each(|it| *it /= sum);
    all.resize(all.len().next_multiple_of(LANES), 0.0);
    all.into()
}

/// The modified Bessel function of the first kind and order 0, by its series.
fn bessel(x: f64) -> f64 {
    let terms = (1..40).scan(1.0, |term, k| {
        *term *= (0.5 * x / f64::from(k)).powi(2);
        Some(*term)
    });
    1.0 + terms.sum::<f64>()
}

/// The sum of products of two lists whose length is a multiple of [`LANES`].
fn product(signal: &[f64], weights: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (signal, weights) in signal.chunks_exact(LANES).zip(weights.chunks_exact(LANES)) {
        for ((sum, value), weight) in sums.iter_mut().zip(signal).zip(weights) {
            *sum += value * weight;
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use proptest::prelude::*;

    const STEP: f64 = 1e-3;

    fn sampled(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..6000).map(|k| of(k as f64 * STEP)).collect()
    }

    /// The mean square about a line of slope −1; half the new rate is 50 Hz.
    fn kept(signal: &[f64]) -> f64 {
        let found = decimated(signal, 10);
        assert_eq!(found.len(), 600);
        (50..550).map(|k| (found[k] - (1.0 - 0.01 * k as f64)).powi(2)).sum::<f64>() / 500.0
    }

    #[test]
    fn of_a_decimated_signal_the_band_is_left() {
        let of = |hertz: f64| kept(&sampled(move |t| 1.0 - t + (TAU * hertz * t).sin()));
        for slow in [5.0, 20.0, 29.0] {
            assert!((of(slow) - 0.5).abs() < 2e-3, "{slow}: {}", of(slow));
        }
        for fast in [41.0, 57.0, 120.0, 333.0] {
            assert!(of(fast) < 1e-6, "{fast}: {}", of(fast));
        }
        // Half of the amplitude in the middle of the edge.
        assert!((of(35.0) - 0.125).abs() < 0.01, "{}", of(35.0));
    }

    #[test]
    fn short_signals_have_samples_too() {
        assert_eq!(decimated(&[1.0, 2.0, 4.0], 1), [1.0, 2.0, 4.0]);
        assert_eq!((decimated(&[3.0], 4), decimated(&[], 4)), (vec![3.0], vec![]));
        assert_eq!(decimated(&[1.0, 2.0], 4).len(), 1);
    }

    #[test]
    fn of_white_noise_the_band_is_left() {
        let white: Vec<f64> = sampled(|t| (1e9 * (t * 1e5).sin()).sin());
        let rms = |all: &[f64]| (all.iter().map(|it| it * it).sum::<f64>() / all.len() as f64).sqrt();
        let ratio = rms(&decimated(&white, 4)) / rms(&white);
        assert!((ratio / left_of_noise(4) - 1.0).abs() < 0.1, "{ratio} {}", left_of_noise(4));
        assert!((left_of_noise(4) / (0.7_f64 / 4.0).sqrt() - 1.0).abs() < 0.05 && left_of_noise(1) == 1.0);
    }

    proptest! {
        #[test]
        fn a_straight_line_stays_one(from in -5.0..5.0_f64, slope in -2.0..2.0_f64, count in 2..90_usize, factor in 2..9_usize) {
            let values: Vec<f64> = (0..count).map(|k| from + slope * k as f64).collect();
            for (found, value) in decimated(&values, factor).iter().zip(values.iter().step_by(factor)) {
                prop_assert!((found - value).abs() < 1e-9);
            }
        }
    }
}
