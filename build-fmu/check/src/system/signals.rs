//! Signal dictionaries (SSB), read as they are.

use roxmltree::Node;

use super::files;
use super::structure::{child, children, source_of, text_of, type_and_unit, units};
use crate::finding::Finding;
use crate::lines::Lines;
use crate::schema;
use crate::unit::Unit;

/// `<SignalDictionary>` of a system: the name of a dictionary, and where its signals stand.
#[derive(Debug)]
pub struct Declared {
    /// Name within the system.
    pub name: String,
    /// What kind of file it is.
    pub media: String,
    /// URI of the file, if it is one.
    pub source: Option<String>,
    /// The signals that are given in place.
    pub inline: Option<Dictionary>,
    /// Line of the element.
    pub line: u32,
}

/// `<SignalDictionary>` of its own: signals that elements share.
#[derive(Clone, Debug)]
pub struct Dictionary {
    /// The signals.
    pub signals: Vec<Signal>,
    /// The declared units.
    pub units: Vec<Unit>,
}

/// `<DictionaryEntry>`.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Name.
    pub name: String,
    /// Name of its type's element: Real, Integer and so on.
    pub of_type: Option<String>,
    /// Unit, if it is given.
    pub unit: Option<String>,
    /// Line of the element.
    pub line: u32,
}

impl Declared {
    /// Reads an element.
    pub fn of(node: Node, lines: &Lines) -> Self {
        Self {
            name: text_of(node, "name"),
            media: node.attribute("type").unwrap_or(Dictionary::MEDIA).into(),
            source: source_of(node),
            inline: child(node, "SignalDictionary").map(|node| Dictionary::of(node, lines)),
            line: lines.line(node),
        }
    }
}

impl Dictionary {
    /// The kind of its files.
    pub const MEDIA: &str = "application/x-ssp-signal-dictionary";

    /// Reads a file.
    ///
    /// # Errors
    /// If it is no well-formed XML or no signal dictionary.
    pub fn parse(bytes: &[u8], file: &str) -> Result<(Self, Vec<Finding>), String> {
        files::read(bytes, &schema::ssp::DICTIONARY, file, Self::of)
    }

    fn of(node: Node, lines: &Lines) -> Self {
        Self {
            signals: children(node, "DictionaryEntry").map(|node| signal(node, lines)).collect(),
            units: units(node),
        }
    }
}

fn signal(node: Node, lines: &Lines) -> Signal {
    let (of_type, unit) = type_and_unit(node);
    Signal { name: text_of(node, "name"), of_type, unit, line: lines.line(node) }
}
