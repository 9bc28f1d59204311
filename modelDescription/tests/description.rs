//! The written description, read back by an XML reader that shares no code with the writer.

use roxmltree::{Document, Node};
use strut_model::{Causality, Initial, Interface, Model, Variability, VariableKind};
use strut_model_description::{Header, write};

use crate::model::{Delay, Wagon};

fn described<M: Model>() -> (Interface, String) {
    let interface = Interface::of::<M>(None, None).unwrap();
    let xml = write(
        &interface,
        &Header { name: M::ABOUT.name, license: "MIT", version: "1.2.3", ..Header::default() },
    );
    (interface, xml)
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Node<'a, 'a> {
    node.children().find(|child| child.has_tag_name(name)).unwrap_or_else(|| panic!("no <{name}>"))
}

fn elements<'a>(node: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(Node::is_element)
}

#[test]
fn a_small_model_is_written_as_expected() {
    // The identifier changes with every declaration of strut-model: it is compared elsewhere.
    let (interface, xml) = described::<Wagon>();
    let text = xml
        .replace(&interface.guid(), "{guid}")
        .replace(&format!("Strut {}", env!("CARGO_PKG_VERSION")), "Strut");
    let expected = include_str!("snapshots/wagon.xml");
    assert!(text == expected, "tests/snapshots/wagon.xml does not agree with what is written:\n{text}");
}

#[test]
fn every_declaration_survives_the_round_trip() {
    let (interface, xml) = described::<Wagon>();
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("guid"), Some(interface.guid().as_str()));
    assert_eq!(root.attribute("license"), Some("MIT"));
    assert_eq!(root.attribute("generationDateAndTime"), None);
    let nodes: Vec<_> = elements(child(root, "ModelVariables")).collect();
    assert_eq!(nodes.len(), interface.variables.len());
    let number = |node: &Node, name: &str| node.attribute(name).map(|text| text.parse::<f64>().unwrap());
    for (node, variable) in nodes.iter().zip(&interface.variables) {
        assert_eq!(node.attribute("name"), Some(variable.name.as_str()));
        assert_eq!(node.attribute("valueReference"), Some(variable.reference.to_string().as_str()));
        assert_eq!(node.attribute("description"), Some(variable.doc.as_str()));
        let kind = node.first_element_child().unwrap();
        match &variable.kind {
            VariableKind::Real { unit, start, min, max, nominal, derivative_of } => {
                assert_eq!(kind.attribute("unit").unwrap_or(""), &*unit.symbol);
                for (name, value) in [("start", start), ("min", min), ("max", max), ("nominal", nominal)] {
                    assert_eq!(number(&kind, name), *value, "{name} of {}", variable.name);
                }
                let index = derivative_of.map(|position| (position + 1).to_string());
                assert_eq!(kind.attribute("derivative"), index.as_deref());
            }
            VariableKind::Integer { start } => assert_eq!(number(&kind, "start"), Some(f64::from(*start))),
            VariableKind::Boolean { start } => {
                assert_eq!(kind.attribute("start"), Some(start.to_string().as_str()));
            }
            VariableKind::Text { start } => assert_eq!(kind.attribute("start"), Some(start.as_str())),
            VariableKind::Choice { enumeration, start } => {
                assert_eq!(kind.attribute("declaredType"), Some(enumeration.name));
                assert_eq!(kind.attribute("start"), Some(start.to_string().as_str()));
            }
        }
    }
}

#[test]
fn markup_quotes_and_umlauts_are_text() {
    let (_, xml) = described::<Wagon>();
    let document = Document::parse(&xml).unwrap();
    assert_eq!(document.root_element().attribute("description"), Some(Wagon::ABOUT.summary));
    assert!(Wagon::ABOUT.summary.contains("\"Größe\" <&>"));
    let file = document.descendants().find(|node| node.attribute("name") == Some("track.file")).unwrap();
    assert_eq!(file.first_element_child().unwrap().attribute("start"), Some("<a> & 'b'.csv"));
}

#[test]
fn units_and_types_that_are_used_are_declared_once() {
    let (_, xml) = described::<Wagon>();
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    let declared: Vec<_> =
        elements(child(root, "UnitDefinitions")).map(|unit| unit.attribute("name").unwrap()).collect();
    let mut used: Vec<_> = document.descendants().filter_map(|node| node.attribute("unit")).collect();
    used.sort_unstable();
    used.dedup();
    assert_eq!(declared, used);
    let types: Vec<_> =
        elements(child(root, "TypeDefinitions")).map(|ty| ty.attribute("name").unwrap()).collect();
    assert_eq!(types, ["Gauge", "SolverMethod"]);
}

/// FMI 2.0.4, table in section 2.2.7: which combinations are legal, and which of them need or must not
/// have a start value.
#[test]
fn combinations_of_causality_variability_and_initial_are_legal() {
    use {Causality as C, Initial as I, Variability as V};
    let legal = |causality, variability, initial| {
        matches!(
            (causality, variability, initial),
            (C::Parameter, V::Fixed | V::Tunable, Some(I::Exact))
                | (C::CalculatedParameter, V::Fixed | V::Tunable, Some(I::Calculated))
                | (C::Input, V::Discrete | V::Continuous, None)
                | (C::Output | C::Local, V::Discrete | V::Continuous, Some(_))
                | (C::Local, V::Fixed | V::Tunable, Some(I::Calculated))
        )
    };
    for (interface, xml) in [described::<Wagon>(), described::<Delay>()] {
        for variable in &interface.variables {
            let (causality, variability, initial) =
                (variable.causality, variable.variability, variable.initial);
            assert!(legal(causality, variability, initial), "{}", variable.name);
            let continuous = variability == Variability::Continuous;
            assert!(!continuous || matches!(variable.kind, VariableKind::Real { .. }), "{}", variable.name);
        }
        let document = Document::parse(&xml).unwrap();
        for node in document.descendants().filter(|node| node.has_tag_name("ScalarVariable")) {
            let start = node.first_element_child().unwrap().attribute("start");
            let needs =
                node.attribute("initial") == Some("exact") || node.attribute("causality") == Some("input");
            assert_eq!(start.is_some(), needs, "{:?}", node.attribute("name"));
        }
    }
}

#[test]
fn references_are_unique_within_a_type() {
    let (_, xml) = described::<Wagon>();
    let document = Document::parse(&xml).unwrap();
    let mut seen: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("ScalarVariable"))
        .map(|node| {
            let ty = node.first_element_child().unwrap().tag_name().name();
            // Enumerations are read with the functions of integers.
            (if ty == "Enumeration" { "Integer" } else { ty }, node.attribute("valueReference").unwrap())
        })
        .collect();
    let count = seen.len();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), count);
}

#[test]
fn the_model_structure_is_complete_and_ascending() {
    for (_, xml) in [described::<Wagon>(), described::<Delay>()] {
        let document = Document::parse(&xml).unwrap();
        let root = document.root_element();
        let variables: Vec<_> = elements(child(root, "ModelVariables")).collect();
        let indices_where = |choose: &dyn Fn(&Node) -> bool| -> Vec<usize> {
            (1..).zip(&variables).filter(|(_, node)| choose(node)).map(|(index, _)| index).collect()
        };
        let has = |node: &Node, name: &str, value: &str| node.attribute(name) == Some(value);
        let is_rate = |node: &Node| node.first_element_child().unwrap().has_attribute("derivative");
        let calculated = |node: &Node| has(node, "initial", "calculated");
        let structure = child(root, "ModelStructure");
        for (list, expected) in [
            ("Outputs", indices_where(&|node| has(node, "causality", "output"))),
            ("Derivatives", indices_where(&is_rate)),
            (
                "InitialUnknowns",
                indices_where(&|node| {
                    let unknown =
                        has(node, "causality", "output") || has(node, "causality", "calculatedParameter");
                    calculated(node) && (unknown || is_rate(node))
                }),
            ),
        ] {
            let Some(list) = structure.children().find(|child| child.has_tag_name(list)) else {
                assert!(expected.is_empty(), "{list} is missing");
                continue;
            };
            let indices: Vec<usize> =
                elements(list).map(|unknown| unknown.attribute("index").unwrap().parse().unwrap()).collect();
            assert_eq!(indices, expected);
            for unknown in elements(list) {
                let on: Vec<usize> = unknown
                    .attribute("dependencies")
                    .expect("a missing list would mean: on everything")
                    .split_whitespace()
                    .map(|index| index.parse().unwrap())
                    .collect();
                assert!(
                    on.is_sorted_by(|a, b| a < b)
                        && on.iter().all(|index| (1..=variables.len()).contains(index))
                );
            }
        }
    }
}

#[test]
fn empty_elements_are_left_out() {
    // No states, no settings, no units but one: nothing to list.
    let (_, xml) = described::<Delay>();
    let document = Document::parse(&xml).unwrap();
    let root = document.root_element();
    assert!(root.children().all(|node| !node.has_tag_name("TypeDefinitions")));
    assert!(child(root, "ModelStructure").children().all(|node| !node.has_tag_name("Derivatives")));
    for node in document.descendants().filter(Node::is_element) {
        let list = ["Definitions", "Categories", "Variables", "Outputs", "Derivatives", "Unknowns"];
        if list.iter().any(|end| node.tag_name().name().ends_with(end)) {
            assert!(elements(node).next().is_some(), "<{}> is empty", node.tag_name().name());
        }
    }
}
