//! The C types of FMI 2.0 (`fmi2TypesPlatform.h`, `fmi2FunctionTypes.h`).

use libc::{c_int, c_void};

pub use crate::interface::types::{
    Component, ComponentEnvironment, FmuState, Real, Size, Status, Text, ValueReference,
};

/// `fmi2Integer`.
pub type Integer = c_int;
/// `fmi2Boolean`: zero is false, anything else true.
pub type Boolean = c_int;
/// `fmi2Byte`, a `char` of whatever sign.
pub type Byte = u8;
/// `fmi2Type` as it comes from C, where nothing keeps it within the enumeration.
pub type RawType = c_int;
/// `fmi2StatusKind` as it comes from C.
pub type RawStatusKind = c_int;

/// `fmi2True`.
pub const TRUE: Boolean = 1;
/// `fmi2False`.
pub const FALSE: Boolean = 0;

/// `fmi2StatusKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatusKind {
    /// `fmi2DoStepStatus`.
    DoStepStatus,
    /// `fmi2PendingStatus`.
    PendingStatus,
    /// `fmi2LastSuccessfulTime`.
    LastSuccessfulTime,
    /// `fmi2Terminated`.
    Terminated,
}

impl StatusKind {
    /// From C.
    pub fn from_raw(kind: RawStatusKind) -> Option<Self> {
        [Self::DoStepStatus, Self::PendingStatus, Self::LastSuccessfulTime, Self::Terminated]
            .into_iter()
            .find(|candidate| *candidate as c_int == kind)
    }
}

/// `fmi2CallbackLogger`.
pub type Logger = unsafe extern "C" fn(ComponentEnvironment, Text, Status, Text, Text, ...);
/// `fmi2CallbackAllocateMemory`.
pub type AllocateMemory = unsafe extern "C" fn(Size, Size) -> *mut c_void;
/// `fmi2CallbackFreeMemory`.
pub type FreeMemory = unsafe extern "C" fn(*mut c_void);
/// `fmi2StepFinished`.
pub type StepFinished = unsafe extern "C" fn(ComponentEnvironment, Status);

/// `fmi2CallbackFunctions`. Only the logger is ever called: memory comes from Rust's allocator, steps
/// are synchronous.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CallbackFunctions {
    /// Takes messages; may be null.
    pub logger: Option<Logger>,
    /// Not used.
    pub allocate_memory: Option<AllocateMemory>,
    /// Not used.
    pub free_memory: Option<FreeMemory>,
    /// Not used.
    pub step_finished: Option<StepFinished>,
    /// Handed back to the logger.
    pub component_environment: ComponentEnvironment,
}

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventInfo {
    /// Call `fmi2NewDiscreteStates` again.
    pub new_discrete_states_needed: Boolean,
    /// End the simulation.
    pub terminate_simulation: Boolean,
    /// Ask for the nominal values again.
    pub nominals_of_continuous_states_changed: Boolean,
    /// Ask for the continuous states again.
    pub values_of_continuous_states_changed: Boolean,
    /// The next field holds.
    pub next_event_time_defined: Boolean,
    /// Enter event mode at this time.
    pub next_event_time: Real,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_are_those_of_the_header() {
        assert_eq!(size_of::<CallbackFunctions>(), 5 * size_of::<*const c_void>());
        assert_eq!(std::mem::offset_of!(EventInfo, next_event_time), 24);
        assert_eq!((size_of::<EventInfo>(), size_of::<Status>()), (32, 4));
        assert_eq!(Status::Pending as c_int, 5);
        assert_eq!(StatusKind::from_raw(2), Some(StatusKind::LastSuccessfulTime));
        assert_eq!((StatusKind::from_raw(-1), StatusKind::from_raw(4)), (None, None));
    }
}
