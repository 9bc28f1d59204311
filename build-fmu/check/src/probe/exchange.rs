//! What model exchange calls at every step. The functions of an integration are looked up once: that takes longer than
//! many a model's equations.

#![allow(unsafe_code)]

use std::ffi::c_int;

use super::library::{ABSENT, Component, Instance, Library, Status, call};

type Get = unsafe extern "C" fn(Component, *const u32, usize, *mut f64) -> Status;
type Set = unsafe extern "C" fn(Component, *const u32, usize, *const f64) -> Status;
type GetAll = unsafe extern "C" fn(Component, *mut f64, usize) -> Status;
type SetAll = unsafe extern "C" fn(Component, *const f64, usize) -> Status;
type SetTime = unsafe extern "C" fn(Component, f64) -> Status;

/// Functions of a library, as far as it has them.
pub struct Functions {
    get: Option<Get>,
    set: Option<Set>,
    rates: Option<GetAll>,
    set_states: Option<SetAll>,
    set_time: Option<SetTime>,
}

impl Functions {
    /// Those of a library; they are not called once it is gone.
    pub fn of(library: &libloading::Library) -> Self {
        macro_rules! found {
            ($name:literal) => {
                // SAFETY: the function has the type that the standard gives it.
                unsafe { library.get($name) }.ok().map(|symbol| *symbol)
            };
        }
        Self {
            get: found!("fmi2GetReal"),
            set: found!("fmi2SetReal"),
            rates: found!("fmi2GetDerivatives"),
            set_states: found!("fmi2SetContinuousStates"),
            set_time: found!("fmi2SetTime"),
        }
    }
}

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Default)]
struct EventInfo {
    again: c_int,
    terminate: c_int,
    nominals_changed: c_int,
    states_changed: c_int,
    next_event_defined: c_int,
    next_event: f64,
}

/// What an event left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Discrete {
    /// Whether it wants to be asked again.
    pub again: bool,
    /// Whether the simulation is to be ended.
    pub terminate: bool,
    /// Time of the next event, if it is known.
    pub next_event: Option<f64>,
}

impl Library {
    /// `fmi2GetReal`.
    pub fn reals(&self, instance: Instance, references: &[u32], values: &mut [f64]) -> Status {
        let count = references.len().min(values.len());
        let Some(function) = self.exchange.get else { return ABSENT };
        // SAFETY: both arrays have that many elements.
        unsafe { function(instance.0, references.as_ptr(), count, values.as_mut_ptr()) }
    }

    /// `fmi2SetReal`.
    pub fn set_reals(&self, instance: Instance, references: &[u32], values: &[f64]) -> Status {
        let count = references.len().min(values.len());
        let Some(function) = self.exchange.set else { return ABSENT };
        // SAFETY: as above.
        unsafe { function(instance.0, references.as_ptr(), count, values.as_ptr()) }
    }

    /// `fmi2GetDerivatives`.
    pub fn rates(&self, instance: Instance, rates: &mut [f64]) -> Status {
        let Some(function) = self.exchange.rates else { return ABSENT };
        // SAFETY: the array has that many elements.
        unsafe { function(instance.0, rates.as_mut_ptr(), rates.len()) }
    }

    /// `fmi2SetContinuousStates`.
    pub fn set_states(&self, instance: Instance, values: &[f64]) -> Status {
        let Some(function) = self.exchange.set_states else { return ABSENT };
        // SAFETY: as above.
        unsafe { function(instance.0, values.as_ptr(), values.len()) }
    }

    /// `fmi2SetTime`.
    pub fn set_time(&self, instance: Instance, time: f64) -> Status {
        let Some(function) = self.exchange.set_time else { return ABSENT };
        // SAFETY: it has a number as its only argument.
        unsafe { function(instance.0, time) }
    }

    /// A function that writes an array: `fmi2GetContinuousStates` and its like.
    pub fn array(&self, function: &str, instance: Instance, values: &mut [f64]) -> Status {
        call!(self.library, function, instance, (*mut f64, usize), values.as_mut_ptr(), values.len())
    }

    /// `fmi2GetDirectionalDerivative` towards one known.
    pub fn directional(
        &self,
        instance: Instance,
        unknowns: &[u32],
        known: u32,
        values: &mut [f64],
    ) -> Status {
        let (seed, count) = (1.0, unknowns.len().min(values.len()));
        call!(
            self.library,
            "fmi2GetDirectionalDerivative",
            instance,
            (*const u32, usize, *const u32, usize, *const f64, *mut f64),
            unknowns.as_ptr(),
            count,
            &raw const known,
            1,
            &raw const seed,
            values.as_mut_ptr()
        )
    }

    /// `fmi2NewDiscreteStates`.
    pub fn new_discrete_states(&self, instance: Instance) -> (Status, Discrete) {
        let mut info = EventInfo::default();
        let status = call!(self.library, "fmi2NewDiscreteStates", instance, (*mut EventInfo), &raw mut info);
        let next_event = (info.next_event_defined != 0).then_some(info.next_event);
        (status, Discrete { again: info.again != 0, terminate: info.terminate != 0, next_event })
    }

    /// `fmi2CompletedIntegratorStep`: whether events are to be handled.
    pub fn completed_step(&self, instance: Instance) -> (Status, bool) {
        let (mut event, mut terminate) = (0, 0);
        let status = call!(
            self.library,
            "fmi2CompletedIntegratorStep",
            instance,
            (c_int, *mut c_int, *mut c_int),
            1,
            &raw mut event,
            &raw mut terminate
        );
        (status, event != 0)
    }
}
