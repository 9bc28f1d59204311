//! What is told of a cause that has no name.

use crate::catalogue::naming::name;
use crate::catalogue::{Element, Scale, Table};
use crate::diagnosis::Diagnosis;
use crate::estimation::fit::Handle;
use crate::estimation::hypothesis::{Fitted, POINTS, Term};
use crate::estimation::intervals::Interval;
use crate::report::findings::Curve;
use crate::screening::rms;
use crate::signal::distortion::{AFTER, Fault, UNKNOWN};

/// Share of a signal's error power on held-out data that the causes have to explain of one signal, to be told by name …
const EXPLAINED: f64 = 0.6;
/// … unless so much of Φ is reached all the same, as a mean over the signals.
const ADEQUATE: f64 = 0.8;

impl Diagnosis<'_> {
    /// An element's velocity or deflection, by the FMU's name where the FMU has it, with its unit; or what goes into it.
    fn variable(&self, element: Element, scale: Scale) -> (String, &'static str) {
        let signals = self.world.rig.kind.elements.iter().find(|it| it.element == element);
        let (signal, otherwise, unit) = match scale {
            Scale::FORCE => (signals.and_then(|it| it.force.signal()), "force", "N"),
            Scale::VELOCITY => (signals.and_then(|it| it.velocity), "velocity", "m/s"),
            _ => (signals.map(|it| it.deflection), "deflection", "m"),
        };
        let plant = &self.world.rig.plant;
        let name = signal.unwrap_or(otherwise);
        let mut declared = plant.inputs.iter().chain(&plant.outputs);
        (name.to_owned(), declared.find(|it| it.name == name).map_or(unit, |it| it.unit.symbol))
    }

    /// Where something acts, and over what, if no more is known of it than a law that comes near.
    pub(super) fn place(&self, term: Term) -> Curve {
        let of_cause = |velocity: bool| if velocity { Scale::VELOCITY } else { Scale::DEFLECTION };
        let (location, over, (quantity, unit)) = match term {
            Term::Cause(cause) => (Some(cause.element), of_cause(cause.is_over_velocity()), ("force", "N")),
            Term::Table(table) => (Some(table.element), table.scale, table.quantity()),
            Term::Fault(_) | Term::Response(_) => (None, Scale::ONE, ("", "")),
        };
        let Some(element) = location else {
            let signal = name(term, &self.world.rig.plant).element;
            return Curve { location: signal.clone(), variable: signal, ..Curve::default() };
        };
        let (variable, variable_unit) = self.variable(element, over);
        Curve {
            location: element.name().into(),
            quantity: quantity.into(),
            variable,
            variable_unit: variable_unit.into(),
            unit: unit.into(),
            ..Curve::default()
        }
    }

    pub(super) fn curve(&self, table: &'static Table) -> Curve {
        let plant = &self.world.rig.plant;
        let fitted: &Fitted = &self.found.extended;
        let range = plant.parameter(table.range).map_or(0.0, |index| fitted.point.parameters[index]);
        let mut curve = self.place(Term::Table(table));
        for number in 1..=POINTS {
            let index = plant.parameter(&format!("{}[{number}]", table.points));
            let found = self.intervals.iter().find(|it| index.map(Handle::Parameter) == Some(it.handle));
            let Some(Interval { value, half, .. }) = found else { continue };
            // A point that is not determined is not covered by the data.
            if *half < table.point.of(&self.world.typical(table.element)) {
                curve.x.push(range * (2.0 * (number - 1) as f64 / (POINTS - 1) as f64 - 1.0));
                curve.y.push(*value);
                curve.low.push(value - half);
                curve.high.push(value + half);
            }
        }
        if table.element == Element::Tire {
            // The plant's table is over the compression, the FMU's output counts the other way.
            curve.x.iter_mut().for_each(|x| *x = -*x);
            for list in [&mut curve.x, &mut curve.y, &mut curve.low, &mut curve.high] {
                list.reverse();
            }
        }
        curve
    }

    /// The step response of an output's sensor.
    pub(super) fn response(&self, output: usize) -> Curve {
        let mut curve = Curve {
            location: self.world.rig.plant.outputs[output].name.clone(),
            quantity: Curve::RESPONSE.into(),
            variable: "time".into(),
            variable_unit: "s".into(),
            unit: "1".into(),
            ..Curve::default()
        };
        for (point, after) in AFTER.into_iter().enumerate() {
            let handle = Handle::Output(output, Fault::Response(point));
            let found = self.intervals.iter().find(|it| it.handle == handle);
            if let Some(Interval { value, half, .. }) = found
                && *half < UNKNOWN
            {
                curve.x.push(after);
                curve.y.push(1.0 + value);
                curve.low.push(1.0 + value - half);
                curve.high.push(1.0 + value + half);
            }
        }
        curve
    }
}

/// What is left of a signal on held-out data, mean squares without noise in the inputs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
    /// By the starting model with fitted parameters.
    before: f64,
    /// By the extended model.
    after: f64,
    /// Of the signal itself.
    whole: f64,
}

impl Left {
    /// Φ of the extended model.
    pub fn phi(&self) -> f64 {
        1.0 - (self.after / self.whole.max(f64::MIN_POSITIVE)).sqrt()
    }
}

impl Diagnosis<'_> {
    /// What is left of each signal.
    pub(super) fn left(&self) -> Vec<Left> {
        let squares = |fitted: &Fitted| self.world.errors(&fitted.test).mean_squares();
        let (before, after) = (squares(&self.found.base), squares(&self.found.extended));
        let whole = |row: usize| {
            let values = self.world.test.iter().flat_map(|it| it.measured[row].values.iter().copied());
            rms(&values.collect::<Vec<_>>()).powi(2)
        };
        let rows = before.into_iter().zip(after).enumerate();
        rows.map(|(row, (before, after))| Left { before, after, whole: whole(row) }).collect()
    }
}

/// Whether the causes leave much of every signal's error: then they only come near to what is there.
pub(super) fn explains_too_little(signals: &[Left]) -> bool {
    let least = signals.iter().map(|it| it.after / it.before).fold(f64::INFINITY, f64::min);
    least > 1.0 - EXPLAINED && misses_much(signals)
}

/// Whether the extended model, whatever it holds, is far from what was measured.
pub(super) fn misses_much(signals: &[Left]) -> bool {
    let mean = signals.iter().map(Left::phi).sum::<f64>() / signals.len().max(1) as f64;
    mean < ADEQUATE
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Root mean squares of what is left, of a signal of one.
    fn signal(before: f64, after: f64) -> Left {
        Left { before: before * before, after: after * after, whole: 1.0 }
    }

    #[test]
    fn a_law_that_leaves_half_of_a_large_error_only_comes_near() {
        assert!(explains_too_little(&[signal(0.5, 0.36), signal(0.4, 0.39)]));
        // Most of one signal's error, as of a sensor that was at fault.
        assert!(!explains_too_little(&[signal(0.5, 0.1), signal(0.4, 0.39)]));
        // Little is left beside what is measured.
        assert!(!explains_too_little(&[signal(0.2, 0.15), signal(0.15, 0.14)]));
        // A mean is what counts: one signal of two may be met badly.
        assert!(misses_much(&[signal(0.5, 0.5), signal(0.1, 0.1)]));
        assert!(!misses_much(&[signal(0.3, 0.3), signal(0.05, 0.05)]));
        assert!((signal(0.5, 0.2).phi() - 0.8).abs() < 1e-12);
    }
}
