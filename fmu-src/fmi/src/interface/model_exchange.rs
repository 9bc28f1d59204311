//! What an outside integrator needs.

use strut_model::{Array, Model, Simulation};

use super::{
    instance::{Instance, call},
    log::Failure,
    pointer::{slice, slice_mut},
    state::{Function, Phase},
    types::{Component, Real, Size, Status},
};

/// Enters Event Mode.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses.
pub unsafe fn enter_event_mode<M: Model>(function: &Function, component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Event);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// What an update of the discrete states leads to. The states never jump, and no model wants to end the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// Another one is due.
    pub again: bool,
    /// When the next event is.
    pub next: Option<f64>,
}

/// Makes the tick that is due, if one is.
pub fn update<M: Model>(instance: &mut Instance<M>) -> Result<Update, Failure> {
    let next = instance.simulation.event()?;
    // A host that went past a tick makes up for it by further calls.
    let again = next.is_some_and(|next| next <= instance.simulation.time());
    Ok(Update { again, next })
}

/// Enters Continuous-Time Mode.
///
/// # Safety
/// As for [`enter_event_mode`].
pub unsafe fn enter_continuous_time_mode<M: Model>(function: &Function, component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::Continuous);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Sets the time.
///
/// # Safety
/// As for [`enter_event_mode`].
pub unsafe fn set_time<M: Model>(function: &Function, component: Component, time: Real) -> Status {
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
    unsafe { call(component, function, body) }
}

/// Sets the continuous states.
///
/// # Safety
/// As for [`enter_event_mode`]; the array is null or of length `n`.
pub unsafe fn set_continuous_states<M: Model>(
    function: &Function,
    component: Component,
    states: *const Real,
    n: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        Ok(instance.simulation.set_states(unsafe { slice(states, n, "x") }?)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Reads the derivatives of the continuous states. They are discarded if they are not finite, so that a host may try a shorter step.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_derivatives<M: Model>(
    function: &Function,
    component: Component,
    rates: *mut Real,
    n: Size,
) -> Status {
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
    unsafe { call(component, function, body) }
}

/// Reads the event indicators.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_event_indicators<M: Model>(
    function: &Function,
    component: Component,
    indicators: *mut Real,
    n: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.origin.event_indicators, "ni")?;
        // SAFETY: by the caller.
        Ok(instance.simulation.event_indicators(unsafe { slice_mut(indicators, n, "eventIndicators") }?)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Reads the continuous states.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_continuous_states<M: Model>(
    function: &Function,
    component: Component,
    states: *mut Real,
    n: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        count(n, instance.simulation.states().len(), "nx")?;
        // SAFETY: by the caller.
        unsafe { slice_mut(states, n, "x") }?.copy_from_slice(instance.simulation.states());
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Reads typical magnitudes of the continuous states.
///
/// # Safety
/// As for [`set_continuous_states`].
pub unsafe fn get_nominals_of_continuous_states<M: Model>(
    function: &Function,
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
    unsafe { call(component, function, body) }
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
