//! Inputs between communication points.

use strut_integrators::Array;

/// Inputs as polynomials of time: value and derivatives at the last communication point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InputPath<A> {
    value: A,
    derivatives: [A; MAX_ORDER],
    /// Time that the value belongs to.
    origin: f64,
    /// Whether any derivative is not zero.
    moving: bool,
}

/// Highest derivative of an input that a master may give.
pub(crate) const MAX_ORDER: usize = 2;

impl<A: Array> InputPath<A> {
    pub fn resting_at(value: A) -> Self {
        Self { value, derivatives: [A::zeros(); MAX_ORDER], origin: 0.0, moving: false }
    }

    /// The inputs at time `t`.
    #[inline]
    pub fn at(&self, t: f64) -> A {
        if !self.moving {
            return self.value;
        }
        let dt = t - self.origin;
        let [first, second] = self.derivatives.each_ref().map(A::as_slice);
        let value = self.value.as_slice();
        A::from_fn(|i| value[i] + dt * (first[i] + 0.5 * dt * second[i]))
    }

    /// The inputs' rates of change at time `t`.
    pub fn rates(&self, t: f64) -> A {
        let dt = t - self.origin;
        let [first, second] = self.derivatives.each_ref().map(A::as_slice);
        A::from_fn(|i| first[i] + dt * second[i])
    }

    /// Sets an input; false if it had that value already.
    #[inline]
    pub fn set(&mut self, index: usize, value: f64) -> bool {
        let place = &mut self.value.as_mut_slice()[index];
        let changed = place.to_bits() != value.to_bits();
        *place = value;
        changed
    }

    /// Sets a derivative of an input at time `now`.
    pub fn set_derivative(&mut self, index: usize, order: usize, value: f64, now: f64) {
        self.derivatives[order - 1].as_mut_slice()[index] = value;
        self.origin = now;
        self.moving = true;
    }

    /// The values and derivatives belong to time `start`.
    pub fn begin_at(&mut self, start: f64) {
        self.origin = start;
    }

    /// Ends a step at time `end`: the derivatives hold for one step, so that the inputs stay where they
    /// have led to. True if they had been moving.
    #[inline]
    pub fn settle(&mut self, end: f64) -> bool {
        if !self.moving {
            return false;
        }
        *self = Self::resting_at(self.at(end));
        true
    }

    /// All numbers, for a snapshot.
    pub fn words(&self) -> impl Iterator<Item = u64> {
        let arrays = [&self.value, &self.derivatives[0], &self.derivatives[1]];
        let numbers =
            arrays.into_iter().flat_map(|array| array.as_slice().iter().map(|number| number.to_bits()));
        numbers.chain([self.origin.to_bits(), u64::from(self.moving)])
    }

    /// From the numbers of a snapshot.
    pub fn from_words(words: &mut impl Iterator<Item = u64>) -> Option<Self> {
        let value = super::snapshot::array(words)?;
        let derivatives = [super::snapshot::array(words)?, super::snapshot::array(words)?];
        let origin = f64::from_bits(words.next()?);
        Some(Self { value, derivatives, origin, moving: super::snapshot::flag(words)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_the_taylor_polynomial_of_its_derivatives() {
        let mut path = InputPath::resting_at([2.0]);
        path.set_derivative(0, 1, 3.0, 1.0);
        path.set_derivative(0, 2, 4.0, 1.0);
        assert_eq!(path.at(1.5), [2.0 + 3.0 * 0.5 + 0.5 * 4.0 * 0.25]);
        assert_eq!(path.rates(1.5), [5.0]);
        assert!(path.settle(1.5));
        assert_eq!((path.at(9.0), path.rates(9.0)), ([4.0], [0.0]));
        assert!(!path.settle(2.0));
    }
}
