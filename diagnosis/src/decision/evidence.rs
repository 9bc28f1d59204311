//! The evidence for an effect, and what it has to exceed.

use serde::Serialize;

use super::criteria::CRITERIA;

/// Why an effect is believed: every gate that it went through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Evidence {
    /// Fall of the Bayesian information criterion, samples counted as far as they are independent.
    pub delta_bic: f64,
    /// Student's t of the gain over the blocks of the estimation data.
    pub block_t: f64,
    /// Chance that of as many effects as were compared the best one's gain is as steady, where none of them is there.
    pub chance: f64,
    /// Student's t of the gain over the blocks of the validation data.
    pub held_out_t: f64,
    /// Chance that of as many effects as were compared the best one's gain on the validation data is as steady, where none of them
    /// is there.
    pub held_out_chance: f64,
    /// Share of the starting model's error power that it explains on the validation data.
    pub explained: f64,
    /// Largest rise of Φ among the signals, on the estimation or the validation data, whichever is less.
    pub phi_gain: f64,
    /// Share that it takes away of the error's power that was left without it, on the estimation or the validation data,
    /// whichever is less.
    pub taken: f64,
    /// Whether every rig has a little of it, so that more of it is asked for.
    pub usual: bool,
    /// Whether it matters however little of it the errors show, as with a signal that is very late.
    pub grave: bool,
}

impl Evidence {
    /// What has to be exceeded, in every gate; the chance must not be. The information criterion alone is never the verdict: small unmodelled
    /// effects pass it on every record.
    ///
    /// Of `phi_gain` and `taken`, one is enough: a large error, or more than half of the missing signal.
    pub const REQUIRED: Self = Self {
        delta_bic: CRITERIA.bic,
        block_t: CRITERIA.estimation_t,
        chance: CRITERIA.p_value,
        held_out_t: CRITERIA.validation_t,
        held_out_chance: CRITERIA.p_value,
        explained: CRITERIA.explained,
        phi_gain: CRITERIA.improvement,
        taken: CRITERIA.majority,
        usual: false,
        grave: false,
    };

    /// The same of what every rig has a little of.
    pub const REQUIRED_OF_USUAL: Self =
        Self { phi_gain: CRITERIA.background * CRITERIA.improvement, usual: true, ..Self::REQUIRED };

    /// What has to be exceeded here.
    pub fn required(&self) -> Self {
        if self.usual { Self::REQUIRED_OF_USUAL } else { Self::REQUIRED }
    }

    /// Whether it takes most of the error away, however small that is.
    pub fn takes_the_bulk(&self) -> bool {
        self.taken > CRITERIA.bulk
    }

    /// Whether so much of the error on validation data goes that chance is no question, however few the blocks are.
    pub fn is_no_chance(&self) -> bool {
        let most_of_what_was_left = self.taken > self.required().taken && self.held_out_t > CRITERIA.certain;
        most_of_what_was_left || self.explained > CRITERIA.by_far && self.held_out_t > 0.0
    }

    /// The first gate that is not passed, in words.
    pub fn refusal(&self) -> Option<String> {
        self.doubt().or_else(|| self.smallness())
    }

    /// Whether it passes beside another effect that has passed: whether anything is there is no question then, and its gains
    /// may be less steady.
    pub fn passes_beside_another(&self) -> bool {
        let steady = self.block_t > CRITERIA.certain;
        steady && Self { block_t: f64::INFINITY, chance: 0.0, ..*self }.refusal().is_none()
    }

    /// Whether a small Student's t over the estimation data is enough: it takes so much away that its gains are as uneven as the
    /// errors were, or the validation data, which chose nothing, rule chance out on their own.
    pub fn is_steady_enough(&self) -> bool {
        self.takes_the_bulk() && self.block_t > CRITERIA.certain
            || self.held_out_chance < self.required().held_out_chance && self.block_t > 0.0
    }

    /// Whether the validation data show it, and enough of it to matter, while the estimation data leave doubt: their errors hang
    /// together so much that they are few independent ones.
    pub fn is_nearest(&self) -> bool {
        self.doubt().is_some() && self.smallness().is_none() && self.held_out_t > self.required().held_out_t
    }

    /// The first gate that is not passed of those that tell whether it is there at all.
    pub fn doubt(&self) -> Option<String> {
        let Self { delta_bic, block_t, chance, held_out_t, explained, .. } = *self;
        let required = self.required();
        if !explained.is_finite() {
            Some("diverges on the validation data".to_owned())
        } else if delta_bic.is_nan() || delta_bic <= required.delta_bic {
            Some(format!("explains too little for its parameters (the BIC falls by {delta_bic:.0})"))
        } else if !(block_t > required.block_t || self.is_steady_enough()) {
            Some(format!("no consistent improvement on the estimation data (t = {block_t:.1})"))
        } else if !(chance < required.chance || self.is_steady_enough()) {
            Some(format!("the improvement may be chance (p-value {chance:.2})"))
        } else if !(held_out_t > required.held_out_t || self.is_no_chance()) {
            Some(format!("no improvement on the validation data (t = {held_out_t:.1})"))
        } else {
            None
        }
    }

    /// The first gate that is not passed of those that tell whether it matters.
    fn smallness(&self) -> Option<String> {
        let Self { explained, phi_gain, taken, .. } = *self;
        let required = self.required();
        if self.grave {
            None
        } else if explained <= required.explained {
            Some(format!(
                "below the smallest improvement of interest ({:.1} % of the error)",
                100.0 * explained
            ))
        } else if !(phi_gain > required.phi_gain || taken > required.taken) {
            Some(format!(
                "below the smallest improvement of interest (the fit rises by {phi_gain:.3}, residual reduction {:.0} %)",
                100.0 * taken
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
        block_t: 8.0,
        chance: 1e-6,
        held_out_t: 6.0,
        held_out_chance: 1e-4,
        explained: 0.2,
        phi_gain: 0.1,
        taken: 0.4,
        usual: false,
        grave: false,
    };

    #[test]
    fn validation_data_that_rule_chance_out_need_no_steadiness_of_the_estimation_data() {
        assert_eq!(CLEAR.refusal(), None);
        let uneven = Evidence { block_t: 1.3, chance: 1.0, ..CLEAR };
        assert_eq!(uneven.refusal(), None);
        assert!(Evidence { held_out_chance: 0.02, ..uneven }.refusal().is_some());
        // What makes the estimation data worse is not there, whatever the validation data say.
        assert!(Evidence { block_t: -0.1, ..uneven }.refusal().is_some());
        assert!(Evidence { delta_bic: 5.0, ..uneven }.refusal().is_some());
    }

    #[test]
    fn every_gate_refuses_on_its_own() {
        for one in [
            Evidence { delta_bic: 19.0, ..CLEAR },
            Evidence { block_t: 3.0, held_out_chance: 0.02, ..CLEAR },
            Evidence { chance: 0.02, held_out_chance: 0.02, ..CLEAR },
            Evidence { held_out_t: 2.9, ..CLEAR },
            Evidence { explained: 0.009, ..CLEAR },
            Evidence { phi_gain: 0.014, ..CLEAR },
            Evidence { phi_gain: 0.02, usual: true, ..CLEAR },
            Evidence { explained: f64::NEG_INFINITY, ..CLEAR },
        ] {
            assert!(one.refusal().is_some(), "{one:?}");
        }
    }

    #[test]
    fn what_only_the_validation_data_show_comes_nearest() {
        let doubted = Evidence { delta_bic: 1.0, ..CLEAR };
        assert!(doubted.is_nearest() && !CLEAR.is_nearest());
        assert!(!Evidence { held_out_t: 2.0, ..doubted }.is_nearest());
        assert!(!Evidence { phi_gain: 0.001, ..doubted }.is_nearest());
    }
}
