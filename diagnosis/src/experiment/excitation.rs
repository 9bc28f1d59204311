//! The excitations that are compared: for each input that can be driven, shapes and sizes.

use crate::dataset::recorded::{Dataset, Measured, Source};
use crate::rig::Rig;

use super::bounds::{Bounds, InputBounds};
use super::shape::Shape;

/// Sizes, as shares of the largest signal within the bounds.
const SIZES: [f64; 3] = [1.0, 0.3, 0.1];
/// Sines between the lowest and the highest frequency.
const SINES: i32 = 5;
/// Periods of a slow wave in an experiment.
const SLOWLY: f64 = 4.0;
/// By how much the frequencies of a multisine differ from those of the one on the input before.
const APART: f64 = 1.08;

/// What drives an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Index of the input.
    pub input: usize,
    /// Its shape.
    pub shape: Shape,
    /// Its amplitude in the input's unit.
    pub amplitude: f64,
}

/// What drives a rig; inputs without a wave rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// The waves, one for each input that is driven.
    pub waves: Vec<Wave>,
}

impl Excitation {
    /// The same, so many times as large.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |wave: &Wave| Wave { amplitude: factor * wave.amplitude, ..*wave };
        Self { waves: self.waves.iter().map(scaled).collect() }
    }

    /// Signal of an input at so many samples.
    pub fn signal(&self, rig: &Rig, input: usize, step: f64, count: usize) -> Vec<f64> {
        let rest = rig.plant.inputs[input].start;
        let Some(wave) = self.waves.iter().find(|it| it.input == input) else { return vec![rest; count] };
        let signal = wave.shape.signal(wave.amplitude, step, count);
        signal.into_iter().map(|value| rest + value).collect()
    }

    /// The record of an experiment without any measurement, with the signals and sections that another one has.
    pub fn record(&self, rig: &Rig, like: &Dataset, duration: f64) -> Dataset {
        let count = (duration / like.step) as usize;
        let inputs = like.inputs.iter().enumerate().map(|(input, source)| {
            let driven = self.waves.iter().any(|it| it.input == input);
            match (source, rig.rate_of(&rig.plant.inputs[input].name)) {
                (_, Some(position)) => Source::DerivativeOf(position),
                (Source::Measured(_), None) if driven => {
                    Source::Measured(self.signal(rig, input, like.step, count))
                }
                (Source::Measured(_), None) => Source::Constant(rig.plant.inputs[input].start),
                (other, None) => other.clone(),
            }
        });
        let unknown = |it: &Measured| Measured { values: vec![f64::NAN; count], ..it.clone() };
        let longest = like.sections.iter().map(ExactSizeIterator::len).max().unwrap_or(count).max(1);
        let parts = count.div_ceil(longest).max(1);
        Dataset {
            name: "experiment".into(),
            step: like.step,
            inputs: inputs.collect(),
            measured: like.measured.iter().map(unknown).collect(),
            sections: (0..parts).map(|part| count * part / parts..count * (part + 1) / parts).collect(),
            ..Dataset::default()
        }
    }
}

/// Every excitation that is compared, as large as inputs may be: each input alone, the others at rest, and all together.
pub fn excitations(bounds: &Bounds) -> Vec<Excitation> {
    let duration = bounds.duration;
    let alone = bounds.inputs.iter().flat_map(|input| {
        shapes(input, duration)
            .into_iter()
            .map(|shape| Excitation { waves: vec![wave(input, shape, duration)] })
    });
    let together = (bounds.inputs.len() > 1).then(|| {
        let own = |(index, input): (i32, &InputBounds)| {
            let (from, to) = input.band;
            wave(input, Shape::Multisine { from: from * APART.powi(index), to }, duration)
        };
        Excitation { waves: (0..).zip(&bounds.inputs).map(own).collect() }
    });
    let largest: Vec<Excitation> = alone.chain(together).collect();
    SIZES.iter().flat_map(|size| largest.iter().map(move |it| it.scaled(*size))).collect()
}

fn wave(input: &InputBounds, shape: Shape, duration: f64) -> Wave {
    let (shape, amplitude) = shape.within_rate(input.amplitude, input.rate, duration);
    Wave { input: input.input, shape, amplitude }
}

/// The shapes for an input: fast and slow.
fn shapes(input: &InputBounds, duration: f64) -> Vec<Shape> {
    let (low, high) = input.band;
    let (middle, slow) = ((low * high).sqrt(), SLOWLY / duration);
    let sine =
        |k: i32| Shape::Sine { frequency: low * (high / low).powf(f64::from(k) / f64::from(SINES - 1)) };
    let others = [
        Shape::Chirp { from: low, to: high },
        Shape::Chirp { from: low, to: middle },
        Shape::Square { frequency: slow, edge: 0.0 },
        Shape::Square { frequency: middle, edge: 0.0 },
        Shape::Triangle { frequency: slow },
        Shape::Multisine { from: low, to: high },
    ];
    (0..SINES).map(sine).chain(others).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::Between;

    fn bounds() -> Bounds {
        let of = |input, amplitude, rate| InputBounds { input, amplitude, rate, band: (0.5, 15.0) };
        Bounds { inputs: vec![of(0, 0.01, 0.2), of(2, 100.0, 5000.0)], outputs: vec![], duration: 10.0 }
    }

    #[test]
    fn every_excitation_keeps_amplitude_and_rate() {
        let bounds = bounds();
        let all = excitations(&bounds);
        assert!(all.len() > 60 && all.iter().any(|it| it.waves.len() == 2));
        for wave in all.iter().flat_map(|it| &it.waves) {
            let bound = bounds.inputs.iter().find(|it| it.input == wave.input).unwrap();
            let signal = wave.shape.signal(wave.amplitude, 1e-3, 10_000);
            let fastest = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 1e-3).fold(0.0, f64::max);
            assert!(wave.amplitude <= bound.amplitude && fastest < 1.02 * bound.rate, "{wave:?}: {fastest}");
        }
    }

    #[test]
    fn a_record_has_a_rate_that_follows_and_inputs_that_rest() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let [road, velocity, force] =
            ["road.position", "road.velocity", "actuator.force"].map(|it| rig.plant.input(it).unwrap());
        let measured = vec![Measured { output: 0, values: vec![0.0; 1000], noise_floor: 0.1 }];
        let inputs = rig.plant.inputs.iter().map(|_| Source::Measured(vec![1.0; 1000])).collect();
        let sections = vec![0..400, 400..1000];
        let like = Dataset {
            step: 2e-3,
            inputs,
            between: Between::Curves,
            measured,
            sections,
            ..Dataset::default()
        };
        let waves = vec![Wave { input: road, shape: Shape::Sine { frequency: 1.0 }, amplitude: 0.01 }];
        let record = Excitation { waves }.record(&rig, &like, 4.0);
        assert_eq!(record.sections, [0..500, 500..1000, 1000..1500, 1500..2000]);
        assert_eq!(record.inputs[velocity], Source::DerivativeOf(road));
        assert_eq!(record.inputs[force], Source::Constant(0.0));
        assert!(matches!(&record.inputs[road], Source::Measured(values) if values.len() == 2000));
    }
}
