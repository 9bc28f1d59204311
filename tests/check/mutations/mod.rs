//! Good FMUs and systems with one fault each, and the rule that finds it.

pub mod archives;
pub mod descriptions;
pub mod fmus;
pub mod libraries;
mod schema;
pub mod systems;

/// An FMU or system with one fault.
pub struct Case {
    /// What was done.
    pub what: String,
    /// The rule that finds it.
    pub rule: &'static str,
    /// `fmu` or `ssp`.
    pub ending: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

impl Case {
    /// An FMU.
    fn fmu(what: impl Into<String>, rule: &'static str, bytes: Vec<u8>) -> Self {
        Self { what: what.into(), rule, ending: "fmu", bytes }
    }

    /// A system.
    fn ssp(what: impl Into<String>, rule: &'static str, bytes: Vec<u8>) -> Self {
        Self { what: what.into(), rule, ending: "ssp", bytes }
    }
}
