//! Steinebach's Rosenbrock method Rodas5P, of order 5(4), for stiff systems.
//!
//! G. Steinebach, Construction of Rosenbrock–Wanner method Rodas5P and numerical benchmarks within
//! the Julia Differential Equations package, BIT Numer. Math. 63 (2023),
//! doi 10.1007/s10543-023-00967-x. Eight stages, L-stable, stiffly accurate, and without the loss of
//! order that stiff problems inflict on others. It needs the exact Jacobian, once a step, and solves
//! linear equations only: there is no iteration that could fail to converge.

use crate::{
    array::{Array, Square},
    control::{Stepper, Trial},
    system::System,
};

const STAGES: usize = 8;

const GAMMA: f64 = 0.211_937_563_194_290_14;

/// Times of the stages, as fractions of the step.
const TIMES: [f64; STAGES] = [
    0.0,
    0.635_812_689_582_870_4,
    0.409_579_839_339_753_5,
    0.976_930_672_506_071_6,
    0.428_840_360_955_866_4,
    1.0,
    1.0,
    1.0,
];

/// Weights of the derivative by time.
const BY_TIME: [f64; STAGES] = [
    GAMMA,
    -0.423_875_126_388_580_27,
    -0.338_462_712_623_592_4,
    1.804_645_287_288_273_4,
    2.325_825_639_765_069,
    0.0,
    0.0,
    0.0,
];

/// Row i: the weights of the earlier increments in the state at which stage i is evaluated. The
/// last row is also the result but for the last increment, which is the error estimate.
const A: [[f64; STAGES - 1]; STAGES] = [
    [0.0; 7],
    [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.849_394_379_747_939, 0.458_422_422_044_639_23, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-6.954_028_509_809_101, 2.489_845_061_869_568, -10.358_996_098_473_584, 0.0, 0.0, 0.0, 0.0],
    [
        2.802_998_627_562_896_4,
        0.507_246_473_622_820_6,
        -0.398_831_254_177_052_4,
        -0.047_211_872_304_046_41,
        0.0,
        0.0,
        0.0,
    ],
    [A61, A62, A63, A64, A65, 0.0, 0.0],
    [A61, A62, A63, A64, A65, 1.0, 0.0],
    [A61, A62, A63, A64, A65, 1.0, 1.0],
];

const A61: f64 = -7.502_846_399_306_121;
const A62: f64 = 2.561_846_144_803_919;
const A63: f64 = -11.627_539_656_261_098;
const A64: f64 = -0.182_687_676_599_422_56;
const A65: f64 = 0.030_198_172_008_377_946;

/// Row i: the weights of the earlier increments, divided by h, on the right-hand side of stage i.
const C: [[f64; STAGES - 1]; STAGES] = [
    [0.0; 7],
    [-14.155_112_264_123_755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-17.972_960_358_859_52, -2.859_693_295_451_294, 0.0, 0.0, 0.0, 0.0, 0.0],
    [147.121_502_757_117_16, -1.412_214_027_182_13, 71.689_402_513_023_58, 0.0, 0.0, 0.0, 0.0],
    [
        165.435_170_248_716_76,
        -0.459_282_345_649_112_6,
        42.909_383_369_586_03,
        -5.961_986_721_573_306,
        0.0,
        0.0,
        0.0,
    ],
    [
        24.854_864_614_690_072,
        -3.000_922_700_283_218_6,
        47.493_111_002_076_8,
        5.581_419_782_155_812_5,
        -0.661_069_182_524_947_1,
        0.0,
        0.0,
    ],
    [
        30.912_732_140_285_99,
        -3.120_824_334_993_797_4,
        77.799_546_460_708_92,
        34.286_460_282_947_83,
        -19.097_331_116_725_623,
        -28.087_943_162_872_662,
        0.0,
    ],
    [
        37.802_771_233_905_63,
        -3.257_196_902_907_227_6,
        112.269_188_494_963_27,
        66.934_723_124_404_7,
        -40.066_189_370_910_02,
        -54.667_802_628_779_68,
        -9.488_616_523_096_27,
    ],
];

/// The method, with the derivatives at the start of the step.
pub(crate) struct Rodas5P<X: Array> {
    jacobian: X::Square,
    by_time: X,
}

impl<X: Array> Rodas5P<X> {
    pub fn new() -> Self {
        Rodas5P { jacobian: X::Square::zeros(), by_time: X::zeros() }
    }
}

impl<X: Array> Stepper<X> for Rodas5P<X> {
    const RATES: u64 = 8;
    const JACOBIANS: u64 = 1;
    const BETA: f64 = 0.0;

    #[inline]
    fn begin<S: System<X>>(&mut self, system: &mut S, t: f64, x: &X) -> Result<(), usize> {
        (self.jacobian, self.by_time) = system.jacobian(t, x);
        // Shorter steps start from the same derivatives, so that this is the place to give up.
        for row in 0..X::LEN {
            let mut finite = self.by_time.as_slice()[row].is_finite();
            for column in 0..X::LEN {
                finite &= self.jacobian.at(row, column).is_finite();
            }
            if !finite {
                return Err(row);
            }
        }
        Ok(())
    }

    #[inline]
    fn step<S: System<X>>(
        &self,
        system: &mut S,
        t: f64,
        end: f64,
        h: f64,
        x: &X,
        rates: &X,
    ) -> Option<Trial<X>> {
        let x = x.as_slice();
        let mut inverse = X::Square::zeros();
        for row in 0..X::LEN {
            for column in 0..X::LEN {
                *inverse.at_mut(row, column) = -self.jacobian.at(row, column);
            }
            *inverse.at_mut(row, row) += 1.0 / (GAMMA * h);
        }
        if !inverse.invert() {
            return None;
        }
        let by_h = 1.0 / h;
        let mut increments = [X::zeros(); STAGES];
        let mut state = X::zeros();
        let mut f = *rates;
        for i in 0..STAGES {
            if i > 0 {
                state = X::from_fn(|n| {
                    let mut change = 0.0;
                    for (weight, increment) in A[i][..i].iter().zip(&increments) {
                        change += weight * increment.as_slice()[n];
                    }
                    x[n] + change
                });
                let time = if TIMES[i] == 1.0 { end } else { t + TIMES[i] * h };
                f = system.rates(time, &state);
            }
            let right = X::from_fn(|n| {
                let mut sum = 0.0;
                for (weight, increment) in C[i][..i].iter().zip(&increments) {
                    sum += weight * increment.as_slice()[n];
                }
                f.as_slice()[n] + by_h * sum + h * BY_TIME[i] * self.by_time.as_slice()[n]
            });
            increments[i] = inverse.times(&right);
        }
        let error = increments[STAGES - 1];
        let y = X::from_fn(|n| state.as_slice()[n] + error.as_slice()[n]);
        let rates = system.rates(end, &y);
        Some(Trial { x: y, rates, error })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SMatrix;

    use super::*;

    type Weights = SMatrix<f64, STAGES, STAGES>;

    fn matrix(rows: &[[f64; STAGES - 1]; STAGES]) -> Weights {
        Weights::from_fn(|i, j| if j < STAGES - 1 { rows[i][j] } else { 0.0 })
    }

    /// The increments of stages without a Jacobian are this matrix times h times their rates: the
    /// coefficients then are those of an explicit Runge-Kutta method, which must fit together.
    fn increments() -> Weights {
        let gamma = Weights::from_diagonal_element(1.0 / GAMMA);
        (gamma - matrix(&C)).try_inverse().expect("a triangular matrix")
    }

    #[test]
    fn times_are_the_row_sums() {
        let by_time = increments().column_sum();
        let times = (matrix(&A) * increments()).column_sum();
        for i in 0..STAGES {
            assert!((by_time[i] - BY_TIME[i]).abs() < 1e-13, "{i}");
            assert!((times[i] - TIMES[i]).abs() < 1e-13, "{i}");
        }
    }

    #[test]
    fn weights_integrate_polynomials() {
        let mut last = matrix(&A).row(STAGES - 1).into_owned();
        last[STAGES - 1] = 1.0;
        let weights = last * increments();
        let error = increments().row(STAGES - 1).into_owned();
        // Rates t^power: their derivative by time at the start is 1 for power 1, else 0.
        let integral = |weights: &SMatrix<f64, 1, STAGES>, power: i32| -> f64 {
            let slope = if power == 1 { 1.0 } else { 0.0 };
            let rate = |i: usize| TIMES[i].powi(power) + slope * BY_TIME[i];
            (0..STAGES).map(|i| weights[i] * rate(i)).sum()
        };
        for power in 0..5 {
            assert!((integral(&weights, power) - 1.0 / f64::from(power + 1)).abs() < 1e-13);
        }
        for power in 0..4 {
            assert!(integral(&error, power).abs() < 1e-13, "{power}");
        }
        assert!(integral(&error, 4).abs() > 1e-3);
    }
}
