//! The scalar that tells what the equations switch on.
//!
//! Every kink of an equation is a [`select`](Real::select), every jump is one or a rounding. Running the equations on these numbers notes each
//! condition that moves with time, states or inputs, in the order in which they are met: an importer that integrates
//! finds the zeros of the conditions, and so the kinks, exactly. No model declares them a second time.

use std::cell::Cell;
use std::f64::consts::PI;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::Real;

/// How many conditions a model may have.
const CAPACITY: usize = 512;

thread_local! {
    // Fixed memory: nothing has to be freed when the thread ends, so that the library can be unloaded before.
    static COUNT: Cell<usize> = const { Cell::new(0) };
    static CONDITIONS: [Cell<f64>; CAPACITY] = const { [const { Cell::new(0.0) }; CAPACITY] };
}

/// When a number may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    /// At events, as constants and parameters do.
    Events,
    /// At ticks.
    Ticks,
    /// At any time.
    Anytime,
}

/// A number with when it may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Switching {
    value: f64,
    change: Change,
}

impl Switching {
    /// A parameter. The structure of the conditions may follow from it: an effect that is off has none.
    pub fn parameter(value: f64) -> Self {
        Self { value, change: Change::Events }
    }

    /// A number of a sampled memory. It moves no condition between ticks, but no effect is off because of it.
    pub fn memory(value: f64) -> Self {
        Self { value, change: Change::Ticks }
    }

    /// Time, a state or an input.
    pub fn moving(value: f64) -> Self {
        Self { value, change: Change::Anytime }
    }

    fn map(self, function: impl FnOnce(f64) -> f64) -> Self {
        Self { value: function(self.value), ..self }
    }

    fn with(self, other: Self, function: impl FnOnce(f64, f64) -> f64) -> Self {
        Self { value: function(self.value, other.value), change: self.change.max(other.change) }
    }
}

/// Runs equations on these numbers; returns how many conditions they have.
///
/// # Panics
/// If there are more than [`CAPACITY`].
pub(crate) fn observe(equations: impl FnOnce()) -> usize {
    COUNT.set(0);
    equations();
    COUNT.get()
}

/// The conditions that the last run of [`observe`] in this thread has met; the rest of the slice is left.
pub(crate) fn conditions(into: &mut [f64]) {
    CONDITIONS.with(|conditions| {
        for (value, condition) in into.iter_mut().zip(&conditions[..COUNT.get()]) {
            *value = condition.get();
        }
    });
}

fn note(condition: f64) {
    let count = COUNT.get();
    assert!(count < CAPACITY, "a model may have at most {CAPACITY} conditions that it switches on");
    // `select` asks whether the number is positive. So zero is made negative: no importer meets a zero that stays.
    let condition = if condition > 0.0 { condition } else { condition.min(-f64::MIN_POSITIVE) };
    CONDITIONS.with(|conditions| conditions[count].set(condition));
    COUNT.set(count + 1);
}

impl From<f64> for Switching {
    fn from(value: f64) -> Self {
        Self::parameter(value)
    }
}

macro_rules! impl_arithmetic {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for Switching {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(other, f64::$method)
            }
        }
        impl $operator<f64> for Switching {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.map(|value| value.$method(other))
            }
        }
    )*};
}
impl_arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Switching {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(f64::neg)
    }
}

impl AddAssign for Switching {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Switching {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Switching {
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    fn exp(self) -> Self {
        self.map(<f64 as Real>::exp)
    }
    fn sin(self) -> Self {
        self.map(<f64 as Real>::sin)
    }
    fn cos(self) -> Self {
        self.map(<f64 as Real>::cos)
    }
    fn tanh(self) -> Self {
        self.map(<f64 as Real>::tanh)
    }
    fn select(self, then: Self, otherwise: Self) -> Self {
        if self.change == Change::Anytime {
            note(self.value);
        }
        let chosen = if self.value > 0.0 { then } else { otherwise };
        Self { value: chosen.value, change: self.change.max(then.change).max(otherwise.change) }
    }
    /// Only what stays zero until the next event: the conditions keep their places in between.
    fn vanishes(self) -> bool {
        self.change == Change::Events && self.value == 0.0
    }
    /// The condition changes its sign at every whole number.
    fn floor(self) -> Self {
        if self.change == Change::Anytime {
            note(libm::sin(PI * self.value));
        }
        self.map(f64::floor)
    }
    /// The condition changes its sign midway between whole numbers.
    fn round(self) -> Self {
        if self.change == Change::Anytime {
            note(libm::cos(PI * self.value));
        }
        self.map(f64::round)
    }
    fn lookup<const N: usize>(self, functions: impl Fn(f64) -> ([f64; N], [f64; N])) -> [Self; N] {
        functions(self.value).0.map(|value| Self { value, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(equations: impl FnOnce()) -> Vec<f64> {
        let mut found = vec![0.0; observe(equations)];
        conditions(&mut found);
        found
    }

    #[test]
    fn conditions_that_move_are_noted_in_their_order() {
        let (x, p) = (Switching::moving(0.25), Switching::parameter(1.0));
        let found = seen(|| {
            let held = x.clamp(-p, p);
            let _ = held.abs() + p.abs() + Switching::memory(3.0).abs();
        });
        // The lower bound, the upper one, the sign; what parameters and memories decide is none.
        assert_eq!(found, [1.25, 0.75, 0.25]);
        assert_eq!(seen(|| _ = p.max(Switching::parameter(2.0))), []);
    }

    #[test]
    fn zero_and_no_number_are_on_the_side_that_select_takes() {
        for (value, positive) in
            [(0.0, false), (-0.0, false), (f64::NAN, false), (1e-320, true), (-1.0, false)]
        {
            let found = seen(|| _ = Switching::moving(value).abs());
            assert_eq!((found[0] > 0.0, found[0] != 0.0), (positive, true), "{value}");
        }
    }

    #[test]
    fn rounding_is_noted_where_it_jumps() {
        let side = |value: f64, round: bool| {
            let x = Switching::moving(value);
            let mut rounded = x;
            let found = seen(|| rounded = if round { x.round() } else { x.floor() });
            (found[0] > 0.0, rounded.value)
        };
        for round in [false, true] {
            let sides: Vec<_> = (0..4000).map(|k| side(0.0131 + f64::from(k) * 1e-3, round)).collect();
            for pair in sides.windows(2) {
                assert_eq!(pair[0].0 != pair[1].0, pair[0].1 != pair[1].1, "{pair:?}");
            }
        }
        assert_eq!(seen(|| _ = Switching::parameter(0.7).floor()), []);
    }

    #[test]
    fn only_what_stays_zero_vanishes() {
        assert!(Switching::parameter(0.0).vanishes());
        assert!(!Switching::parameter(1.0).vanishes());
        assert!(!Switching::memory(0.0).vanishes());
        assert!(!(Switching::moving(0.0) * 0.0).vanishes());
        let product = Switching::parameter(0.0) * Switching::parameter(3.0);
        assert!(product.vanishes());
    }

    #[test]
    fn values_are_those_of_plain_numbers() {
        fn equation<R: Real>(x: R) -> R {
            let [looked_up] = (x * 3.0).lookup(|x| ([x.floor()], [0.0]));
            (x.sqrt() + x.exp() - x.sin() * x.cos() / x.tanh()).max(x.powf(R::from(1.5))) + looked_up
        }
        assert_eq!(equation(Switching::moving(0.7)).value, equation(0.7));
    }
}
