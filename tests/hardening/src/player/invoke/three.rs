//! The calls that only FMI 3.0 has. Every number of values is the right one for its variables: that wrong ones are refused is
//! tested elsewhere.

use std::ffi::CStr;
use std::ptr;

use strut_fmi::fmi3::types::{Component, FALSE, Real, Status, TRUE, Text};

use super::{Outcome, both, first, last, last_mut, place, text};
use crate::api::Three;
use crate::call::{Action, Null};
use crate::package::{Kind, Package};

/// A value for each element of an array.
fn expanded(package: &Package, values: &[(u32, Real)]) -> (Vec<u32>, Vec<Real>) {
    let references = values.iter().map(|(reference, _)| *reference).collect();
    let each = |(reference, value): &(u32, Real)| std::iter::repeat_n(*value, package.length(*reference));
    (references, values.iter().flat_map(each).collect())
}

/// Makes a call.
///
/// # Safety
/// The component is null or an instance of this version.
pub unsafe fn invoke(three: &Three, package: &Package, c: Component, time: f64, action: &Action) -> Outcome {
    use Action as A;
    let mut outcome = Outcome::of(Status::Ok);
    // SAFETY: by the caller; pointers are null or to living arrays of the length that is given.
    outcome.status = unsafe {
        match action {
            A::SetDebugLogging { on, categories, null } => {
                let texts: Vec<Text> = categories.iter().map(text).collect();
                (three.set_debug_logging)(c, u8::from(*on), texts.len(), first(both(*null), &texts))
            }
            A::SetupExperiment { tolerance, start, stop } => {
                let [tolerance, stop] =
                    [tolerance, stop].map(|it| (u8::from(it.is_some()), it.unwrap_or(f64::NAN)));
                (three.enter_initialization_mode)(c, tolerance.0, tolerance.1, *start, stop.0, stop.1)
            }
            A::Get { kind, references, null } => {
                let (vr, n) = (first(*null, references), references.len());
                match kind {
                    Kind::Real => {
                        let mut values = vec![f64::NAN; package.values(references)];
                        (three.get_float64)(c, vr, n, last_mut(*null, &mut values), values.len())
                    }
                    Kind::Integer => {
                        let mut values = vec![0; n];
                        (three.get_int32)(c, vr, n, last_mut(*null, &mut values), n)
                    }
                    Kind::Choice => {
                        let mut values = vec![0; n];
                        (three.get_int64)(c, vr, n, last_mut(*null, &mut values), n)
                    }
                    Kind::Boolean => {
                        let mut values = vec![FALSE; n];
                        let status = (three.get_boolean)(c, vr, n, last_mut(*null, &mut values), n);
                        outcome.integer = values.into_iter().max().unwrap_or(FALSE).into();
                        status
                    }
                    Kind::Text => {
                        let mut values = vec![ptr::null(); n];
                        let status = (three.get_string)(c, vr, n, last_mut(*null, &mut values), n);
                        // Read to their ends, for memory checkers.
                        let is_text = |text: &Text| !text.is_null() && CStr::from_ptr(*text).to_str().is_ok();
                        outcome.complete = status != Status::Ok || values.iter().all(is_text);
                        status
                    }
                }
            }
            A::SetReal { values, null } => {
                let (vr, values) = expanded(package, values);
                (three.set_float64)(c, first(*null, &vr), vr.len(), last(*null, &values), values.len())
            }
            A::SetInteger { kind: Kind::Choice, values, null } => {
                let (vr, values): (Vec<u32>, Vec<i64>) =
                    values.iter().map(|(reference, value)| (*reference, i64::from(*value))).unzip();
                (three.set_int64)(c, first(*null, &vr), vr.len(), last(*null, &values), values.len())
            }
            A::SetInteger { values, null, .. } => {
                let (vr, values): (Vec<u32>, Vec<i32>) = values.iter().copied().unzip();
                (three.set_int32)(c, first(*null, &vr), vr.len(), last(*null, &values), values.len())
            }
            A::SetBoolean { values, null } => {
                let (vr, values): (Vec<u32>, Vec<u8>) =
                    values.iter().map(|(reference, value)| (*reference, value.to_le_bytes()[0])).unzip();
                (three.set_boolean)(c, first(*null, &vr), vr.len(), last(*null, &values), values.len())
            }
            A::SetString { values, null } => {
                let vr: Vec<u32> = values.iter().map(|(reference, _)| *reference).collect();
                let texts: Vec<Text> = values.iter().map(|(_, value)| text(value)).collect();
                (three.set_string)(c, first(*null, &vr), vr.len(), last(*null, &texts), texts.len())
            }
            A::GetDirectionalDerivative { unknowns, knowns, null } => {
                let (known, seed) = expanded(package, knowns);
                let mut result = vec![f64::NAN; package.values(unknowns)];
                (three.get_directional_derivative)(
                    c,
                    first(*null, unknowns),
                    unknowns.len(),
                    known.as_ptr(),
                    known.len(),
                    seed.as_ptr(),
                    seed.len(),
                    last_mut(*null, &mut result),
                    result.len(),
                )
            }
            A::GetAdjointDerivative { unknowns, knowns, null } => {
                let (unknown, seed) = expanded(package, unknowns);
                let mut result = vec![f64::NAN; package.values(knowns)];
                (three.get_adjoint_derivative)(
                    c,
                    first(*null, &unknown),
                    unknown.len(),
                    knowns.as_ptr(),
                    knowns.len(),
                    seed.as_ptr(),
                    seed.len(),
                    last_mut(*null, &mut result),
                    result.len(),
                )
            }
            A::NewDiscreteStates { null } => {
                let (mut flags, mut next) = ([7; 5], f64::NAN);
                let [again, end, nominals, states, defined] = &mut flags;
                let first = if *null == Null::First { ptr::null_mut() } else { again };
                let last = if *null == Null::Last { ptr::null_mut() } else { &raw mut next };
                (three.update_discrete_states)(c, first, end, nominals, states, defined, last)
            }
            A::CompletedIntegratorStep { null } => {
                let (mut event, mut end) = (FALSE, FALSE);
                let event = if *null == Null::First { ptr::null_mut() } else { &raw mut event };
                let end = if *null == Null::Last { ptr::null_mut() } else { &raw mut end };
                (three.completed_integrator_step)(c, TRUE, event, end)
            }
            A::GetRealOutputDerivatives { orders, null } => {
                let (vr, orders): (Vec<u32>, Vec<i32>) = orders.iter().copied().unzip();
                let mut values = vec![f64::NAN; package.values(&vr)];
                (three.get_output_derivatives)(
                    c,
                    first(*null, &vr),
                    vr.len(),
                    orders.as_ptr(),
                    last_mut(*null, &mut values),
                    values.len(),
                )
            }
            A::DoStep { offset, size } => {
                let [mut event, mut end, mut early] = [7_u8; 3];
                let (point, reached) = (time + offset, &raw mut outcome.real);
                let status =
                    (three.do_step)(c, point, *size, TRUE, &mut event, &mut end, &mut early, reached);
                outcome.early = early == TRUE;
                status
            }
            A::GetNumberOfContinuousStates { null } => {
                let mut number = 0;
                (three.get_number_of_continuous_states)(c, place(*null, &mut number))
            }
            A::GetUInt16 { references } => {
                let (n, mut values) = (references.len(), vec![0; references.len()]);
                (three.get_uint16)(c, references.as_ptr(), n, values.as_mut_ptr(), n)
            }
            A::SetFloat32 { references } => {
                let (n, values) = (references.len(), vec![0.0; references.len()]);
                (three.set_float32)(c, references.as_ptr(), n, values.as_ptr(), n)
            }
            A::EnterConfigurationMode => (three.enter_configuration_mode)(c),
            A::EvaluateDiscreteStates => (three.evaluate_discrete_states)(c),
            A::EnterStepMode => (three.enter_step_mode)(c),
            _ => unreachable!("both versions have it, or the other one"),
        }
    };
    outcome
}
