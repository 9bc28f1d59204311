//! Systems: components and the connections between them.

mod adapter;
mod check;
mod face;
mod ssp;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_theirs;
mod theirs;
mod wire;

use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;

use indexmap::IndexMap;
use serde::Deserialize;
use strut_model::Value;
use toml::Value as Toml;

pub use adapter::{Adapter, stated_unit};
pub use face::Face;
pub use theirs::Theirs;

use crate::failure::{Failure, Result};

/// A composition of FMUs, from a TOML file.
///
/// ```toml
/// name = "quanser-lqr"
/// title = "Active suspension with state feedback"
/// source = "Quanser 3.1"
/// components = { road = "QuanserRoad", rig = "QuanserQuarterCar", seat = { fmu = "seat.fmu" } } # one is of others
/// connections = [
///     "road.position -> rig.road.position",                            # first the component, then its variable
///     { from = "rig.body.acceleration", to = "seat.force", factor = -80.0 },
/// ]
/// outputs = ["rig.body.position"]                                      # what to look at
///
/// [experiment]
/// stop = 10.0
/// step = 1e-3
///
/// [parameters]
/// "road.frequency" = { value = 0.3, unit = "Hz" }
/// ```
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct System {
    /// Name of the SSP.
    pub name: String,
    /// What it is, one sentence.
    pub title: String,
    /// Where it is from.
    pub source: String,
    /// FMU of each component, in the order of calculation.
    pub components: IndexMap<String, Part>,
    connections: Vec<Line>,
    /// What multiplies a signal that is connected with a factor.
    #[serde(default)]
    factors: Factors,
    /// What to look at.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// How to run it.
    pub experiment: Experiment,
    #[serde(default)]
    parameters: IndexMap<String, Toml>,
}

/// How a system is run.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// End in seconds; it starts at zero.
    pub stop: f64,
    /// Communication step in seconds.
    pub step: f64,
}

/// What a component is made of.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(
    untagged,
    expecting = "a component is the name of an FMU, { parameters = \"my-set.toml\" } for one with a parameter set of your own, \
                 or { fmu = \"path.fmu\" } for one of others, with units = \"SI\" if what declares no unit is in SI units"
)]
pub enum Part {
    /// An FMU of the catalogue, by its name.
    Ours(String),
    /// One of our models with a parameter set in a file.
    Set(OwnSet),
    /// A file that others have made.
    Theirs(Foreign),
}

impl Display for Part {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ours(name) => write!(f, "{name}"),
            Self::Set(set) => write!(f, "{}", set.parameters.display()),
            Self::Theirs(foreign) => write!(f, "{}", foreign.fmu.display()),
        }
    }
}

/// One of our models with a parameter set of its own.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct OwnSet {
    /// The file of the set, from the folder of the system's. Files that it brings are beside it.
    pub parameters: PathBuf,
}

/// An FMU that others have made.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Foreign {
    /// Its file, from the folder of the system's.
    pub fmu: PathBuf,
    /// In which units its variables are that declare none; not given if nobody knows.
    #[serde(default)]
    pub units: Option<Units>,
}

/// A system of units.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Units {
    /// The coherent units of the SI.
    #[serde(rename = "SI")]
    Si,
}

/// A connection as it is written.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a connection is \"road.position -> rig.road.position\", or { from = \"...\", to = \"...\" } with some of \
                 factor, offset, operation (\"value\", \"derivative\", \"integral\" or \"lag\"), filter, initial"
)]
enum Line {
    Plain(String),
    Adapted(Adapted),
}

impl Line {
    /// Where it comes from, and where it goes; what is done to the signal on the way stands with the latter.
    fn ends(&self) -> (String, String) {
        match self {
            Self::Plain(text) => {
                let (from, to) = text.split_once("->").unwrap_or((text, ""));
                (from.trim().into(), to.trim().into())
            }
            Self::Adapted(adapted) => {
                let numbers = [
                    ("factor", adapted.factor),
                    ("offset", adapted.offset),
                    ("filter", adapted.filter),
                    ("initial", adapted.initial),
                ];
                let numbers =
                    numbers.iter().filter_map(|(name, value)| Some(format!("{name} {}", (*value)?)));
                let operation = adapted.operation.map(|it| format!("{it:?}").to_lowercase());
                let done: Vec<String> = operation.into_iter().chain(numbers).collect();
                let done = if done.is_empty() { String::new() } else { format!(" ({})", done.join(", ")) };
                (adapted.from.clone(), format!("{}{done}", adapted.to))
            }
        }
    }
}

/// A connection between different conventions.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Adapted {
    from: String,
    to: String,
    factor: Option<f64>,
    offset: Option<f64>,
    operation: Option<adapter::Operation>,
    filter: Option<f64>,
    initial: Option<f64>,
}

/// What multiplies a signal that is connected with a factor.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Factors {
    /// A component of its own, which every master runs.
    #[default]
    Component,
    /// The connection, by SSP's LinearTransformation, which some masters pass over.
    Connection,
}

/// A component as it is packed.
#[derive(Clone, Debug)]
pub struct Packed<'a> {
    /// What it is, in one sentence.
    pub title: &'a str,
    /// Its file's name.
    pub file: String,
    /// The file.
    pub bytes: &'a [u8],
}

/// A variable of a component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// The component's name.
    pub component: String,
    /// The variable's.
    pub variable: String,
}

/// A start value for a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The variable.
    pub port: Port,
    /// Its value.
    pub value: Value,
    /// In this unit; none for settings.
    pub unit: Option<String>,
}

/// Whether OMSimulator accepts a name: until March 2026 it refused the whole system otherwise.
fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

impl System {
    /// Reads the TOML form; `file` is named in messages.
    ///
    /// # Errors
    /// If the text is no TOML of this form.
    pub fn parse(file: &str, text: &str) -> Result<Self> {
        let system: Self = toml::from_str(text).map_err(|error| {
            Failure::new(format!("the system `{file}` is broken: {}", error.to_string().trim_end()))
        })?;
        let own = system.identifier();
        if let Some(name) =
            [&own].into_iter().chain(system.components.keys()).find(|name| !is_identifier(name))
        {
            return Err(Failure::new(format!("the system `{file}` has the name `{name}` in it"))
                .help("a component's name is a letter, then letters, digits and `_`: OMSimulator takes no other")
                .help("a system's name may have `-` as well, which is `_` in its SSD"));
        }
        let Experiment { stop, step } = system.experiment;
        if !(step > 0.0 && stop >= step && stop.is_finite()) {
            return Err(Failure::new(format!(
                "the experiment of the system `{file}` cannot stop at {stop} s in steps of {step} s"
            )));
        }
        Ok(system)
    }

    /// Its name in the SSD: the file's, with `_` for `-`.
    pub fn identifier(&self) -> String {
        self.name.replace('-', "_")
    }

    /// Checks names, roles, units and values against the components, which are in their order. Returns what has to
    /// stand between them.
    ///
    /// # Errors
    /// All mistakes, by name.
    pub fn check(&self, faces: &[Face]) -> Result<Vec<Adapter>> {
        check::Checked::new(self, faces).map(|checked| checked.adapters)
    }

    /// The SSP. The components are in the order of the system's, followed by the adapters; it has been checked.
    pub fn pack(&self, faces: &[Face], components: &[Packed]) -> Vec<u8> {
        let checked = check::Checked::new(self, faces).expect("a system is checked before it is packed");
        ssp::archive(self, &checked, components)
    }

    /// Where each connection comes from, and where it goes with what is done to the signal on the way.
    pub fn ends(&self) -> impl Iterator<Item = (String, String)> {
        self.connections.iter().map(Line::ends)
    }

    /// The parameters, with nested tables flattened to dotted names; and those that are not understood.
    pub fn settings(&self) -> (Vec<Setting>, Vec<Failure>) {
        let (mut settings, mut broken) = (Vec::new(), Vec::new());
        for (name, value) in &self.parameters {
            broken.extend(self.collect(name, value, &mut settings).err());
        }
        (settings, broken)
    }

    fn collect(&self, name: &str, value: &Toml, into: &mut Vec<Setting>) -> Result<()> {
        let wrong = || {
            Failure::new(format!("the parameter `{name}` of the system {} is not understood", self.name))
                .help("write \"component.variable\" = { value = 1.0, unit = \"m\" }")
        };
        let table = value.as_table().ok_or_else(wrong)?;
        let Some(value) = table.get("value") else {
            return table
                .iter()
                .try_for_each(|(key, value)| self.collect(&format!("{name}.{key}"), value, into));
        };
        if table.keys().any(|key| !matches!(key.as_str(), "value" | "unit" | "source")) {
            return Err(wrong());
        }
        let value = match value {
            Toml::Float(number) => Value::Real(*number),
            Toml::Integer(number) => Value::Integer(i32::try_from(*number).map_err(|_| wrong())?),
            Toml::Boolean(flag) => Value::Boolean(*flag),
            Toml::String(text) => Value::Text(text.clone()),
            _ => return Err(wrong()),
        };
        let unit =
            table.get("unit").map(|unit| unit.as_str().map(str::to_owned).ok_or_else(wrong)).transpose()?;
        into.push(Setting { port: self.port(name)?, value, unit });
        Ok(())
    }

    /// `rig.body.position` is the variable `body.position` of the component `rig`.
    fn port(&self, text: &str) -> Result<Port> {
        match text.trim().split_once('.') {
            Some((component, variable)) if !variable.is_empty() => {
                Ok(Port { component: component.into(), variable: variable.into() })
            }
            _ => Err(Failure::new(format!(
                "`{text}` in the system {} names no variable of a component",
                self.name
            ))
            .help("write the component, a dot, and the variable: `rig.body.position`")),
        }
    }
}
