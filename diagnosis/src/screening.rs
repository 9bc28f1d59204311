//! Which causes the residuals of a fit may contain: every term is tried out, and compared to what is missing.

use std::ops::Range;

use nalgebra::DVector;
use rayon::prelude::*;

use crate::catalogue::{self, Cause, Element, Part, Table};
use crate::correction::Fault;
use crate::fit::{Handle, Point, Residuals};
use crate::hypothesis::{Fitted, POINTS, Term, World};
use crate::naming::name;
use crate::recorded::{Recorded, Source};

/// A term that may explain something.
#[derive(Clone, Debug)]
pub struct Screened {
    /// The term.
    pub term: Term,
    /// By how much the weighted sum of squares would fall, linearly.
    pub gain: f64,
    /// Points from which it is to be fitted, the most promising first.
    pub starts: Vec<Point>,
    /// The size of its first parameter that would be seen for certain: five standard deviations.
    pub detectable: f64,
}

/// A point with a term tried out, and what its signals are differenced against being the fit's.
pub struct Probe {
    /// Index of the term.
    pub term: usize,
    /// The point; for a sum one for each of its addends, as a table's points are.
    pub points: Vec<Point>,
}

/// What every term would change beside a fit, in the signals predicted of the training data.
pub struct Changes {
    /// The terms.
    pub terms: Vec<Term>,
    /// Each term tried out, some in several shapes, with the range of its columns: one for each of its points.
    pub probes: Vec<(Probe, Range<usize>)>,
    /// The changes of the signals.
    pub columns: Vec<Residuals>,
}

impl World<'_> {
    /// Every term that the records allow to be judged.
    pub fn terms(&self) -> Vec<Term> {
        let plant = &self.rig.plant;
        let mut terms: Vec<Term> = Vec::new();
        for cause in catalogue::causes(plant) {
            let amount = cause.parts.first().and_then(|part| plant.parameter(part.parameter));
            let there = match (amount, cause.setting.and_then(|name| plant.setting(name))) {
                (Some(index), _) => self.rig.parameters[index] != 0.0,
                (None, Some(setting)) => self.rig.choices[setting] == strut_model::Value::Boolean(true),
                (None, None) => true,
            };
            if !there {
                terms.push(Term::Cause(cause));
            }
        }
        terms.extend(catalogue::tables(plant).map(Term::Table));
        let Some(record) = self.train.first() else { return terms };
        for measured in &record.measured {
            let name = &plant.outputs[measured.output].name;
            // A drift is looked for with the offset that it starts from.
            for fault in Fault::ALL.into_iter().filter(|fault| *fault != Fault::Drift) {
                let bends = matches!(fault, Fault::Quadratic | Fault::Cubic);
                if !bends || name.ends_with("deflection") {
                    terms.push(Term::Fault(Handle::Output(measured.output, fault)));
                }
            }
        }
        for (input, source) in record.inputs.iter().enumerate() {
            if matches!(source, Source::Measured(_)) && !self.twofold(record, input) {
                // Positions count from wherever equilibrium is.
                let offset = (!plant.inputs[input].name.ends_with("position")).then_some(Fault::Offset);
                for fault in [Fault::Gain, Fault::Delay, Fault::Lag].into_iter().chain(offset) {
                    terms.push(Term::Fault(Handle::Input(input, fault)));
                }
            }
        }
        terms.retain(|term| self.only.is_empty() || self.only.contains(&name(*term, plant).id));
        terms
    }

    /// Whether an input is measured as a position and as a velocity: one of them wrong would contradict the other.
    fn twofold(&self, record: &Recorded, input: usize) -> bool {
        let plant = &self.rig.plant;
        let name = &plant.inputs[input].name;
        let other = |from: &str, to: &str| Some(format!("{}{to}", name.strip_suffix(from)?));
        [other("position", "velocity"), other("velocity", "position")].into_iter().flatten().any(|name| {
            plant.input(&name).is_some_and(|index| matches!(record.inputs[index], Source::Measured(_)))
        })
    }

    /// What every term would change beside a fit.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn changes(&self, fitted: &Fitted) -> Result<Changes, String> {
        let terms: Vec<Term> = self.terms().into_iter().filter(|term| !fitted.terms.contains(term)).collect();
        let dynamics = self.dynamics(&fitted.terms)?;
        let predicted = self.fit(&*dynamics, self.train, Vec::new()).predictions(&fitted.point);
        let probes: Vec<Probe> = terms
            .iter()
            .enumerate()
            .flat_map(|(index, term)| self.probes(index, *term, &fitted.point))
            .collect();
        let changed = |term: Term, point: &Point| -> Option<Residuals> {
            let mut all = fitted.terms.clone();
            all.push(term);
            let dynamics = self.dynamics(&all).ok()?;
            let mut signals = self.fit(&*dynamics, self.train, Vec::new()).predictions(point);
            for (record, before) in signals.iter_mut().zip(&predicted) {
                for (signal, before) in record.iter_mut().zip(before) {
                    for (value, before) in signal.iter_mut().zip(before) {
                        *value -= before;
                        if !value.is_finite() {
                            return None;
                        }
                    }
                }
            }
            Some(signals)
        };
        let changes: Vec<Option<Vec<Residuals>>> = probes
            .par_iter()
            .map(|probe| probe.points.iter().map(|point| changed(terms[probe.term], point)).collect())
            .collect();
        let mut columns = Vec::new();
        let mut kept = Vec::new();
        for (probe, changes) in probes.into_iter().zip(changes) {
            let Some(changes) = changes else { continue };
            let first = columns.len();
            columns.extend(changes);
            kept.push((probe, first..columns.len()));
        }
        Ok(Changes { terms, probes: kept, columns })
    }

    /// Compares every term to what a fit misses.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn screened(&self, fitted: &Fitted) -> Result<Vec<Screened>, String> {
        let Changes { terms, probes, columns } = self.changes(fitted)?;
        let dynamics = self.dynamics(&fitted.terms)?;
        let fit = self.fit(&*dynamics, self.train, fitted.coordinates.clone());
        let (h, g) = fit.contained(&fitted.point, &columns);

        let mut screened: Vec<Screened> = terms
            .iter()
            .map(|term| Screened { term: *term, gain: 0.0, starts: Vec::new(), detectable: f64::INFINITY })
            .collect();
        let mut found: Vec<Vec<(f64, Point)>> = vec![Vec::new(); terms.len()];
        for (probe, range) in &probes {
            let mut block = h.view((range.start, range.start), (range.len(), range.len())).into_owned();
            for index in 0..range.len() {
                block[(index, index)] = block[(index, index)] * (1.0 + 1e-6) + f64::MIN_POSITIVE;
            }
            let right = g.rows(range.start, range.len()).into_owned();
            let Some(factor) = block.cholesky() else { continue };
            let amounts = factor.solve(&right);
            let gain = amounts.dot(&right);
            let screened = &mut screened[probe.term];
            if !matches!(terms[probe.term], Term::Table(_)) {
                let size = self.first_size(terms[probe.term], &probe.points[0], &fitted.point);
                screened.detectable = screened.detectable.min(5.0 * size * factor.inverse()[(0, 0)].sqrt());
            }
            let (gain, point) = self.start(terms[probe.term], probe, &amounts, gain, &fitted.point);
            found[probe.term].push((gain, point));
        }
        for (screened, mut found) in screened.iter_mut().zip(found) {
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            screened.gain = found.first().map_or(0.0, |(gain, _)| *gain);
            // A second start where it may lead as far.
            let near = 0.5 * screened.gain;
            screened.starts =
                found.into_iter().take(2).filter(|(gain, _)| *gain >= near).map(|(_, point)| point).collect();
        }
        screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Ok(screened)
    }

    fn probes(&self, index: usize, term: Term, at: &Point) -> Vec<Probe> {
        match term {
            Term::Cause(cause) => self
                .shapes(cause, at)
                .into_iter()
                .map(|shape| Probe { term: index, points: self.addends(cause, shape, at) })
                .collect(),
            Term::Table(table) => vec![Probe { term: index, points: self.knots(table, at) }],
            Term::Fault(handle) => {
                let mut point = at.clone();
                point.set(handle, at.get(handle) + self.typical_fault(handle));
                vec![Probe { term: index, points: vec![point] }]
            }
        }
    }

    /// A shape of a cause, and each of its addends without the others.
    fn addends(&self, cause: &Cause, shape: Point, at: &Point) -> Vec<Point> {
        let typical = self.typical(cause.element);
        let index = |part: &Part| self.rig.plant.parameter(part.parameter);
        let alone = |part: &Part| {
            let (amount, first) = (index(part)?, index(cause.parts.first()?)?);
            let mut point = shape.clone();
            point.parameters[first] = at.parameters[first];
            point.parameters[amount] += part.probes.first()? * part.scale.of(&typical);
            Some(point)
        };
        let others: Vec<Point> = cause.parts.iter().filter(|part| part.addend).filter_map(alone).collect();
        std::iter::once(shape).chain(others).collect()
    }

    /// A cause from every combination of its probes, without its addends.
    fn shapes(&self, cause: &Cause, at: &Point) -> Vec<Point> {
        let typical = self.typical(cause.element);
        let mut points = vec![at.clone()];
        for part in cause.parts.iter().filter(|part| !part.addend) {
            let Some(index) = self.rig.plant.parameter(part.parameter) else { continue };
            // What another cause has brought already stays.
            let there = at.parameters[index] != self.rig.parameters[index];
            let values: Vec<f64> = if there {
                vec![at.parameters[index]]
            } else {
                let declared = &self.rig.plant.parameters[index];
                let (low, high) = (declared.min.unwrap_or(f64::MIN), declared.max.unwrap_or(f64::MAX));
                part.probes.iter().map(|probe| (probe * part.scale.of(&typical)).clamp(low, high)).collect()
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

    /// A table's points, each a tenth of the typical force.
    fn knots(&self, table: &Table, at: &Point) -> Vec<Point> {
        let plant = &self.rig.plant;
        let force = 0.1 * self.typical(table.element).force;
        let mut flat = at.clone();
        let indices = (plant.parameter(table.switch), plant.parameter(table.range));
        let (Some(switch), Some(range)) = indices else { return Vec::new() };
        flat.parameters[switch] = 1.0;
        // Three times the root mean square is about the largest value.
        flat.parameters[range] = 3.0 * table.scale.of(&self.typical(table.element));
        let points =
            (1..=POINTS).filter_map(|number| plant.parameter(&format!("{}[{number}]", table.points)));
        points
            .map(|index| {
                let mut point = flat.clone();
                point.parameters[index] = force;
                point
            })
            .collect()
    }

    /// A fault that would be noticed.
    fn typical_fault(&self, handle: Handle) -> f64 {
        let Some(record) = self.train.first() else { return 0.0 };
        let (fault, magnitude) = match handle {
            Handle::Input(input, fault) => match &record.inputs[input] {
                Source::Measured(values) => (fault, rms(values)),
                Source::DerivativeOf(_) | Source::Constant(_) => (fault, 1.0),
            },
            Handle::Output(output, fault) => {
                let measured = record.measured.iter().find(|it| it.output == output);
                (fault, measured.map_or(1.0, |measured| rms(&measured.values)))
            }
            Handle::Parameter(_) => return 0.0,
        };
        let magnitude = magnitude.max(f64::MIN_POSITIVE);
        match fault {
            Fault::Gain => 0.05,
            Fault::Offset => 0.1 * magnitude,
            Fault::Drift => 0.1 * magnitude / (record.len() as f64 * record.step),
            Fault::Lag | Fault::Delay => record.step.max(1e-3),
            Fault::Quadratic => 0.05 / magnitude,
            Fault::Cubic => 0.05 / magnitude.powi(2),
        }
    }

    /// By how much a probe differs from the fit in the term's first parameter.
    fn first_size(&self, term: Term, probe: &Point, at: &Point) -> f64 {
        match self.own_coordinates(term).first() {
            Some(coordinate) => (probe.get(coordinate.handle) - at.get(coordinate.handle)).abs(),
            None => 1.0,
        }
    }

    /// Where a fit of the term starts, and what it may gain there.
    fn start(
        &self,
        term: Term,
        probe: &Probe,
        amounts: &DVector<f64>,
        gain: f64,
        at: &Point,
    ) -> (f64, Point) {
        let Some(mut point) = probe.points.first().cloned() else { return (0.0, at.clone()) };
        let own = self.own_coordinates(term);
        match probe.points.as_slice() {
            [_, _, ..] => {
                for coordinate in &own {
                    let before = at.get(coordinate.handle);
                    let tried = probe.points.iter().map(|tried| tried.get(coordinate.handle) - before);
                    let step: f64 = tried.zip(amounts.iter()).map(|(tried, amount)| amount * tried).sum();
                    let value = before + step;
                    point.set(coordinate.handle, value.clamp(coordinate.bounds.0, coordinate.bounds.1));
                }
                (gain, point)
            }
            _ => {
                let Some(first) = own.first() else { return (gain.max(0.0), point) };
                let before = at.get(first.handle);
                let step = amounts[0] * (probe.points[0].get(first.handle) - before);
                let (low, high) = first.bounds;
                // What would have to be negative is not there; it is tried from a small amount all the same.
                let possible = (before + step).clamp(low, high) != before;
                let least = 0.1 * (probe.points[0].get(first.handle) - before);
                let amount = if possible { step } else { least };
                point.set(first.handle, (before + amount).clamp(low, high));
                (if possible { gain } else { 0.0 }, point)
            }
        }
    }
}

/// Root mean square of the known values about their mean.
pub fn rms(values: &[f64]) -> f64 {
    let known: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let n = known.len().max(1) as f64;
    let mean = known.iter().sum::<f64>() / n;
    (known.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Typical magnitudes of an element over records, from predicted signals of all outputs.
pub fn typical(
    world_rig: &crate::rig::Rig,
    records: &[Recorded],
    outputs: &[Vec<Vec<f64>>],
) -> Vec<(Element, catalogue::Typical)> {
    use crate::rig::ForceOf;
    let plant = &world_rig.plant;
    let signal = |name: &str| -> Vec<Vec<f64>> {
        let index = plant.output(name);
        outputs.iter().map(|record| index.map_or_else(Vec::new, |index| record[index].clone())).collect()
    };
    let magnitude = |signals: &[Vec<f64>]| rms(&signals.concat()).max(1e-12);
    let value = |name: &str| plant.parameter(name).map_or(0.0, |index| world_rig.parameters[index]);
    let of = |element: &crate::rig::ElementSignals| {
        let positions = signal(element.deflection);
        let velocities = match element.velocity {
            Some(name) => signal(name),
            None => {
                let pairs = positions.iter().zip(records);
                pairs.map(|(x, record)| crate::recorded::derivative(x, record.step)).collect()
            }
        };
        let (deflection, velocity) = (magnitude(&positions), magnitude(&velocities));
        let force = match element.force {
            ForceOf::Output(name) => {
                // Measured rather than simulated, where it is measured: the model may be far off.
                let index = plant.output(name);
                let measured: Vec<f64> = records
                    .iter()
                    .flat_map(|record| record.measured.iter().filter(|it| Some(it.output) == index))
                    .flat_map(|measured| measured.values.clone())
                    .collect();
                if measured.is_empty() { magnitude(&signal(name)) } else { rms(&measured).max(1e-12) }
            }
            ForceOf::Moment(force, lever) => (value(lever) * magnitude(&signal(force))).max(1e-12),
            ForceOf::SpringAndDamper(stiffness, damping) => {
                (value(stiffness) * deflection).hypot(value(damping) * velocity)
            }
        };
        (element.element, catalogue::Typical { force, deflection, velocity })
    };
    world_rig.kind.elements.iter().map(of).collect()
}
