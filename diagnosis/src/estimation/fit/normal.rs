//! The normal equations of a section of a record, from the plant's derivatives.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::dataset::recorded::Dataset;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::plant::{Linearised, Seed, Signals};
use crate::signal::distortion::{Correction, Fault};

use super::Fit;

/// Samples whose products are added in one go: their Jacobian stays in the processor's cache.
const TOGETHER: usize = 256;

/// How the states at a section's start follow the coordinates.
#[derive(Clone, Debug)]
pub(super) struct Elimination {
    /// `C⁻¹ c`
    pub(super) constant: DVector<f64>,
    /// `C⁻¹ Bᵀ`
    pub(super) linear: DMatrix<f64>,
    /// Half the weighted sum of squares of the section where they are.
    pub(super) cost: f64,
    /// By how much it falls where they follow.
    pub(super) fall: f64,
}

/// The normal equations of a section.
pub(super) struct Section {
    pub(super) h: DMatrix<f64>,
    pub(super) g: DVector<f64>,
    pub(super) scores: Vec<DVector<f64>>,
    pub(super) elimination: Elimination,
}

impl Fit<'_> {
    /// The seeds of the states at the start and of all coordinates that act through the plant, each with the column of the
    /// Jacobian that it is for.
    fn seeds(&self, point: &Estimate, record: &Dataset, section: &Range<usize>) -> Vec<(usize, Seed)> {
        let states = self.states.iter().map(|state| Seed::State(*state));
        let mut seeds: Vec<(usize, Seed)> = states.enumerate().collect();
        for (column, coordinate) in (self.states.len()..).zip(&self.coordinates) {
            match coordinate.handle {
                Unknown::Parameter(parameter) => seeds.push((column, Seed::Parameter(parameter))),
                Unknown::Input(input, fault) => {
                    let change = slope(&point.inputs[input], fault, record.step, |correction| {
                        let mut corrections = point.inputs.clone();
                        corrections[input] = *correction;
                        record.drive(section, &corrections).inputs.swap_remove(input)
                    });
                    seeds.push((column, Seed::Inputs(record.change(input, change))));
                }
                Unknown::Output(..) => {}
            }
        }
        seeds
    }

    /// The normal equations of a section; `extra` are changes of the record's predicted signals whose amounts are
    /// further coordinates, in groups of which nobody asks what they have in common.
    pub(super) fn section(
        &self,
        point: &Estimate,
        start: &[f64],
        record: &Dataset,
        section: &Range<usize>,
        (extra, groups): (&[Signals], &[Range<usize>]),
    ) -> Section {
        let drive = record.drive(section, &point.inputs);
        let (columns, seeds): (Vec<usize>, Vec<Seed>) =
            self.seeds(point, record, section).into_iter().unzip();
        let wanted: Vec<usize> = record.measured.iter().map(|measured| measured.output).collect();
        let linearised = self.dynamics.linearised(&point.parameters, start, &drive, &seeds, &wanted);
        let fixed = self.states.len() + self.coordinates.len();
        let all = fixed + extra.len();
        let products = |row: usize| {
            let (jacobian, residual) =
                self.jacobian(point, record, section, (row, &columns, &linearised), extra);
            let cost = 0.5 * residual.norm_squared();
            (cost, products(&jacobian, fixed, groups), scores(&jacobian, &residual, record.block()))
        };
        // Added in the same order, whoever is ready first: a sum does not depend on the number of processors.
        let parts: Vec<_> = (0..wanted.len()).into_par_iter().map(products).collect();
        let (cost, h, scores) = parts
            .into_iter()
            .reduce(|(cost, h, scores), (dearer, more, further)| {
                let scores = scores.into_iter().zip(further).map(|(score, more)| score + more).collect();
                (cost + dearer, h + more, scores)
            })
            .unwrap_or_else(|| (0.0, DMatrix::zeros(all, all), Vec::new()));
        eliminate(cost, &h, &scores, &self.ridge)
    }

    /// The derivatives of a measured signal's residuals over their deviation, and these: columns for the states at the
    /// start, for the coordinates, and for further changes of the predicted signals. What is missing is zero.
    fn jacobian(
        &self,
        point: &Estimate,
        record: &Dataset,
        section: &Range<usize>,
        (row, columns, linearised): (usize, &[usize], &Linearised),
        extra: &[Signals],
    ) -> (DMatrix<f64>, DVector<f64>) {
        let (measured, predicted) = (&record.measured[row], &linearised.outputs[row]);
        let output = measured.output;
        let (correction, samples) = (&point.outputs[output], record.samples(section));
        let weight = 1.0 / self.sigma[output];
        let states = self.states.len();
        let fixed = states + self.coordinates.len();
        let mut jacobian = DMatrix::<f64>::zeros(section.len(), fixed + extra.len());
        let mut put = |column: usize, slopes: &[f64]| {
            for (entry, slope) in jacobian.column_mut(column).iter_mut().zip(slopes) {
                *entry = -weight * slope;
            }
        };
        for (column, signals) in columns.iter().zip(&linearised.slopes) {
            if correction.is_neutral() {
                put(*column, &signals[row]);
            } else {
                put(*column, &correction.tangent(predicted, &signals[row], samples));
            }
        }
        for (column, coordinate) in (states..).zip(&self.coordinates) {
            if let Unknown::Output(of, fault) = coordinate.handle
                && of == output
            {
                let change = |it: &Correction| it.applied(predicted, samples);
                put(column, &slope(correction, fault, record.step, change));
            }
        }
        for (column, change) in (fixed..).zip(extra) {
            put(column, &change[row]);
        }
        let signal = correction.applied(predicted, samples);
        let mut residual = DVector::zeros(section.len());
        for (k, value) in record.compared(row, section).iter().enumerate() {
            if value.is_finite() {
                residual[k] = weight * (value - signal[k]);
            } else {
                jacobian.row_mut(k).fill(0.0);
            }
        }
        (jacobian, residual)
    }
}

/// The gradient over each block of time.
fn scores(jacobian: &DMatrix<f64>, residual: &DVector<f64>, block: usize) -> Vec<DVector<f64>> {
    let samples = residual.len();
    let blocks = (0..samples).step_by(block).map(|first| (first, block.min(samples - first)));
    blocks.map(|(first, rows)| jacobian.rows(first, rows).tr_mul(&residual.rows(first, rows))).collect()
}

/// The products of the Jacobian's columns: of the first `fixed` with all, of the others within their groups only. They are
/// many, and most of the work would be for what nobody asks.
fn products(jacobian: &DMatrix<f64>, fixed: usize, groups: &[Range<usize>]) -> DMatrix<f64> {
    let (samples, all) = jacobian.shape();
    let mut h = DMatrix::zeros(all, all);
    for first in (0..samples).step_by(TOGETHER) {
        let part = jacobian.rows(first, TOGETHER.min(samples - first));
        let transposed = part.transpose();
        let mut add = |rows: Range<usize>, columns: Range<usize>| {
            let mut sum = h.view_mut((rows.start, columns.start), (rows.len(), columns.len()));
            sum.gemm(1.0, &transposed.rows_range(rows), &part.columns_range(columns), 1.0);
        };
        add(0..fixed, 0..all);
        for group in groups {
            let columns = fixed + group.start..fixed + group.end;
            add(columns.clone(), columns);
        }
    }
    h.fill_lower_triangle_with_upper_triangle();
    h
}

/// The normal equations without the states at the start, each of which is held where it is by its entry in `ridge`.
fn eliminate(cost: f64, h: &DMatrix<f64>, scores: &[DVector<f64>], ridge: &[f64]) -> Section {
    let (states, n) = (ridge.len(), h.ncols() - ridge.len());
    let g: DVector<f64> = scores.iter().fold(DVector::zeros(states + n), |sum, score| sum + score);
    let mut c = h.view((0, 0), (states, states)).into_owned();
    for state in 0..states {
        // A state that nothing depends on stays where it is.
        c[(state, state)] += 1e-9 * c[(state, state)] + ridge[state];
    }
    let b = h.view((states, 0), (n, states)).into_owned();
    let inverse = c.cholesky().map_or_else(|| DMatrix::zeros(states, states), |it| it.inverse());
    let linear = &inverse * b.transpose();
    let constant = &inverse * g.rows(0, states);
    let fall = 0.5 * constant.dot(&g.rows(0, states));
    let reduce = |whole: &DVector<f64>| whole.rows(states, n) - linear.transpose() * whole.rows(0, states);
    Section {
        h: h.view((states, states), (n, n)) - &b * &linear,
        g: reduce(&g),
        scores: scores.iter().map(reduce).collect(),
        elimination: Elimination { constant, linear, cost, fall },
    }
}

/// How a corrected signal changes with a fault, by a central difference.
fn slope(at: &Correction, fault: Fault, step: f64, applied: impl Fn(&Correction) -> Vec<f64>) -> Vec<f64> {
    let value = at.get(fault);
    let h = match fault {
        Fault::Delay => 0.05 * step,
        // A lag is not negative: beside zero, the difference is taken around a lag that is small.
        Fault::Lag => 0.05 * step,
        // Fine enough for the end of any section.
        Fault::Rate => 1e-7,
        Fault::Limit => 1e-3 * value,
        _ => 1e-3,
    };
    let middle = if fault == Fault::Lag { value.max(0.1 * step) } else { value };
    let moved = |amount: f64| {
        let mut moved = *at;
        moved.set(fault, amount);
        applied(&moved)
    };
    let (low, high) = (moved(middle - h), moved(middle + h));
    high.iter().zip(&low).map(|(high, low)| (high - low) / (2.0 * h)).collect()
}
