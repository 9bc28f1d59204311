//! An FMU, unpacked, and what a host needs to know of its description.

use std::ffi::CString;
use std::fs::File;
use std::path::{Path, PathBuf};

use roxmltree::{Document, Node};
use tempfile::TempDir;

/// The types of `ScalarVariable`; enumerations are integers in the C interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `Real`
    Real,
    /// `Integer` or `Enumeration`
    Integer,
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
    /// `modelIdentifier`
    pub name: String,
    /// `guid`
    pub guid: CString,
    /// The variables.
    pub variables: Vec<Variable>,
    /// Number of continuous states.
    pub states: usize,
    /// `numberOfEventIndicators`
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
        let derivatives = document.descendants().filter_map(|node| node.attribute("derivative"));
        let states: Vec<usize> =
            derivatives.map(|text| text.parse().map_err(|error| wrong(&error))).collect::<Result<_, _>>()?;
        let scalars = document.descendants().filter(|node| node.has_tag_name("ScalarVariable"));
        Ok(Self {
            name: identifier.ok_or_else(|| wrong(&"no modelIdentifier"))?.to_owned(),
            guid: CString::new(root.attribute("guid").unwrap_or_default()).map_err(|error| wrong(&error))?,
            variables: (1..)
                .zip(scalars)
                .map(|(index, node)| {
                    let variable =
                        variable(node).ok_or_else(|| wrong(&format!("{node:?} is no variable")))?;
                    Ok(Variable { is_state: states.contains(&index), ..variable })
                })
                .collect::<Result<_, String>>()?,
            states: states.len(),
            event_indicators: root
                .attribute("numberOfEventIndicators")
                .and_then(|text| text.parse().ok())
                .ok_or_else(|| wrong(&"no numberOfEventIndicators"))?,
            folder,
        })
    }

    /// The shared library for this machine.
    pub fn library(&self) -> PathBuf {
        let folder = if cfg!(windows) { "win64" } else { "linux64" };
        let file = format!("{}{}", self.name, std::env::consts::DLL_SUFFIX);
        self.folder.path().join("binaries").join(folder).join(file)
    }

    /// The resources as a URI.
    pub fn resources(&self) -> CString {
        let folder = self.folder.path().join("resources");
        CString::new(format!("file://{}", folder.display())).expect("a path has no zero bytes")
    }

    /// The variable of a type with a reference.
    pub fn variable(&self, kind: Kind, reference: u32) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.kind == kind && variable.reference == reference)
    }
}

fn variable(node: Node<'_, '_>) -> Option<Variable> {
    let typed = node.first_element_child()?;
    let kind = match typed.tag_name().name() {
        "Real" => Kind::Real,
        "Integer" | "Enumeration" => Kind::Integer,
        "Boolean" => Kind::Boolean,
        "String" => Kind::Text,
        _ => return None,
    };
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
        start: typed.attribute("start").and_then(|text| text.parse().ok()).unwrap_or(0.0),
        min: number("min", f64::NEG_INFINITY)?,
        max: number("max", f64::INFINITY)?,
        is_choice: typed.has_tag_name("Enumeration"),
        is_state: false,
    })
}
