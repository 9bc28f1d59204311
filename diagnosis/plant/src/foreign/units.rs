//! Units as an FMU declares them, and the base units of the SI that a plant's values are in.

use strut_check::import::Unit as Declared;
use strut_model::unit::{ALL, ANY, Base, Unit};

/// How a variable's values are made values in base units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// Factor to base units.
    pub factor: f64,
    /// Offset to base units.
    pub offset: f64,
}

impl Conversion {
    /// Values are taken as they are.
    pub const NONE: Self = Self { factor: 1.0, offset: 0.0 };

    /// In base units.
    pub fn si(self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// As the FMU has it.
    pub fn own(self, value: f64) -> f64 {
        (value - self.offset) / self.factor
    }

    /// A rate of change in base units.
    pub fn si_rate(self, rate: f64) -> f64 {
        self.factor * rate
    }
}

/// The coherent unit of a declared one, and how values are made values in it. What only has a name keeps it.
pub fn coherent(name: Option<&str>, declared: &[Declared]) -> (Unit, Conversion) {
    let Some(name) = name else { return (ANY, Conversion::NONE) };
    let known = |symbol: &str| ALL.iter().find(|it| it.symbol == symbol).copied();
    let Some((declared, base)) =
        declared.iter().find(|it| it.symbol == name).and_then(|it| Some((it, base(it)?)))
    else {
        let named = || Unit::coherent(kept(name.to_owned()), Base::NONE);
        return (known(name).unwrap_or_else(named), Conversion::NONE);
    };
    let conversion = Conversion { factor: declared.factor, offset: declared.offset };
    let is_coherent = conversion == Conversion::NONE;
    // Its own name where it is coherent: a moment is no energy.
    let own = is_coherent.then(|| known(name).filter(|it| it.base == base)).flatten();
    let same = || ALL.iter().find(|it| it.base == base).copied();
    let made = || Unit::coherent(kept(if is_coherent { name.to_owned() } else { product(base) }), base);
    (own.or_else(same).unwrap_or_else(made), conversion)
}

fn base(declared: &Declared) -> Option<Base> {
    let exponents = declared.base.as_ref()?;
    Some(Base::of(Base::NAMES.map(|name| {
        exponents.iter().find(|(other, _)| *other == name).map_or(0, |(_, exponent)| *exponent as i8)
    })))
}

/// `kg.m2/s3` without a table of names: `kg.m2.s-3`.
fn product(base: Base) -> String {
    let part = |(name, exponent): (&str, i8)| {
        if exponent == 1 { name.to_owned() } else { format!("{name}{exponent}") }
    };
    base.exponents().map(part).collect::<Vec<_>>().join(".")
}

/// A symbol as declarations have it. An FMU has a few of them, and a process few FMUs.
fn kept(symbol: String) -> &'static str {
    Box::leak(symbol.into_boxed_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn declared(symbol: &str, base: &[(&'static str, i32)], factor: f64, offset: f64) -> Declared {
        Declared { symbol: symbol.into(), base: Some(base.to_vec()), factor, offset }
    }

    #[test]
    fn values_come_in_base_units_and_go_back() {
        let units = [
            declared("mm", &[("m", 1)], 1e-3, 0.0),
            declared("degC", &[("K", 1)], 1.0, 273.15),
            declared("N.m", &[("kg", 1), ("m", 2), ("s", -2)], 1.0, 0.0),
            declared("kNs/m", &[("kg", 1), ("s", -1)], 1e3, 0.0),
            declared("odd", &[("kg", 3), ("m", -1)], 2.0, 0.0),
        ];
        let symbol = |name: &str| coherent(Some(name), &units).0.symbol;
        let named = ["mm", "N.m", "kNs/m", "odd", "bar"].map(symbol);
        assert_eq!(named, ["m", "N.m", "N.s/m", "kg3.m-1", "bar"]);
        let (_, celsius) = coherent(Some("degC"), &units);
        assert_eq!((celsius.si(20.0), celsius.own(293.15), celsius.si_rate(2.0)), (293.15, 20.0, 2.0));
        assert_eq!(coherent(None, &units), (ANY, Conversion::NONE));
    }
}
