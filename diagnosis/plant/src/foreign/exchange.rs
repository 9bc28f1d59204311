//! An FMU, loaded, and instances of it that compute rates and outputs.

mod events;
mod starts;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use strut_check::import::{
    Description, Instance, Kind, Library, Package, Status, Variable, Version, description, host,
    library_path, uri,
};
use strut_model::Declaration;
use tempfile::TempDir;

use super::Foreign;
use super::units::{Conversion, coherent};
use events::Events;

pub use starts::LEAST;

/// A loaded FMU.
pub struct Fmu {
    pub name: String,
    pub inputs: Vec<Declaration>,
    pub outputs: Vec<Declaration>,
    pub parameters: Vec<Declaration>,
    pub states: Vec<Declaration>,
    /// Start values of the parameters that an element replaces, which are zero here, in base units.
    pub replaced: Vec<f64>,
    /// All real variables by name.
    reals: BTreeMap<String, u32>,
    library: Library,
    guid: String,
    resources: String,
    start: f64,
    indicators: usize,
    silent: bool,
    of_inputs: Access,
    of_outputs: Access,
    of_parameters: Access,
    of_replaced: Access,
    of_states: Vec<Conversion>,
    /// Instances that nobody uses.
    idle: Mutex<Vec<Instance>>,
    // Unloaded before its files are removed.
    _folder: TempDir,
}

/// Where values of variables are, and how they are made values in base units.
#[derive(Clone, Debug, Default)]
struct Access {
    references: Vec<u32>,
    conversions: Vec<Conversion>,
}

/// An instance with the parameters of its owner.
pub struct Session {
    fmu: Arc<Fmu>,
    instance: Instance,
    /// Its time at the record's beginning.
    start: f64,
    /// Values as the FMU has them.
    own: Vec<f64>,
    events: Events,
    failed: bool,
    /// Whether a state or an input where it was put is not a number.
    is_nowhere: bool,
}

impl std::fmt::Debug for Fmu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fmu").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Fmu {
    /// Loads an FMU with the parameters that may be changed, and those that are to be zero.
    pub fn load(wanted: &Foreign, zero: &[&str]) -> Result<Arc<Self>, String> {
        let Foreign { fmu: file, parameters, locals, .. } = wanted;
        let failed = |error: String| format!("`{}`: {error}", file.display());
        let mut package = Package::open(file).map_err(failed)?;
        let (description, _) = description(&mut package).map_err(failed)?;
        let (identifier, platform) = runnable(&description).map_err(failed)?;
        let library = library_path(platform, &identifier);
        if !package.files().any(|it| it == library) {
            return Err(failed(format!("it has no library for this machine: `{library}` is missing")));
        }
        let folder = tempfile::tempdir().map_err(|error| failed(error.to_string()))?;
        package.unpack(folder.path()).map_err(failed)?;
        let library = Library::load(&folder.path().join(&library))
            .map_err(|error| failed(format!("its library cannot be loaded: {error}")))?;
        let has = |causality: &'static str| {
            move |it: &&Variable| it.kind == "Real" && it.causality == causality && it.reference.is_some()
        };
        let (inputs, of_inputs) = declared(&description, description.variables.iter().filter(has("input")));
        let shown = |it: &&Variable| has("output")(it) || (has("local")(it) && locals.contains(&it.name));
        let (outputs, of_outputs) = declared(&description, description.variables.iter().filter(shown));
        let states = state_variables(&description).map_err(failed)?;
        // A rig file gives start values of states, too.
        let is_state = |name: &&str| states.iter().any(|it| it.name == *name);
        let mut absent = Vec::new();
        let mut of = |name: &'_ str| {
            let own = |it: &&Variable| it.name == name && has("parameter")(it);
            let found = description.variables.iter().find(own);
            if found.is_none() {
                absent.push(name.to_owned());
            }
            found
        };
        let own = parameters.iter().map(String::as_str).filter(|name| !is_state(name));
        let own: Vec<&Variable> = own.filter_map(&mut of).collect();
        let taken: Vec<&Variable> = zero.iter().copied().filter_map(&mut of).collect();
        if !absent.is_empty() {
            let all = description.variables.iter().filter(has("parameter"));
            let all: Vec<&str> = all.map(|it| it.name.as_str()).take(40).collect();
            return Err(failed(format!(
                "it has no real parameter {}; its parameters are {}",
                absent.join(", "),
                all.join(", ")
            )));
        }
        let (parameters, of_parameters) = declared(&description, own.into_iter());
        let (replaced, of_replaced) = declared(&description, taken.into_iter());
        let (states, of_states) = declared(&description, states.into_iter());
        let guid = description.guid.clone().unwrap_or_default();
        let me = |it: &&strut_check::import::Interface| it.kind == Kind::ModelExchange;
        let silent = description
            .interfaces
            .iter()
            .find(me)
            .is_some_and(|it| it.can("completedIntegratorStepNotNeeded"));
        let mut fmu = Self {
            name: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            inputs,
            outputs,
            parameters,
            states,
            replaced: replaced.iter().map(|it| it.start).collect(),
            reals: starts::references(&description),
            library,
            guid,
            resources: uri(&folder.path().join("resources")),
            start: description.experiment.start.unwrap_or(0.0),
            indicators: description.event_indicators,
            silent,
            of_inputs,
            of_outputs,
            of_parameters,
            of_replaced,
            of_states: of_states.conversions,
            idle: Mutex::default(),
            _folder: folder,
        };
        fmu.read_starts().map_err(failed)?;
        Ok(Arc::new(fmu))
    }

    fn instantiate(&self) -> Option<Instance> {
        self.library.instantiate(false, &self.guid, &self.resources, false)
    }

    /// Enters the initialisation.
    fn begin(&self, instance: Instance, start: f64) -> bool {
        fine(self.library.set_up(instance, start, None, None))
            && fine(self.library.plain("fmi2EnterInitializationMode", instance))
    }

    /// Goes from the initialisation to where rates are computed, and gives the time of the first event; none if it fails.
    fn finish(&self, instance: Instance) -> Option<f64> {
        let is_fine = fine(self.library.plain("fmi2ExitInitializationMode", instance));
        is_fine.then(|| self.leave_events(instance)).flatten()
    }

    fn release(&self, instance: Instance) {
        self.library.plain("fmi2Terminate", instance);
        if fine(self.library.plain("fmi2Reset", instance)) {
            self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(instance);
        } else {
            self.library.free(instance);
        }
    }

    /// An instance with these parameters, in base units, ready to compute rates `later` than its own start, in seconds; none if
    /// the FMU refuses them.
    pub fn open(self: &Arc<Self>, parameters: &[f64], later: f64) -> Option<Session> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let instance = idle.or_else(|| self.instantiate())?;
        let own = |access: &Access, values: &[f64]| -> Vec<f64> {
            access.conversions.iter().zip(values).map(|(conversion, value)| conversion.own(*value)).collect()
        };
        let set = |access: &Access, values: &[f64]| {
            access.references.is_empty()
                || fine(self.library.set_reals(instance, &access.references, &own(access, values)))
        };
        let nothing = vec![0.0; self.of_replaced.references.len()];
        let start = self.start + later;
        let is_ready = set(&self.of_parameters, parameters)
            && set(&self.of_replaced, &nothing)
            && self.begin(instance, start);
        let Some(first_event) = is_ready.then(|| self.finish(instance)).flatten() else {
            self.release(instance);
            return None;
        };
        let events = Events::new(self.indicators, first_event);
        Some(Session {
            fmu: self.clone(),
            instance,
            start,
            own: Vec::new(),
            events,
            failed: false,
            is_nowhere: false,
        })
    }
}

impl Drop for Fmu {
    fn drop(&mut self) {
        let idle = self.idle.get_mut().unwrap_or_else(PoisonError::into_inner);
        idle.drain(..).for_each(|instance| self.library.free(instance));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Some FMUs crash where an instance that has failed is used again.
        match self.failed {
            true => self.fmu.library.free(self.instance),
            false => self.fmu.release(self.instance),
        }
    }
}

impl Session {
    /// Whether nothing is asked of it: after a failure, and where it was put at what is not a number. Some FMUs abort the process
    /// that asks them nevertheless.
    fn is_silent(&self) -> bool {
        self.failed || self.is_nowhere
    }

    /// Puts it at a time, with states and inputs in base units.
    pub fn place(&mut self, time: f64, states: &[f64], inputs: &[f64]) {
        self.is_nowhere = !states.iter().all(|it| it.is_finite());
        if self.is_silent() {
            return;
        }
        let (fmu, instance) = (&*self.fmu, self.instance);
        self.failed |= !fine(fmu.library.set_time(instance, self.start + time));
        if !states.is_empty() {
            own(&mut self.own, &fmu.of_states, states);
            self.failed |= !fine(fmu.library.set_states(instance, &self.own));
        }
        self.drive(inputs);
    }

    /// Sets the inputs, in base units.
    pub fn drive(&mut self, inputs: &[f64]) {
        let access = &self.fmu.of_inputs;
        self.is_nowhere |= !inputs.iter().all(|it| it.is_finite());
        if !inputs.is_empty() && !self.is_silent() {
            own(&mut self.own, &access.conversions, inputs);
            self.failed |= !fine(self.fmu.library.set_reals(self.instance, &access.references, &self.own));
        }
    }

    /// The rates of change of all states there, in base units; not a number after a failure.
    pub fn rates(&mut self, rates: &mut [f64]) {
        if !rates.is_empty() && !self.is_silent() {
            self.failed |= !fine(self.fmu.library.rates(self.instance, rates));
        }
        for (rate, conversion) in rates.iter_mut().zip(&self.fmu.of_states) {
            *rate = if self.is_silent() { f64::NAN } else { conversion.si_rate(*rate) };
        }
    }

    /// The outputs there, in base units; not a number after a failure.
    pub fn outputs(&mut self, outputs: &mut [f64]) {
        let access = &self.fmu.of_outputs;
        if !self.is_silent() {
            self.failed |= !fine(self.fmu.library.reals(self.instance, &access.references, outputs));
        }
        for (output, conversion) in outputs.iter_mut().zip(&access.conversions) {
            *output = if self.is_silent() { f64::NAN } else { conversion.si(*output) };
        }
    }

    /// Sets one of the inputs, in base units, where the others stay.
    pub fn push(&mut self, index: usize, input: f64) {
        let access = &self.fmu.of_inputs;
        self.is_nowhere |= !input.is_finite();
        if !self.is_silent() {
            let (reference, value) = (access.references[index], access.conversions[index].own(input));
            self.failed |= !fine(self.fmu.library.set_reals(self.instance, &[reference], &[value]));
        }
    }

    /// Some of the outputs there, in base units.
    pub fn some<const N: usize>(&mut self, indices: [usize; N]) -> [f64; N] {
        let access = &self.fmu.of_outputs;
        let mut values = [f64::NAN; N];
        if !self.is_silent() {
            let references = indices.map(|index| access.references[index]);
            self.failed |= !fine(self.fmu.library.reals(self.instance, &references, &mut values));
        }
        let silent = self.is_silent();
        std::array::from_fn(|i| if silent { f64::NAN } else { access.conversions[indices[i]].si(values[i]) })
    }
}

fn own(values: &mut Vec<f64>, conversions: &[Conversion], si: &[f64]) {
    values.clear();
    values.extend(conversions.iter().zip(si).map(|(conversion, value)| conversion.own(*value)));
}

/// Whether a call was successful, perhaps with a warning.
fn fine(status: Status) -> bool {
    (0..=1).contains(&status)
}

/// The library's name, and the folder of this machine's libraries.
fn runnable(description: &Description) -> Result<(String, &'static str), String> {
    if description.is_of_another_version() {
        return Err(format!("it is of FMI {}; export it as FMI 2.0 for model exchange", description.version));
    }
    let of_kind = |kind: Kind| description.interfaces.iter().find(move |it| it.kind == kind);
    let Some(interface) = of_kind(Kind::ModelExchange) else {
        return Err(
            "it is for co-simulation only, whose states cannot be estimated; export it for model exchange"
                .into(),
        );
    };
    if interface.can("needsExecutionTool") {
        return Err("it needs the tool that made it; export it with its solver or source code inside".into());
    }
    if interface.can("canBeInstantiatedOnlyOncePerProcess") {
        return Err("it can be instantiated only once in a process, and a fit needs several instances".into());
    }
    let platform = host(Version::Two)
        .ok_or("FMI 2.0 has no name for this machine, for which it could have a library")?;
    Ok((interface.identifier.clone(), platform))
}

/// The states in the order of the interface: what the derivatives are of.
fn state_variables(description: &Description) -> Result<Vec<&Variable>, String> {
    let variable = |index: usize| index.checked_sub(1).and_then(|index| description.variables.get(index));
    let of = |unknown: &strut_check::import::Unknown| variable(variable(unknown.index)?.derivative?);
    let found: Option<Vec<&Variable>> = description.derivatives.iter().map(of).collect();
    found.ok_or_else(|| {
        "its model structure does not say what its derivatives are of; `build-fmu check` tells more".into()
    })
}

fn declared<'a>(
    description: &Description,
    variables: impl Iterator<Item = &'a Variable>,
) -> (Vec<Declaration>, Access) {
    let mut access = Access::default();
    let mut all = Vec::new();
    for variable in variables {
        let (unit, conversion) = coherent(variable.unit.as_deref(), &description.units);
        let si = |value: Option<f64>| value.map(|value| conversion.si(value));
        let start = variable.start.as_deref().and_then(|it| it.trim().parse().ok()).unwrap_or(0.0);
        all.push(Declaration {
            doc: variable.description.clone().unwrap_or_default(),
            unit,
            start: conversion.si(start),
            min: si(variable.min),
            max: si(variable.max),
            nominal: variable.nominal.map(|it| conversion.si_rate(it).abs()),
            ..Declaration::named(&variable.name)
        });
        access.references.extend(variable.reference);
        access.conversions.push(conversion);
    }
    (all, access)
}
