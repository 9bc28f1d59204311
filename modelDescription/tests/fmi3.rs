//! The description of FMI 3.0, read back by an XML reader that shares no code with the writer.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};
use strut_model::{Interface, Model};
use strut_model_description::{Header, write_fmi3, write_terminals};

use crate::model::{Mast, Wagon};

fn described<M: Model>() -> (Interface, String) {
    let interface = Interface::of::<M>(None, None).unwrap();
    let header = Header { name: M::ABOUT.name, license: "MIT", version: "1.2.3", ..Header::default() };
    let xml = write_fmi3(&interface, &header);
    (interface, xml)
}

/// The elements below one of the root's children.
fn below<'a>(document: &'a Document<'a>, name: &str) -> Vec<Node<'a, 'a>> {
    let parent = document.root_element().children().find(|child| child.has_tag_name(name));
    parent.unwrap_or_else(|| panic!("no <{name}>")).children().filter(Node::is_element).collect()
}

#[test]
fn a_small_model_is_written_as_expected() {
    // The identifier changes with every declaration of strut-model: it is compared elsewhere.
    let (interface, xml) = described::<Wagon>();
    let text = xml
        .replace(&interface.guid(), "{token}")
        .replace(&format!("Strut {}", env!("CARGO_PKG_VERSION")), "Strut");
    let expected = include_str!("snapshots/wagon-fmi3.xml");
    assert!(text == expected, "tests/snapshots/wagon-fmi3.xml does not agree with this text:\n{text}");
}

#[test]
fn every_variable_is_there_once_with_a_reference_of_its_own() {
    let (interface, xml) = described::<Wagon>();
    let document = Document::parse(&xml).unwrap();
    let nodes = below(&document, "ModelVariables");
    let references: BTreeMap<&str, &str> = nodes
        .iter()
        .map(|node| (node.attribute("valueReference").unwrap(), node.attribute("name").unwrap()))
        .collect();
    assert_eq!(references.len(), nodes.len());
    assert_eq!(nodes.len(), 1 + interface.variables.len() + interface.event_indicators);
    for (position, variable) in interface.variables.iter().enumerate() {
        assert_eq!(references[position.to_string().as_str()], variable.name);
    }
    let indicators = below(&document, "ModelStructure");
    let indicators = indicators.iter().filter(|node| node.has_tag_name("EventIndicator"));
    let names: Vec<&str> =
        indicators.map(|node| references[node.attribute("valueReference").unwrap()]).collect();
    assert_eq!(names.len(), interface.event_indicators);
    assert!(names.iter().all(|name| name.starts_with("event_indicator[")));
}

#[test]
fn an_array_is_one_variable_and_time_a_dependency() {
    let (interface, xml) = described::<Mast>();
    let document = Document::parse(&xml).unwrap();
    let nodes = below(&document, "ModelVariables");
    let named = |name: &str| *nodes.iter().find(|node| node.attribute("name") == Some(name)).unwrap();
    let reference = |name: &str| named(name).attribute("valueReference").unwrap().to_owned();
    let points = named("points");
    assert_eq!(points.attribute("start"), Some("1 2.5 3"));
    assert_eq!((points.attribute("min"), points.attribute("description")), (Some("0"), Some("Points")));
    assert_eq!(points.first_element_child().unwrap().attribute("start"), Some("3"));
    assert!(nodes.iter().all(|node| node.attribute("name") != Some("points[2]")));
    let depends = |element: &str, name: &str| -> Vec<String> {
        let structure = below(&document, "ModelStructure");
        let unknown = structure.iter().find(|node| {
            node.has_tag_name(element) && node.attribute("valueReference") == Some(&reference(name))
        });
        unknown.unwrap().attribute("dependencies").unwrap().split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(depends("Output", "top.height"), [reference("foot.height"), reference("time")]);
    assert_eq!(
        depends("InitialUnknown", "top.height"),
        [reference("foot.height"), reference("points"), reference("time")]
    );
    assert_eq!(depends("Output", "top.left.force"), [reference("foot.height")]);
    assert_eq!(interface.tables.len(), 1);
}

#[test]
fn groups_of_signals_are_terminals() {
    let (interface, _) = described::<Mast>();
    let xml = write_terminals(&interface);
    let document = Document::parse(&xml).unwrap();
    let terminals = below(&document, "Terminals");
    let told: Vec<String> = terminals
        .iter()
        .flat_map(Node::descendants)
        .filter(Node::is_element)
        .map(|node| match node.attribute("variableName") {
            Some(variable) => format!("{} = {variable}", node.attribute("memberName").unwrap()),
            None => node.attribute("name").unwrap().to_owned(),
        })
        .collect();
    assert_eq!(
        told,
        ["foot", "height = foot.height", "top", "height = top.height", "left", "force = top.left.force"]
    );
    // A model without groups has an icon and no terminals.
    assert!(!write_terminals(&described::<Wagon>().0).contains("Terminals>"));
}
