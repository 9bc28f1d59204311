//! The unknowns of a fit: parameters and distortions of signals, their priors, and an estimate of all.

use crate::plant::Plant;
use crate::signal::distortion::{Correction, Fault};

/// An unknown of a model: a parameter, or a distortion of an input or output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unknown {
    /// A parameter of the plant, by its index.
    Parameter(usize),
    /// A correction of an input's signal, by the input's index.
    Input(usize, Fault),
    /// A correction of an output's signal, by the output's index.
    Output(usize, Fault),
}

impl Unknown {
    /// The distortion of a signal that it is; none of a parameter.
    pub fn fault(self) -> Option<Fault> {
        match self {
            Self::Parameter(_) => None,
            Self::Input(_, fault) | Self::Output(_, fault) => Some(fault),
        }
    }

    /// Whether it is a distortion of an input's signal.
    pub fn is_of_input(self) -> bool {
        matches!(self, Self::Input(..))
    }

    /// Another distortion of the same signal; a parameter stays what it is.
    #[must_use]
    pub fn with_fault(self, fault: Fault) -> Self {
        match self {
            Self::Parameter(_) => self,
            Self::Input(input, _) => Self::Input(input, fault),
            Self::Output(output, _) => Self::Output(output, fault),
        }
    }
}

/// An unknown that a fit changes, within bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeParameter {
    /// What.
    pub handle: Unknown,
    /// Smallest and largest value.
    pub bounds: (f64, f64),
    /// Its prior, if it has one.
    pub prior: Option<Prior>,
}

/// The prior of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prior {
    /// Its value, with a standard deviation.
    Value {
        /// The value.
        mean: f64,
        /// Standard deviation.
        deviation: f64,
    },
    /// A value that is right within a factor: its logarithm has a standard deviation. Half of it is as far off as its double, so
    /// that data which tell only the ratios of several parameters leave their common scale where it was.
    Factor {
        /// The value, positive.
        mean: f64,
        /// Standard deviation of the logarithm.
        deviation: f64,
    },
    /// A positive value that nobody vouches for: it keeps an unknown that the data leave open in its place, without a tolerance.
    Guess {
        /// The value.
        mean: f64,
    },
}

/// Factor that is one standard deviation of a guess: a joint's inertia is a millionth of a carriage's mass.
const GUESSED: f64 = 10.0;

/// Smallest share of a value of which a logarithm is taken: a positive parameter may be next to nothing.
const NEXT_TO_NOTHING: f64 = 1e-3;

impl Prior {
    /// Distance of a value in standard deviations, and its derivative.
    pub fn distance(self, value: f64) -> (f64, f64) {
        let factor = |mean: f64, deviation: f64| {
            let share = value / mean;
            let slope = if share > NEXT_TO_NOTHING { (value * deviation).recip() } else { 0.0 };
            (share.max(NEXT_TO_NOTHING).ln() / deviation, slope)
        };
        match self {
            Self::Value { mean, deviation } => ((value - mean) / deviation, deviation.recip()),
            Self::Factor { mean, deviation } => factor(mean, deviation),
            Self::Guess { mean } => factor(mean, GUESSED.ln()),
        }
    }

    /// Whether somebody vouches for it.
    pub fn is_vouched_for(self) -> bool {
        !matches!(self, Self::Guess { .. })
    }
}

impl FreeParameter {
    /// Distance of its value from what was known before, in standard deviations, and its derivative; none if nothing was known.
    pub fn distance(&self, at: &Estimate) -> Option<(f64, f64)> {
        Some(self.prior?.distance(at.get(self.handle)))
    }
}

/// An estimate of all unknowns: parameters, distortions, and the states at the start of every segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The plant's parameters.
    pub parameters: Vec<f64>,
    /// Of each input.
    pub inputs: Vec<Correction>,
    /// Of each output.
    pub outputs: Vec<Correction>,
    /// States at the start of each section, record after record.
    pub starts: Vec<Vec<f64>>,
}

impl Estimate {
    /// Parameters of a plant with undistorted signals, and no starts yet.
    pub fn undistorted(plant: &Plant, parameters: &[f64]) -> Self {
        Self {
            parameters: parameters.to_vec(),
            inputs: vec![Correction::default(); plant.inputs.len()],
            outputs: vec![Correction::default(); plant.outputs.len()],
            starts: Vec::new(),
        }
    }

    /// The value of what can be changed.
    pub fn get(&self, handle: Unknown) -> f64 {
        match handle {
            Unknown::Parameter(index) => self.parameters[index],
            Unknown::Input(index, fault) => self.inputs[index].get(fault),
            Unknown::Output(index, fault) => self.outputs[index].get(fault),
        }
    }

    /// Changes it.
    pub fn set(&mut self, handle: Unknown, value: f64) {
        match handle {
            Unknown::Parameter(index) => self.parameters[index] = value,
            Unknown::Input(index, fault) => self.inputs[index].set(fault, value),
            Unknown::Output(index, fault) => self.outputs[index].set(fault, value),
        }
    }
}

/// Half the squared distance of a point from the coordinates' priors, in their standard deviations.
pub fn strain(coordinates: &[FreeParameter], point: &Estimate) -> f64 {
    let each = coordinates.iter().filter_map(|coordinate| {
        let (distance, _) = coordinate.distance(point)?;
        Some(0.5 * distance.powi(2))
    });
    each.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn half_and_double_are_equally_far_and_nothing_is_not_infinitely_far() {
        let prior = Prior::Factor { mean: 350.0, deviation: 0.3 };
        let [half, double] = [175.0, 700.0].map(|value| prior.distance(value).0);
        assert!((half + double).abs() < 1e-12 && (double - 2.0_f64.ln() / 0.3).abs() < 1e-12);
        assert!(prior.distance(0.0).0.is_finite() && prior.distance(-1.0).1 == 0.0);
        assert_eq!(Prior::Value { mean: 1.0, deviation: 0.5 }.distance(2.0), (2.0, 2.0));
        assert!(prior.is_vouched_for() && !Prior::Guess { mean: 1.0 }.is_vouched_for());
    }

    proptest! {
        #[test]
        fn the_slope_is_the_derivative(mean in 0.1_f64..1e3, share in 0.01_f64..20.0, deviation in 0.05_f64..3.0) {
            for prior in [Prior::Factor { mean, deviation }, Prior::Guess { mean }, Prior::Value { mean, deviation }] {
                let (at, by) = (share * mean, 1e-6 * share * mean);
                let [low, high] = [at - by, at + by].map(|value| prior.distance(value).0);
                let slope = prior.distance(at).1;
                prop_assert!(((high - low) / (2.0 * by) / slope - 1.0).abs() < 1e-4);
            }
        }
    }
}
