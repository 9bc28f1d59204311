//! The C types that both versions share.

use libc::{c_char, c_double, c_uint, c_void, size_t};

/// An instance.
pub type Component = *mut c_void;
/// The host's own, handed back to its logger.
pub type ComponentEnvironment = *mut c_void;
/// A saved state.
pub type FmuState = *mut c_void;
/// A value reference.
pub type ValueReference = c_uint;
/// A real number.
pub type Real = c_double;
/// UTF-8 with a zero at the end.
pub type Text = *const c_char;
/// `size_t`.
pub type Size = size_t;

/// `fmi2Status` and `fmi3Status`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All well.
    Ok,
    /// Not quite right, but the computation can go on.
    Warning,
    /// Not possible like this; the instance is as it was.
    Discard,
    /// The call was refused or failed.
    Error,
    /// The instance is lost.
    Fatal,
    /// FMI 2.0 only: an asynchronous step is under way; steps of these FMUs never are.
    Pending,
}
