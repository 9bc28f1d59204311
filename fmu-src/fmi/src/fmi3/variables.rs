//! Reading and writing variables.

use strut_model::{Model, Value};

use super::{
    references::{Number, check_count, unknown},
    state_table as table,
    types::{Boolean, Component, Real, Size, Status, Text, ValueReference},
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    pointer::{slice, slice_mut, text, utf8},
    state::{Function, Phase},
    variables::{hand_out, read},
};

/// `fmi3GetFloat64`. In the state Instantiated it reads start values: nothing is calculated yet.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; arrays are null or of the given lengths.
#[inline]
pub unsafe fn get_float64<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Real,
    n_values: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) =
            unsafe { (slice(references, n, "valueReferences")?, slice_mut(values, n_values, "values")?) };
        if instance.are_singles(references, n_values) {
            return read(instance, references, values);
        }
        read_arrays(instance, references, values)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_FLOAT64, body) }
}

/// Reads arrays, event indicators and time as well.
#[inline(never)]
fn read_arrays<M: Model>(
    instance: &mut Instance<M>,
    references: &[ValueReference],
    values: &mut [Real],
) -> Result<(), Failure> {
    let numbers = references.iter().map(|reference| instance.number(*reference));
    let numbers: Vec<Number> = numbers.collect::<Result<_, _>>()?;
    let length = |number: &Number| if let Number::Reals(_, length) = number { *length } else { 1 };
    check_count(values.len(), numbers.iter().map(length).sum())?;
    let mut indicators = Vec::new();
    if numbers.iter().any(|number| matches!(number, Number::Indicator(_))) {
        if instance.state.phase() == Phase::Instantiated {
            return Err(Failure::error(
                "event indicators are calculated and have no values yet: read them in Initialization Mode or later",
            ));
        }
        indicators.resize(instance.origin.event_indicators, 0.0);
        instance.simulation.event_indicators(&mut indicators)?;
    }
    let mut rest = values;
    for number in numbers {
        let (own, others) = rest.split_at_mut(length(&number));
        match number {
            Number::Reals(first, length) => {
                let references: Vec<u32> = (first..).take(length).collect();
                read(instance, &references, own)?;
            }
            Number::Indicator(index) => own[0] = indicators[index],
            Number::Time => own[0] = instance.simulation.time(),
        }
        rest = others;
    }
    Ok(())
}

/// `fmi3SetFloat64`. If a value is refused, those before it are set.
///
/// # Safety
/// As for [`get_float64`].
#[inline]
pub unsafe fn set_float64<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Real,
    n_values: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) =
            unsafe { (slice(references, n, "valueReferences")?, slice(values, n_values, "values")?) };
        if instance.are_singles(references, n_values) {
            return Ok(instance.simulation.set_real(references, values, instance.access())?);
        }
        set_arrays(instance, references, values)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::SET_FLOAT64, body) }
}

/// Sets arrays as well.
#[inline(never)]
fn set_arrays<M: Model>(
    instance: &mut Instance<M>,
    references: &[ValueReference],
    values: &[Real],
) -> Result<(), Failure> {
    let references = instance.reals(references, values.len())?;
    Ok(instance.simulation.set_real(&references, values, instance.access())?)
}

/// A type of settings.
struct Type {
    /// Name in FMI 3.0.
    name: &'static str,
    /// Name of the model's values.
    kind: &'static str,
    /// Whether it has to be an enumeration, of those that are integers.
    choice: Option<bool>,
}

const INT32: Type = Type { name: "Int32", kind: "integer", choice: Some(false) };
const ENUMERATION: Type = Type { name: "Enumeration", kind: "integer", choice: Some(true) };
const BOOLEAN: Type = Type { name: "Boolean", kind: "boolean", choice: None };
const STRING: Type = Type { name: "String", kind: "string", choice: None };

impl Type {
    /// The setting of a reference, if it is one of this type.
    fn setting<M: Model>(&self, instance: &Instance<M>, reference: ValueReference) -> Result<u32, Failure> {
        let setting = instance.setting_of(reference, self.name, self.choice)?;
        match instance.simulation.setting(setting, self.kind) {
            Ok(_) => Ok(setting),
            Err(_) => Err(unknown::<M>(reference, self.name)),
        }
    }
}

/// Reads settings; `pick` takes a value of the type.
///
/// # Safety
/// As for [`get_float64`].
unsafe fn get<M: Model, T>(
    (component, function, of): (Component, &Function, &Type),
    arrays: (*const ValueReference, Size, *mut T, Size),
    pick: impl Fn(Value) -> Option<T>,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let (references, n, values, n_values) = arrays;
        // SAFETY: by the caller.
        let (references, values) =
            unsafe { (slice(references, n, "valueReferences")?, slice_mut(values, n_values, "values")?) };
        check_count(n_values, n)?;
        for (reference, value) in references.iter().zip(values) {
            let setting = of.setting(instance, *reference)?;
            if let Some(found) = pick(instance.simulation.setting(setting, of.kind)?) {
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
/// As for [`get_float64`].
unsafe fn set<M: Model, T: Copy>(
    (component, function, of): (Component, &Function, &Type),
    arrays: (*const ValueReference, Size, *const T, Size),
    wrap: impl Fn(T) -> Result<Value, Failure>,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let (references, n, values, n_values) = arrays;
        // SAFETY: by the caller.
        let (references, values) =
            unsafe { (slice(references, n, "valueReferences")?, slice(values, n_values, "values")?) };
        check_count(n_values, n)?;
        for (reference, value) in references.iter().zip(values) {
            let setting = of.setting(instance, *reference)?;
            instance.simulation.set_setting(setting, wrap(*value)?, instance.access())?;
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// `fmi3GetInt32`.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn get_int32<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut i32,
    n_values: Size,
) -> Status {
    let pick = |value| if let Value::Integer(number) = value { Some(number) } else { None };
    let which = (component, &table::GET_INT32, &INT32);
    // SAFETY: by the caller.
    unsafe { get::<M, _>(which, (references, n, values, n_values), pick) }
}

/// `fmi3SetInt32`.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn set_int32<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const i32,
    n_values: Size,
) -> Status {
    let which = (component, &table::SET_INT32, &INT32);
    // SAFETY: by the caller.
    unsafe { set::<M, _>(which, (references, n, values, n_values), |value| Ok(Value::Integer(value))) }
}

/// `fmi3GetInt64`: enumerations.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn get_int64<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut i64,
    n_values: Size,
) -> Status {
    let pick = |value| if let Value::Integer(number) = value { Some(number.into()) } else { None };
    let which = (component, &table::GET_INT64, &ENUMERATION);
    // SAFETY: by the caller.
    unsafe { get::<M, _>(which, (references, n, values, n_values), pick) }
}

/// `fmi3SetInt64`: enumerations.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn set_int64<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const i64,
    n_values: Size,
) -> Status {
    // No enumeration has so many items: what does not fit is no item either.
    let wrap = |value: i64| Ok(Value::Integer(i32::try_from(value).unwrap_or(i32::MIN)));
    let which = (component, &table::SET_INT64, &ENUMERATION);
    // SAFETY: by the caller.
    unsafe { set::<M, _>(which, (references, n, values, n_values), wrap) }
}

/// `fmi3GetBoolean`.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn get_boolean<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Boolean,
    n_values: Size,
) -> Status {
    let pick = |value| if let Value::Boolean(flag) = value { Some(Boolean::from(flag)) } else { None };
    let which = (component, &table::GET_BOOLEAN, &BOOLEAN);
    // SAFETY: by the caller.
    unsafe { get::<M, _>(which, (references, n, values, n_values), pick) }
}

/// `fmi3SetBoolean`; anything but zero is true.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn set_boolean<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Boolean,
    n_values: Size,
) -> Status {
    let which = (component, &table::SET_BOOLEAN, &BOOLEAN);
    // SAFETY: by the caller.
    unsafe { set::<M, _>(which, (references, n, values, n_values), |value| Ok(Value::Boolean(value != 0))) }
}

/// `fmi3GetString`. The strings live until the next `fmi3GetString` or `fmi3Reset`.
///
/// # Safety
/// As for [`get_float64`].
pub unsafe fn get_string<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *mut Text,
    n_values: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, values) =
            unsafe { (slice(references, n, "valueReferences")?, slice_mut(values, n_values, "values")?) };
        check_count(n_values, n)?;
        let settings: Vec<_> =
            references.iter().map(|reference| STRING.setting(instance, *reference)).collect();
        hand_out(instance, settings.into_iter(), values)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_STRING, body) }
}

/// `fmi3SetString`.
///
/// # Safety
/// As for [`get_float64`]; the texts are null or end with a zero.
pub unsafe fn set_string<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    values: *const Text,
    n_values: Size,
) -> Status {
    // SAFETY: by the caller.
    let wrap = |value| Ok(Value::Text(utf8(unsafe { text(value, "a string") }?, "a string")?.to_owned()));
    let which = (component, &table::SET_STRING, &STRING);
    // SAFETY: by the caller.
    unsafe { set::<M, _>(which, (references, n, values, n_values), wrap) }
}

/// Reads or writes variables of a type that no FMU has: none is all right.
///
/// # Safety
/// The component is as for [`get_float64`].
pub unsafe fn absent<M: Model>(function: &Function, component: Component, n: Size) -> Status {
    let body = |_: &mut Instance<M>| {
        if n == 0 {
            return Ok(());
        }
        Err(Failure::error(format!(
            "{} has no variables of this type; see modelDescription.xml",
            M::ABOUT.name
        )))
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// A function that is never legal.
///
/// # Safety
/// The component is as for [`get_float64`].
pub unsafe fn never<M: Model>(function: &Function, component: Component) -> Status {
    // SAFETY: by the caller.
    unsafe { call::<M>(component, function, |_| Ok(())) }
}
