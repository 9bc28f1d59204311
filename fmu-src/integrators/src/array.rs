//! Fixed-size arrays as the integrators see them.

use std::fmt::Debug;

use nalgebra::SMatrix;

/// An array whose length is part of its type, `[f64; N]`.
///
/// A model's state length follows from its declared variables, so that it is an associated type and
/// not a constant that generic code could write `[f64; N]` with. This trait is that `[f64; N]`.
pub trait Array: Copy + Debug + PartialEq + Send + 'static {
    /// Number of elements.
    const LEN: usize;
    /// The square matrix that maps this array to one of its own kind.
    type Square: Square<Self>;

    /// All elements zero.
    fn zeros() -> Self;
    /// Element `i` is `f(i)`.
    fn from_fn(f: impl FnMut(usize) -> f64) -> Self;
    /// The elements.
    fn as_slice(&self) -> &[f64];
    /// The elements, to change them.
    fn as_mut_slice(&mut self) -> &mut [f64];
}

/// A square matrix, as the implicit integrator needs it.
pub trait Square<A>: Copy + Debug + PartialEq + Send + 'static {
    /// All entries zero.
    fn zeros() -> Self;
    /// Entry at `row`, `column`.
    fn at(&self, row: usize, column: usize) -> f64;
    /// The entry at `row`, `column`, to change it.
    fn at_mut(&mut self, row: usize, column: usize) -> &mut f64;
    /// Replaces the matrix by its inverse; false (and unspecified contents) if it is singular.
    fn invert(&mut self) -> bool;
    /// Matrix times vector.
    fn times(&self, x: &A) -> A;
}

impl<const N: usize> Array for [f64; N] {
    const LEN: usize = N;
    type Square = SMatrix<f64, N, N>;

    #[inline]
    fn zeros() -> Self {
        [0.0; N]
    }

    #[inline]
    fn from_fn(mut f: impl FnMut(usize) -> f64) -> Self {
        let mut array = [0.0; N];
        for (i, element) in array.iter_mut().enumerate() {
            *element = f(i);
        }
        array
    }

    #[inline]
    fn as_slice(&self) -> &[f64] {
        self
    }

    #[inline]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}

impl<const N: usize> Square<[f64; N]> for SMatrix<f64, N, N> {
    #[inline]
    fn zeros() -> Self {
        SMatrix::zeros()
    }

    #[inline]
    fn at(&self, row: usize, column: usize) -> f64 {
        self[(row, column)]
    }

    #[inline]
    fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self[(row, column)]
    }

    fn invert(&mut self) -> bool {
        invert(self)
    }

    #[inline]
    fn times(&self, x: &[f64; N]) -> [f64; N] {
        (self * nalgebra::SVector::from(*x)).into()
    }
}

/// Gauss–Jordan elimination in place with partial pivoting (Golub and Van Loan, Matrix Computations, 4th ed., section 3.4). For
/// matrices of up to a dozen rows, whose size the compiler knows, loops over all entries are faster than nalgebra's elimination. Its
/// formulas for up to four rows take the compiler long, for each model again.
fn invert<const N: usize>(matrix: &mut SMatrix<f64, N, N>) -> bool {
    let mut pivots = [0; N];
    for k in 0..N {
        let mut pivot = k;
        for row in k + 1..N {
            if matrix[(row, k)].abs() > matrix[(pivot, k)].abs() {
                pivot = row;
            }
        }
        let head = matrix[(pivot, k)];
        // Entries that are not finite have no inverse either.
        if head == 0.0 || !head.is_finite() {
            return false;
        }
        pivots[k] = pivot;
        if pivot != k {
            matrix.swap_rows(k, pivot);
        }
        matrix[(k, k)] = 1.0;
        let scale = 1.0 / head;
        for column in 0..N {
            matrix[(k, column)] *= scale;
        }
        for row in 0..N {
            if row != k {
                let factor = std::mem::take(&mut matrix[(row, k)]);
                for column in 0..N {
                    matrix[(row, column)] -= factor * matrix[(k, column)];
                }
            }
        }
    }
    for (k, pivot) in pivots.into_iter().enumerate().rev() {
        if pivot != k {
            matrix.swap_columns(k, pivot);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Random matrices are hardly ever near a singular one; their rows come in any order.
        #[test]
        fn inverse_and_matrix_make_one(entries in prop::array::uniform25(-1.0..1.0_f64)) {
            let matrix = SMatrix::<f64, 5, 5>::from_row_slice(&entries);
            let mut inverse = matrix;
            prop_assert!(inverse.invert());
            let condition = matrix.norm() * inverse.norm();
            let product = inverse * matrix - SMatrix::<f64, 5, 5>::identity();
            prop_assert!(product.norm() < 1e-13 * condition, "{product}");
        }
    }

    #[test]
    fn rows_are_exchanged_where_the_diagonal_is_zero() {
        let mut matrix = SMatrix::<f64, 3, 3>::from_row_slice(&[0.0, 2.0, 0.0, 0.0, 0.0, 4.0, 1.0, 0.0, 0.0]);
        assert!(matrix.invert());
        assert_eq!(
            matrix,
            SMatrix::<f64, 3, 3>::from_row_slice(&[0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.25, 0.0])
        );
    }

    #[test]
    fn inverse_times_matrix_is_identity() {
        let mut m = <[f64; 3] as Array>::Square::zeros();
        for (i, v) in [4.0, 1.0, 0.5, -2.0, 3.0, 0.1, 0.0, 1.0, 2.0].into_iter().enumerate() {
            *m.at_mut(i / 3, i % 3) = v;
        }
        let x = [1.0, -2.0, 3.0];
        let y = m.times(&x);
        let mut inverse = m;
        assert!(inverse.invert());
        for (a, b) in inverse.times(&y).iter().zip(x) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn a_singular_matrix_is_reported() {
        assert!(!<[f64; 2] as Array>::Square::zeros().invert());
        assert!(!SMatrix::<f64, 2, 2>::new(f64::NAN, 1.0, f64::NAN, 1.0).invert());
    }
}
