//! The scalar that every equation is written in.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use num_dual::{Dual64, DualSVec64};

/// A real number, as equations see it.
///
/// An equation is written once and read by many: with `f64` it is simulated, with dual numbers it is
/// differentiated, with [`Lanes`](crate::Lanes) it runs for several parameter sets at once, with
/// [`Dependencies`](crate::Dependencies) it tells what depends on what.
///
/// It is deliberately not ordered: a branch on a value would not be legal for lanes and would hide a
/// dependency. Write [`select`](Real::select) instead.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// Square root.
    fn sqrt(self) -> Self;
    /// e raised to the number.
    fn exp(self) -> Self;
    /// Sine (radians).
    fn sin(self) -> Self;
    /// Cosine (radians).
    fn cos(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// `then` where the number is greater than zero, `otherwise` elsewhere (and for NaN).
    ///
    /// Both values are computed; both must be finite.
    fn select(self, then: Self, otherwise: Self) -> Self;
    /// Whether the number is zero, derivatives included, so that a term multiplied by it may be left
    /// out. An effect that is switched off costs this question and nothing more.
    fn vanishes(self) -> bool;
    /// Functions that exist as numbers only: tables, measured profiles, rounding. From a number they give
    /// values and slopes.
    fn lookup<const N: usize>(self, functions: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N];

    /// Natural logarithm of a positive number.
    fn ln(self) -> Self {
        let [logarithm] = self.lookup(|number| ([libm::log(number)], [1.0 / number]));
        logarithm
    }
    /// A positive number raised to a power.
    fn powf(self, exponent: Self) -> Self {
        (self.ln() * exponent).exp()
    }
    /// The largest whole number that is not larger; its slope is zero.
    fn floor(self) -> Self {
        let [floor] = self.lookup(|number| ([number.floor()], [0.0]));
        floor
    }
    /// The nearest whole number; its slope is zero.
    fn round(self) -> Self {
        let [nearest] = self.lookup(|number| ([number.round()], [0.0]));
        nearest
    }
    /// Absolute value; its derivative at zero is taken from the left.
    fn abs(self) -> Self {
        self.select(self, -self)
    }
    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self {
        (other - self).select(self, other)
    }
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self {
        (self - other).select(self, other)
    }
    /// The number, held between two bounds.
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
    /// The number times itself.
    fn squared(self) -> Self {
        self * self
    }
}

// The functions are in Rust, not the C library's: the same bits on every platform, and no
// demand on the age of the C library.
impl Real for f64 {
    #[inline]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn sin(self) -> Self {
        libm::sin(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cos(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        crate::tanh::tanh(self)
    }
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        if self > 0.0 { then } else { otherwise }
    }
    #[inline]
    fn vanishes(self) -> bool {
        // Both zeros, by one test where a comparison of numbers takes two (NaN is a case of its own).
        self.to_bits() << 1 == 0
    }
    #[inline]
    fn lookup<const N: usize>(self, functions: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N] {
        functions(self).0
    }
}

/// A function's value at a dual number from the function's value and slope.
macro_rules! chain {
    ($number:expr, $value:expr, $slope:expr) => {{
        let mut result = $number * $slope;
        result.re = $value;
        result
    }};
}

/// The derivative-carrying scalars of num-dual: its arithmetic, our functions by the chain rule, and
/// the choice between two values by the value.
macro_rules! impl_real_for_dual {
    ($(#[$doc:meta])* [$($generics:tt)*] $dual:ty, $vanishing_derivative:expr) => {
        $(#[$doc])*
        impl<$($generics)*> Real for $dual {
            #[inline]
            fn sqrt(self) -> Self {
                let root = self.re.sqrt();
                chain!(self, root, 0.5 / root)
            }
            #[inline]
            fn exp(self) -> Self {
                let power = Real::exp(self.re);
                chain!(self, power, power)
            }
            #[inline]
            fn sin(self) -> Self {
                chain!(self, Real::sin(self.re), Real::cos(self.re))
            }
            #[inline]
            fn cos(self) -> Self {
                chain!(self, Real::cos(self.re), -Real::sin(self.re))
            }
            #[inline]
            fn tanh(self) -> Self {
                let tangent = Real::tanh(self.re);
                chain!(self, tangent, 1.0 - tangent * tangent)
            }
            #[inline]
            fn select(self, then: Self, otherwise: Self) -> Self {
                if self.re > 0.0 { then } else { otherwise }
            }
            #[inline]
            fn vanishes(self) -> bool {
                let vanishing: fn(Self) -> bool = $vanishing_derivative;
                self.re == 0.0 && vanishing(self)
            }
            #[inline]
            fn lookup<const N: usize>(self, functions: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N] {
                let (values, slopes) = functions(self.re);
                std::array::from_fn(|i| chain!(self, values[i], slopes[i]))
            }
        }
    };
}

impl_real_for_dual!(
    /// One directional derivative.
    [] Dual64, |number| number.eps == 0.0
);
impl_real_for_dual!(
    /// A gradient of `D` partial derivatives.
    [const D: usize] DualSVec64<D>,
    |number| number.eps.0.is_none_or(|gradient| gradient.iter().all(|part| *part == 0.0))
);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polynomial_with_kink<R: Real>(x: R) -> R {
        (x - 0.5).select(x.squared() * 3.0, x.sin()) + x.tanh() * x.exp() / (x.squared() + 1.0).sqrt()
    }

    proptest! {
        #[test]
        fn duals_agree_with_finite_differences(x in -3.0..3.0_f64) {
            prop_assume!((x - 0.5).abs() > 1e-3);
            let h = 1e-6;
            let difference = (polynomial_with_kink(x + h) - polynomial_with_kink(x - h)) / (2.0 * h);
            let dual = polynomial_with_kink(Dual64::new(x, 1.0));
            prop_assert!((dual.re - polynomial_with_kink(x)).abs() < 1e-12 * (1.0 + dual.re.abs()));
            prop_assert!((dual.eps - difference).abs() < 1e-6 * (1.0 + difference.abs()));
        }
    }

    proptest! {
        #[test]
        fn powers_agree_with_those_of_the_library(x in 0.1..10.0_f64, exponent in -3.0..3.0_f64) {
            let power = Real::powf(Dual64::new(x, 1.0), Dual64::from(exponent));
            prop_assert!((power.re / x.powf(exponent) - 1.0).abs() < 1e-14);
            prop_assert!((power.eps - exponent * x.powf(exponent - 1.0)).abs() < 1e-13 * power.eps.abs());
            let by_exponent = Real::powf(Dual64::from(x), Dual64::new(exponent, 1.0));
            prop_assert!((by_exponent.eps - x.ln() * x.powf(exponent)).abs() < 1e-13 * (1.0 + power.re));
        }
    }

    #[test]
    fn tanh_of_a_large_number_has_a_finite_derivative() {
        let saturated = Real::tanh(Dual64::new(1e4, 1.0));
        assert_eq!((saturated.re, saturated.eps), (1.0, 0.0));
    }

    #[test]
    fn a_looked_up_function_carries_its_slope() {
        let square_and_step = |x: f64| ([x * x, x.floor()], [2.0 * x, 0.0]);
        let [square, step] = Dual64::new(2.5, 3.0).lookup(square_and_step);
        assert_eq!((square.re, square.eps, step.re, step.eps), (6.25, 15.0, 2.0, 0.0));
        assert_eq!(2.5.lookup(square_and_step), [6.25, 2.0]);
    }

    #[test]
    fn a_zero_that_is_being_varied_does_not_vanish() {
        assert!(Dual64::from(0.0).vanishes());
        assert!(!Dual64::new(0.0, 1.0).vanishes());
    }

    #[test]
    fn clamp_keeps_to_the_bounds() {
        assert_eq!(Real::clamp(5.0, -1.0, 1.0), 1.0);
        assert_eq!(Real::clamp(-5.0, -1.0, 1.0), -1.0);
        assert_eq!(Real::clamp(0.5, -1.0, 1.0), 0.5);
    }
}
