//! The scalar that tells what depends on what.

use std::ops::{Add, AddAssign, BitOr, Div, Mul, Neg, Sub, SubAssign};

use crate::Real;

/// Number of 64-bit words of the set.
const WORDS: usize = 6;

/// A set of known quantities, used as a number: every operation yields the union of its operands'
/// sets, a constant is the empty set.
///
/// Running an equation on these gives its structural dependencies, whatever the values: both sides of
/// a [`select`](Real::select) and its condition count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Dependencies([u64; WORDS]);

impl Dependencies {
    /// How many quantities can be told apart.
    pub const CAPACITY: usize = WORDS * u64::BITS as usize;

    /// The set of quantity number `index`.
    ///
    /// # Panics
    /// If `index` is not below [`CAPACITY`](Self::CAPACITY).
    pub fn on(index: usize) -> Self {
        assert!(index < Self::CAPACITY, "a model may have at most {} known quantities", Self::CAPACITY);
        let mut words = [0; WORDS];
        words[index / 64] = 1 << (index % 64);
        Self(words)
    }

    /// Whether quantity number `index` is in the set.
    pub fn contains(self, index: usize) -> bool {
        self.0[index / 64] >> (index % 64) & 1 == 1
    }
}

impl BitOr for Dependencies {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] | other.0[i]))
    }
}

impl From<f64> for Dependencies {
    fn from(_: f64) -> Self {
        Self::default()
    }
}

macro_rules! impl_union {
    ($($operator:ident $method:ident),*) => {$(
        #[expect(clippy::suspicious_arithmetic_impl, reason = "every operation is a union")]
        impl $operator for Dependencies {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self | other
            }
        }
        impl $operator<f64> for Dependencies {
            type Output = Self;
            fn $method(self, _: f64) -> Self {
                self
            }
        }
    )*};
}
impl_union!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Dependencies {
    type Output = Self;
    fn neg(self) -> Self {
        self
    }
}

impl AddAssign for Dependencies {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dependencies {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Dependencies {
    fn sqrt(self) -> Self {
        self
    }
    fn exp(self) -> Self {
        self
    }
    fn sin(self) -> Self {
        self
    }
    fn cos(self) -> Self {
        self
    }
    fn tanh(self) -> Self {
        self
    }
    fn select(self, then: Self, otherwise: Self) -> Self {
        self | then | otherwise
    }
    /// Never: that an effect is off now does not mean that it stays off.
    fn vanishes(self) -> bool {
        false
    }
    fn lookup<const N: usize>(self, _: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N] {
        [self; N]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_unite_and_constants_add_nothing() {
        let (a, b, c) = (Dependencies::on(0), Dependencies::on(70), Dependencies::on(383));
        let set = c.select((a * 2.0).sin(), b + Dependencies::from(1.0));
        for index in 0..Dependencies::CAPACITY {
            assert_eq!(set.contains(index), [0, 70, 383].contains(&index));
        }
    }
}
