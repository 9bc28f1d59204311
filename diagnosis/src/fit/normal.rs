//! The normal equations of a section of a record, from the plant's derivatives.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::correction::{Correction, Fault};
use crate::plant::{DIRECTIONS, Seed, Signals};
use crate::recorded::Recorded;

use super::{Fit, Handle, Point};

/// How the states at a section's start follow the coordinates.
#[derive(Clone, Debug)]
pub(super) struct Elimination {
    /// `C⁻¹ c`
    pub(super) constant: DVector<f64>,
    /// `C⁻¹ Bᵀ`
    pub(super) linear: DMatrix<f64>,
}

/// The normal equations of a section.
pub(super) struct Section {
    pub(super) h: DMatrix<f64>,
    pub(super) g: DVector<f64>,
    pub(super) scores: Vec<DVector<f64>>,
    pub(super) elimination: Elimination,
}

impl Fit<'_> {
    /// The seeds of all coordinates that act through the plant, with the coordinates' indices; then those of the
    /// states at the start.
    fn seeds(&self, point: &Point, record: &Recorded, section: &Range<usize>) -> Vec<(usize, Seed)> {
        let coordinates = self.coordinates.len();
        let mut seeds = Vec::new();
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            match coordinate.handle {
                Handle::Parameter(parameter) => seeds.push((index, Seed::Parameter(parameter))),
                Handle::Input(input, fault) => {
                    let change = slope(&point.inputs[input], fault, record.step, |correction| {
                        let mut corrections = point.inputs.clone();
                        corrections[input] = *correction;
                        record.drive(section, &corrections).inputs.swap_remove(input)
                    });
                    seeds.push((index, Seed::Inputs(record.change(input, change))));
                }
                Handle::Output(..) => {}
            }
        }
        let states = self.states.iter().enumerate();
        seeds.extend(states.map(|(number, state)| (coordinates + number, Seed::State(*state))));
        seeds
    }

    /// The normal equations of a section; `extra` are changes of the record's predicted signals whose amounts are
    /// further coordinates, in groups of which nobody asks what they have in common.
    pub(super) fn section(
        &self,
        point: &Point,
        start: &[f64],
        record: &Recorded,
        section: &Range<usize>,
        (extra, groups): (&[&Signals], &[Range<usize>]),
    ) -> Section {
        let (own, states) = (self.coordinates.len(), self.states.len());
        let n = own + extra.len();
        let drive = record.drive(section, &point.inputs);
        let outputs = self.dynamics.outputs(&point.parameters, start, &drive);
        let seeds = self.seeds(point, record, section);
        let derivatives: Vec<Signals> = seeds
            .par_chunks(DIRECTIONS)
            .flat_map_iter(|chunk| {
                let seeds: Vec<Seed> = chunk.iter().map(|(_, seed)| seed.clone()).collect();
                self.dynamics.derivatives(&point.parameters, start, &drive, &seeds)
            })
            .collect();
        let block = record.block();
        let mut h = DMatrix::zeros(n + states, n + states);
        let mut scores = vec![DVector::zeros(n + states); section.len().div_ceil(block)];
        for (row, measured) in record.measured.iter().enumerate() {
            let output = measured.output;
            let correction = &point.outputs[output];
            let weight = 1.0 / self.sigma[output];
            let signal = correction.applied(&outputs[output], record.samples(section));
            let mut jacobian = DMatrix::<f64>::zeros(section.len(), n + states);
            let mut put = |column: usize, slopes: &[f64]| {
                for (entry, slope) in jacobian.column_mut(column).iter_mut().zip(slopes) {
                    *entry = -weight * slope;
                }
            };
            for ((column, _), signals) in seeds.iter().zip(&derivatives) {
                // Those of the states come after the further coordinates.
                let column = if *column < own { *column } else { column + extra.len() };
                if correction.is_neutral() {
                    put(column, &signals[output]);
                } else {
                    put(
                        column,
                        &correction.tangent(&outputs[output], &signals[output], record.samples(section)),
                    );
                }
            }
            for (column, coordinate) in self.coordinates.iter().enumerate() {
                if let Handle::Output(of, fault) = coordinate.handle
                    && of == output
                {
                    let change = |it: &Correction| it.applied(&outputs[output], record.samples(section));
                    put(column, &slope(correction, fault, record.step, change));
                }
            }
            for (column, change) in (own..).zip(extra) {
                put(column, &change[row][section.clone()]);
            }
            let mut residual = DVector::zeros(section.len());
            for (k, value) in measured.values[section.clone()].iter().enumerate() {
                if value.is_finite() {
                    residual[k] = weight * (value - signal[k]);
                } else {
                    jacobian.row_mut(k).fill(0.0);
                }
            }
            add_products(&mut h, &jacobian, (own, n), groups);
            for (number, score) in scores.iter_mut().enumerate() {
                let first = number * block;
                let rows = block.min(section.len() - first);
                *score += jacobian.rows(first, rows).tr_mul(&residual.rows(first, rows));
            }
        }
        eliminate(&h, &scores, n, &self.ridge)
    }
}

/// Adds the products of the Jacobian's columns: of those before `own` and from `n` on with all, of those between them within
/// their groups only. They are many, and most of the work would be for what nobody asks.
fn add_products(
    h: &mut DMatrix<f64>,
    jacobian: &DMatrix<f64>,
    (own, n): (usize, usize),
    groups: &[Range<usize>],
) {
    let mut add = |rows: Range<usize>, columns: Range<usize>| {
        let product = jacobian.columns_range(rows.clone()).tr_mul(&jacobian.columns_range(columns.clone()));
        let mut part = h.view_mut((rows.start, columns.start), (rows.len(), columns.len()));
        part += product;
    };
    let all = jacobian.ncols();
    add(0..own, 0..all);
    add(n..all, 0..all);
    if n > own {
        add(own..n, 0..own);
        add(own..n, n..all);
    }
    for group in groups {
        let columns = own + group.start..own + group.end;
        add(columns.clone(), columns);
    }
}

/// The normal equations without the states at the start, each of which is held where it is by its entry in `ridge`.
fn eliminate(h: &DMatrix<f64>, scores: &[DVector<f64>], n: usize, ridge: &[f64]) -> Section {
    let states = h.ncols() - n;
    let g: DVector<f64> = scores.iter().fold(DVector::zeros(n + states), |sum, score| sum + score);
    let mut c = h.view((n, n), (states, states)).into_owned();
    for state in 0..states {
        // A state that nothing depends on stays where it is.
        c[(state, state)] += 1e-9 * c[(state, state)] + ridge[state];
    }
    let b = h.view((0, n), (n, states)).into_owned();
    let inverse = c.cholesky().map_or_else(|| DMatrix::zeros(states, states), |it| it.inverse());
    let linear = &inverse * b.transpose();
    let constant = &inverse * g.rows(n, states);
    let reduce = |whole: &DVector<f64>| whole.rows(0, n) - linear.transpose() * whole.rows(n, states);
    Section {
        h: h.view((0, 0), (n, n)) - &b * &linear,
        g: reduce(&g),
        scores: scores.iter().map(reduce).collect(),
        elimination: Elimination { constant, linear },
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
