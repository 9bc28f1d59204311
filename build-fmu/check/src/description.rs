//! The model description, read as it is: what is wrong with it is for the rules to find.

use std::collections::{BTreeMap, HashMap};

use roxmltree::{Document, Node};

use crate::lines::Lines;
use crate::unit::Unit;

/// What stands in `modelDescription.xml`.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// `2.0`.
    pub version: String,
    /// Identifier that the library has to know.
    pub guid: Option<String>,
    /// Whether names are declared to be structured.
    pub structured: bool,
    /// Number of event indicators.
    pub event_indicators: usize,
    /// Co-simulation and model exchange, as far as they are there.
    pub interfaces: Vec<Interface>,
    /// The declared units.
    pub units: Vec<Unit>,
    /// Declared types by name: element and unit.
    pub types: BTreeMap<String, (String, Option<String>)>,
    /// All that is declared by a name, in the order of the document.
    pub declared: Vec<Declared>,
    /// Default experiment: start, stop, tolerance, step.
    pub experiment: Experiment,
    /// Variables in their order; the first has the index 1.
    pub variables: Vec<Variable>,
    /// Index of the first variable of each name.
    names: HashMap<String, usize>,
    /// `ModelStructure/Outputs`.
    pub outputs: Vec<Unknown>,
    /// `ModelStructure/Derivatives`.
    pub derivatives: Vec<Unknown>,
    /// `ModelStructure/InitialUnknowns`.
    pub initial_unknowns: Vec<Unknown>,
}

/// Which of FMI's two interfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Kind {
    /// Co-simulation: it integrates itself.
    CoSimulation,
    /// Model exchange: it is integrated.
    ModelExchange,
}

/// An interface with its capabilities.
#[derive(Clone, Debug)]
pub struct Interface {
    /// Which.
    pub kind: Kind,
    /// Name of the library, without its ending.
    pub identifier: String,
    /// Flags and numbers as they stand there.
    attributes: BTreeMap<String, String>,
    /// Line of the element.
    pub line: u32,
}

impl Interface {
    /// Whether a capability is declared.
    pub fn can(&self, capability: &str) -> bool {
        self.attributes.get(capability).is_some_and(|value| matches!(value.as_str(), "true" | "1"))
    }
}

/// `<DefaultExperiment>`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Experiment {
    /// Start in seconds.
    pub start: Option<f64>,
    /// End in seconds.
    pub stop: Option<f64>,
    /// Relative tolerance.
    pub tolerance: Option<f64>,
    /// Step in seconds.
    pub step: Option<f64>,
    /// Line of the element.
    pub line: u32,
}

/// `<ScalarVariable>`.
#[derive(Clone, Debug, Default)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// Value reference.
    pub reference: Option<u32>,
    /// Description.
    pub description: Option<String>,
    /// Causality, `local` if it is not given.
    pub causality: String,
    /// Variability, `continuous` if it is not given.
    pub variability: String,
    /// Initial, if it is given.
    pub initial: Option<String>,
    /// Name of the element: Real, Integer, Boolean, String, Enumeration; empty if there is none.
    pub kind: String,
    /// Start value, as it stands there.
    pub start: Option<String>,
    /// Unit, its type's if it has none of its own.
    pub unit: Option<String>,
    /// Type.
    pub declared_type: Option<String>,
    /// Smallest legal value.
    pub min: Option<f64>,
    /// Largest legal value.
    pub max: Option<f64>,
    /// Typical magnitude.
    pub nominal: Option<f64>,
    /// Index of the variable that it is the derivative of.
    pub derivative: Option<usize>,
    /// Line of the element.
    pub line: u32,
}

impl Variable {
    /// Initial, by the standard's table where it is not given; none for those that have none, and for
    /// illegal combinations.
    pub fn effective_initial(&self) -> Option<&str> {
        if let Some(initial) = &self.initial {
            return Some(initial);
        }
        match (self.causality.as_str(), self.variability.as_str()) {
            ("parameter", _) | ("output" | "local", "constant") => Some("exact"),
            ("calculatedParameter", _) | ("output" | "local", _) => Some("calculated"),
            _ => None,
        }
    }
}

/// `<Unknown>` of the model structure.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Index of its variable, from 1; 0 if it is not given or no number.
    pub index: usize,
    /// Indices of what it depends on; none if that is not told.
    pub dependencies: Option<Vec<usize>>,
    /// Number of dependencies' kinds, if they are given.
    pub kinds: Option<usize>,
    /// Line of the element.
    pub line: u32,
}

impl Description {
    /// Reads the document.
    ///
    /// # Errors
    /// If it is no well-formed XML or no model description.
    pub fn parse(text: &str) -> Result<Self, String> {
        let document = Document::parse(text)
            .map_err(|error| format!("modelDescription.xml is no well-formed XML: {error}"))?;
        let root = document.root_element();
        if root.tag_name().name() != "fmiModelDescription" {
            let found = root.tag_name().name();
            return Err(format!("modelDescription.xml is a `{found}` and no `fmiModelDescription`"));
        }
        let lines = Lines::of(text);
        let line = |node: Node| lines.line(node);
        let child = |name: &str| root.children().find(|node| node.has_tag_name(name));
        let text = |node: Node, name: &str| node.attribute(name).map(str::to_owned);
        let mut description = Self {
            version: text(root, "fmiVersion").unwrap_or_default(),
            guid: text(root, "guid"),
            structured: root.attribute("variableNamingConvention") == Some("structured"),
            event_indicators: value(root, "numberOfEventIndicators").unwrap_or(0),
            ..Self::default()
        };
        for (name, kind) in [("CoSimulation", Kind::CoSimulation), ("ModelExchange", Kind::ModelExchange)] {
            description.interfaces.extend(child(name).map(|node| Interface {
                kind,
                identifier: text(node, "modelIdentifier").unwrap_or_default(),
                attributes: node.attributes().map(|it| (it.name().into(), it.value().into())).collect(),
                line: line(node),
            }));
        }
        description.declared = declared(root, &lines);
        for unit in child("UnitDefinitions").into_iter().flat_map(|node| elements(node, "Unit")) {
            // What its numbers are the schema tells; the unit is declared all the same.
            let named = || Unit::named(unit.attribute("name").unwrap_or_default());
            description.units.push(Unit::parse(unit).unwrap_or_else(|_| named()));
        }
        for ty in child("TypeDefinitions").into_iter().flat_map(|node| elements(node, "SimpleType")) {
            let kind = ty.children().find(Node::is_element);
            let unit = kind.and_then(|kind| text(kind, "unit"));
            let kind = kind.map_or_else(String::new, |kind| kind.tag_name().name().into());
            description.types.insert(text(ty, "name").unwrap_or_default(), (kind, unit));
        }
        if let Some(node) = child("DefaultExperiment") {
            description.experiment = Experiment {
                start: value(node, "startTime"),
                stop: value(node, "stopTime"),
                tolerance: value(node, "tolerance"),
                step: value(node, "stepSize"),
                line: line(node),
            };
        }
        for node in child("ModelVariables").into_iter().flat_map(|node| elements(node, "ScalarVariable")) {
            description.variables.push(variable(node, line(node), &description.types));
        }
        for (index, variable) in (1..).zip(&description.variables) {
            description.names.entry(variable.name.clone()).or_insert(index);
        }
        let structure = child("ModelStructure");
        let list = |name: &str| -> Vec<Unknown> {
            let list = structure.and_then(|node| node.children().find(|node| node.has_tag_name(name)));
            let unknowns = list.into_iter().flat_map(|node| elements(node, "Unknown"));
            unknowns.map(|node| unknown(node, line(node))).collect()
        };
        description.outputs = list("Outputs");
        description.derivatives = list("Derivatives");
        description.initial_unknowns = list("InitialUnknowns");
        Ok(description)
    }

    /// The variable of an index, which counts from 1.
    pub fn variable(&self, index: usize) -> Option<&Variable> {
        self.variables.get(index.checked_sub(1)?)
    }

    /// The variable of a name.
    pub fn named(&self, name: &str) -> Option<&Variable> {
        self.variable(*self.names.get(name)?)
    }

    /// The interface of a kind.
    pub fn interface(&self, kind: Kind) -> Option<&Interface> {
        self.interfaces.iter().find(|interface| interface.kind == kind)
    }
}

/// Something that is declared by a name, or a value, of which there may be one.
#[derive(Clone, Debug, PartialEq)]
pub struct Declared {
    /// What it is: `unit`, `type`.
    pub what: &'static str,
    /// In what: nothing, or the type or unit that it belongs to.
    pub within: String,
    /// Its name.
    pub name: String,
    /// Factor to another unit, if there is one.
    pub factor: Option<String>,
    /// Line of the element.
    pub line: u32,
}

/// Units with their display units, types with their items (by name and by value), log categories.
fn declared(root: Node, lines: &Lines) -> Vec<Declared> {
    let mut all = Vec::new();
    let mut add = |what, within: &str, node: Node, name: &str, factor: Option<&str>| {
        all.push(Declared {
            what,
            within: within.into(),
            name: name.into(),
            factor: factor.map(str::to_owned),
            line: lines.line(node),
        });
    };
    let name = |node: Node| node.attribute("name").unwrap_or_default().to_owned();
    let list = |list: &'static str, item: &'static str| {
        let found = root.children().find(move |node| node.has_tag_name(list));
        found.into_iter().flat_map(move |node| elements(node, item))
    };
    for unit in list("UnitDefinitions", "Unit") {
        let base = unit.children().find(|node| node.has_tag_name("BaseUnit"));
        add("unit", "", unit, &name(unit), base.and_then(|base| base.attribute("factor")));
        for display in elements(unit, "DisplayUnit") {
            add("display unit", &name(unit), display, &name(display), display.attribute("factor"));
        }
    }
    for ty in list("TypeDefinitions", "SimpleType") {
        add("type", "", ty, &name(ty), None);
        for item in ty.children().filter(Node::is_element).flat_map(|kind| elements(kind, "Item")) {
            add("item", &name(ty), item, &name(item), None);
            add("item's value", &name(ty), item, item.attribute("value").unwrap_or_default().trim(), None);
        }
    }
    for category in list("LogCategories", "Category") {
        add("log category", "", category, &name(category), None);
    }
    all
}

fn elements<'a, 'input>(node: Node<'a, 'input>, name: &'a str) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |node| node.has_tag_name(name))
}

fn value<T: std::str::FromStr>(node: Node, name: &str) -> Option<T> {
    node.attribute(name)?.trim().parse().ok()
}

fn variable(node: Node, line: u32, types: &BTreeMap<String, (String, Option<String>)>) -> Variable {
    let text = |name: &str| node.attribute(name).map(str::to_owned);
    const KINDS: [&str; 5] = ["Real", "Integer", "Boolean", "String", "Enumeration"];
    let kind = node.children().find(|child| KINDS.contains(&child.tag_name().name()));
    let declared_type = kind.and_then(|kind| kind.attribute("declaredType")).map(str::to_owned);
    let inherited = declared_type.as_ref().and_then(|name| types.get(name)?.1.clone());
    let number = |name: &str| kind.and_then(|kind| value(kind, name));
    Variable {
        name: text("name").unwrap_or_default(),
        reference: value(node, "valueReference"),
        description: text("description"),
        causality: text("causality").unwrap_or_else(|| "local".into()),
        variability: text("variability").unwrap_or_else(|| "continuous".into()),
        initial: text("initial"),
        kind: kind.map_or_else(String::new, |kind| kind.tag_name().name().into()),
        start: kind.and_then(|kind| kind.attribute("start")).map(str::to_owned),
        unit: kind.and_then(|kind| kind.attribute("unit")).map(str::to_owned).or(inherited),
        declared_type,
        min: number("min"),
        max: number("max"),
        nominal: number("nominal"),
        derivative: kind.and_then(|kind| value(kind, "derivative")),
        line,
    }
}

fn unknown(node: Node, line: u32) -> Unknown {
    let list = |name: &str| node.attribute(name).map(str::split_whitespace);
    Unknown {
        index: value(node, "index").unwrap_or(0),
        dependencies: list("dependencies").map(|items| items.map(|item| item.parse().unwrap_or(0)).collect()),
        kinds: list("dependenciesKind").map(Iterator::count),
        line,
    }
}
