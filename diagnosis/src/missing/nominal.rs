//! Nominal parameters by the balance of what the sensors show, with any signal missing beside them.

use std::ops::Range;

use rayon::prelude::*;

use crate::estimation::coordinates::TOLERANCE;
use crate::estimation::hypothesis::Baseline;
use crate::estimation::unknowns::{Estimate, Unknown};

use super::innovations::{Columns, Noise, Stretch};
use super::likelihood::Amounts;
use super::{Frame, stretches};

/// Least share of a nominal value that a parameter is believed to have, where it cannot be zero.
const LEAST: f64 = 0.3;
/// Share of each port's size that may be missing while stated parameters are corrected.
const LOOSE: [f64; 1] = [0.03];
/// Shares that are tried while parameters without a value are: a missing signal that is held to be smaller than it is bends
/// them.
const ANY: [f64; 4] = [0.03, 0.1, 0.3, 1.0];
/// How often the nominal parameters are corrected where all of them are stated, and at most where one is not.
const ROUNDS: [usize; 2] = [2, 10];
/// Powers of ten by which what has no value and must not be zero may be off.
const DECADES: Range<i32> = -9..5;
/// Fall of the log-likelihood a decade to either side by which a parameter's order is clearly the right one (R. E. Kass and
/// A. E. Raftery, J. Am. Stat. Assoc. 90, 1995, 773–795: very strong evidence).
const CLEARLY: f64 = 5.0;
/// Samples that tell the order of a parameter, and how many of them are in one go: fewer show too little of what is slow.
const ENOUGH: (usize, usize) = (1500, 500);
/// Largest logarithm of the factor by which a round changes it.
const FACTOR: f64 = 1.0;
/// Relative change of a parameter without a value below which the rounds end.
const SETTLED: f64 = 0.01;

/// What a trajectory is about.
pub(super) struct About<'a, 'b> {
    pub frame: &'a Frame,
    /// Variances of the measured outputs' errors, where they are known by now.
    pub errors: Option<&'b [f64]>,
    /// Stretches of the records that are looked at, those of the estimation records first.
    pub stretches: &'b [(usize, Range<usize>)],
    /// What is late of each channel.
    pub timing: &'b [Unknown],
}

impl Baseline<'_> {
    /// Whether neither a data sheet nor the user gives a parameter's value: the model's own is of no meaning then.
    fn is_unstated(&self, index: usize) -> bool {
        !self.rig.stated[index] && !self.known.iter().any(|(known, _, _)| *known == index)
    }

    /// Whether not even the order of a parameter is known: what may be zero starts there, and a step tells its size.
    pub(crate) fn is_of_unknown_order(&self, index: usize) -> bool {
        self.is_unstated(index) && self.least(index) > 0.0
    }

    /// Nominal parameters from the balance alone, without a simulation.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges along every stretch.
    pub(crate) fn balanced(&self, at: &Estimate) -> Result<Vec<f64>, String> {
        let mut frame = self.frame(&[], at)?;
        frame.far = true;
        Ok(self.missing(&frame)?.point().parameters)
    }

    /// What was known of each nominal parameter before.
    pub(super) fn precisions(&self, parameters: &[usize]) -> Vec<f64> {
        let of = |index: &usize| {
            let known = self.known.iter().find(|(known, _, _)| known == index);
            let value = self.rig.parameters[*index];
            match known {
                Some((_, _, deviation)) => deviation.powi(-2),
                None if value == 0.0 || self.is_unstated(*index) => 0.0,
                None => (TOLERANCE * value).powi(-2),
            }
        };
        parameters.iter().map(of).collect()
    }

    /// Corrects the nominal parameters as far as the missing signals allow: before the last step, and behind it.
    pub(super) fn nominal_by_balance(&self, about: &About<'_, '_>, precisions: &[f64]) -> [Estimate; 2] {
        // Nominal parameters answer to the estimation records only.
        let own = about.stretches.partition_point(|(record, _)| *record < self.train.len());
        let about = &About { stretches: &about.stretches[..own], ..*about };
        let mut point = about.frame.point.clone();
        for (index, value, _) in &self.known {
            point.parameters[*index] = *value;
        }
        let parameters = about.frame.parameters.iter().copied();
        let unstated: Vec<usize> = parameters.filter(|it| self.is_of_unknown_order(*it)).collect();
        let (shares, rounds) =
            if unstated.is_empty() { (&LOOSE[..], ROUNDS[0]) } else { (&ANY[..], ROUNDS[1]) };
        if about.frame.far {
            let few = stretches(&about.frame.records[..self.train.len()], ENOUGH.0, ENOUGH.1);
            let roughly = About { stretches: &few, ..*about };
            for index in &unstated {
                point = self.of_the_right_order(&roughly, (precisions, shares), *index, &point);
            }
        }
        let mut before = point.parameters.clone();
        for _ in 0..rounds {
            if self.deadline.is_past() {
                break;
            }
            // A step too far is taken back.
            let Ok(Some((_, fitted))) = self.corrected(about, (precisions, shares), &point) else {
                point.parameters.clone_from(&before);
                break;
            };
            before.clone_from(&point.parameters);
            for (index, step) in about.frame.parameters.iter().zip(fitted.values.iter()) {
                point.parameters[*index] = self.moved(*index, before[*index], *step);
            }
            if about.frame.dynamics.check(&point.parameters).is_err() {
                point.parameters.clone_from(&before);
                break;
            }
            let moved = |index: &usize| {
                (point.parameters[*index] - before[*index]).abs() > SETTLED * before[*index].abs()
            };
            if !unstated.is_empty() && !unstated.iter().any(moved) {
                break;
            }
        }
        [Estimate { parameters: before, ..point.clone() }, point]
    }

    /// A point with one parameter of the order that makes the record likeliest: a force moves a mass that is off by decades
    /// so little, or so much, that no derivative tells how to go on.
    fn of_the_right_order(
        &self,
        about: &About<'_, '_>,
        shares: (&[f64], &[f64]),
        index: usize,
        point: &Estimate,
    ) -> Estimate {
        let most = self.rig.plant.parameters[index].max.unwrap_or(f64::INFINITY);
        let at = |decade: i32| {
            let mut scaled = point.clone();
            scaled.parameters[index] *= 10.0_f64.powi(decade);
            let possible = (self.least(index)..=most).contains(&scaled.parameters[index]);
            if !possible || self.deadline.is_past() {
                return None;
            }
            let (likelihood, _) = self.corrected(about, shares, &scaled).ok()??;
            Some((likelihood, scaled))
        };
        let near: Vec<(f64, Estimate)> = [0, -1, 1].into_par_iter().filter_map(at).collect();
        if let [(here, _), (less, _), (more, _)] = &near[..]
            && here - less.max(*more) > CLEARLY
        {
            return point.clone();
        }
        let further = DECADES.into_par_iter().filter(|it| it.abs() > 1).filter_map(at);
        let all: Vec<(f64, Estimate)> = near.into_par_iter().chain(further).collect();
        all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(|| point.clone(), |(_, best)| best)
    }

    /// The likelihood of the estimation records about a point, and the corrections that make them likeliest; none if they
    /// cannot be told apart.
    fn corrected(
        &self,
        about: &About<'_, '_>,
        (precisions, shares): (&[f64], &[f64]),
        point: &Estimate,
    ) -> Result<Option<(f64, Amounts)>, String> {
        let (setting, windows) = self.along(about, point)?;
        let tried = shares.iter().filter_map(|share| {
            let noise =
                Noise { ports: setting.shared(*share), outputs: setting.noise.clone(), simulated: None };
            let stretches = setting.innovations(&windows, &noise, Columns::default());
            let normal = Stretch::total(&stretches, |record| record < self.train.len())?.known();
            Some((normal.log_likelihood(precisions), normal.fitted(precisions)?))
        });
        Ok(tried.filter(|(likelihood, _)| likelihood.is_finite()).max_by(|a, b| a.0.total_cmp(&b.0)))
    }

    fn least(&self, index: usize) -> f64 {
        self.rig.plant.parameters[index].min.unwrap_or(f64::NEG_INFINITY)
    }

    /// Whether a step takes away most of a parameter that cannot be zero, as a mass.
    pub(crate) fn is_gone(&self, index: usize, before: f64, step: f64) -> bool {
        let cannot_be_zero = self.rig.plant.parameters[index].min.is_some_and(|least| least > 0.0);
        let nominal = if self.is_unstated(index) { before } else { self.rig.parameters[index] };
        cannot_be_zero && before + step < LEAST * nominal
    }

    /// A nominal parameter after a step. What has no value and must not be zero may be off by much: its logarithm moves.
    fn moved(&self, index: usize, before: f64, step: f64) -> f64 {
        let least = self.least(index);
        let most = self.rig.plant.parameters[index].max.unwrap_or(f64::INFINITY);
        if self.is_unstated(index) {
            let moved = if least > 0.0 {
                before * (step / before).clamp(-FACTOR, FACTOR).exp()
            } else {
                before + step
            };
            return moved.clamp(least, most);
        }
        let known = self.known.iter().find(|(known, _, _)| *known == index).map(|(_, value, _)| *value);
        let nominal = known.unwrap_or(self.rig.parameters[index]);
        let least = if least.is_finite() { least.max(LEAST * nominal) } else { least };
        (before + step).clamp(least.min(before), most.max(before))
    }
}
