//! Effects after the search: taken back if their amount may be zero or their simulation runs away, and told apart from rivals that
//! the others rule out.

use rayon::prelude::*;

use crate::confirm::Accepted;
use crate::dataset::recorded::Dataset;
use crate::decision::rules::{Amount, is_determined, lowers};
use crate::estimation::deadline::Stage;
use crate::estimation::fit::Residuals;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::intervals::Interval;
use crate::estimation::lsq::Stop;
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};
use crate::signal::distortion::Fault;

use super::{Found, phi};

impl Baseline<'_> {
    /// The last effect whose interval holds zero, or that is within the usual timing of a channel: effects found later may have
    /// taken its place.
    pub(super) fn doubtful(&self, found: &Found, intervals: &[Interval]) -> Option<usize> {
        let amount = |handle: Unknown| {
            let it = intervals.iter().find(|it| it.handle == handle)?;
            let value = self.amount(handle, it.value, &found.base);
            // A common scale that only the parameter set knows makes no amount zero, but a gain is that scale.
            let half = if handle.fault() == Some(Fault::Gain) { it.half } else { it.half_of_data };
            Some(Amount { value, bounds: self.within(handle, &found.extended), half })
        };
        // A curve has no single amount, and every similar law pulls at it. One of its points has to exceed its noise and the records'
        // disagreement.
        let point = |it: FreeParameter| {
            let own = intervals.iter().find(|interval| interval.handle == it.handle)?;
            Some(Amount {
                value: own.value,
                bounds: (f64::NEG_INFINITY, f64::INFINITY),
                half: own.half_of_noise,
            })
        };
        found.accepted.iter().rposition(|it| {
            let amounts: Vec<Amount> = match it.term {
                Term::Table(_) => self.own_coordinates(it.term).into_iter().filter_map(point).collect(),
                term => self.sizes(term).into_iter().filter_map(amount).collect(),
            };
            !is_determined(&amounts) || self.is_in_time(it.term, &found.extended)
        })
    }

    /// The first effect that lowers the fit of a signal of the records as measured, in the simulation that an importer makes.
    pub(super) fn harmful(&self, found: &Found, measured: &[Dataset]) -> Option<usize> {
        let rows = measured.first().map_or(0, |record| record.measured.len());
        let fits = |stage: &Fitted| -> Vec<f64> {
            let Some((_, residuals)) = self.as_measured(measured, (&stage.terms, &stage.point), stage) else {
                return vec![f64::NAN; rows];
            };
            (0..rows).map(|row| fit_of(measured, &residuals, row)).collect()
        };
        let all: Vec<Vec<f64>> = std::iter::once(&found.base).chain(&found.stages).map(fits).collect();
        all.windows(2).position(|pair| lowers(&pair[0], &pair[1]))
    }

    /// The point of records as they were measured, and the errors there of a model whose coordinates are a fit's.
    pub(crate) fn as_measured(
        &self,
        measured: &[Dataset],
        (terms, point): (&[Term], &Estimate),
        fitted: &Fitted,
    ) -> Option<(Estimate, Residuals)> {
        let dynamics = self.dynamics(terms).ok()?;
        let fit = self.fit(&*dynamics, measured, Vec::new());
        let mut point = Estimate { starts: self.starts(measured), ..point.within(&self.rig.plant) };
        // An importer's simulation of the extended model has no timing of channels, except where the report gives it: a
        // signal's delay and lag go together.
        let output = |term: &Term| match term {
            Term::Fault(Unknown::Output(output, Fault::Delay | Fault::Lag)) | Term::Response(output) => {
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

    /// Drops rivals that later effects rule out: in their effect's place, they leave more. A fit cut short by the time limit rules
    /// nothing out.
    pub(super) fn tell_apart(&self, found: &mut Found) {
        if self.deadline.is_over(Stage::Search) {
            return;
        }
        for index in 0..found.accepted.len().saturating_sub(1) {
            let Accepted { term, rivals, .. } = &found.accepted[index];
            let stays = |rival: &&Term| {
                let other = self.in_place_of(found, *term, **rival);
                other.is_ok_and(|it| {
                    let as_good = self.as_good(&found.base, &found.extended, &it);
                    as_good && self.is_sized_in(**rival, &it, &found.base)
                })
            };
            found.accepted[index].rivals = rivals.par_iter().filter(stays).copied().collect();
        }
    }

    /// The extended model with a rival in the place of an effect: without the effect where the rival is there already.
    ///
    /// # Errors
    /// If the rival's model refuses its settings or diverges.
    pub(crate) fn in_place_of(&self, found: &Found, effect: Term, rival: Term) -> Result<Fitted, String> {
        let mut terms = found.extended.terms.clone();
        let there = terms.contains(&rival);
        match terms.iter().position(|it| *it == effect) {
            Some(place) if there => drop(terms.remove(place)),
            Some(place) => terms[place] = rival,
            None => (),
        }
        let tried = found.tried.iter().rev().filter(|it| it.term == rival);
        let tried = tried.filter_map(|it| it.fitted.as_ref().ok()).next();
        let start = match tried {
            Some(tried) if tried.terms == terms => tried.point.clone(),
            _ => {
                let mut point = self.point_without(effect, &found.extended, &found.base);
                let of = tried.map_or(&found.base.point, |it| &it.point);
                let own = if there { Vec::new() } else { self.own_coordinates(rival) };
                own.iter().for_each(|it| point.set(it.handle, of.get(it.handle)));
                point
            }
        };
        self.fitted(&terms, &[start], Stop::NOISY)
    }

    /// A fit's point with an effect as the starting model has it.
    fn point_without(&self, effect: Term, fitted: &Fitted, base: &Fitted) -> Estimate {
        let mut point = fitted.point.clone();
        self.own_coordinates(effect).iter().for_each(|it| point.set(it.handle, base.point.get(it.handle)));
        point
    }

    /// Takes an effect back. Effects that were found later stay if they explain it: if the model without it is as good, and each
    /// of them passes on its own.
    pub(super) fn explained_away(&self, found: &mut Found, index: usize) {
        if self.without(found, index).is_none() {
            self.retract(found, index);
        }
    }

    fn without(&self, found: &mut Found, index: usize) -> Option<()> {
        let term = found.accepted[index].term;
        let (mut accepted, mut stages) = (found.accepted[..index].to_vec(), found.stages[..index].to_vec());
        for (effect, later) in found.accepted.iter().zip(&found.stages).skip(index + 1) {
            let terms: Vec<Term> = later.terms.iter().copied().filter(|it| *it != term).collect();
            let start = self.point_without(term, later, &found.base);
            let fitted = self.fitted(&terms, &[start], Stop::NOISY).ok()?;
            let before = stages.last().unwrap_or(&found.base);
            let evidence = self.evidence(effect.term, &found.base, before, &fitted);
            if evidence.refusal().is_some() {
                return None;
            }
            accepted.push(Accepted { evidence, ..effect.clone() });
            stages.push(fitted);
        }
        let last = stages.get(index..)?.last()?.clone();
        if !self.as_good(&found.base, &found.extended, &last) {
            return None;
        }
        found.retracted.push(term);
        (found.accepted, found.stages, found.extended) = (accepted, stages, last);
        Some(())
    }

    /// Takes an effect back, and with it what was found beside it later: that is to be found again without it.
    pub(super) fn retract(&self, found: &mut Found, index: usize) {
        found.retracted.push(found.accepted[index].term);
        found.accepted.truncate(index);
        found.stages.truncate(index);
        let kept = |curve: Term| found.accepted.iter().any(|it| it.term == curve);
        found.unmodelled.retain(|it| it.curve.is_some_and(kept));
        found.extended = found.stages.last().unwrap_or(&found.base).clone();
    }
}

/// The fit of a measured output by its residuals; not a number where the simulation runs away.
fn fit_of(measured: &[Dataset], residuals: &Residuals, row: usize) -> f64 {
    let (mut left, mut values) = (Vec::new(), Vec::new());
    for (record, residuals) in measured.iter().zip(residuals) {
        for section in &record.sections {
            let pairs =
                record.measured[row].values[section.clone()].iter().zip(&residuals[row][section.clone()]);
            for (value, residual) in pairs.filter(|(value, _)| value.is_finite()) {
                values.push(*value);
                left.push(*residual);
            }
        }
    }
    if left.iter().all(|it| it.is_finite()) { phi(&left, &values) } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;

    #[test]
    fn what_runs_away_is_no_perfect_fit() {
        let values: Vec<f64> = (0..100).map(|k| f64::from(k).sin()).collect();
        let with = |values: Vec<f64>| Dataset {
            step: 1e-3,
            measured: vec![Measured { output: 0, values, noise_floor: 0.0 }],
            sections: std::iter::once(0..100).collect(),
            ..Dataset::default()
        };
        let left = vec![vec![vec![0.01; 100]]];
        let close = fit_of(&[with(values.clone())], &left, 0);
        assert!((0.98..1.0).contains(&close), "{close}");
        let mut lost = left.clone();
        lost[0][0][50..].fill(f64::NAN);
        assert!(fit_of(&[with(values.clone())], &lost, 0).is_nan());
        // Samples that the sensor got wrong are not compared.
        let mut wrong = values;
        wrong[50..].fill(f64::NAN);
        assert!(fit_of(&[with(wrong)], &lost, 0) > 0.97);
    }
}
