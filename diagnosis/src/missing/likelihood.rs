//! Likelihoods and amounts from sums of squared innovations.

use nalgebra::{DMatrix, DVector};

use super::innovations::Block;

/// Sums over some blocks.
#[derive(Clone, Debug)]
pub struct Sums {
    /// Products of all columns' innovations over their variances.
    pub normal: DMatrix<f64>,
    /// Sum of the logarithms of the variances.
    pub log_variance: f64,
    /// Number of innovations.
    pub count: usize,
}

/// Amounts of some columns that fit the record best.
#[derive(Clone, Debug)]
pub struct Amounts {
    /// The columns, by their numbers.
    pub columns: Vec<usize>,
    /// How much there is of each.
    pub values: DVector<f64>,
    /// Their covariance as if the innovations were white.
    pub covariance: DMatrix<f64>,
    /// What is left of the record's sum of squares, priors included.
    pub left: f64,
}

impl Sums {
    /// Of some blocks.
    pub fn of<'a>(blocks: impl Iterator<Item = &'a Block>) -> Option<Self> {
        let mut sums: Option<Self> = None;
        for block in blocks {
            let sums = sums.get_or_insert_with(|| Self {
                normal: DMatrix::zeros(block.normal.nrows(), block.normal.ncols()),
                log_variance: 0.0,
                count: 0,
            });
            sums.normal += &block.normal;
            sums.log_variance += block.log_variance;
            sums.count += block.count;
        }
        sums
    }

    /// The best amounts of some columns, with the precision that is known of each before; none where columns do the same.
    pub fn fitted(&self, columns: &[usize], precisions: &[f64]) -> Option<Amounts> {
        let n = columns.len();
        let size: Vec<f64> = columns
            .iter()
            .zip(precisions)
            .map(|(it, more)| (self.normal[(*it, *it)] + more).sqrt())
            .collect();
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            if size[i] == 0.0 || size[j] == 0.0 {
                return f64::from(i == j);
            }
            let prior = if i == j { precisions[i] } else { 0.0 };
            let ridge = if i == j { 1e-9 } else { 0.0 };
            (self.normal[(columns[i], columns[j])] + prior) / size[i] / size[j] + ridge
        });
        let right =
            DVector::from_fn(
                n,
                |i, _| {
                    if size[i] == 0.0 { 0.0 } else { -self.normal[(columns[i], 0)] / size[i] }
                },
            );
        let factor = scaled.cholesky()?;
        let solved = factor.solve(&right);
        let unscale = |i: usize| if size[i] == 0.0 { 0.0 } else { 1.0 / size[i] };
        let inverse = factor.inverse();
        Some(Amounts {
            columns: columns.to_vec(),
            values: DVector::from_fn(n, |i, _| solved[i] * unscale(i)),
            covariance: DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * unscale(i) * unscale(j)),
            left: self.normal[(0, 0)] - solved.dot(&right),
        })
    }

    /// Logarithm of the likelihood, the first `parameters` columns behind the record being fitted.
    pub fn log_likelihood(&self, precisions: &[f64]) -> f64 {
        let columns: Vec<usize> = (1..=precisions.len()).collect();
        let left = self.fitted(&columns, precisions).map_or(self.normal[(0, 0)], |it| it.left);
        -0.5 * (left + self.log_variance)
    }
}
