//! How much of a signal's fit is at stake.

use crate::decision::choice::Score;
use crate::decision::criteria::CRITERIA;
use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::explain::selection::Compared;
use crate::missing::Missing;
use crate::screening::bent_rms;

impl Baseline<'_> {
    /// Whether the fit of some signal would rise visibly if its error were its noise alone.
    pub(super) fn is_worth_a_look(&self, fitted: &Fitted) -> bool {
        let above = |(row, error): (usize, f64)| (error - self.floor[row]) / bent_rms(self.train, row);
        self.roots(fitted).map(above).any(|it| it >= CRITERIA.improvement)
    }

    /// Share by which a candidate reduces the squared errors of a simulation, signals in shares of their magnitudes.
    pub(super) fn reduction(&self, (missing, compared): (&Missing<'_>, &Compared), score: Score) -> f64 {
        let magnitudes: Vec<f64> =
            (0..missing.setting.magnitudes.len()).map(|row| bent_rms(self.train, row)).collect();
        compared.reduction(score.candidate, missing, &magnitudes, self.rig.segment()).unwrap_or_default()
    }

    /// By how much the fit of the worst signal would rise without a share of its error's power.
    pub(super) fn improvement(&self, fitted: &Fitted, share: f64) -> f64 {
        let of = |(row, error): (usize, f64)| error / bent_rms(self.train, row);
        let worst = self.roots(fitted).map(of).fold(0.0, f64::max);
        worst * (1.0 - (1.0 - share.clamp(0.0, 1.0)).sqrt())
    }

    /// Root mean square of each signal's error on the estimation records, by its row.
    pub(super) fn roots(&self, fitted: &Fitted) -> impl Iterator<Item = (usize, f64)> {
        self.errors(&fitted.train).roots().into_iter().enumerate()
    }
}
