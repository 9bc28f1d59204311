//! The augmented model: another maker's FMU with what was found beside it, as a system of FMUs (SSP).

mod material;
mod step;
mod system;
#[cfg(test)]
mod tests;

use std::path::Path;

use strut_model::Declaration;

use crate::diagnosis::Diagnosis;
use crate::plant::{Drive, Face, Foreign, Signals};
use crate::rig::{Rig, UNSEEN, difference, fmu_of};
use crate::signal::distortion::Correction;

use super::extend::Segment;
use super::words;
use material::{Material, Value};

pub use system::{NAME, System};

/// Difference of a state from what it should start with, as a share of how far it moves, that a reader wants to know.
const APART: f64 = 1e-3;

/// Why another maker's FMU cannot be part of a system; none if it can.
pub fn obstacle(face: &Face) -> Option<&'static str> {
    match face {
        Face { is_of_fmi_2: false, .. } => Some("the FMU is not of FMI 2.0"),
        Face { co_simulates: false, .. } => {
            Some("the FMU is for model exchange only, and tools that run an SSP need co-simulation")
        }
        _ => None,
    }
}

/// The notes on an `augmented.ssp` before there is a diagnosis: signals that it would not show. None for a model of the library, which
/// gets an `extended.fmu`.
///
/// # Errors
/// Why there can be none.
pub fn possible(rig: &Rig) -> Option<Result<Vec<String>, String>> {
    rig.kind.is_foreign().then(|| {
        let mut parameters = rig.parameters.clone();
        // As if something had been found in each element.
        for at in rig.kind.attached()? {
            let friction =
                ["strut.coulomb.force", "tire.coulomb.force"].iter().find_map(|it| at.role.beside(it));
            let index = friction.and_then(|name| rig.plant.parameter(&name));
            index.into_iter().for_each(|index| parameters[index] = 1.0);
        }
        let drive = rig.trial();
        let outputs = rig.plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name));
        let found = Found {
            parameters: &parameters,
            start: &rig.start,
            simulated: rig.plant.prepare(&rig.choices)?.outputs(&parameters, &rig.start, &drive),
            drive,
            measured: outputs.map(|it| (&*it.name, Correction::default())).collect(),
            step: 1e-3,
            record: String::new(),
        };
        Ok(found.system(rig)?.notes)
    })
}

impl Diagnosis<'_> {
    /// The augmented model on a segment of a record.
    ///
    /// # Errors
    /// Why there is none, in a sentence.
    pub(super) fn augmented(&self, segment: Option<&Segment<'_>>) -> Result<System, String> {
        let Segment { record, range, point, start, dynamics } =
            segment.ok_or("the model diverges on the validation records")?;
        let rig = self.baseline.rig;
        let (drive, parameters) = (record.drive(range, &point.inputs), &point.parameters);
        let [from, to] = [range.start, range.end - 1].map(|sample| sample as f64 * record.step);
        let outputs = record.measured.iter().map(|it| it.output);
        let found = Found {
            parameters,
            start,
            simulated: dynamics.outputs(parameters, start, &drive),
            step: step::step(&**dynamics, (parameters, start), &drive),
            drive,
            measured: outputs.map(|it| (&*rig.plant.outputs[it].name, point.outputs[it])).collect(),
            record: format!("{}, {from} s to {to} s", record.name),
        };
        found.system(rig)
    }
}

/// What a rig becomes, and what it does on a record.
struct Found<'a> {
    parameters: &'a [f64],
    start: &'a [f64],
    drive: Drive,
    simulated: Signals,
    measured: Vec<(&'a str, Correction)>,
    step: f64,
    record: String,
}

impl Found<'_> {
    fn system(self, rig: &Rig) -> Result<System, String> {
        let Self { parameters, start, drive, simulated, measured, step, record } = self;
        let (fmu, plant) = (fmu_of(Path::new(&rig.kind.model))?, &rig.plant);
        let face = Face::read(&fmu)?;
        if let Some(text) = obstacle(&face) {
            return Err(text.into());
        }
        if !simulated.iter().flatten().all(|it| it.is_finite()) {
            return Err("the model cannot be simulated".into());
        }
        let beside = rig.kind.attached()?;
        let memory = plant.states.iter().zip(start).filter(|(it, _)| rig.kind.is_beside(&it.name));
        let mut material = Material {
            fmu: &fmu,
            face: &face,
            beside: &beside,
            stands_in: difference(rig)?.is_some_and(|it| it < UNSEEN),
            parameters: plant.parameters.iter().zip(&plant.own(parameters)).map(valued).collect(),
            memory: memory.map(valued).collect(),
            starts: Vec::new(),
            inputs: plant.inputs.iter().zip(&drive.inputs).map(|(it, of)| (&*it.name, &**of)).collect(),
            outputs: plant.outputs.iter().zip(&simulated).map(|(it, of)| (&*it.name, &**of)).collect(),
            sampling: drive.step / drive.finer as f64,
            measured,
            step,
            record,
        };
        material.starts = starts(&face, (&plant.states, start), &material.outputs);
        let note = apart(&mut material, (&plant.states, start))?;
        let mut system = system::system(&material)?;
        system.notes.extend(note);
        Ok(system)
    }
}

fn valued<'a>((declared, value): (&'a Declaration, &f64)) -> Value<'a> {
    Value { name: &declared.name, value: *value, start: declared.start, unit: declared.unit.symbol }
}

/// What the FMU takes as start values, of its states and of outputs that follow from them.
fn starts(
    face: &Face,
    (states, start): (&[Declaration], &[f64]),
    outputs: &[(&str, &[f64])],
) -> Vec<(String, f64)> {
    let takes = |name: &str| {
        let found = face.variable(name).filter(|it| it.settable && it.kind == "Real");
        found.is_some_and(|it| ["local", "output"].contains(&it.causality.as_str()))
    };
    let of_states = states.iter().zip(start).map(|(it, value)| (it.name.clone(), *value));
    let mut all: Vec<(String, f64)> = of_states.collect();
    for (name, values) in outputs.iter().filter(|(name, _)| states.iter().all(|it| it.name != *name)) {
        all.extend(values.first().map(|value| ((*name).to_owned(), *value)));
    }
    all.retain(|(name, _)| takes(name));
    all
}

/// The note on states that the FMU does not start with, from a trial. Start values that it refuses are left out.
fn apart(
    material: &mut Material<'_>,
    (states, start): (&[Declaration], &[f64]),
) -> Result<Option<String>, String> {
    let alone =
        Foreign { fmu: material.fmu.into(), parameters: Vec::new(), locals: Vec::new(), beside: Vec::new() };
    let mut found = alone.started(&material.given())?;
    if found.is_none() {
        material.starts.clear();
        found = alone.started(&material.given())?;
    }
    let found = found.ok_or("the FMU refuses the fitted parameters as start values")?;
    let both = states.iter().zip(start).zip(&found);
    let unlike =
        both.filter(|((_, wanted), found)| (*wanted - *found).abs() > APART * wanted.abs().max(found.abs()));
    let told: Vec<String> = unlike
        .map(|((it, wanted), found)| {
            let (unit, name) = (words::unit(it.unit.symbol), &it.name);
            format!("{name} = {} {unit} instead of {} {unit}", words::number(*found), words::number(*wanted))
        })
        .collect();
    Ok((!told.is_empty()).then(|| {
        format!(
            "the FMU takes no start values for all of its states and starts with {}",
            words::list(&told, "and")
        )
    }))
}
