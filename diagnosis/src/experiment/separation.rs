//! How far apart two models are by what sensors can show: pure functions of numbers.
//!
//! An experiment decides between rival models as far as the predictions of the wrong one, its parameters fitted, miss those of
//! the right one: W. G. Hunter, A. M. Reiner, Designs for discriminating between two rival models, Technometrics 7 (1965);
//! A. C. Atkinson, V. V. Fedorov, The design of experiments for discriminating between two rival models, Biometrika 62 (1975)
//! (T-optimality).

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::decision::criteria::CRITERIA;

/// Growth of the error power from which one model is told from another: below, the diagnosis calls both as good.
pub const EXCESS: f64 = CRITERIA.same - 1.0;

/// Distance d' that a probability of a right decision needs: Φ(d'/2).
fn needed(probability: f64) -> f64 {
    2.0 * Normal::standard().inverse_cdf(probability)
}

/// How far the predictions of a wrong model are from those of the right one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Separation {
    /// Distance in standard deviations of what sensors and the model leave: d'.
    pub distance: f64,
    /// By how much the wrong model's error power exceeds the right one's, as a share.
    pub excess: f64,
}

impl Separation {
    /// From the weighted sum of squares of the difference and the number of independent samples in it. More samples than those
    /// with which [`EXCESS`] just decides are no further evidence: no model is so right that its errors are all chance.
    pub fn of(squares: f64, independent: f64) -> Self {
        let excess = squares.max(0.0) / independent.max(1.0);
        let believed = needed(CRITERIA.decides).powi(2) / EXCESS;
        Self { distance: (excess * independent.clamp(1.0, believed)).sqrt(), excess }
    }

    /// Probability that the likelier model is the right one: Φ(d'/2).
    pub fn probability(self) -> f64 {
        Normal::standard().cdf(0.5 * self.distance)
    }

    /// Whether it is enough to decide.
    pub fn decides(self) -> bool {
        self.probability() >= CRITERIA.decides
    }

    /// The smaller one.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        if other.distance < self.distance { other } else { self }
    }
}

/// Standard deviation of a signal's errors as if its samples were independent: errors with a memory count as fewer samples.
pub fn level(rms: f64, samples: f64, independent: f64) -> f64 {
    rms * (samples / independent.clamp(1.0, samples.max(1.0))).max(1.0).sqrt()
}

/// Weighted sum of squares of signals, each in its own level; what is not known does not count.
pub fn squares<'a>(signals: impl Iterator<Item = (&'a [f64], f64)>) -> f64 {
    let of = |(signal, level): (&[f64], f64)| {
        signal.iter().filter(|it| it.is_finite()).map(|it| (it / level).powi(2)).sum::<f64>()
    };
    signals.map(of).sum()
}

/// Sum of squares of a difference beyond what a model can follow by its own parameters: from the products of the parameters'
/// columns `h`, the spread of what was known of them included, of the columns with the difference, and of the difference with
/// itself. A parameter that nothing depends on follows nothing.
pub fn beyond(h: &DMatrix<f64>, cross: &DVector<f64>, square: f64) -> f64 {
    // In units of each column's norm, and of its best-known combinations only: what is left of the others is rounding.
    let scale =
        DVector::from_fn(cross.len(), |i, _| if h[(i, i)] > 0.0 { h[(i, i)].sqrt().recip() } else { 0.0 });
    let scaled = DMatrix::from_fn(cross.len(), cross.len(), |i, j| scale[i] * h[(i, j)] * scale[j]);
    let cross = cross.component_mul(&scale);
    let eigen = scaled.symmetric_eigen();
    let along = |(value, vector): (&f64, _)| -> f64 {
        let vector: nalgebra::DVectorView<'_, f64> = vector;
        if *value > DETERMINED { vector.dot(&cross).powi(2) / value } else { 0.0 }
    };
    let followed: f64 = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()).map(along).sum();
    (square - followed).clamp(0.0, square.max(0.0))
}

/// Share of a column's own square below which a combination of columns is nothing but rounding.
const DETERMINED: f64 = 1e-10;

/// The rank of an experiment by its separations, one for each rival: the more rivals it separates the better, and then the
/// larger the product of the distances (compound T-optimality, which is free of scale).
pub fn rank(separations: &[Separation]) -> (usize, f64) {
    let decided = separations.iter().filter(|it| it.decides()).count();
    let logarithms = separations.iter().map(|it| it.distance.max(f64::MIN_POSITIVE).ln());
    (decided, logarithms.sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn products(columns: &[Vec<f64>], difference: &[f64], prior: f64) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let n = columns.len();
        let h =
            DMatrix::from_fn(n, n, |i, j| dot(&columns[i], &columns[j]) + if i == j { prior } else { 0.0 });
        let cross = DVector::from_fn(n, |i, _| dot(&columns[i], difference));
        beyond(&h, &cross, dot(difference, difference))
    }

    #[test]
    fn a_distance_becomes_a_probability() {
        let of = |distance: f64| Separation { distance, excess: 1.0 };
        assert!((of(0.0).probability() - 0.5).abs() < 1e-12);
        assert!((of(3.29).probability() - 0.95).abs() < 1e-3);
        assert!(of(3.3).decides() && !of(3.2).decides());
        assert_eq!(Separation::of(25.0, 100.0), Separation { distance: 5.0, excess: 0.25 });
        // However many samples: an error power that is hardly larger tells nothing.
        for samples in [1e4, 1e6, 1e8] {
            assert!(!Separation::of(0.99 * EXCESS * samples, samples).decides());
            assert!(Separation::of(1.01 * EXCESS * samples, samples).decides());
        }
    }

    #[test]
    fn errors_with_a_memory_count_as_fewer_samples() {
        assert_eq!(level(2.0, 1000.0, 1000.0), 2.0);
        assert_eq!(level(2.0, 1000.0, 250.0), 4.0);
        assert_eq!(level(2.0, 1000.0, 4000.0), 2.0);
        let unknown = [3.0, f64::NAN, 4.0];
        assert_eq!(squares([(&unknown[..], 1.0), (&unknown[..], 5.0)].into_iter()), 26.0);
    }

    #[test]
    fn the_more_rivals_are_separated_the_better() {
        let of = |distances: [f64; 2]| rank(&distances.map(|distance| Separation { distance, excess: 1.0 }));
        assert!(of([4.0, 4.0]) > of([0.1, 400.0]));
        assert!(of([0.1, 20.0]) > of([0.3, 4.0]));
        assert!(of([0.0, 5.0]) > of([0.0, 4.0]));
    }

    proptest! {
        #[test]
        fn parameters_follow_what_they_can_and_no_more(
            columns in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 12), 1..4),
            difference in prop::collection::vec(-1.0..1.0_f64, 12),
            amounts in prop::collection::vec(-3.0..3.0_f64, 3),
        ) {
            let square: f64 = difference.iter().map(|it| it * it).sum();
            let left = products(&columns, &difference, 0.0);
            prop_assert!(left >= 0.0 && left <= square + 1e-12);
            // A change of the parameters is no difference.
            let moved: Vec<f64> = (0..12)
                .map(|k| difference[k] + columns.iter().zip(&amounts).map(|(it, a)| a * it[k]).sum::<f64>())
                .collect();
            prop_assert!((products(&columns, &moved, 0.0) - left).abs() < 1e-6 * (1.0 + square));
            // The same column twice follows no more than once.
            let twice: Vec<Vec<f64>> = columns.iter().chain(&columns[..1]).cloned().collect();
            prop_assert!((products(&twice, &difference, 0.0) - left).abs() < 1e-6);
            // What is known of the parameters holds them.
            prop_assert!(products(&columns, &difference, 1e12) >= square * (1.0 - 1e-6));
            prop_assert!(products(&columns, &difference, 0.1) >= left - 1e-9);
        }

        #[test]
        fn a_larger_distance_is_never_less_sure(a in 0.0..20.0_f64, b in 0.0..20.0_f64) {
            let [one, two] = [a, b].map(|distance| Separation { distance, excess: 1.0 });
            prop_assert!(a > b || one.probability() <= two.probability());
            prop_assert_eq!(one.min(two).distance, a.min(b));
        }
    }
}
