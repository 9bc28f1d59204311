//! The account: where the power of a signal's error goes.

use super::criteria::CRITERIA;

/// A signal's error on the validation records, in powers (mean squares) that add up to the starting model's.
#[derive(Clone, Debug, PartialEq)]
pub struct Account {
    /// Power of the starting model's error.
    pub total: f64,
    /// Measurement noise.
    pub noise: f64,
    /// What fitting the nominal parameters takes away; negative if it makes this signal worse, and nothing else was found.
    pub parameters: f64,
    /// What each effect takes away, in their order.
    pub effects: Vec<f64>,
    /// What features without a name explain of the rest.
    pub unmodelled: f64,
    /// What nothing explains.
    pub unexplained: f64,
}

/// From the mean squares of the starting model's error, of the error after fitting the nominal parameters, and after each effect; the
/// noise's; and the share that features without a name explain of what is left then.
pub fn account(start: f64, fitted: f64, effects: &[f64], noise: f64, unmodelled: f64) -> Account {
    // Without its effects, a model may need worse parameters than those that it started with: no amount of either.
    let fitted = if effects.is_empty() { fitted } else { fitted.min(start) };
    let mut before = fitted;
    let taken = effects.iter().map(|after| {
        let taken = before - after;
        before = *after;
        taken
    });
    let taken: Vec<f64> = taken.collect();
    let noise = noise.min(before);
    let rest = before - noise;
    let unmodelled = rest * unmodelled.clamp(0.0, 1.0);
    Account {
        total: start,
        noise,
        parameters: start - fitted,
        effects: taken,
        unmodelled,
        unexplained: rest - unmodelled,
    }
}

impl Account {
    /// Whether a signal of this mean square misses more than its noise and what is worth a sentence.
    pub fn is_open(&self, signal: f64) -> bool {
        self.exceeds(CRITERIA.visible, signal)
    }

    /// Whether it misses more than its noise and more than a plot hides: the report states such an error of a closed account, too.
    pub fn shows(&self, signal: f64) -> bool {
        self.exceeds(CRITERIA.improvement, signal)
    }

    fn exceeds(&self, share: f64, signal: f64) -> bool {
        let left = self.unexplained + self.unmodelled;
        left > (CRITERIA.above_noise.powi(2) - 1.0) * self.noise && left > share.powi(2) * signal
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_account_adds_up(
            start in 0.0..10.0_f64, fitted in 0.0..10.0_f64, effects in prop::collection::vec(0.0..10.0_f64, 0..4),
            noise in 0.0..1.0_f64, share in -0.5..1.5_f64,
        ) {
            let Account { total, noise, parameters, effects, unmodelled, unexplained } =
                account(start, fitted, &effects, noise, share);
            let sum = noise + parameters + effects.iter().sum::<f64>() + unmodelled + unexplained;
            prop_assert!((sum - total).abs() < 1e-12 * (1.0 + total));
            prop_assert!(noise >= 0.0 && unmodelled >= 0.0 && unexplained >= 0.0);
        }
    }

    #[test]
    fn parameters_that_make_up_for_an_effect_take_nothing_away() {
        let found = account(100.0, 250.0, &[30.0], 0.0, 0.0);
        assert_eq!((found.parameters, &found.effects[..]), (0.0, &[70.0][..]));
        assert_eq!(account(100.0, 250.0, &[], 0.0, 0.0).parameters, -150.0);
    }

    #[test]
    fn an_account_is_open_beyond_three_times_the_noise() {
        let of =
            |left: f64, noise: f64| account(100.0, 50.0, &[left * left], noise * noise, 0.4).is_open(100.0);
        assert!(of(4.0, 1.0) && !of(2.9, 1.0));
        // A tenth of the signal is not worth a sentence, however small the noise is.
        assert!(!of(0.9, 0.01));
    }

    #[test]
    fn an_error_shows_beyond_a_plots_accuracy_though_the_account_is_closed() {
        let of =
            |left: f64, noise: f64| account(100.0, 50.0, &[left * left], noise * noise, 0.4).shows(100.0);
        assert!(of(0.9, 0.01) && of(0.2, 0.01) && !of(0.1, 0.01) && !of(0.9, 0.4));
    }
}
