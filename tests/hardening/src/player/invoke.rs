//! From a call as a value to a call in C.

mod three;
mod two;

use std::ffi::CString;
use std::ptr;

use strut_fmi::fmi2::types::{Component, Status, Text};

use super::{Blob, Player};
use crate::api::Own;
use crate::call::{Action, Damage, Null, STATES};

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
    /// Whether a step ended early, in FMI 3.0.
    pub early: bool,
}

impl Outcome {
    /// That nothing came back but a status.
    fn of(status: Status) -> Self {
        Self { status, real: f64::NAN, integer: 7, complete: true, early: false }
    }
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
        let common = self.api.common;
        // SAFETY: the component is null or an instance, pointers are null or to living arrays of the length
        // that is given; states are looked up.
        let status = unsafe {
            match action {
                A::Instantiate { .. } | A::FreeInstance => unreachable!("they are not calls to an instance"),
                A::ExitInitializationMode => (common.exit_initialization_mode)(c),
                A::Terminate => (common.terminate)(c),
                A::Reset => (common.reset)(c),
                A::GetFmuState { state, null } => {
                    (common.get_fmu_state)(c, place(*null, &mut self.states[*state]))
                }
                A::SetFmuState { state } => (common.set_fmu_state)(c, self.states[*state]),
                A::FreeFmuState { state, null } => self.free_state(c, *state, *null),
                A::SerializedFmuStateSize { state, null } => {
                    let mut size = 0;
                    (common.serialized_fmu_state_size)(c, self.states[*state], place(*null, &mut size))
                }
                A::SerializeFmuState { state, blob, excess, null } => {
                    self.serialize(c, *state, *blob, *excess, *null)
                }
                A::DeSerializeFmuState { blob, damage, state, null } => {
                    self.de_serialize(c, *blob, damage, *state, *null)
                }
                A::EnterEventMode => (common.enter_event_mode)(c),
                A::EnterContinuousTimeMode => (common.enter_continuous_time_mode)(c),
                A::SetTime { time } => (common.set_time)(c, *time),
                A::SetContinuousStates { values, excess, null } => {
                    let n = self.package.states.saturating_add_signed(*excess);
                    let x: Vec<f64> = values.iter().copied().cycle().take(n).collect();
                    (common.set_continuous_states)(c, first(both(*null), &x), n)
                }
                A::GetDerivatives { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (common.get_derivatives)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetContinuousStates { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (common.get_continuous_states)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetNominals { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.states.saturating_add_signed(*excess)];
                    (common.get_nominals)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                A::GetEventIndicators { excess, null } => {
                    let mut x = vec![f64::NAN; self.package.event_indicators.saturating_add_signed(*excess)];
                    (common.get_event_indicators)(c, last_mut(both_last(*null), &mut x), x.len())
                }
                _ => {
                    return match &self.api.own {
                        Own::Two(two) => two::invoke(two, c, time, action),
                        Own::Three(three) => three::invoke(three, self.package, c, time, action),
                    };
                }
            }
        };
        Outcome::of(status)
    }

    fn free_state(&mut self, c: Component, state: usize, null: Null) -> Status {
        let freed = self.states[state];
        // SAFETY: the component is null or an instance; the state is looked up.
        let status = unsafe { (self.api.common.free_fmu_state)(c, place(null, &mut self.states[state])) };
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
            (self.api.common.serialized_fmu_state_size)(c, self.states[state], &raw mut size);
            let mut bytes = vec![0_u8; size.saturating_add_signed(excess)];
            let target = if null == Null::None { bytes.as_mut_ptr() } else { ptr::null_mut() };
            let status = (self.api.common.serialize_fmu_state)(c, self.states[state], target, bytes.len());
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
        let source = if null == Null::First { ptr::null() } else { bytes.as_ptr() };
        let target = if null == Null::Last { ptr::null_mut() } else { &raw mut self.states[state] };
        // SAFETY: the component is null or an instance, the array is as long as is said; the state is looked
        // up.
        unsafe { (self.api.common.de_serialize_fmu_state)(c, source, bytes.len(), target) }
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
