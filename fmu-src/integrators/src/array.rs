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
        // By the same way for all sizes: the formulas that nalgebra has for small ones are long, and each model compiles them all.
        nalgebra::try_invert_to(*self, self)
    }

    #[inline]
    fn times(&self, x: &[f64; N]) -> [f64; N] {
        (self * nalgebra::SVector::from(*x)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    }
}
