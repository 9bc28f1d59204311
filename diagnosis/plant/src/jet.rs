//! A number with its partial derivatives in a few directions, laid out for the processor's vectors.
//!
//! num-dual's vector duals do the same behind an option and by reference; in an integration they cost three times as
//! much.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use strut_model::Real;

/// A number and its derivatives in `N` directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jet<const N: usize> {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub slopes: [f64; N],
}

impl<const N: usize> Jet<N> {
    /// A function of the number, from its value and its slope there.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: std::array::from_fn(|i| slope * self.slopes[i]) }
    }

    /// `value`, and the slopes of both in proportion.
    #[inline(always)]
    fn joined(self, other: Self, value: f64, a: f64, b: f64) -> Self {
        Self { value, slopes: std::array::from_fn(|i| a * self.slopes[i] + b * other.slopes[i]) }
    }
}

/// A scalar of an integration.
pub(super) trait Scalar: Real {
    /// Its value, without derivatives.
    fn number(&self) -> f64;

    /// Its derivatives; a plain number has none.
    fn slopes(&self) -> &[f64];
}

impl Scalar for f64 {
    #[inline(always)]
    fn number(&self) -> f64 {
        *self
    }

    #[inline(always)]
    fn slopes(&self) -> &[f64] {
        &[]
    }
}

impl<const N: usize> Scalar for Jet<N> {
    #[inline(always)]
    fn number(&self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn slopes(&self) -> &[f64] {
        &self.slopes
    }
}

impl<const N: usize> From<f64> for Jet<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; N] }
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let slopes = std::array::from_fn(|i| self.slopes[i] + other.slopes[i]);
        Self { value: self.value + other.value, slopes }
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let slopes = std::array::from_fn(|i| self.slopes[i] - other.slopes[i]);
        Self { value: self.value - other.value, slopes }
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.joined(other, self.value * other.value, other.value, self.value)
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (inverse, value) = (1.0 / other.value, self.value / other.value);
        self.joined(other, value, inverse, -value * inverse)
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> AddAssign for Jet<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Jet<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> Add<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const N: usize> Sub<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl<const N: usize> Div<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.chain(self.value / other, 1.0 / other)
    }
}

impl<const N: usize> Real for Jet<N> {
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let power = Real::exp(self.value);
        self.chain(power, power)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(Real::sin(self.value), Real::cos(self.value))
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(Real::cos(self.value), -Real::sin(self.value))
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        let tangent = Real::tanh(self.value);
        self.chain(tangent, 1.0 - tangent * tangent)
    }
    #[inline(always)]
    fn select(self, then: Self, otherwise: Self) -> Self {
        if self.value > 0.0 { then } else { otherwise }
    }
    #[inline(always)]
    fn vanishes(self) -> bool {
        self.value == 0.0 && self.slopes.iter().all(|slope| *slope == 0.0)
    }
    #[inline(always)]
    fn lookup<const M: usize>(self, functions: impl Fn(f64) -> ([f64; M], [f64; M])) -> [Self; M] {
        let (values, slopes) = functions(self.value);
        std::array::from_fn(|i| self.chain(values[i], slopes[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    fn anything<R: Real>(x: R, y: R) -> R {
        let kink = (x - 0.3).select(x * y / (y.squared() + 1.0), (x - y).sin() - y.cos());
        -(kink + x.tanh() * 2.0 - (y.squared() + 0.5).sqrt() / 3.0) + (x * 0.1).exp()
    }

    proptest! {
        #[test]
        fn it_differentiates_as_num_dual_does(x in -2.0..2.0_f64, y in -2.0..2.0_f64) {
            let jet = anything(Jet { value: x, slopes: [1.0, 0.0] }, Jet { value: y, slopes: [0.0, 1.0] });
            let by_x = anything(Dual64::new(x, 1.0), Dual64::from(y));
            let by_y = anything(Dual64::from(x), Dual64::new(y, 1.0));
            prop_assert!((jet.value - by_x.re).abs() < 1e-12);
            prop_assert!((jet.slopes[0] - by_x.eps).abs() < 1e-12 && (jet.slopes[1] - by_y.eps).abs() < 1e-12);
        }
    }
}
