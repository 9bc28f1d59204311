//! An FMU, unpacked, and what a host needs to know of its description.

use std::ffi::CString;
use std::fs::File;
use std::path::{Path, PathBuf};

use roxmltree::{Document, Node};
use tempfile::TempDir;

use crate::standard::Version;

/// The types of variables, as the C interface tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `Real`, `Float64`
    Real,
    /// `Integer` or `Enumeration`, `Int32`
    Integer,
    /// `Enumeration` of FMI 3.0
    Choice,
    /// `Boolean`
    Boolean,
    /// `String`
    Text,
}

/// A variable of the description.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its value reference.
    pub reference: u32,
    /// Its type.
    pub kind: Kind,
    /// Its causality, as it is written.
    pub causality: String,
    /// Its variability, as it is written.
    pub variability: String,
    /// Its `initial`, as it is written; empty if it is not.
    pub initial: String,
    /// Start value of a number; zero if there is none.
    pub start: f64,
    /// Least value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Whether the values of the type are listed.
    pub is_choice: bool,
    /// Whether another variable is its derivative.
    pub is_state: bool,
    /// Number of its values.
    pub length: usize,
}

impl Variable {
    /// Whether it is an input.
    pub fn is_input(&self) -> bool {
        self.causality == "input"
    }

    /// Whether a host may set it before initialisation ends (FMI 2.0.4, section 2.2.7: those with a start
    /// value that is not calculated).
    pub fn is_settable(&self) -> bool {
        self.is_input() || self.initial == "exact" || self.initial == "approx"
    }
}

/// An unpacked FMU.
#[derive(Debug)]
pub struct Package {
    /// Its folder, gone with the value.
    folder: TempDir,
    /// `fmiVersion`
    pub version: Version,
    /// `modelIdentifier`
    pub name: String,
    /// `guid`, `instantiationToken`
    pub guid: CString,
    /// The variables.
    pub variables: Vec<Variable>,
    /// Number of continuous states.
    pub states: usize,
    /// Number of event indicators.
    pub event_indicators: usize,
}

impl Package {
    /// Unpacks an FMU.
    ///
    /// # Errors
    /// What cannot be read.
    pub fn open(fmu: &Path) -> Result<Self, String> {
        let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", fmu.display());
        let folder = tempfile::tempdir().map_err(|error| wrong(&error))?;
        let file = File::open(fmu).map_err(|error| wrong(&error))?;
        zip::ZipArchive::new(file)
            .and_then(|mut archive| archive.extract(folder.path()))
            .map_err(|error| wrong(&error))?;
        let xml = std::fs::read_to_string(folder.path().join("modelDescription.xml"))
            .map_err(|error| wrong(&error))?;
        let document = Document::parse(&xml).map_err(|error| wrong(&error))?;
        let root = document.root_element();
        let identifier = document.descendants().find_map(|node| node.attribute("modelIdentifier"));
        let version = match root.attribute("fmiVersion") {
            Some("3.0") => Version::Three,
            _ => Version::Two,
        };
        // FMI 2.0 numbers states by their place in the list, FMI 3.0 by reference.
        let derivatives = document.descendants().filter_map(|node| node.attribute("derivative"));
        let states: Vec<usize> =
            derivatives.map(|text| text.parse().map_err(|error| wrong(&error))).collect::<Result<_, _>>()?;
        let list = root.children().find(|node| node.has_tag_name("ModelVariables"));
        let nodes = list.into_iter().flat_map(|list| list.children()).filter(Node::is_element);
        let read = |(index, node): (usize, Node<'_, '_>)| {
            let typed = if version == Version::Two { node.first_element_child() } else { Some(node) };
            let variable = typed.and_then(|typed| variable(node, typed, version));
            let variable = variable.ok_or_else(|| wrong(&format!("{node:?} is no variable")))?;
            let named = if version == Version::Two { index } else { variable.reference as usize };
            Ok(Variable { is_state: states.contains(&named), ..variable })
        };
        let indicators = document.descendants().filter(|node| node.has_tag_name("EventIndicator")).count();
        let (guid, event_indicators) = match version {
            Version::Two => {
                let number = root.attribute("numberOfEventIndicators").and_then(|text| text.parse().ok());
                ("guid", number.ok_or_else(|| wrong(&"no numberOfEventIndicators"))?)
            }
            Version::Three => ("instantiationToken", indicators),
        };
        Ok(Self {
            version,
            name: identifier.ok_or_else(|| wrong(&"no modelIdentifier"))?.to_owned(),
            guid: CString::new(root.attribute(guid).unwrap_or_default()).map_err(|error| wrong(&error))?,
            variables: (1..).zip(nodes).map(read).collect::<Result<_, String>>()?,
            states: states.len(),
            event_indicators,
            folder,
        })
    }

    /// The shared library for this machine.
    pub fn library(&self) -> PathBuf {
        let folder = match (self.version, cfg!(windows)) {
            (Version::Two, false) => "linux64",
            (Version::Two, true) => "win64",
            (Version::Three, false) => "x86_64-linux",
            (Version::Three, true) => "x86_64-windows",
        };
        let file = format!("{}{}", self.name, std::env::consts::DLL_SUFFIX);
        self.folder.path().join("binaries").join(folder).join(file)
    }

    /// The resources as a URI or, in FMI 3.0, as a path.
    pub fn resources(&self) -> CString {
        let folder = self.folder.path().join("resources");
        let text = match self.version {
            Version::Two => format!("file://{}", folder.display()),
            Version::Three => format!("{}/", folder.display()),
        };
        CString::new(text).expect("a path has no zero bytes")
    }

    /// The reference of time; none in FMI 2.0.
    pub fn time(&self) -> Option<u32> {
        self.variables.iter().find(|variable| variable.causality == "independent").map(|it| it.reference)
    }

    /// How many values references of real variables have together; an unknown one counts as one.
    pub fn values(&self, references: &[u32]) -> usize {
        references.iter().map(|reference| self.length(*reference)).sum()
    }

    /// How many values a real variable has.
    pub fn length(&self, reference: u32) -> usize {
        self.variable(Kind::Real, reference).map_or(1, |variable| variable.length)
    }

    /// The variable of a type with a reference.
    pub fn variable(&self, kind: Kind, reference: u32) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.kind == kind && variable.reference == reference)
    }
}

fn variable(node: Node<'_, '_>, typed: Node<'_, '_>, version: Version) -> Option<Variable> {
    let kind = match typed.tag_name().name() {
        "Real" | "Float64" => Kind::Real,
        "Enumeration" if version == Version::Three => Kind::Choice,
        "Integer" | "Enumeration" | "Int32" => Kind::Integer,
        "Boolean" => Kind::Boolean,
        "String" => Kind::Text,
        _ => return None,
    };
    let dimension = node.children().find(|child| child.has_tag_name("Dimension"));
    let length = dimension.map_or(Some(1), |node| node.attribute("start")?.parse().ok())?;
    let start = typed.attribute("start").and_then(|text| text.split_whitespace().next()?.parse().ok());
    let text = |name| node.attribute(name).unwrap_or_default().to_owned();
    let number = |name: &str, default| match typed.attribute(name) {
        Some(text) => text.parse().ok(),
        None => Some(default),
    };
    Some(Variable {
        reference: node.attribute("valueReference")?.parse().ok()?,
        kind,
        causality: text("causality"),
        variability: text("variability"),
        initial: text("initial"),
        start: start.unwrap_or(0.0),
        min: number("min", f64::NEG_INFINITY)?,
        max: number("max", f64::INFINITY)?,
        is_choice: typed.has_tag_name("Enumeration"),
        is_state: false,
        length,
    })
}
