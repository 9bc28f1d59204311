//! The account of each signal, from the fits on the validation records.

use crate::catalogue::naming::name;
use crate::decision::account::account;
use crate::diagnosis::Diagnosis;
use crate::estimation::hypothesis::Fitted;
use crate::report::findings::{AccountItem, SignalAccount};
use crate::report::words::located;

impl Diagnosis<'_> {
    /// Where each signal's error goes; `share` of what is left is explained without a name.
    pub(super) fn account(&self, share: f64) -> Vec<SignalAccount> {
        let (baseline, found) = (&self.baseline, &self.found);
        let squares = |fitted: &Fitted| baseline.errors(&fitted.test).mean_squares();
        let Some(before) = self.before_on_validation() else { return Vec::new() };
        let start = baseline.errors(&before).mean_squares();
        let fitted = squares(&found.base);
        let stages: Vec<Vec<f64>> = found.stages.iter().map(squares).collect();
        let rows = baseline.test.first().map_or(&[][..], |record| &record.measured);
        let of = |(row, measured): (usize, &crate::dataset::recorded::Measured)| {
            let after: Vec<f64> = stages.iter().map(|stage| stage[row]).collect();
            let account = account(start[row], fitted[row], &after, baseline.noise(row).powi(2), share);
            let total = account.total.max(f64::MIN_POSITIVE);
            let item = |(taken, accepted): (&f64, &crate::confirm::Accepted)| {
                let words = name(accepted.term, &baseline.rig.plant);
                AccountItem { name: located(&words.name, &words.element), share: taken / total }
            };
            SignalAccount {
                signal: baseline.rig.plant.outputs[measured.output].name.clone(),
                error: account.total.sqrt(),
                noise: account.noise / total,
                parameters: account.parameters / total,
                effects: account.effects.iter().zip(&found.accepted).map(item).collect(),
                unmodelled: account.unmodelled / total,
                unexplained: account.unexplained / total,
                open: account.is_open(baseline.signal(row)),
            }
        };
        rows.iter().enumerate().map(of).collect()
    }

    /// Errors of the starting model on the conditioned validation records.
    fn before_on_validation(&self) -> Option<crate::estimation::fit::Residuals> {
        let dynamics = self.baseline.dynamics(&[]).ok()?;
        let fit = self.baseline.fit(&*dynamics, self.baseline.test, Vec::new());
        let point = self.baseline.held_out_point(&*dynamics, &self.before);
        Some(fit.residuals(&point))
    }
}
