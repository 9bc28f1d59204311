//! The evidence for an effect, and what it has to exceed.

use serde::Serialize;

use super::criteria::CRITERIA;

/// What a fit leaves of a signal on some data and another effect would leave, in roots of mean squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// Of the fit's error.
    pub error: f64,
    /// Of the starting model's error.
    pub before: f64,
    /// Of the error that would be left: of the sensor's noise at least.
    pub left: f64,
    /// Of what the model has to tell of the signal.
    pub signal: f64,
}

impl Left {
    /// Whether the effect would matter. Where none would in any signal that left nothing but noise, a search has nothing to find.
    pub fn may_matter(&self) -> bool {
        let taken = self.error.powi(2) - self.left.powi(2);
        let evidence = Evidence {
            variance_explained: taken / self.before.powi(2),
            fit_improvement: (self.error - self.left) / self.signal,
            residual_reduction: taken / self.error.powi(2),
            ..Evidence::default()
        };
        taken > 0.0 && evidence.smallness().is_none()
    }
}

/// Why a gate does not have to be passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waiver {
    /// Nearly all of the error goes, so that the improvement is as uneven as the error was.
    Bulk,
    /// The validation data, which chose nothing, rule chance out on their own.
    Validated,
    /// More than half of what was left goes.
    Most,
    /// So much of the starting model's error goes that chance is no question.
    ByFar,
}

/// Why an effect is believed: every gate that it went through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Evidence {
    /// Fall of the Bayesian information criterion, samples counted as far as they are independent.
    pub delta_bic: f64,
    /// Student's t of the gain over the blocks of the estimation data.
    pub estimation_t: f64,
    /// Chance that of as many effects as were compared the best one's gain is as steady, where none of them is there.
    pub p_value: f64,
    /// Student's t of the gain over the blocks of the validation data.
    pub validation_t: f64,
    /// Chance that of as many effects as were compared the best one's gain on the validation data is as steady, where none of them
    /// is there.
    pub validation_p_value: f64,
    /// Share of the starting model's error power that it explains on the validation data.
    pub variance_explained: f64,
    /// Largest rise of Φ among the signals, on the estimation or the validation data, whichever is less.
    pub fit_improvement: f64,
    /// Share that it takes away of the error's power that was left without it, on the estimation or the validation data,
    /// whichever is less.
    pub residual_reduction: f64,
    /// Whether every rig has a little of it, so that more of it is asked for.
    pub background: bool,
    /// Whether every rig has it: it is not one of many that are tried, so that nothing but the data speaks against it.
    pub expected: bool,
}

impl Evidence {
    /// What has to be exceeded, in every gate; the chance must not be. The information criterion alone is never the verdict: small unmodelled
    /// effects pass it on every record.
    ///
    /// A rise of the fit is enough to matter, however wrong the starting model was. So is more than half of the missing signal, if that is
    /// worth a name.
    pub const REQUIRED: Self = Self {
        delta_bic: CRITERIA.bic,
        estimation_t: CRITERIA.estimation_t,
        p_value: CRITERIA.p_value,
        validation_t: CRITERIA.validation_t,
        validation_p_value: CRITERIA.p_value,
        variance_explained: CRITERIA.explained,
        fit_improvement: CRITERIA.improvement,
        residual_reduction: CRITERIA.majority,
        background: false,
        expected: false,
    };

    /// What has to be exceeded here: a larger size of what every rig has a little of, and any fall of the criterion of what
    /// every rig has or where chance is ruled out.
    pub fn required(&self) -> Self {
        let more = if self.background { CRITERIA.background } else { 1.0 };
        Self {
            fit_improvement: more * CRITERIA.improvement,
            delta_bic: if self.expected || self.is_beyond_chance() { 0.0 } else { CRITERIA.bic },
            ..Self::REQUIRED
        }
    }

    /// Whether it takes most of the error away, and so steadily on the validation data, which chose nothing, that chance cannot. Errors
    /// that hang together over a whole record, as those of a drift do, are few for a criterion that counts them.
    fn is_beyond_chance(&self) -> bool {
        self.residual_reduction > CRITERIA.majority && self.validation_p_value < CRITERIA.p_value
    }

    /// Whether it takes most of the error away, however small that is.
    pub fn takes_the_bulk(&self) -> bool {
        self.residual_reduction > CRITERIA.bulk
    }

    /// Whether so much of the error on validation data goes that chance is no question, however few the blocks are.
    pub fn is_no_chance(&self) -> Option<Waiver> {
        let most_of_what_was_left = self.residual_reduction > self.required().residual_reduction
            && self.validation_t > CRITERIA.certain;
        let by_far = self.variance_explained > CRITERIA.by_far && self.validation_t > 0.0;
        let most = most_of_what_was_left.then_some(Waiver::Most);
        most.or(by_far.then_some(Waiver::ByFar))
    }

    /// The first gate that is not passed, in words.
    pub fn refusal(&self) -> Option<String> {
        self.doubt().or_else(|| self.smallness())
    }

    /// Whether it is there, and too small to matter.
    pub fn is_small(&self) -> bool {
        self.doubt().is_none() && self.smallness().is_some()
    }

    /// Whether it passes beside another effect that has passed: whether anything is there is no question then, and its gains
    /// may be less steady.
    pub fn passes_beside_another(&self) -> bool {
        let steady = self.estimation_t > CRITERIA.certain;
        steady && Self { estimation_t: f64::INFINITY, p_value: 0.0, ..*self }.refusal().is_none()
    }

    /// Whether a small Student's t over the estimation data is enough: it takes so much away that its gains are as uneven as the
    /// errors were, or the validation data, which chose nothing, rule chance out on their own.
    pub fn is_steady_enough(&self) -> Option<Waiver> {
        let bulk = self.takes_the_bulk() && self.estimation_t > CRITERIA.certain;
        let validated =
            self.validation_p_value < self.required().validation_p_value && self.estimation_t > 0.0;
        bulk.then_some(Waiver::Bulk).or(validated.then_some(Waiver::Validated))
    }

    /// Whether the validation data show it, and enough of it to matter, while the estimation data leave doubt: their errors hang
    /// together so much that they are few independent ones.
    pub fn is_nearest(&self) -> bool {
        self.doubt().is_some()
            && self.smallness().is_none()
            && self.validation_t > self.required().validation_t
    }

    /// The first gate that is not passed of those that tell whether it is there at all.
    pub fn doubt(&self) -> Option<String> {
        let Self { delta_bic, estimation_t, p_value, validation_t, variance_explained, .. } = *self;
        let required = self.required();
        if !variance_explained.is_finite() {
            Some("diverges on the validation data".to_owned())
        } else if delta_bic.is_nan() || delta_bic <= required.delta_bic {
            let moves = if delta_bic < 0.0 {
                format!("rises by {:.0}", -delta_bic)
            } else {
                format!("falls by {delta_bic:.0} instead of {:.0}", required.delta_bic)
            };
            Some(format!("explains too little for its parameters (the BIC {moves})"))
        } else if !(estimation_t > required.estimation_t || self.is_steady_enough().is_some()) {
            Some(format!("no consistent improvement on the estimation data (t = {estimation_t:.1})"))
        } else if !(p_value < required.p_value || self.is_steady_enough().is_some()) {
            Some(format!("the improvement may be chance (p-value {p_value:.2})"))
        } else if !(validation_t > required.validation_t || self.is_no_chance().is_some()) {
            Some(format!("no improvement on the validation data (t = {validation_t:.1})"))
        } else {
            None
        }
    }

    /// The first gate that is not passed of those that tell whether it matters.
    fn smallness(&self) -> Option<String> {
        let Self { variance_explained, fit_improvement, residual_reduction, .. } = *self;
        let required = self.required();
        if fit_improvement > required.fit_improvement {
            None
        } else if variance_explained <= required.variance_explained {
            Some(format!(
                "below the smallest improvement of interest ({:.1} % of the error)",
                100.0 * variance_explained
            ))
        } else if residual_reduction <= required.residual_reduction {
            Some(format!(
                "below the smallest improvement of interest (the fit rises by {fit_improvement:.3}, residual reduction {:.0} %)",
                100.0 * residual_reduction
            ))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLEAR: Evidence = Evidence {
        delta_bic: 100.0,
        estimation_t: 8.0,
        p_value: 1e-6,
        validation_t: 6.0,
        validation_p_value: 1e-4,
        variance_explained: 0.2,
        fit_improvement: 0.1,
        residual_reduction: 0.4,
        background: false,
        expected: false,
    };

    #[test]
    fn validation_data_that_rule_chance_out_need_no_steadiness_of_the_estimation_data() {
        assert_eq!(CLEAR.refusal(), None);
        let uneven = Evidence { estimation_t: 1.3, p_value: 1.0, ..CLEAR };
        assert_eq!(uneven.refusal(), None);
        assert!(Evidence { validation_p_value: 0.02, ..uneven }.refusal().is_some());
        // What makes the estimation data worse is not there, whatever the validation data say.
        assert!(Evidence { estimation_t: -0.1, ..uneven }.refusal().is_some());
        assert!(Evidence { delta_bic: 5.0, ..uneven }.refusal().is_some());
    }

    #[test]
    fn each_waiver_has_its_own_reason() {
        let bulk = Evidence { residual_reduction: 0.8, ..CLEAR };
        assert_eq!(bulk.is_steady_enough(), Some(Waiver::Bulk));
        assert_eq!(CLEAR.is_steady_enough(), Some(Waiver::Validated));
        assert_eq!(Evidence { validation_p_value: 0.02, ..CLEAR }.is_steady_enough(), None);
        assert_eq!(Evidence { residual_reduction: 0.6, ..CLEAR }.is_no_chance(), Some(Waiver::Most));
        assert_eq!(Evidence { variance_explained: 0.3, ..CLEAR }.is_no_chance(), Some(Waiver::ByFar));
        assert_eq!(CLEAR.is_no_chance(), None);
    }

    #[test]
    fn every_gate_refuses_on_its_own() {
        for one in [
            Evidence { delta_bic: 19.0, ..CLEAR },
            Evidence { estimation_t: 3.0, validation_p_value: 0.02, ..CLEAR },
            Evidence { p_value: 0.02, validation_p_value: 0.02, ..CLEAR },
            Evidence { validation_t: 2.9, ..CLEAR },
            Evidence { fit_improvement: 0.014, residual_reduction: 0.6, variance_explained: 0.009, ..CLEAR },
            Evidence { fit_improvement: 0.014, ..CLEAR },
            Evidence { fit_improvement: 0.02, background: true, ..CLEAR },
            Evidence { variance_explained: f64::NEG_INFINITY, ..CLEAR },
        ] {
            assert!(one.refusal().is_some(), "{one:?}");
        }
    }

    #[test]
    fn errors_that_are_noise_leave_nothing_to_find() {
        let left = Left { error: 0.02, before: 0.5, left: 0.02, signal: 1.0 };
        assert!(!left.may_matter());
        // A visible rise of the fit, or most of an error that is worth a name.
        assert!(Left { error: 0.036, ..left }.may_matter());
        assert!(!Left { error: 0.034, before: 2.0, ..left }.may_matter());
        assert!(Left { error: 0.034, before: 0.1, ..left }.may_matter());
        assert!(!Left { error: 0.028, before: 0.1, ..left }.may_matter());
        assert!(!Left { signal: 0.0, before: 0.0, error: 0.0, left: 0.0 }.may_matter());
    }

    #[test]
    fn where_chance_is_ruled_out_errors_that_hang_together_need_not_be_many() {
        let drift = Evidence { delta_bic: 2.0, residual_reduction: 0.96, ..CLEAR };
        assert_eq!(drift.refusal(), None);
        assert!(Evidence { delta_bic: -1.0, ..drift }.refusal().is_some());
        assert!(Evidence { residual_reduction: 0.5, ..drift }.refusal().is_some());
        assert!(Evidence { validation_p_value: 0.02, ..drift }.refusal().is_some());
    }

    #[test]
    fn a_starting_model_that_is_far_off_hides_nothing() {
        let beside_a_wrong_sign = Evidence { variance_explained: 0.002, ..CLEAR };
        assert_eq!(beside_a_wrong_sign.refusal(), None);
        let most = Evidence { fit_improvement: 0.014, residual_reduction: 0.6, ..CLEAR };
        assert_eq!(most.refusal(), None);
        assert!(Evidence { variance_explained: 0.002, ..most }.refusal().is_some());
    }

    #[test]
    fn what_every_rig_has_needs_no_more_than_that_the_criterion_falls() {
        let few = Evidence { delta_bic: 0.5, ..CLEAR };
        assert!(few.refusal().is_some());
        assert_eq!(Evidence { expected: true, ..few }.refusal(), None);
        assert!(Evidence { expected: true, delta_bic: -0.1, ..few }.refusal().is_some());
        assert!(Evidence { expected: true, fit_improvement: 0.014, ..few }.refusal().is_some());
    }

    #[test]
    fn what_only_the_validation_data_show_comes_nearest() {
        let doubted = Evidence { delta_bic: 1.0, ..CLEAR };
        assert!(doubted.is_nearest() && !CLEAR.is_nearest());
        assert!(!Evidence { validation_t: 2.0, ..doubted }.is_nearest());
        assert!(!Evidence { fit_improvement: 0.001, ..doubted }.is_nearest());
    }
}
