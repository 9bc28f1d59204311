//! How many effects are compared: of a hundred, the best gains steadily by chance alone now and then.
//!
//! Effects that resemble one another are no further looks at the errors. So the comparison is repeated with errors that contain
//! none of them: what each block of time adds to each effect's gain, about its mean, with a random sign and size (multiplier
//! bootstrap; V. Chernozhukov, D. Chetverikov and K. Kato, Gaussian approximations and multiplier bootstrap for maxima of sums
//! of high-dimensional random vectors, Annals of Statistics 41, 2013).

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, Normal as Gaussian};

use crate::estimation::fit::contained;
use crate::estimation::hypothesis::Fitted;
use crate::signal::random::Random;

use super::TriedOut;

/// Chance that the best of all looks as steady where there is none, at which looks are counted.
const LEVEL: f64 = 0.01;
/// Repetitions.
const REPEATED: usize = 2000;
/// Seed of the multipliers.
const SEED: u64 = 41;

impl TriedOut {
    /// Number of independent looks at a fit's errors that comparing every effect to them amounts to.
    pub fn looks(&self, fitted: &Fitted) -> f64 {
        let scores = contained(&self.normal, fitted.coordinates.len()).scores;
        looks(&scores, self.probes.iter().flat_map(|(_, columns)| columns.clone()))
    }
}

/// Number of independent looks of which the best is as large as that at some columns of blocks' scores.
fn looks(scores: &[DVector<f64>], columns: impl Iterator<Item = usize>) -> f64 {
    let unit = |column: usize| -> Option<DVector<f64>> {
        let blocks = DVector::from_iterator(scores.len(), scores.iter().map(|score| score[column]));
        let about = blocks.add_scalar(-blocks.mean());
        let size = about.norm();
        (size > 0.0 && size.is_finite()).then(|| about / size)
    };
    let columns: Vec<DVector<f64>> = columns.filter_map(unit).collect();
    if columns.is_empty() {
        return 1.0;
    }
    let columns = DMatrix::from_columns(&columns);
    let mut random = Random::new(SEED);
    let mut best: Vec<f64> = (0..REPEATED)
        .map(|_| columns.tr_mul(&DVector::from_fn(scores.len(), |_, _| random.normal())).amax())
        .collect();
    best.sort_by(f64::total_cmp);
    let largest = best[REPEATED - (LEVEL * REPEATED as f64) as usize];
    (LEVEL / (2.0 * Gaussian::standard().sf(largest))).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::random::white;

    /// Blocks' scores of so many columns, each of them so many times.
    fn scores(blocks: usize, columns: usize, times: usize) -> Vec<DVector<f64>> {
        let white = white(3, blocks * columns);
        let score = |block: usize| {
            let own =
                (0..columns).flat_map(|column| std::iter::repeat_n(white[block * columns + column], times));
            // How large an effect is and that it is there does not matter.
            DVector::from_iterator(
                columns * times,
                own.enumerate().map(|(index, it)| (it + 2.0) * (1 + index) as f64),
            )
        };
        (0..blocks).map(score).collect()
    }

    #[test]
    fn causes_that_are_alike_are_one_look() {
        let of = |columns: usize, times: usize| looks(&scores(200, columns, times), 0..columns * times);
        assert!((of(1, 1) - 1.0).abs() < 0.4, "{}", of(1, 1));
        assert!((of(1, 30) / of(1, 1) - 1.0).abs() < 1e-9);
        let fifty = of(50, 1);
        assert!((30.0..80.0).contains(&fifty), "{fifty}");
        assert!((of(50, 4) / fifty - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_shows_nowhere_is_no_look() {
        assert_eq!(looks(&vec![DVector::zeros(3); 20], 0..3), 1.0);
        assert_eq!(looks(&[], 0..0), 1.0);
    }
}
