//! How sure the coordinates of a fit are.
//!
//! Three things make a coordinate uncertain. Noise: the spread of its scores over blocks of the training data. Excitations:
//! errors of a model that is not quite right pull its parameters differently in each; what each excitation on its own would
//! say is compared, held-out ones included, and the variance between them, after DerSimonian and Laird (Meta-analysis in
//! clinical trials, Controlled Clinical Trials 7, 1986), widens the interval. And what pulls alike in all excitations: small
//! effects that are not in the model. Each effect of the catalogue that is not is assumed to be there by as much as the
//! errors contain of it. The move of the coordinate with it is added, in squares, and as much again, since it hardly
//! has the shape in which it is tried. Assumed effects together are no larger than all remaining errors: more would have to
//! be compensated by the parameters. Another shape of an identified effect takes its place and is not
//! beside it: confirmation compares the two.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::confirm::worth;
use crate::dataset::recorded::Recorded;
use crate::decision::disagreement::{Wish, wish};
use crate::estimation::fit::{Coordinate, Handle, Normal, Point};
use crate::estimation::hypothesis::{Fitted, POINTS, Term, World};
use crate::estimation::lsq::Problem;
use crate::screening::TriedOut;

/// Excitations that are compared at least: fewer records are cut in pieces.
const EXCITATIONS: usize = 4;
/// Share of a column's square below which it does nothing that the coordinates could not do: it is another name for one of
/// them, as a force cell's offset is for a preload, and nothing that is left speaks of it.
const ITS_OWN: f64 = 1e-6;
/// The same of a table's points: held beyond its ends, it comes only near to the straight line that is another name for a
/// gain or a rate.
const POINTS_OWN: f64 = 1e-3;
/// Share of what an identified effect does on its own, below which columns beside it are another shape of it.
const ANOTHER_SHAPE: f64 = 0.5;
/// Quantile of the normal distribution for 95 % within.
const NORMAL: f64 = 1.96;

/// What is known of a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The coordinate.
    pub handle: Handle,
    /// Its value.
    pub value: f64,
    /// Half the interval that holds the true value with 95 %; infinite if nothing is known.
    pub half: f64,
    /// What each record on its own would choose, estimation records first.
    pub wishes: Vec<Wish>,
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
    /// Whether it was learnt from.
    learnt: bool,
    /// The record's number, estimation records first.
    record: usize,
}

impl World<'_> {
    /// The interval of each coordinate of a fit.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn intervals(&self, fitted: &Fitted) -> Result<Vec<Interval>, String> {
        let own = fitted.linear.robust_covariance(&fitted.trace.scores);
        let opinions = self.opinions(fitted)?;
        let pulls = self.pulls(fitted)?;
        let interval = |(index, coordinate): (usize, &Coordinate)| {
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
            Interval { handle, value, half: variance.sqrt(), wishes, bounds }
        };
        Ok(fitted.coordinates.iter().enumerate().map(interval).collect())
    }

    /// How far each coordinate would move beside each cause that is not in the model, the cause being in the shape in which the
    /// errors contain most of it; only of causes that are worth a fit.
    fn pulls(&self, fitted: &Fitted) -> Result<Vec<DVector<f64>>, String> {
        let TriedOut { terms, probes, normal: Normal { h, g, .. } } = self.tried_out(fitted)?;
        let mut most: Vec<Option<Pull>> = vec![None; terms.len()];
        let amounts: Vec<Handle> = fitted.terms.iter().flat_map(|term| self.sizes(*term)).collect();
        let effects = fitted.coordinates.iter().map(|it| amounts.contains(&it.handle)).collect::<Vec<_>>();
        let beside = Beside { h: &h, g: &g, effects: &effects, left: 2.0 * fitted.cost };
        for (probe, range) in &probes {
            // It can do all that a gain, a lag and a delay can, which count on their own.
            if matches!(terms[probe.term], Term::Response(_)) {
                continue;
            }
            let found = beside.pull(range).filter(|it| it.gain > worth(fitted));
            let most = &mut most[probe.term];
            if let Some(found) = found
                && most.as_ref().is_none_or(|it| found.gain > it.gain)
            {
                *most = Some(found);
            }
        }
        Ok(together(most.into_iter().flatten().collect(), beside.left))
    }

    /// What each excitation says of each coordinate: a Gauss–Newton step from the fit.
    fn opinions(&self, fitted: &Fitted) -> Result<Vec<Vec<Opinion>>, String> {
        let dynamics = self.dynamics(&fitted.terms)?;
        let of = |record: &Recorded, learnt: bool, number: usize| {
            let records = std::slice::from_ref(record);
            let starts = self.starts(records);
            let fit = self.fit(&*dynamics, records, fitted.coordinates.clone());
            let point = fit.settled(Point { starts, ..fitted.point.clone() });
            let (linear, trace) = fit.linearise(&point);
            let shift = linear.minimiser();
            let covariance = linear.robust_covariance(&trace.scores);
            let one = |index: usize| {
                let variance = covariance[(index, index)];
                Opinion { shift: shift[index], variance, learnt, record: number }
            };
            (0..fitted.coordinates.len()).map(one).collect()
        };
        let pieces = EXCITATIONS.div_ceil(self.train.len() + self.test.len());
        let all = self.train.iter().map(|it| (it, true)).chain(self.test.iter().map(|it| (it, false)));
        let cut = all.enumerate().flat_map(|(number, (record, learnt))| {
            cut(record, pieces)
                .into_iter()
                .map(move |sections| (Recorded { sections, ..record.clone() }, learnt, number))
        });
        Ok(cut.map(|(record, learnt, number)| of(&record, learnt, number)).collect())
    }
}

/// What an assumed effect does to a fit.
#[derive(Clone, Debug)]
struct Pull {
    /// By how much the sum of squares falls with it.
    gain: f64,
    /// Sum of squares of all that it does.
    size: f64,
    /// How far each coordinate moves with it.
    moved: DVector<f64>,
}

/// How far coordinates move with effects that are together no larger than the remaining errors' sum of squares.
fn together(pulls: Vec<Pull>, left: f64) -> Vec<DVector<f64>> {
    let total: f64 = pulls.iter().map(|it| it.size.min(left)).sum();
    let share = (left / total).min(1.0);
    pulls.into_iter().map(|it| it.moved * (share * (left / it.size).min(1.0)).sqrt()).collect()
}

/// Normal equations `H d = −g` of a fit's coordinates, at their minimum, and of further columns behind them.
struct Beside<'a> {
    h: &'a DMatrix<f64>,
    g: &'a DVector<f64>,
    /// Which of the fit's coordinates are amounts of identified effects.
    effects: &'a [bool],
    /// Sum of squares of the remaining errors.
    left: f64,
}

impl Beside<'_> {
    /// The normal matrix of some columns in units of each one's norm, factored; none if they depend on each other.
    fn factor(&self, all: &[usize], norm: &[f64]) -> Option<Cholesky<f64, Dyn>> {
        // What nothing depends on stays where it is.
        let diagonal = |i: usize| 1e-9 + f64::from(self.h[(all[i], all[i])] == 0.0);
        DMatrix::from_fn(all.len(), all.len(), |i, j| {
            self.h[(all[i], all[j])] / norm[i] / norm[j] + if i == j { diagonal(i) } else { 0.0 }
        })
        .cholesky()
    }

    /// By how much the sum of squares falls with some further columns, and how far the fit's coordinates move with them.
    /// None if the columns do nothing that the coordinates could not do, or are another shape of an identified effect.
    fn pull(&self, columns: &Range<usize>) -> Option<Pull> {
        let own = self.effects.len();
        let (mut order, effects): (Vec<usize>, Vec<usize>) = (0..own).partition(|it| !self.effects[*it]);
        let nominal = order.len();
        order.extend(effects);
        order.extend(columns.clone().map(|column| own + column));
        let norm: Vec<f64> =
            order.iter().map(|it| self.h[(*it, *it)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let factor = self.factor(&order, &norm)?;
        // Squares of the pivots: what of each column none of those before it can do.
        let pivot = |factor: &Cholesky<f64, Dyn>, it: usize| factor.l_dirty()[(it, it)].powi(2);
        let least = if columns.len() < POINTS { ITS_OWN } else { POINTS_OWN };
        if (own..order.len()).any(|it| pivot(&factor, it) < least) {
            return None;
        }
        let rotated = |all: &[usize]| [&all[..nominal], &all[own..], &all[nominal..own]].concat();
        let places: Vec<usize> = (0..order.len()).collect();
        let places = rotated(&places);
        let norms: Vec<f64> = places.iter().map(|it| norm[*it]).collect();
        let behind = self.factor(&rotated(&order), &norms)?;
        let replaces = |it: usize| pivot(&behind, it + columns.len()) < ANOTHER_SHAPE * pivot(&factor, it);
        if (nominal..own).any(replaces) {
            return None;
        }
        // What bounds hold has a gradient, and stays.
        let right =
            DVector::from_fn(order.len(), |i, _| if i < own { 0.0 } else { -self.g[order[i]] / norm[i] });
        let step = factor.solve(&right);
        let unscaled = |i: usize| step[i] / norm[i];
        let beside = || own..order.len();
        let done = |i: usize, j: usize| unscaled(i) * self.h[(order[i], order[j])] * unscaled(j);
        let size: f64 = beside().map(|i| beside().map(|j| done(i, j)).sum::<f64>()).sum();
        let mut moved = DVector::zeros(own);
        (0..own).for_each(|i| moved[order[i]] = unscaled(i));
        let pull = Pull { gain: step.dot(&right), size, moved };
        Some(pull).filter(|it| it.gain.is_finite() && it.moved.iter().all(|it| it.is_finite()))
    }
}

/// A record's sections in so many pieces.
fn cut(record: &Recorded, pieces: usize) -> Vec<Vec<Range<usize>>> {
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

/// The variance that differences between excitations bring to what was learnt from some of them, and the quantile of
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
    let learnt = |power: i32| sum(&|it| if it.learnt { weight(it).powi(power) } else { 0.0 });
    let share = learnt(2) / learnt(1).powi(2).max(f64::MIN_POSITIVE);
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
            learnt: index < 2,
            record: index,
        };
        shifts.iter().enumerate().map(of).collect()
    }

    /// With equal weights the estimator is the sample variance less the variance within, and half of it is left of two
    /// records that were learnt from.
    #[test]
    fn equal_opinions_leave_the_sample_variance_less_that_within() {
        let (between, quantile) = between(&opinions(&[1.0, -1.0, 3.0, -3.0], 0.5));
        assert!((between - 0.5 * (20.0 / 3.0 - 0.5)).abs() < 1e-12, "{between}");
        // Student's distribution with three degrees of freedom.
        assert!((quantile - 3.182).abs() < 1e-3, "{quantile}");
    }

    /// A straight line through points of a parabola: without its curvature, the line's height at zero is off by what the
    /// joint fit says.
    #[test]
    fn what_is_not_in_the_model_pulls_what_is() {
        let (height, slope, curvature) = (2.0, -1.0, 0.5);
        let x = DVector::from_fn(20, |i, _| i as f64 / 10.0);
        let y = x.map(|x| height + slope * x + curvature * x * x);
        let all = DMatrix::from_fn(20, 3, |row, power| x[row].powi(power as i32));
        let line = all.columns(0, 2).into_owned();
        let fitted = (line.tr_mul(&line)).cholesky().unwrap().solve(&line.tr_mul(&y));
        let left = &line * &fitted - &y;
        // A column that is a combination of the others says nothing.
        let none =
            DMatrix::from_fn(20, 4, |row, column| if column < 3 { all[(row, column)] } else { 1.0 + x[row] });
        let (h, g) = (none.tr_mul(&none), none.tr_mul(&left));
        let beside = |effects: &'static [bool]| Beside { h: &h, g: &g, effects, left: left.norm_squared() };
        let pull = beside(&[false; 2]).pull(&(0..1)).unwrap();
        assert!((pull.gain - left.norm_squared()).abs() < 1e-6 * pull.gain, "{}", pull.gain);
        let moved = &pull.moved;
        assert!(
            (moved[0] - (height - fitted[0])).abs() < 1e-6 && (moved[1] - (slope - fitted[1])).abs() < 1e-6
        );
        assert!(beside(&[false; 2]).pull(&(1..2)).is_none());
        // A parabola is most of all a line: it is another shape of an effect in proportion to x.
        assert!(beside(&[false, true]).pull(&(0..1)).is_none());
    }

    /// Two effects, each twice as large as what remains, are half of it each.
    #[test]
    fn assumed_effects_are_together_no_larger_than_the_remaining_errors() {
        let pull = Pull { gain: 1.0, size: 4.0, moved: DVector::from_element(1, 1.0) };
        let all = together(vec![pull.clone(), pull.clone()], 2.0);
        assert!(all.iter().all(|it| (it[0].powi(2) * pull.size - 1.0).abs() < 1e-12), "{all:?}");
        assert_eq!(together(vec![pull.clone()], 8.0)[0], pull.moved);
    }

    #[test]
    fn opinions_that_differ_by_less_than_their_variance_widen_nothing() {
        assert_eq!(between(&opinions(&[0.1, -0.1, 0.2, -0.2], 1.0)).0, 0.0);
    }

    #[test]
    fn what_no_variance_is_known_of_does_not_count() {
        let all = opinions(&[1.0, -1.0, 3.0, -3.0], 0.5);
        let unknown =
            [f64::INFINITY, 0.0].map(|variance| Opinion { shift: 7.0, variance, learnt: true, record: 0 });
        assert_eq!(between(&[all.clone(), unknown.to_vec()].concat()), between(&all));
        assert_eq!(between(&[all[..1].to_vec(), unknown.to_vec()].concat()), (0.0, 0.0));
    }

    #[test]
    fn a_record_is_cut_where_it_may_be() {
        let sections = vec![0..700, 750..1000];
        let (name, inputs, between, measured) = (String::new(), vec![], Between::Lines, vec![]);
        let record = Recorded { name, step: 1e-3, inputs, between, measured, others: vec![], sections };
        assert_eq!(cut(&record, 1).concat(), record.sections);
        let measured = vec![Measured { output: 0, values: vec![0.0; 2000], noise_floor: 1.0 }];
        let long = Recorded { measured, sections: vec![0..1400, 1450..2000], ..record };
        // Of the first section's second half, 400 samples are less than a block.
        let pieces = cut(&long, 2);
        assert_eq!((pieces.len(), pieces.concat()), (2, vec![0..1000, 1450..2000]));
    }
}
