//! What of a model is fitted: nominal parameters, the timing of the channels, and what effects bring.

use strut_model::unit;

use crate::catalogue::{self, Bounds, Part, Scale, Signal};
use crate::dataset::recorded::Source;
use crate::diagnosis::component::Component;
use crate::estimation::hypothesis::{Baseline, Term};
use crate::estimation::unknowns::{FreeParameter, Prior, Unknown};
use crate::signal::distortion::{AFTER, Fault, UNKNOWN};
use crate::signal::spectral::below;

/// Points of a table without a name.
pub const POINTS: usize = 11;

/// Standard deviation of a channel's timing in seconds: multiplexers and buses make such delays, and the filters of
/// accelerometers have such time constants. They are no fault.
pub const TIMING: f64 = 4e-4;

/// Standard deviations within which a value is that was measured otherwise.
pub(crate) const SURE: f64 = 3.0;

/// Standard deviations of a channel's timing within which a signal is in time.
pub(crate) const IN_TIME: f64 = 2.5;

/// Standard deviation of the logarithm of a nominal parameter that is stated, before the data are seen: a data sheet's damping or
/// tyre stiffness is right within a third.
pub(crate) const TOLERANCE: f64 = 0.3;

/// Factor within which a stated parameter is looked for if it must not be zero.
const SHEET: f64 = 20.0;

/// Standard deviation of a start value that may be negative, over its value.
const SIGNED: f64 = 10.0;

/// Share of a signal's period beyond which it is as well reversed and early as late.
const QUARTER: f64 = 0.25;

impl Baseline<'_> {
    /// Standard deviation of what any measurement does to a signal; none for what would be a fault.
    pub fn usual(&self, handle: Unknown) -> Option<f64> {
        let filtered = |output: usize| self.rig.plant.outputs[output].name.ends_with("acceleration");
        match handle {
            Unknown::Output(_, Fault::Delay) => Some(TIMING),
            Unknown::Output(output, Fault::Lag) if filtered(output) => Some(TIMING),
            _ => None,
        }
    }

    /// The free parameters of a fit with the terms: nominal parameters first, then the terms' own, each once.
    pub fn coordinates(&self, terms: &[Term]) -> Vec<FreeParameter> {
        let plant = &self.rig.plant;
        let mut coordinates: Vec<FreeParameter> = Vec::new();
        for index in self.rig.base() {
            let (declared, value) = (&plant.parameters[index], self.rig.parameters[index]);
            let (low, high) =
                (declared.min.unwrap_or(f64::NEG_INFINITY), declared.max.unwrap_or(f64::INFINITY));
            let stated = self.rig.stated[index];
            let around = if stated { SHEET } else { f64::INFINITY };
            // Near zero, what must not be zero makes equations that nothing can integrate; but there may be no spring.
            let least = if declared.unit == unit::N_PER_M { low } else { low.max(value / around) };
            let bounds = if low > 0.0 { (least, high.min(value * around)) } else { (low, high) };
            let bounds = self.sought(index).map_or(bounds, |(from, to)| (from.min(value), to.max(value)));
            // However many samples a model that is not quite right has to say otherwise with.
            let known = self.known.iter().find(|(of, _, _)| *of == index);
            let bounds = known.map_or(bounds, |(_, mean, deviation)| {
                let (low, high) = (bounds.0.min(*mean), bounds.1.max(*mean));
                (low.max(mean - SURE * deviation), high.min(mean + SURE * deviation))
            });
            // It is right within a factor where the data do not know better; of what nobody knows it says zero.
            let sheet = (value != 0.0 && (self.uses(Component::Tolerances) || !stated)).then_some(
                match (value > 0.0 && low >= 0.0, stated) {
                    (true, true) => Prior::Factor { mean: value, deviation: TOLERANCE },
                    (true, false) => Prior::Guess { mean: value },
                    (false, _) => Prior::Value { mean: value, deviation: SIGNED * value.abs() },
                },
            );
            let known = known.map(|(_, mean, deviation)| Prior::Value { mean: *mean, deviation: *deviation });
            let prior = known.or(sheet);
            coordinates.push(FreeParameter { handle: Unknown::Parameter(index), bounds, prior });
        }
        for measured in self.train.first().map_or(&[][..], |record| &record.measured) {
            for handle in [Fault::Delay, Fault::Lag].map(|fault| Unknown::Output(measured.output, fault)) {
                let bounds = self.fault_bounds(handle);
                let Some(deviation) = self.usual(handle) else { continue };
                // A signal that is later than that has a fault, which is a term of its own.
                let most = IN_TIME * deviation;
                let bounds = (bounds.0.max(-most), bounds.1.min(most));
                coordinates.push(FreeParameter {
                    handle,
                    bounds,
                    prior: Some(Prior::Value { mean: 0.0, deviation }),
                });
            }
        }
        for term in terms {
            for coordinate in self.own_coordinates(*term) {
                match coordinates.iter_mut().find(|other| other.handle == coordinate.handle) {
                    Some(other) => *other = coordinate,
                    None => coordinates.push(coordinate),
                }
            }
        }
        coordinates
    }

    /// The bounds of a velocity that nobody states and that is part of an effect's law: where it would be looked for if the rig did
    /// not have the effect already, the widest of all effects that it is part of. Of friction that turns over in no time at all, no derivative tells anything.
    pub(crate) fn sought(&self, index: usize) -> Option<(f64, f64)> {
        if self.rig.stated[index] {
            return None;
        }
        let plant = &self.rig.plant;
        let parts = catalogue::effects(plant).flat_map(|it| it.parts.iter().map(move |part| (it, part)));
        let own =
            |part: &Part| part.scale == Scale::VELOCITY && plant.parameter(part.parameter) == Some(index);
        let ranges = parts.filter(|(_, part)| own(part)).map(|(effect, part)| {
            let unit = part.scale.of(&self.typical(effect.element));
            (part.bounds.0 * unit, part.bounds.1 * unit)
        });
        ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// The coordinates that a term brings.
    pub fn own_coordinates(&self, term: Term) -> Vec<FreeParameter> {
        let plant = &self.rig.plant;
        match term {
            Term::Effect(effect) => {
                let typical = self.typical(effect.element);
                let parts = effect.parts.iter().filter_map(|part| {
                    let (index, unit) = (plant.parameter(part.parameter)?, part.scale.of(&typical));
                    let declared = &plant.parameters[index];
                    let low = (part.bounds.0 * unit).max(declared.min.unwrap_or(f64::NEG_INFINITY));
                    let within = part.within.map_or(f64::INFINITY, |(scale, most)| most * scale.of(&typical));
                    let high = (part.bounds.1 * unit).min(declared.max.unwrap_or(f64::INFINITY)).min(within);
                    let high = high.max(low);
                    Some(FreeParameter {
                        handle: Unknown::Parameter(index),
                        bounds: (low, high),
                        prior: None,
                    })
                });
                parts.collect()
            }
            Term::Table(table) => {
                let typical = table.law.point.of(&self.typical(table.element));
                let points =
                    (1..=POINTS).filter_map(|number| plant.parameter(&format!("{}[{number}]", table.points)));
                points
                    .map(|index| FreeParameter {
                        handle: Unknown::Parameter(index),
                        bounds: (table.law.bounds.0 * typical, table.law.bounds.1 * typical),
                        // A ridge: points that nothing reaches stay at zero.
                        prior: Some(Prior::Value { mean: 0.0, deviation: typical }),
                    })
                    .collect()
            }
            Term::Fault(handle) => {
                let with = match handle {
                    Unknown::Output(output, fault) => {
                        let with = catalogue::distortion(fault).at(Signal::Output).with;
                        with.map(|fault| Unknown::Output(output, fault))
                    }
                    Unknown::Input(..) | Unknown::Parameter(_) => None,
                };
                let of = |handle| FreeParameter { handle, bounds: self.fault_bounds(handle), prior: None };
                std::iter::once(handle).chain(with).map(of).collect()
            }
            Term::Response(output) => (0..AFTER.len())
                .map(|point| Unknown::Output(output, Fault::Response(point)))
                // A ridge, as a table has one.
                .map(|handle| FreeParameter {
                    handle,
                    bounds: self.fault_bounds(handle),
                    prior: Some(Prior::Value { mean: 0.0, deviation: UNKNOWN }),
                })
                .collect(),
        }
    }

    /// A term's coordinates that are thresholds.
    pub fn thresholds(&self, term: Term) -> Vec<FreeParameter> {
        let Term::Effect(effect) = term else { return Vec::new() };
        let parts = effect.parts.iter().filter(|it| it.beyond.is_some());
        let indices = parts.filter_map(|it| self.rig.plant.parameter(it.parameter));
        let handles: Vec<Unknown> = indices.map(Unknown::Parameter).collect();
        let mut own = self.own_coordinates(term);
        own.retain(|it| handles.contains(&it.handle));
        own
    }

    /// Largest magnitude of a measured input on the estimation data.
    pub fn largest(&self, input: usize) -> f64 {
        let values = self.train.iter().filter_map(|record| match &record.inputs[input] {
            Source::Measured(values) => Some(values),
            Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => None,
        });
        values.flatten().filter(|it| it.is_finite()).fold(0.0, |most, it| it.abs().max(most))
    }

    /// Period in seconds of a measured input: half of its power on the estimation data is slower.
    fn period(&self, input: usize) -> Option<f64> {
        let parts = self.train.iter().flat_map(|record| {
            let values = match &record.inputs[input] {
                Source::Measured(values) => &values[..],
                Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => &[],
            };
            let sections = if values.is_empty() { Vec::new() } else { record.joined().sections };
            sections.into_iter().map(|section| (record.step, values[section].to_vec()))
        });
        below(&parts.collect::<Vec<_>>(), 0.5).filter(|it| *it > 0.0).map(f64::recip)
    }

    pub(crate) fn fault_bounds(&self, handle: Unknown) -> (f64, f64) {
        let Some(fault) = handle.fault() else { return (f64::NEG_INFINITY, f64::INFINITY) };
        match (catalogue::distortion(fault).bounds, handle) {
            (Bounds::Between(low, high), _) => (low, high),
            (Bounds::OfLargest(low, high), Unknown::Input(input, _)) => {
                let largest = self.largest(input);
                (low * largest, high * largest)
            }
            (Bounds::OfLargest(..), _) => (0.0, f64::INFINITY),
            (Bounds::QuarterOfPeriod(least), Unknown::Input(input, _)) => {
                let most = self.period(input).map_or(least, |period| least.max(QUARTER * period));
                (-most, most)
            }
            (Bounds::QuarterOfPeriod(least), _) => (-least, least),
            (Bounds::Free, _) => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }
}
