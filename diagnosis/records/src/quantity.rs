//! Values in SI with what they measure, and what may be done with them.

use super::units::{ANGLE, Dimension, NONE, si};

/// SI symbols of a dimension's exponents.
const SYMBOLS: [&str; 6] = ["m", "kg", "s", "A", "K", "rad"];
/// Largest exponent of a base unit.
const HIGHEST: i8 = 9;

/// Values of one dimension: of a column, or one for all samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// In SI.
    pub values: Vec<f64>,
    /// What they measure.
    dimension: Dimension,
}

impl Quantity {
    /// Values in a unit; an empty unit is 1.
    ///
    /// # Errors
    /// The unit is not known.
    pub fn new(values: &[f64], unit: &str) -> Result<Self, String> {
        let (conversion, dimension) = si(unit)?;
        Ok(Self { values: values.iter().map(|it| conversion.apply(*it)).collect(), dimension })
    }

    /// The SI unit: `m·kg/s2`.
    #[must_use]
    pub fn unit(&self) -> String {
        let part = |above: bool| -> Vec<String> {
            let powers = SYMBOLS.iter().zip(self.dimension).filter(|(_, it)| (*it > 0) == above && *it != 0);
            powers
                .map(
                    |(symbol, it)| {
                        if it.abs() == 1 { (*symbol).into() } else { format!("{symbol}{}", it.abs()) }
                    },
                )
                .collect()
        };
        let (above, below) = (part(true), part(false));
        let above = if above.is_empty() { "1".into() } else { above.join("·") };
        match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join("·")),
        }
    }

    /// Whether it is an angle, or a number that may be one.
    #[must_use]
    pub fn is_angle(&self) -> bool {
        self.dimension == ANGLE || self.dimension == NONE
    }

    /// Whether it measures the same as a unit.
    ///
    /// # Errors
    /// The unit is not known.
    pub fn is_of(&self, unit: &str) -> Result<bool, String> {
        Ok(si(unit)?.1 == self.dimension)
    }

    /// Every value through a function that keeps what it measures.
    #[must_use]
    pub fn map(mut self, function: impl Fn(f64) -> f64) -> Self {
        self.values.iter_mut().for_each(|it| *it = function(*it));
        self
    }

    /// Every value through a function whose result is a number.
    #[must_use]
    pub fn number(self, function: impl Fn(f64) -> f64) -> Self {
        Self { dimension: NONE, ..self.map(function) }
    }

    /// Sum or difference.
    ///
    /// # Errors
    /// They do not measure the same.
    pub fn sum(self, other: &Self, both: impl Fn(f64, f64) -> f64) -> Result<Self, String> {
        if self.dimension != other.dimension {
            return Err(format!("{} and {} are not added or subtracted", self.unit(), other.unit()));
        }
        Ok(Self { values: pairwise(&self.values, &other.values, both), dimension: self.dimension })
    }

    /// Product with another one to the power of one or minus one.
    ///
    /// # Errors
    /// An exponent is too high.
    pub fn product(self, other: &Self, exponent: i8) -> Result<Self, String> {
        let dimension = combined(self.dimension, other.dimension, exponent)?;
        let values = pairwise(&self.values, &other.values, |a, b| a * b.powi(i32::from(exponent)));
        Ok(Self { values, dimension })
    }

    /// An integer power.
    ///
    /// # Errors
    /// An exponent is too high.
    pub fn power(self, exponent: i8) -> Result<Self, String> {
        let dimension = combined(NONE, self.dimension, exponent)?;
        Ok(Self { dimension, ..self.map(|it| it.powi(i32::from(exponent))) })
    }

    /// Square root.
    ///
    /// # Errors
    /// An exponent of the unit is odd.
    pub fn root(self) -> Result<Self, String> {
        if self.dimension.iter().any(|it| it % 2 != 0) {
            return Err(format!("there is no square root of a quantity in {}", self.unit()));
        }
        Ok(Self { dimension: self.dimension.map(|it| it / 2), ..self.map(f64::sqrt) })
    }
}

fn combined(a: Dimension, b: Dimension, exponent: i8) -> Result<Dimension, String> {
    let mut sum = a;
    for (sum, part) in sum.iter_mut().zip(b) {
        let next = part.checked_mul(exponent).and_then(|part| sum.checked_add(part));
        *sum = next.filter(|it| it.abs() <= HIGHEST).ok_or("the power of a unit is too high")?;
    }
    Ok(sum)
}

/// Pairs of values; of a single one with every other.
fn pairwise(a: &[f64], b: &[f64], both: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    match (a, b) {
        ([a], b) => b.iter().map(|b| both(*a, *b)).collect(),
        (a, [b]) => a.iter().map(|a| both(*a, *b)).collect(),
        (a, b) => a.iter().zip(b).map(|(a, b)| both(*a, *b)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_from_what_is_done() {
        let force = Quantity::new(&[2.0, 4.0], "kN").unwrap();
        let area = Quantity::new(&[5.0], "cm2").unwrap();
        let pressure = force.clone().product(&area, -1).unwrap();
        assert_eq!((pressure.unit().as_str(), pressure.is_of("bar")), ("kg/(m·s2)", Ok(true)));
        assert!((pressure.values[1] / 8e6 - 1.0).abs() < 1e-12);
        assert_eq!(area.root().unwrap().unit(), "m");
        assert!(force.clone().root().is_err() && force.clone().power(100).is_err());
        assert_eq!(force.power(-1).unwrap().unit(), "s2/(m·kg)");
        let warm = Quantity::new(&[20.0], "degC").unwrap();
        assert_eq!((warm.values[0], warm.unit().as_str()), (293.15, "K"));
    }

    #[test]
    fn only_the_same_is_added() {
        let [length, angle] =
            [("m", 1.0), ("deg", 30.0)].map(|(unit, it)| Quantity::new(&[it], unit).unwrap());
        assert_eq!(length.clone().sum(&length, |a, b| a - b).unwrap().values, [0.0]);
        assert_eq!(
            length.clone().sum(&angle, |a, b| a + b),
            Err("m and rad are not added or subtracted".into())
        );
        assert!(angle.is_angle() && !length.is_angle());
    }
}
