//! What effects that are not in the model would do to a fit: by how much they would pull its coordinates, and which of them
//! a coordinate cannot be told from.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::confirm::worth;
use crate::decision::criteria::CRITERIA;
use crate::estimation::coordinates::POINTS;
use crate::estimation::deadline::Stage;
use crate::estimation::fit::Normal;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};
use crate::screening::{Probe, TriedOut, of_gain};
use crate::signal::distortion::Fault;

/// Share of a column's square below which it does nothing that the coordinates could not do: it is another name for one of
/// them, as a force cell's offset is for a preload, and the residuals do not show it.
const ITS_OWN: f64 = 1e-6;
/// The same of a table's points: held beyond its ends, it comes only near to the straight line that is another name for a
/// gain or a rate.
const POINTS_OWN: f64 = 1e-3;
/// Share of what an identified effect does on its own, below which columns beside it are another shape of it.
const ANOTHER_SHAPE: f64 = 0.5;

/// Effects that are not in the model beside those that are.
pub struct Assumed {
    /// How far each coordinate moves with each of them.
    pub pulls: Vec<DVector<f64>>,
    /// For each coordinate: those that do what it does, of a parameter that the starting model has at zero; of another, those that do
    /// on their own what it and others do together, by as much as they differ from what was known before.
    pub twins: Vec<Vec<Term>>,
}

impl Baseline<'_> {
    /// How far each coordinate would move beside each effect that is not in the model, the effect being in the shape in which
    /// the errors contain most of it, of effects that are worth a fit; and which effects do what a coordinate does.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn assumed(&self, fitted: &Fitted) -> Result<Assumed, String> {
        // Where the time was up before a look at the rig, nobody knows how large an effect is there.
        if self.typical.is_empty() && self.deadline.is_over(Stage::Search) {
            return Ok(Assumed { pulls: Vec::new(), twins: vec![Vec::new(); fitted.coordinates.len()] });
        }
        let TriedOut { terms, probes, normal: Normal { h, g, .. } } = self.tried_out(fitted)?;
        let mut most: Vec<Option<Pull>> = vec![None; terms.len()];
        let amounts: Vec<Unknown> = fitted.terms.iter().flat_map(|term| self.sizes(*term)).collect();
        let effects = fitted.coordinates.iter().map(|it| amounts.contains(&it.handle)).collect::<Vec<_>>();
        let beside = Beside { h: &h, g: &g, effects: &effects, left: 2.0 * fitted.cost };
        let mut twins: Vec<Vec<Term>> = vec![Vec::new(); fitted.coordinates.len()];
        let absent: Vec<bool> = fitted.coordinates.iter().map(|it| self.is_absent(it.handle)).collect();
        let known = fitted.coordinates.iter().map(|it| it.distance(&fitted.point));
        let known: Vec<Option<(f64, f64)>> = known.collect();
        for (probe, range) in &probes {
            // It can do all that a gain, a lag and a delay can, which count on their own.
            if matches!(terms[probe.term], Term::Response(_)) {
                continue;
            }
            let term = terms[probe.term];
            let is_single = range.len() == 1;
            let done = if is_single { beside.done_by(range.start, &known) } else { Vec::new() };
            for (coordinate, twins) in twins.iter_mut().enumerate() {
                let is_twin = match absent[coordinate] {
                    // A gain scales all of a drive's parameters alike, which says nothing of one that is not there.
                    true => is_single && !is_gain(term) && beside.is_twin(range.start, coordinate),
                    false => done.contains(&coordinate),
                };
                if is_twin && !twins.contains(&term) {
                    twins.push(term);
                }
            }
            let found = beside.pull(range).map(|it| {
                let (possible, _) = self.start(term, probe, &it.amounts, &fitted.point);
                // A gain is nearly another name for the common scale of the parameters, so that the data hardly limit it. A larger one
                // than the probe would have been noticed.
                let unnoticed = if is_gain(term) { it.amounts.amax().recip().min(1.0) } else { 1.0 };
                it.held(possible.min(unnoticed))
            });
            let found = found.filter(|it| it.gain > worth(fitted));
            let most = &mut most[probe.term];
            if let Some(found) = found
                && most.as_ref().is_none_or(|it| found.gain > it.gain)
            {
                *most = Some(found);
            }
        }
        let pulls = together(most.into_iter().flatten().collect(), beside.left);
        Ok(Assumed { pulls, twins })
    }

    /// Whether the starting model is without what a parameter does.
    fn is_absent(&self, handle: Unknown) -> bool {
        matches!(handle, Unknown::Parameter(index) if self.rig.parameters[index] == 0.0)
    }

    /// Where a fit of each term that comes in several shapes may begin: with the shape in which the errors of a simulation contain most of
    /// it, and as much of it as they do, all else having given way. From one sample to the next, another shape may do as well.
    pub fn best_shapes(&self, fitted: &Fitted, tried: &TriedOut) -> Vec<(Term, Estimate)> {
        let TriedOut { terms, probes, normal: Normal { h, g, .. } } = tried;
        let effects = vec![false; fitted.coordinates.len()];
        let beside = Beside { h, g, effects: &effects, left: 2.0 * fitted.cost };
        let best = |(index, term): (usize, &Term)| {
            let own: Vec<_> = probes.iter().filter(|(probe, _)| probe.term == index).collect();
            let several = own.iter().filter(|_| own.len() > 1);
            let pulls = several.filter_map(|(probe, range)| Some((probe, beside.pull(range)?)));
            let (probe, pull) = pulls.max_by(|(_, a), (_, b)| a.gain.total_cmp(&b.gain))?;
            let (_, mut start) = self.start(*term, probe, &pull.amounts, &fitted.point);
            for (FreeParameter { handle, bounds: (low, high), .. }, moved) in
                fitted.coordinates.iter().zip(pull.moved.iter())
            {
                start.set(*handle, (fitted.point.get(*handle) + moved).clamp(*low, *high));
            }
            Some((*term, start))
        };
        terms.iter().enumerate().filter_map(best).collect()
    }

    /// The share of the sum of squares that each term takes from a simulation's errors in its best shape, all else giving way, as far as
    /// the linearisation tells. Where an innovation hides what nominal parameters have bent to, a simulation may show it.
    pub fn promised(&self, fitted: &Fitted, tried: &TriedOut) -> Vec<(Term, f64)> {
        let TriedOut { terms, probes, normal: Normal { h, g, .. } } = tried;
        let effects = vec![false; fitted.coordinates.len()];
        let beside = Beside { h, g, effects: &effects, left: 2.0 * fitted.cost };
        let share = |(probe, range): &(Probe, Range<usize>)| {
            let pull = beside.pull(range)?;
            let (possible, _) = self.start(terms[probe.term], probe, &pull.amounts, &fitted.point);
            Some(pull.held(possible).gain / beside.left)
        };
        let of = |(index, term): (usize, &Term)| {
            let own = probes.iter().filter(|(probe, _)| probe.term == index).filter_map(share);
            (*term, own.fold(0.0, f64::max))
        };
        terms.iter().enumerate().map(of).collect()
    }
}

fn is_gain(term: Term) -> bool {
    matches!(term, Term::Fault(Unknown::Input(_, Fault::Gain) | Unknown::Output(_, Fault::Gain)))
}

/// What an assumed effect does to a fit.
#[derive(Clone, Debug)]
struct Pull {
    /// By how much the sum of squares falls with it.
    gain: f64,
    /// The amounts of its columns.
    amounts: DVector<f64>,
    /// How far each coordinate moves with it.
    moved: DVector<f64>,
}

impl Pull {
    /// The same by a share of the effect.
    fn held(self, share: f64) -> Self {
        Self { gain: of_gain(share) * self.gain, amounts: share * self.amounts, moved: share * self.moved }
    }
}

/// How far coordinates move with effects that together explain no more than the remaining errors' sum of squares.
fn together(pulls: Vec<Pull>, left: f64) -> Vec<DVector<f64>> {
    let total: f64 = pulls.iter().map(|it| it.gain).sum();
    let share = (left / total).min(1.0);
    pulls.into_iter().map(|it| it.moved * share.sqrt()).collect()
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

    /// Whether a further column does what a coordinate does, beyond what the other coordinates do.
    fn is_twin(&self, column: usize, coordinate: usize) -> bool {
        let own = self.effects.len();
        let mut order: Vec<usize> = (0..own).filter(|it| *it != coordinate).collect();
        order.extend([coordinate, own + column]);
        let norm: Vec<f64> =
            order.iter().map(|it| self.h[(*it, *it)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let Some(factor) = self.factor(&order, &norm) else { return false };
        let (together, alone) =
            (factor.l_dirty()[(own, own - 1)].powi(2), factor.l_dirty()[(own, own)].powi(2));
        together + alone > POINTS_OWN && together > CRITERIA.decides * (together + alone)
    }

    /// The coordinates whose difference from what was known before a further column may make instead: it does what coordinates do
    /// together, and with an amount of it in their place, most of all differences is gone, and most of each of these. `known` has the
    /// distance of each coordinate from what was known in standard deviations, and its derivative.
    fn done_by(&self, column: usize, known: &[Option<(f64, f64)>]) -> Vec<usize> {
        let own = known.len();
        let order: Vec<usize> = (0..own).chain([own + column]).collect();
        // What was known before tells the coordinates apart, but is nothing that records say.
        let said = |it: usize| {
            let before = known.get(it).copied().flatten().map_or(0.0, |(_, slope)| slope * slope);
            (self.h[(it, it)] - before).max(f64::MIN_POSITIVE)
        };
        let norm: Vec<f64> = order.iter().map(|it| said(*it).sqrt()).collect();
        let all = DMatrix::from_fn(own + 1, own + 1, |i, j| match i == j {
            true => 1.0 + 1e-9,
            false => self.h[(order[i], order[j])] / norm[i] / norm[j],
        });
        let Some(factor) = all.view((0, 0), (own, own)).into_owned().cholesky() else {
            return Vec::new();
        };
        let cross = all.view((0, own), (own, 1)).into_owned();
        let together = factor.solve(&cross);
        if 1.0 - together.dot(&cross) > ITS_OWN {
            return Vec::new();
        }
        let moved = (0..own).filter_map(|it| {
            let (distance, slope) = known[it]?;
            Some((it, distance, slope * together[it] * norm[own] / norm[it]))
        });
        let moved: Vec<(usize, f64, f64)> = moved.collect();
        let sum = |of: &dyn Fn(f64, f64) -> f64| moved.iter().map(|it| of(it.1, it.2)).sum::<f64>();
        let moves = sum(&|_, moved| moved * moved);
        let amount = if moves > 0.0 { sum(&|distance, moved| distance * moved) / moves } else { 0.0 };
        let left = |distance: f64, moved: f64| (distance - amount * moved).powi(2);
        let is_done = |left: f64, whole: f64| left < (1.0 - CRITERIA.majority) * whole;
        if !is_done(sum(&left), sum(&|distance, _| distance * distance)) {
            return Vec::new();
        }
        moved.iter().filter(|it| is_done(left(it.1, it.2), it.1 * it.1)).map(|it| it.0).collect()
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
        let mut moved = DVector::zeros(own);
        (0..own).for_each(|i| moved[order[i]] = step[i] / norm[i]);
        let amounts = DVector::from_fn(columns.len(), |i, _| step[own + i] / norm[own + i]);
        let pull = Pull { gain: step.dot(&right), amounts, moved };
        Some(pull).filter(|it| it.gain.is_finite() && it.moved.iter().all(|it| it.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!((pull.amounts[0] - curvature).abs() < 1e-6);
        assert!(
            (moved[0] - (height - fitted[0])).abs() < 1e-6 && (moved[1] - (slope - fitted[1])).abs() < 1e-6
        );
        assert!(beside(&[false; 2]).pull(&(1..2)).is_none());
        // A parabola is most of all a line: it is another shape of an effect in proportion to x.
        assert!(beside(&[false, true]).pull(&(0..1)).is_none());
    }

    /// Two effects, each of which explains all that remains, explain half of it each.
    #[test]
    fn assumed_effects_together_explain_no_more_than_the_remaining_errors() {
        let one = |value: f64| DVector::from_element(1, value);
        let pull = Pull { gain: 2.0, amounts: one(1.0), moved: one(3.0) };
        let all = together(vec![pull.clone(), pull.clone()], 2.0);
        assert!(all.iter().all(|it| (it[0].powi(2) - 4.5).abs() < 1e-12), "{all:?}");
        assert_eq!(together(vec![pull.clone()], 8.0)[0], pull.moved);
        // Half of an effect takes three quarters of what all of it takes.
        let half = pull.held(0.5);
        assert_eq!((half.gain, half.moved[0], half.amounts[0]), (1.5, 1.5, 0.5));
    }

    /// A force over a mass and a damping: a gain of the force is a factor of both, unless one of them is the only one that is off.
    #[test]
    fn one_column_may_do_what_all_coordinates_do_together() {
        let all = DMatrix::from_fn(50, 3, |k, column| {
            let x = 0.2 * k as f64;
            match column {
                0 => x.sin(),
                1 => (1.7 * x).cos(),
                _ => -1.25 * x.sin() - 0.5 * (1.7 * x).cos(),
            }
        });
        let known = |off: [f64; 2]| off.map(|it| Some((it / 0.3, 1.0 / 0.3)));
        let done = |all: &DMatrix<f64>, off: [f64; 2]| {
            let mut h = all.tr_mul(all);
            // What was known before.
            (0..2).for_each(|it| h[(it, it)] += 1.0 / 0.09);
            let g = DVector::zeros(3);
            Beside { h: &h, g: &g, effects: &[false; 2], left: 1.0 }.done_by(0, &known(off))
        };
        assert_eq!([done(&all, [0.25, 0.1]), done(&all, [-0.25, -0.1])], [[0, 1], [0, 1]]);
        assert!(done(&all, [0.05, -0.3]).is_empty());
        // The second one is off the other way.
        assert_eq!(done(&all, [0.25, -0.05]), [0]);
        // Something that the coordinates cannot do.
        let mut other = all;
        other[(10, 2)] += 0.5;
        assert!(done(&other, [0.25, 0.1]).is_empty());
    }

    /// An offset and a friction are one for a body that never turns back, and two for one that does.
    #[test]
    fn what_never_turns_back_cannot_tell_friction_from_an_offset() {
        let of = |turns: bool| {
            let velocity = |k: usize| match k {
                _ if !turns => 1.0 + 0.01 * k as f64,
                0..50 => 0.02 + 0.04 * k as f64,
                _ => 1.98 - 0.04 * k as f64,
            };
            let all = DMatrix::from_fn(100, 3, |k, column| match column {
                0 => velocity(k),
                1 => 1.0,
                _ => (velocity(k) / 0.5).tanh(),
            });
            let (h, g) = (all.tr_mul(&all), DVector::zeros(3));
            let beside = Beside { h: &h, g: &g, effects: &[false; 2], left: 1.0 };
            [0, 1].map(|coordinate| beside.is_twin(0, coordinate))
        };
        assert_eq!((of(false), of(true)), ([false, true], [false, false]));
    }
}
