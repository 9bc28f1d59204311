//! A Kalman filter for several right-hand sides at once.
//!
//! The gains of a linear filter do not depend on the data. So the record, the change that each parameter makes and the change
//! that each candidate makes pass the same filter, and what comes out is white where the model holds: ordinary least
//! squares on the innovations is then the likelihood (B. Rosenberg, Annals of Economic and Social Measurement 2 (1973);
//! P. de Jong, Annals of Statistics 19 (1991)).

use std::slice::{ChunksExact, ChunksExactMut};

/// The rows of a matrix with n columns; of a rig without states there are none.
fn rows(matrix: &[f64], n: usize) -> ChunksExact<'_, f64> {
    matrix.chunks_exact(n.max(1))
}

/// The same, to be changed.
fn rows_mut(matrix: &mut [f64], n: usize) -> ChunksExactMut<'_, f64> {
    matrix.chunks_exact_mut(n.max(1))
}

/// The state of a filter: estimates for each right-hand side, and one covariance for all.
#[derive(Clone, Debug)]
pub struct Filter {
    /// Number of states.
    n: usize,
    /// Number of right-hand sides.
    columns: usize,
    /// Estimates, state by state.
    pub x: Vec<f64>,
    /// Covariance, row by row.
    pub p: Vec<f64>,
    gain: Vec<f64>,
    next: Vec<f64>,
    product: Vec<f64>,
    /// Which states follow from themselves alone, as a port's signal does.
    alone: Vec<bool>,
}

/// What a measurement brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// Variance of the innovation.
    pub variance: f64,
}

impl Filter {
    /// At rest, with this variance of each state.
    pub fn new(variances: &[f64], columns: usize) -> Self {
        let n = variances.len();
        let mut p = vec![0.0; n * n];
        for (index, variance) in variances.iter().enumerate() {
            p[index * n + index] = *variance;
        }
        Self {
            n,
            columns,
            x: vec![0.0; n * columns],
            p,
            gain: vec![0.0; n],
            next: vec![0.0; n * columns],
            product: vec![0.0; n * n],
            alone: vec![false; n],
        }
    }

    /// The gain of the last measurement.
    pub fn gain(&self) -> &[f64] {
        &self.gain
    }

    /// Takes in a measurement `y = h x + e` with variance `noise` of e; `y` becomes the innovations, of each right-hand side.
    pub fn measure(&mut self, h: &[f64], noise: f64, y: &mut [f64]) -> Update {
        let n = self.n;
        self.gain.fill(0.0);
        for (h, row) in h.iter().zip(rows(&self.p, n)).filter(|(h, _)| **h != 0.0) {
            self.gain.iter_mut().zip(row).for_each(|(gain, p)| *gain += p * h);
        }
        // Rounding must not make less of it than the noise.
        let variance = noise + self.gain.iter().zip(h).map(|(g, h)| g * h).sum::<f64>().max(0.0);
        let inverse = 1.0 / variance;
        for (h, x) in h.iter().zip(self.x.chunks_exact(self.columns)) {
            if *h != 0.0 {
                y.iter_mut().zip(x).for_each(|(y, x)| *y -= h * x);
            }
        }
        for (gain, row) in self.gain.iter().zip(rows_mut(&mut self.p, n)) {
            let factor = gain * inverse;
            row.iter_mut().zip(&self.gain).for_each(|(p, gain)| *p -= factor * gain);
        }
        for (gain, x) in self.gain.iter_mut().zip(self.x.chunks_exact_mut(self.columns)) {
            *gain *= inverse;
            x.iter_mut().zip(&*y).for_each(|(x, y)| *x += *gain * y);
        }
        Update { variance }
    }

    /// Goes on by `x' = a x + input`, with these variances of what drives each state.
    pub fn predict(&mut self, a: &[f64], input: &[f64], driven: &[f64]) {
        let (n, columns) = (self.n, self.columns);
        self.next.copy_from_slice(input);
        for (row, next) in rows(a, n).zip(self.next.chunks_exact_mut(columns)) {
            for (a, x) in row.iter().zip(self.x.chunks_exact(columns)) {
                if *a != 0.0 {
                    next.iter_mut().zip(x).for_each(|(next, x)| *next += a * x);
                }
            }
        }
        std::mem::swap(&mut self.x, &mut self.next);
        self.spread(a, driven);
    }

    /// The covariance alone: `p' = a p aᵀ + diag(driven)`.
    pub fn spread(&mut self, a: &[f64], driven: &[f64]) {
        let n = self.n;
        self.product.fill(0.0);
        for (j, (row, product)) in rows(a, n).zip(rows_mut(&mut self.product, n)).enumerate() {
            self.alone[j] = row.iter().enumerate().all(|(i, a)| i == j || *a == 0.0);
            for (a, p) in row.iter().zip(rows(&self.p, n)) {
                if *a != 0.0 {
                    product.iter_mut().zip(p).for_each(|(product, p)| *product += a * p);
                }
            }
        }
        for (i, driven) in driven.iter().enumerate() {
            let product = &self.product[i * n..(i + 1) * n];
            for j in 0..=i {
                let row = &a[j * n..(j + 1) * n];
                let value: f64 = match self.alone[j] {
                    true => product[j] * row[j],
                    false => product.iter().zip(row).map(|(p, a)| p * a).sum(),
                };
                (self.p[i * n + j], self.p[j * n + i]) = (value, value);
            }
            self.p[i * n + i] += driven;
        }
    }
}

/// What a filter leaves behind of one sample for the way back.
#[derive(Clone, Debug, Default)]
pub struct Passed {
    /// Estimate before the measurements.
    pub x: Vec<f64>,
    /// Its covariance.
    pub p: Vec<f64>,
    /// Each measurement: its row, gain, innovation and variance.
    pub measured: Vec<(Vec<f64>, Vec<f64>, f64, f64)>,
    /// The transition to the next sample.
    pub a: Vec<f64>,
}

/// A smoothed sample.
#[derive(Clone, Debug)]
pub struct Smoothed {
    /// Estimate from all data.
    pub x: Vec<f64>,
    /// Its variances.
    pub variance: Vec<f64>,
}

/// The way back through a record, without inverting a covariance (G. J. Bierman, Fixed interval smoothing with discrete
/// measurements, International Journal of Control 18 (1973); modified Bryson–Frazier).
pub fn smoothed(passed: &[Passed]) -> Vec<Smoothed> {
    let Some(n) = passed.first().map(|it| it.x.len()) else { return Vec::new() };
    let (mut adjoint, mut information) = (vec![0.0; n], vec![0.0; n * n]);
    let mut all: Vec<Smoothed> = Vec::with_capacity(passed.len());
    let mut scratch = vec![0.0; n * n];
    for sample in passed.iter().rev() {
        if !sample.a.is_empty() && !all.is_empty() {
            adjoint = transposed_times(&sample.a, &adjoint);
            congruence(&sample.a, &mut information, &mut scratch);
        }
        for (h, gain, innovation, variance) in sample.measured.iter().rev() {
            // (I − K h)ᵀ applied from the left, and from both sides.
            let along: f64 = gain.iter().zip(&adjoint).map(|(k, a)| k * a).sum();
            let mut pulled = vec![0.0; n];
            for (pulled, row) in pulled.iter_mut().zip(rows(&information, n)) {
                *pulled = row.iter().zip(gain).map(|(m, k)| m * k).sum();
            }
            let twice: f64 = pulled.iter().zip(gain).map(|(m, k)| m * k).sum::<f64>() + 1.0 / variance;
            for i in 0..n {
                adjoint[i] += h[i] * (innovation / variance - along);
                for j in 0..n {
                    information[i * n + j] += twice * h[i] * h[j] - h[i] * pulled[j] - pulled[i] * h[j];
                }
            }
        }
        let mut x = sample.x.clone();
        let mut variance = vec![0.0; n];
        for i in 0..n {
            let row = &sample.p[i * n..(i + 1) * n];
            x[i] += row.iter().zip(&adjoint).map(|(p, a)| p * a).sum::<f64>();
            let quadratic: f64 = (0..n)
                .map(|j| {
                    row[j] * information[j * n..(j + 1) * n].iter().zip(row).map(|(m, p)| m * p).sum::<f64>()
                })
                .sum();
            variance[i] = (row[i] - quadratic).max(0.0);
        }
        all.push(Smoothed { x, variance });
    }
    all.reverse();
    all
}

fn transposed_times(a: &[f64], x: &[f64]) -> Vec<f64> {
    let n = x.len();
    let mut result = vec![0.0; n];
    for (row, x) in rows(a, n).zip(x) {
        result.iter_mut().zip(row).for_each(|(result, a)| *result += a * x);
    }
    result
}

/// `m ← aᵀ m a`.
fn congruence(a: &[f64], m: &mut [f64], scratch: &mut [f64]) {
    let n = a.len().isqrt();
    scratch.fill(0.0);
    for (row, product) in rows(m, n).zip(rows_mut(scratch, n)) {
        for (m, a) in row.iter().zip(rows(a, n)) {
            product.iter_mut().zip(a).for_each(|(product, a)| *product += m * a);
        }
    }
    m.fill(0.0);
    for (a, product) in rows(a, n).zip(rows(scratch, n)) {
        for (i, a) in a.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            m[i * n..(i + 1) * n].iter_mut().zip(product).for_each(|(m, product)| *m += a * product);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// A random walk measured four times: filter and smoother against generalised least squares of all samples at once.
    #[test]
    fn a_smoothed_random_walk_is_the_best_linear_estimate() {
        let y = [1.0, 3.0, 2.0, 5.0];
        let (start, driven, noise) = (4.0, 0.5, 0.8);
        let mut filter = Filter::new(&[start], 1);
        let mut passed = Vec::new();
        let mut likelihood = 0.0;
        for value in y {
            let (x, p) = (filter.x.clone(), filter.p.clone());
            let mut e = [value];
            let update = filter.measure(&[1.0], noise, &mut e);
            likelihood -= 0.5 * (update.variance.ln() + e[0] * e[0] / update.variance);
            let measured = vec![(vec![1.0], filter.gain().to_vec(), e[0], update.variance)];
            passed.push(Passed { x, p, measured, a: vec![1.0] });
            filter.predict(&[1.0], &[0.0], &[driven]);
        }
        let prior = DMatrix::from_fn(4, 4, |i, j| start + driven * i.min(j) as f64);
        let total = &prior + DMatrix::identity(4, 4) * noise;
        let y = DVector::from_row_slice(&y);
        let inverse = total.clone().try_inverse().unwrap();
        let mean = &prior * &inverse * &y;
        let covariance = &prior - &prior * &inverse * &prior;
        for (k, smoothed) in smoothed(&passed).iter().enumerate() {
            assert!((smoothed.x[0] - mean[k]).abs() < 1e-12, "{k}: {} {}", smoothed.x[0], mean[k]);
            assert!((smoothed.variance[0] - covariance[(k, k)]).abs() < 1e-12);
        }
        let expected = -0.5 * (total.determinant().ln() + y.dot(&(&inverse * &y)));
        assert!((likelihood - expected).abs() < 1e-12);
    }

    /// Two states, of which one is measured; the estimates are linear in the data, for each right-hand side.
    #[test]
    fn right_hand_sides_superpose() {
        let run = |columns: &[[f64; 3]]| {
            let mut filter = Filter::new(&[1.0, 2.0], columns.len());
            let mut innovations = Vec::new();
            for k in 0..3 {
                let mut y: Vec<f64> = columns.iter().map(|it| it[k]).collect();
                filter.measure(&[1.0, 0.3], 0.1, &mut y);
                innovations.push(y);
                filter.predict(&[1.0, 0.1, -0.2, 0.9], &vec![0.0; 2 * columns.len()], &[0.01, 0.02]);
            }
            innovations
        };
        let (a, b) = ([1.0, -2.0, 0.5], [0.3, 0.7, -1.1]);
        let sum = [0, 1, 2].map(|k| 2.0 * a[k] - b[k]);
        let all = run(&[a, b, sum]);
        for e in &all {
            assert!((2.0 * e[0] - e[1] - e[2]).abs() < 1e-12);
        }
    }
}
