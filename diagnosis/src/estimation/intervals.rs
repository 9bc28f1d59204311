//! How sure the coordinates of a fit are.
//!
//! Four things make a coordinate uncertain. Noise: the spread of its scores over blocks of the estimation data. What was known
//! before, where the data tell no more: the values of a parameter set have a tolerance of their own. Excitations:
//! errors of a model that is not quite right pull its parameters differently in each; what each excitation on its own would
//! say is compared, validation data included, and the variance between them, after DerSimonian and Laird (Meta-analysis in
//! clinical trials, Controlled Clinical Trials 7, 1986), widens the interval. And what pulls alike in all excitations: small
//! effects that are not in the model. Each effect of the catalogue that is not is assumed to be there by as much as the
//! errors contain of it. The move of the coordinate with it is added, in squares, and as much again, since it hardly
//! has the shape in which it is tried. Assumed effects together are no larger than all remaining errors: more would have to
//! be compensated by the parameters. Another shape of an identified effect takes its place and is not
//! beside it: confirmation compares the two.

use std::ops::Range;

use nalgebra::DMatrix;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::dataset::recorded::Dataset;
use crate::decision::disagreement::{Wish, wish};
use crate::estimation::beside::Assumed;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::lsq::Problem;
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};

/// Excitations that are compared at least: fewer records are cut in pieces.
const EXCITATIONS: usize = 4;
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
    /// Whether what was known before makes most of its uncertainty: the data tell it only together with others.
    pub from_parameter_set: bool,
    /// What each record on its own would choose, estimation records first.
    pub wishes: Vec<Wish>,
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

    /// Its upper end, within what is possible.
    pub fn high(&self) -> f64 {
        (self.value + self.half).min(self.bounds.1)
    }
}

/// What an excitation on its own says of a coordinate.
#[derive(Clone, Copy, Debug)]
struct Opinion {
    /// Change from the fitted value.
    shift: f64,
    /// Its variance.
    variance: f64,
    /// Whether it is estimation data.
    estimation: bool,
    /// The record's number, estimation records first.
    record: usize,
}

impl Baseline<'_> {
    /// The interval of each coordinate of a fit.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn intervals(&self, fitted: &Fitted) -> Result<Vec<Interval>, String> {
        let own = fitted.linear.robust_covariance(&fitted.trace.scores);
        let [before, vouched_for] = [false, true].map(|it| fitted.linear.sandwich(&fitted.priors(it)));
        let opinions = self.opinions(fitted)?;
        let dynamics = self.dynamics(&fitted.terms)?;
        let fit = self.fit(&*dynamics, self.train, fitted.coordinates.clone());
        let count: f64 = self.errors(&fitted.train).effective_counts().iter().sum();
        let norms = fitted.linear.column_norms();
        let amounts: Vec<Unknown> = fitted.terms.iter().flat_map(|term| self.sizes(*term)).collect();
        let Assumed { pulls, twins } = self.assumed(fitted)?;
        let interval = |(index, coordinate): (usize, &FreeParameter)| {
            let all: Vec<Opinion> = opinions.iter().map(|excitation| excitation[index]).collect();
            let (between, quantile) = between(&all);
            let pulled: f64 = pulls.iter().map(|pull| pull[index].powi(2)).sum();
            let variance =
                NORMAL.powi(2) * own[(index, index)].max(0.0) + quantile.powi(2) * between + 2.0 * pulled;
            let value = fitted.point.get(coordinate.handle);
            let (handle, bounds) = (coordinate.handle, coordinate.bounds);
            let said = |record: usize| {
                let of = all.iter().filter(move |it| it.record == record);
                of.map(|it| (value + it.shift, it.variance)).collect::<Vec<_>>()
            };
            let records = 0..self.train.len() + self.test.len();
            let wishes = records.filter_map(|record| wish(record, &said(record))).collect();
            let twins = twins[index].clone();
            let mut half_of_data = variance.sqrt();
            let of = |known: &DMatrix<f64>| NORMAL.powi(2) * known[(index, index)].max(0.0);
            // Of what was known before, the data have to leave some uncertainty, too.
            let slope = coordinate.prior.map_or(f64::INFINITY, |it| it.distance(value).1);
            let is_open = before[(index, index)].sqrt() * slope > OPEN;
            let from_parameter_set = of(&before) > FROM_SET * variance && is_open;
            let mut half = (variance + of(&vouched_for)).sqrt();
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
                    (half, half_of_data) = (f64::INFINITY, f64::INFINITY);
                }
            }
            Interval { handle, value, half, half_of_data, from_parameter_set, wishes, twins, bounds }
        };
        Ok(fitted.coordinates.iter().enumerate().map(interval).collect())
    }

    /// What each excitation says of each coordinate: a Gauss–Newton step from the fit.
    fn opinions(&self, fitted: &Fitted) -> Result<Vec<Vec<Opinion>>, String> {
        let dynamics = self.dynamics(&fitted.terms)?;
        let of = |record: &Dataset, estimation: bool, number: usize| {
            let records = std::slice::from_ref(record);
            let starts = self.starts(records);
            let fit = self.fit(&*dynamics, records, fitted.coordinates.clone());
            let point = fit.settled(Estimate { starts, ..fitted.point.clone() });
            let (linear, trace) = fit.linearise(&point);
            let shift = linear.minimiser();
            let covariance = linear.robust_covariance(&trace.scores);
            let one = |index: usize| {
                let variance = covariance[(index, index)];
                Opinion { shift: shift[index], variance, estimation, record: number }
            };
            (0..fitted.coordinates.len()).map(one).collect()
        };
        let pieces = EXCITATIONS.div_ceil(self.train.len() + self.test.len());
        let all = self.train.iter().map(|it| (it, true)).chain(self.test.iter().map(|it| (it, false)));
        let cut = all.enumerate().flat_map(|(number, (record, estimation))| {
            cut(record, pieces)
                .into_iter()
                .map(move |sections| (Dataset { sections, ..record.clone() }, estimation, number))
        });
        Ok(cut.map(|(record, estimation, number)| of(&record, estimation, number)).collect())
    }
}

/// A record's sections in so many pieces.
fn cut(record: &Dataset, pieces: usize) -> Vec<Vec<Range<usize>>> {
    if pieces < 2 {
        return vec![record.sections.clone()];
    }
    let length = record.len().div_ceil(pieces).max(1);
    let piece = |number: usize| -> Vec<Range<usize>> {
        let (start, end) = (number * length, (number + 1) * length);
        let part = |it: &Range<usize>| it.start.max(start)..it.end.min(end);
        // What is shorter than a block says nothing on its own.
        record.sections.iter().map(part).filter(|it| it.len() > record.block()).collect()
    };
    (0..pieces).map(piece).filter(|sections| !sections.is_empty()).collect()
}

/// The variance that differences between excitations bring to estimates from some of them, and the quantile of
/// Student's distribution that belongs to it.
fn between(opinions: &[Opinion]) -> (f64, f64) {
    // A piece of one block has no variance that could be told, and a coordinate that does nothing in it an infinite one.
    let told = |it: &&Opinion| it.shift.is_finite() && it.variance.is_finite() && it.variance > 0.0;
    let known: Vec<&Opinion> = opinions.iter().filter(told).collect();
    let freedom = known.len() as f64 - 1.0;
    let sum = |of: &dyn Fn(&Opinion) -> f64| known.iter().map(|it| of(it)).sum::<f64>();
    let weight = |it: &Opinion| 1.0 / it.variance;
    let (first, second) = (sum(&weight), sum(&|it| weight(it).powi(2)));
    if freedom < 1.0 {
        return (0.0, 0.0);
    }
    let spread = first - second / first;
    let mean = sum(&|it| weight(it) * it.shift) / first;
    let excess = sum(&|it| weight(it) * (it.shift - mean).powi(2)) - freedom;
    let each = (excess / spread).max(0.0);
    let weights = |power: i32| sum(&|it| if it.estimation { weight(it).powi(power) } else { 0.0 });
    let share = weights(2) / weights(1).powi(2).max(f64::MIN_POSITIVE);
    let quantile = StudentsT::new(0.0, 1.0, freedom).map_or(NORMAL, |it| it.inverse_cdf(0.975));
    (each * share, quantile)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;
    use crate::plant::Between;

    fn opinions(shifts: &[f64], variance: f64) -> Vec<Opinion> {
        let of = |(index, shift): (usize, &f64)| Opinion {
            shift: *shift,
            variance,
            estimation: index < 2,
            record: index,
        };
        shifts.iter().enumerate().map(of).collect()
    }

    /// With equal weights the estimator is the sample variance less the variance within, and half of it is left of two
    /// records of the estimation data.
    #[test]
    fn equal_opinions_leave_the_sample_variance_less_that_within() {
        let (between, quantile) = between(&opinions(&[1.0, -1.0, 3.0, -3.0], 0.5));
        assert!((between - 0.5 * (20.0 / 3.0 - 0.5)).abs() < 1e-12, "{between}");
        // Student's distribution with three degrees of freedom.
        assert!((quantile - 3.182).abs() < 1e-3, "{quantile}");
    }

    #[test]
    fn opinions_that_differ_by_less_than_their_variance_widen_nothing() {
        assert_eq!(between(&opinions(&[0.1, -0.1, 0.2, -0.2], 1.0)).0, 0.0);
    }

    #[test]
    fn what_no_variance_is_known_of_does_not_count() {
        let all = opinions(&[1.0, -1.0, 3.0, -3.0], 0.5);
        let unknown = [f64::INFINITY, 0.0].map(|variance| Opinion {
            shift: 7.0,
            variance,
            estimation: true,
            record: 0,
        });
        assert_eq!(between(&[all.clone(), unknown.to_vec()].concat()), between(&all));
        assert_eq!(between(&[all[..1].to_vec(), unknown.to_vec()].concat()), (0.0, 0.0));
    }

    #[test]
    fn a_record_is_cut_where_it_may_be() {
        let sections = vec![0..700, 750..1000];
        let (name, inputs, between, measured) = (String::new(), vec![], Between::Lines, vec![]);
        let record =
            Dataset { name, step: 1e-3, inputs, between, measured, others: vec![], errors: vec![], sections };
        assert_eq!(cut(&record, 1).concat(), record.sections);
        let measured = vec![Measured { output: 0, values: vec![0.0; 2000], noise_floor: 1.0 }];
        let long = Dataset { measured, sections: vec![0..1400, 1450..2000], ..record };
        // Of the first section's second half, 400 samples are less than a block.
        let pieces = cut(&long, 2);
        assert_eq!((pieces.len(), pieces.concat()), (2, vec![0..1000, 1450..2000]));
    }
}
