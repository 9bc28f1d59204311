//! Values between samples.

/// The value at a time by linear interpolation; NaN outside of the times, or where a neighbour is missing.
/// The times have to increase.
pub(crate) fn linear(time: &[f64], values: &[f64], at: f64) -> f64 {
    let after = time.partition_point(|&t| t < at);
    match (after.checked_sub(1), time.get(after)) {
        (_, Some(&t)) if t == at => values[after],
        (Some(before), Some(&t)) => {
            let share = (at - time[before]) / (t - time[before]);
            values[before] + share * (values[after] - values[before])
        }
        _ => f64::NAN,
    }
}

/// The value at a time by monotone cubic interpolation: it never leaves the range of the two neighbours.
/// Slopes by Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300. Otherwise as [`linear`].
pub(crate) fn cubic(time: &[f64], values: &[f64], at: f64) -> f64 {
    let after = time.partition_point(|&t| t < at);
    let (Some(before), Some(&t)) = (after.checked_sub(1), time.get(after)) else {
        return linear(time, values, at);
    };
    let width = t - time[before];
    let share = (at - time[before]) / width;
    let (low, high) = (slope(time, values, before), slope(time, values, after));
    let (y0, y1) = (values[before], values[after]);
    let secant = (y1 - y0) / width;
    // Hermite's form, written as the straight line and what bends it.
    let bend = (1.0 - share) * (low - secant) - share * (high - secant);
    y0 + share * (y1 - y0) + width * share * (1.0 - share) * bend
}

/// Slope at a sample: the weighted harmonic mean of the slopes beside it; 0 at an extreme value.
fn slope(time: &[f64], values: &[f64], i: usize) -> f64 {
    let secant = |i: usize| (values[i + 1] - values[i]) / (time[i + 1] - time[i]);
    let before = i.checked_sub(1).map(secant).filter(|s| s.is_finite());
    let after = (i + 1 < time.len()).then(|| secant(i)).filter(|s| s.is_finite());
    match (before, after) {
        (Some(a), Some(b)) if a * b > 0.0 => {
            let (h0, h1) = (time[i] - time[i - 1], time[i + 1] - time[i]);
            let weight = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
            a * b / (weight * b + (1.0 - weight) * a)
        }
        (Some(_), Some(_)) | (None, None) => 0.0,
        (Some(only), None) | (None, Some(only)) => only,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn between_samples_and_outside() {
        let (time, values) = ([0.0, 1.0, 3.0], [0.0, 2.0, -2.0]);
        assert_eq!(linear(&time, &values, 0.5), 1.0);
        assert_eq!(linear(&time, &values, 2.0), 0.0);
        assert_eq!(linear(&time, &values, 3.0), -2.0);
        assert!(linear(&time, &values, 3.1).is_nan() && linear(&time, &values, -0.1).is_nan());
        assert!(linear(&time, &[0.0, f64::NAN, 1.0], 0.5).is_nan());
        assert!(linear(&[], &[], 0.0).is_nan());
    }

    #[test]
    fn the_cubic_is_better_than_a_line_on_a_sine() {
        let time: Vec<f64> = (0..100).map(|i| f64::from(i) + 0.3 * f64::from(i % 3)).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.3 * t).sin()).collect();
        let rms = |f: fn(&[f64], &[f64], f64) -> f64| {
            (50..900)
                .map(|i| 0.1 * f64::from(i))
                .map(|t| (f(&time, &values, t) - (0.3 * t).sin()).powi(2))
                .sum::<f64>()
        };
        assert!(rms(cubic) < 0.3 * rms(linear), "{} {}", rms(cubic), rms(linear));
    }

    proptest! {
        #[test]
        fn the_cubic_stays_between_its_neighbours(
            steps in prop::collection::vec((0.1..2.0_f64, -9.0..9.0_f64), 3..20), share in 0.0..1.0_f64
        ) {
            let mut now = 0.0;
            let time: Vec<f64> = steps.iter().map(|s| { now += s.0; now }).collect();
            let values: Vec<f64> = steps.iter().map(|s| s.1).collect();
            let at = time[0] + share * (now - time[0]);
            let i = time.partition_point(|&t| t < at).clamp(1, time.len() - 1);
            let (low, high) = (values[i - 1].min(values[i]), values[i - 1].max(values[i]));
            let found = cubic(&time, &values, at);
            prop_assert!(found >= low - 1e-9 && found <= high + 1e-9);
        }
    }
}
