//! Balances of measured signals ("parity residuals"), for a body and a wheel above a road.
//!
//! An error of a simulation is made of all that is wrong anywhere. A balance holds but a few sensors and at most one law,
//! so that it tells where to look: r4 has no law in it, r2 no force between body and wheel. All terms of all balances pass
//! the same filter, up to where the measured deflection stands out from its noise: its second derivative would be nothing
//! but noise beyond.

mod balance;
mod laws;
mod stretch;

use crate::diagnosis::{Diagnosis, root_mean_square, simulated};
use crate::estimation::hypothesis::Term;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::report::findings::Parity;
use crate::signal::distortion::Fault;

use super::shown;
use balance::{BALANCES, Balance, EDGE};
use laws::Laws;
use stretch::{Rigged, Stretch};

/// Samples that are shown in the shortest period.
const FINE: f64 = 5.0;

/// A model to be balanced with, over the validation records as they were measured.
struct Judged {
    laws: Laws,
    point: Estimate,
    /// The model's outputs on each record, for the velocities that nothing measures.
    simulated: Vec<Vec<Vec<f64>>>,
}

impl Diagnosis<'_> {
    /// Every balance, those included that cannot be formed; none if the rig is not a body and a wheel.
    pub(super) fn parity(&self) -> Vec<Parity> {
        let terms = self.found.extended.terms.clone();
        let models = [
            (&[][..], self.as_given()),
            (&[], self.without(&terms)),
            (&terms, self.found.extended.point.clone()),
        ];
        let judged: Option<Vec<Judged>> =
            models.into_iter().map(|(terms, point)| self.judged(terms, point)).collect();
        let (Some(judged), Some(record)) = (judged, self.measured.first()) else { return Vec::new() };
        let Some(extended) = judged.last() else { return Vec::new() };
        let rigged = Rigged { plant: &self.baseline.rig.plant, record, point: &extended.point, noisy: false };
        let band = rigged.band();
        let stretches: Vec<_> = judged.iter().map(|model| self.stretches(model, band, false)).collect();
        let noisy = self.stretches(extended, band, true);
        let balance = |it: &Balance| {
            let mut parity = it.unformed(band, rigged);
            if parity.needs.is_some() {
                return parity;
            }
            let left = |model: &Judged, stretches: &[Vec<Stretch>]| -> Option<Vec<Vec<f64>>> {
                let records = self.measured.iter().zip(stretches);
                records.map(|(record, stretches)| it.over(record, &model.laws, stretches)).collect()
            };
            let all: Option<Vec<_>> =
                judged.iter().zip(&stretches).map(|(model, stretches)| left(model, stretches)).collect();
            let (Some([start, fitted, after]), Some(noisy)) = (all.as_deref(), left(extended, &noisy)) else {
                return parity;
            };
            if known(after).next().is_none() {
                parity.needs = Some(format!("a stretch of more than {} s without a gap", 2.0 * EDGE));
                return parity;
            }
            let noise: Vec<Vec<f64>> =
                noisy.iter().zip(after).map(|(noisy, clean)| less(noisy, clean)).collect();
            (parity.rms_before, parity.rms_fitted) = (rms(start), rms(fitted));
            (parity.rms_after, parity.noise) = (rms(after), rms(&noise));
            let stride = ((1.0 / (FINE * band * record.step)) as usize).max(1);
            let thin = |values: &[f64]| values[..shown(record)].iter().copied().step_by(stride).collect();
            (parity.before, parity.after) = (thin(&fitted[0]), thin(&after[0]));
            parity.time = (0..parity.before.len()).map(|k| (k * stride) as f64 * record.step).collect();
            parity
        };
        BALANCES.iter().map(balance).collect()
    }

    /// The starting model as it was given, with the channels' timing that the extended model has found, unless that is
    /// a fault: next to nothing, but enough to spoil a balance.
    fn as_given(&self) -> Estimate {
        let mut point = self.before.clone();
        for output in 0..point.outputs.len() {
            let timing = Unknown::Output(output, Fault::Delay);
            point.set(timing, self.found.extended.point.get(timing));
        }
        self.with_given(point, &self.found.extended.terms)
    }

    /// The extended model with what was found taken away again. The fitted starting model will not do: it has bent its
    /// masses and its timing to what it lacks, and would spoil balances that have nothing to do with it.
    fn without(&self, terms: &[Term]) -> Estimate {
        self.with_given(self.found.extended.point.clone(), terms)
    }

    /// A point with the terms' own values as they were given.
    fn with_given(&self, mut point: Estimate, terms: &[Term]) -> Estimate {
        let given = self.baseline.origin();
        for own in terms.iter().flat_map(|term| self.baseline.own_coordinates(*term)) {
            point.set(own.handle, given.get(own.handle));
        }
        point
    }

    fn judged(&self, terms: &[Term], point: Estimate) -> Option<Judged> {
        let laws = Laws::of(self.baseline.rig, &self.baseline.choices(terms), &point.parameters)?;
        let (settled, _) = self.measured(terms, &point)?;
        let simulated = simulated(&self.baseline, terms, &settled, self.measured);
        // The settled point knows nothing of the channels' timing.
        Some(Judged { laws, point, simulated })
    }

    fn stretches(&self, model: &Judged, band: f64, noisy: bool) -> Vec<Vec<Stretch>> {
        let plant = &self.baseline.rig.plant;
        let records = self.measured.iter().zip(&model.simulated);
        records
            .map(|(record, simulated)| {
                let rigged = Rigged { plant, record, point: &model.point, noisy };
                record.sections.iter().map(|section| rigged.stretch(section, band, simulated)).collect()
            })
            .collect()
    }
}

fn known(left: &[Vec<f64>]) -> impl Iterator<Item = f64> + '_ {
    left.iter().flatten().copied().filter(|it| it.is_finite())
}

/// Root mean square over all records; not a number if nothing is known.
fn rms(left: &[Vec<f64>]) -> f64 {
    let known: Vec<f64> = known(left).collect();
    if known.is_empty() { f64::NAN } else { root_mean_square(&known) }
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
