//! An FMU as a co-simulation slave, with all functions that a coupling method can use.
//!
//! The instances of the `fmi` crate have no derivatives of inputs and outputs, and take derivatives by direction only
//! for as many knowns as unknowns. So this calls the C functions as the crate binds them.
#![expect(unsafe_code, reason = "C functions are called")]

use std::ffi::CString;
use std::path::Path;
use std::ptr;

use fmi::fmi2::binding::{self, Fmi2Binding};
use fmi::fmi2::schema::ScalarVariableElement;
use fmi::fmi2::{CallbackFunctions, import::Fmi2Import};
use fmi::traits::FmiImport;

use crate::Error;

/// One instance of an FMU.
pub struct Slave {
    binding: Fmi2Binding,
    component: binding::fmi2Component,
    /// The state that was kept last, or null.
    saved: binding::fmi2FMUstate,
    import: Fmi2Import,
    /// The instance holds a pointer to them.
    _callbacks: Box<CallbackFunctions>,
}

impl Slave {
    /// Unpacks an FMU and makes an instance of it.
    pub fn new(path: &Path, name: &str) -> Result<Self, Error> {
        let import: Fmi2Import = fmi::import::from_path(path).map_err(|error| {
            Error::Fmi(format!("{}: {error}; cargo run --release builds it", path.display()))
        })?;
        let description = import.model_description();
        let unusable = |what: &str| Error::Fmi(format!("{}: {what}", path.display()));
        let identifier =
            &description.co_simulation.as_ref().ok_or_else(|| unusable("no co-simulation"))?.model_identifier;
        let binding = import.binding(identifier).map_err(|error| unusable(&error.to_string()))?;
        let text = |text: &str| CString::new(text).map_err(|error| unusable(&error.to_string()));
        let (instance, guid) = (text(name)?, text(&description.guid)?);
        let resources = text(&import.canonical_resource_path_string())?;
        let callbacks = Box::<CallbackFunctions>::default();
        // SAFETY: the strings end with a zero and outlive the call. The callbacks have the layout of the C structure and
        // stay where they are until the instance is freed.
        let component = unsafe {
            binding.fmi2Instantiate(
                instance.as_ptr(),
                binding::fmi2Type_fmi2CoSimulation,
                guid.as_ptr(),
                resources.as_ptr(),
                ptr::from_ref(&*callbacks).cast(),
                0,
                0,
            )
        };
        if component.is_null() {
            return Err(unusable("it cannot be instantiated; see its messages"));
        }
        Ok(Self { binding, component, saved: ptr::null_mut(), import, _callbacks: callbacks })
    }

    /// Names and value references of its variables.
    pub fn variables(&self) -> impl Iterator<Item = (&str, u32)> {
        let variables = self.import.model_description().get_model_variables();
        variables.map(|variable| (variable.name.as_str(), variable.value_reference))
    }

    /// Value references of the states and of their rates.
    pub fn states(&self) -> (Vec<u32>, Vec<u32>) {
        let variables: Vec<_> = self.import.model_description().get_model_variables().collect();
        let rate = |variable: &_| match variable {
            fmi::fmi2::schema::ScalarVariable {
                elem: ScalarVariableElement::Real(real),
                value_reference,
                ..
            } => {
                // Counted from one.
                real.derivative.map(|state| (variables[state as usize - 1].value_reference, *value_reference))
            }
            _ => None,
        };
        variables.iter().copied().filter_map(rate).unzip()
    }

    /// Before the start, at 0 s.
    pub fn enter_initialization(&mut self) -> Result<(), Error> {
        // SAFETY: the instance is alive, here and below; slices are as long as the function is told.
        let status = unsafe { self.binding.fmi2SetupExperiment(self.component, 0, 0.0, 0.0, 0, 0.0) };
        self.done("fmi2SetupExperiment", status)?;
        // SAFETY: as above.
        let status = unsafe { self.binding.fmi2EnterInitializationMode(self.component) };
        self.done("fmi2EnterInitializationMode", status)
    }

    /// At the start.
    pub fn exit_initialization(&mut self) -> Result<(), Error> {
        // SAFETY: as above.
        let status = unsafe { self.binding.fmi2ExitInitializationMode(self.component) };
        self.done("fmi2ExitInitializationMode", status)
    }

    /// Values of variables.
    pub fn real(&self, references: &[u32]) -> Result<Vec<f64>, Error> {
        let mut values = vec![0.0; references.len()];
        let n = references.len();
        // SAFETY: as above.
        let status =
            unsafe { self.binding.fmi2GetReal(self.component, references.as_ptr(), n, values.as_mut_ptr()) };
        self.done("fmi2GetReal", status).map(|()| values)
    }

    /// Sets variables, one value for each.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        let n = references.len().min(values.len());
        // SAFETY: as above.
        let status =
            unsafe { self.binding.fmi2SetReal(self.component, references.as_ptr(), n, values.as_ptr()) };
        self.done("fmi2SetReal", status)
    }

    /// Sets derivatives of inputs with respect to time for the next step, one value for each.
    pub fn set_input_derivatives(
        &mut self,
        references: &[u32],
        order: i32,
        values: &[f64],
    ) -> Result<(), Error> {
        let n = references.len().min(values.len());
        let orders = vec![order; n];
        let (references, orders, values) = (references.as_ptr(), orders.as_ptr(), values.as_ptr());
        // SAFETY: as above.
        let status = unsafe {
            self.binding.fmi2SetRealInputDerivatives(self.component, references, n, orders, values)
        };
        self.done("fmi2SetRealInputDerivatives", status)
    }

    /// Slopes of outputs.
    pub fn slopes(&self, references: &[u32]) -> Result<Vec<f64>, Error> {
        let (mut values, orders) = (vec![0.0; references.len()], vec![1; references.len()]);
        let (references, n, orders) = (references.as_ptr(), references.len(), orders.as_ptr());
        // SAFETY: as above.
        let status = unsafe {
            self.binding.fmi2GetRealOutputDerivatives(
                self.component,
                references,
                n,
                orders,
                values.as_mut_ptr(),
            )
        };
        self.done("fmi2GetRealOutputDerivatives", status).map(|()| values)
    }

    /// Derivatives of `unknown` with respect to one known.
    pub fn derivatives(&self, unknown: &[u32], known: u32) -> Result<Vec<f64>, Error> {
        let mut values = vec![0.0; unknown.len()];
        let (references, n) = (unknown.as_ptr(), unknown.len());
        // SAFETY: as above; there is one known and one seed.
        let status = unsafe {
            self.binding.fmi2GetDirectionalDerivative(
                self.component,
                references,
                n,
                &known,
                1,
                &1.0,
                values.as_mut_ptr(),
            )
        };
        self.done("fmi2GetDirectionalDerivative", status).map(|()| values)
    }

    /// Takes a step; `last` says that no earlier state will be asked for.
    pub fn step(&mut self, time: f64, size: f64, last: bool) -> Result<(), Error> {
        // SAFETY: as above.
        let status = unsafe { self.binding.fmi2DoStep(self.component, time, size, i32::from(last)) };
        self.done("fmi2DoStep", status)
    }

    /// Keeps the state, in the place of the one before.
    pub fn save(&mut self) -> Result<(), Error> {
        // SAFETY: as above; the state is null or of this instance.
        let status = unsafe { self.binding.fmi2GetFMUstate(self.component, &mut self.saved) };
        self.done("fmi2GetFMUstate", status)
    }

    /// Back to the state that was kept.
    pub fn rewind(&mut self) -> Result<(), Error> {
        // SAFETY: as above.
        let status = unsafe { self.binding.fmi2SetFMUstate(self.component, self.saved) };
        self.done("fmi2SetFMUstate", status)
    }

    fn done(&self, function: &str, status: binding::fmi2Status) -> Result<(), Error> {
        match status {
            binding::fmi2Status_fmi2OK | binding::fmi2Status_fmi2Warning => Ok(()),
            _ => {
                let name = &self.import.model_description().model_name;
                Err(Error::Fmi(format!("{name}: {function} has failed (status {status}); see its messages")))
            }
        }
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        // SAFETY: the instance is alive until the last call; its state is freed before it, its library after it.
        unsafe {
            if !self.saved.is_null() {
                self.binding.fmi2FreeFMUstate(self.component, &mut self.saved);
            }
            self.binding.fmi2FreeInstance(self.component);
        }
    }
}
