//! Events, and what an outside integrator needs in its own form of FMI 3.0.

use strut_model::Model;

use super::{
    state_table as table,
    types::{Boolean, Component, FALSE, Real, Size, Status},
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    model_exchange::{Update, update},
    pointer::one,
    state::{Function, Phase},
};

/// `fmi3EnterEventMode`. In co-simulation the host has said at instantiation that it would.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses.
pub unsafe fn enter_event_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        if !instance.handles.events {
            return Err(Failure::error(
                "the instance was made without Event Mode: give eventModeUsed = fmi3True to \
                 fmi3InstantiateCoSimulation",
            ));
        }
        instance.enter(Phase::Event);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_EVENT_MODE, body) }
}

/// `fmi3UpdateDiscreteStates`: makes the tick that is due, if one is.
///
/// # Safety
/// As for [`enter_event_mode`]; the answers are null or may be written.
pub unsafe fn update_discrete_states<M: Model>(
    component: Component,
    again_needed: *mut Boolean,
    terminate: *mut Boolean,
    nominals_changed: *mut Boolean,
    states_changed: *mut Boolean,
    next_defined: *mut Boolean,
    next_time: *mut Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (again_needed, terminate, nominals, states, defined, time) = unsafe {
            (
                one(again_needed, "discreteStatesNeedUpdate")?,
                one(terminate, "terminateSimulation")?,
                one(nominals_changed, "nominalsOfContinuousStatesChanged")?,
                one(states_changed, "valuesOfContinuousStatesChanged")?,
                one(next_defined, "nextEventTimeDefined")?,
                one(next_time, "nextEventTime")?,
            )
        };
        let Update { again, next } = update(instance)?;
        (*again_needed, *terminate, *nominals, *states) = (Boolean::from(again), FALSE, FALSE, FALSE);
        (*defined, *time) = (Boolean::from(next.is_some()), next.unwrap_or(0.0));
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::UPDATE_DISCRETE_STATES, body) }
}

/// `fmi3CompletedIntegratorStep`: events are announced by their times and indicators, none is found by a step.
///
/// # Safety
/// As for [`update_discrete_states`].
pub unsafe fn completed_integrator_step<M: Model>(
    component: Component,
    _no_set_state: Boolean,
    enter_event_mode: *mut Boolean,
    terminate: *mut Boolean,
) -> Status {
    let body = |_: &mut Instance<M>| {
        // SAFETY: by the caller.
        unsafe {
            *one(enter_event_mode, "enterEventMode")? = FALSE;
            *one(terminate, "terminateSimulation")? = FALSE;
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::COMPLETED_INTEGRATOR_STEP, body) }
}

/// Tells a number.
///
/// # Safety
/// As for [`update_discrete_states`].
unsafe fn count<M: Model>(
    function: &Function,
    component: Component,
    (number, name): (*mut Size, &str),
    of: impl FnOnce(&Instance<M>) -> usize,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        *unsafe { one(number, name) }? = of(instance);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// `fmi3GetNumberOfContinuousStates`.
///
/// # Safety
/// As for [`update_discrete_states`].
pub unsafe fn get_number_of_continuous_states<M: Model>(component: Component, number: *mut Size) -> Status {
    let (function, number) = (&table::GET_NUMBER_OF_CONTINUOUS_STATES, (number, "nContinuousStates"));
    // SAFETY: by the caller.
    unsafe { count::<M>(function, component, number, |instance| instance.simulation.states().len()) }
}

/// `fmi3GetNumberOfEventIndicators`.
///
/// # Safety
/// As for [`update_discrete_states`].
pub unsafe fn get_number_of_event_indicators<M: Model>(component: Component, number: *mut Size) -> Status {
    let (function, number) = (&table::GET_NUMBER_OF_EVENT_INDICATORS, (number, "nEventIndicators"));
    // SAFETY: by the caller.
    unsafe { count::<M>(function, component, number, |instance| instance.origin.event_indicators) }
}
