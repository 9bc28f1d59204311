//! How sure the coordinates of a fit are.
//!
//! Four things make a coordinate uncertain. Noise: the spread of its scores over blocks of the estimation data. What was known
//! before, where the data tell no more: the values of a parameter set have a tolerance of their own, and so
//! has a common scale that no record tells. Excitations:
//! errors of a model that is not quite right pull its parameters differently in each; what each excitation on its own would
//! say is compared, validation data included, and the variance between them, after DerSimonian and Laird (Meta-analysis in
//! clinical trials, Controlled Clinical Trials 7, 1986), widens the interval. And what pulls alike in all excitations: small
//! effects that are not in the model. Each effect of the catalogue that is not is assumed to be there by as much as the
//! errors contain of it. The move of the coordinate with it is added, in squares, and as much again, since it hardly
//! has the shape in which it is tried. Assumed effects together explain no more than all remaining errors, however much of
//! them the parameters have compensated: that is what pulls them. Another shape of an identified effect takes its place and is not
//! beside it: confirmation compares the two.

mod excitations;
mod ratios;

use nalgebra::DMatrix;

use crate::decision::disagreement::Wish;
use crate::estimation::beside::Assumed;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::lsq::Problem;
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};

use excitations::{Opinion, between, opinions, wishes};

/// Share of the rise of the cost at an interval's ends that is asked for: of what the derivative promises, or of what makes 95 %,
/// whichever is less. Near a limit of a law, its derivative may be infinite, and the interval more than ten times too narrow.
const BORNE_OUT: f64 = 0.01;
/// Standard deviation that the data leave of what was known before, in that, from which they tell a coordinate only together with
/// others: a scale that six parameters share leaves two fifths.
const OPEN: f64 = 0.1;
/// Variance that the values of a parameter set bring, over that of the data, from which a coordinate is mostly theirs.
const FROM_SET: f64 = 3.0;
/// Quantile of the normal distribution for 95 % within.
const NORMAL: f64 = 1.96;

/// What is known of a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The coordinate.
    pub handle: Unknown,
    /// Its value.
    pub value: f64,
    /// Half the interval that holds the true value with 95 %; infinite if nothing is known.
    pub half: f64,
    /// The same if what was known before were exact: what the data alone tell, beside the scale of the parameter set.
    pub half_of_data: f64,
    /// The same if no effect that is not in the model pulled at it, either: whether it moved at all, whatever moved it.
    pub half_of_noise: f64,
    /// Half the interval at the scale of the parameter that keeps its value; none where the scale is known or does not matter.
    pub half_of_ratio: Option<f64>,
    /// Whether what was known before makes most of its uncertainty: the data tell it only together with others.
    pub from_parameter_set: bool,
    /// What each record on its own would choose, estimation records first.
    pub wishes: Vec<Wish>,
    /// The parameter that is the same in all of them, where records tell only ratios.
    pub yardstick: Option<Unknown>,
    /// Effects that do on these records what the coordinate does.
    pub twins: Vec<Term>,
    /// Values that are possible.
    bounds: (f64, f64),
}

impl Interval {
    /// Its lower end, within what is possible.
    pub fn low(&self) -> f64 {
        (self.value - self.half).max(self.bounds.0)
    }

    /// Both ends at the scale of the parameter that keeps its value.
    pub fn of_ratio(&self) -> Option<[f64; 2]> {
        let half = self.half_of_ratio?;
        Some([(self.value - half).max(self.bounds.0), (self.value + half).min(self.bounds.1)])
    }

    /// The other end where the value is at one end of its bounds, if that leaves a part of them out.
    pub fn limit(&self) -> Option<f64> {
        let (least, largest) = self.bounds;
        let (low, high) = (self.low(), self.high());
        let limit = match (self.value <= least, self.value >= largest) {
            (true, false) => (high < largest).then_some(high),
            (false, true) => (low > least).then_some(low),
            _ => None,
        };
        limit.filter(|it| it.is_finite())
    }

    /// Its upper end, within what is possible.
    pub fn high(&self) -> f64 {
        (self.value + self.half).min(self.bounds.1)
    }
}

impl Baseline<'_> {
    /// The interval of each coordinate of a fit.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn intervals(&self, fitted: &Fitted) -> Result<Vec<Interval>, String> {
        let own = fitted.linear.robust_covariance(&fitted.trace.scores);
        let [before, vouched_for] = [false, true].map(|it| fitted.linear.sandwich(&fitted.priors(it)));
        let excitations = self.excitations(fitted)?;
        let held = fitted.coordinates.iter().position(|it| self.is_yardstick(it.handle));
        let opinions = opinions(&excitations, held);
        let dynamics = self.dynamics(&fitted.terms)?;
        let fit = self.fit(&*dynamics, self.train, fitted.coordinates.clone());
        let count: f64 = self.errors(&fitted.train).effective_counts().iter().sum();
        let norms = fitted.linear.column_norms();
        let amounts: Vec<Unknown> = fitted.terms.iter().flat_map(|term| self.sizes(*term)).collect();
        let Assumed { pulls, twins } = self.assumed(fitted)?;
        let interval = |(index, coordinate): (usize, &FreeParameter)| {
            let all: Vec<Opinion> = opinions.iter().map(|excitation| excitation[index]).collect();
            let (between, quantile) = between(&all, own[(index, index)]);
            let pulled: f64 = pulls.iter().map(|pull| pull[index].powi(2)).sum();
            let noise = NORMAL.powi(2) * own[(index, index)].max(0.0) + quantile.powi(2) * between;
            let variance = noise + 2.0 * pulled;
            let value = fitted.point.get(coordinate.handle);
            let (handle, bounds) = (coordinate.handle, self.released(coordinate).bounds);
            let wishes = wishes(value, &all);
            let twins = twins[index].clone();
            let mut half_of_data = variance.sqrt();
            let of = |known: &DMatrix<f64>| NORMAL.powi(2) * known[(index, index)].max(0.0);
            let data = variance / NORMAL.powi(2);
            let scale = self.variance_of_scale(handle, value);
            let from_parameter_set = scale > FROM_SET * data
                || is_of_parameter_set(coordinate, &fitted.point, [before[(index, index)], data]);
            let of_ratio = variance + of(&vouched_for);
            let mut half = (of_ratio + NORMAL.powi(2) * scale).sqrt();
            let mut half_of_ratio = (scale > 0.0).then_some(of_ratio.sqrt());
            if amounts.contains(&handle) && half_of_data.is_finite() {
                let promised = 0.5 * (norms[index] * half_of_data).powi(2);
                let enough = BORNE_OUT * promised.min(fitted.cost * NORMAL.powi(2) / count);
                // On either side: on one, the integration may take other steps, and the cost may jump with that.
                let borne_out = [value - half_of_data, value + half_of_data].into_iter().any(|moved| {
                    let mut point = fitted.point.clone();
                    point.set(handle, moved);
                    bounds.0 <= moved && moved <= bounds.1 && fit.cost(&point) - fitted.cost >= enough
                });
                if !borne_out {
                    (half, half_of_data, half_of_ratio) = (f64::INFINITY, f64::INFINITY, None);
                }
            }
            let yardstick = None;
            Interval {
                handle,
                value,
                half,
                half_of_ratio,
                half_of_data,
                half_of_noise: noise.sqrt(),
                from_parameter_set,
                wishes,
                yardstick,
                twins,
                bounds,
            }
        };
        let mut intervals: Vec<Interval> = fitted.coordinates.iter().enumerate().map(interval).collect();
        let is_scaled = |index: &usize| self.is_scaled(fitted.coordinates[*index].handle);
        let scaled: Vec<usize> = (0..intervals.len()).filter(is_scaled).collect();
        ratios::compare(&mut intervals, &scaled, &excitations);
        Ok(intervals)
    }
}

/// Whether what was known before makes most of a coordinate's uncertainty, by the variances that it and the data leave.
fn is_of_parameter_set(coordinate: &FreeParameter, at: &Estimate, [before, data]: [f64; 2]) -> bool {
    // Of what was known before, the data have to leave some uncertainty, too.
    let is_open = coordinate.distance(at).is_none_or(|(_, slope)| before.sqrt() * slope > OPEN);
    before > FROM_SET * data && is_open
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_at_the_end_of_its_range_has_a_limit_if_the_records_tell_one() {
        let of = |value: f64, half: f64| {
            let it = Interval {
                handle: Unknown::Parameter(0),
                value,
                half,
                half_of_data: half,
                half_of_noise: half,
                half_of_ratio: None,
                from_parameter_set: false,
                wishes: Vec::new(),
                yardstick: None,
                twins: Vec::new(),
                bounds: (0.2, 4.0),
            };
            it.limit()
        };
        assert_eq!((of(0.2, 0.1), of(4.0, 1.5)), (Some(0.2 + 0.1), Some(2.5)));
        assert_eq!(of(1.0, 0.1), None);
        // All of the range is no limit.
        assert_eq!((of(0.2, f64::INFINITY), of(4.0, 5.0)), (None, None));
    }
}
