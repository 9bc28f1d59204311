//! Steps, and what a host may ask about them.

use std::mem::MaybeUninit;

use strut_model::Model;

use super::{
    state_table::{self as table, FMI_2},
    types::{
        Boolean, Component, FALSE, Integer, RawStatusKind, Real, Size, Status, StatusKind, Text,
        ValueReference,
    },
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    pointer::{one, slice, slice_mut},
    state::{Function, Phase},
    steps,
};

/// `fmi2SetRealInputDerivatives`.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; arrays are null or of
/// length `n`.
pub unsafe fn set_real_input_derivatives<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, orders, values) =
            unsafe { (slice(references, n, "vr")?, slice(orders, n, "order")?, slice(values, n, "value")?) };
        Ok(instance.simulation.set_input_derivatives(references, orders, values)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_REAL_INPUT_DERIVATIVES, body) }
}

/// `fmi2GetRealOutputDerivatives`.
///
/// # Safety
/// As for [`set_real_input_derivatives`].
pub unsafe fn get_real_output_derivatives<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, orders, values) = unsafe {
            (slice(references, n, "vr")?, slice(orders, n, "order")?, slice_mut(values, n, "value")?)
        };
        Ok(instance.simulation.output_derivatives(references, orders, values)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_REAL_OUTPUT_DERIVATIVES, body) }
}

/// `fmi2DoStep`. A step that cannot be integrated is discarded: everything is as before it, and a state
/// saved there may be restored to try a shorter one.
///
/// # Safety
/// As for [`set_real_input_derivatives`].
#[inline]
pub unsafe fn do_step<M: Model>(
    component: Component,
    point: Real,
    size: Real,
    _no_set_state: Boolean,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let made = steps::do_step(instance, &FMI_2, point, size);
        if let Err(Failure { status: Status::Discard, .. }) = made {
            instance.enter(Phase::StepFailed);
        }
        made
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::DO_STEP, body) }
}

/// `fmi2CancelStep`, of which there is never a legal call.
///
/// # Safety
/// As for [`set_real_input_derivatives`].
pub unsafe fn cancel_step<M: Model>(component: Component) -> Status {
    // SAFETY: by the caller.
    unsafe { call::<M>(component, &table::CANCEL_STEP, |_| Ok(())) }
}

/// Answers one of the status functions.
///
/// # Safety
/// As for [`set_real_input_derivatives`]; the place of the answer is null or may be written.
unsafe fn status<M: Model, T>(
    component: Component,
    function: &Function,
    kind: RawStatusKind,
    value: *mut T,
    answer: impl Fn(&Instance<M>, StatusKind) -> Option<T>,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let value = unsafe { one(value.cast::<MaybeUninit<T>>(), "value") }?;
        let asked = StatusKind::from_raw(kind)
            .ok_or_else(|| Failure::error(format!("status kind {kind} is unknown: give 0 to 3")))?;
        let answer = answer(instance, asked).ok_or_else(|| Failure {
            status: Status::Discard,
            message: match asked {
                StatusKind::LastSuccessfulTime => "ask fmi2GetRealStatus for the last successful time".into(),
                StatusKind::Terminated => "ask fmi2GetBooleanStatus whether the instance wants to end".into(),
                StatusKind::DoStepStatus | StatusKind::PendingStatus => {
                    "a step has always ended when fmi2DoStep returns: use the status that it returned".into()
                }
            },
        })?;
        value.write(answer);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// `fmi2GetStatus`.
///
/// # Safety
/// As for [`set_real_input_derivatives`]; the place of the answer is null or may be written.
pub unsafe fn get_status<M: Model>(component: Component, kind: RawStatusKind, value: *mut Status) -> Status {
    // SAFETY: by the caller.
    unsafe { status::<M, _>(component, &table::GET_STATUS, kind, value, |_, _| None) }
}

/// `fmi2GetRealStatus`.
///
/// # Safety
/// As for [`get_status`].
pub unsafe fn get_real_status<M: Model>(
    component: Component,
    kind: RawStatusKind,
    value: *mut Real,
) -> Status {
    let answer = |instance: &Instance<M>, kind| {
        (kind == StatusKind::LastSuccessfulTime).then(|| instance.simulation.time())
    };
    // SAFETY: by the caller.
    unsafe { status(component, &table::GET_REAL_STATUS, kind, value, answer) }
}

/// `fmi2GetIntegerStatus`.
///
/// # Safety
/// As for [`get_status`].
pub unsafe fn get_integer_status<M: Model>(
    component: Component,
    kind: RawStatusKind,
    value: *mut Integer,
) -> Status {
    // SAFETY: by the caller.
    unsafe { status::<M, _>(component, &table::GET_INTEGER_STATUS, kind, value, |_, _| None) }
}

/// `fmi2GetBooleanStatus`: no model ever wants to end the simulation.
///
/// # Safety
/// As for [`get_status`].
pub unsafe fn get_boolean_status<M: Model>(
    component: Component,
    kind: RawStatusKind,
    value: *mut Boolean,
) -> Status {
    let answer = |_: &Instance<M>, kind| (kind == StatusKind::Terminated).then_some(FALSE);
    // SAFETY: by the caller.
    unsafe { status(component, &table::GET_BOOLEAN_STATUS, kind, value, answer) }
}

/// `fmi2GetStringStatus`.
///
/// # Safety
/// As for [`get_status`].
pub unsafe fn get_string_status<M: Model>(
    component: Component,
    kind: RawStatusKind,
    value: *mut Text,
) -> Status {
    // SAFETY: by the caller.
    unsafe { status::<M, _>(component, &table::GET_STRING_STATUS, kind, value, |_, _| None) }
}
