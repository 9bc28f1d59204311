//! Within what an experiment has to stay: stroke, force, rate, frequencies and time.

use crate::dataset::recorded::Dataset;
use crate::diagnosis::simulated;
use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::rig::ForceOf;
use crate::signal::derivative;

/// Longest experiment in seconds where nobody asks for a longer one.
const LONGEST: f64 = 20.0;
/// Highest frequency as a share of the sampling rate.
const SAMPLED: f64 = 0.2;

/// Limits from the user; the others follow from the records.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Largest stroke in m, or rad of a pivot.
    pub stroke: Option<f64>,
    /// Largest force in N, or N.m of a torque.
    pub force: Option<f64>,
    /// Largest rate of a motion that drives the rig, in m/s.
    pub rate: Option<f64>,
    /// Longest duration in seconds.
    pub duration: Option<f64>,
    /// Highest frequency in Hz.
    pub bandwidth: Option<f64>,
}

/// What an input may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputBounds {
    /// Index of the input.
    pub input: usize,
    /// Largest distance from its rest, in its unit.
    pub amplitude: f64,
    /// Largest rate, in its unit per second.
    pub rate: f64,
    /// Lowest and highest frequency in Hz.
    pub band: (f64, f64),
}

/// What an experiment may do.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Of each input that can be driven.
    pub inputs: Vec<InputBounds>,
    /// Outputs, by index, and their largest magnitudes.
    pub outputs: Vec<(usize, f64)>,
    /// Duration in seconds.
    pub duration: f64,
}

impl Baseline<'_> {
    /// The bounds of an experiment: the user's limits, otherwise what the estimation records have reached. Of what they did
    /// not measure, the fitted model tells.
    pub fn bounds(&self, limits: Limits, fitted: &Fitted) -> Bounds {
        let plant = &self.rig.plant;
        let recorded = self.train.iter().map(|it| it.step * it.len() as f64).fold(0.0, f64::max);
        let duration = limits.duration.unwrap_or(recorded.min(LONGEST));
        let step = self.train.first().map_or(1.0, |it| it.step);
        let inputs = plant.inputs.iter().enumerate().filter_map(|(input, declared)| {
            let (_, band) = self.rig.excitation(declared)?;
            let [amplitude, rate] = self.reached(input, declared.start)?;
            let (amplitude, rate) = match declared.unit.symbol {
                "N" | "N.m" => (limits.force.unwrap_or(amplitude), rate),
                // A road may be as high as the stroke is long: the stroke itself is an output's bound.
                "m" => {
                    let amplitude = limits.stroke.map_or(amplitude, |stroke| stroke.max(amplitude));
                    (amplitude, limits.rate.unwrap_or(rate))
                }
                _ => (amplitude, rate),
            };
            let low = band.0.max(1.0 / duration);
            let high = limits.bandwidth.unwrap_or(band.1).min(SAMPLED / step).max(low);
            Some(InputBounds { input, amplitude, rate, band: (low, high) })
        });
        let inputs: Vec<InputBounds> = inputs.collect();
        let forced = inputs.iter().any(|it| matches!(plant.inputs[it.input].unit.symbol, "N" | "N.m"));
        let force = self.force().filter(|_| !forced).map(|output| (output, limits.force));
        let stroke = self.stroke().map(|output| (output, limits.stroke));
        let predicted = simulated(self, &fitted.terms, &fitted.point, self.train);
        let outputs = [stroke, force].into_iter().flatten().map(|(output, limit)| {
            (output, limit.unwrap_or_else(|| largest(output, self.train, &predicted)))
        });
        Bounds { outputs: outputs.collect(), inputs, duration }
    }

    /// Largest distance from rest and largest rate of a measured input; none if it rests.
    fn reached(&self, input: usize, rest: f64) -> Option<[f64; 2]> {
        let largest = |values: &[f64], about: f64| {
            values.iter().filter(|it| it.is_finite()).fold(0.0_f64, |most, it| most.max((it - about).abs()))
        };
        let measured =
            self.train.iter().filter_map(|record| Some((record.inputs[input].measured()?, record.step)));
        let each =
            measured.map(|(values, step)| [largest(values, rest), largest(&derivative(values, step), 0.0)]);
        let reached = each.reduce(|[a, b], [c, d]| [a.max(c), b.max(d)])?;
        (reached[0] > 0.0 && reached[1] > 0.0).then_some(reached)
    }

    /// The output that is the rig's stroke: the deflection of its first element that has one.
    fn stroke(&self) -> Option<usize> {
        let plant = &self.rig.plant;
        let deflections = self.rig.kind.elements.iter().filter_map(|it| plant.output(&it.deflection));
        deflections.into_iter().find(|output| matches!(plant.outputs[*output].unit.symbol, "m" | "rad"))
    }

    /// The measured output that is the rig's force.
    fn force(&self) -> Option<usize> {
        let outputs = self.rig.kind.elements.iter().filter_map(|it| match &it.force {
            ForceOf::Output { output: name } => self.rig.plant.output(name),
            _ => None,
        });
        let measured = &self.train.first()?.measured;
        outputs.into_iter().find(|output| measured.iter().any(|it| it.output == *output))
    }
}

/// Largest magnitude of an output, as measured, or as predicted where it is not.
fn largest(output: usize, records: &[Dataset], predicted: &[Vec<Vec<f64>>]) -> f64 {
    let each = records.iter().zip(predicted).flat_map(|(record, predicted)| {
        let measured = record.measured.iter().find(|it| it.output == output);
        measured.map_or(&predicted[output], |it| &it.values)
    });
    each.filter(|it| it.is_finite()).fold(0.0, |most, it| most.max(it.abs()))
}
