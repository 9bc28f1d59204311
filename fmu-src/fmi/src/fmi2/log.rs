//! Messages to a host of FMI 2.0.

use std::ffi::CString;

use super::types::CallbackFunctions;
use crate::interface::log::{Debugging, Log};

/// A log that ends at the host's logger, if it has one. Warnings are always logged.
pub fn log(callbacks: &CallbackFunctions, instance: CString, on: bool) -> Log {
    let CallbackFunctions { logger, component_environment: environment, .. } = *callbacks;
    let send = move |status, category: &std::ffi::CStr, message: &str| {
        let Some(logger) = logger else { return };
        let message = escape(message);
        // SAFETY: the host gave the logger for these arguments; the strings end with a zero and outlive
        // the call, and the message, being a format, names no further arguments.
        unsafe { logger(environment, instance.as_ptr(), status, category.as_ptr(), message.as_ptr()) }
    };
    Log::new(send, Debugging { warnings: true, ..Debugging::all(on) })
}

/// A message as the format that prints it. (`"%s"` with the message as argument would be lost on hosts
/// that, like FMPy, cannot take further arguments and show the format as it is.)
fn escape(message: &str) -> CString {
    let bytes: Vec<u8> = message.replace('%', "%%").bytes().map(|byte| byte.max(1)).collect();
    CString::new(bytes).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_a_format_without_arguments() {
        assert_eq!(escape("5 % of %s"), CString::from(c"5 %% of %%s"));
        assert_eq!(escape("a\0b"), CString::from(c"a\x01b"));
    }
}
