//! Steps of a co-simulation.

use strut_model::Model;

use super::{
    state_table::{self as table, FMI_3},
    types::{Boolean, Component, FALSE, Real, Status},
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    pointer::one,
    state::Phase,
    steps,
};

/// `fmi3EnterStepMode`.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses.
pub unsafe fn enter_step_mode<M: Model>(component: Component) -> Status {
    let body = |instance: &mut Instance<M>| {
        instance.enter(Phase::StepComplete);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_STEP_MODE, body) }
}

/// `fmi3DoStep`. A step that cannot be integrated is discarded: everything is as before it.
///
/// A host that handles events and early return gets a step to each tick, to handle it in Event Mode; for any other one the
/// ticks on the way are made inside the step. A tick at the end is the next step's, or that of the Event Mode in between.
///
/// # Safety
/// As for [`enter_step_mode`]; the answers are null or may be written.
#[allow(clippy::too_many_arguments, reason = "the standard has them")]
#[inline]
pub unsafe fn do_step<M: Model>(
    component: Component,
    point: Real,
    size: Real,
    _no_set_state: Boolean,
    event_needed: *mut Boolean,
    terminate: *mut Boolean,
    early_return: *mut Boolean,
    reached: *mut Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (event_needed, terminate, early_return, reached) = unsafe {
            (
                one(event_needed, "eventHandlingNeeded")?,
                one(terminate, "terminateSimulation")?,
                one(early_return, "earlyReturn")?,
                one(reached, "lastSuccessfulTime")?,
            )
        };
        let (event, early) = if instance.handles.events {
            step_among_events(instance, point, size)?
        } else {
            steps::do_step(instance, &FMI_3, point, size)?;
            (false, false)
        };
        (*event_needed, *terminate, *early_return) = (Boolean::from(event), FALSE, Boolean::from(early));
        *reached = instance.simulation.time();
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::DO_STEP, body) }
}

/// Makes a step for a host that handles events; returns whether an event is due then, and whether the step ended early.
#[inline(never)]
fn step_among_events<M: Model>(
    instance: &mut Instance<M>,
    point: Real,
    size: Real,
) -> Result<(bool, bool), Failure> {
    let end = point + size;
    steps::check_end(instance, &FMI_3, point, size)?;
    // A step that is refused is refused as a whole.
    let early = instance.handles.early_return && end.is_finite();
    let tick = if early { instance.simulation.tick_before(end)?.filter(|tick| *tick > point) } else { None };
    steps::do_step(instance, &FMI_3, point, tick.map_or(size, |tick| tick - point))?;
    Ok((instance.simulation.is_tick_due(), tick.is_some()))
}
