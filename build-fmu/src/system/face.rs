//! What a system has to know of a component, be it one of ours or an FMU of others.

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

/// A unit: `value in base units = factor · value + offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// As it is written.
    pub symbol: String,
    /// Exponents of the base units, zeros left out, in the order of [`BASES`]; none if they are not told.
    pub base: Option<Vec<(&'static str, i32)>>,
    /// Factor to base units.
    pub factor: f64,
    /// Offset to base units.
    pub offset: f64,
}

/// The base units of FMI 2.0.
pub const BASES: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// How a signal in one unit becomes one in another.
#[derive(Clone, Debug, PartialEq)]
pub enum Fit {
    /// It is one already.
    Same,
    /// `factor · signal + offset`.
    Linear {
        /// Factor.
        factor: f64,
        /// Offset, in the other unit.
        offset: f64,
    },
    /// It is its rate of change.
    Derivative,
    /// It is its integral.
    Integral,
    /// One of them does not tell its unit.
    Unknown,
    /// Not by its unit alone.
    Different,
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
                    Kind::Real { unit: Unit::ours(*unit), min: *min, max: *max }
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

impl Unit {
    fn ours(unit: strut_model::unit::Unit) -> Option<Self> {
        let strut_model::unit::Unit { symbol, base, factor, offset } = unit;
        let exponents: Vec<(&str, i8)> = base.exponents().collect();
        let exponent = |name| exponents.iter().find(|(other, _)| *other == name).map(|(_, e)| i32::from(*e));
        let base = BASES.iter().filter_map(|name| Some((*name, exponent(*name)?))).collect();
        (!symbol.is_empty()).then(|| Self { symbol: symbol.into(), base: Some(base), factor, offset })
    }

    fn fit(&self, to: &Self, power_of_time: i32) -> Fit {
        let (Some(base), Some(wanted)) = (&self.base, &to.base) else {
            // A unit that is only named is known by its name.
            let same = self.symbol == to.symbol && power_of_time == 0;
            return if same { Fit::Same } else { Fit::Unknown };
        };
        let exponent = |list: &[(&str, i32)], name: &str| {
            list.iter().find(|(other, _)| *other == name).map_or(0, |(_, exponent)| *exponent)
        };
        let others = BASES.iter().filter(|name| **name != "s");
        if others.into_iter().any(|name| exponent(base, name) != exponent(wanted, name)) {
            return Fit::Different;
        }
        match exponent(wanted, "s") - exponent(base, "s") - power_of_time {
            0 => {
                // What a rate of change is made of has lost its offset.
                let zero = if power_of_time == 0 { self.offset - to.offset } else { 0.0 };
                let (factor, offset) = (self.factor / to.factor, zero / to.factor);
                let same = (factor - 1.0).abs() < 1e-12 && offset == 0.0;
                if same { Fit::Same } else { Fit::Linear { factor, offset } }
            }
            -1 if power_of_time == 0 => Fit::Derivative,
            1 if power_of_time == 0 => Fit::Integral,
            _ => Fit::Different,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(symbol: &str, base: &[(&'static str, i32)], factor: f64, offset: f64) -> Unit {
        Unit { symbol: symbol.into(), base: Some(base.to_vec()), factor, offset }
    }

    #[test]
    fn units_are_compared_by_what_they_are() {
        let metre = unit("m", &[("m", 1)], 1.0, 0.0);
        let millimetre = unit("mm", &[("m", 1)], 1e-3, 0.0);
        let speed = unit("m.s-1", &[("m", 1), ("s", -1)], 1.0, 0.0);
        let force = unit("kN", &[("kg", 1), ("m", 1), ("s", -2)], 1e3, 0.0);
        let (kelvin, celsius) = (unit("K", &[("K", 1)], 1.0, 0.0), unit("degC", &[("K", 1)], 1.0, 273.15));
        assert_eq!(millimetre.fit(&metre, 0), Fit::Linear { factor: 1e-3, offset: 0.0 });
        assert_eq!(kelvin.fit(&celsius, 0), Fit::Linear { factor: 1.0, offset: -273.15 });
        assert_eq!(Unit::ours(strut_model::unit::M_PER_S).unwrap().fit(&speed, 0), Fit::Same);
        assert_eq!(metre.fit(&speed, 0), Fit::Derivative);
        assert_eq!(speed.fit(&metre, 0), Fit::Integral);
        assert_eq!(metre.fit(&force, 0), Fit::Different);
        assert_eq!((metre.fit(&speed, -1), speed.fit(&metre, 1)), (Fit::Same, Fit::Same));
        assert_eq!(millimetre.fit(&speed, -1), Fit::Linear { factor: 1e-3, offset: 0.0 });
        assert_eq!(celsius.fit(&kelvin, -1), Fit::Different);
        let named = |symbol: &str| Unit { base: None, ..unit(symbol, &[], 1.0, 0.0) };
        assert_eq!((named("m").fit(&metre, 0), named("furlong").fit(&metre, 0)), (Fit::Same, Fit::Unknown));
    }
}
