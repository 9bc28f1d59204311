//! How much better one model is than another: errors over blocks of time, whatever their colour.
//!
//! Errors of a model that is not quite right are correlated over time, so that samples are not independent. Counts are
//! those of independent samples, N/(1 + 2Σρ), and tests are over blocks that are longer than the correlation, as Vuong's
//! (Q. H. Vuong, Likelihood ratio tests for model selection and non-nested hypotheses, Econometrica 57, 1989).

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::estimation::fit::Residuals;

/// Share of the largest change of a block below which two models do not differ in a block.
const INACTIVE: f64 = 0.02;

/// Errors of one model on some records.
#[derive(Clone, Copy, Debug)]
pub struct Errors<'a> {
    /// The errors, record by record and signal by signal.
    pub residuals: &'a Residuals,
    /// Smallest mean square that is believed of each signal: that of its noise.
    pub floor: &'a [f64],
}

impl Errors<'_> {
    /// Mean square of each signal, and not below its noise.
    pub fn mean_squares(&self) -> Vec<f64> {
        (0..self.floor.len())
            .map(|row| {
                let values = self.residuals.iter().flat_map(|record| &record[row]);
                let (sum, count) = values
                    .filter(|value| value.is_finite())
                    .fold((0.0, 0_u32), |(sum, count), value| (sum + value * value, count + 1));
                (sum / f64::from(count.max(1))).max(self.floor[row].powi(2))
            })
            .collect()
    }

    /// Root mean square of each signal, and not below its noise.
    pub fn roots(&self) -> Vec<f64> {
        self.mean_squares().into_iter().map(f64::sqrt).collect()
    }

    /// Number of independent samples of each signal.
    pub fn effective_counts(&self) -> Vec<f64> {
        (0..self.floor.len())
            .map(|row| self.residuals.iter().map(|record| effective_count(&record[row])).sum::<f64>())
            .collect()
    }

    /// Logarithm of another model's likelihood on these records over this one's, given the number of independent samples of each signal.
    pub fn log_ratio(&self, other: &Self, counts: &[f64]) -> f64 {
        let squares = self.mean_squares().into_iter().zip(other.mean_squares());
        counts.iter().zip(squares).map(|(n, (own, other))| 0.5 * n * (own / other).ln()).sum()
    }

    /// By how much another model's squared errors are smaller over blocks of so many samples, in halves of `unit`, one
    /// for each signal; blocks in which both models say the same are left out.
    pub fn gains(&self, other: &Self, block: usize, unit: &[f64]) -> Vec<f64> {
        self.blocks(other, block, unit).iter().map(|it| 0.5 * (it.before - it.after)).collect()
    }

    /// The same in logarithms of each block's own errors: a block counts for what is better there, not for how large its
    /// errors are.
    pub fn ratios(&self, other: &Self, block: usize, unit: &[f64]) -> Vec<f64> {
        let ratio = |it: &Block| (it.before.max(f64::MIN_POSITIVE) / it.after.max(f64::MIN_POSITIVE)).ln();
        self.blocks(other, block, unit).iter().map(ratio).collect()
    }

    /// Squared errors of both models over blocks, in `unit`; blocks in which both say the same are left out.
    fn blocks(&self, other: &Self, block: usize, unit: &[f64]) -> Vec<Block> {
        let mut blocks: Vec<Block> = Vec::new();
        for (own, other) in self.residuals.iter().zip(other.residuals) {
            let count = own.first().map_or(0, |signal| signal.len().div_ceil(block));
            let mut here = vec![Block::default(); count];
            for ((own, other), unit) in own.iter().zip(other).zip(unit) {
                for ((own, other), here) in own.chunks(block).zip(other.chunks(block)).zip(&mut here) {
                    for (before, after) in own.iter().zip(other) {
                        if before.is_finite() && after.is_finite() {
                            here.before += before * before / unit;
                            here.after += after * after / unit;
                            here.change += (before - after).powi(2) / unit;
                        }
                    }
                }
            }
            blocks.extend(here);
        }
        let largest = blocks.iter().map(|it| it.change).fold(0.0, f64::max);
        blocks.retain(|it| it.change > INACTIVE * largest);
        blocks
    }
}

/// Sums of squares over a block: of two models' errors, and of their difference.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    before: f64,
    after: f64,
    change: f64,
}

/// Number of independent samples: the sum of correlations ends where they first change their sign. They are those of what
/// varies about a straight line: an offset is as certain as the samples are many.
fn effective_count(values: &[f64]) -> f64 {
    let known = about_a_line(values);
    let n = known.len();
    let variance: f64 = known.iter().map(|value| value * value).sum();
    if n < 4 || variance == 0.0 {
        return n as f64;
    }
    let mut sum = 0.0;
    for lag in 1..n / 4 {
        let products: f64 = known[lag..].iter().zip(&known).map(|(later, earlier)| later * earlier).sum();
        if products <= 0.0 {
            break;
        }
        sum += products / variance;
    }
    n as f64 / (1.0 + 2.0 * sum)
}

/// The known values about the straight line through them.
fn about_a_line(values: &[f64]) -> Vec<f64> {
    let known: Vec<(f64, f64)> = values
        .iter()
        .enumerate()
        .filter(|(_, y)| y.is_finite())
        .map(|(index, y)| (index as f64, *y))
        .collect();
    let n = known.len().max(1) as f64;
    let (x_mean, y_mean) = known.iter().fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x / n, sum.1 + y / n));
    let (xx, xy) = known
        .iter()
        .fold((0.0, 0.0), |sum, (x, y)| (sum.0 + (x - x_mean).powi(2), sum.1 + (x - x_mean) * (y - y_mean)));
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    known.iter().map(|(x, y)| y - y_mean - slope * (x - x_mean)).collect()
}

/// How surely a mean is not zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Student {
    /// Student's t.
    pub t: f64,
    /// Its degrees of freedom.
    freedom: f64,
}

impl Student {
    /// Chance that the mean is as clearly above zero where it is zero.
    pub fn chance(self) -> f64 {
        StudentsT::new(0.0, 1.0, self.freedom).map_or(1.0, |law| law.sf(self.t))
    }

    /// Chance that what was fitted gains as steadily where there is nothing to be fitted. An amount `a` that follows from what
    /// blocks say of it, `s`, gains `a s − a² h/2` in each, whose mean is half that of `a s`; so the t of what they say is twice
    /// that of what is gained.
    pub fn chance_of_gain(self) -> f64 {
        let law = StudentsT::new(0.0, 1.0, self.freedom);
        law.map_or(1.0, |law| 2.0 * law.sf(2.0 * self.t.max(0.0)))
    }
}

/// Student's t of the mean of values.
pub fn student(values: &[f64]) -> Student {
    let n = values.len() as f64;
    if n < 2.0 {
        return Student::default();
    }
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let t = if variance == 0.0 { 0.0 } else { mean / (variance / n).sqrt() };
    Student { t, freedom: n - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_that_holds_each_value_ten_times_has_a_tenth_of_the_samples() {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let white: Vec<f64> = (0..20_000).map(|_| random()).collect();
        let held: Vec<f64> = white.iter().take(2000).flat_map(|value| [*value; 10]).collect();
        assert!(effective_count(&white) > 15_000.0);
        assert!((effective_count(&held) / 2000.0 - 1.0).abs() < 0.2);
        let drifting: Vec<f64> = white.iter().zip(0..).map(|(y, k)| y + 3.0 - 1e-4 * f64::from(k)).collect();
        assert!((effective_count(&drifting) / effective_count(&white) - 1.0).abs() < 0.01);
    }

    #[test]
    fn half_the_error_is_two_to_the_number_of_samples_as_likely() {
        let of = |share: f64| -> Residuals {
            vec![vec![(0..1000_i32).map(|k| share * f64::from(k * k % 17 - 8)).collect()]]
        };
        let (whole, half, floor) = (of(1.0), of(0.5), [0.0]);
        let [whole, half] = [&whole, &half].map(|residuals| Errors { residuals, floor: &floor });
        let counts = whole.effective_counts();
        assert!((whole.log_ratio(&half, &counts) - counts[0] * 2.0_f64.ln()).abs() < 1e-9 * counts[0]);
        assert_eq!(whole.log_ratio(&half, &counts), -half.log_ratio(&whole, &counts));
        // Below its noise, an error is no smaller.
        let floor = [100.0];
        let [whole, half] = [whole, half].map(|it| Errors { floor: &floor, ..it });
        assert_eq!(whole.log_ratio(&half, &counts), 0.0);
    }

    /// A large event and nine small ones, all of them met better.
    #[test]
    fn events_of_any_size_count_alike_in_ratios() {
        let sizes = [6.0, 7.0, 5.5, 30.0, 6.5, 6.0, 5.0, 7.0, 6.0, 5.5];
        let of = |share: f64| -> Residuals {
            let event = |size: f64, k: i32| share * size * (0.6 * f64::from(k)).sin();
            vec![vec![sizes.iter().flat_map(|size| (0..50).map(move |k| event(*size, k))).collect()]]
        };
        let (bad, good, floor) = (of(1.0), of(0.9), [0.0]);
        let [bad, good] = [&bad, &good].map(|residuals| Errors { residuals, floor: &floor });
        assert!(student(&bad.gains(&good, 50, &[1.0])).t < 2.0);
        let ratios = bad.ratios(&good, 50, &[1.0]);
        assert_eq!(ratios.len(), sizes.len());
        assert!(ratios.iter().all(|it| (it - 2.0 * (1.0_f64 / 0.9).ln()).abs() < 1e-9), "{ratios:?}");
    }

    /// Of amounts that are fitted to noise, one in ten gains as steadily as one in ten does by chance.
    #[test]
    fn what_is_fitted_to_noise_gains_by_chance_as_often_as_is_said() {
        let (block, blocks, repeated) = (40, 30, 200_u64);
        let column: Vec<f64> = (0..block * blocks).map(|k| (0.3 * f64::from(k)).sin()).collect();
        let chance = |seed: u64| {
            let white = crate::signal::random::white(seed, column.len());
            let both = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let amount = both(&white, &column) / both(&column, &column);
            let left = white.iter().zip(&column).map(|(y, x)| y - amount * x).collect();
            let [before, after] = [vec![vec![white.clone()]], vec![vec![left]]];
            let [before, after] = [&before, &after].map(|residuals| Errors { residuals, floor: &[0.0] });
            student(&before.gains(&after, block as usize, &[1.0])).chance_of_gain()
        };
        let chances: Vec<f64> = (1..=repeated).map(chance).collect();
        for level in [0.1, 0.5] {
            let share = chances.iter().filter(|it| **it < level).count() as f64 / repeated as f64;
            assert!((share - level).abs() < 0.08, "{share} below {level}");
        }
    }

    #[test]
    fn a_model_that_is_better_in_every_block_has_a_large_t_and_an_equal_one_none() {
        let residual = |size: f64| vec![vec![(0..1000).map(|k| size * (f64::from(k) * 0.7).sin()).collect()]];
        let (bad, good) = (residual(2.0), residual(1.0));
        let floor = [0.1];
        let of = |residuals| Errors { residuals, floor: &floor };
        assert!(student(&of(&bad).gains(&of(&good), 50, &[1.0])).t > 20.0);
        assert!(student(&of(&good).gains(&of(&bad), 50, &[1.0])).t < -20.0);
        assert!(of(&bad).gains(&of(&bad), 50, &[1.0]).is_empty());
    }
}
