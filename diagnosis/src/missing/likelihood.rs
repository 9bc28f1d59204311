//! Likelihoods and amounts from sums of squared innovations.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

/// Share of their power by which columns differ through rounding.
const ROUNDING: f64 = 1e-9;

/// Sums over the innovations of a stretch of a record. Candidates are compared and never fitted together, so there are no products
/// of two candidates' columns.
#[derive(Clone, Debug)]
pub struct Sums {
    /// Each candidate's columns, among all candidates'.
    candidates: Vec<Range<usize>>,
    /// Products of the record's and the nuisances' innovations with all columns' innovations, over their variances.
    shared: DMatrix<f64>,
    /// Products of each candidate's columns with one another.
    own: Vec<DMatrix<f64>>,
    /// Sum of the logarithms of the variances.
    log_variance: f64,
    /// Number of innovations.
    count: usize,
}

impl Sums {
    /// Of no innovations: `known` columns are the record's and the nuisances'; those of the candidates follow.
    pub fn none(known: usize, candidates: &[Range<usize>]) -> Self {
        let columns = known + candidates.iter().map(|it| it.end).max().unwrap_or(0);
        Self {
            candidates: candidates.to_vec(),
            shared: DMatrix::zeros(known, columns),
            own: candidates.iter().map(|it| DMatrix::zeros(it.len(), it.len())).collect(),
            log_variance: 0.0,
            count: 0,
        }
    }

    /// Takes in innovations, one measurement's of all columns after the other, over their standard deviations.
    pub fn take(&mut self, innovations: &[f64], log_variance: f64) {
        let (known, columns) = self.shared.shape();
        // A few measurements at a time: adding their products one by one is cheaper than the packing of a general product.
        for measurement in innovations.chunks_exact(columns) {
            let (first, others) = measurement.split_at(known);
            add_products(self.shared.as_mut_slice(), first, measurement);
            for (range, own) in self.candidates.iter().zip(&mut self.own) {
                let candidate = &others[range.clone()];
                add_products(own.as_mut_slice(), candidate, candidate);
            }
        }
        self.log_variance += log_variance;
        self.count += innovations.len() / columns;
    }

    /// Of several stretches.
    pub fn of<'a>(mut stretches: impl Iterator<Item = &'a Self>) -> Option<Self> {
        let mut sums = stretches.next()?.clone();
        for stretch in stretches {
            sums.shared += &stretch.shared;
            sums.own.iter_mut().zip(&stretch.own).for_each(|(all, more)| *all += more);
            sums.log_variance += stretch.log_variance;
            sums.count += stretch.count;
        }
        Some(sums)
    }

    /// The record and the nuisances.
    pub fn known(&self) -> Normal {
        let known = self.shared.nrows();
        self.normal(self.shared.columns(0, known).into_owned())
    }

    /// The record, the nuisances, and a candidate behind them.
    pub fn with(&self, candidate: usize) -> Normal {
        let (known, range, own) = (self.shared.nrows(), &self.candidates[candidate], &self.own[candidate]);
        let size = known + range.len();
        let column = |index: usize| if index < known { index } else { index + range.start };
        self.normal(DMatrix::from_fn(size, size, |i, j| match (i.checked_sub(known), j.checked_sub(known)) {
            (Some(i), Some(j)) => own[(i, j)],
            (None, _) => self.shared[(i, column(j))],
            (Some(_), None) => self.shared[(j, column(i))],
        }))
    }

    fn normal(&self, products: DMatrix<f64>) -> Normal {
        Normal { products, log_variance: self.log_variance, count: self.count }
    }
}

/// Adds the products of two vectors to a matrix, column by column.
fn add_products(sums: &mut [f64], rows: &[f64], columns: &[f64]) {
    for (column, by) in sums.chunks_exact_mut(rows.len().max(1)).zip(columns) {
        column.iter_mut().zip(rows).for_each(|(sum, it)| *sum += it * by);
    }
}

/// The normal equations of some columns: the record's first.
#[derive(Clone, Debug)]
pub struct Normal {
    /// Products of the columns' innovations over their variances.
    pub products: DMatrix<f64>,
    /// Sum of the logarithms of the variances.
    pub log_variance: f64,
    /// Number of innovations.
    pub count: usize,
}

/// Amounts of the columns behind the record that fit it best.
#[derive(Clone, Debug)]
pub struct Amounts {
    /// How much there is of each.
    pub values: DVector<f64>,
    /// The remaining sum of squares of the record, priors included.
    pub left: f64,
}

impl Normal {
    /// The best amounts of the first columns behind the record, with the precision that is known of each before; none where columns
    /// do the same.
    pub fn fitted(&self, precisions: &[f64]) -> Option<Amounts> {
        self.fitted_apart(precisions, ROUNDING)
    }

    /// The same, columns being one that differ by less than this share of their power.
    pub fn fitted_apart(&self, precisions: &[f64], alike: f64) -> Option<Amounts> {
        let n = precisions.len();
        let product = |i: usize, j: usize| self.products[(i + 1, j + 1)];
        let size: Vec<f64> = (0..n).map(|it| (product(it, it) + precisions[it]).sqrt()).collect();
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            if size[i] == 0.0 || size[j] == 0.0 {
                return f64::from(i == j);
            }
            let prior = if i == j { precisions[i] } else { 0.0 };
            let ridge = if i == j { alike } else { 0.0 };
            (product(i, j) + prior) / size[i] / size[j] + ridge
        });
        let unscale = |i: usize| if size[i] == 0.0 { 0.0 } else { 1.0 / size[i] };
        let right = DVector::from_fn(n, |i, _| -self.products[(i + 1, 0)] * unscale(i));
        let factor = scaled.cholesky()?;
        let solved = factor.solve(&right);
        Some(Amounts {
            values: DVector::from_fn(n, |i, _| solved[i] * unscale(i)),
            left: self.products[(0, 0)] - solved.dot(&right),
        })
    }

    /// The record plus the last columns times these amounts, in place of those columns.
    #[must_use]
    pub fn moved(&self, amounts: &[f64]) -> Self {
        let known = self.products.nrows() - amounts.len();
        let mut change = DMatrix::identity(known, self.products.nrows());
        change.view_mut((0, known), (1, amounts.len())).copy_from_slice(amounts);
        Self { products: &change * &self.products * change.transpose(), ..*self }
    }

    /// Logarithm of the likelihood, the first columns behind the record being fitted.
    pub fn log_likelihood(&self, precisions: &[f64]) -> f64 {
        let left = self.fitted(precisions).map_or(self.products[(0, 0)], |it| it.left);
        -0.5 * (left + self.log_variance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::random::with_noise;

    /// A nuisance and a column that differs from it by a thousandth, in which a record has a little of something else: apart, they are a
    /// hundred times as large as together.
    #[test]
    fn columns_that_are_nearly_one_share_what_they_explain() {
        let count = 400;
        let (first, other) = (with_noise(&vec![0.0; count], 1.0, 1), with_noise(&vec![0.0; count], 1.0, 2));
        let rows: Vec<[f64; 3]> =
            first.iter().zip(&other).map(|(a, b)| [-3.0 * a - 0.1 * b, *a, a + 1e-3 * b]).collect();
        let sums = DMatrix::from_fn(3, 3, |i, j| rows.iter().map(|row| row[i] * row[j]).sum());
        let normal = Normal { products: sums, log_variance: 0.0, count };
        let apart = normal.fitted(&[0.0; 2]).unwrap();
        let together = normal.fitted_apart(&[0.0; 2], 1e-4).unwrap();
        assert!(apart.values.amax() > 90.0, "{}", apart.values);
        assert!(
            (together.values.sum() - 3.0).abs() < 0.02 && together.values.amax() < 3.0,
            "{}",
            together.values
        );
    }

    /// A record, a nuisance, and two candidates of one and two columns, seven measurements in two stretches.
    #[test]
    fn sums_are_those_of_all_columns() {
        let (known, candidates, columns, count) = (2, [0..1, 1..3], 5, 7);
        let rows = with_noise(&[0.0; 35], 1.0, 5);
        let all = DMatrix::from_column_slice(columns, count, &rows);
        let parts = rows.split_at(3 * columns);
        let stretches = [parts.0, parts.1].map(|part| {
            let mut sums = Sums::none(known, &candidates);
            sums.take(part, 0.5);
            sums
        });
        let sums = Sums::of(stretches.iter()).unwrap();
        for (candidate, own) in [vec![0, 1, 2], vec![0, 1, 3, 4]].into_iter().enumerate() {
            let normal = sums.with(candidate);
            let excerpt = all.select_rows(&own);
            assert!((&normal.products - &excerpt * excerpt.transpose()).amax() < 1e-12);
            assert_eq!((normal.count, normal.log_variance), (count, 1.0));
            // Amounts of the candidate's columns, added to the record.
            let amounts: Vec<f64> = (2..own.len()).map(|it| 0.3 * it as f64).collect();
            let mut moved = all.rows(0, known).into_owned();
            for (column, amount) in own[known..].iter().zip(&amounts) {
                let added = moved.row(0) + all.row(*column) * *amount;
                moved.set_row(0, &added);
            }
            assert!((normal.moved(&amounts).products - &moved * moved.transpose()).amax() < 1e-12);
        }
        assert_eq!(sums.known().products.nrows(), known);
    }
}
