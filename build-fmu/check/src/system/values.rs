//! Parameter sets (SSV) and mappings of their names (SSM), read as they are.

use roxmltree::Node;

use super::files;
use super::structure::{child, children, is_within, source_of, text_of, transformation, units};
use crate::finding::Finding;
use crate::lines::Lines;
use crate::schema;
use crate::unit::Unit;

/// `<ParameterSet>`.
#[derive(Debug)]
pub struct Values {
    /// What it gives.
    pub parameters: Vec<Parameter>,
    /// The declared units.
    pub units: Vec<Unit>,
}

/// `<Parameter>`.
#[derive(Debug)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Name of its value's element: Real, Integer and so on; empty if there is none.
    pub kind: String,
    /// Value, as it stands there.
    pub value: String,
    /// Unit, if it is given.
    pub unit: Option<String>,
    /// Line of the element.
    pub line: u32,
}

/// `<ParameterMapping>`.
#[derive(Debug)]
pub struct Mapping {
    /// URI of its file, if it is one.
    pub source: Option<String>,
    /// Whether the file is looked for in the component, and not beside the description.
    pub within: bool,
    /// From which name to which.
    pub entries: Vec<Entry>,
}

/// `<MappingEntry>`.
#[derive(Debug)]
pub struct Entry {
    /// Name in the parameter set.
    pub source: String,
    /// Name of what it is given to.
    pub target: String,
    /// The element of how the value is transformed on the way, if it is.
    pub transformation: Option<String>,
    /// Line of the element.
    pub line: u32,
}

impl Values {
    /// Reads a file.
    ///
    /// # Errors
    /// If it is no well-formed XML or no parameter set.
    pub fn parse(bytes: &[u8], file: &str) -> Result<(Self, Vec<Finding>), String> {
        files::read(bytes, &schema::ssp::PARAMETER_SET, file, Self::of)
    }

    /// Reads an element.
    pub fn of(node: Node, lines: &Lines) -> Self {
        let list = child(node, "Parameters").into_iter().flat_map(|list| children(list, "Parameter"));
        Self { parameters: list.map(|node| parameter(node, lines)).collect(), units: units(node) }
    }
}

impl Mapping {
    /// Reads a file.
    ///
    /// # Errors
    /// If it is no well-formed XML or no mapping.
    pub fn parse(bytes: &[u8], file: &str) -> Result<(Self, Vec<Finding>), String> {
        files::read(bytes, &schema::ssp::MAPPING, file, Self::of)
    }

    /// Reads an element: a mapping, or what holds one or names its file.
    pub fn of(node: Node, lines: &Lines) -> Self {
        let inner = child(node, "ParameterMapping").unwrap_or(node);
        let entry = |node: Node| Entry {
            source: text_of(node, "source"),
            target: text_of(node, "target"),
            transformation: transformation(node),
            line: lines.line(node),
        };
        Self {
            source: source_of(node),
            within: is_within(node),
            entries: children(inner, "MappingEntry").map(entry).collect(),
        }
    }
}

fn parameter(node: Node, lines: &Lines) -> Parameter {
    let value = node.children().find(Node::is_element);
    let text = |name: &str| value.and_then(|value| value.attribute(name)).map(str::to_owned);
    Parameter {
        name: text_of(node, "name"),
        kind: value.map_or_else(String::new, |value| value.tag_name().name().into()),
        value: text("value").unwrap_or_default(),
        unit: text("unit"),
        line: lines.line(node),
    }
}
