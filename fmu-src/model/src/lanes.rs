//! The scalar that runs four parameter sets at once.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use wide::f64x4;

use crate::Real;

/// Four numbers in one SIMD register: the same equation for four parameter sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes(f64x4);

impl Lanes {
    /// How many numbers there are.
    pub const COUNT: usize = 4;

    /// From one number per lane.
    pub fn new(lanes: [f64; Self::COUNT]) -> Self {
        Self(f64x4::from(lanes))
    }

    /// The number of each lane.
    pub fn to_array(self) -> [f64; Self::COUNT] {
        self.0.to_array()
    }
}

impl From<f64> for Lanes {
    fn from(number: f64) -> Self {
        Self(f64x4::splat(number))
    }
}

macro_rules! impl_lanewise {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl $operator<f64> for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(f64x4::splat(other)))
            }
        }
    )*};
}
impl_lanewise!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Lanes {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Lanes {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Lanes {
    #[inline]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline]
    fn exp(self) -> Self {
        Self(self.0.exp())
    }
    #[inline]
    fn sin(self) -> Self {
        Self(self.0.sin_cos().0)
    }
    #[inline]
    fn cos(self) -> Self {
        Self(self.0.sin_cos().1)
    }
    #[inline]
    fn tanh(self) -> Self {
        Self(self.0.tanh())
    }
    #[inline]
    fn select(self, then: Self, otherwise: Self) -> Self {
        Self(self.0.simd_gt(f64x4::ZERO).select(then.0, otherwise.0))
    }
    #[inline]
    fn vanishes(self) -> bool {
        self.to_array() == [0.0; Self::COUNT]
    }
    fn lookup<const N: usize>(self, functions: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N] {
        let lanes = self.to_array().map(|number| functions(number).0);
        std::array::from_fn(|i| Self::new(lanes.map(|values| values[i])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn law<R: Real>(x: R) -> R {
        (x * 2.0 - 1.0).select(x.tanh() * x.sin(), (x.squared() + 0.1).sqrt() / (x.cos() + 3.0)) + (-x).exp()
    }

    proptest! {
        #[test]
        fn each_lane_is_the_scalar_result(x in prop::array::uniform4(-4.0..4.0_f64)) {
            for (lane, x) in law(Lanes::new(x)).to_array().into_iter().zip(x) {
                prop_assert!((lane - law(x)).abs() < 1e-12 * (1.0 + lane.abs()), "{lane} {}", law(x));
            }
        }
    }

    #[test]
    fn all_lanes_must_vanish() {
        assert!(Lanes::from(0.0).vanishes());
        assert!(!Lanes::new([0.0, 0.0, 1.0, 0.0]).vanishes());
    }
}
