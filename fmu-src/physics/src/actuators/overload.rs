//! The I²t limiter of a drive.

use strut_model::Real;

/// Peak current for a short time, continuous current for ever, TUM eq. 1.
///
/// The accumulator (I²T_acc) is a state of the motor that has the limiter:
/// `q' = i² − i_c²` between 0 and `Q = (i_p² − i_c²) t_p` (I²T_set). Eq. 1 switches from peak to continuous current at
/// once when q reaches Q, and back as soon as it has fallen: the current would chatter between both. Here the limit
/// moves linearly over the last part `fade` of Q, so that under a lasting demand the current settles at i_c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overload<R> {
    /// Current that is allowed for a short time (i_p).
    pub peak_current: R,
    /// Current that is allowed for ever (i_c).
    pub continuous_current: R,
    /// How long the peak current is allowed, from cold (t_p).
    pub peak_time: R,
    /// Last part of the capacity over which the limit goes from peak to continuous current.
    pub fade: R,
}

impl<R: Real> Overload<R> {
    /// Overload at which only the continuous current is left (Q).
    #[inline]
    pub fn capacity(&self) -> R {
        (self.peak_current.squared() - self.continuous_current.squared()) * self.peak_time
    }

    /// The largest current that is allowed at an overload.
    #[inline]
    pub fn current_limit(&self, capacity: R, overload: R) -> R {
        let left = (capacity - overload) / (self.fade * capacity);
        let share = left.clamp(R::from(0.0), R::from(1.0));
        self.continuous_current + (self.peak_current - self.continuous_current) * share
    }

    /// How fast a current changes the overload. Empty it cannot fall, full it cannot grow.
    #[inline]
    pub fn rate(&self, capacity: R, overload: R, current: R) -> R {
        let surplus = current.squared() - self.continuous_current.squared();
        let charging = (capacity - overload).select(surplus, surplus.min(R::from(0.0)));
        overload.select(charging, charging.max(R::from(0.0)))
    }
}

impl Overload<f64> {
    /// Refuses currents between which there is nothing to limit.
    ///
    /// # Errors
    /// A sentence with both currents.
    pub fn check(&self) -> Result<(), String> {
        if self.peak_current > self.continuous_current {
            return Ok(());
        }
        Err(format!(
            "peak_current = {} A must be larger than continuous_current = {} A: there would be no overload \
             to limit",
            self.peak_current, self.continuous_current
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The excitation motor of TUM 3.2.1: 1860 N for 1 s and 276 N with 93 N/A.
    const EXCITATION: Overload<f64> =
        Overload { peak_current: 20.0, continuous_current: 2.97, peak_time: 1.0, fade: 0.02 };

    #[test]
    fn peak_current_fills_it_in_the_peak_time() {
        let capacity = EXCITATION.capacity();
        assert!((capacity - 391.1791).abs() < 1e-9);
        assert_eq!(EXCITATION.rate(capacity, 1.0, 20.0) * EXCITATION.peak_time, capacity);
        assert_eq!(EXCITATION.current_limit(capacity, 0.0), 20.0);
        assert_eq!(EXCITATION.current_limit(capacity, capacity), 2.97);
    }

    #[test]
    fn currents_without_overload_are_refused() {
        let error = Overload { peak_current: 2.0, ..EXCITATION }.check().unwrap_err();
        assert!(error.contains("peak_current = 2 A") && error.contains("2.97 A"), "{error}");
    }

    proptest! {
        #[test]
        fn it_stays_between_empty_and_full(current in -30.0..30.0_f64) {
            let capacity = EXCITATION.capacity();
            prop_assert!(EXCITATION.rate(capacity, 0.0, current) >= 0.0);
            prop_assert!(EXCITATION.rate(capacity, capacity, current) <= 0.0);
        }

        #[test]
        fn what_it_allows_lies_between_its_currents(q in -10.0..500.0_f64) {
            let limit = EXCITATION.current_limit(EXCITATION.capacity(), q);
            prop_assert!((2.97..=20.0).contains(&limit));
        }
    }
}
