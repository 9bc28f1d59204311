//! Fitting a plant to records: output error, weighted, with every state at the start estimated along.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::correction::{Correction, Fault};
use crate::lsq::{Linear, Problem};
use crate::plant::{DIRECTIONS, Dynamics, Plant, Seed, Signals};
use crate::recorded::Recorded;

/// Length of the blocks over which scores are summed, in seconds: longer than the residuals' memory.
const BLOCK: f64 = 0.5;

/// What the names of states begin with whose values at the start are not estimated: they are forgotten within
/// milliseconds, or act only after long.
const FORGOTTEN: &[&str] =
    &["hysteresis.", "current", "overload", "velocity_loop.command", "velocity_loop.output"];

/// How far a state at the start may go in a step on a standard deviation's gain, in its nominal values. What is
/// forgotten within milliseconds hardly shows: without a bound it would be sent as far as a limiter.
const FAR: f64 = 3.0;

/// Something that a fit may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Handle {
    /// A parameter of the plant, by its index.
    Parameter(usize),
    /// A correction of an input's signal, by the input's index.
    Input(usize, Fault),
    /// A correction of an output's signal, by the output's index.
    Output(usize, Fault),
}

/// Something that a fit changes, within bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinate {
    /// What.
    pub handle: Handle,
    /// Smallest and largest value.
    pub bounds: (f64, f64),
    /// What was known before, as mean and standard deviation.
    pub prior: Option<(f64, f64)>,
}

/// A plant's parameters, corrections and states at the start of every section.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The plant's parameters.
    pub parameters: Vec<f64>,
    /// Of each input.
    pub inputs: Vec<Correction>,
    /// Of each output.
    pub outputs: Vec<Correction>,
    /// States at the start of each section, record after record.
    pub starts: Vec<Vec<f64>>,
}

impl Point {
    /// The value of what can be changed.
    pub fn get(&self, handle: Handle) -> f64 {
        match handle {
            Handle::Parameter(index) => self.parameters[index],
            Handle::Input(index, fault) => self.inputs[index].get(fault),
            Handle::Output(index, fault) => self.outputs[index].get(fault),
        }
    }

    /// Changes it.
    pub fn set(&mut self, handle: Handle, value: f64) {
        match handle {
            Handle::Parameter(index) => self.parameters[index] = value,
            Handle::Input(index, fault) => self.inputs[index].set(fault, value),
            Handle::Output(index, fault) => self.outputs[index].set(fault, value),
        }
    }
}

/// Measured less predicted, for each record and each of its measured outputs.
pub type Residuals = Vec<Signals>;

/// The fit of a plant to records as a least-squares problem.
pub struct Fit<'a> {
    /// The model.
    pub plant: &'a Plant,
    /// Its equations.
    pub dynamics: &'a dyn Dynamics,
    /// What was measured.
    pub records: &'a [Recorded],
    /// What may be changed.
    pub coordinates: Vec<Coordinate>,
    /// Standard deviation of the residuals of each output.
    pub sigma: Vec<f64>,
    /// States whose values at the start are estimated.
    states: Vec<usize>,
    ridge: Vec<f64>,
    bounds: Vec<(f64, f64)>,
}

/// What linearising a fit leaves behind.
#[derive(Clone, Debug)]
pub struct Trace {
    sections: Vec<Elimination>,
    /// Gradient of the cost over each block of time.
    pub scores: Vec<DVector<f64>>,
}

/// How the states at a section's start follow the coordinates.
#[derive(Clone, Debug)]
struct Elimination {
    /// `C⁻¹ c`
    constant: DVector<f64>,
    /// `C⁻¹ Bᵀ`
    linear: DMatrix<f64>,
}

/// The normal equations of a section.
struct Section {
    h: DMatrix<f64>,
    g: DVector<f64>,
    scores: Vec<DVector<f64>>,
    elimination: Elimination,
}

impl<'a> Fit<'a> {
    /// A fit.
    pub fn new(
        plant: &'a Plant,
        dynamics: &'a dyn Dynamics,
        records: &'a [Recorded],
        coordinates: Vec<Coordinate>,
        sigma: Vec<f64>,
    ) -> Self {
        let bounds = coordinates.iter().map(|coordinate| coordinate.bounds).collect();
        let forgotten = |name: &str| FORGOTTEN.iter().any(|prefix| name.starts_with(prefix));
        let states = plant.states.iter().enumerate().filter(|(_, state)| !forgotten(&state.name));
        let states: Vec<usize> = states.map(|(index, _)| index).collect();
        let nominal = |state: &usize| plant.states[*state].nominal.unwrap_or(1.0);
        let ridge = states.iter().map(|state| (FAR * nominal(state)).powi(-2)).collect();
        Self { plant, dynamics, records, coordinates, sigma, states, ridge, bounds }
    }

    fn sections(&self) -> Vec<(usize, &'a Recorded, &'a Range<usize>)> {
        let all = self.records.iter().flat_map(|record| record.sections.iter().map(move |it| (record, it)));
        all.enumerate().map(|(index, (record, section))| (index, record, section)).collect()
    }

    /// The measured outputs as predicted in a section.
    fn predicted(&self, point: &Point, index: usize, record: &Recorded, section: &Range<usize>) -> Signals {
        let drive = record.drive(section, &point.inputs);
        let mut outputs = self.dynamics.outputs(&point.parameters, &point.starts[index], &drive);
        let measured = record.measured.iter();
        measured
            .map(|measured| {
                let signal = std::mem::take(&mut outputs[measured.output]);
                let correction = &point.outputs[measured.output];
                if correction.is_neutral() { signal } else { correction.applied(&signal, record.step) }
            })
            .collect()
    }

    /// Predicted signals of each record, whole.
    pub fn predictions(&self, point: &Point) -> Residuals {
        let sections = self.sections();
        let parts: Vec<Signals> = sections
            .par_iter()
            .map(|(index, record, it)| self.predicted(point, *index, record, it))
            .collect();
        let mut results: Residuals = Vec::new();
        let mut parts = parts.into_iter();
        for record in self.records {
            let mut whole = vec![vec![f64::NAN; record.len()]; record.measured.len()];
            for section in &record.sections {
                let part = parts.next().unwrap_or_default();
                for (whole, part) in whole.iter_mut().zip(part) {
                    whole[section.clone()].copy_from_slice(&part);
                }
            }
            results.push(whole);
        }
        results
    }

    /// Measured less predicted.
    pub fn residuals(&self, point: &Point) -> Residuals {
        let mut all = self.predictions(point);
        for (record, signals) in self.records.iter().zip(&mut all) {
            for (measured, signal) in record.measured.iter().zip(signals) {
                for (predicted, value) in signal.iter_mut().zip(&measured.values) {
                    *predicted = value - *predicted;
                }
            }
        }
        all
    }

    /// The same point with the states at the start of each section that fit best.
    pub fn settled(&self, point: Point) -> Point {
        let (plant, dynamics, records) = (self.plant, self.dynamics, self.records);
        let bare = Self::new(plant, dynamics, records, Vec::new(), self.sigma.clone());
        let mut best = (bare.cost(&point), point);
        for _ in 0..3 {
            let (_, trace) = bare.linearise(&best.1);
            let moved = bare.moved(&best.1, &trace, &bare.coordinates(&best.1));
            let cost = bare.cost(&moved);
            if cost.is_nan() || cost >= best.0 {
                break;
            }
            best = (cost, moved);
        }
        best.1
    }

    /// How much of each change of the predicted signals the residuals contain, beyond what the coordinates and the
    /// states at the start can do: the normal equations `H a = g` of the amounts. Each change has its signals for
    /// each record.
    pub fn contained(&self, point: &Point, changes: &[Residuals]) -> (DMatrix<f64>, DVector<f64>) {
        let (own, extra) = (self.coordinates.len(), changes.len());
        let (mut h, mut g) = (DMatrix::zeros(own + extra, own + extra), DVector::zeros(own + extra));
        let numbered = self.records.iter().enumerate();
        let records: Vec<usize> = numbered.flat_map(|(number, it)| vec![number; it.sections.len()]).collect();
        for ((index, record, section), number) in self.sections().into_iter().zip(records) {
            let signals: Vec<&Signals> = changes.iter().map(|change| &change[number]).collect();
            let part = self.section(point, index, record, section, &signals);
            h += part.h;
            g += part.g;
        }
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            if let Some((_, deviation)) = coordinate.prior {
                h[(index, index)] += deviation.powi(-2);
            }
        }
        // At the minimum the coordinates' own gradient is zero, up to what bounds hold.
        let mut block = h.view((0, 0), (own, own)).into_owned();
        for index in 0..own {
            block[(index, index)] =
                block[(index, index)] * (1.0 + 1e-9) + f64::from(block[(index, index)] == 0.0);
        }
        let cross = h.view((0, own), (own, extra)).into_owned();
        let solved = block.cholesky().map_or_else(|| DMatrix::zeros(own, extra), |it| it.solve(&cross));
        let h = h.view((own, own), (extra, extra)) - cross.transpose() * &solved;
        // The changes' columns in the Jacobian of the residuals are negative.
        (h, -g.rows(own, extra) + solved.transpose() * g.rows(0, own))
    }

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
    /// further coordinates.
    fn section(
        &self,
        point: &Point,
        index: usize,
        record: &Recorded,
        section: &Range<usize>,
        extra: &[&Signals],
    ) -> Section {
        let (own, states) = (self.coordinates.len(), self.states.len());
        let n = own + extra.len();
        let drive = record.drive(section, &point.inputs);
        let start = &point.starts[index];
        let outputs = self.dynamics.outputs(&point.parameters, start, &drive);
        let seeds = self.seeds(point, record, section);
        let derivatives: Vec<Signals> = seeds
            .par_chunks(DIRECTIONS)
            .flat_map_iter(|chunk| {
                let seeds: Vec<Seed> = chunk.iter().map(|(_, seed)| seed.clone()).collect();
                self.dynamics.derivatives(&point.parameters, start, &drive, &seeds)
            })
            .collect();
        let block = ((BLOCK / record.step).round() as usize).max(1);
        let mut h = DMatrix::zeros(n + states, n + states);
        let mut scores = vec![DVector::zeros(n + states); section.len().div_ceil(block)];
        for (row, measured) in record.measured.iter().enumerate() {
            let output = measured.output;
            let correction = &point.outputs[output];
            let weight = 1.0 / self.sigma[output];
            let signal = correction.applied(&outputs[output], record.step);
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
                    put(column, &correction.tangent(&outputs[output], &signals[output], record.step));
                }
            }
            for (column, coordinate) in self.coordinates.iter().enumerate() {
                if let Handle::Output(of, fault) = coordinate.handle
                    && of == output
                {
                    let change = |it: &Correction| it.applied(&outputs[output], record.step);
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
            h += jacobian.tr_mul(&jacobian);
            for (number, score) in scores.iter_mut().enumerate() {
                let first = number * block;
                let rows = block.min(section.len() - first);
                *score += jacobian.rows(first, rows).tr_mul(&residual.rows(first, rows));
            }
        }
        eliminate(&h, &scores, n, &self.ridge)
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

impl Problem for Fit<'_> {
    type Point = Point;
    type Trace = Trace;

    fn cost(&self, point: &Point) -> f64 {
        if self.dynamics.check(&point.parameters).is_err() {
            return f64::INFINITY;
        }
        let sections = self.sections();
        let parts = sections.par_iter().map(|(index, record, section)| {
            let predicted = self.predicted(point, *index, record, section);
            let mut sum = 0.0;
            for (measured, signal) in record.measured.iter().zip(predicted) {
                let weight = self.sigma[measured.output].powi(-2);
                let values = measured.values[(*section).clone()].iter();
                let known = values.zip(signal).filter(|(value, _)| value.is_finite());
                sum += 0.5 * weight * known.map(|(value, y)| (value - y).powi(2)).sum::<f64>();
            }
            sum
        });
        let parts: Vec<f64> = parts.collect();
        let prior = self.coordinates.iter().filter_map(|coordinate| {
            coordinate
                .prior
                .map(|(mean, deviation)| 0.5 * ((point.get(coordinate.handle) - mean) / deviation).powi(2))
        });
        parts.iter().sum::<f64>() + prior.sum::<f64>()
    }

    fn linearise(&self, point: &Point) -> (Linear, Trace) {
        let n = self.coordinates.len();
        let (mut h, mut g) = (DMatrix::zeros(n, n), DVector::zeros(n));
        let mut trace = Trace { sections: Vec::new(), scores: Vec::new() };
        // One section at a time: its derivatives are many, and they are what is parallel.
        for (index, record, section) in self.sections() {
            let part = self.section(point, index, record, section, &[]);
            h += part.h;
            g += part.g;
            trace.scores.extend(part.scores);
            trace.sections.push(part.elimination);
        }
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            if let Some((mean, deviation)) = coordinate.prior {
                h[(index, index)] += deviation.powi(-2);
                g[index] += (point.get(coordinate.handle) - mean) * deviation.powi(-2);
            }
        }
        (Linear::by_cholesky(&h, &g), trace)
    }

    fn coordinates(&self, point: &Point) -> DVector<f64> {
        DVector::from_iterator(
            self.coordinates.len(),
            self.coordinates.iter().map(|coordinate| point.get(coordinate.handle)),
        )
    }

    fn moved(&self, point: &Point, trace: &Trace, coordinates: &DVector<f64>) -> Point {
        let step = coordinates - self.coordinates(point);
        let mut moved = point.clone();
        for (coordinate, value) in self.coordinates.iter().zip(coordinates.iter()) {
            moved.set(coordinate.handle, *value);
        }
        for (start, elimination) in moved.starts.iter_mut().zip(&trace.sections) {
            let change = &elimination.constant + &elimination.linear * &step;
            for (state, change) in self.states.iter().zip(change.iter()) {
                start[*state] -= change;
            }
        }
        moved
    }

    fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }
}

/// The covariance of the coordinates at a minimum, whatever the residuals' correlation within a block of time; infinite
/// for a coordinate that is not determined.
pub fn covariance(linear: &Linear, scores: &[DVector<f64>]) -> DMatrix<f64> {
    let n = linear.q.len();
    let mean = scores.iter().fold(DVector::zeros(n), |sum, score| sum + score) / scores.len().max(1) as f64;
    let deviations: Vec<DVector<f64>> = scores.iter().map(|score| score - &mean).collect();
    sandwich(linear, &deviations)
}

/// `H⁻¹ (Σ s sᵀ) H⁻¹`; infinite for a coordinate that is not determined.
pub fn sandwich(linear: &Linear, scores: &[DVector<f64>]) -> DMatrix<f64> {
    let mut inverse = linear.covariance();
    let n = inverse.ncols();
    let unknown: Vec<usize> = (0..n).filter(|index| inverse[(*index, *index)].is_infinite()).collect();
    for index in &unknown {
        inverse[(*index, *index)] = 0.0;
    }
    let spread = scores.iter().fold(DMatrix::zeros(n, n), |sum, score| sum + score * score.transpose());
    let mut covariance = &inverse * spread * &inverse;
    for index in unknown {
        covariance[(index, index)] = f64::INFINITY;
    }
    covariance
}
