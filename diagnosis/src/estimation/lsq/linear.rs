//! A least-squares problem, linearised: steps to its minimum, and covariances there.

use nalgebra::{DMatrix, DVector};

/// Half a sum of squares, linearised: `½‖R d + q‖² + rest` for a small step d.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Upper triangular, n × n.
    pub r: DMatrix<f64>,
    /// n values.
    pub q: DVector<f64>,
}

impl Linear {
    /// From a Jacobian, m × n with m ≥ n, and the residuals.
    pub fn by_qr(jacobian: DMatrix<f64>, residuals: &DVector<f64>) -> Self {
        let qr = jacobian.qr();
        let mut rotated = residuals.clone();
        qr.q_tr_mul(&mut rotated);
        let r = qr.r();
        let q = rotated.rows(0, r.ncols()).into_owned();
        Self { r, q }
    }

    /// From the normal equations `H = JᵀJ` and `g = Jᵀe`. Columns without influence get a zero row.
    pub fn by_cholesky(h: &DMatrix<f64>, g: &DVector<f64>) -> Self {
        let n = g.len();
        let scale = DVector::from_fn(n, |i, _| h[(i, i)].max(0.0).sqrt());
        let mut r = DMatrix::zeros(n, n);
        // Row by row, in units of each column's own norm: the remainder of a dependent column is rounding.
        for i in 0..n {
            let mut pivot = h[(i, i)];
            for k in 0..i {
                pivot -= r[(k, i)] * r[(k, i)];
            }
            if pivot.is_nan() || pivot <= 1e-13 * scale[i] * scale[i] {
                continue;
            }
            r[(i, i)] = pivot.sqrt();
            for j in i + 1..n {
                let mut sum = h[(i, j)];
                for k in 0..i {
                    sum -= r[(k, i)] * r[(k, j)];
                }
                r[(i, j)] = sum / r[(i, i)];
            }
        }
        let mut q = DVector::zeros(n);
        for i in 0..n {
            if r[(i, i)] > 0.0 {
                let sum: f64 = (0..i).map(|k| r[(k, i)] * q[k]).sum();
                q[i] = (g[i] - sum) / r[(i, i)];
            }
        }
        Self { r, q }
    }

    /// With a coordinate held where it is: the linearisation in the others.
    pub fn without(&self, coordinate: usize) -> Self {
        Self::by_qr(self.r.clone().remove_column(coordinate), &self.q)
    }

    /// Norm of each column of the Jacobian.
    pub fn column_norms(&self) -> DVector<f64> {
        DVector::from_fn(self.r.ncols(), |j, _| self.r.column(j).norm())
    }

    /// `(RᵀR)⁻¹`, the covariance for residuals of variance one. Coordinates that are not determined have a variance of
    /// infinity and are taken as known for the others.
    pub fn covariance(&self) -> DMatrix<f64> {
        let n = self.r.ncols();
        let norms = self.column_norms();
        let determined: Vec<usize> =
            (0..n).filter(|i| norms[*i] > 0.0 && self.r[(*i, *i)].abs() > 1e-12 * norms[*i]).collect();
        let m = determined.len();
        let mut covariance = DMatrix::from_diagonal(&DVector::repeat(n, f64::INFINITY));
        let reduced = DMatrix::from_fn(n, m, |row, column| self.r[(row, determined[column])]);
        if m == 0 {
            return covariance;
        }
        let upper = reduced.qr().r();
        if let Some(inverse) = upper.solve_upper_triangular(&DMatrix::identity(m, m)) {
            let product = &inverse * inverse.transpose();
            for (i, row) in determined.iter().enumerate() {
                for (j, column) in determined.iter().enumerate() {
                    covariance[(*row, *column)] = product[(i, j)];
                }
            }
        }
        covariance
    }

    /// The covariance at a minimum for scores that are correlated within, not among, themselves: those of blocks of time;
    /// infinite for a coordinate that is not determined.
    pub fn robust_covariance(&self, scores: &[DVector<f64>]) -> DMatrix<f64> {
        let n = self.q.len();
        let mean =
            scores.iter().fold(DVector::zeros(n), |sum, score| sum + score) / scores.len().max(1) as f64;
        let deviations: Vec<DVector<f64>> = scores.iter().map(|score| score - &mean).collect();
        self.sandwich(&deviations)
    }

    /// `H⁻¹ (Σ s sᵀ) H⁻¹`; infinite for a coordinate that is not determined, or whose scores are not numbers.
    pub fn sandwich(&self, scores: &[DVector<f64>]) -> DMatrix<f64> {
        let mut inverse = self.covariance();
        let n = inverse.ncols();
        let is_unknown = |index: &usize| {
            !inverse[(*index, *index)].is_finite() || scores.iter().any(|score| !score[*index].is_finite())
        };
        let unknown: Vec<usize> = (0..n).filter(is_unknown).collect();
        let mut scores = scores.to_vec();
        for index in &unknown {
            inverse.row_mut(*index).fill(0.0);
            inverse.column_mut(*index).fill(0.0);
            scores.iter_mut().for_each(|score| score[*index] = 0.0);
        }
        let spread = scores.iter().fold(DMatrix::zeros(n, n), |sum, score| sum + score * score.transpose());
        let mut covariance = &inverse * spread * &inverse;
        for index in unknown {
            covariance[(index, index)] = f64::INFINITY;
        }
        covariance
    }

    /// The step to the minimum; zero for coordinates that are not determined.
    pub fn minimiser(&self) -> DVector<f64> {
        let inverse = self.covariance().map(|it| if it.is_finite() { it } else { 0.0 });
        -(inverse * self.r.tr_mul(&self.q))
    }

    /// By how much a step makes half the sum of squares smaller.
    pub(super) fn fall(&self, step: &DVector<f64>) -> f64 {
        0.5 * (self.q.norm_squared() - (&self.r * step + &self.q).norm_squared())
    }

    /// The step that is least in `‖R d + q‖² + λ‖D d‖²` over the free coordinates; others stay.
    pub(super) fn step(&self, lambda: f64, scale: &DVector<f64>, free: &[bool]) -> DVector<f64> {
        let n = self.r.ncols();
        let indices: Vec<usize> = (0..n).filter(|i| free[*i]).collect();
        let m = indices.len();
        let mut step = DVector::zeros(n);
        if m == 0 {
            return step;
        }
        let mut stacked = DMatrix::zeros(n + m, m);
        for (column, index) in indices.iter().enumerate() {
            stacked.view_mut((0, column), (n, 1)).copy_from(&self.r.column(*index));
            stacked[(n + column, column)] = lambda.sqrt() * scale[*index];
        }
        let mut right = DVector::zeros(n + m);
        right.rows_mut(0, n).copy_from(&(-&self.q));
        let qr = stacked.qr();
        qr.q_tr_mul(&mut right);
        if let Some(solution) = qr.r().solve_upper_triangular(&right.rows(0, m).into_owned()) {
            for (column, index) in indices.iter().enumerate() {
                step[*index] = solution[column];
            }
        }
        step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a law's derivative does not exist, nothing is known of its coordinate, and no less of the others.
    #[test]
    fn scores_that_are_no_numbers_tell_nothing_of_their_own_coordinate() {
        let h = DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 9.0]);
        let scores = [[2.0, 1.0], [-2.0, f64::NAN]].map(|it| DVector::from_row_slice(&it));
        let covariance = Linear::by_cholesky(&h, &DVector::zeros(2)).robust_covariance(&scores);
        // 8 by the scores, over 4 squared.
        assert!((covariance[(0, 0)] - 0.5).abs() < 1e-12, "{covariance}");
        assert_eq!(covariance[(1, 1)], f64::INFINITY);
        assert_eq!((covariance[(0, 1)], covariance[(1, 0)]), (0.0, 0.0));
    }
}
