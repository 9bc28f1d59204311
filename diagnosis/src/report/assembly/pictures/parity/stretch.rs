//! What the sensors say over a stretch of time.

use std::ops::Range;

use crate::data::check::noise_floor;
use crate::dataset::recorded::{Dataset, Source};
use crate::estimation::unknowns::Estimate;
use crate::plant::{Between, Drive, Plant};
use crate::signal::random::with_noise;
use crate::signal::spectral::{filled, in_band, power_spectrum};

/// How far a signal's power stands above its noise's where it still counts.
const CLEAR: f64 = 4.0;
/// The band's highest frequency over the sampling rate: the filter ends a fifth above.
const HIGHEST: f64 = 0.4;

/// Something that is measured, or follows from what is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sensor {
    BodyAcceleration,
    WheelAcceleration,
    /// Body above wheel.
    Deflection,
    /// Road above wheel.
    Compression,
    TireForce,
    ActuatorForce,
    Pressure,
}

impl Sensor {
    const ALL: [Self; 7] = [
        Self::BodyAcceleration,
        Self::WheelAcceleration,
        Self::Deflection,
        Self::Compression,
        Self::TireForce,
        Self::ActuatorForce,
        Self::Pressure,
    ];

    /// What has to be measured.
    pub fn words(self) -> &'static str {
        match self {
            Self::BodyAcceleration => "the body’s acceleration",
            Self::WheelAcceleration => "the wheel’s acceleration",
            Self::Deflection => "the strut’s deflection",
            Self::Compression => "the tyre’s deflection, or the positions of road and wheel",
            Self::TireForce => "the tyre’s force",
            Self::ActuatorForce => "the actuator’s force",
            Self::Pressure => "the actuator’s pressure",
        }
    }

    /// Sums of signals that it is, the best one first.
    fn ways(self) -> &'static [&'static [(&'static str, f64)]] {
        match self {
            Self::BodyAcceleration => &[&[("body.acceleration", 1.0)]],
            Self::WheelAcceleration => &[&[("wheel.acceleration", 1.0)]],
            Self::Deflection => {
                &[&[("suspension.deflection", 1.0)], &[("body.position", 1.0), ("wheel.position", -1.0)]]
            }
            Self::Compression => {
                &[&[("tire.deflection", -1.0)], &[("road.position", 1.0), ("wheel.position", -1.0)]]
            }
            Self::TireForce => &[&[("wheel.force", 1.0)]],
            Self::ActuatorForce => &[&[("actuator.force", 1.0)]],
            Self::Pressure => &[&[("pressure", 1.0)]],
        }
    }

    /// Whether a plant knows of it.
    pub fn is_of(self, plant: &Plant) -> bool {
        let known = |name: &str| plant.output(name).or_else(|| plant.input(name)).is_some();
        self.ways().iter().any(|way| way.iter().all(|(name, _)| known(name)))
    }
}

/// A record with what a model says of its sensors.
#[derive(Clone, Copy)]
pub(super) struct Rigged<'a> {
    pub plant: &'a Plant,
    pub record: &'a Dataset,
    pub point: &'a Estimate,
    /// Whether the sensors' noise is there a second time.
    pub noisy: bool,
}

impl Rigged<'_> {
    /// Whether the record has what is needed for it.
    pub fn has(&self, sensor: Sensor) -> bool {
        self.record.sections.first().is_some_and(|section| self.read(sensor, section).is_some())
    }

    /// The highest frequency at which the deflection's, or what comes nearest to it, stands out from its noise.
    pub fn band(&self) -> f64 {
        let highest = HIGHEST / self.record.step;
        let longest = self.record.sections.iter().max_by_key(|section| section.len());
        let read = |sensor: Sensor| self.read(sensor, longest?);
        let positions = [Sensor::Deflection, Sensor::Compression, Sensor::BodyAcceleration];
        let Some((values, variance)) = positions.into_iter().find_map(read) else { return highest };
        let Some(values) = filled(&values) else { return highest };
        let (frequency, density) = power_spectrum(&values, self.record.step);
        let noise = 2.0 * self.record.step * variance;
        let last = density.iter().rposition(|density| *density > CLEAR * noise);
        last.map_or(highest, |last| frequency[last].min(highest))
    }

    /// All that the sensors say in a section; `simulated` has the velocities that nothing measures.
    pub fn stretch(&self, section: &Range<usize>, band: f64, simulated: &[Vec<f64>]) -> Stretch {
        let mut known = vec![true; section.len()];
        let mut signals = Vec::new();
        for sensor in Sensor::ALL {
            let Some((values, _)) = self.read(sensor, section) else { continue };
            let Some(whole) = filled(&values) else { continue };
            known.iter_mut().zip(&values).for_each(|(known, value)| *known &= value.is_finite());
            signals.push((sensor, whole));
        }
        let velocity = |name: &str| match self.plant.output(name) {
            Some(index) => simulated[index][section.clone()].to_vec(),
            None => vec![0.0; section.len()],
        };
        Stretch {
            step: self.record.step,
            band,
            known,
            signals,
            body_velocity: velocity("body.velocity"),
            wheel_velocity: velocity("wheel.velocity"),
        }
    }

    /// What a sensor says, with the variance of its noise.
    fn read(&self, sensor: Sensor, section: &Range<usize>) -> Option<(Vec<f64>, f64)> {
        sensor.ways().iter().find_map(|way| {
            let mut sum = vec![0.0; section.len()];
            let mut variance = 0.0;
            for (name, sign) in *way {
                let (values, noise) = self.channel(name, section)?;
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += sign * value);
                variance += noise * noise;
            }
            Some((sum, variance))
        })
    }

    /// What a channel's signal really was, by the model's corrections, and its noise.
    fn channel(&self, name: &str, section: &Range<usize>) -> Option<(Vec<f64>, f64)> {
        let (samples, plant) = (self.record.samples(section), self.plant);
        let output = plant.output(name);
        if let Some(it) = self.record.measured.iter().find(|it| Some(it.output) == output) {
            let values = self.with_noise(&it.values[section.clone()], it.noise_floor, it.output as u64);
            return Some((self.point.outputs[it.output].removed(&values, samples), it.noise_floor));
        }
        let input = plant.input(name)?;
        match &self.record.inputs[input] {
            Source::Measured(values) => {
                let noise = noise_floor(values);
                // Channels of inputs are numbered behind those of outputs.
                let number = (plant.outputs.len() + input) as u64;
                let values = self.with_noise(&values[section.clone()], noise, number);
                Some((self.point.inputs[input].applied(&values, samples), noise))
            }
            Source::Constant(value) => Some((vec![*value; section.len()], 0.0)),
            Source::DerivativeOf(_) | Source::RateOf(_) => None,
        }
    }

    fn with_noise(&self, values: &[f64], deviation: f64, channel: u64) -> Vec<f64> {
        if !self.noisy {
            return values.to_vec();
        }
        with_noise(values, deviation, channel + 1)
    }
}

/// What was measured over a stretch of time, as a model's corrections of the sensors say that it was.
pub(super) struct Stretch {
    pub step: f64,
    /// Highest frequency in hertz.
    pub band: f64,
    /// Whether all sensors have a sample.
    pub known: Vec<bool>,
    signals: Vec<(Sensor, Vec<f64>)>,
    pub body_velocity: Vec<f64>,
    pub wheel_velocity: Vec<f64>,
}

impl Stretch {
    /// What a sensor says.
    pub fn signal(&self, sensor: Sensor) -> Option<&[f64]> {
        self.signals.iter().find(|(of, _)| *of == sensor).map(|(_, values)| &values[..])
    }

    /// The second derivative of what a sensor says, to be filtered yet.
    pub fn bend(&self, sensor: Sensor) -> Option<Vec<f64>> {
        Some(in_band(self.signal(sensor)?, self.step, f64::INFINITY, 2))
    }

    /// An element moved by what a sensor says, times a sign, within the band: noise would shake it with its rate.
    pub fn moved(&self, sensor: Sensor, sign: f64) -> Option<Drive> {
        let values = self.signal(sensor)?;
        let motion = |order| -> Vec<f64> {
            in_band(values, self.step, self.band, order).into_iter().map(|it| sign * it).collect()
        };
        Some(Drive {
            start: 0.0,
            step: self.step,
            inputs: vec![motion(0), motion(1)],
            finer: 1,
            between: Between::Curves,
            filtered: false,
        })
    }

    /// A weighted sum of signals.
    pub fn sum(&self, terms: &[(f64, &[f64])]) -> Vec<f64> {
        let at = |k: usize| terms.iter().map(|(factor, values)| factor * values[k]).sum();
        (0..self.known.len()).map(at).collect()
    }
}
