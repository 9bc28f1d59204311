//! From `fmi2Instantiate` to the simulation.

use std::ffi::c_void;

use strut_model::Model;

use super::{
    log::log,
    state_table::{self as table, FMI_2},
    types::{Boolean, CallbackFunctions, Component, FALSE, RawType, Real, Status, Text},
};
use crate::interface::{
    instance::{Handles, Instance, call},
    life_cycle,
    log::Failure,
    pointer,
    resources::Origin,
    state::{Kind, Phase},
    to_path,
};

/// `fmi2GetTypesPlatform`.
pub fn types_platform() -> Text {
    c"default".as_ptr()
}

/// `fmi2GetVersion`.
pub fn version() -> Text {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`. Errors go to the logger, if there is one.
///
/// # Safety
/// Texts are null or end with a zero; the callbacks are null or of their declared types.
pub unsafe fn instantiate<M: Model>(
    name: Text,
    kind: RawType,
    guid: Text,
    resources: Text,
    callbacks: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> Component {
    // SAFETY: by the caller. Without callbacks there is nobody to tell that they are missing.
    let Ok([callbacks]) = (unsafe { pointer::slice(callbacks, 1, "functions") }) else {
        return std::ptr::null_mut();
    };
    let start = || {
        let kind = match kind {
            0 => Kind::ModelExchange,
            1 => Kind::CoSimulation,
            _ => {
                return Err(Failure::error(format!(
                    "fmuType {kind} is unknown: give 0 (model exchange) or 1 (co-simulation)"
                )));
            }
        };
        // SAFETY: by the caller.
        let guid = pointer::utf8(unsafe { pointer::text(guid, "fmuGUID") }?, "fmuGUID")?;
        // SAFETY: by the caller.
        let location = unsafe { pointer::optional(resources, "fmuResourceLocation") }?;
        let folder = location.map(to_path).transpose().map_err(Failure::error)?;
        let origin = Origin::find::<M>(guid, folder, instantiate::<M> as *const c_void)?;
        Ok((kind, Handles::default(), origin))
    };
    let log = |name| log(callbacks, name, logging_on != FALSE);
    // SAFETY: by the caller.
    unsafe { life_cycle::instantiate::<M>((&FMI_2, "fmi2Instantiate"), name, log, start) }
}

/// `fmi2SetDebugLogging`. Of the categories only discarded steps and the integration's cost are debug
/// messages; the others are always logged.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; there are `n` categories that end with a zero.
pub unsafe fn set_debug_logging<M: Model>(
    component: Component,
    logging_on: Boolean,
    n: usize,
    categories: *const Text,
) -> Status {
    let on = logging_on != FALSE;
    // SAFETY: by the caller.
    unsafe { life_cycle::set_debug_logging::<M>(&table::SET_DEBUG_LOGGING, component, on, n, categories) }
}

/// `fmi2SetupExperiment`. A tolerance that no solver could keep is left aside with a warning.
///
/// # Safety
/// The component is as for [`set_debug_logging`].
pub unsafe fn setup_experiment<M: Model>(
    component: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
        life_cycle::set_up(instance, tolerance, start, (stop_defined != FALSE).then_some(stop))
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SETUP_EXPERIMENT, body) }
}

/// `fmi2EnterInitializationMode`.
///
/// # Safety
/// The component is as for [`set_debug_logging`].
pub unsafe fn enter_initialization_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Initialization);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_INITIALIZATION_MODE, body) }
}
