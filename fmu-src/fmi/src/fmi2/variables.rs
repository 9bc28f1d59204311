//! Reading and writing variables, and derivatives of some by others.

use strut_model::{Model, Value};

use super::{
    state_table as table,
    types::{Boolean, Component, Integer, Real, Size, Status, Text, ValueReference},
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    pointer::{slice, slice_mut, text, utf8},
    state::Function,
    variables::{hand_out, read},
};

/// `fmi2GetReal`. In the state Instantiated it reads start values: nothing is calculated yet.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; arrays are null or of
/// length `n`.
#[inline]
pub unsafe fn get_real<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) = unsafe { (slice(references, n, "vr")?, slice_mut(values, n, "value")?) };
        read(instance, references, values)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_REAL, body) }
}

/// `fmi2SetReal`. If a value is refused, those before it are set.
///
/// # Safety
/// As for [`get_real`].
#[inline]
pub unsafe fn set_real<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) = unsafe { (slice(references, n, "vr")?, slice(values, n, "value")?) };
        Ok(instance.simulation.set_real(references, values, instance.access())?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_REAL, body) }
}

/// Reads settings; `pick` takes a value of the kind that was asked for.
///
/// # Safety
/// As for [`get_real`].
unsafe fn get<M: Model, T>(
    component: Component,
    function: &Function,
    arrays: (*const ValueReference, Size, *mut T),
    kind: &'static str,
    pick: impl Fn(Value) -> Option<T>,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let (references, n, values) = arrays;
        // SAFETY: by the caller.
        let (references, values) = unsafe { (slice(references, n, "vr")?, slice_mut(values, n, "value")?) };
        for (reference, value) in references.iter().zip(values) {
            if let Some(found) = pick(instance.simulation.setting(*reference, kind)?) {
                *value = found;
            }
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Writes settings.
///
/// # Safety
/// As for [`get_real`].
unsafe fn set<M: Model, T: Copy>(
    component: Component,
    function: &Function,
    arrays: (*const ValueReference, Size, *const T),
    wrap: impl Fn(T) -> Result<Value, Failure>,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let (references, n, values) = arrays;
        // SAFETY: by the caller.
        let (references, values) = unsafe { (slice(references, n, "vr")?, slice(values, n, "value")?) };
        for (reference, value) in references.iter().zip(values) {
            instance.simulation.set_setting(*reference, wrap(*value)?, instance.access())?;
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// `fmi2GetInteger`; enumerations are integers, too.
///
/// # Safety
/// As for [`get_real`].
pub unsafe fn get_integer<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Integer,
) -> Status {
    let pick = |value| if let Value::Integer(number) = value { Some(number) } else { None };
    // SAFETY: by the caller.
    unsafe { get::<M, _>(component, &table::GET_INTEGER, (references, n, values), "integer", pick) }
}

/// `fmi2SetInteger`.
///
/// # Safety
/// As for [`get_real`].
pub unsafe fn set_integer<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Integer,
) -> Status {
    // SAFETY: by the caller.
    unsafe {
        set::<M, _>(component, &table::SET_INTEGER, (references, n, values), |value| {
            Ok(Value::Integer(value))
        })
    }
}

/// `fmi2GetBoolean`.
///
/// # Safety
/// As for [`get_real`].
pub unsafe fn get_boolean<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Boolean,
) -> Status {
    let pick = |value| if let Value::Boolean(flag) = value { Some(Boolean::from(flag)) } else { None };
    // SAFETY: by the caller.
    unsafe { get::<M, _>(component, &table::GET_BOOLEAN, (references, n, values), "boolean", pick) }
}

/// `fmi2SetBoolean`; anything but zero is true.
///
/// # Safety
/// As for [`get_real`].
pub unsafe fn set_boolean<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Boolean,
) -> Status {
    let wrap = |value| Ok(Value::Boolean(value != 0));
    // SAFETY: by the caller.
    unsafe { set::<M, _>(component, &table::SET_BOOLEAN, (references, n, values), wrap) }
}

/// `fmi2GetString`. The strings live until the next `fmi2GetString` or `fmi2Reset`.
///
/// # Safety
/// As for [`get_real`].
pub unsafe fn get_string<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Text,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) = unsafe { (slice(references, n, "vr")?, slice_mut(values, n, "value")?) };
        hand_out(instance, references.iter().map(|reference| Ok(*reference)), values)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_STRING, body) }
}

/// `fmi2SetString`.
///
/// # Safety
/// As for [`get_real`]; the texts are null or end with a zero.
pub unsafe fn set_string<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Text,
) -> Status {
    // SAFETY: by the caller.
    let wrap = |value| Ok(Value::Text(utf8(unsafe { text(value, "a string") }?, "a string")?.to_owned()));
    // SAFETY: by the caller.
    unsafe { set::<M, _>(component, &table::SET_STRING, (references, n, values), wrap) }
}

/// `fmi2GetDirectionalDerivative`.
///
/// # Safety
/// As for [`get_real`], with the lengths of unknowns and of knowns.
pub unsafe fn get_directional_derivative<M: Model>(
    component: Component,
    unknowns: *const ValueReference,
    n_unknowns: Size,
    knowns: *const ValueReference,
    n_knowns: Size,
    seed: *const Real,
    sensitivity: *mut Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (unknowns, sensitivity) = unsafe {
            (slice(unknowns, n_unknowns, "vUnknown_ref")?, slice_mut(sensitivity, n_unknowns, "dvUnknown")?)
        };
        // SAFETY: by the caller.
        let (knowns, seed) =
            unsafe { (slice(knowns, n_knowns, "vKnown_ref")?, slice(seed, n_knowns, "dvKnown")?) };
        if let Some(wrong) = seed.iter().find(|number| !number.is_finite()) {
            return Err(Failure::error(format!("dvKnown contains {wrong}: give finite numbers")));
        }
        Ok(instance.simulation.directional_derivative(unknowns, (knowns, seed), 0.0, sensitivity)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_DIRECTIONAL_DERIVATIVE, body) }
}
