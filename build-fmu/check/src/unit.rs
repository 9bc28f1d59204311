//! Units, and how a signal in one becomes a signal in another.

use roxmltree::Node;

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

impl Unit {
    /// Reads the element of a unit, as FMI 2.0 and SSP write it.
    ///
    /// # Errors
    /// If one of its numbers is none.
    pub fn parse(node: Node) -> Result<Self, String> {
        let symbol = node.attribute("name").unwrap_or_default().to_owned();
        let Some(base) = node.children().find(|child| child.tag_name().name() == "BaseUnit") else {
            return Ok(Self::named(&symbol));
        };
        let number = |attribute: &str| -> Result<Option<f64>, String> {
            let text = base.attribute(attribute);
            let read =
                |text: &str| text.trim().parse().map_err(|_| format!("{attribute}=\"{text}\" is no number"));
            text.map(read).transpose()
        };
        let exponents = BASES
            .iter()
            .map(|name| Ok((*name, number(name)?.map_or(0, |exponent| exponent as i32))))
            .collect::<Result<Vec<_>, String>>()?;
        Ok(Self {
            symbol,
            base: Some(exponents.into_iter().filter(|(_, exponent)| *exponent != 0).collect()),
            factor: number("factor")?.unwrap_or(1.0),
            offset: number("offset")?.unwrap_or(0.0),
        })
    }

    /// A unit of which nothing but the name is known.
    pub fn named(symbol: &str) -> Self {
        Self { symbol: symbol.into(), base: None, factor: 1.0, offset: 0.0 }
    }

    /// How a signal in this unit, multiplied by a power of time, becomes one in another.
    pub fn fit(&self, to: &Self, power_of_time: i32) -> Fit {
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
        assert_eq!(unit("m/s", &[("m", 1), ("s", -1)], 1.0, 0.0).fit(&speed, 0), Fit::Same);
        assert_eq!(metre.fit(&speed, 0), Fit::Derivative);
        assert_eq!(speed.fit(&metre, 0), Fit::Integral);
        assert_eq!(metre.fit(&force, 0), Fit::Different);
        assert_eq!((metre.fit(&speed, -1), speed.fit(&metre, 1)), (Fit::Same, Fit::Same));
        assert_eq!(millimetre.fit(&speed, -1), Fit::Linear { factor: 1e-3, offset: 0.0 });
        assert_eq!(celsius.fit(&kelvin, -1), Fit::Different);
        assert_eq!(
            (Unit::named("m").fit(&metre, 0), Unit::named("furlong").fit(&metre, 0)),
            (Fit::Same, Fit::Unknown)
        );
    }
}
