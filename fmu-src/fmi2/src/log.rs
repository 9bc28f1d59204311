//! Messages to the host.

use std::ffi::{CStr, CString};

use strut_model::Work;

use crate::types::{CallbackFunctions, ComponentEnvironment, Logger, Status};

/// Why a call did not return `fmi2OK`.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// What it returns instead.
    pub status: Status,
    /// What is wrong and what to do.
    pub message: String,
}

impl Failure {
    /// A call that is refused; nothing was changed.
    #[cold]
    pub fn error(message: impl Into<String>) -> Self {
        Self { status: Status::Error, message: message.into() }
    }
}

impl From<strut_model::Error> for Failure {
    #[cold]
    fn from(error: strut_model::Error) -> Self {
        Self::error(error.to_string())
    }
}

/// What is told only if debug logging is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Debugging {
    /// Steps that are discarded: a host may well try a step and make a shorter one.
    pub discards: bool,
    /// What the integration has cost.
    pub solver: bool,
}

impl Debugging {
    /// All of it, or none.
    pub fn all(on: bool) -> Self {
        Self { discards: on, solver: on }
    }
}

/// The way to the host's logger.
///
/// As section 2.1.3 of the standard has it, warnings and errors are always told.
#[derive(Debug)]
pub struct Log {
    logger: Option<Logger>,
    environment: ComponentEnvironment,
    instance: CString,
    /// What else is told.
    pub debug: Debugging,
}

impl Log {
    /// A log that ends at the host's logger, if it has one.
    pub fn new(callbacks: &CallbackFunctions, instance: CString, debug: Debugging) -> Self {
        Self { logger: callbacks.logger, environment: callbacks.component_environment, instance, debug }
    }

    /// Tells the host why a function did not return `fmi2OK`.
    pub fn tell(&self, function: &str, failure: &Failure) {
        let category = match failure.status {
            Status::Discard if !self.debug.discards => return,
            Status::Discard => c"logStatusDiscard",
            Status::Fatal => c"logStatusFatal",
            Status::Ok | Status::Warning | Status::Pending => c"logStatusWarning",
            Status::Error => c"logStatusError",
        };
        self.send(failure.status, category, function, &failure.message);
    }

    /// Tells the host what the integration has cost, if it wants to know.
    pub fn tell_cost(&self, function: &str, work: Work) {
        if self.debug.solver {
            let Work { accepted, rejected, rates, jacobians, .. } = work;
            let message = format!(
                "the integration took {accepted} steps and tried {rejected} that were too long, with {rates} \
                 evaluations of the rates and {jacobians} Jacobians"
            );
            self.send(Status::Ok, c"logSolver", function, &message);
        }
    }

    fn send(&self, status: Status, category: &CStr, function: &str, message: &str) {
        let Some(logger) = self.logger else { return };
        let message = escape(&format!("{function}: {message}"));
        // SAFETY: the host gave the logger for these arguments; the strings end with a zero and outlive
        // the call, and the message, being a format, names no further arguments.
        unsafe {
            logger(self.environment, self.instance.as_ptr(), status, category.as_ptr(), message.as_ptr());
        }
    }
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
    use strut_model::LOG_CATEGORIES;

    #[test]
    fn a_message_is_a_format_without_arguments() {
        assert_eq!(escape("5 % of %s"), CString::from(c"5 %% of %%s"));
        assert_eq!(escape("a\0b"), CString::from(c"a\x01b"));
    }

    #[test]
    fn the_categories_are_the_declared_ones() {
        for category in
            ["logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal", "logSolver"]
        {
            assert!(LOG_CATEGORIES.iter().any(|(name, _)| *name == category));
        }
    }
}
