//! Units of variables that no declaration has: rates of change, and what a parameter set gives.

use std::borrow::Cow;

use toml::{Table, Value as Toml};

use super::{ANY, Base, Unit};

/// A unit of a variable: one that is declared, one that follows from it, or one that a parameter set gives.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedUnit {
    /// As it is written in a model description; empty if nobody knows the unit.
    pub symbol: Cow<'static, str>,
    /// Exponents of the base units; none if the symbol is all that is known.
    pub base: Option<Base>,
    /// Factor to base units.
    pub factor: f64,
    /// Offset to base units.
    pub offset: f64,
}

impl From<Unit> for OwnedUnit {
    fn from(Unit { symbol, base, factor, offset }: Unit) -> Self {
        Self { symbol: symbol.into(), base: Some(base), factor, offset }
    }
}

impl Unit {
    /// The unit of a rate of change. Its symbol has one second more in the denominator: `Pa/s`, `m/s2`.
    pub fn per_second(self) -> OwnedUnit {
        let base = Base { s: self.base.s - 1, ..self.base };
        // An offset (degrees Celsius) is the same at all times.
        let rest = OwnedUnit { base: Some(base), offset: 0.0, ..self.into() };
        if self == ANY { rest } else { OwnedUnit { symbol: per_second(self.symbol).into(), ..rest } }
    }
}

impl OwnedUnit {
    /// Reads `{ symbol = "kN", base = { kg = 1, m = 1, s = -2 }, factor = 1e3 }`; all but the symbol may be left out.
    ///
    /// # Errors
    /// The key that is missing, unknown or of a wrong type.
    pub fn read(value: &Toml) -> Result<Self, String> {
        let wrong =
            "a unit is { symbol = \"kN\", base = { kg = 1, m = 1, s = -2 }, factor = 1e3, offset = 0.0 }";
        let table = value.as_table().ok_or(wrong)?;
        let mut unit = Self { symbol: Cow::Borrowed(""), base: None, factor: 1.0, offset: 0.0 };
        for (key, value) in table {
            match (key.as_str(), value) {
                ("symbol", Toml::String(text)) => unit.symbol = text.clone().into(),
                ("base", Toml::Table(exponents)) => unit.base = Some(base(exponents)?),
                ("factor", Toml::Float(number)) => unit.factor = *number,
                ("offset", Toml::Float(number)) => unit.offset = *number,
                _ => return Err(format!("`{key}` is unknown or of a wrong type; {wrong}")),
            }
        }
        if unit.symbol.is_empty() { Err(format!("a symbol is missing; {wrong}")) } else { Ok(unit) }
    }
}

fn base(exponents: &Table) -> Result<Base, String> {
    let mut all = [0; 8];
    for (name, exponent) in exponents {
        let place = Base::NAMES.iter().position(|other| other == name);
        let number = exponent.as_integer().and_then(|number| i8::try_from(number).ok());
        let (Some(place), Some(number)) = (place, number) else {
            return Err(format!(
                "`{name}` is no base unit with a whole exponent: {}",
                Base::NAMES.join(", ")
            ));
        };
        all[place] = number;
    }
    Ok(Base::of(all))
}

/// The symbol of a unit over a second.
fn per_second(symbol: &str) -> String {
    let (numerator, denominator) = symbol.split_once('/').unwrap_or((symbol, ""));
    let factors = |text: &str| -> Vec<(String, i32)> {
        let list = text.trim_matches(['(', ')']).split('.').filter(|factor| !matches!(*factor, "" | "1"));
        list.map(|factor| {
            let name = factor.trim_end_matches(char::is_numeric);
            (name.to_owned(), factor[name.len()..].parse().unwrap_or(1))
        })
        .collect()
    };
    let (mut over, mut under) = (factors(numerator), factors(denominator));
    let second = |(name, _): &&mut (String, i32)| name == "s";
    match (over.iter_mut().find(second), under.iter_mut().find(second)) {
        (Some((_, power)), _) => *power -= 1,
        (None, Some((_, power))) => *power += 1,
        (None, None) => under.push(("s".into(), 1)),
    }
    let written = |factors: &[(String, i32)]| {
        let list = factors.iter().filter(|(_, power)| *power != 0);
        let list: Vec<String> = list
            .map(|(name, power)| if *power == 1 { name.clone() } else { format!("{name}{power}") })
            .collect();
        (list.len(), list.join("."))
    };
    let over = match written(&over) {
        (0, _) => "1".to_owned(),
        (_, text) => text,
    };
    match written(&under) {
        (0, _) => over,
        (1, text) => format!("{over}/{text}"),
        (_, text) => format!("{over}/({text})"),
    }
}
