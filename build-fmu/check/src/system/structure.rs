//! The description of a system (SSP 1.0), read as it is: what is wrong with it is for the rules to find.

use roxmltree::Node;

use super::files;
use super::signals::Declared;
use super::values::{Mapping, Values};
use crate::finding::Finding;
use crate::lines::Lines;
use crate::schema;
use crate::unit::Unit;

/// The file that an SSP must have.
pub const FILE: &str = "SystemStructure.ssd";

/// What stands in the description.
#[derive(Debug)]
pub struct Structure {
    /// `1.0`.
    pub version: String,
    /// The outermost system.
    pub root: Element,
    /// The declared units.
    pub units: Vec<Unit>,
}

/// A system, or what it is made of.
#[derive(Debug)]
pub struct Element {
    /// Name within the system around.
    pub name: String,
    /// Names from the outermost system on, which is left out itself: `corner.rig`.
    pub path: String,
    /// What can be connected.
    pub connectors: Vec<Connector>,
    /// Where values for it come from.
    pub bindings: Vec<Binding>,
    /// What it is.
    pub content: Content,
    /// Line of the element.
    pub line: u32,
}

/// What an element is.
#[derive(Debug)]
pub enum Content {
    /// Made of a file.
    Component {
        /// Its URI.
        source: String,
        /// What kind of file it is.
        media: String,
        /// Which of an FMU's interfaces is to be used; `any` if that is not told.
        implementation: String,
    },
    /// Made of elements.
    System {
        /// The elements.
        elements: Vec<Element>,
        /// What joins them.
        connections: Vec<Connection>,
        /// The signal dictionaries that are known in it.
        dictionaries: Vec<Declared>,
    },
    /// Signals without a model, of a dictionary of this name.
    Dictionary(String),
}

/// `<Connector>`.
#[derive(Debug)]
pub struct Connector {
    /// Name, which is its variable's.
    pub name: String,
    /// `input`, `output`, `parameter`, `calculatedParameter`, `inout`.
    pub kind: String,
    /// Name of its type's element, if it is given: Real, Integer and so on.
    pub of_type: Option<String>,
    /// Unit, if it is given.
    pub unit: Option<String>,
    /// Line of the element.
    pub line: u32,
}

/// `<Connection>`.
#[derive(Debug)]
pub struct Connection {
    /// Where it starts, and where it ends; neither says which way the signal flows.
    pub ends: [End; 2],
    /// Whether units are not to be converted.
    pub unconverted: bool,
    /// The element of how the signal is transformed on the way, if it is.
    pub transformation: Option<String>,
    /// Line of the element.
    pub line: u32,
}

/// An end of a connection.
#[derive(Debug)]
pub struct End {
    /// Name of the element; none for the system's own connectors.
    pub element: Option<String>,
    /// Name of the connector.
    pub connector: String,
}

/// `<ParameterBinding>`.
#[derive(Debug)]
pub struct Binding {
    /// What kind of file it is.
    pub media: String,
    /// URI of the file, if it is one.
    pub source: Option<String>,
    /// Whether the file is looked for in the component, and not beside the description.
    pub within: bool,
    /// What is put before each name.
    pub prefix: String,
    /// The values that are given in place.
    pub inline: Option<Values>,
    /// How names are mapped.
    pub mapping: Option<Mapping>,
    /// Line of the element.
    pub line: u32,
}

impl Structure {
    /// Reads the file, and checks it by itself.
    ///
    /// # Errors
    /// If it is no well-formed XML or describes no system.
    pub fn parse(bytes: &[u8]) -> Result<(Self, Vec<Finding>), String> {
        let read = |root: Node, lines: &Lines| -> Option<Self> {
            Some(Self {
                version: text_of(root, "version"),
                root: element(child(root, "System")?, "", lines),
                units: units(root),
            })
        };
        let (structure, findings) = files::read(bytes, &schema::ssp::DESCRIPTION, FILE, read)
            .map_err(|error| format!("{FILE} {error}"))?;
        Ok((structure.ok_or_else(|| format!("{FILE} has no <System>"))?, findings))
    }
}

impl Element {
    /// This element and all within it.
    pub fn all(&self) -> Vec<&Self> {
        let mut all = vec![self];
        if let Content::System { elements, .. } = &self.content {
            all.extend(elements.iter().flat_map(Self::all));
        }
        all
    }

    /// The connector of a name.
    pub fn connector(&self, name: &str) -> Option<&Connector> {
        self.connectors.iter().find(|connector| connector.name == name)
    }

    /// A name of it for messages.
    pub fn shown(&self) -> String {
        if self.path.is_empty() { "the system".into() } else { format!("`{}`", self.path) }
    }

    /// The name of one of its connectors or variables, for messages.
    pub fn of(&self, name: &str) -> String {
        if self.path.is_empty() { name.into() } else { format!("{}.{name}", self.path) }
    }
}

/// The children of a name; prefixes of namespaces may be any.
pub fn children<'a, 'x>(node: Node<'a, 'x>, name: &'static str) -> impl Iterator<Item = Node<'a, 'x>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The first child of a name.
pub fn child<'a, 'x>(node: Node<'a, 'x>, name: &'static str) -> Option<Node<'a, 'x>> {
    children(node, name).next()
}

/// An attribute; nothing if it is missing.
pub fn text_of(node: Node, name: &str) -> String {
    node.attribute(name).unwrap_or_default().to_owned()
}

/// The units that a document declares.
pub fn units(root: Node) -> Vec<Unit> {
    let units = child(root, "Units").into_iter().flat_map(|list| children(list, "Unit"));
    // What its numbers are the schema tells; the unit is declared all the same.
    units.map(|node| Unit::parse(node).unwrap_or_else(|_| Unit::named(&text_of(node, "name")))).collect()
}

/// The file that something is in; none if it is given in place.
pub fn source_of(node: Node) -> Option<String> {
    node.attribute("source").filter(|source| !source.is_empty()).map(str::to_owned)
}

/// Whether a source is looked for in the component.
pub fn is_within(node: Node) -> bool {
    node.attribute("sourceBase") == Some("component")
}

fn is_true(node: Node, name: &str) -> bool {
    matches!(node.attribute(name), Some("true" | "1"))
}

fn element(node: Node, around: &str, lines: &Lines) -> Element {
    let name = text_of(node, "name");
    let path = match (around, node.parent_element().is_some_and(|it| it.tag_name().name() == "Elements")) {
        (_, false) => String::new(),
        ("", true) => name.clone(),
        (around, true) => format!("{around}.{name}"),
    };
    let list = |list, item| child(node, list).into_iter().flat_map(move |list| children(list, item));
    let content = match node.tag_name().name() {
        "Component" => Content::Component {
            source: text_of(node, "source"),
            media: node.attribute("type").unwrap_or("application/x-fmu-sharedlibrary").into(),
            implementation: node.attribute("implementation").unwrap_or("any").into(),
        },
        "System" => {
            let inner = child(node, "Elements").into_iter().flat_map(|list| list.children());
            Content::System {
                elements: inner.filter(Node::is_element).map(|inner| element(inner, &path, lines)).collect(),
                connections: list("Connections", "Connection").map(|node| connection(node, lines)).collect(),
                dictionaries: list("SignalDictionaries", "SignalDictionary")
                    .map(|node| Declared::of(node, lines))
                    .collect(),
            }
        }
        _ => Content::Dictionary(text_of(node, "dictionary")),
    };
    Element {
        connectors: list("Connectors", "Connector").map(|node| connector(node, lines)).collect(),
        bindings: list("ParameterBindings", "ParameterBinding").map(|node| binding(node, lines)).collect(),
        line: lines.line(node),
        name,
        path,
        content,
    }
}

/// The element of a transformation, if there is one.
pub fn transformation(node: Node) -> Option<String> {
    let mut names = node.children().map(|child| child.tag_name().name());
    names.find(|name| name.ends_with("Transformation")).map(str::to_owned)
}

fn connector(node: Node, lines: &Lines) -> Connector {
    let (of_type, unit) = type_and_unit(node);
    Connector {
        name: text_of(node, "name"),
        kind: text_of(node, "kind"),
        of_type,
        unit,
        line: lines.line(node),
    }
}

/// Of a connector or a signal, if they are given.
pub fn type_and_unit(node: Node) -> (Option<String>, Option<String>) {
    const TYPES: [&str; 6] = ["Real", "Integer", "Boolean", "String", "Enumeration", "Binary"];
    let of_type = node.children().find(|child| TYPES.contains(&child.tag_name().name()));
    let unit = of_type.and_then(|node| node.attribute("unit")).map(str::to_owned);
    (of_type.map(|node| node.tag_name().name().into()), unit)
}

fn connection(node: Node, lines: &Lines) -> Connection {
    let end = |element: &str, connector: &str| End {
        element: node.attribute(element).map(str::to_owned),
        connector: text_of(node, connector),
    };
    Connection {
        ends: [end("startElement", "startConnector"), end("endElement", "endConnector")],
        unconverted: is_true(node, "suppressUnitConversion"),
        transformation: transformation(node),
        line: lines.line(node),
    }
}

fn binding(node: Node, lines: &Lines) -> Binding {
    let inline = child(node, "ParameterValues").and_then(|values| child(values, "ParameterSet"));
    Binding {
        media: node.attribute("type").unwrap_or("application/x-ssp-parameter-set").into(),
        source: source_of(node),
        within: is_within(node),
        prefix: text_of(node, "prefix"),
        inline: inline.map(|node| Values::of(node, lines)),
        mapping: child(node, "ParameterMapping").map(|node| Mapping::of(node, lines)),
        line: lines.line(node),
    }
}
