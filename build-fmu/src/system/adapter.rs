//! What stands between components of different conventions.

use serde::Deserialize;
use strut_check::unit::Unit;

use super::{Adapted, System};

/// What becomes of a signal before factor and offset.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Operation {
    /// It stays what it is.
    #[default]
    Value,
    /// Its rate of change.
    Derivative,
    /// Its integral.
    Integral,
    /// What a sensor with a lag shows of it.
    Lag,
}

impl Operation {
    /// The power of time that it multiplies the signal's unit by.
    pub fn power_of_time(self) -> i32 {
        match self {
            Self::Value | Self::Lag => 0,
            Self::Derivative => -1,
            Self::Integral => 1,
        }
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Derivative => "derivative",
            Self::Integral => "integral",
            Self::Lag => "lag",
        }
    }
}

/// How a signal is adapted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation {
    /// What becomes of it first.
    pub operation: Operation,
    /// Factor; none where the units are to agree.
    pub factor: Option<f64>,
    /// What is added.
    pub offset: f64,
    /// Time constant of a lag, or of the filter of a rate of change, in seconds.
    pub filter: f64,
    /// Integral at the start.
    pub initial: f64,
}

impl Adaptation {
    /// As it is written; none if nothing is.
    pub(super) fn of(line: &Adapted) -> Option<Self> {
        let Adapted { factor, offset, operation, filter, initial, .. } = line;
        let told = factor.or(*offset).or(*filter).or(*initial).is_some() || operation.is_some();
        told.then(|| Self {
            operation: operation.unwrap_or_default(),
            factor: *factor,
            offset: offset.unwrap_or(0.0),
            filter: filter.unwrap_or(0.0),
            initial: initial.unwrap_or(0.0),
        })
    }

    /// Whether the signal stays as it is.
    pub fn is_none(&self) -> bool {
        self.operation == Operation::Value && self.factor() == 1.0 && self.offset == 0.0
    }

    /// The factor.
    pub fn factor(&self) -> f64 {
        self.factor.unwrap_or(1.0)
    }
}

/// A component that adapts a signal on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Adapter {
    /// Its name, which is its FMU's too.
    pub name: String,
    /// Its parameter set: every master knows start values, and not every one reads a system's.
    pub set: String,
    /// Units of what comes and of what goes; none if nobody knows.
    pub units: [Option<Unit>; 2],
}

impl Adapter {
    /// The model that adapters are made of.
    pub const MODEL: &str = "SignalAdapter";

    /// An adapter; its period is the system's communication step.
    pub fn new(
        name: String,
        title: &str,
        units: [Option<Unit>; 2],
        adaptation: Adaptation,
        system: &System,
    ) -> Self {
        let Adaptation { operation, offset, filter, initial, .. } = adaptation;
        let factor = adaptation.factor();
        let (source, period) = (&system.name, system.experiment.step);
        let [from, to] = units.each_ref().map(Option::as_ref);
        // What is added, before and after, is in the unit of what goes.
        let ends = [("input", from), ("added", to), ("offset", to), ("output", to)];
        let given: String =
            ends.iter().filter_map(|(name, unit)| Some(stated_unit(name, (*unit)?))).collect();
        let set = format!(
            "fmu = \"{name}\"\nmodel = \"{}\"\ntitle = {}\nsource = \"{source}\"\n[values]\n\
             operation = {{ value = \"{operation:?}\", source = \"the system's file\" }}\n\
             factor = {{ value = {factor:?}, source = \"the system's file\" }}\n\
             offset = {{ value = {offset:?}, source = \"the system's file\" }}\n\
             initial = {{ value = {initial:?}, source = \"the system's file\" }}\n\
             filter = {{ value = {filter:?}, unit = \"s\", source = \"the system's file\" }}\n\
             period = {{ value = {period:?}, unit = \"s\", source = \"the communication step\" }}\n\
             [units]\n{given}",
            Self::MODEL,
            toml::Value::String(title.into())
        );
        Self { name, set, units }
    }

    /// A name for the adapter of an input: an identifier that no other component bears.
    pub fn name(to: &str, taken: impl Fn(&str) -> bool) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let name: String = format!("to_{to}").chars().map(plain).collect();
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        std::iter::once(name.clone())
            .chain(numbered)
            .find(|name| !taken(name))
            .expect("there is always another number")
    }
}

/// The unit of a variable, as a parameter set gives it under `[units]`.
pub fn stated_unit(name: &str, unit: &Unit) -> String {
    let Unit { symbol, base, factor, offset } = unit;
    let symbol = toml::Value::String(symbol.clone());
    let base = base.iter().map(|exponents| {
        let list: Vec<String> = exponents.iter().map(|(name, power)| format!("{name} = {power}")).collect();
        format!(", base = {{ {} }}", list.join(", "))
    });
    let base: String = base.collect();
    format!("{name} = {{ symbol = {symbol}{base}, factor = {factor:?}, offset = {offset:?} }}\n")
}
