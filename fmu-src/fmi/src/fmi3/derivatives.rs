//! Derivatives of some variables by others, and of outputs by time.

use strut_model::Model;

use super::{
    references::{Number, check_count},
    state_table as table,
    types::{Component, Real, Size, Status, ValueReference},
};
use crate::interface::{
    instance::{Instance, call},
    log::Failure,
    pointer::{slice, slice_mut},
};

/// What derivatives are taken with respect to: a variable, or time.
fn knowns<M: Model>(
    instance: &Instance<M>,
    references: &[ValueReference],
) -> Result<Vec<Option<u32>>, Failure> {
    let mut knowns = Vec::with_capacity(references.len());
    for reference in references {
        match instance.number(*reference)? {
            Number::Reals(first, length) => knowns.extend((first..).take(length).map(Some)),
            Number::Time => knowns.push(None),
            Number::Indicator(_) => {
                return Err(Failure::error(format!(
                    "value reference {reference} is an event indicator: no derivatives are taken with respect to it"
                )));
            }
        }
    }
    Ok(knowns)
}

/// Refuses seeds that are not finite.
fn check_seed(seed: &[Real]) -> Result<(), Failure> {
    match seed.iter().find(|number| !number.is_finite()) {
        Some(wrong) => Err(Failure::error(format!("seed contains {wrong}: give finite numbers"))),
        None => Ok(()),
    }
}

/// Unknowns, knowns, seed and sensitivity with their lengths, as C hands them over.
type Arguments =
    ((*const ValueReference, Size), (*const ValueReference, Size), (*const Real, Size), (*mut Real, Size));

/// The arrays behind the arguments.
///
/// # Safety
/// As for [`get_directional_derivative`].
#[expect(clippy::type_complexity, reason = "four arrays, named in the lines above")]
unsafe fn arrays<'a>(
    (unknowns, knowns, seed, sensitivity): Arguments,
) -> Result<(&'a [ValueReference], &'a [ValueReference], &'a [Real], &'a mut [Real]), Failure> {
    // SAFETY: by the caller.
    unsafe {
        let (unknowns, knowns) =
            (slice(unknowns.0, unknowns.1, "unknowns")?, slice(knowns.0, knowns.1, "knowns")?);
        let (seed, sensitivity) =
            (slice(seed.0, seed.1, "seed")?, slice_mut(sensitivity.0, sensitivity.1, "sensitivity")?);
        check_seed(seed)?;
        Ok((unknowns, knowns, seed, sensitivity))
    }
}

/// `fmi3GetDirectionalDerivative`: the Jacobian times the seed, exactly.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; arrays are null or of the given lengths.
#[allow(clippy::too_many_arguments, reason = "the standard has them")]
pub unsafe fn get_directional_derivative<M: Model>(
    component: Component,
    unknowns: *const ValueReference,
    n_unknowns: Size,
    known: *const ValueReference,
    n_knowns: Size,
    seed: *const Real,
    n_seed: Size,
    sensitivity: *mut Real,
    n_sensitivity: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let arguments =
            ((unknowns, n_unknowns), (known, n_knowns), (seed, n_seed), (sensitivity, n_sensitivity));
        // SAFETY: by the caller.
        let (unknowns, references, seed, sensitivity) = unsafe { arrays(arguments) }?;
        let unknowns = instance.reals(unknowns, n_sensitivity)?;
        let knowns = knowns(instance, references)?;
        check_count(n_seed, knowns.len())?;
        let (mut variables, mut seeds, mut time) = (Vec::new(), Vec::new(), 0.0);
        for (known, seed) in knowns.iter().zip(seed) {
            match known {
                Some(reference) => {
                    variables.push(*reference);
                    seeds.push(*seed);
                }
                None => time += seed,
            }
        }
        Ok(instance.simulation.directional_derivative(&unknowns, (&variables, &seeds), time, sensitivity)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_DIRECTIONAL_DERIVATIVE, body) }
}

/// `fmi3GetAdjointDerivative`: the seed times the Jacobian, exactly; one column of it after the other.
///
/// # Safety
/// As for [`get_directional_derivative`].
#[allow(clippy::too_many_arguments, reason = "the standard has them")]
pub unsafe fn get_adjoint_derivative<M: Model>(
    component: Component,
    unknowns: *const ValueReference,
    n_unknowns: Size,
    known: *const ValueReference,
    n_knowns: Size,
    seed: *const Real,
    n_seed: Size,
    sensitivity: *mut Real,
    n_sensitivity: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let arguments =
            ((unknowns, n_unknowns), (known, n_knowns), (seed, n_seed), (sensitivity, n_sensitivity));
        // SAFETY: by the caller.
        let (unknowns, references, seed, sensitivity) = unsafe { arrays(arguments) }?;
        let unknowns = instance.reals(unknowns, n_seed)?;
        let knowns = knowns(instance, references)?;
        check_count(n_sensitivity, knowns.len())?;
        let mut column = vec![0.0; unknowns.len()];
        for (known, sensitivity) in knowns.iter().zip(sensitivity) {
            let (variable, time) =
                known.as_ref().map_or((&[][..], 1.0), |it| (std::slice::from_ref(it), 0.0));
            let one = &[1.0][..variable.len()];
            instance.simulation.directional_derivative(&unknowns, (variable, one), time, &mut column)?;
            *sensitivity = column.iter().zip(seed).map(|(slope, seed)| slope * seed).sum();
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_ADJOINT_DERIVATIVE, body) }
}

/// `fmi3GetOutputDerivatives`.
///
/// # Safety
/// As for [`get_directional_derivative`].
pub unsafe fn get_output_derivatives<M: Model>(
    component: Component,
    references: *const ValueReference,
    n: Size,
    orders: *const i32,
    values: *mut Real,
    n_values: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (references, orders, values) = unsafe {
            (
                slice(references, n, "valueReferences")?,
                slice(orders, n, "orders")?,
                slice_mut(values, n_values, "values")?,
            )
        };
        let (mut variables, mut each) = (Vec::new(), Vec::new());
        for (reference, order) in references.iter().zip(orders) {
            let Number::Reals(first, length) = instance.number(*reference)? else {
                return Err(Failure::error(format!("value reference {reference} is no output")));
            };
            variables.extend((first..).take(length));
            each.extend(std::iter::repeat_n(*order, length));
        }
        check_count(n_values, variables.len())?;
        Ok(instance.simulation.output_derivatives(&variables, &each, values)?)
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::GET_OUTPUT_DERIVATIVES, body) }
}
