//! What an FMU of another maker declares, and where its forces act.

use std::collections::BTreeMap;
use std::path::Path;

use strut_check::import::{Description, Package, Variable, description};
use strut_model::unit;

use crate::plant::{Drive, Foreign, Plant};

use super::guess::Declared;
use crate::rig::{Rig, fmu_of};

/// A force in N whose effect is far from rounding and far from breaking anything.
const STEP: f64 = 100.0;
/// Samples of a millisecond after which the effect is looked at.
const MOMENT: usize = 10;

/// The declarations of an FMU, in base units of the SI.
///
/// # Errors
/// If it cannot be read, or not run on this machine: why, and what to do.
pub fn declared(file: &Path) -> Result<Declared, String> {
    let failed = |error: String| format!("`{}`: {error}", file.display());
    let mut package = Package::open(file).map_err(failed)?;
    let (description, _) = description(&mut package).map_err(failed)?;
    let parameters = names(&description, "parameter");
    let plant =
        Foreign { fmu: file.to_owned(), parameters, locals: Vec::new(), beside: Vec::new() }.plant()?;
    Ok(Declared {
        depends: names(&description, "output").iter().map(|name| dependencies(&description, name)).collect(),
        moved: moved(&plant)?,
        inputs: plant.inputs,
        outputs: plant.outputs,
        parameters: plant.parameters,
    })
}

impl Rig {
    /// Real parameters of a foreign model that its rig file does not name; none of a model of the library.
    ///
    /// # Errors
    /// If the FMU cannot be read.
    pub fn unnamed_parameters(&self) -> Result<Vec<String>, String> {
        if !self.kind.is_foreign() {
            return Ok(Vec::new());
        }
        let (description, _) =
            Package::open(&fmu_of(Path::new(&self.kind.model))?).and_then(|mut it| description(&mut it))?;
        let replaced = self.kind.elements.iter().filter_map(|it| it.replaces.as_ref());
        let replaced: Vec<&String> = replaced.flat_map(|it| [&it.stiffness, &it.damping]).collect();
        let mut all = names(&description, "parameter");
        // A name of an element of the library means its parameter, not that of the FMU.
        let is_beside = |name: &str| self.kind.is_beside(name);
        all.retain(|it| !replaced.contains(&it) && (is_beside(it) || self.plant.parameter(it).is_none()));
        Ok(all)
    }
}

/// Real variables of a causality, as a plant has them.
fn names(description: &Description, causality: &str) -> Vec<String> {
    let of = |it: &&Variable| it.kind == "Real" && it.causality == causality && it.reference.is_some();
    description.variables.iter().filter(of).map(|it| it.name.clone()).collect()
}

/// On which variables an output depends at once, by the model structure.
fn dependencies(description: &Description, output: &str) -> Option<Vec<String>> {
    let name = |index: usize| description.variable(index).map(|it| it.name.clone());
    let unknown = description.outputs.iter().find(|it| name(it.index).as_deref() == Some(output))?;
    unknown.dependencies.as_ref()?.iter().map(|index| name(*index)).collect()
}

/// How far outputs have moved a moment after a step of each force.
///
/// # Errors
/// If the model cannot be prepared.
fn moved(plant: &Plant) -> Result<BTreeMap<usize, Vec<f64>>, String> {
    let dynamics = plant.prepare(&plant.choices)?;
    let parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
    let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
    let last = |stepped: Option<usize>| -> Option<Vec<f64>> {
        let level =
            |index: usize| plant.inputs[index].start + if stepped == Some(index) { STEP } else { 0.0 };
        let inputs = (0..plant.inputs.len()).map(|index| vec![level(index); MOMENT + 1]).collect();
        let drive = Drive::sampled(1e-3, inputs);
        let signals = dynamics.outputs(&parameters, &start, &drive);
        signals.iter().map(|signal| signal.last().copied()).collect()
    };
    let forces = (0..plant.inputs.len()).filter(|it| plant.inputs[*it].unit.base == unit::N.base);
    let mut moved = BTreeMap::new();
    let rest = last(None);
    for force in forces {
        if let (Some(rest), Some(pushed)) = (&rest, last(Some(force))) {
            moved.insert(force, pushed.iter().zip(rest).map(|(pushed, rest)| pushed - rest).collect());
        }
    }
    Ok(moved)
}
