//! Messages to the host.

use std::ffi::CStr;

use strut_model::SolverStats;

use super::types::Status;

/// Why a call did not return that all is well.
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
    /// Warnings: FMI 2.0 always logs them (section 2.1.3), FMI 3.0 only if the host asks for them (section 2.3.1).
    pub warnings: bool,
    /// Steps that are discarded: a host may well try a step and make a shorter one.
    pub discards: bool,
    /// What the integration has cost.
    pub solver: bool,
}

impl Debugging {
    /// All of it, or none.
    pub fn all(on: bool) -> Self {
        Self { warnings: on, discards: on, solver: on }
    }
}

/// What brings a message to the host: status, category, text.
type Send = Box<dyn Fn(Status, &CStr, &str)>;

/// The way to the host's logger. Errors are always logged.
pub struct Log {
    send: Send,
    /// What else is told.
    pub debug: Debugging,
}

impl Log {
    /// A log that ends at a host's logger.
    pub fn new(send: impl Fn(Status, &CStr, &str) + 'static, debug: Debugging) -> Self {
        Self { send: Box::new(send), debug }
    }

    /// Tells the host why a function did not return that all is well.
    pub fn tell(&self, function: &str, failure: &Failure) {
        let category = match failure.status {
            Status::Discard if !self.debug.discards => return,
            Status::Ok | Status::Warning | Status::Pending if !self.debug.warnings => return,
            Status::Discard => c"logStatusDiscard",
            Status::Fatal => c"logStatusFatal",
            Status::Ok | Status::Warning | Status::Pending => c"logStatusWarning",
            Status::Error => c"logStatusError",
        };
        (self.send)(failure.status, category, &format!("{function}: {}", failure.message));
    }

    /// Tells the host what the integration has cost, if it wants to know.
    pub fn tell_cost(&self, function: &str, work: SolverStats) {
        if self.debug.solver {
            let SolverStats { accepted, rejected, rates, jacobians, .. } = work;
            let message = format!(
                "{function}: the integration took {accepted} steps and tried {rejected} that were too long, with {rates} \
                 evaluations of the rates and {jacobians} Jacobians"
            );
            (self.send)(Status::Ok, c"logSolver", &message);
        }
    }
}

#[cfg(test)]
mod tests {
    use strut_model::LOG_CATEGORIES;

    #[test]
    fn the_categories_are_the_declared_ones() {
        for category in
            ["logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal", "logSolver"]
        {
            assert!(LOG_CATEGORIES.iter().any(|(name, _)| *name == category));
        }
    }
}
