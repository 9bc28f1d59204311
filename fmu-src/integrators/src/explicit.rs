//! Dormand & Prince's explicit Runge–Kutta pair of order 5(4), for systems that are not stiff.
//!
//! J. R. Dormand, P. J. Prince, A family of embedded Runge–Kutta formulae, J. Comp. Appl. Math. 6
//! (1980); the method of DOPRI5 and of MATLAB's ode45. Tsitouras' pair (2011) takes 14 % longer
//! steps for the same estimate on a smooth oscillation, but the commonest step here is as long as
//! the call allows, and then Dormand–Prince has fewer products (two weights are zero) and, measured
//! over all positions of a kink within the step, 0.6 of the error (a jump: a third).

use crate::{
    array::Array,
    control::{Stepper, Trial},
    system::System,
};

const C2: f64 = 1.0 / 5.0;
const C3: f64 = 3.0 / 10.0;
const C4: f64 = 4.0 / 5.0;
const C5: f64 = 8.0 / 9.0;

const A2: [f64; 1] = [1.0 / 5.0];
const A3: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
const A4: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
const A5: [f64; 4] = [19_372.0 / 6561.0, -25_360.0 / 2187.0, 64_448.0 / 6561.0, -212.0 / 729.0];
const A6: [f64; 5] = [9017.0 / 3168.0, -355.0 / 33.0, 46_732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18_656.0];

/// Weights of stages 1, 3, 4, 5, 6; the second stage has none.
const B: [f64; 5] = [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// Weights of stages 1, 3, 4, 5, 6, 7 in the difference to the embedded method of order 4.
const E: [f64; 6] = [
    KINKS * 71.0 / 57_600.0,
    KINKS * -71.0 / 16_695.0,
    KINKS * 71.0 / 1920.0,
    KINKS * -17_253.0 / 339_200.0,
    KINKS * 22.0 / 525.0,
    -KINKS / 40.0,
];

/// What the difference is multiplied by to estimate the error.
///
/// The difference alone is safe only where the solution is smooth. A kink or a jump in the rates
/// between the third and the fourth stage, half of all positions, changes the fourth- and the
/// fifth-order result almost alike (the weights E of stages 4 to 7 add up to 0.003): the error is
/// then 20 (median) to 60 times (90 % of the positions) what the difference shows. Eight times the
/// difference leaves 2.5 and 8, which is what the Rosenbrock method's estimate comes to. It costs
/// 8^(1/5) = 1.5 times the steps where the tolerance limits them (with a result that is more
/// accurate accordingly), and nothing where the calls are short.
const KINKS: f64 = 8.0;

/// Weights of stages 1, 3, 4, 5, 6, 7 in a second estimate, of order h^4.
///
/// Near some positions of a kink the first estimate is zero. Step control finds them: it shortens a
/// step until it is accepted, not until it is accurate. The second estimate is zero elsewhere, and
/// the larger of the two misses no kink by more than a factor of 8 (for the first alone: of 74, on
/// a grid of 199 positions). The weights of stages 5 to 7 are chosen for that, by random search,
/// and for a size that hardly matters on smooth solutions: on Van der Pol's oscillator it costs 1 %
/// of the evaluations at a relative tolerance of 1e-5, and 29 % at 1e-8, where the error is then
/// within the tolerance instead of eight times that. The other weights follow from the conditions
/// of order three.
const G: [f64; 6] = {
    let [g5, g6, g7] = [0.008, -0.019, -0.005];
    // Sums of weights times the first and the second power of the stages' times vanish.
    let first = g5 * C5 + g6 + g7;
    let second = g5 * C5 * C5 + g6 + g7;
    let g3 = (C4 * first - second) / (C3 * (C3 - C4));
    let g4 = (C3 * first - second) / (C4 * (C4 - C3));
    [-(g3 + g4 + g5 + g6 + g7), g3, g4, g5, g6, g7]
};

/// The method; it has nothing to remember.
pub(crate) struct DormandPrince;

/// `x` plus `h` times the weighted sum of the rates `k`.
///
/// The oldest rate comes first: all but the last product can be done before the newest rate is
/// known, so that one product and one sum are all that one stage waits for.
#[inline(always)]
fn stage<A: Array, const J: usize>(x: &A, h: f64, weights: &[f64; J], k: [&A; J]) -> A {
    A::from_fn(|i| {
        let mut sum = x.as_slice()[i];
        for j in 0..J {
            sum += h * weights[j] * k[j].as_slice()[i];
        }
        sum
    })
}

/// `h` times the weighted sum of the rates `k`.
#[inline(always)]
fn increment<A: Array, const J: usize>(h: f64, weights: &[f64; J], k: [&A; J]) -> A {
    A::from_fn(|i| {
        let mut sum = h * weights[0] * k[0].as_slice()[i];
        for j in 1..J {
            sum += h * weights[j] * k[j].as_slice()[i];
        }
        sum
    })
}

impl<A: Array> Stepper<A> for DormandPrince {
    const RATES: u64 = 6;
    const JACOBIANS: u64 = 0;
    const BETA: f64 = 0.04;

    #[inline(always)]
    fn begin<S: System<A>>(&mut self, _: &mut S, _: f64, _: &A) -> Result<(), usize> {
        Ok(())
    }

    #[inline(always)]
    fn step<S: System<A>>(
        &self,
        system: &mut S,
        t: f64,
        end: f64,
        h: f64,
        x: &A,
        k1: &A,
    ) -> Option<Trial<A>> {
        let k2 = system.rates(t + C2 * h, &stage(x, h, &A2, [k1]));
        let k3 = system.rates(t + C3 * h, &stage(x, h, &A3, [k1, &k2]));
        let k4 = system.rates(t + C4 * h, &stage(x, h, &A4, [k1, &k2, &k3]));
        let k5 = system.rates(t + C5 * h, &stage(x, h, &A5, [k1, &k2, &k3, &k4]));
        let k6 = system.rates(end, &stage(x, h, &A6, [k1, &k2, &k3, &k4, &k5]));
        // One sum to the state, not five: the rounding error of a million steps adds up.
        let change = increment(h, &B, [k1, &k3, &k4, &k5, &k6]);
        let y = A::from_fn(|i| x.as_slice()[i] + change.as_slice()[i]);
        let k7 = system.rates(end, &y);
        let error = increment(h, &E, [k1, &k3, &k4, &k5, &k6, &k7]);
        let guard = increment(h, &G, [k1, &k3, &k4, &k5, &k6, &k7]);
        // Not `f64::max`, which would drop a NaN.
        let larger = |e: f64, g: f64| if e.abs() < g.abs() { g } else { e };
        let error = A::from_fn(|i| larger(error.as_slice()[i], guard.as_slice()[i]));
        Some(Trial { x: y, rates: k7, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sum of weight times c^power, over the stages that have weights.
    fn moment(weights: &[f64], power: i32) -> f64 {
        let times = [0.0_f64, C3, C4, C5, 1.0, 1.0];
        weights.iter().zip(times).map(|(weight, c)| weight * c.powi(power)).sum()
    }

    #[test]
    fn stage_times_are_the_row_sums() {
        let rows: [(&[f64], f64); 5] = [(&A2, C2), (&A3, C3), (&A4, C4), (&A5, C5), (&A6, 1.0)];
        for (row, time) in rows {
            assert!((row.iter().sum::<f64>() - time).abs() < 1e-14);
        }
    }

    #[test]
    fn weights_integrate_polynomials_and_estimates_ignore_them() {
        for power in 0..5 {
            assert!((moment(&B, power) - 1.0 / f64::from(power + 1)).abs() < 1e-14);
        }
        for power in 0..4 {
            assert!(moment(&E, power).abs() < 1e-14);
        }
        for power in 0..3 {
            assert!(moment(&G, power).abs() < 1e-14);
        }
        assert!(moment(&E, 4).abs() > 1e-4 && moment(&G, 3).abs() > 1e-4);
    }

    /// The larger estimate against the true error of a kink, at every position in the step.
    #[test]
    fn no_kink_is_underestimated_by_more_than_eight() {
        let ramp = |weights: &[f64], kink: f64| -> f64 {
            let times = [0.0_f64, C3, C4, C5, 1.0, 1.0];
            weights.iter().zip(times).map(|(weight, c)| weight * (c - kink).max(0.0)).sum()
        };
        for i in 1..200 {
            let kink = f64::from(i) / 200.0;
            let error = ramp(&B, kink) - 0.5 * (1.0 - kink).powi(2);
            let estimate = ramp(&E, kink).abs().max(ramp(&G, kink).abs());
            assert!(error.abs() < 8.0 * estimate, "{kink}: {error} {estimate}");
        }
    }
}
