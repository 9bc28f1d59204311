//! What an outside integrator needs in its own form of FMI 2.0.

use strut_model::Model;

use super::{
    state_table as table,
    types::{Boolean, Component, EventInfo, FALSE, Status},
};
use crate::interface::{
    instance::{Instance, call},
    model_exchange::{Update, update},
    pointer::one,
};

/// `fmi2NewDiscreteStates`: makes the tick that is due, if one is.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; the event info is null or may be written.
pub unsafe fn new_discrete_states<M: Model>(component: Component, info: *mut EventInfo) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let info = unsafe { one(info, "eventInfo") }?;
        let Update { again, next } = update(instance)?;
        *info = EventInfo {
            new_discrete_states_needed: Boolean::from(again),
            terminate_simulation: FALSE,
            nominals_of_continuous_states_changed: FALSE,
            values_of_continuous_states_changed: FALSE,
            next_event_time_defined: Boolean::from(next.is_some()),
            next_event_time: next.unwrap_or(0.0),
        };
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::NEW_DISCRETE_STATES, body) }
}

/// `fmi2CompletedIntegratorStep`: events are announced by their times, none is found by a step.
///
/// # Safety
/// As for [`new_discrete_states`]; the answers are null or may be written.
pub unsafe fn completed_integrator_step<M: Model>(
    component: Component,
    _no_set_state: Boolean,
    enter_event_mode: *mut Boolean,
    terminate_simulation: *mut Boolean,
) -> Status {
    let body = |_: &mut Instance<M>| {
        // SAFETY: by the caller.
        unsafe {
            *one(enter_event_mode, "enterEventMode")? = FALSE;
            *one(terminate_simulation, "terminateSimulation")? = FALSE;
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::COMPLETED_INTEGRATOR_STEP, body) }
}
