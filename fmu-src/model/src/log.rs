//! The categories that log messages are sorted into.

/// Name and description of each category, as the model description lists them and the FMUs log them.
pub const LOG_CATEGORIES: &[(&str, &str)] = &[
    ("logStatusWarning", "What works, but perhaps not as meant"),
    ("logStatusDiscard", "Steps that were refused and may be tried again, shorter"),
    ("logStatusError", "Calls that were refused, and why"),
    ("logStatusFatal", "Failures that no further call can repair"),
    ("logSolver", "What the integration has cost, at the end"),
    ("logAll", "Everything"),
];
