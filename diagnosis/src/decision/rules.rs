//! Rules that hold whatever the method: nothing is identified whose interval holds zero or that stands at a bound.

use super::criteria::CRITERIA;

/// Share of a bound within which a value stands at it: a fit comes ever closer, and never arrives.
const AT: f64 = 0.01;

/// How large an effect is, and how sure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    /// Its value, in the parameter's unit, beyond that of the model without it.
    pub value: f64,
    /// Lower and upper end of what is possible.
    pub bounds: (f64, f64),
    /// Half the interval in which it is.
    pub half: f64,
}

impl Amount {
    /// Whether it is something, and not as much as may be.
    pub fn is_determined(&self) -> bool {
        let (low, high) = (self.bounds.0 * (1.0 - AT), self.bounds.1 * (1.0 - AT));
        let inside = (self.value > low || low == 0.0) && self.value < high;
        inside && self.value.is_finite() && self.value.abs() > self.half
    }
}

/// Whether an effect is determined by its amounts: a sum is, if one of its addends is.
pub fn is_determined(amounts: &[Amount]) -> bool {
    amounts.is_empty() || amounts.iter().any(Amount::is_determined)
}

/// Fall of a signal's fit that an effect may cost.
pub const FALL: f64 = CRITERIA.background * CRITERIA.improvement;

/// Whether some signal's fit falls, or runs away.
pub fn lowers(before: &[f64], after: &[f64]) -> bool {
    before.iter().zip(after).any(|(before, after)| !after.is_finite() || before - after > FALL)
}

/// Whether a diagnosis over shorter stretches is told in place of one over longer ones, given whether each says of something that it is
/// missing. Over shorter stretches the states at the start take up what is slow: that nothing is missing there takes nothing back.
pub fn tells_more(shorter: bool, longer: bool) -> bool {
    shorter || !longer
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_may_be_nothing_or_stands_at_a_bound_is_not_determined(
            value in -10.0..10.0_f64, half in 0.0..20.0_f64, bound in 0.1..20.0_f64,
        ) {
            let amount = Amount { value, bounds: (-bound, bound), half };
            if amount.is_determined() {
                prop_assert!(value - half > 0.0 || value + half < 0.0);
                prop_assert!(value > -0.99 * bound && value < 0.99 * bound);
            }
            let free = Amount { bounds: (f64::NEG_INFINITY, f64::INFINITY), ..amount };
            prop_assert_eq!(free.is_determined(), value.abs() > half);
            let unknown = Amount { half: f64::INFINITY, ..free };
            prop_assert!(!unknown.is_determined());
        }
    }

    #[test]
    fn nothing_over_short_stretches_takes_nothing_back() {
        assert!(!tells_more(false, true));
        assert!(tells_more(false, false) && tells_more(true, true) && tells_more(true, false));
    }

    #[test]
    fn what_costs_a_signal_its_fit_is_harmful() {
        assert!(!lowers(&[0.5, 0.9], &[0.8, 0.89]));
        assert!(lowers(&[0.5, 0.9], &[0.8, 0.8]));
        assert!(lowers(&[0.5], &[-5e51]) && lowers(&[0.5], &[f64::NAN]) && lowers(&[-3.0], &[-7.0]));
        assert!(!lowers(&[-7.0], &[-3.0]));
    }

    #[test]
    fn a_sum_is_determined_by_one_of_its_addends() {
        let sure = Amount { value: 2.0, bounds: (-5.0, 5.0), half: 1.0 };
        let unsure = Amount { half: 3.0, ..sure };
        assert!(is_determined(&[unsure, sure]) && !is_determined(&[unsure, unsure]));
        // A choice of the model has no amount.
        assert!(is_determined(&[]));
    }
}
