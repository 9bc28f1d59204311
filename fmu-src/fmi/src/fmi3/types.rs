//! The C types of FMI 3.0 (`fmi3PlatformTypes.h`, `fmi3FunctionTypes.h`).

use libc::{c_int, c_void};

pub use crate::interface::types::{
    Component, ComponentEnvironment, FmuState, Real, Size, Status, Text, ValueReference,
};

/// `fmi3Boolean` and `fmi3Clock` as they come from C, where nothing keeps a `bool` within its two values: zero is false,
/// anything else true.
pub type Boolean = u8;
/// `fmi3Binary`.
pub type Binary = *const u8;
/// `fmi3IntervalQualifier` and `fmi3DependencyKind` as they come from C.
pub type RawKind = c_int;

/// `fmi3True`.
pub const TRUE: Boolean = 1;
/// `fmi3False`.
pub const FALSE: Boolean = 0;

/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(ComponentEnvironment, Status, Text, Text);
/// `fmi3IntermediateUpdateCallback`, never called.
pub type IntermediateUpdate = *const c_void;
/// `fmi3ClockUpdateCallback`, `fmi3LockPreemptionCallback` and `fmi3UnlockPreemptionCallback`, never called.
pub type Callback = *const c_void;
