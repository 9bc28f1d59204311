//! The model description, read as it is: what is wrong with it is for the rules to find.

mod three;

use std::collections::{BTreeMap, HashMap};

use roxmltree::Node;

use crate::declared::{Declared, declared};
use crate::lines::Lines;
use crate::unit::Unit;

/// A version of the interface that libraries are run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl Version {
    /// Prefix of the names of its functions and types.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Two => "fmi2",
            Self::Three => "fmi3",
        }
    }
}

/// What stands in `modelDescription.xml`.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// `2.0`.
    pub version: String,
    /// Identifier that the library has to know: in FMI 3.0, the instantiationToken.
    pub guid: Option<String>,
    /// When it was made, as it stands there.
    pub date: Option<String>,
    /// Whether names are declared to be structured.
    pub structured: bool,
    /// Number of event indicators.
    pub event_indicators: usize,
    /// Co-simulation and model exchange, as far as they are there.
    pub interfaces: Vec<Interface>,
    /// The declared units.
    pub units: Vec<Unit>,
    /// Declared types by name.
    pub types: BTreeMap<String, SimpleType>,
    /// The declared log categories.
    pub categories: Vec<String>,
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
    /// The files that are to be compiled.
    pub sources: Vec<String>,
    /// Line of the element.
    pub line: u32,
}

impl Interface {
    /// Whether a capability is declared.
    pub fn can(&self, capability: &str) -> bool {
        self.attributes.get(capability).is_some_and(|value| matches!(value.as_str(), "true" | "1"))
    }

    /// A number that is declared, 0 if it is not.
    pub fn number(&self, capability: &str) -> usize {
        self.attributes.get(capability).and_then(|value| value.trim().parse().ok()).unwrap_or(0)
    }
}

/// `<SimpleType>`.
#[derive(Clone, Debug, Default)]
pub struct SimpleType {
    /// Name of the element: Real, Integer, Boolean, String, Enumeration; empty if there is none.
    pub kind: String,
    /// Unit.
    pub unit: Option<String>,
    /// Unit to be shown.
    pub display_unit: Option<String>,
    /// Smallest and largest legal value.
    pub bounds: [Option<f64>; 2],
    /// Typical magnitude.
    pub nominal: Option<f64>,
    /// Values of an enumeration's items.
    pub items: Vec<i32>,
    /// Line of the element.
    pub line: u32,
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
    /// Name of the element: Real, Integer, Boolean, String, Enumeration; empty if there is none. Types of FMI 3.0
    /// that correspond to them have the same names.
    pub kind: String,
    /// Start value, as it stands there.
    pub start: Option<String>,
    /// Unit, its type's if it has none of its own.
    pub unit: Option<String>,
    /// Unit to be shown, its own.
    pub display_unit: Option<String>,
    /// Type.
    pub declared_type: Option<String>,
    /// Smallest legal value, its type's if it has none of its own.
    pub min: Option<f64>,
    /// Largest legal value, likewise.
    pub max: Option<f64>,
    /// Typical magnitude, likewise.
    pub nominal: Option<f64>,
    /// Index of the variable that it is the derivative of.
    pub derivative: Option<usize>,
    /// Whether the attribute `reinit` is there.
    pub reinit: bool,
    /// Whether the attribute `canHandleMultipleSetPerTimeInstant` is there.
    pub multiple_set: bool,
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
    /// Dependencies' kinds, if they are given.
    pub kinds: Option<Vec<String>>,
    /// Line of the element.
    pub line: u32,
}

impl Description {
    /// Reads the document.
    ///
    /// # Errors
    /// If it is no model description.
    pub fn of(root: Node, lines: &Lines) -> Result<Self, String> {
        if root.tag_name().name() != "fmiModelDescription" {
            let found = root.tag_name().name();
            return Err(format!("modelDescription.xml is a `{found}` and no `fmiModelDescription`"));
        }
        let line = |node: Node| lines.line(node);
        let child = |name: &str| root.children().find(|node| node.has_tag_name(name));
        let text = |node: Node, name: &str| node.attribute(name).map(str::to_owned);
        let mut description = Self {
            version: text(root, "fmiVersion").unwrap_or_default(),
            guid: text(root, "guid"),
            date: text(root, "generationDateAndTime"),
            structured: root.attribute("variableNamingConvention") == Some("structured"),
            event_indicators: value(root, "numberOfEventIndicators").unwrap_or(0),
            ..Self::default()
        };
        description.experiment = experiment(root, lines);
        for (name, kind) in [("CoSimulation", Kind::CoSimulation), ("ModelExchange", Kind::ModelExchange)] {
            description.interfaces.extend(elements(root, name).map(|node| {
                Interface {
                    kind,
                    sources: elements(node, "SourceFiles")
                        .flat_map(|list| elements(list, "File"))
                        .filter_map(|file| text(file, "name"))
                        .collect(),
                    identifier: text(node, "modelIdentifier").unwrap_or_default(),
                    attributes: node.attributes().map(|it| (it.name().into(), it.value().into())).collect(),
                    line: line(node),
                }
            }));
        }
        if description.runs_as() == Some(Version::Three) {
            description.guid = text(root, "instantiationToken");
            description.variables = three::variables(root, lines);
            description.note_names();
            return Ok(description);
        }
        description.declared = declared(root, lines);
        for unit in child("UnitDefinitions").into_iter().flat_map(|node| elements(node, "Unit")) {
            // What its numbers are the schema tells; the unit is declared all the same.
            let named = || Unit::named(unit.attribute("name").unwrap_or_default());
            description.units.push(Unit::parse(unit).unwrap_or_else(|_| named()));
        }
        for ty in child("TypeDefinitions").into_iter().flat_map(|node| elements(node, "SimpleType")) {
            description.types.insert(text(ty, "name").unwrap_or_default(), simple_type(ty, line(ty)));
        }
        let categories = child("LogCategories").into_iter().flat_map(|node| elements(node, "Category"));
        description.categories = categories.filter_map(|node| text(node, "name")).collect();
        for node in child("ModelVariables").into_iter().flat_map(|node| elements(node, "ScalarVariable")) {
            description.variables.push(variable(node, line(node), &description.types));
        }
        description.note_names();
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

    /// Whether it is FMI 1.0 or 3.0; a version that is none is for the schema.
    pub fn is_of_another_version(&self) -> bool {
        self.runs_as() != Some(Version::Two)
    }

    /// The interface that its library has; none for FMI 1.0.
    pub fn runs_as(&self) -> Option<Version> {
        match self.version.split('.').next() {
            Some("1") => None,
            Some("3") => Some(Version::Three),
            _ => Some(Version::Two),
        }
    }

    fn note_names(&mut self) {
        for (index, variable) in (1..).zip(&self.variables) {
            self.names.entry(variable.name.clone()).or_insert(index);
        }
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

/// The children of a name.
pub fn elements<'a, 'input>(node: Node<'a, 'input>, name: &'a str) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(move |node| node.has_tag_name(name))
}

fn value<T: std::str::FromStr>(node: Node, name: &str) -> Option<T> {
    node.attribute(name)?.trim().parse().ok()
}

fn experiment(root: Node, lines: &Lines) -> Experiment {
    let node = root.children().find(|node| node.has_tag_name("DefaultExperiment"));
    node.map_or_else(Experiment::default, |node| Experiment {
        start: value(node, "startTime"),
        stop: value(node, "stopTime"),
        tolerance: value(node, "tolerance"),
        step: value(node, "stepSize"),
        line: lines.line(node),
    })
}

fn simple_type(node: Node, line: u32) -> SimpleType {
    let Some(kind) = node.children().find(Node::is_element) else {
        return SimpleType { line, ..SimpleType::default() };
    };
    SimpleType {
        kind: kind.tag_name().name().into(),
        unit: kind.attribute("unit").map(str::to_owned),
        display_unit: kind.attribute("displayUnit").map(str::to_owned),
        bounds: [value(kind, "min"), value(kind, "max")],
        nominal: value(kind, "nominal"),
        items: elements(kind, "Item").filter_map(|item| value(item, "value")).collect(),
        line,
    }
}

fn variable(node: Node, line: u32, types: &BTreeMap<String, SimpleType>) -> Variable {
    let text = |name: &str| node.attribute(name).map(str::to_owned);
    const KINDS: [&str; 5] = ["Real", "Integer", "Boolean", "String", "Enumeration"];
    let kind = node.children().find(|child| KINDS.contains(&child.tag_name().name()));
    let declared_type = kind.and_then(|kind| kind.attribute("declaredType")).map(str::to_owned);
    let ty = declared_type.as_ref().and_then(|name| types.get(name));
    let number = |name: &str| kind.and_then(|kind| value(kind, name));
    let own = |name: &str| kind.and_then(|kind| kind.attribute(name)).map(str::to_owned);
    Variable {
        name: text("name").unwrap_or_default(),
        reference: value(node, "valueReference"),
        description: text("description"),
        causality: text("causality").unwrap_or_else(|| "local".into()),
        variability: text("variability").unwrap_or_else(|| "continuous".into()),
        initial: text("initial"),
        kind: kind.map_or_else(String::new, |kind| kind.tag_name().name().into()),
        start: own("start"),
        unit: own("unit").or_else(|| ty?.unit.clone()),
        display_unit: own("displayUnit"),
        min: number("min").or_else(|| ty?.bounds[0]),
        max: number("max").or_else(|| ty?.bounds[1]),
        nominal: number("nominal").or_else(|| ty?.nominal),
        declared_type,
        derivative: kind.and_then(|kind| value(kind, "derivative")),
        reinit: own("reinit").is_some(),
        multiple_set: text("canHandleMultipleSetPerTimeInstant").is_some(),
        line,
    }
}

fn unknown(node: Node, line: u32) -> Unknown {
    let list = |name: &str| node.attribute(name).map(str::split_whitespace);
    Unknown {
        index: value(node, "index").unwrap_or(0),
        dependencies: list("dependencies").map(|items| items.map(|item| item.parse().unwrap_or(0)).collect()),
        kinds: list("dependenciesKind").map(|items| items.map(str::to_owned).collect()),
        line,
    }
}
