//! Where a stretch of a record starts.

use std::ops::Range;

use crate::dataset::recorded::Dataset;
use crate::plant::{Follower, Seen};

use super::trajectory::Setting;

/// Samples by which two starts of a stretch are compared.
const FIRST: usize = 100;
/// Time in which a rig comes to rest where its inputs do, in seconds: two periods of a body on its springs.
const SETTLING: f64 = 2.0;

impl Setting<'_> {
    /// Where a stretch starts: at a given start, or where the model comes to rest under the inputs that it begins with. A wheel
    /// that starts far above its road has left it, and no sensor shows where it is: of the two, the one from which the sensors
    /// are predicted better.
    pub(super) fn start(&self, own: &Dataset, samples: &Range<usize>, given: &[f64]) -> Vec<f64> {
        let first = samples.start..samples.end.min(samples.start + FIRST);
        let surprise = |start: &[f64]| -> f64 {
            let (passed, _) = self.passed(own, &first, start);
            let each = passed.iter().flat_map(|it| &it.measured);
            each.map(|(_, _, innovation, variance)| innovation * innovation / variance + variance.ln()).sum()
        };
        match self.at_rest(own, samples, given) {
            Some(rest) if surprise(&rest) < surprise(given) => rest,
            _ => given.to_vec(),
        }
    }

    /// Where the model comes to rest under the inputs at the start of some samples; none if it does not, or is there already.
    fn at_rest(&self, own: &Dataset, samples: &Range<usize>, start: &[f64]) -> Option<Vec<f64>> {
        let mut drive = own.drive(&(samples.start..samples.end.min(samples.start + 2)), &self.point.inputs);
        let steps = (SETTLING / own.step) as usize;
        for (values, source) in drive.inputs.iter_mut().zip(&own.inputs) {
            let value = if source.motion().is_some() { 0.0 } else { values[0] };
            *values = vec![value; drive.finer * steps + 1];
        }
        let mut last = Last { halfway: steps / 2, ..Last::default() };
        self.dynamics.followed(&self.point.parameters, start, &drive, (&[], &[]), &mut last);
        let scale = |state: usize| self.state_sizes[state].abs().max(f64::MIN_POSITIVE);
        let apart = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).enumerate().map(|(it, (a, b))| (a - b).abs() / scale(it)).fold(0.0, f64::max)
        };
        let moved = apart(&last.end, start);
        (moved.is_finite() && moved > 0.0 && apart(&last.end, &last.middle) < 0.5 * moved).then_some(last.end)
    }
}

/// The states halfway and at the end of a simulation.
#[derive(Default)]
struct Last {
    halfway: usize,
    middle: Vec<f64>,
    end: Vec<f64>,
}

impl Follower for Last {
    fn state(&mut self, _: usize, _: &mut [f64]) {}

    fn seen(&mut self, sample: usize, _: Seen<'_>, state: &mut [f64]) {
        if sample == self.halfway {
            self.middle = state.to_vec();
        }
        self.end = state.to_vec();
    }

    fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::{Measured, Source};
    use crate::estimation::unknowns::Estimate;
    use crate::plant::Drive;
    use crate::rig::Rig;
    use crate::signal::distortion::Correction;

    /// A car that stands on a road of 40 mm, and swings a little: from zero its tyre would hang in the air.
    #[test]
    fn a_stretch_starts_on_its_road() {
        let rig = Rig::published("quarter-car").unwrap();
        let plant = &rig.plant;
        let dynamics = plant.prepare(&rig.choices).unwrap();
        let [road, rate] = ["road.position", "road.velocity"].map(|name| plant.input(name).unwrap());
        let step = 2.5e-3;
        let height: Vec<f64> = (0..400).map(|k| 0.04 + 1e-3 * (0.05 * f64::from(k)).sin()).collect();
        let inputs: Vec<Source> = (0..plant.inputs.len())
            .map(|input| match input {
                it if it == road => Source::Measured(height.clone()),
                it if it == rate => Source::DerivativeOf(road),
                _ => Source::Constant(0.0),
            })
            .collect();
        let place = |name: &str| plant.states.iter().position(|it| it.name == name).unwrap();
        let [body, wheel] = [place("body.position"), place("wheel.position")];
        let mut there = rig.start.clone();
        (there[body], there[wheel]) = (0.04, 0.04);
        let mut record =
            Dataset { step, inputs, sections: std::iter::once(0..400).collect(), ..Dataset::default() };
        let drive: Drive = record.drive(&(0..400), &vec![Correction::default(); plant.inputs.len()]);
        let seen = dynamics.outputs(&rig.parameters, &there, &drive);
        record.measured = ["body.acceleration", "wheel.acceleration"]
            .map(|name| plant.outputs.iter().position(|it| it.name == name).unwrap())
            .map(|output| Measured { output, values: seen[output].clone(), noise_floor: 1e-3 })
            .to_vec();
        let point = Estimate::undistorted(plant, &rig.parameters);
        let nominal: Vec<f64> = plant.states.iter().map(|it| it.nominal.unwrap_or(1.0)).collect();
        let records = [record];
        let setting = Setting::new(&*dynamics, (&point, &rig.start), &[], &[], &nominal, &records);
        let start = setting.start(&records[0], &(0..400), &rig.start);
        assert!((start[body] - 0.04).abs() < 2e-3 && (start[wheel] - 0.04).abs() < 1e-3, "{start:?}");
        // A start that predicts the sensors better is kept.
        assert_eq!(setting.start(&records[0], &(0..400), &there), there);
    }
}
