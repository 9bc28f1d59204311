//! Characteristics that are given as points, the points being parameters.

use strut_model::Real;

/// A piecewise linear function through N points with increasing abscissas, N ≥ 2.
///
/// It is a sum over all pieces, not a search: the points carry derivatives like any parameter, and several
/// parameter sets at once may have their arguments in different pieces.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a, R, const N: usize> {
    /// Abscissas.
    pub x: &'a [R; N],
    /// Ordinates.
    pub y: &'a [R; N],
}

impl<R: Real, const N: usize> Table<'_, R, N> {
    /// The value at `x`; beyond the ends that of the end.
    #[inline]
    pub fn held(&self, x: R) -> R {
        self.sum(|piece| self.not_beyond(piece, self.not_before(piece, x)))
    }

    /// The value at `x`; beyond the ends with the slope of the last piece.
    #[inline]
    pub fn extended(&self, x: R) -> R {
        self.sum(|piece| {
            let x = if piece == 0 { x } else { self.not_before(piece, x) };
            if piece == N - 2 { x } else { self.not_beyond(piece, x) }
        })
    }

    // A point belongs to the piece that starts there and to no other: there, too, the derivative is a slope of
    // the table, the one to the right.

    #[inline]
    fn not_before(&self, piece: usize, x: R) -> R {
        let start = self.x[piece];
        (start - x).select(start, x)
    }

    #[inline]
    fn not_beyond(&self, piece: usize, x: R) -> R {
        let end = self.x[piece + 1];
        (end - x).select(x, end)
    }

    /// The increments of all pieces up to where each piece is left.
    #[inline]
    fn sum(&self, left_at: impl Fn(usize) -> R) -> R {
        (0..N - 1).fold(self.y[0], |sum, piece| {
            let slope = (self.y[piece + 1] - self.y[piece]) / (self.x[piece + 1] - self.x[piece]);
            sum + slope * (left_at(piece) - self.x[piece])
        })
    }
}

/// Refuses points that do not increase from one to the next.
///
/// # Errors
/// A sentence with the name of the table, the two values and what must hold.
pub fn check_increasing(name: &str, points: &[f64]) -> Result<(), String> {
    // What cannot be compared does not increase either.
    let increases = |pair: &[f64]| pair[0].partial_cmp(&pair[1]) == Some(std::cmp::Ordering::Less);
    match points.windows(2).position(|pair| !increases(pair)) {
        None => Ok(()),
        Some(i) => Err(format!(
            "{name}[{}] = {} must be larger than {name}[{}] = {}: the values of a table increase",
            i + 2,
            points[i + 1],
            i + 1,
            points[i]
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    const X: [f64; 4] = [-1.0, 0.0, 2.0, 3.0];
    const Y: [f64; 4] = [5.0, 1.0, 2.0, -1.0];
    const TABLE: Table<'static, f64, 4> = Table { x: &X, y: &Y };

    #[test]
    fn it_goes_through_its_points() {
        for (x, y) in X.into_iter().zip(Y) {
            assert_eq!((TABLE.held(x), TABLE.extended(x)), (y, y));
        }
        assert_eq!((TABLE.held(1.0), TABLE.extended(1.0)), (1.5, 1.5));
        assert_eq!((TABLE.held(4.0), TABLE.extended(4.0)), (-1.0, -4.0));
        assert_eq!((TABLE.held(-2.0), TABLE.extended(-2.0)), (5.0, 9.0));
    }

    #[test]
    fn points_carry_derivatives() {
        let mut y = Y.map(Dual64::from);
        y[2] = y[2].derivative();
        let table = Table { x: &X.map(Dual64::from), y: &y };
        assert_eq!(table.held(Dual64::from(1.5)).eps, 0.75);
    }

    #[test]
    fn at_a_point_the_slope_is_the_one_to_the_right() {
        let table = Table { x: &X.map(Dual64::from), y: &Y.map(Dual64::from) };
        for (x, slope, beyond) in [(-1.0, -4.0, -4.0), (0.0, 0.5, 0.5), (2.0, -3.0, -3.0), (3.0, 0.0, -3.0)] {
            let x = Dual64::new(x, 1.0);
            assert_eq!((table.held(x).eps, table.extended(x).eps), (slope, beyond));
        }
    }

    #[test]
    fn points_that_do_not_increase_are_named() {
        assert_eq!(check_increasing("flow", &[0.0, 1.0, 2.0]), Ok(()));
        let error = check_increasing("flow", &[0.0, 1.0, 1.0]).unwrap_err();
        assert!(error.contains("flow[3] = 1 must be larger than flow[2] = 1"), "{error}");
        assert!(check_increasing("flow", &[0.0, f64::NAN]).is_err());
    }

    proptest! {
        #[test]
        fn it_keeps_between_neighbouring_points(x in -1.0..3.0_f64) {
            let piece = X.iter().rposition(|&knot| knot <= x).unwrap().min(2);
            let (low, high) = (Y[piece].min(Y[piece + 1]), Y[piece].max(Y[piece + 1]));
            let y = TABLE.held(x);
            prop_assert!((low - 1e-12..=high + 1e-12).contains(&y) && y == TABLE.extended(x));
        }
    }
}
