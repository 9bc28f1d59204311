//! Rules for each file by itself, and for what stands in place of one: its schema, its version, what it declares.

use std::collections::HashSet;

use roxmltree::{Document, Node};

use crate::finding::{Finding, repeated};
use crate::lines::Lines;
use crate::rules::{Rule, ssp};
use crate::schema::{self, Element};
use crate::text::{self, Standard};

/// What the sentences of the schema are.
const RULES: schema::Rules = schema::Rules {
    element: ssp::SCHEMA_ELEMENT,
    order: ssp::SCHEMA_ORDER,
    missing: ssp::SCHEMA_MISSING,
    attribute: ssp::SCHEMA_ATTRIBUTE,
    required: ssp::SCHEMA_REQUIRED,
    value: ssp::SCHEMA_VALUE,
    text: ssp::SCHEMA_TEXT,
    finite: None,
};

/// What can stand in place of a file.
static INLINE: [&Element; 3] = [&schema::ssp::PARAMETER_SET, &schema::ssp::MAPPING, &schema::ssp::DICTIONARY];

/// Reads a file with a root element of some name, and checks it by itself.
///
/// # Errors
/// If it is no well-formed XML, or the root is another.
pub fn read<T>(
    bytes: &[u8],
    schema: &Element,
    file: &str,
    read: impl Fn(Node, &Lines) -> T,
) -> Result<(T, Vec<Finding>), String> {
    let (text, mut findings) = text::decoded(bytes, Standard::Ssp, file);
    let document = Document::parse(&text).map_err(|error| format!("is no well-formed XML: {error}"))?;
    let root = document.root_element();
    let (found, wanted) = (root.tag_name().name(), schema.name);
    if found != wanted {
        return Err(format!("is a `{found}` and no `{wanted}`"));
    }
    let lines = Lines::of(&text);
    if root.tag_name().namespace() == schema.namespace {
        findings.extend(alone(root, schema, file, &lines));
    } else {
        let message = format!("`{found}` in {file} is of another namespace");
        let help = format!("it is {}", schema.namespace.unwrap_or("none"));
        let place = format!("{file}:{}", lines.line(root));
        findings.push(Finding::error(ssp::SCHEMA_ELEMENT, message).at(place).help(help));
    }
    Ok((read(root, &lines), findings))
}

/// What is wrong with a document by itself, and with those within it.
fn alone(root: Node, schema: &Element, file: &str, lines: &Lines) -> Vec<Finding> {
    let version = root.attribute("version").unwrap_or_default();
    let mut findings = Vec::new();
    let mut wrong = |rule: &'static Rule, node: Node, message: String| {
        let place = format!("{file}:{}", lines.line(node));
        findings.push(Finding::error(rule, message).at(place));
    };
    // SSP 2.0 is not checked; the description's version is a finding.
    let newer = version.starts_with("2.");
    if !version.is_empty() && version != "1.0" && !newer {
        wrong(ssp::SOURCE_VERSION, root, format!("<{}> is of the version {version}", schema.name));
    }
    let mut own = Vec::new();
    let mut inner = Vec::new();
    collect(root, &mut own, &mut inner);
    let entities: Vec<Node> =
        own.iter().copied().filter(|it| it.tag_name().namespace() == schema.namespace).collect();
    let ids = entities.iter().filter_map(|it| it.attribute("id"));
    let with_id = entities.iter().filter(|it| it.attribute("id").is_some());
    for (node, again) in with_id.zip(repeated(ids)) {
        if again {
            let id = node.attribute("id").unwrap_or_default();
            wrong(ssp::ID_TWICE, *node, format!("two entities have the id `{id}`"));
        }
    }
    let list = |list: &'static str| -> Vec<Node> {
        let lists = root.children().filter(move |it| it.is_element() && it.tag_name().name() == list);
        lists.flat_map(|it| it.children().filter(Node::is_element)).collect()
    };
    let name = |node: &Node| node.attribute("name").map(str::to_owned).unwrap_or_default();
    let (units, enumerations) = (list("Units"), list("Enumerations"));
    for (what, rule, nodes) in
        [("unit", ssp::UNIT_TWICE, &units), ("enumeration", ssp::ENUMERATION_TWICE, &enumerations)]
    {
        let names: Vec<String> = nodes.iter().map(name).collect();
        for (node, again) in nodes.iter().zip(repeated(names.iter().map(String::as_str))) {
            if again {
                wrong(rule, *node, format!("the {what} `{}` is declared twice", name(node)));
            }
        }
    }
    let mut units: HashSet<String> = units.iter().map(name).collect();
    let enumerations: HashSet<String> = enumerations.iter().map(name).collect();
    for node in own {
        let is_type = node.parent_element().is_some_and(|it| it.tag_name().name() != "Enumerations");
        match node.tag_name().name() {
            "Real" => {
                let unit = node.attribute("unit").filter(|unit| !units.contains(*unit));
                if let Some(unit) = unit {
                    wrong(ssp::UNIT_DECLARED, node, format!("the unit `{unit}` is not declared in {file}"));
                    // Once is enough.
                    units.insert(unit.to_owned());
                }
            }
            "Enumeration" if is_type => {
                if let Some(of) = node.attribute("name").filter(|of| !enumerations.contains(*of)) {
                    let message = format!("the enumeration `{of}` is not declared in {file}");
                    wrong(ssp::ENUMERATION_DECLARED, node, message);
                }
            }
            transformation if transformation.ends_with("MappingTransformation") => {
                let entries: Vec<Node> = node.children().filter(Node::is_element).collect();
                let sources = entries.iter().map(|it| it.attribute("source").unwrap_or_default());
                for (entry, again) in entries.iter().zip(repeated(sources)) {
                    let source = entry.attribute("source").unwrap_or_default();
                    if again {
                        let message = format!("two entries of a transformation are for `{source}`");
                        wrong(ssp::MAP_TWICE, *entry, message);
                    }
                }
            }
            "SystemGeometry" => {
                let number = |name: &str| node.attribute(name).and_then(|it| it.trim().parse::<f64>().ok());
                let below = |low: &str, high: &str| Some(number(low)? < number(high)?);
                if [below("x1", "x2"), below("y1", "y2")].contains(&Some(false)) {
                    let message = "a system's canvas does not begin at its lower left corner".to_owned();
                    wrong(ssp::GEOMETRY, node, message);
                }
            }
            _ => {}
        }
    }
    if !newer {
        findings.extend(schema::validate(root, schema, &RULES, file, lines));
    }
    for (node, schema) in inner {
        findings.extend(alone(node, schema, file, lines));
    }
    findings
}

/// The elements of a document itself, and the roots of those that stand in it.
fn collect<'a, 'x>(
    node: Node<'a, 'x>,
    own: &mut Vec<Node<'a, 'x>>,
    inner: &mut Vec<(Node<'a, 'x>, &'static Element)>,
) {
    for child in node.children().filter(Node::is_element) {
        let tag = child.tag_name();
        match INLINE.iter().find(|it| it.name == tag.name() && it.namespace == tag.namespace()) {
            Some(schema) => inner.push((child, schema)),
            None => {
                own.push(child);
                collect(child, own, inner);
            }
        }
    }
}
