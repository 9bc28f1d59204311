//! What can go wrong, and what to do about it.

use thiserror::Error;

/// Why an integration stopped. Times and steps in the system's unit of time, normally s.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum IntegrationError {
    /// The rates or the state are NaN or infinite, however short the step.
    #[error(
        "state {component} or its rate is not finite at t = {t}; check its start value, the inputs \
         and the parameters for a division by zero, a root or a logarithm out of its domain"
    )]
    NotFinite {
        /// Time of the last good state.
        t: f64,
        /// Index of the first state concerned.
        component: usize,
    },
    /// The tolerance cannot be met with a step that still changes t.
    #[error(
        "the tolerance cannot be met at t = {t} with steps of {h}, the shortest that t can resolve; \
         raise the tolerances, or look for a rate that jumps back and forth, or a solution that \
         grows without bound, at this time"
    )]
    StepUnderflow {
        /// Time of the last good state.
        t: f64,
        /// The step that was still too long.
        h: f64,
    },
    /// More steps than [`Settings::max_steps`](crate::Settings::max_steps) in one call.
    #[error(
        "{limit} steps did not reach the end of the call, they got to t = {t}; if the system is \
         stiff, choose the Rosenbrock method, else raise the tolerances, shorten the call or allow \
         more steps"
    )]
    TooManySteps {
        /// Time that was reached.
        t: f64,
        /// The number of steps allowed.
        limit: u32,
    },
    /// The end lies before the start, or a time is not finite.
    #[error("cannot integrate from t = {t0} to {t1}; times must be finite and not decrease")]
    InvalidInterval {
        /// Start of the call.
        t0: f64,
        /// End of the call.
        t1: f64,
    },
}

/// Which setting cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum InvalidSettings {
    /// Zero would ask for steps of zero length.
    #[error("relative tolerance {0} must be positive and finite, e.g. 1e-6")]
    RelativeTolerance(f64),
    /// Zero would ask for steps of zero length where the state passes zero.
    #[error("absolute tolerance {value} of state {component} must be positive and finite")]
    AbsoluteTolerance {
        /// Index of the state.
        component: usize,
        /// Its tolerance.
        value: f64,
    },
    /// Infinity is allowed, and the default.
    #[error("longest step {0} must be positive")]
    MaxStep(f64),
    /// No step at all cannot get anywhere.
    #[error("at least one step must be allowed")]
    MaxSteps,
}
