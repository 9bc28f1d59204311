//! What a model can hold of what its inputs pass: an actuator's gain, delay and lag are parameters of some models.
//!
//! The search looks for them in the signals, where a delay is exact and costs nothing; the extended model has them inside.

use crate::estimation::unknowns::Estimate;
use crate::plant::Plant;
use crate::signal::distortion::Fault;

/// What a parameter can do to an input.
const FAULTS: [Fault; 3] = [Fault::Gain, Fault::Delay, Fault::Lag];

/// A parameter that does to an input what a fault does: `actuator.delay` to `actuator.force`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Index of the parameter.
    pub parameter: usize,
    fault: Fault,
    least: f64,
}

impl Held {
    /// The parameter that does to an input what a fault does, if the plant has one.
    pub fn of(plant: &Plant, input: usize, fault: Fault) -> Option<Self> {
        let (group, _) = plant.inputs[input].name.split_once('.')?;
        let name = format!("{group}.{}", fault.name());
        let parameter = plant.parameter(&name).filter(|_| FAULTS.contains(&fault))?;
        let least = plant.parameters[parameter].min.unwrap_or(f64::NEG_INFINITY);
        Some(Self { parameter, fault, least })
    }

    /// The parameter's value with so much of the fault beside what it was.
    pub fn with(&self, before: f64, amount: f64) -> f64 {
        if self.fault == Fault::Gain { before * (1.0 + amount) } else { before + amount }
    }
}

impl Estimate {
    /// The same with all inside of the model that it can hold: a command that is measured late, say, it cannot make earlier.
    #[must_use]
    pub fn within(&self, plant: &Plant) -> Self {
        let mut point = self.clone();
        for input in 0..plant.inputs.len() {
            for fault in FAULTS {
                let Some(held) = self.holds(plant, input, fault) else { continue };
                let amount = self.inputs[input].get(fault);
                point.parameters[held.parameter] = held.with(self.parameters[held.parameter], amount);
                point.inputs[input].set(fault, 0.0);
            }
        }
        point
    }

    /// The parameter that can hold what is here of an input's fault.
    pub fn holds(&self, plant: &Plant, input: usize, fault: Fault) -> Option<Held> {
        let amount = self.inputs[input].get(fault);
        Held::of(plant, input, fault).filter(|it| it.with(self.parameters[it.parameter], amount) >= it.least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Rig;
    use crate::signal::distortion::Correction;

    /// A point of the TUM rig with some faults of its actuator.
    fn point(rig: &Rig, faults: &[(Fault, f64)]) -> (Estimate, usize) {
        let mut point = Estimate {
            parameters: rig.parameters.clone(),
            inputs: vec![Correction::default(); rig.plant.inputs.len()],
            outputs: Vec::new(),
            starts: Vec::new(),
        };
        let input = rig.plant.input("actuator.force").unwrap();
        faults.iter().for_each(|(fault, amount)| point.inputs[input].set(*fault, *amount));
        (point, input)
    }

    #[test]
    fn an_actuator_s_faults_become_the_model_s_parameters() {
        let rig = Rig::published("tum-quarter-vehicle").unwrap();
        let (point, input) = point(&rig, &[(Fault::Gain, -0.1), (Fault::Delay, 4e-3), (Fault::Lag, 2e-3)]);
        let within = point.within(&rig.plant);
        let value = |name: &str| within.parameters[rig.plant.parameter(name).unwrap()];
        let names = ["actuator.gain", "actuator.delay", "actuator.lag"];
        assert_eq!(names.map(value), [0.9, 4e-3, 2e-3]);
        assert!(within.inputs[input].is_neutral());
    }

    #[test]
    fn a_command_that_was_measured_late_stays_outside() {
        let rig = Rig::published("tum-quarter-vehicle").unwrap();
        let (point, input) = point(&rig, &[(Fault::Gain, 0.2), (Fault::Delay, -4e-3)]);
        let within = point.within(&rig.plant);
        assert_eq!(within.inputs[input].get(Fault::Delay), -4e-3);
        assert_eq!(within.inputs[input].get(Fault::Gain), 0.0);
        let road = rig.plant.input("road.position").unwrap();
        assert_eq!(Held::of(&rig.plant, road, Fault::Delay), None);
    }
}
