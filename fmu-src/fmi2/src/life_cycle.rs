//! From `fmi2Instantiate` to `fmi2FreeInstance`.

use std::{
    ffi::{CString, c_void},
    panic::{AssertUnwindSafe, catch_unwind},
    ptr,
};

use strut_model::{Error, LOG_CATEGORIES, Model, Simulation};

use crate::{
    instance::{Instance, call, fatal},
    log::{Debugging, Failure, Log},
    pointer,
    resources::Origin,
    state_table::{self as table, Kind, Phase, State},
    types::{Boolean, CallbackFunctions, Component, FALSE, RawType, Real, Size, Status, Text},
};

/// `fmi2GetTypesPlatform`.
pub fn types_platform() -> Text {
    c"default".as_ptr()
}

/// `fmi2GetVersion`.
pub fn version() -> Text {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`. What is wrong is told through the logger, if there is one.
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
        return ptr::null_mut();
    };
    let library = instantiate::<M> as *const c_void;
    let make = AssertUnwindSafe(|| {
        // SAFETY: by the caller.
        let name = unsafe { pointer::text(name, "instanceName") };
        let log = Log::new(
            callbacks,
            name.as_ref().map_or_else(|_| CString::default(), |name| (*name).into()),
            Debugging::all(logging_on != FALSE),
        );
        let instance = name.and_then(|name| {
            if name.is_empty() {
                return Err(Failure::error("instanceName is empty: give the instance a name"));
            }
            let kind = Kind::from_raw(kind).ok_or_else(|| {
                Failure::error(format!(
                    "fmuType {kind} is unknown: give 0 (model exchange) or 1 (co-simulation)"
                ))
            })?;
            // SAFETY: by the caller.
            let origin = unsafe { Origin::find::<M>(guid, resources, library) }?;
            let log = Log::new(callbacks, name.into(), log.debug);
            Instance::<M>::new(State::new(kind, Phase::Instantiated), origin, log)
        });
        match instance {
            Ok(instance) => instance.into_component(),
            Err(failure) => {
                log.tell("fmi2Instantiate", &failure);
                ptr::null_mut()
            }
        }
    });
    catch_unwind(make).unwrap_or_else(|panic| {
        Log::new(callbacks, CString::default(), Debugging::all(true))
            .tell("fmi2Instantiate", &fatal(panic.as_ref()));
        ptr::null_mut()
    })
}

/// `fmi2FreeInstance`. States that the host has saved and not freed go with the instance.
///
/// # Safety
/// The component is null or came from [`instantiate`], and is not used afterwards.
pub unsafe fn free_instance<M: Model>(component: Component) {
    // SAFETY: by the caller.
    unsafe { Instance::<M>::free(component) }
}

/// `fmi2SetDebugLogging`. Of the categories only discarded steps and the integration's cost are debug
/// messages; the others are always told.
///
/// # Safety
/// The component is as for [`free_instance`]; there are `n` categories that end with a zero.
pub unsafe fn set_debug_logging<M: Model>(
    component: Component,
    logging_on: Boolean,
    n: Size,
    categories: *const Text,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let mut concerned = Debugging::all(n == 0);
        // SAFETY: by the caller.
        for category in unsafe { pointer::slice(categories, n, "categories") }? {
            // SAFETY: by the caller.
            let category = unsafe { pointer::text(*category, "a category") }?;
            if !LOG_CATEGORIES.iter().any(|(name, _)| name.as_bytes() == category.to_bytes()) {
                let names: Vec<&str> = LOG_CATEGORIES.iter().map(|(name, _)| *name).collect();
                return Err(Failure::error(format!(
                    "category {category:?} is unknown: give any of {}",
                    names.join(", ")
                )));
            }
            concerned.discards |= category == c"logAll" || category == c"logStatusDiscard";
            concerned.solver |= category == c"logAll" || category == c"logSolver";
        }
        let debug = &mut instance.log.debug;
        if concerned.discards {
            debug.discards = logging_on != FALSE;
        }
        if concerned.solver {
            debug.solver = logging_on != FALSE;
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_DEBUG_LOGGING, body) }
}

/// `fmi2SetupExperiment`. A tolerance that no solver could keep is left aside with a warning.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn setup_experiment<M: Model>(
    component: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let stop = if stop_defined == FALSE { f64::INFINITY } else { stop };
        // Not a number is not greater either.
        if start.is_finite() && (stop.is_nan() || stop <= start) {
            return Err(Failure::error(format!(
                "the stop time {stop} s does not come after the start time {start} s: give a later one, or none"
            )));
        }
        instance.simulation.set_up(start, None)?;
        instance.stop = stop;
        if tolerance_defined == FALSE {
            return Ok(());
        }
        instance.simulation.set_up(start, Some(tolerance)).map_err(|error| Failure {
            status: Status::Warning,
            message: format!("the tolerance {tolerance} is not used: {error}"),
        })
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SETUP_EXPERIMENT, body) }
}

/// `fmi2EnterInitializationMode`.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn enter_initialization_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Initialization);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_INITIALIZATION_MODE, body) }
}

/// `fmi2ExitInitializationMode`. If the model refuses its parameters, initialization goes on, so that
/// they may be mended.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn exit_initialization_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.simulation.initialize()?;
        instance.enter(match instance.state.kind() {
            Kind::ModelExchange => Phase::Event,
            Kind::CoSimulation => Phase::StepComplete,
        });
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::EXIT_INITIALIZATION_MODE, body) }
}

/// `fmi2Terminate`. Tells what the integration has cost, if debug logging of it is on.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn terminate<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        if instance.state.kind() == Kind::CoSimulation && !instance.simulation.states().is_empty() {
            instance.log.tell_cost("fmi2Terminate", instance.simulation.work());
        }
        instance.enter(Phase::Terminated);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::TERMINATE, body) }
}

/// `fmi2Reset`: everything is as after `fmi2Instantiate`, but that saved states stay the host's.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn reset<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        let Instance { origin, .. } = &*instance;
        let fresh = Simulation::new(origin.set.as_ref(), origin.resources.as_deref());
        instance.simulation = fresh.map_err(|error: Error| Failure::error(error.to_string()))?;
        instance.stop = f64::INFINITY;
        instance.log.debug = instance.debug_at_first;
        instance.strings.clear();
        instance.enter(Phase::Instantiated);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::RESET, body) }
}
