//! The continuous algebraic Riccati equation of four states and one input, for every scalar.
//!
//! `AᵀX + XA − XGX + Q = 0` with `G = B R⁻¹ Bᵀ` is solved by the structure-preserving doubling algorithm
//! (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin, A structure-preserving doubling algorithm for continuous-time
//! algebraic Riccati equations, Linear Algebra Appl. 396 (2005)): a Cayley transform with a positive shift
//! makes a discrete equation of it, whose solution each iteration carries twice as far.
//!
//! The number of iterations is fixed and no branch depends on a value, so that derivatives and dependencies
//! pass through. The error after k iterations is of the order of ρ^(2^k), with ρ = max |(λ + γ)/(λ − γ)| over the
//! eigenvalues λ of the closed loop and the shift γ: about 1 − ζ for a mode of damping ratio ζ at the shift.
//! With [`ITERATIONS`] it is below rounding for damping ratios from about 0.1 %, and what has converged stays.

use strut_model::Real;

/// A matrix by rows.
pub type Matrix<R> = [[R; 4]; 4];
/// A column.
pub type Vector<R> = [R; 4];

/// Number of doublings.
const ITERATIONS: usize = 15;

/// `ẋ = A x + b u` with the cost `∫ xᵀ diag(q) x + r u² dt`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem<R> {
    /// State matrix A.
    pub state: Matrix<R>,
    /// Input column b.
    pub input: Vector<R>,
    /// Diagonal q of the state's weight.
    pub state_weight: Vector<R>,
    /// Weight r of the input.
    pub input_weight: R,
}

impl<R: Real> Problem<R> {
    /// The stabilising solution X. `shift` γ must be positive; it should be of the size of the eigenvalues.
    pub fn solve(&self, shift: R) -> Matrix<R> {
        let one = R::from(1.0);
        // Time in units of 1/γ and velocities, the second and fourth state, in metres per that unit: then all
        // entries of A are about one and the shift is one. G and Q occur as products only.
        let unit = [one, shift, one, shift];
        let a = from_fn(|i, j| self.state[i][j] * unit[j] / (unit[i] * shift));
        let g = from_fn(|i, j| self.coupling(i, j) / (unit[i] * unit[j] * shift));
        let h = from_fn(
            |i, j| if i == j { self.state_weight[i] * unit[i] * unit[j] / shift } else { R::from(0.0) },
        );

        // Cayley transform.
        let shifted = from_fn(|i, j| a[i][j] - R::from(f64::from(i == j)));
        let inverse = invert(&shifted);
        let w = invert(&add(&transpose(&shifted), &product(&h, &product(&inverse, &g))));
        let mut a = from_fn(|i, j| w[j][i] * 2.0 + R::from(f64::from(i == j)));
        let mut g = scale(&product(&inverse, &product(&g, &w)), 2.0);
        let mut h = scale(&product(&w, &product(&h, &inverse)), 2.0);

        for _ in 0..ITERATIONS {
            let w = invert(&from_fn(|i, j| dot(&g, &h, i, j) + R::from(f64::from(i == j))));
            let wa = product(&w, &a);
            let awg = product(&product(&a, &w), &g);
            h = add(&h, &product(&product(&transpose(&a), &h), &wa));
            g = add(&g, &product(&awg, &transpose(&a)));
            a = product(&a, &wa);
        }
        // Symmetric by nature; the mean takes what rounding has put between both halves.
        from_fn(|i, j| (h[i][j] + h[j][i]) * 0.5 / (unit[i] * unit[j]))
    }

    /// The gain `K = R⁻¹ Bᵀ X`.
    pub fn gain(&self, solution: &Matrix<R>) -> Vector<R> {
        std::array::from_fn(|j| {
            let sum = (0..4).fold(R::from(0.0), |sum, i| sum + self.input[i] * solution[i][j]);
            sum / self.input_weight
        })
    }

    fn coupling(&self, i: usize, j: usize) -> R {
        self.input[i] * self.input[j] / self.input_weight
    }
}

impl Problem<f64> {
    /// The largest entry of `AᵀX + XA − XGX + Q` relative to its largest summand, entry by entry.
    pub fn residual(&self, x: &Matrix<f64>) -> f64 {
        let ax = product(&transpose(&self.state), x);
        let gain = self.gain(x);
        let mut worst = 0.0_f64;
        for i in 0..4 {
            for j in 0..4 {
                let quadratic = gain[i] * gain[j] * self.input_weight;
                let weight = if i == j { self.state_weight[i] } else { 0.0 };
                let scale = [ax[i][i], ax[j][j], self.state_weight[i], self.state_weight[j]]
                    .into_iter()
                    .fold(quadratic.abs(), |largest, term| largest.max(term.abs()));
                let sum = ax[i][j] + ax[j][i] - quadratic + weight;
                // A comparison that NaN fails too.
                let relative = sum.abs() / scale.max(f64::MIN_POSITIVE);
                worst = if relative <= worst { worst } else { relative };
            }
        }
        worst
    }

    /// Whether `A − B K` has all eigenvalues in the left half plane (Routh–Hurwitz).
    pub fn is_stable_with(&self, gain: &Vector<f64>) -> bool {
        let closed = from_fn(|i, j| self.state[i][j] - self.input[i] * gain[j]);
        let [c3, c2, c1, c0] = characteristic(&closed);
        let b1 = c3 * c2 - c1;
        c3 > 0.0 && b1 > 0.0 && b1 * c1 > c3 * c3 * c0 && c0 > 0.0
    }
}

/// `s⁴ + c₃ s³ + c₂ s² + c₁ s + c₀` of a matrix, by Faddeev and Le Verrier.
fn characteristic(a: &Matrix<f64>) -> [f64; 4] {
    let mut m = from_fn(|i, j| f64::from(i == j));
    std::array::from_fn(|k| {
        let am = product(a, &m);
        let c = -(0..4).map(|i| am[i][i]).sum::<f64>() / (k + 1) as f64;
        m = from_fn(|i, j| am[i][j] + if i == j { c } else { 0.0 });
        c
    })
}

fn from_fn<R: Real>(f: impl Fn(usize, usize) -> R) -> Matrix<R> {
    std::array::from_fn(|i| std::array::from_fn(|j| f(i, j)))
}

fn dot<R: Real>(a: &Matrix<R>, b: &Matrix<R>, i: usize, j: usize) -> R {
    (1..4).fold(a[i][0] * b[0][j], |sum, k| sum + a[i][k] * b[k][j])
}

fn product<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    from_fn(|i, j| dot(a, b, i, j))
}

fn add<R: Real>(a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    from_fn(|i, j| a[i][j] + b[i][j])
}

fn scale<R: Real>(a: &Matrix<R>, factor: f64) -> Matrix<R> {
    from_fn(|i, j| a[i][j] * factor)
}

fn transpose<R: Real>(a: &Matrix<R>) -> Matrix<R> {
    from_fn(|i, j| a[j][i])
}

/// The inverse by Laplace expansion in 2×2 minors of the upper and lower two rows: an elimination would have
/// to choose its pivots by value.
fn invert<R: Real>(a: &Matrix<R>) -> Matrix<R> {
    let minor =
        |rows: [usize; 2], i: usize, j: usize| a[rows[0]][i] * a[rows[1]][j] - a[rows[0]][j] * a[rows[1]][i];
    const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let upper = PAIRS.map(|[i, j]| minor([0, 1], i, j));
    let lower = PAIRS.map(|[i, j]| minor([2, 3], i, j));
    let determinant = upper[0] * lower[5] - upper[1] * lower[4] + upper[2] * lower[3] + upper[3] * lower[2]
        - upper[4] * lower[1]
        + upper[5] * lower[0];
    // The minor of the columns that are not `without` and not `column`, with its sign in the expansion.
    let expand = |minors: &[R; 6], row: usize, without: usize| {
        let columns: [usize; 3] = std::array::from_fn(|place| place + usize::from(place >= without));
        let pair = |i: usize, j: usize| {
            let place = PAIRS.iter().position(|pair| *pair == [columns[i], columns[j]]);
            minors[place.unwrap_or_default()]
        };
        a[row][columns[0]] * pair(1, 2) - a[row][columns[1]] * pair(0, 2) + a[row][columns[2]] * pair(0, 1)
    };
    from_fn(|i, j| {
        // Cofactor of row j and column i.
        let cofactor = match j {
            0 => expand(&lower, 1, i),
            1 => expand(&lower, 0, i),
            2 => expand(&upper, 3, i),
            _ => expand(&upper, 2, i),
        };
        let sign = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
        cofactor * sign / determinant
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_double_integrator_chain_has_its_known_solution() {
        // ẍ = u for x and, apart from it, a stable pair: Q = diag(1, 0), R = 1 gives K = [1, √2].
        let state = [[0.0, 1.0, 0.0, 0.0], [0.0; 4], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -1.0, -1.0]];
        let problem = Problem {
            state,
            input: [0.0, 1.0, 0.0, 0.0],
            state_weight: [1.0, 0.0, 0.0, 0.0],
            input_weight: 1.0,
        };
        let gain = problem.gain(&problem.solve(1.0));
        for (found, exact) in gain.into_iter().zip([1.0, 2_f64.sqrt(), 0.0, 0.0]) {
            assert!((found - exact).abs() < 1e-13, "{gain:?}");
        }
        assert!(problem.is_stable_with(&gain) && !problem.is_stable_with(&[0.0; 4]));
    }

    proptest! {
        #[test]
        fn an_inverse_undoes(entries in prop::array::uniform4(prop::array::uniform4(-1.0..1.0_f64))) {
            let a = from_fn(|i, j| entries[i][j] + if i == j { 4.5 } else { 0.0 });
            let one = product(&a, &invert(&a));
            for (i, row) in one.iter().enumerate() {
                for (j, entry) in row.iter().enumerate() {
                    prop_assert!((entry - f64::from(i == j)).abs() < 1e-13);
                }
            }
        }
    }
}
