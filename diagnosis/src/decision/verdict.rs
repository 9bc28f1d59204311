//! The verdict, from the account and from what was found.

use serde::Serialize;

use super::criteria::CRITERIA;

/// What is the matter with the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing that these records could show.
    NoEffect,
    /// Parameters differ from those that the model started with; no effect beyond them could be shown.
    ParameterMismatch,
    /// One or several effects are identified.
    Identified,
    /// Several effects explain the data equally well.
    Ambiguous,
    /// Something is missing that is not in the catalogue.
    Unmodelled,
    /// Of all that could be missing, only sensors are at fault. Nominal parameters may be off, too.
    SensorFault,
    /// The model explains too little for anything to be told.
    ModelInadequate,
    /// The time limit was reached before an effect was identified.
    OutOfTime,
    /// The data cannot be used.
    BadData,
}

/// What a verdict is made from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// Best fit of any signal on the validation records.
    pub best_fit: f64,
    /// Number of effects.
    pub effects: usize,
    /// Whether one of them has a rival.
    pub ambiguous: bool,
    /// Whether all of them are of sensors.
    pub sensors: bool,
    /// Share of the remaining error that something without a name explains; zero if there is nothing of the kind.
    pub unmodelled: f64,
    /// Whether what has no name came first: whatever is named beside it is smaller.
    pub unmodelled_first: bool,
    /// Whether nominal parameters are off.
    pub mismatch: bool,
    /// Whether a signal misses more than its noise.
    pub open: bool,
    /// Whether the time limit ended the search.
    pub out_of_time: bool,
}

/// The verdict.
pub fn verdict(facts: Facts) -> Verdict {
    let Facts { best_fit, effects, ambiguous, sensors, unmodelled, unmodelled_first, mismatch, open, .. } =
        facts;
    // Of what was not looked at, nothing is claimed.
    if facts.out_of_time && effects == 0 && unmodelled == 0.0 {
        Verdict::OutOfTime
    } else if best_fit < CRITERIA.inadequate && unmodelled == 0.0 {
        Verdict::ModelInadequate
    } else if unmodelled > 0.0 && (effects == 0 || unmodelled_first || sensors) || effects == 0 && open {
        Verdict::Unmodelled
    } else if ambiguous {
        Verdict::Ambiguous
    } else if effects > 0 && sensors {
        Verdict::SensorFault
    } else if effects > 0 {
        Verdict::Identified
    } else if mismatch {
        Verdict::ParameterMismatch
    } else {
        Verdict::NoEffect
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FITS: Facts = Facts {
        best_fit: 0.9,
        effects: 0,
        ambiguous: false,
        sensors: false,
        unmodelled: 0.0,
        unmodelled_first: false,
        mismatch: false,
        open: false,
        out_of_time: false,
    };

    #[test]
    fn nothing_is_told_as_nothing_only_where_the_account_is_closed() {
        assert_eq!(verdict(FITS), Verdict::NoEffect);
        assert_eq!(verdict(Facts { mismatch: true, ..FITS }), Verdict::ParameterMismatch);
        assert_eq!(verdict(Facts { open: true, ..FITS }), Verdict::Unmodelled);
    }

    #[test]
    fn a_search_that_was_ended_claims_no_absence() {
        let ended = Facts { out_of_time: true, ..FITS };
        for facts in [
            ended,
            Facts { mismatch: true, ..ended },
            Facts { open: true, ..ended },
            Facts { best_fit: -3.0, ..ended },
        ] {
            assert_eq!(verdict(facts), Verdict::OutOfTime);
        }
        assert_eq!(verdict(Facts { effects: 1, ..ended }), Verdict::Identified);
        assert_eq!(verdict(Facts { unmodelled: 0.3, ..ended }), Verdict::Unmodelled);
    }

    #[test]
    fn a_name_stands_unless_something_larger_has_none() {
        let named = Facts { effects: 1, ..FITS };
        assert_eq!(verdict(named), Verdict::Identified);
        assert_eq!(verdict(Facts { unmodelled: 0.3, ..named }), Verdict::Identified);
        assert_eq!(verdict(Facts { unmodelled: 0.3, unmodelled_first: true, ..named }), Verdict::Unmodelled);
        assert_eq!(verdict(Facts { ambiguous: true, ..named }), Verdict::Ambiguous);
        assert_eq!(verdict(Facts { sensors: true, ..named }), Verdict::SensorFault);
        // A fault of a sensor does not acquit the plant.
        assert_eq!(verdict(Facts { sensors: true, unmodelled: 0.3, ..named }), Verdict::Unmodelled);
    }

    #[test]
    fn a_model_that_meets_nothing_tells_nothing() {
        assert_eq!(verdict(Facts { best_fit: 0.1, effects: 2, ..FITS }), Verdict::ModelInadequate);
        assert_eq!(verdict(Facts { best_fit: 0.1, unmodelled: 0.5, ..FITS }), Verdict::Unmodelled);
    }
}
