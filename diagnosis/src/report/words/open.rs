//! Signals with errors that no known effect explains.

use super::{digits, percent};
use crate::decision::criteria::CRITERIA;
use crate::report::findings::{Findings, SignalAccount, Verdict};

/// A ratio to the noise above which its digits mean nothing.
const FAR: f64 = 1000.0;

/// The unexplained error of a signal, on the validation data.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenSignal {
    /// As in the FMU.
    pub signal: String,
    /// Its root mean square as a share of the signal's; not a number if the fit is not known.
    pub share: f64,
    /// The same as a multiple of the sensor's noise; infinite without noise.
    pub noise: f64,
    /// Fit of the extended model, without the noise of the measured inputs.
    pub fit: f64,
    /// Whether a description covers part of it, although no effect of the catalogue does.
    pub described: bool,
}

/// The signals whose account is open, the largest share of a signal first.
pub fn open_signals(findings: &Findings) -> Vec<OpenSignal> {
    let mut all: Vec<OpenSignal> =
        findings.account.iter().filter_map(|account| open_signal(findings, account)).collect();
    let key = |it: &OpenSignal| if it.share.is_finite() { it.share } else { -1.0 };
    all.sort_by(|a, b| key(b).total_cmp(&key(a)));
    all
}

/// A reservation about fitted parameters while something is missing.
pub fn reservation(findings: &Findings) -> Option<&'static str> {
    let missing = findings.verdict == Verdict::Unmodelled || findings.account.iter().any(|it| it.open);
    missing.then_some("While an effect is missing from the model, parameters may compensate a part of it.")
}

/// The unexplained error of one account, if it is open.
pub fn open_signal(findings: &Findings, account: &SignalAccount) -> Option<OpenSignal> {
    account.open.then(|| unexplained(findings, account))
}

/// The largest remaining error that shows in a plot and exceeds the noise, if all accounts are closed: by as much as an open one
/// does, or by less if it is a large part of the signal.
pub fn small_rest(findings: &Findings) -> Option<OpenSignal> {
    if findings.account.iter().any(|it| it.open) {
        return None;
    }
    let all = findings.account.iter().map(|it| unexplained(findings, it));
    let limits = [(CRITERIA.improvement, CRITERIA.above_noise), (CRITERIA.visible, CRITERIA.certain)];
    let shown = all.filter(|it| limits.iter().any(|(share, noise)| it.share > *share && it.noise > *noise));
    shown.max_by(|a, b| a.share.total_cmp(&b.share))
}

fn unexplained(findings: &Findings, account: &SignalAccount) -> OpenSignal {
    let left = account.unmodelled.max(0.0) + account.unexplained.max(0.0);
    let noise = account.noise.max(0.0);
    let fit = findings
        .signals
        .iter()
        .find(|it| it.name == account.signal)
        .map_or(f64::NAN, |it| it.fit_without_input_noise);
    OpenSignal {
        signal: account.signal.clone(),
        // The remaining error is noise and the rest, which add up in power.
        share: (1.0 - fit) * (left / (left + noise)).sqrt(),
        noise: (left / noise).sqrt(),
        fit,
        described: account.unmodelled > 0.0,
    }
}

impl OpenSignal {
    /// How much of the signal it is, if the model predicts the signal at all.
    fn part(&self) -> Option<String> {
        (self.share.is_finite() && self.share < 1.0).then(|| percent(self.share))
    }

    /// `12 × sensor noise`; nothing if that is not known.
    pub fn times_noise(&self) -> Option<String> {
        match self.noise {
            times if times > FAR => Some(format!("more than {FAR} × sensor noise")),
            times if times.is_finite() => Some(format!("{} × sensor noise", digits(times, 2))),
            _ => None,
        }
    }

    /// One sentence.
    pub fn sentence(&self) -> String {
        let noise = self.times_noise().map_or(String::new(), |times| format!(" ({times})"));
        let Self { signal, .. } = self;
        match (self.part(), self.described) {
            (Some(part), false) => {
                format!("{part} of {signal} is still unexplained on the validation data{noise}.")
            }
            (Some(part), true) => {
                format!("{part} of {signal} is explained by no known effect on the validation data{noise}.")
            }
            (None, _) if self.fit < 0.0 => {
                format!("The model does not predict {signal} at all on the validation data{noise}.")
            }
            (None, _) => format!("{signal} is still unexplained on the validation data{noise}."),
        }
    }

    /// The same beside the signal's name, without a verb.
    pub fn note(&self) -> String {
        let what = if self.described { "no known effect" } else { "still unexplained" };
        let part = match self.part() {
            Some(part) => format!("{part} of the signal"),
            None => "the signal as a whole".to_owned(),
        };
        let noise = self.times_noise().map_or(String::new(), |times| format!(", {times}"));
        format!("{what}: {part}{noise}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::Signal;

    fn findings(noise: f64, unmodelled: f64, unexplained: f64, phi: f64) -> Findings {
        let account = SignalAccount {
            signal: "body.acceleration".into(),
            error: 1.0,
            noise,
            parameters: 0.0,
            effects: vec![],
            unmodelled,
            unexplained,
            open: true,
        };
        let signal = Signal {
            name: "body.acceleration".into(),
            unit: "m/s2".into(),
            fit_before: 0.1,
            fit_fitted: phi,
            fit_after: phi,
            fit_without_input_noise: phi,
            rms_before: 8.0,
            rms_fitted: 4.0,
            rms_after: 4.0,
            noise_floor: 0.1,
            repeatability: None,
        };
        let mut findings = Findings::of_bad_data("rig", vec![], vec![], vec![]);
        (findings.account, findings.signals) = (vec![account], vec![signal]);
        findings
    }

    #[test]
    fn an_open_signal_has_its_share_and_its_multiple_of_the_noise() {
        let all = open_signals(&findings(0.001, 0.0, 0.4, 0.6));
        assert!((all[0].share - 0.4).abs() < 1e-3 && (all[0].noise - 20.0).abs() < 1e-9, "{all:?}");
        let text = all[0].sentence();
        assert_eq!(
            text,
            "40 % of body.acceleration is still unexplained on the validation data (20 × sensor noise)."
        );
    }

    #[test]
    fn parameters_are_facts_only_where_nothing_is_missing() {
        let mut found = findings(0.001, 0.0, 0.4, 0.6);
        assert!(reservation(&found).is_some());
        found.account[0].open = false;
        assert!(reservation(&found).is_none());
        assert!(reservation(&Findings { verdict: Verdict::Unmodelled, ..found }).is_some());
    }

    #[test]
    fn a_description_is_no_explanation() {
        let text = open_signals(&findings(0.001, 0.3, 0.1, 0.6))[0].sentence();
        assert!(text.starts_with("40 % of body.acceleration is explained by no known effect"), "{text}");
    }

    #[test]
    fn a_fit_below_zero_is_said_in_words() {
        let all = open_signals(&findings(0.0, 0.0, 0.4, -15.9));
        assert!(all[0].sentence().starts_with("The model does not predict body.acceleration at all"));
        assert!(!all[0].note().contains("inf") && !all[0].note().contains("15"), "{}", all[0].note());
    }

    #[test]
    fn a_large_part_of_a_signal_is_told_though_its_account_is_closed() {
        let rest = |unexplained: f64, fit: f64| {
            let mut closed = findings(0.1, 0.0, unexplained, fit);
            closed.account[0].open = false;
            small_rest(&closed).map(|it| it.sentence())
        };
        let told = rest(0.625, 0.8).unwrap();
        assert_eq!(
            told,
            "19 % of body.acceleration is still unexplained on the validation data (2.5 × sensor noise)."
        );
        assert!(rest(0.3, 0.8).is_none() && rest(0.625, 0.95).is_none() && rest(2.5, 0.95).is_some());
    }

    #[test]
    fn a_closed_account_is_not_open() {
        let mut closed = findings(0.5, 0.0, 0.1, 0.9);
        closed.account[0].open = false;
        assert!(open_signals(&closed).is_empty());
    }
}
