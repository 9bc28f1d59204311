//! From instantiation to the end.

use std::{
    ffi::CString,
    panic::{AssertUnwindSafe, catch_unwind},
    ptr,
};

use strut_model::{Error, LOG_CATEGORIES, Model, Simulation};

use super::{
    instance::{Handles, Instance, call, fatal},
    log::{Failure, Log},
    pointer,
    resources::Origin,
    state::{Function, Kind, Phase, Version},
    types::{Component, Real, Size, Status, Text},
};

/// Makes an instance of what `start` says. Errors go to the log that `log` makes for an instance's name.
///
/// # Safety
/// The name is null or ends with a zero.
pub unsafe fn instantiate<M: Model>(
    (version, function): (&Version, &str),
    name: Text,
    log: impl Fn(CString) -> Log,
    start: impl FnOnce() -> Result<(Kind, Handles, Origin), Failure>,
) -> Component {
    let make = AssertUnwindSafe(|| {
        // SAFETY: by the caller.
        let name = unsafe { pointer::text(name, "instanceName") };
        let told = name.as_ref().map_or_else(|_| CString::default(), |name| (*name).into());
        let instance = name.and_then(|name| {
            if name.is_empty() {
                return Err(Failure::error("instanceName is empty: give the instance a name"));
            }
            let (kind, handles, origin) = start()?;
            Instance::<M>::new(version, (kind, handles), origin, log(name.into()))
        });
        match instance {
            Ok(instance) => instance.into_component(),
            Err(failure) => {
                log(told).tell(function, &failure);
                ptr::null_mut()
            }
        }
    });
    catch_unwind(make).unwrap_or_else(|panic| {
        log(CString::default()).tell(function, &fatal(version, panic.as_ref()));
        ptr::null_mut()
    })
}

/// Frees an instance. States that the host has saved and not freed go with it.
///
/// # Safety
/// The component is null or came from [`instantiate`], and is not used afterwards.
pub unsafe fn free_instance<M: Model>(function: &Function, component: Component) {
    // SAFETY: by the caller.
    unsafe { Instance::<M>::free(component, function.version) }
}

/// Turns debug logging on or off. Errors are always logged.
///
/// # Safety
/// The component is as for [`free_instance`]; there are `n` categories that end with a zero.
pub unsafe fn set_debug_logging<M: Model>(
    function: &Function,
    component: Component,
    on: bool,
    n: Size,
    categories: *const Text,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let all = n == 0;
        let (mut warnings, mut discards, mut solver) = (all, all, all);
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
            let concerned = |name| category == c"logAll" || category == name;
            warnings |= concerned(c"logStatusWarning");
            discards |= concerned(c"logStatusDiscard");
            solver |= concerned(c"logSolver");
        }
        let debug = &mut instance.log.debug;
        let optional = warnings && function.version.optional_warnings;
        for (concerned, flag) in
            [(optional, &mut debug.warnings), (discards, &mut debug.discards), (solver, &mut debug.solver)]
        {
            if concerned {
                *flag = on;
            }
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Sets start time, stop time and tolerance. A tolerance that no solver could keep is left aside with a warning.
pub fn set_up<M: Model>(
    instance: &mut Instance<M>,
    tolerance: Option<Real>,
    start: Real,
    stop: Option<Real>,
) -> Result<(), Failure> {
    let stop = stop.unwrap_or(f64::INFINITY);
    // Not a number is not greater either.
    if start.is_finite() && (stop.is_nan() || stop <= start) {
        return Err(Failure::error(format!(
            "the stop time {stop} s does not come after the start time {start} s: give a later one, or none"
        )));
    }
    instance.simulation.set_up(start, None)?;
    instance.stop = stop;
    let Some(tolerance) = tolerance else { return Ok(()) };
    instance.simulation.set_up(start, Some(tolerance)).map_err(|error| Failure {
        status: Status::Warning,
        message: format!("the tolerance {tolerance} is not used: {error}"),
    })
}

/// Ends initialization. If the model refuses its parameters, initialization goes on, so that they may be mended.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn exit_initialization_mode<M: Model>(function: &Function, component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.simulation.initialize()?;
        instance.enter(match instance.state.kind() {
            Kind::CoSimulation if !instance.handles.events => Phase::StepComplete,
            Kind::CoSimulation | Kind::ModelExchange => Phase::Event,
        });
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Ends the simulation. Tells what the integration has cost, if debug logging of it is on.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn terminate<M: Model>(function: &Function, component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        if instance.state.kind() == Kind::CoSimulation && !instance.simulation.states().is_empty() {
            instance.log.tell_cost(function.name, instance.simulation.work());
        }
        instance.enter(Phase::Terminated);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Makes everything as it is after instantiation, but that saved states stay the host's.
///
/// # Safety
/// The component is as for [`free_instance`].
pub unsafe fn reset<M: Model>(function: &Function, component: Component) -> Status {
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
    unsafe { call(component, function, body) }
}
