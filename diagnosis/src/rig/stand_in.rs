//! Whether a strut of the library does what it replaces in a model of another maker.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::Declaration;

use crate::plant::{Drive, Foreign, Plant};

use super::Rig;
use super::own::fmu_of;

/// Time between two samples in seconds.
const STEP: f64 = 1e-3;
/// Samples that are compared.
const SAMPLES: usize = 501;
/// Frequency of the first input in Hz; each further one has a higher one, so that none hides another.
const FREQUENCY: f64 = 3.0;
/// Difference of an output, in its unit, that is no more than rounding.
const ROUNDING: f64 = 1e-9;

/// Difference of outputs that is no more than that of two ways to compute the same.
pub const UNSEEN: f64 = 5e-4;

/// Largest difference of an output between the model on its own and with a strut of the library in the place of its spring
/// and damper, relative to how far the output moves; none if no strut replaces anything. Not a number where one of the
/// two cannot be run.
///
/// # Errors
/// If the model on its own cannot be read or prepared.
pub fn difference(rig: &Rig) -> Result<Option<f64>, String> {
    let Some(replaced) = rig.kind.elements.iter().find_map(|it| it.replaces.as_ref()) else {
        return Ok(None);
    };
    if !rig.kind.is_foreign() {
        return Ok(None);
    }
    let mut parameters: Vec<String> = vec![replaced.stiffness.clone(), replaced.damping.clone()];
    let own = rig.plant.parameters.iter().map(|it| &it.name).filter(|it| !rig.kind.is_beside(it));
    parameters.extend(own.cloned());
    let fmu = fmu_of(Path::new(&rig.kind.model))?;
    let alone = Foreign { fmu, parameters, locals: Vec::new(), beside: Vec::new() }.plant()?;
    // Both have the values of the rig.
    let values: Vec<f64> = alone
        .parameters
        .iter()
        .map(|it| {
            let name = match &it.name {
                name if *name == replaced.stiffness => "strut.stiffness",
                name if *name == replaced.damping => "strut.damping",
                name => name,
            };
            rig.plant.parameter(name).map_or(it.start, |index| rig.parameters[index])
        })
        .collect();
    let drive = rig.trial();
    let run = |plant: &Plant, parameters: &[f64]| -> Result<Vec<Vec<f64>>, String> {
        // From where the rig starts, which may be where its spring rests.
        let of = |state: &Declaration| rig.plant.state(&state.name).map_or(state.start, |it| rig.start[it]);
        let start: Vec<f64> = plant.states.iter().map(of).collect();
        Ok(plant.prepare(&plant.choices)?.outputs(parameters, &start, &drive))
    };
    let (own, with) = (run(&alone, &values)?, run(&rig.plant, &rig.parameters)?);
    let both = alone
        .outputs
        .iter()
        .zip(&own)
        .filter_map(|(it, own)| Some((own, &with[rig.plant.output(&it.name)?])));
    Ok(Some(both.map(|(own, with)| apart(own, with)).fold(0.0, larger)))
}

impl Rig {
    /// What drives it for half a second where there is no record: all inputs at once, each by a sine of its usual size.
    pub fn trial(&self) -> Drive {
        let sine = |(place, declared): (usize, &Declaration)| -> Vec<f64> {
            let size = self.excitation(declared).map_or(0.0, |(amplitude, _)| amplitude);
            let turns = FREQUENCY * (1.0 + 0.3 * place as f64) * STEP;
            (0..SAMPLES).map(|k| declared.start + size * (TAU * turns * k as f64).sin()).collect()
        };
        let inputs = self.plant.inputs.iter().enumerate().map(sine).collect();
        Drive::sampled(STEP, inputs)
    }
}

/// Root mean square of the difference over that of a signal's own motion; zero for signals that rest.
fn apart(own: &[f64], with: &[f64]) -> f64 {
    let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
    let size = |values: &mut dyn Iterator<Item = f64>| values.map(|it| it * it).sum::<f64>().sqrt();
    let difference = size(&mut own.iter().zip(with).map(|(own, with)| with - own));
    let motion = size(&mut own.iter().map(|it| it - mean));
    if difference <= ROUNDING { 0.0 } else { difference / motion }
}

/// The larger one, or not a number if one of them is none.
fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::NAN } else { one.max(other) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_compared_by_how_far_they_move() {
        let own = [5.0, 6.0, 5.0, 4.0];
        assert_eq!(apart(&own, &own), 0.0);
        assert!((apart(&own, &[5.0, 6.1, 5.0, 3.9]) - 0.1).abs() < 1e-12);
        assert_eq!(apart(&[1.0, 1.0], &[1.0, 1.0]), 0.0);
        assert!(apart(&own, &[f64::NAN; 4]).is_nan());
    }

    #[test]
    fn what_cannot_be_run_is_not_the_same() {
        assert!([0.1, f64::NAN, 0.3].into_iter().fold(0.0, larger).is_nan());
        assert_eq!([0.1, 0.3].into_iter().fold(0.0, larger), 0.3);
    }

    #[test]
    fn a_model_of_the_library_replaces_nothing() {
        let rig = Rig::published("quarter-car").unwrap();
        assert_eq!(difference(&rig), Ok(None));
    }
}
