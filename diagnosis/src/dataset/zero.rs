//! Deflections that count from elsewhere than the model's, which count from static equilibrium.

use crate::dataset::recorded::Dataset;
use crate::plant::{Between, Drive};
use crate::report::findings::DataProblem;
use crate::report::words::quantity;
use crate::rig::Rig;

/// Time in seconds over which a model is looked at that rests.
const STEP: f64 = 1e-3;

/// Makes deflections count from their mean that never pass their zero: a suspension moves about its static equilibrium, so that
/// a sensor which never shows it has its zero elsewhere. The mean is that of all records: a ride height that differs between
/// them is the rig's. The notes on it.
pub fn zeroed(rig: &Rig, records: &mut [Dataset]) -> Vec<DataProblem> {
    let Some(first) = records.first() else { return Vec::new() };
    let outputs: Vec<usize> = first.measured.iter().map(|it| it.output).collect();
    let equilibrium = counting_from_equilibrium(rig);
    let mut notes = Vec::new();
    for output in outputs.into_iter().filter(|it| equilibrium.contains(it)) {
        let declared = &rig.plant.outputs[output];
        let known: Vec<f64> =
            records.iter_mut().filter_map(|it| values(it, output)).flatten().map(|it| *it).collect();
        let Some(mean) = never_zero(&known) else { continue };
        records.iter_mut().filter_map(|it| values(it, output)).flatten().for_each(|it| *it -= mean);
        notes.push(DataProblem {
            record: "all".into(),
            signal: declared.name.clone(),
            text: format!(
                "an offset of {}: no record passes its zero, which is the model's static equilibrium. Its mean over all records is \
                 taken for that",
                quantity(mean, declared.unit.symbol)
            ),
            fatal: false,
        });
    }
    notes
}

fn values(record: &mut Dataset, output: usize) -> Option<&mut Vec<f64>> {
    record.measured.iter_mut().find(|it| it.output == output).map(|it| &mut it.values)
}

/// Outputs that are lengths or angles, are no states that start where they are, and are zero where the model rests.
fn counting_from_equilibrium(rig: &Rig) -> Vec<usize> {
    let still = rig.plant.inputs.iter().map(|it| vec![it.start; 2]).collect();
    let drive = Drive { start: 0.0, step: STEP, inputs: still, finer: 1, between: Between::Lines };
    let Ok(dynamics) = rig.plant.prepare(&rig.choices) else { return Vec::new() };
    let resting = dynamics.outputs(&rig.parameters, &rig.start, &drive);
    let counts = |index: usize| {
        let declared = &rig.plant.outputs[index];
        matches!(declared.unit.symbol, "m" | "rad")
            && rig.shown(&declared.name).is_none()
            && resting[index].first() == Some(&0.0)
    };
    (0..rig.plant.outputs.len()).filter(|index| counts(*index)).collect()
}

/// The mean of the known values, if they are all positive or all negative.
fn never_zero(values: &[f64]) -> Option<f64> {
    let known = || values.iter().filter(|it| it.is_finite());
    let (count, sum) = known().fold((0_u32, 0.0), |(count, sum), it| (count + 1, sum + it));
    let same = known().all(|it| *it > 0.0) || known().all(|it| *it < 0.0);
    (same && count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_zero_counts_from_there() {
        assert_eq!(never_zero(&[0.03, 0.05, f64::NAN]), Some(0.04));
        assert_eq!(never_zero(&[-0.03, -0.05]), Some(-0.04));
        assert_eq!(never_zero(&[0.03, -0.001, 0.05]), None);
        assert_eq!(never_zero(&[f64::NAN]), None);
    }

    #[test]
    fn forces_accelerations_states_and_what_rests_elsewhere_stay() {
        let counts = |rig: &str| {
            let rig = Rig::published(rig).unwrap();
            let outputs = counting_from_equilibrium(&rig).into_iter();
            outputs.map(|index| rig.plant.outputs[index].name.clone()).collect::<Vec<_>>()
        };
        assert_eq!(counts("tum-quarter-vehicle"), ["suspension.deflection", "tire.deflection"]);
        assert_eq!(counts("linear-drive"), Vec::<String>::new());
        // Its arms rest at angles of their own.
        assert_eq!(counts("kogut-sas-rig"), Vec::<String>::new());
    }
}
