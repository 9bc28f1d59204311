//! What a model looks like from outside: its variables and what depends on what.

mod numbering;
mod structure;

pub use numbering::{Numbering, Table};
pub use structure::{Dependency, Structure, Timely};

use std::path::Path;

use uuid::Uuid;

use crate::{
    About, Bundle, Declaration, Enumeration, Error, Model, ParameterSet, SettingDeclaration, SettingKind,
    Settings, Value,
    layout::{Declared, Layout, Section, rate_name},
    parameter_set::Starts,
    unit::OwnedUnit,
};

/// The variables of a model with a parameter set: all that a model description says.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface {
    /// The model's own words.
    pub about: About,
    /// Variables in the order of their value references, real ones first.
    pub variables: Vec<Variable>,
    /// What depends on what, by position in `variables`.
    pub structure: Structure,
    /// What depends on time itself.
    pub timely: Timely,
    /// Number of continuous states.
    pub states: usize,
    /// Number of event indicators.
    pub event_indicators: usize,
    /// The variables that are elements of arrays.
    pub tables: Vec<Table>,
    /// Whether a part of it is sampled.
    pub sampled: bool,
}

/// A scalar variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Value reference; unique within the real and within the other variables.
    pub reference: u32,
    /// Description.
    pub doc: String,
    /// Role.
    pub causality: Causality,
    /// When its value may change.
    pub variability: Variability,
    /// How its initial value comes about; none for inputs.
    pub initial: Option<Initial>,
    /// Type and what belongs to it.
    pub kind: VariableKind,
}

/// Role of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set by the user.
    Parameter,
    /// Follows from parameters.
    CalculatedParameter,
    /// Set by the environment.
    Input,
    /// Read by the environment.
    Output,
    /// Inside.
    Local,
}

impl Causality {
    /// As the model description writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::CalculatedParameter => "calculatedParameter",
            Self::Input => "input",
            Self::Output => "output",
            Self::Local => "local",
        }
    }
}

/// When a variable's value may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Not after initialisation.
    Fixed,
    /// At events, from outside.
    Tunable,
    /// At events.
    Discrete,
    /// At any time.
    Continuous,
}

impl Variability {
    /// As the model description writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Tunable => "tunable",
            Self::Discrete => "discrete",
            Self::Continuous => "continuous",
        }
    }
}

/// How an initial value comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Initial {
    /// It is the start value.
    Exact,
    /// It is calculated.
    Calculated,
}

impl Initial {
    /// As the model description writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Calculated => "calculated",
        }
    }
}

/// Type of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum VariableKind {
    /// A real number.
    Real {
        /// Unit.
        unit: OwnedUnit,
        /// Start value, if it has one.
        start: Option<f64>,
        /// Smallest legal value.
        min: Option<f64>,
        /// Largest legal value.
        max: Option<f64>,
        /// Typical magnitude.
        nominal: Option<f64>,
        /// Position of the variable that it is the derivative of.
        derivative_of: Option<usize>,
    },
    /// A whole number.
    Integer {
        /// Start value.
        start: i32,
    },
    /// True or false.
    Boolean {
        /// Start value.
        start: bool,
    },
    /// A text.
    Text {
        /// Start value.
        start: String,
    },
    /// One of several.
    Choice {
        /// The type.
        enumeration: Enumeration,
        /// Start value, from one.
        start: i32,
    },
}

impl Interface {
    /// The interface of a model with its declared start values, or with those of a parameter set.
    ///
    /// # Errors
    /// If the parameter set does not fit the declarations or the model refuses it.
    pub fn of<M: Model>(set: Option<&ParameterSet>, resources: Option<&Path>) -> Result<Self, Error> {
        let declared = Layout::<M>::declared();
        let starts = Starts::of(&declared, set)?;
        let mut settings = M::Settings::starts();
        for (index, value) in starts.settings.iter().enumerate() {
            // The solver's settings follow the model's; they have no part in the structure.
            let _ = settings.set(index, value.clone());
        }
        let dependency = Dependency::of::<M>(&settings, resources)?;
        let sampled = <M::Memory<f64> as Bundle<f64>>::LEN > 0;
        Ok(Self::made_of(M::ABOUT, &declared, (set, starts), &dependency, sampled))
    }

    /// The part that needs no model's type.
    fn made_of(
        about: About,
        declared: &Declared,
        (set, starts): (Option<&ParameterSet>, Starts),
        dependency: &Dependency,
        sampled: bool,
    ) -> Self {
        let (mut variables, mut tables) = (Vec::new(), Vec::new());
        for (section, list) in &declared.sections {
            let first = declared.first(*section);
            tables.extend(numbering::tables(*section, first, list));
            variables.extend(list.iter().enumerate().map(|(index, declaration)| {
                let reference = (first + index) as u32;
                let start = starts.reals.get(&reference).copied();
                let given = set.and_then(|set| set.units.get(&declaration.name)).cloned();
                real(*section, reference, declaration.clone(), start, given, (dependency, index))
            }));
        }
        let states = declared.section(Section::State).len();
        for index in 0..states {
            let state = declared.first(Section::State) + index;
            let rate = declared.first(Section::Rate) + index;
            if let VariableKind::Real { derivative_of, .. } = &mut variables[rate].kind {
                *derivative_of = Some(state);
            }
        }
        for (reference, (declaration, value)) in declared.settings.iter().zip(starts.settings).enumerate() {
            variables.push(setting(reference as u32, declaration, value));
        }
        // Who sees the value in a tool must see that its source does not give it.
        for (name, _) in set.iter().flat_map(|set| &set.values).filter(|(_, given)| given.assumed) {
            for variable in variables.iter_mut().filter(|variable| variable.name == *name) {
                variable.doc.push_str(" (value assumed)");
            }
        }
        let structure = Structure::new(declared, dependency, &variables);
        let event_indicators = dependency.event_indicators;
        let timely = Timely::new(declared, dependency);
        Self { about, variables, structure, timely, states, event_indicators, tables, sampled }
    }

    /// An identifier of all that is declared, start values included: the library computes it from the
    /// parameter set that it finds in its resources, the packager from the one that it writes, so that
    /// a binary and a description that do not belong together are told apart.
    pub fn guid(&self) -> String {
        let Self { about, variables, structure, event_indicators, .. } = self;
        let text = format!("{:?} {variables:?} {structure:?} {event_indicators}", about.name);
        Uuid::new_v5(&Uuid::NAMESPACE_OID, text.as_bytes()).braced().to_string()
    }

    /// The variable of a name.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}

fn real(
    section: Section,
    reference: u32,
    declaration: Declaration,
    start: Option<f64>,
    given: Option<OwnedUnit>,
    (dependency, index): (&Dependency, usize),
) -> Variable {
    let Declaration { name, doc, unit, min, max, nominal, fixed, output, .. } = declaration;
    let parameter = if fixed { Variability::Fixed } else { Variability::Tunable };
    let exposed = if output { Causality::Output } else { Causality::Local };
    use {Causality as C, Initial as I, Variability as V};
    let (causality, variability, initial) = match section {
        Section::Input => (C::Input, V::Continuous, None),
        Section::Output if dependency.output_is_held(index) => (C::Output, V::Discrete, Some(I::Calculated)),
        Section::Output => (C::Output, V::Continuous, Some(I::Calculated)),
        Section::State => (exposed, V::Continuous, Some(I::Exact)),
        Section::Rate => (C::Local, V::Continuous, Some(I::Calculated)),
        Section::Parameter | Section::Solver => (C::Parameter, parameter, Some(I::Exact)),
        Section::Derived => (C::CalculatedParameter, parameter, Some(I::Calculated)),
    };
    if section == Section::Rate {
        let doc = format!("{doc}: rate of change");
        let kind = VariableKind::Real {
            unit: unit.per_second(),
            start: None,
            min: None,
            max: None,
            nominal: None,
            derivative_of: None,
        };
        return Variable { name: rate_name(&name), reference, doc, causality, variability, initial, kind };
    }
    let kind = VariableKind::Real {
        unit: given.unwrap_or_else(|| unit.into()),
        start,
        min,
        max,
        nominal,
        derivative_of: None,
    };
    Variable { name, reference, doc, causality, variability, initial, kind }
}

fn setting(reference: u32, declaration: &SettingDeclaration, value: Value) -> Variable {
    let kind = match (declaration.kind, value) {
        (SettingKind::Choice(enumeration), Value::Integer(start)) => {
            VariableKind::Choice { enumeration, start }
        }
        (_, Value::Integer(start)) => VariableKind::Integer { start },
        (_, Value::Boolean(start)) => VariableKind::Boolean { start },
        (_, Value::Text(start)) => VariableKind::Text { start },
        (_, Value::Real(_)) => unreachable!("a setting is no real number"),
    };
    Variable {
        name: declaration.name.into(),
        reference,
        doc: declaration.doc.into(),
        causality: Causality::Parameter,
        variability: if declaration.tunable { Variability::Tunable } else { Variability::Fixed },
        initial: Some(Initial::Exact),
        kind,
    }
}
