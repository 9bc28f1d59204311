//! Fitting a plant to records: output error, weighted, with every state at the start estimated along.

mod normal;
mod settling;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::dataset::recorded::Dataset;
use crate::estimation::lsq::{Linear, Problem};
use crate::estimation::unknowns::{Estimate, FreeParameter, strain};
use crate::plant::{Dynamics, Plant, Signals};

use normal::Elimination;

/// What the names of states begin with whose values at the start are not estimated: they are forgotten within
/// milliseconds, or act only after long.
const FORGOTTEN: &[&str] = &[
    "hysteresis.",
    "clevis.",
    "actuator.",
    "frame.",
    "enveloping.",
    "force_cell.",
    "spool.follower",
    "current",
    "overload",
    "velocity_loop.command",
    "velocity_loop.output",
];

/// What of it is estimated where motion is imposed: that may be slow, and a body that turned just before the record shows its friction
/// until it turns again.
const REMEMBERED: &[&str] = &["hysteresis.", "clevis."];

/// How far a state at the start may go in a step on a standard deviation's gain, in its nominal values, or in what the record has in its
/// unit. What is forgotten within milliseconds hardly shows: without a bound it would be sent as far as a limiter.
const FAR: f64 = 3.0;

/// Measured less predicted, for each record and each of its measured outputs.
pub type Residuals = Vec<Signals>;

/// The normal equations `H d = −g` of a fit's coordinates and, behind them, of the amounts of further changes of its signals.
#[derive(Clone, Debug)]
pub struct Normal {
    /// `H`.
    pub h: DMatrix<f64>,
    /// `g`.
    pub g: DVector<f64>,
    /// What each block of time adds to `g`, priors aside.
    pub scores: Vec<DVector<f64>>,
}

/// Changes of the signals predicted of a section, by its number over all records.
pub type Changes<'a> = dyn Fn(usize, &Dataset, &Range<usize>) -> Vec<Signals> + 'a;

/// The fit of a plant to records as a least-squares problem.
pub struct Fit<'a> {
    /// The model.
    pub plant: &'a Plant,
    /// Its equations.
    pub dynamics: &'a dyn Dynamics,
    /// What was measured.
    pub records: &'a [Dataset],
    /// What may be changed.
    pub coordinates: Vec<FreeParameter>,
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

impl<'a> Fit<'a> {
    /// A fit.
    pub fn new(
        plant: &'a Plant,
        dynamics: &'a dyn Dynamics,
        records: &'a [Dataset],
        coordinates: Vec<FreeParameter>,
        sigma: Vec<f64>,
    ) -> Self {
        let bounds = coordinates.iter().map(|coordinate| coordinate.bounds).collect();
        let imposed = records.first().filter(|it| it.imposed);
        let is_of = |name: &str, prefixes: &[&str]| prefixes.iter().any(|it| name.starts_with(it));
        let is_estimated =
            |name: &str| !is_of(name, FORGOTTEN) || imposed.is_some() && is_of(name, REMEMBERED);
        let states = plant.states.iter().enumerate().filter(|(_, state)| is_estimated(&state.name));
        let states: Vec<usize> = states.map(|(index, _)| index).collect();
        let size = |state: &usize| {
            let state = &plant.states[*state];
            let nominal = state.nominal.unwrap_or(1.0);
            imposed.map_or(nominal, |record| record.magnitude(plant, state.unit).max(nominal))
        };
        let ridge = states.iter().map(|state| (FAR * size(state)).powi(-2)).collect();
        Self { plant, dynamics, records, coordinates, sigma, states, ridge, bounds }
    }

    fn sections(&self) -> Vec<(usize, &'a Dataset, &'a Range<usize>)> {
        let all = self.records.iter().flat_map(|record| record.sections.iter().map(move |it| (record, it)));
        all.enumerate().map(|(index, (record, section))| (index, record, section)).collect()
    }

    /// The measured outputs as predicted in a section.
    pub fn predicted(
        &self,
        point: &Estimate,
        start: &[f64],
        record: &Dataset,
        section: &Range<usize>,
    ) -> Signals {
        let drive = record.drive(section, &point.inputs);
        let mut outputs = self.dynamics.outputs(&point.parameters, start, &drive);
        let measured = record.measured.iter();
        measured
            .map(|measured| {
                let signal = std::mem::take(&mut outputs[measured.output]);
                let correction = &point.outputs[measured.output];
                if correction.is_neutral() {
                    signal
                } else {
                    correction.applied(&signal, record.samples(section))
                }
            })
            .collect()
    }

    /// Half the weighted sum of squares of a section.
    fn section_cost(&self, point: &Estimate, start: &[f64], record: &Dataset, section: &Range<usize>) -> f64 {
        let predicted = self.predicted(point, start, record, section);
        let signals = record.measured.iter().zip(predicted).enumerate().map(|(row, (measured, signal))| {
            let weight = self.sigma[measured.output].powi(-2);
            let values = record.compared(row, section);
            let known = values.iter().zip(signal).filter(|(value, _)| value.is_finite());
            0.5 * weight * known.map(|(value, y)| (value - y).powi(2)).sum::<f64>()
        });
        signals.sum()
    }

    /// Predicted signals of each record, whole.
    pub fn predictions(&self, point: &Estimate) -> Residuals {
        let sections = self.sections();
        let parts: Vec<Signals> = sections
            .par_iter()
            .map(|(index, record, it)| self.predicted(point, &point.starts[*index], record, it))
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
    pub fn residuals(&self, point: &Estimate) -> Residuals {
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

    /// The normal equations of the coordinates and of the amounts of changes of the predicted signals, without
    /// the states at the start. The changes are asked for section by section, since they are many, and entries of changes in
    /// different groups are not computed.
    pub fn beside(&self, point: &Estimate, changes: &Changes<'_>, groups: &[Range<usize>]) -> Normal {
        let own = self.coordinates.len();
        let all = own + groups.last().map_or(0, |last| last.end);
        let (mut h, mut g, mut scores) = (DMatrix::zeros(all, all), DVector::zeros(all), Vec::new());
        for (index, record, section) in self.sections() {
            let signals = changes(index, record, section);
            let part = self.section(point, &point.starts[index], record, section, (&signals, groups));
            h += part.h;
            g += part.g;
            scores.extend(part.scores);
        }
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            if let Some((_, slope)) = coordinate.distance(point) {
                h[(index, index)] += slope * slope;
            }
        }
        Normal { h, g, scores }
    }
}

/// How much of each change of the predicted signals the residuals contain, beyond what the first `own` coordinates and the
/// states at the start can do: the normal equations `H a = g` of the amounts, from those of both. Each block's part of `g` has
/// the sign of `g`.
pub fn contained(normal: &Normal, own: usize) -> Normal {
    let Normal { h, g, scores } = normal;
    let extra = g.len() - own;
    // At the minimum the coordinates' own gradient is zero, up to what bounds hold.
    let mut block = h.view((0, 0), (own, own)).into_owned();
    for index in 0..own {
        block[(index, index)] =
            block[(index, index)] * (1.0 + 1e-9) + f64::from(block[(index, index)] == 0.0);
    }
    let cross = h.view((0, own), (own, extra)).into_owned();
    let solved = block.cholesky().map_or_else(|| DMatrix::zeros(own, extra), |it| it.solve(&cross));
    // The changes' columns in the Jacobian of the residuals are negative.
    let beyond = |g: &DVector<f64>| -g.rows(own, extra) + solved.tr_mul(&g.rows(0, own));
    Normal {
        h: h.view((own, own), (extra, extra)) - cross.tr_mul(&solved),
        g: beyond(g),
        scores: scores.iter().map(beyond).collect(),
    }
}

impl Problem for Fit<'_> {
    type Estimate = Estimate;
    type Trace = Trace;

    fn is_possible(&self, point: &Estimate) -> bool {
        self.dynamics.check(&point.parameters).is_ok()
    }

    fn cost(&self, point: &Estimate) -> f64 {
        if !self.is_possible(point) {
            return f64::INFINITY;
        }
        let sections = self.sections();
        let parts = sections
            .par_iter()
            .map(|(index, record, section)| self.section_cost(point, &point.starts[*index], record, section));
        let parts: Vec<f64> = parts.collect();
        parts.iter().sum::<f64>() + strain(&self.coordinates, point)
    }

    fn linearise(&self, point: &Estimate) -> (Linear, Trace) {
        let n = self.coordinates.len();
        let (mut h, mut g) = (DMatrix::zeros(n, n), DVector::zeros(n));
        let mut trace = Trace { sections: Vec::new(), scores: Vec::new() };
        // One section at a time: its derivatives are many, and they are what is parallel.
        for (index, record, section) in self.sections() {
            let part = self.section(point, &point.starts[index], record, section, (&[], &[]));
            h += part.h;
            g += part.g;
            trace.scores.extend(part.scores);
            trace.sections.push(part.elimination);
        }
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            if let Some((distance, slope)) = coordinate.distance(point) {
                h[(index, index)] += slope * slope;
                g[index] += distance * slope;
            }
        }
        (Linear::by_cholesky(&h, &g), trace)
    }

    fn coordinates(&self, point: &Estimate) -> DVector<f64> {
        DVector::from_iterator(
            self.coordinates.len(),
            self.coordinates.iter().map(|coordinate| point.get(coordinate.handle)),
        )
    }

    fn moved(&self, point: &Estimate, trace: &Trace, coordinates: &DVector<f64>) -> Estimate {
        let step = coordinates - self.coordinates(point);
        let mut moved = point.clone();
        for (coordinate, value) in self.coordinates.iter().zip(coordinates.iter()) {
            moved.set(coordinate.handle, *value);
        }
        for (start, elimination) in moved.starts.iter_mut().zip(&trace.sections) {
            *start = self.gone(start, &(&elimination.constant + &elimination.linear * &step));
        }
        moved
    }

    fn hold_back(&self, point: &Estimate, trace: &mut Trace) {
        self.hold_sections_back(point, &mut trace.sections);
    }

    fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }
}
