//! How large the forces and motions of a rig's elements are.

use crate::catalogue::{Element, TURNED, Typical, joints};
use crate::dataset::recorded::{Dataset, Source};
use crate::rig::{ElementSignals, ForceOf, Rig};
use crate::signal::derivative;

use super::rms;

/// Typical magnitudes of an element over records, from predicted signals of all outputs with these parameters.
pub fn typical(
    (rig, parameters): (&Rig, &[f64]),
    records: &[Dataset],
    outputs: &[Vec<Vec<f64>>],
) -> Vec<(Element, Typical)> {
    let plant = &rig.plant;
    let signal = |name: &str| -> Vec<Vec<f64>> {
        let index = plant.output(name);
        outputs.iter().map(|record| index.map_or_else(Vec::new, |index| record[index].clone())).collect()
    };
    let magnitude = |signals: &[Vec<f64>]| rms(&signals.concat()).max(1e-12);
    let value = |name: &str| plant.parameter(name).map_or(0.0, |index| parameters[index]);
    let driven = |name: &str| {
        let index = plant.input(name);
        let sources = records.iter().filter_map(|record| record.inputs.get(index?));
        let driven: Vec<f64> = sources
            .flat_map(|source| match source {
                Source::Measured(values) => values.clone(),
                Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => Vec::new(),
            })
            .collect();
        rms(&driven).max(1e-12)
    };
    let of = |element: &ElementSignals| {
        let positions: Vec<_> = signal(&element.deflection).iter().map(|it| element.deflected(it)).collect();
        let velocities = match &element.velocity {
            Some(name) => signal(name),
            None => {
                let pairs = positions.iter().zip(records);
                pairs.map(|(x, record)| derivative(x, record.step)).collect()
            }
        };
        let (deflection, velocity) = (magnitude(&positions), magnitude(&velocities));
        // What moves the mass of an element that nothing pushes is in the element.
        let of_mass = || {
            let missing = rig.kind.missing.iter().filter(|it| it.over.contains(&element.element));
            let mass = missing.filter_map(|it| it.times.as_deref()).map(value).next()?;
            let pairs = velocities.iter().zip(records);
            let accelerations: Vec<_> = pairs.map(|(v, record)| derivative(v, record.step)).collect();
            Some(mass * magnitude(&accelerations))
        };
        let force = match &element.force {
            ForceOf::Output { output: name } => {
                // Measured rather than simulated, where it is measured: the model may be far off.
                let index = plant.output(name);
                let measured: Vec<f64> = records
                    .iter()
                    .flat_map(|record| record.measured.iter().filter(|it| Some(it.output) == index))
                    .flat_map(|measured| measured.values.clone())
                    .collect();
                let own =
                    if measured.is_empty() { magnitude(&signal(name)) } else { rms(&measured).max(1e-12) };
                own.max(of_mass().unwrap_or(0.0))
            }
            ForceOf::Input { input: name } => driven(name),
            ForceOf::Inertia { acceleration: output, mass: by }
            | ForceOf::Moment { moment_of: output, lever: by } => {
                (value(by) * magnitude(&signal(output))).max(1e-12)
            }
            ForceOf::SpringAndDamper { stiffness, damping } => {
                (value(stiffness) * deflection).hypot(value(damping) * velocity)
            }
        };
        let pitch = if element.turns(plant) { TURNED } else { 1.0 };
        (element.element, Typical { force, deflection, velocity, pitch })
    };
    let mut all: Vec<(Element, Typical)> = rig.kind.elements.iter().map(of).collect();
    let several = joints(plant).map(|(joint, members)| {
        let own: Vec<Typical> =
            all.iter().filter(|(of, _)| members.contains(of)).map(|(_, typical)| *typical).collect();
        let of = |value: fn(&Typical) -> f64| own.iter().map(value).sum::<f64>() / own.len().max(1) as f64;
        (
            joint,
            Typical {
                force: of(|it| it.force),
                deflection: of(|it| it.deflection),
                velocity: of(|it| it.velocity),
                pitch: of(|it| it.pitch),
            },
        )
    });
    let several: Vec<(Element, Typical)> = several.collect();
    all.extend(several);
    all
}
