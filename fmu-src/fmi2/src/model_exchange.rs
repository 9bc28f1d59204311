//! What an outside integrator needs.

use strut_model::{Array, Model, Simulation};

use crate::{
    instance::{Instance, call},
    log::Failure,
    pointer::{one, slice, slice_mut},
    state_table::{self as table, Phase},
    types::{Boolean, Component, EventInfo, FALSE, Real, Size, Status, TRUE},
};

/// `fmi2EnterEventMode`.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses.
pub unsafe fn enter_event_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Event);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_EVENT_MODE, body) }
}

/// `fmi2NewDiscreteStates`: makes the tick that is due, if one is. The states never jump.
///
/// # Safety
/// As for [`enter_event_mode`]; the event info is null or may be written.
pub unsafe fn new_discrete_states<M: Model>(component: Component, info: *mut EventInfo) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let info = unsafe { one(info, "eventInfo") }?;
        let next = instance.simulation.event()?;
        // A host that went past a tick makes up for it by further calls.
        let late = next.is_some_and(|next| next <= instance.simulation.time());
        *info = EventInfo {
            new_discrete_states_needed: Boolean::from(late),
            terminate_simulation: FALSE,
            nominals_of_continuous_states_changed: FALSE,
            values_of_continuous_states_changed: FALSE,
            next_event_time_defined: if next.is_some() { TRUE } else { FALSE },
            next_event_time: next.unwrap_or(0.0),
        };
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::NEW_DISCRETE_STATES, body) }
}

/// `fmi2EnterContinuousTimeMode`.
///
/// # Safety
/// As for [`enter_event_mode`].
pub unsafe fn enter_continuous_time_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Continuous);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_CONTINUOUS_TIME_MODE, body) }
}

/// `fmi2CompletedIntegratorStep`: events are announced by their times, none is found by a step.
///
/// # Safety
/// As for [`enter_event_mode`]; the answers are null or may be written.
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

/// `fmi2SetTime`.
///
/// # Safety
/// As for [`enter_event_mode`].
pub unsafe fn set_time<M: Model>(component: Component, time: Real) -> Status {
    let body = |instance: &mut Instance<M>| {
        if !time.is_finite() {
            return Err(Failure::error(format!(
                "the time cannot be {time}: give a finite number of seconds"
            )));
        }
        instance.simulation.set_time(time);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_TIME, body) }
}

/// `fmi2SetContinuousStates`.
///
/// # Safety
/// As for [`enter_event_mode`]; the array is null or of length `n`.
pub unsafe fn set_continuous_states<M: Model>(component: Component, states: *const Real, n: Size) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        Ok(instance.simulation.set_states(unsafe { slice(states, n, "x") }?)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_CONTINUOUS_STATES, body) }
}

/// `fmi2GetDerivatives`. They are discarded if they are not finite, so that a host may try a shorter step.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_derivatives<M: Model>(component: Component, rates: *mut Real, n: Size) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        let rates = unsafe { slice_mut(rates, n, "derivatives") }?;
        rates.copy_from_slice(instance.simulation.rates()?);
        match rates.iter().position(|rate| !rate.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Failure {
                status: Status::Discard,
                message: format!(
                    "the derivative of state {index} is {} at {} s: make a shorter step, or check inputs and parameters",
                    rates[index],
                    instance.simulation.time()
                ),
            }),
        }
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_DERIVATIVES, body) }
}

/// `fmi2GetEventIndicators`.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_event_indicators<M: Model>(component: Component, indicators: *mut Real, n: Size) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.origin.event_indicators, "ni")?;
        // SAFETY: by the caller.
        Ok(instance.simulation.event_indicators(unsafe { slice_mut(indicators, n, "eventIndicators") }?)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_EVENT_INDICATORS, body) }
}

/// `fmi2GetContinuousStates`.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_continuous_states<M: Model>(component: Component, states: *mut Real, n: Size) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        unsafe { slice_mut(states, n, "x") }?.copy_from_slice(instance.simulation.states());
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_CONTINUOUS_STATES, body) }
}

/// `fmi2GetNominalsOfContinuousStates`.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_nominals_of_continuous_states<M: Model>(
    component: Component,
    nominals: *mut Real,
    n: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        unsafe { slice_mut(nominals, n, "x_nominal") }?
            .copy_from_slice(Simulation::<M>::nominals().as_slice());
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_NOMINALS_OF_CONTINUOUS_STATES, body) }
}

/// Refuses a length that is not the model's.
fn count(given: Size, right: usize, name: &str) -> Result<(), Failure> {
    if given == right {
        return Ok(());
    }
    Err(Failure::error(format!(
        "{name} = {given}, but this model has {right}: see ModelStructure in modelDescription.xml"
    )))
}
