//! A signal between its samples.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector};

use super::KEPT;

/// Samples of a refined signal for each of the original's.
pub const FINER: usize = 4;
/// Samples to each side that say what is between two.
const REACH: usize = 10;
/// The weights of the samples around, for each place between two.
static WEIGHTS: LazyLock<[[f64; 2 * REACH]; FINER - 1]> =
    LazyLock::new(|| std::array::from_fn(|place| weights((place + 1) as f64 / FINER as f64)));

/// [`FINER`] times as many samples of a signal, up to its last one. Beyond its ends it is taken to go on as it is before them,
/// reflected.
pub fn refined(signal: &[f64]) -> Vec<f64> {
    let Some(&last) = signal.last() else { return Vec::new() };
    let end = signal.len() - 1;
    let reflected = |about: usize, distance: usize| {
        let other = if about == 0 { distance.min(end) } else { end.saturating_sub(distance) };
        2.0 * signal[about] - signal[other]
    };
    let before = (1..REACH).rev().map(|distance| reflected(0, distance));
    let after = (1..=REACH).map(|distance| reflected(end, distance));
    let longer: Vec<f64> = before.chain(signal.iter().copied()).chain(after).collect();
    let mut fine = Vec::with_capacity(FINER * end + 1);
    let places: &[_; FINER - 1] = &WEIGHTS;
    for (value, around) in signal.iter().zip(longer.windows(2 * REACH)).take(end) {
        // A weight of every place at a time: sums that do not wait for one another.
        let mut sums = [0.0; FINER - 1];
        for (index, near) in around.iter().enumerate() {
            for (sum, weights) in sums.iter_mut().zip(places) {
                *sum += near * weights[index];
            }
        }
        fine.push(*value);
        fine.extend(sums);
    }
    fine.push(last);
    fine
}

/// The weights with the least mean square error of a signal that is white within the band that is kept, among those that are
/// exact for straight lines; at a share of the way between the two samples in the middle.
fn weights(share: f64) -> [f64; 2 * REACH] {
    let count = 2 * REACH;
    let at = |index: usize| index as f64 - (REACH - 1) as f64;
    // What samples so far apart have in common.
    let common =
        |apart: f64| if apart == 0.0 { 1.0 } else { (KEPT * PI * apart).sin() / (KEPT * PI * apart) };
    let conditions = |index: usize| [1.0, at(index)];
    let matrix = DMatrix::from_fn(count + 2, count + 2, |i, j| match (i < count, j < count) {
        (true, true) => common(at(i) - at(j)),
        (true, false) => conditions(i)[j - count],
        (false, true) => conditions(j)[i - count],
        (false, false) => 0.0,
    });
    let wanted = DVector::from_fn(count + 2, |i, _| match i.checked_sub(count) {
        None => common(share - at(i)),
        Some(0) => 1.0,
        Some(_) => share,
    });
    let solved = matrix.lu().solve(&wanted).expect("samples are no multiples of each other");
    std::array::from_fn(|index| solved[index])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Up to three quarters of the band to 0.1 %, in the middle between samples where a cubic has lost two fifths.
        #[test]
        fn a_sine_below_its_band_is_followed(frequency in 0.0..0.3_f64, phase in 0.0..6.3_f64) {
            let sine = |t: f64| (std::f64::consts::TAU * frequency * t + phase).sin();
            let fine = refined(&(0..60).map(f64::from).map(sine).collect::<Vec<_>>());
            prop_assert_eq!(fine.len(), 59 * FINER + 1);
            for (k, value) in fine.iter().enumerate().take(48 * FINER).skip(12 * FINER) {
                prop_assert!((value - sine(k as f64 / FINER as f64)).abs() < 1e-3);
            }
        }

        #[test]
        fn a_straight_line_stays_one_to_its_ends(
            from in -5.0..5.0_f64, slope in -2.0..2.0_f64, count in REACH + 1..40_usize,
        ) {
            let line = |k: f64| from + slope * k;
            let fine = refined(&(0..count).map(|k| line(k as f64)).collect::<Vec<_>>());
            prop_assert_eq!(fine.len(), (count - 1) * FINER + 1);
            for (k, value) in fine.iter().enumerate() {
                prop_assert!((value - line(k as f64 / FINER as f64)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn samples_stay_what_they_are() {
        let signal = [1.0, -2.0, 5.0, 0.5];
        assert_eq!(refined(&signal).into_iter().step_by(FINER).collect::<Vec<_>>(), signal);
        assert!(refined(&[]).is_empty());
        assert_eq!(refined(&[3.0]), [3.0]);
    }
}
