//! What is kept of what was found: no amount that may be nothing, and nothing that runs away.

use crate::dataset::recorded::Recorded;
use crate::decision::rules::{Amount, is_determined, lowers};
use crate::estimation::fit::{Handle, Point, Residuals};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::intervals::Interval;
use crate::estimation::lsq::Stop;
use crate::signal::distortion::Fault;

use super::{Found, phi};

impl World<'_> {
    /// The last effect whose amount may be nothing by all that is known of it.
    pub(super) fn doubtful(&self, found: &Found, intervals: &[Interval]) -> Option<usize> {
        let amount = |handle: Handle| {
            let it = intervals.iter().find(|it| it.handle == handle)?;
            let value = it.value - found.base.point.get(handle);
            Some(Amount { value, bounds: (f64::NEG_INFINITY, f64::INFINITY), half: it.half })
        };
        found.accepted.iter().rposition(|it| {
            let amounts: Vec<Amount> = self.sizes(it.term).into_iter().filter_map(amount).collect();
            !is_determined(&amounts)
        })
    }

    /// The first effect with which the model as others simulate it, on the records as they were measured, meets a signal less
    /// well than without it: what runs away there is of no use, however well it fits.
    pub(super) fn harmful(&self, found: &Found, measured: &[Recorded]) -> Option<usize> {
        let rows = measured.first().map_or(0, |record| record.measured.len());
        let fits = |stage: &Fitted| -> Vec<f64> {
            let residuals = self.as_measured(measured, (&stage.terms, &stage.point), stage);
            let of = |row: usize| {
                let left = residuals.iter().flat_map(|(_, it)| it.iter().flat_map(|record| &record[row]));
                let left: Vec<f64> = left.copied().collect();
                let values = measured.iter().flat_map(|record| &record.measured[row].values);
                phi(&left, &values.copied().collect::<Vec<_>>())
            };
            (0..rows).map(of).collect()
        };
        let all: Vec<Vec<f64>> = std::iter::once(&found.base).chain(&found.stages).map(fits).collect();
        all.windows(2).position(|pair| lowers(&pair[0], &pair[1]))
    }

    /// The point of records as they were measured, and the errors there of a model whose coordinates are a fit's.
    pub(crate) fn as_measured(
        &self,
        measured: &[Recorded],
        (terms, point): (&[Term], &Point),
        fitted: &Fitted,
    ) -> Option<(Point, Residuals)> {
        let dynamics = self.dynamics(terms).ok()?;
        let fit = self.fit(&*dynamics, measured, Vec::new());
        let mut point = Point { starts: self.starts(measured), ..point.within(&self.rig.plant) };
        // What any importer finds with the extended model, which knows nothing of what measuring did to the signals, but for
        // what is reported: a signal's delay and lag go together.
        let output = |term: &Term| match term {
            Term::Fault(Handle::Output(output, Fault::Delay | Fault::Lag)) | Term::Response(output) => {
                Some(*output)
            }
            _ => None,
        };
        let told: Vec<usize> = terms.iter().filter_map(output).collect();
        for handle in fitted.coordinates.iter().map(|it| it.handle) {
            let kept = output(&Term::Fault(handle)).is_some_and(|it| told.contains(&it));
            if self.usual(handle).is_some() && !kept {
                point.set(handle, 0.0);
            }
        }
        let settled = fit.settled(point);
        let residuals = fit.residuals(&settled);
        Some((settled, residuals))
    }

    /// Takes an effect back, and what was described beside it.
    pub(super) fn retract(&self, found: &mut Found, index: usize) -> Result<(), String> {
        let term = found.accepted.remove(index).term;
        found.retracted.push(term);
        found.unmodelled.retain(|it| it.curve.is_some_and(|curve| curve != term));
        found.stages.truncate(index);
        let mut last = found.stages.last().unwrap_or(&found.base).clone();
        for accepted in &found.accepted[index..] {
            let mut terms = last.terms.clone();
            terms.push(accepted.term);
            let mut start = last.point.clone();
            for own in self.own_coordinates(accepted.term) {
                start.set(own.handle, found.extended.point.get(own.handle));
            }
            last = self.fitted(&terms, &[start], Stop::NOISY)?;
            found.stages.push(last.clone());
        }
        found.extended = last;
        Ok(())
    }
}
