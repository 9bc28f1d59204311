//! From a call as a value to a call in C.

use std::ffi::{CStr, CString};
use std::ptr;

use strut_fmi::fmi2::types::*;

use super::{Blob, Player};
use crate::call::{Action, Damage, Null, STATES};
use crate::package::Kind;

/// What came back.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// The status.
    pub status: Status,
    /// A number that was asked for.
    pub real: f64,
    /// Another.
    pub integer: i32,
    /// Whether every text that was asked for is one.
    pub complete: bool,
}

fn first<T>(null: Null, values: &[T]) -> *const T {
    if null == Null::First { ptr::null() } else { values.as_ptr() }
}

fn last<T>(null: Null, values: &[T]) -> *const T {
    if null == Null::Last { ptr::null() } else { values.as_ptr() }
}

fn last_mut<T>(null: Null, values: &mut [T]) -> *mut T {
    if null == Null::Last { ptr::null_mut() } else { values.as_mut_ptr() }
}

/// The place of a single answer.
fn place<T>(null: Null, value: &mut T) -> *mut T {
    if null == Null::None { value } else { ptr::null_mut() }
}

impl Player<'_> {
    /// Makes a call; states and bytes that come back are kept.
    ///
    /// Pointers that are not null point to as many values as the call says, never fewer: what a C interface
    /// cannot check is not tried.
    pub(super) fn invoke(&mut self, c: Component, time: f64, action: &Action) -> Outcome {
        use Action as A;
        let api = self.api;
        let (mut real, mut integer, mut complete) = (f64::NAN, 7, true);
        let split = |values: &[(u32, i32)]| -> (Vec<u32>, Vec<i32>) { values.iter().copied().unzip() };
        // SAFETY: the component is null or an instance, pointers are null or to living arrays of the length
        // that is given; states are looked up.
        let status = unsafe {
            match action {
                A::Instantiate { .. } | A::FreeInstance => unreachable!("they are not calls to an instance"),
                A::SetDebugLogging { on, categories, null } => {
                    let texts: Vec<Text> = categories.iter().map(text).collect();
                    (api.set_debug_logging)(c, Boolean::from(*on), texts.len(), first(both(*null), &texts))
                }
                A::SetupExperiment { tolerance, start, stop } => (api.setup_experiment)(
                    c,
                    Boolean::from(tolerance.is_some()),
                    tolerance.unwrap_or(f64::NAN),
                    *start,
                    Boolean::from(stop.is_some()),
                    stop.unwrap_or(f64::NAN),
                ),
                A::EnterInitializationMode => (api.enter_initialization_mode)(c),
                A::ExitInitializationMode => (api.exit_initialization_mode)(c),
                A::Terminate => (api.terminate)(c),
                A::Reset => (api.reset)(c),
                A::Get { kind, references, null } => {
                    let (vr, n) = (first(*null, references), references.len());
                    match kind {
                        Kind::Real => {
                            let mut values = vec![f64::NAN; n];
                            (api.get_real)(c, vr, n, last_mut(*null, &mut values))
                        }
                        Kind::Integer => {
                            let mut values = vec![0; n];
                            (api.get_integer)(c, vr, n, last_mut(*null, &mut values))
                        }
                        Kind::Boolean => {
                            let mut values = vec![FALSE; n];
                            let status = (api.get_boolean)(c, vr, n, last_mut(*null, &mut values));
                            integer = values.into_iter().max().unwrap_or(FALSE);
                            status
                        }
                        Kind::Text => {
                            let mut values = vec![ptr::null(); n];
                            let status = (api.get_string)(c, vr, n, last_mut(*null, &mut values));
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
                    (api.set_real)(c, first(*null, &vr), vr.len(), last(*null, &values))
                }
                A::SetInteger { values, null } => {
                    let (vr, values) = split(values);
                    (api.set_integer)(c, first(*null, &vr), vr.len(), last(*null, &values))
                }
                A::SetBoolean { values, null } => {
                    let (vr, values) = split(values);
                    (api.set_boolean)(c, first(*null, &vr), vr.len(), last(*null, &values))
                }
                A::SetString { values, null } => {
                    let vr: Vec<u32> = values.iter().map(|(reference, _)| *reference).collect();
                    let texts: Vec<Text> = values.iter().map(|(_, value)| text(value)).collect();
                    (api.set_string)(c, first(*null, &vr), vr.len(), last(*null, &texts))
                }
                A::GetDirectionalDerivative { unknowns, knowns, null } => {
                    let (known, seed): (Vec<_>, Vec<_>) = knowns.iter().copied().unzip();
                    let mut result = vec![f64::NAN; unknowns.len()];
                    (api.get_directional_derivative)(
                        c,
                        first(*null, unknowns),
                        unknowns.len(),
                        known.as_ptr(),
                        known.len(),
                        seed.as_ptr(),
                        last_mut(*null, &mut result),
                    )
                }
                A::GetFmuState { state, null } => {
                    (api.get_fmu_state)(c, place(*null, &mut self.states[*state]))
                }
                A::SetFmuState { state } => (api.set_fmu_state)(c, self.states[*state]),
                A::FreeFmuState { state, null } => self.free_state(c, *state, *null),
                A::SerializedFmuStateSize { state, null } => {
                    let mut size = 0;
                    (api.serialized_fmu_state_size)(c, self.states[*state], place(*null, &mut size))
                }
                A::SerializeFmuState { state, blob, excess, null } => {
                    self.serialize(c, *state, *blob, *excess, *null)
                }
                A::DeSerializeFmuState { blob, damage, state, null } => {
                    self.de_serialize(c, *blob, damage, *state, *null)
                }
                A::EnterEventMode => (api.enter_event_mode)(c),
                A::NewDiscreteStates { null } => {
                    let mut info = EventInfo {
                        new_discrete_states_needed: FALSE,
                        terminate_simulation: FALSE,
                        nominals_of_continuous_states_changed: FALSE,
                        values_of_continuous_states_changed: FALSE,
                        next_event_time_defined: FALSE,
                        next_event_time: 0.0,
                    };
                    (api.new_discrete_states)(c, place(*null, &mut info))
                }
                A::EnterContinuousTimeMode => (api.enter_continuous_time_mode)(c),
                A::CompletedIntegratorStep { null } => {
                    let (mut event, mut end) = (FALSE, FALSE);
                    let event = if *null == Null::First { ptr::null_mut() } else { &raw mut event };
                    let end = if *null == Null::Last { ptr::null_mut() } else { &raw mut end };
                    (api.completed_integrator_step)(c, TRUE, event, end)
                }
                A::SetTime { time } => (api.set_time)(c, *time),
                A::SetContinuousStates { values, excess, null } => {
                    let n = self.package.states.saturating_add_signed(*excess);
                    let x: Vec<f64> = values.iter().copied().cycle().take(n).collect();
                    (api.set_continuous_states)(c, first(both(*null), &x), n)
                }
                A::GetDerivatives { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (api.get_derivatives)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetContinuousStates { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (api.get_continuous_states)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetNominals { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (api.get_nominals)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetEventIndicators { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.event_indicators.saturating_add_signed(*excess)];
                    (api.get_event_indicators)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::SetRealInputDerivatives { values, null } => {
                    let vr: Vec<u32> = values.iter().map(|(reference, _, _)| *reference).collect();
                    let orders: Vec<i32> = values.iter().map(|(_, order, _)| *order).collect();
                    let values: Vec<f64> = values.iter().map(|(_, _, value)| *value).collect();
                    (api.set_real_input_derivatives)(
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
                    (api.get_real_output_derivatives)(
                        c,
                        first(*null, &vr),
                        vr.len(),
                        orders.as_ptr(),
                        last_mut(*null, &mut values),
                    )
                }
                A::DoStep { offset, size } => (api.do_step)(c, time + offset, *size, TRUE),
                A::CancelStep => (api.cancel_step)(c),
                A::GetStatus { kind, null } => {
                    let mut value = Status::Ok;
                    (api.get_status)(c, *kind, place(*null, &mut value))
                }
                A::GetRealStatus { kind, null } => (api.get_real_status)(c, *kind, place(*null, &mut real)),
                A::GetIntegerStatus { kind, null } => {
                    (api.get_integer_status)(c, *kind, place(*null, &mut integer))
                }
                A::GetBooleanStatus { kind, null } => {
                    (api.get_boolean_status)(c, *kind, place(*null, &mut integer))
                }
                A::GetStringStatus { kind, null } => {
                    let mut value = ptr::null();
                    (api.get_string_status)(c, *kind, place(*null, &mut value))
                }
            }
        };
        Outcome { status, real, integer, complete }
    }

    fn free_state(&mut self, c: Component, state: usize, null: Null) -> Status {
        let freed = self.states[state];
        // SAFETY: the component is null or an instance; the state is looked up.
        let status = unsafe { (self.api.free_fmu_state)(c, place(null, &mut self.states[state])) };
        // A pointer to what was freed stays in use somewhere, as with careless hosts.
        let other = (state + 1) % STATES;
        if status == Status::Ok && !freed.is_null() && self.states[other].is_null() {
            self.states[other] = freed;
        }
        status
    }

    fn serialize(&mut self, c: Component, state: usize, blob: usize, excess: isize, null: Null) -> Status {
        let mut size = 0;
        // SAFETY: the component is null or an instance, the array is as long as is said; the state is looked
        // up.
        unsafe {
            (self.api.serialized_fmu_state_size)(c, self.states[state], &raw mut size);
            let mut bytes = vec![0_u8; size.saturating_add_signed(excess)];
            let target = if null == Null::None { bytes.as_mut_ptr().cast() } else { ptr::null_mut() };
            let status = (self.api.serialize_fmu_state)(c, self.states[state], target, bytes.len());
            if status == Status::Ok {
                self.blobs[blob] = Blob { bytes, known: None };
            }
            status
        }
    }

    fn de_serialize(
        &mut self,
        c: Component,
        blob: usize,
        damage: &Damage,
        state: usize,
        null: Null,
    ) -> Status {
        let bytes = damaged(&self.blobs[blob].bytes, damage);
        let source = if null == Null::First { ptr::null() } else { bytes.as_ptr().cast() };
        let target = if null == Null::Last { ptr::null_mut() } else { &raw mut self.states[state] };
        // SAFETY: the component is null or an instance, the array is as long as is said; the state is looked
        // up.
        unsafe { (self.api.de_serialize_fmu_state)(c, source, bytes.len(), target) }
    }
}

/// Of a call with one array, either null means it.
fn both(null: Null) -> Null {
    if null == Null::None { Null::None } else { Null::First }
}

fn both_last(null: Null) -> Null {
    if null == Null::None { Null::None } else { Null::Last }
}

fn text(text: &Option<CString>) -> Text {
    text.as_ref().map_or(ptr::null(), |text| text.as_ptr())
}

fn damaged(bytes: &[u8], damage: &Damage) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let at = |fraction: f64, len: usize| ((fraction * len as f64) as usize).min(len.saturating_sub(1));
    match damage {
        Damage::None => {}
        Damage::Flip(fraction, pattern) => {
            let index = at(*fraction, bytes.len());
            if let Some(byte) = bytes.get_mut(index) {
                *byte ^= pattern;
            }
        }
        Damage::Cut(fraction) => bytes.truncate(at(*fraction, bytes.len())),
        Damage::Longer(count) => bytes.extend(vec![0xa5; *count]),
        Damage::Forge(fraction, word) => forge(&mut bytes, *fraction, *word),
        Damage::Random(seed, len) => {
            let mut rng = fastrand::Rng::with_seed(*seed);
            bytes = (0..*len).map(|_| rng.u8(..)).collect();
        }
    }
    bytes
}

/// Replaces a word and puts the checksum right: FNV-1a over everything, in the last eight bytes.
fn forge(bytes: &mut [u8], fraction: f64, word: u64) {
    let Some(len) = bytes.len().checked_sub(8) else { return };
    let index = ((fraction * len as f64) as usize).min(len.saturating_sub(8));
    let (content, checksum) = bytes.split_at_mut(len);
    if let Some(place) = content.get_mut(index..index + 8) {
        place.copy_from_slice(&word.to_le_bytes());
    }
    let hash = content.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    checksum.copy_from_slice(&hash.to_le_bytes());
}
