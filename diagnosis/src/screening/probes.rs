//! How terms are tried out: by which amounts, and in which shapes.

use crate::catalogue::{Effect, Part, TIMES, Table};
use crate::dataset::recorded::Source;
use crate::estimation::coordinates::POINTS;
use crate::estimation::hypothesis::{Baseline, Term};
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::signal::distortion::{AFTER, Fault};

use super::rms;

/// Relative errors of a sampling rate from which they are looked for.
const RATES: &[f64] = &[1e-4, 1e-3, -1e-3, 3e-3, -3e-3, 6e-3, -6e-3, 1e-2, -1e-2];

/// Delays in seconds that are looked for beside the shorter [`TIMES`]: of a valve, a fan, a cable, of loggers started by hand.
const LONG: &[f64] = &[0.04, 0.1, 0.25];

/// Shares of the largest command at which its limit is looked for.
const LIMITS: &[f64] = &[0.5, 0.7, 0.85];

/// A point with a term tried out, and what its signals are differenced against being the fit's.
pub struct Probe {
    /// Index of the term.
    pub term: usize,
    /// The point; for a sum one for each of its addends, as a table's points are.
    pub points: Vec<Estimate>,
}

impl Baseline<'_> {
    /// A term tried out, in several shapes where it has some.
    pub fn probes(&self, index: usize, term: Term, at: &Estimate) -> Vec<Probe> {
        match term {
            Term::Effect(effect) => self
                .shapes(effect, at)
                .into_iter()
                .map(|shape| Probe { term: index, points: self.addends(effect, shape, at) })
                .collect(),
            Term::Table(table) => vec![Probe { term: index, points: self.knots(table, at) }],
            Term::Response(output) => {
                let point = |point: usize| {
                    let handle = Unknown::Output(output, Fault::Response(point));
                    let mut moved = at.clone();
                    moved.set(handle, at.get(handle) + self.typical_fault(handle));
                    moved
                };
                vec![Probe { term: index, points: (0..AFTER.len()).map(point).collect() }]
            }
            Term::Fault(handle) => {
                let probe = |amount: f64| {
                    let mut point = at.clone();
                    point.set(handle, at.get(handle) + amount);
                    Probe { term: index, points: vec![point] }
                };
                match handle {
                    // From zero, a signal whose phase has run away shows no way back.
                    Unknown::Output(_, Fault::Rate) => RATES.iter().map(|rate| probe(*rate)).collect(),
                    Unknown::Input(input, Fault::Limit) => {
                        let largest = self.largest(input);
                        LIMITS.iter().map(|share| probe(share * largest)).collect()
                    }
                    Unknown::Input(_, Fault::Lag) | Unknown::Output(_, Fault::Lag) => {
                        TIMES.iter().map(|time| probe(*time)).collect()
                    }
                    // Where one channel is early, all others are late.
                    Unknown::Input(_, Fault::Delay) | Unknown::Output(_, Fault::Delay) => {
                        let (_, most) = self.fault_bounds(handle);
                        let times = TIMES.iter().chain(LONG).filter(|time| **time <= most);
                        times.flat_map(|time| [*time, -time]).map(probe).collect()
                    }
                    // What goes with it, as a drift with an offset, is there or not on its own.
                    _ => {
                        let own = self.own_coordinates(term).into_iter().map(|it| it.handle);
                        let points = own.map(|handle| {
                            let mut point = at.clone();
                            point.set(handle, at.get(handle) + self.typical_fault(handle));
                            point
                        });
                        vec![Probe { term: index, points: points.collect() }]
                    }
                }
            }
        }
    }

    /// A shape of an effect, and each of its addends without the others.
    fn addends(&self, effect: &Effect, shape: Estimate, at: &Estimate) -> Vec<Estimate> {
        let typical = self.typical(effect.element);
        let index = |part: &Part| self.rig.plant.parameter(part.parameter);
        let alone = |part: &Part| {
            let (amount, first) = (index(part)?, index(effect.parts.first()?)?);
            let mut point = shape.clone();
            point.parameters[first] = at.parameters[first];
            point.parameters[amount] += part.probes.first()? * part.scale.of(&typical);
            Some(point)
        };
        let others: Vec<Estimate> =
            effect.parts.iter().filter(|part| part.addend).filter_map(alone).collect();
        std::iter::once(shape).chain(others).collect()
    }

    /// An effect from every combination of its probes, without its addends.
    fn shapes(&self, effect: &Effect, at: &Estimate) -> Vec<Estimate> {
        let typical = self.typical(effect.element);
        let mut points = vec![at.clone()];
        for part in effect.parts.iter().filter(|part| !part.addend) {
            let Some(index) = self.rig.plant.parameter(part.parameter) else { continue };
            // What another effect has brought already stays.
            let there = at.parameters[index] != self.rig.parameters[index];
            let values: Vec<f64> = if there {
                vec![at.parameters[index]]
            } else {
                let declared = &self.rig.plant.parameters[index];
                let (low, high) = (declared.min.unwrap_or(f64::MIN), declared.max.unwrap_or(f64::MAX));
                let within = part.within.map_or(f64::INFINITY, |(scale, most)| most * scale.of(&typical));
                let values = part.probes.iter().map(|probe| probe * part.scale.of(&typical));
                values.filter(|value| *value <= within).map(|value| value.clamp(low, high)).collect()
            };
            points = points
                .iter()
                .flat_map(|point| {
                    values.iter().map(|value| {
                        let mut point = point.clone();
                        point.parameters[index] = *value;
                        point
                    })
                })
                .collect();
        }
        points
    }

    /// A table's points, each a tenth of what is typical.
    fn knots(&self, table: &Table, at: &Estimate) -> Vec<Estimate> {
        let plant = &self.rig.plant;
        let typical = self.typical(table.element);
        let point = 0.1 * table.law.point.of(&typical);
        let mut flat = at.clone();
        let indices = (plant.parameter(table.switch), plant.parameter(table.range));
        let (Some(switch), Some(range)) = indices else { return Vec::new() };
        flat.parameters[switch] = 1.0;
        // Three times the root mean square is about the largest value.
        flat.parameters[range] = 3.0 * table.scale.of(&typical);
        let knots = (1..=POINTS).filter_map(|number| plant.parameter(&format!("{}[{number}]", table.points)));
        knots
            .map(|index| {
                let mut moved = flat.clone();
                moved.parameters[index] = point;
                moved
            })
            .collect()
    }

    /// A fault that would be noticed.
    fn typical_fault(&self, handle: Unknown) -> f64 {
        let Some(record) = self.train.first() else { return 0.0 };
        let (fault, magnitude) = match handle {
            Unknown::Input(input, fault) => match &record.inputs[input] {
                Source::Measured(values) => (fault, rms(values)),
                Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => (fault, 1.0),
            },
            Unknown::Output(output, fault) => {
                let measured = record.measured.iter().find(|it| it.output == output);
                (fault, measured.map_or(1.0, |measured| rms(&measured.values)))
            }
            Unknown::Parameter(_) => return 0.0,
        };
        let magnitude = magnitude.max(f64::MIN_POSITIVE);
        match fault {
            Fault::Gain | Fault::Response(_) => 0.05,
            Fault::Offset => 0.1 * magnitude,
            Fault::Drift => 0.1 * magnitude / (record.len() as f64 * record.step),
            Fault::Lag | Fault::Delay => record.step.max(1e-3),
            Fault::Rate => RATES[0],
            Fault::Limit => magnitude,
            Fault::Quadratic => 0.05 / magnitude,
            Fault::Cubic => 0.05 / magnitude.powi(2),
        }
    }
}
