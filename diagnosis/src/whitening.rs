//! How likely residuals are, whatever their colour: a vector autoregression makes them white.
//!
//! The residuals of a model that is not quite right are coloured, and those of several signals belong together. Their
//! likelihood is that of the innovations of an autoregression fitted to them (H. Lütkepohl, New Introduction to
//! Multiple Time Series Analysis, 2005, section 3.4).

use nalgebra::{DMatrix, DVector};

use crate::fit::Residuals;

/// Order of the autoregression.
const ORDER: usize = 12;

/// The likelihood of residuals.
#[derive(Clone, Debug)]
pub struct Likelihood {
    /// Logarithm of the likelihood of each sample of each record.
    pub samples: Vec<Vec<f64>>,
}

impl Likelihood {
    /// Of residuals; `floor` are standard deviations below which an innovation is not believed, one for each signal.
    ///
    /// The signals of all records are the same, in the same order; a missing sample counts as zero.
    pub fn of(residuals: &Residuals, floor: &[f64]) -> Self {
        let signals = floor.len();
        let known = |value: f64| if value.is_finite() { value } else { 0.0 };
        // In units of the floors.
        let rows: Vec<DMatrix<f64>> = residuals
            .iter()
            .map(|record| {
                let len = record.first().map_or(0, Vec::len);
                DMatrix::from_fn(signals, len, |i, k| known(record[i][k]) / floor[i])
            })
            .collect();
        let total: usize = rows.iter().map(DMatrix::ncols).sum();
        let covariances: Vec<DMatrix<f64>> = (0..=ORDER)
            .map(|lag| {
                let mut sum = DMatrix::zeros(signals, signals);
                for record in rows.iter().filter(|record| record.ncols() > lag) {
                    let n = record.ncols() - lag;
                    sum += record.columns(lag, n) * record.columns(0, n).transpose();
                }
                sum / total.max(1) as f64
            })
            .collect();
        let (coefficients, innovation) = yule_walker(&covariances);
        let scatter = innovation + DMatrix::identity(signals, signals) * 0.25;
        let Some(cholesky) = scatter.cholesky() else {
            return Self { samples: rows.iter().map(|record| vec![0.0; record.ncols()]).collect() };
        };
        let constant = cholesky.l().diagonal().map(f64::ln).sum();
        let samples = rows
            .iter()
            .map(|record| {
                let mut innovations = record.clone();
                for (lag, matrix) in (1..).zip(&coefficients) {
                    if record.ncols() > lag {
                        let n = record.ncols() - lag;
                        let predicted = matrix * record.columns(0, n);
                        let mut later = innovations.columns_mut(lag, n);
                        later -= predicted;
                    }
                }
                let white = cholesky.l().solve_lower_triangular(&innovations).unwrap_or(innovations);
                white.column_iter().map(|column| -constant - 0.5 * column.norm_squared()).collect()
            })
            .collect();
        Self { samples }
    }

    /// Sum over all samples.
    pub fn total(&self) -> f64 {
        self.samples.iter().flatten().sum()
    }

    /// How much likelier other residuals of the same records are, over blocks of so many samples.
    pub fn gains(&self, other: &Self, block: usize) -> Vec<f64> {
        let records = self.samples.iter().zip(&other.samples);
        records
            .flat_map(|(own, other)| {
                own.chunks(block)
                    .zip(other.chunks(block))
                    .map(|(own, other)| other.iter().zip(own).map(|(other, own)| other - own).sum::<f64>())
            })
            .collect()
    }
}

/// Coefficients and covariance of the innovations of an autoregression with these covariances.
fn yule_walker(covariances: &[DMatrix<f64>]) -> (Vec<DMatrix<f64>>, DMatrix<f64>) {
    let (order, n) = (covariances.len() - 1, covariances[0].nrows());
    let at = |lag: isize| {
        if lag >= 0 { covariances[lag as usize].clone() } else { covariances[(-lag) as usize].transpose() }
    };
    let mut toeplitz = DMatrix::zeros(order * n, order * n);
    let mut right = DMatrix::zeros(order * n, n);
    for i in 0..order {
        for j in 0..order {
            // Σ_j A_j Γ(i − j) = Γ(i), transposed.
            toeplitz.view_mut((i * n, j * n), (n, n)).copy_from(&at(i as isize - j as isize).transpose());
        }
        right.view_mut((i * n, 0), (n, n)).copy_from(&covariances[i + 1].transpose());
    }
    // Residuals that are nearly predictable make a matrix that is nearly singular.
    let ridge = 1e-9 * toeplitz.trace() / (order * n).max(1) as f64 + f64::MIN_POSITIVE;
    toeplitz += DMatrix::identity(order * n, order * n) * ridge;
    let Some(solution) = toeplitz.lu().solve(&right) else { return (Vec::new(), covariances[0].clone()) };
    let coefficients: Vec<DMatrix<f64>> =
        (0..order).map(|lag| solution.rows(lag * n, n).transpose()).collect();
    let mut innovation = covariances[0].clone();
    for (matrix, covariance) in coefficients.iter().zip(&covariances[1..]) {
        innovation -= matrix * covariance.transpose();
    }
    let symmetric = (&innovation + innovation.transpose()) * 0.5;
    (coefficients, symmetric)
}

/// Student's t of the mean of values.
pub fn student(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let values = DVector::from_column_slice(values);
    let (mean, deviation) = (values.mean(), values.variance().sqrt() * (n / (n - 1.0)).sqrt());
    if deviation == 0.0 { 0.0 } else { mean / deviation * n.sqrt() }
}
