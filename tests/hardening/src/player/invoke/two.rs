//! The calls that only FMI 2.0 has.

use std::ffi::CStr;
use std::ptr;

use strut_fmi::fmi2::types::{Boolean, Component, EventInfo, FALSE, Status, TRUE, Text};

use super::{Outcome, both, first, last, last_mut, place, text};
use crate::api::Two;
use crate::call::{Action, Null};
use crate::package::Kind;

/// Makes a call.
///
/// # Safety
/// The component is null or an instance of this version.
pub unsafe fn invoke(two: &Two, c: Component, time: f64, action: &Action) -> Outcome {
    use Action as A;
    let (mut real, mut integer, mut complete) = (f64::NAN, 7, true);
    let split = |values: &[(u32, i32)]| -> (Vec<u32>, Vec<i32>) { values.iter().copied().unzip() };
    // SAFETY: by the caller; pointers are null or to living arrays of the length that is given.
    let status = unsafe {
        match action {
            A::SetDebugLogging { on, categories, null } => {
                let texts: Vec<Text> = categories.iter().map(text).collect();
                (two.set_debug_logging)(c, Boolean::from(*on), texts.len(), first(both(*null), &texts))
            }
            A::SetupExperiment { tolerance, start, stop } => (two.setup_experiment)(
                c,
                Boolean::from(tolerance.is_some()),
                tolerance.unwrap_or(f64::NAN),
                *start,
                Boolean::from(stop.is_some()),
                stop.unwrap_or(f64::NAN),
            ),
            A::EnterInitializationMode => (two.enter_initialization_mode)(c),
            A::Get { kind, references, null } => {
                let (vr, n) = (first(*null, references), references.len());
                match kind {
                    Kind::Real => {
                        let mut values = vec![f64::NAN; n];
                        (two.get_real)(c, vr, n, last_mut(*null, &mut values))
                    }
                    Kind::Integer | Kind::Choice => {
                        let mut values = vec![0; n];
                        (two.get_integer)(c, vr, n, last_mut(*null, &mut values))
                    }
                    Kind::Boolean => {
                        let mut values = vec![FALSE; n];
                        let status = (two.get_boolean)(c, vr, n, last_mut(*null, &mut values));
                        integer = values.into_iter().max().unwrap_or(FALSE);
                        status
                    }
                    Kind::Text => {
                        let mut values = vec![ptr::null(); n];
                        let status = (two.get_string)(c, vr, n, last_mut(*null, &mut values));
                        // Read to their ends, for memory checkers.
                        complete = status != Status::Ok
                            || values
                                .iter()
                                .all(|text| !text.is_null() && CStr::from_ptr(*text).to_str().is_ok());
                        status
                    }
                }
            }
            A::SetReal { values, null } => {
                let (vr, values): (Vec<_>, Vec<_>) = values.iter().copied().unzip();
                (two.set_real)(c, first(*null, &vr), vr.len(), last(*null, &values))
            }
            A::SetInteger { values, null, .. } => {
                let (vr, values) = split(values);
                (two.set_integer)(c, first(*null, &vr), vr.len(), last(*null, &values))
            }
            A::SetBoolean { values, null } => {
                let (vr, values) = split(values);
                (two.set_boolean)(c, first(*null, &vr), vr.len(), last(*null, &values))
            }
            A::SetString { values, null } => {
                let vr: Vec<u32> = values.iter().map(|(reference, _)| *reference).collect();
                let texts: Vec<Text> = values.iter().map(|(_, value)| text(value)).collect();
                (two.set_string)(c, first(*null, &vr), vr.len(), last(*null, &texts))
            }
            A::GetDirectionalDerivative { unknowns, knowns, null } => {
                let (known, seed): (Vec<_>, Vec<_>) = knowns.iter().copied().unzip();
                let mut result = vec![f64::NAN; unknowns.len()];
                (two.get_directional_derivative)(
                    c,
                    first(*null, unknowns),
                    unknowns.len(),
                    known.as_ptr(),
                    known.len(),
                    seed.as_ptr(),
                    last_mut(*null, &mut result),
                )
            }
            A::NewDiscreteStates { null } => {
                let mut info = EventInfo {
                    new_discrete_states_needed: FALSE,
                    terminate_simulation: FALSE,
                    nominals_of_continuous_states_changed: FALSE,
                    values_of_continuous_states_changed: FALSE,
                    next_event_time_defined: FALSE,
                    next_event_time: 0.0,
                };
                (two.new_discrete_states)(c, place(*null, &mut info))
            }
            A::CompletedIntegratorStep { null } => {
                let (mut event, mut end) = (FALSE, FALSE);
                let event = if *null == Null::First { ptr::null_mut() } else { &raw mut event };
                let end = if *null == Null::Last { ptr::null_mut() } else { &raw mut end };
                (two.completed_integrator_step)(c, TRUE, event, end)
            }
            A::SetRealInputDerivatives { values, null } => {
                let vr: Vec<u32> = values.iter().map(|(reference, _, _)| *reference).collect();
                let orders: Vec<i32> = values.iter().map(|(_, order, _)| *order).collect();
                let values: Vec<f64> = values.iter().map(|(_, _, value)| *value).collect();
                (two.set_real_input_derivatives)(
                    c,
                    first(*null, &vr),
                    vr.len(),
                    orders.as_ptr(),
                    last(*null, &values),
                )
            }
            A::GetRealOutputDerivatives { orders, null } => {
                let (vr, orders) = split(orders);
                let mut values = vec![f64::NAN; vr.len()];
                (two.get_real_output_derivatives)(
                    c,
                    first(*null, &vr),
                    vr.len(),
                    orders.as_ptr(),
                    last_mut(*null, &mut values),
                )
            }
            A::DoStep { offset, size } => (two.do_step)(c, time + offset, *size, TRUE),
            A::CancelStep => (two.cancel_step)(c),
            A::GetStatus { kind, null } => {
                let mut value = Status::Ok;
                (two.get_status)(c, *kind, place(*null, &mut value))
            }
            A::GetRealStatus { kind, null } => (two.get_real_status)(c, *kind, place(*null, &mut real)),
            A::GetIntegerStatus { kind, null } => {
                (two.get_integer_status)(c, *kind, place(*null, &mut integer))
            }
            A::GetBooleanStatus { kind, null } => {
                (two.get_boolean_status)(c, *kind, place(*null, &mut integer))
            }
            A::GetStringStatus { kind, null } => {
                let mut value = ptr::null();
                (two.get_string_status)(c, *kind, place(*null, &mut value))
            }
            _ => unreachable!("both versions have it, or the other one"),
        }
    };
    Outcome { status, real, integer, complete, early: false }
}
