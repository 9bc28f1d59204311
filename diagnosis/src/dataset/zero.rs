//! Motions that count from elsewhere than the model's, which count from static equilibrium.

use strut_model::unit;

use crate::data::check::DataProblem;
use crate::dataset::recorded::Dataset;
use crate::plant::{Drive, Dynamics};
use crate::report::words::quantity;
use crate::rig::Rig;
use crate::signal::distortion::Correction;

/// Time in seconds over which a model is looked at that rests.
const STEP: f64 = 1e-3;

/// Units of motions: what moves about an equilibrium has a mean near zero over a record, whatever forces act on it.
const MOTIONS: [unit::Unit; 6] =
    [unit::M, unit::RAD, unit::M_PER_S, unit::RAD_PER_S, unit::M_PER_S2, unit::RAD_PER_S2];

/// Makes motions count from their mean that are mostly constant where the starting model's are not: a suspension moves about its
/// static equilibrium, so that a sensor which shows another has its zero elsewhere, or gravity on it. Such an offset hides all
/// else. The mean is that of all records: a ride height that differs between them is the rig's. The notes on it.
pub fn zeroed(rig: &Rig, records: &mut [Dataset]) -> Vec<DataProblem> {
    let Some(first) = records.first() else { return Vec::new() };
    let outputs: Vec<usize> = first.measured.iter().map(|it| it.output).collect();
    let Ok(dynamics) = rig.plant.prepare(&rig.choices) else { return Vec::new() };
    let equilibrium = counting_from_equilibrium(rig, &*dynamics);
    let offset = |output: &usize| {
        let known = records.iter().flat_map(|it| it.measured.iter().filter(|it| it.output == *output));
        Some((*output, constant(known.flat_map(|it| &it.values))?))
    };
    let offsets = outputs.iter().filter(|it| equilibrium.contains(it)).filter_map(offset);
    let offsets: Vec<(usize, f64)> = offsets.collect();
    if offsets.is_empty() {
        return Vec::new();
    }
    let responses: Vec<_> = records.iter().flat_map(|it| responses(rig, &*dynamics, it)).collect();
    let mut notes = Vec::new();
    for (output, mean) in offsets {
        // A constant force moves the equilibrium.
        if constant(responses.iter().flat_map(|it| &it[output])).is_some() {
            continue;
        }
        let measured = records.iter_mut().flat_map(|it| it.measured.iter_mut());
        measured.filter(|it| it.output == output).flat_map(|it| &mut it.values).for_each(|it| *it -= mean);
        let declared = &rig.plant.outputs[output];
        notes.push(DataProblem {
            record: "all".into(),
            signal: declared.name.clone(),
            text: format!(
                "an offset of {}, larger than all motion about it, where the starting model moves about zero. It counts from its \
                 mean over all records",
                quantity(mean, declared.unit.symbol)
            ),
            fatal: false,
        });
    }
    notes
}

/// Outputs that are motions, are no states that start where they are, and are zero where the model rests.
fn counting_from_equilibrium(rig: &Rig, dynamics: &dyn Dynamics) -> Vec<usize> {
    let still = rig.plant.inputs.iter().map(|it| vec![it.start; 2]).collect();
    let drive = Drive::sampled(STEP, still);
    let resting = dynamics.outputs(&rig.parameters, &rig.start, &drive);
    let counts = |index: usize| {
        let declared = &rig.plant.outputs[index];
        MOTIONS.contains(&declared.unit)
            && rig.shown(&declared.name).is_none()
            && resting[index].first() == Some(&0.0)
    };
    (0..rig.plant.outputs.len()).filter(|index| counts(*index)).collect()
}

/// All outputs of the starting model in each section of a record.
fn responses(rig: &Rig, dynamics: &dyn Dynamics, record: &Dataset) -> Vec<Vec<Vec<f64>>> {
    let corrections = vec![Correction::default(); record.inputs.len()];
    let of = |section| dynamics.outputs(&rig.parameters, &rig.start, &record.drive(section, &corrections));
    record.sections.iter().map(of).collect()
}

/// The mean of the known values, if there is more power in it than in all that varies.
fn constant<'a>(values: impl Iterator<Item = &'a f64>) -> Option<f64> {
    let known = values.filter(|it| it.is_finite());
    let (count, sum, squares) =
        known.fold((0.0, 0.0, 0.0), |(count, sum, squares), it| (count + 1.0, sum + it, squares + it * it));
    let mean = sum / count;
    (2.0 * mean * mean > squares / count).then_some(mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::{Measured, Source};

    /// Half a second of a car on a wavy road, under a constant force.
    fn record(rig: &Rig, force: f64, measured: &[&str]) -> Dataset {
        let road: Vec<f64> = (0..500).map(|k| 2e-3 * (31.0 * f64::from(k) * STEP).sin()).collect();
        let mut record = Dataset {
            step: STEP,
            inputs: vec![Source::Measured(road), Source::DerivativeOf(0), Source::Measured(vec![force; 500])],
            sections: std::iter::once(0..500).collect(),
            ..Dataset::default()
        };
        let outputs = responses(rig, &*rig.plant.prepare(&rig.choices).unwrap(), &record).remove(0);
        let of = |name: &&str| {
            let output = rig.plant.output(name).unwrap();
            Measured { output, values: outputs[output].clone(), noise_floor: 1e-9 }
        };
        record.measured = measured.iter().map(of).collect();
        record
    }

    #[test]
    fn gravity_is_an_offset_and_what_a_constant_force_does_is_none() {
        let rig = Rig::published("tum-quarter-vehicle").unwrap();
        let signals = ["body.acceleration", "suspension.deflection"];
        let original = record(&rig, 0.0, &signals);
        let mut records = [original.clone(), original.clone()];
        for values in records.iter_mut().map(|it| &mut it.measured[0].values) {
            values.iter_mut().for_each(|it| *it += 9.81);
        }
        let notes = zeroed(&rig, &mut records);
        assert_eq!(notes.iter().map(|it| &it.signal[..]).collect::<Vec<_>>(), ["body.acceleration"]);
        let mean = original.measured[0].values.iter().sum::<f64>() / 500.0;
        for (now, before) in records[1].measured[0].values.iter().zip(&original.measured[0].values) {
            assert!((now - (before - mean)).abs() < 1e-9);
        }
        let mut pressed = [record(&rig, -2000.0, &signals)];
        let deflection = pressed[0].measured[1].values.clone();
        assert!(constant(deflection.iter()).is_some(), "it is to be mostly constant");
        assert!(zeroed(&rig, &mut pressed).is_empty());
        assert_eq!(pressed[0].measured[1].values, deflection);
    }

    #[test]
    fn a_mean_is_an_offset_where_it_is_most_of_a_signal() {
        assert_eq!(constant([0.03, 0.05, f64::NAN].iter()), Some(0.04));
        assert_eq!(constant([-0.03, -0.05].iter()), Some(-0.04));
        // One sample that was lost does not hide it, and a large motion is none.
        assert!(constant([9.8, 9.9, 0.0, 9.7, 9.8].iter()).is_some());
        assert_eq!(constant([9.8, -30.0, 40.0].iter()), None);
        assert_eq!(constant([f64::NAN].iter()), None);
    }

    #[test]
    fn forces_states_and_what_rests_elsewhere_stay() {
        let counts = |rig: &str| {
            let rig = Rig::published(rig).unwrap();
            let dynamics = rig.plant.prepare(&rig.choices).unwrap();
            let outputs = counting_from_equilibrium(&rig, &*dynamics).into_iter();
            outputs.map(|index| rig.plant.outputs[index].name.clone()).collect::<Vec<_>>()
        };
        assert_eq!(
            counts("tum-quarter-vehicle"),
            [
                "body.acceleration",
                "wheel.acceleration",
                "suspension.deflection",
                "suspension.velocity",
                "tire.deflection"
            ]
        );
        // Its position and its velocity are where they are.
        assert_eq!(counts("linear-drive"), ["acceleration"]);
        // Its arms rest at angles of their own.
        assert_eq!(counts("kogut-sas-rig"), ["relative.speed"]);
    }
}
