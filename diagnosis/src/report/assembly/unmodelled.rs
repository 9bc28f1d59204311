//! What the report says of what is in no catalogue.

use crate::catalogue::{Element, ElementKind, Scale, Table, Unnamed};
use crate::diagnosis::Diagnosis;
use crate::estimation::coordinates::POINTS;
use crate::estimation::hypothesis::{Fitted, Term};
use crate::estimation::intervals::Interval;
use crate::estimation::unknowns::Unknown;
use crate::explain::describe as described;
use crate::explain::signal::MissingSignal;
use crate::report::findings::{Curve, Missing, PlaceLikelihood, Unmodelled};
use crate::screening::rms;
use crate::signal::distortion::{AFTER, Fault, UNKNOWN};

/// The missing signal for the report.
pub(super) fn missing(signal: &MissingSignal) -> Missing {
    let places = signal
        .ranked
        .iter()
        .map(|(place, gain)| PlaceLikelihood { place: place.clone(), log_likelihood: *gain });
    Missing {
        place: signal.place.clone(),
        unit: signal.unit.into(),
        equivalent_places: signal.ties.clone(),
        places: places.collect(),
        time: signal.time.clone(),
        value: signal.value.clone(),
        deviation: signal.deviation.clone(),
        deflection: signal.deflection.clone(),
        velocity: signal.velocity.clone(),
    }
}

impl Diagnosis<'_> {
    /// All that is missing and has no name.
    pub(super) fn unmodelled(&self) -> Vec<Unmodelled> {
        let of = |it: &described::Unmodelled| {
            let curve = match it.curve {
                Some(Term::Table(table)) => Some(self.curve(table)),
                Some(Term::Response(output)) => Some(self.response(output)),
                _ => None,
            };
            Unmodelled {
                place: it.place.clone(),
                unit: it.unit.into(),
                depends_on: it.depends_on.clone(),
                share: it.share,
                validation_share: it.validated,
                improvement: it.improvement,
                frequency: it.frequency,
                band: it.band,
                description: it.description(),
                curve,
            }
        };
        self.found.unmodelled.iter().map(of).collect()
    }

    /// An element's velocity or deflection, by the FMU's name where the FMU has it, with its unit; or what goes into it.
    fn variable(&self, element: Element, scale: Scale) -> (String, &'static str) {
        let signals = self.baseline.rig.kind.elements.iter().find(|it| it.element == element);
        let (signal, otherwise, unit) = match scale {
            Scale::FORCE => (signals.and_then(|it| it.force.signal()), "force", "N"),
            Scale::VELOCITY => (signals.and_then(|it| it.velocity.as_deref()), "velocity", "m/s"),
            _ => (signals.map(|it| it.deflection.as_str()), "deflection", "m"),
        };
        let plant = &self.baseline.rig.plant;
        let name = signal.unwrap_or(otherwise);
        let mut declared = plant.inputs.iter().chain(&plant.outputs);
        (name.to_owned(), declared.find(|it| it.name == name).map_or(unit, |it| it.unit.symbol))
    }

    fn curve(&self, table: &'static Table) -> Curve {
        let plant = &self.baseline.rig.plant;
        let fitted: &Fitted = &self.found.extended;
        let range = plant.parameter(table.range).map_or(0.0, |index| fitted.point.parameters[index]);
        let (variable, variable_unit) = self.variable(table.element, table.scale);
        let Unnamed { quantity, point, .. } = table.law;
        let mut curve = Curve {
            location: table.element.name().into(),
            quantity: (*quantity).into(),
            variable,
            variable_unit: variable_unit.into(),
            unit: table.unit(plant).into(),
            ..Curve::default()
        };
        for number in 1..=POINTS {
            let index = plant.parameter(&format!("{}[{number}]", table.points));
            let found = self.intervals.iter().find(|it| index.map(Unknown::Parameter) == Some(it.handle));
            let Some(Interval { value, half, .. }) = found else { continue };
            // A point that is not determined is not covered by the data.
            if *half < point.of(&self.baseline.typical(table.element)) {
                curve.x.push(range * (2.0 * (number - 1) as f64 / (POINTS - 1) as f64 - 1.0));
                curve.y.push(*value);
                curve.low.push(value - half);
                curve.high.push(value + half);
            }
        }
        if table.element.kind() == ElementKind::Tire {
            // The plant's table is over the compression, the FMU's output counts the other way.
            curve.x.iter_mut().for_each(|x| *x = -*x);
            for list in [&mut curve.x, &mut curve.y, &mut curve.low, &mut curve.high] {
                list.reverse();
            }
        }
        curve
    }

    /// The step response of an output's sensor.
    fn response(&self, output: usize) -> Curve {
        let mut curve = Curve {
            location: self.baseline.rig.plant.outputs[output].name.clone(),
            quantity: Curve::RESPONSE.into(),
            variable: "time".into(),
            variable_unit: "s".into(),
            unit: "1".into(),
            ..Curve::default()
        };
        for (point, after) in AFTER.into_iter().enumerate() {
            let handle = Unknown::Output(output, Fault::Response(point));
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

/// The remaining error of a signal on validation data: mean squares without noise in the inputs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left {
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
        let squares = |fitted: &Fitted| self.baseline.errors(&fitted.test).mean_squares();
        let whole = |row: usize| {
            let values = self.baseline.test.iter().flat_map(|it| it.measured[row].values.iter().copied());
            rms(&values.collect::<Vec<_>>()).powi(2)
        };
        let rows = squares(&self.found.extended).into_iter().enumerate();
        rows.map(|(row, after)| Left { after, whole: whole(row) }).collect()
    }
}
