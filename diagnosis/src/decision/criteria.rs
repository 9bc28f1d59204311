//! The numbers that decide on an identified effect, in one place. Numbers of data checks and of numerical methods are no decisions about
//! a model; they stand beside their functions.

/// What has to hold before something is said of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Smallest improvement of interest: rise of a signal's fit (NRMSE). An engineer sees no less in a plot.
    pub improvement: f64,
    /// Factor of it that is asked of a background effect, and that an effect may cost another signal. Background effects of the
    /// benchmark's rigs reach it seldom.
    pub background: f64,
    /// Residual reduction that matters however small the error is: more than half of it, so that no second effect does as much.
    pub majority: f64,
    /// Residual reduction that no mixture of small effects reaches.
    pub bulk: f64,
    /// Share of the starting model's error on validation data that does not go by chance, however few the blocks are.
    pub by_far: f64,
    /// Share of the starting model's error that is worth a name.
    pub explained: f64,
    /// Fall of the Bayesian information criterion: twice what Kass and Raftery call very strong (Journal of the American Statistical
    /// Association 90, 1995).
    pub bic: f64,
    /// Student's t of the improvement over blocks of the estimation data, from which the effect was chosen.
    pub estimation_t: f64,
    /// The same on validation data, which chose nothing.
    pub validation_t: f64,
    /// Standard deviations from zero within which an amount may be zero: 95 %.
    pub certain: f64,
    /// Probability that the best candidate improves the fit this consistently by chance.
    pub p_value: f64,
    /// Errors in sensor noise beyond which an account is open.
    pub above_noise: f64,
    /// Share of a signal, of a parameter's value, or of an error's power, below which a difference is not worth a sentence.
    pub visible: f64,
    /// Standard deviations between two answers that chance does not explain: for normal errors once in 16 000.
    pub apart: f64,
    /// Paired t of two fits' errors beyond which the data tell them apart: 99 %.
    pub paired_t: f64,
    /// Factor of the error below which a difference tells nothing apart, however steady it is: no model is that right.
    pub same: f64,
    /// Factor of a rough fit's error below which a close fit may be the better one.
    pub near: f64,
    /// Fit of the best signal below which a model describes another rig.
    pub inadequate: f64,
    /// Share of the missing signal that background effects make.
    pub background_share: f64,
    /// Share of what free features explain that a law in a rough shape has to explain, before it is fitted.
    pub rough: f64,
    /// The same of a fitted law, to take the features' place.
    pub fitted: f64,
    /// Share of what the best candidate explains from which another one is fitted, too: its shape may be the rougher one.
    pub rival: f64,
    /// Share of the estimation data's explained part that the validation data have to show: another excitation may
    /// show a quarter of it.
    pub confirmed: f64,
    /// Largest missing force, in what would move the rig as it moves.
    pub largest: f64,
    /// Probability with which an experiment separates rivals; and the share of a column from which it is another name of a parameter.
    pub decides: f64,
}

/// The criteria of every diagnosis.
pub const CRITERIA: Criteria = Criteria {
    improvement: 0.015,
    background: 2.0,
    majority: 0.55,
    bulk: 0.7,
    by_far: 0.25,
    explained: 0.01,
    bic: 20.0,
    estimation_t: 3.5,
    validation_t: 3.0,
    certain: 2.0,
    p_value: 0.01,
    above_noise: 3.0,
    visible: 0.1,
    apart: 4.0,
    paired_t: 2.5,
    same: 1.005,
    near: 1.1,
    inadequate: 0.2,
    background_share: 0.04,
    rough: 0.65,
    fitted: 0.9,
    rival: 0.5,
    confirmed: 0.25,
    largest: 10.0,
    decides: 0.95,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_most_25_numbers_decide_and_none_contradicts_another() {
        assert!(size_of::<Criteria>() <= 25 * size_of::<f64>());
        let it = CRITERIA;
        assert!(it.by_far < it.majority && it.majority < it.bulk);
        assert!(it.rough < it.fitted && it.background_share < it.confirmed * it.rival);
        assert!(
            it.certain < it.paired_t && it.paired_t < it.validation_t && it.validation_t < it.estimation_t
        );
        assert!(it.estimation_t < it.apart && it.same < it.near);
    }
}
