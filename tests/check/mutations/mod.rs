//! Good FMUs and systems with one fault each, and the rule that finds it.

pub mod archives;
pub mod descriptions;
pub mod fmus;
pub mod libraries;
pub mod related;
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

/// Descriptions, good and bad, for a comparison with the standards' own schemas: ending, text, and the file that it is in.
pub fn documents() -> Vec<(&'static str, String, Vec<u8>)> {
    let mut documents = Vec::new();
    let description = descriptions::xml();
    for text in schema::random(&description, &["Tool"], 400) {
        let bytes = descriptions::of(&text);
        documents.push(("xml", text, bytes));
    }
    // Values in place are checked by their own schema, which that of the description does not ask.
    for (file, ending, text) in [
        (crate::ssp::DESCRIPTION, "ssd", include_str!("../SystemStructure.ssd")),
        (crate::ssp::VALUES, "ssv", include_str!("../first.ssv")),
    ] {
        for text in schema::random(text, &["ParameterValues"], 200) {
            let bytes = crate::ssp::replaced(file, text.as_bytes()).bytes();
            documents.push((ending, text, bytes));
        }
    }
    documents
}
