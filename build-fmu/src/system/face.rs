//! What a system has to know of a component, be it one of ours or an FMU of others.

use strut_check::unit::{Fit, Unit};
use strut_model::unit::OwnedUnit;
use strut_model::{Causality, Initial, Interface, VariableKind};

/// The variables of a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// In the order of their declaration.
    pub variables: Vec<Variable>,
}

/// A variable of a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Role.
    pub causality: Causality,
    /// Whether it may be given a start value.
    pub settable: bool,
    /// Type and what belongs to it.
    pub kind: Kind,
}

/// Type of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A real number.
    Real {
        /// Unit, if one is declared.
        unit: Option<Unit>,
        /// Smallest legal value.
        min: Option<f64>,
        /// Largest legal value.
        max: Option<f64>,
    },
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
    /// A text.
    Text,
    /// One of several: name and number of each.
    Choice(Vec<(String, i32)>),
}

impl Face {
    /// Of one of our models.
    pub fn of(interface: &Interface) -> Self {
        let variables = interface.variables.iter().map(|variable| Variable {
            name: variable.name.clone(),
            causality: variable.causality,
            settable: variable.causality == Causality::Input || variable.initial == Some(Initial::Exact),
            kind: match &variable.kind {
                VariableKind::Real { unit, min, max, .. } => {
                    Kind::Real { unit: ours(unit), min: *min, max: *max }
                }
                VariableKind::Integer { .. } => Kind::Integer,
                VariableKind::Boolean { .. } => Kind::Boolean,
                VariableKind::Text { .. } => Kind::Text,
                VariableKind::Choice { enumeration, .. } => Kind::Choice(
                    enumeration.items.iter().map(|(name, _)| (*name).to_owned()).zip(1..).collect(),
                ),
            },
        });
        Self { variables: variables.collect() }
    }

    /// The variable of a name.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}

impl Variable {
    /// The unit of a real variable.
    pub fn unit(&self) -> Option<&Unit> {
        match &self.kind {
            Kind::Real { unit, .. } => unit.as_ref(),
            _ => None,
        }
    }

    /// The symbol of its unit; nothing for those that have none.
    pub fn symbol(&self) -> &str {
        self.unit().map_or("", |unit| &unit.symbol)
    }

    /// How its signal, multiplied by a power of time, becomes one that another variable takes.
    pub fn fit(&self, other: &Self, power_of_time: i32) -> Fit {
        let (Some(from), Some(to)) = (self.unit(), other.unit()) else {
            return if self.unit() == other.unit() { Fit::Same } else { Fit::Unknown };
        };
        from.fit(to, power_of_time)
    }
}

impl Kind {
    /// As the standard names it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Real { .. } => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::Text => "String",
            Self::Choice(_) => "Enumeration",
        }
    }
}

/// The unit of one of our variables.
pub fn ours(unit: &OwnedUnit) -> Option<Unit> {
    let OwnedUnit { symbol, base, factor, offset } = unit;
    let base =
        base.map(|base| base.exponents().map(|(name, exponent)| (name, i32::from(exponent))).collect());
    (!symbol.is_empty()).then(|| Unit { symbol: symbol.to_string(), base, factor: *factor, offset: *offset })
}
