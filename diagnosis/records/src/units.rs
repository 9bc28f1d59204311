//! Units of measurement: what a column's unit is in the model's.
//!
//! A unit is a product of symbols with powers: `m/s2`, `N.s/m`, `kN/mm`, `m5/(N.s)`. The plane angle counts as
//! a base quantity of its own, so that `rpm` is no substitute for `Hz`. `g` is standard gravity (CGPM 1901).

use std::f64::consts::PI;

/// From a column's unit to the model's: `scale * value + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// Factor.
    pub scale: f64,
    /// Added after the factor; not zero between scales of temperature only.
    pub offset: f64,
}

impl Conversion {
    /// The value in the model's unit.
    #[must_use]
    pub fn apply(self, value: f64) -> f64 {
        // Values that need no conversion stay what they are, to the bit.
        if self.offset == 0.0 { self.scale * value } else { self.scale * value + self.offset }
    }
}

/// Exponents of m, kg, s, A, K, rad.
pub(super) type Dimension = [i8; 6];

/// Size of a unit in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Size {
    factor: f64,
    dimension: Dimension,
}

pub(super) const NONE: Dimension = [0; 6];
const LENGTH: Dimension = [1, 0, 0, 0, 0, 0];
const FORCE: Dimension = [1, 1, -2, 0, 0, 0];
const PRESSURE: Dimension = [-1, 1, -2, 0, 0, 0];
const VOLTAGE: Dimension = [2, 1, -3, -1, 0, 0];
pub(super) const ANGLE: Dimension = [0, 0, 0, 0, 0, 1];
const SPEED: Dimension = [1, 0, -1, 0, 0, 0];
const TIME: Dimension = [0, 0, 1, 0, 0, 0];

/// Newtons in a pound-force: 0.453 592 37 kg times standard gravity.
const LBF: f64 = 4.448_221_615_260_5;
/// Standard gravity, m/s2.
const GRAVITY: f64 = 9.806_65;

/// Symbols that take prefixes.
const PREFIXED: [(&str, f64, Dimension); 16] = [
    ("m", 1.0, LENGTH),
    ("s", 1.0, TIME),
    ("A", 1.0, [0, 0, 0, 1, 0, 0]),
    ("K", 1.0, [0, 0, 0, 0, 1, 0]),
    ("N", 1.0, FORCE),
    ("Pa", 1.0, PRESSURE),
    ("bar", 1e5, PRESSURE),
    ("V", 1.0, VOLTAGE),
    ("W", 1.0, [2, 1, -3, 0, 0, 0]),
    ("J", 1.0, [2, 1, -2, 0, 0, 0]),
    ("Hz", 1.0, [0, 0, -1, 0, 0, 0]),
    ("rad", 1.0, ANGLE),
    ("Ohm", 1.0, [2, 1, -3, -2, 0, 0]),
    ("H", 1.0, [2, 1, -2, -2, 0, 0]),
    ("g", GRAVITY, [1, 0, -2, 0, 0, 0]),
    ("L", 1e-3, [3, 0, 0, 0, 0, 0]),
];

/// Symbols that stand as they are.
const PLAIN: [(&str, f64, Dimension); 41] = [
    ("1", 1.0, NONE),
    ("-", 1.0, NONE),
    ("%", 0.01, NONE),
    ("kg", 1.0, [0, 1, 0, 0, 0, 0]),
    ("t", 1e3, [0, 1, 0, 0, 0, 0]),
    ("in", 0.0254, LENGTH),
    ("inch", 0.0254, LENGTH),
    ("inches", 0.0254, LENGTH),
    ("ft", 0.3048, LENGTH),
    ("mil", 25.4e-6, LENGTH),
    ("lbf", LBF, FORCE),
    ("lb", LBF, FORCE),
    ("lbs", LBF, FORCE),
    ("kip", 1e3 * LBF, FORCE),
    ("kips", 1e3 * LBF, FORCE),
    ("kgf", GRAVITY, FORCE),
    ("psi", LBF / (0.0254 * 0.0254), PRESSURE),
    ("atm", 101_325.0, PRESSURE),
    ("deg", PI / 180.0, ANGLE),
    ("°", PI / 180.0, ANGLE),
    ("rev", 2.0 * PI, ANGLE),
    ("rpm", PI / 30.0, [0, 0, -1, 0, 0, 1]),
    ("kph", 1.0 / 3.6, SPEED),
    ("kmh", 1.0 / 3.6, SPEED),
    ("mph", 0.447_04, SPEED),
    ("min", 60.0, TIME),
    ("h", 3600.0, TIME),
    ("sec", 1.0, TIME),
    ("second", 1.0, TIME),
    ("seconds", 1.0, TIME),
    ("msec", 1e-3, TIME),
    ("usec", 1e-6, TIME),
    ("Ω", 1.0, [2, 1, -3, -2, 0, 0]),
    ("mΩ", 1e-3, [2, 1, -3, -2, 0, 0]),
    ("ohm", 1.0, [2, 1, -3, -2, 0, 0]),
    ("l", 1e-3, [3, 0, 0, 0, 0, 0]),
    ("volt", 1.0, VOLTAGE),
    ("Amp", 1.0, [0, 0, 0, 1, 0, 0]),
    ("g_n", GRAVITY, [1, 0, -2, 0, 0, 0]),
    ("Gs", GRAVITY, [1, 0, -2, 0, 0, 0]),
    ("G", GRAVITY, [1, 0, -2, 0, 0, 0]),
];

/// Words that mean the same in capitals, `Sec` or `BAR`; no word that may be a part of a name, as `Min` is.
const IN_CAPITALS: [&str; 10] = ["sec", "msec", "lbf", "kgf", "psi", "bar", "rpm", "deg", "rad", "volt"];

const PREFIXES: [(&str, f64); 11] = [
    ("da", 1e1),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("h", 1e2),
    ("d", 1e-1),
    ("c", 1e-2),
    ("m", 1e-3),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("n", 1e-9),
];

/// How a value in the unit `from` becomes one in the unit `to`.
///
/// # Errors
/// One of the units is not known, or they measure different things: `` `V` is not a unit of `m` ``.
pub fn conversion(from: &str, to: &str) -> Result<Conversion, String> {
    let (from, to) = (from.trim(), to.trim());
    let (source, zero) = parse(from)?;
    let (target, target_zero) = parse(to)?;
    if source.dimension != target.dimension {
        return Err(format!("`{from}` does not measure the same as `{to}`"));
    }
    let scale = source.factor / target.factor;
    Ok(Conversion { scale, offset: (zero - target_zero) / target.factor })
}

/// A column's name and the unit at its end, as in `Time_ms` and `AccelZ_g`; none unless that is a unit of `wanted`.
#[must_use]
pub(crate) fn split_suffix<'a>(name: &'a str, wanted: &str) -> Option<(&'a str, &'a str)> {
    suffix(name).filter(|(_, unit)| conversion(unit, wanted).is_ok())
}

/// A column's name without the unit at its end; none unless there is one.
#[must_use]
pub fn without_suffix(name: &str) -> Option<&str> {
    suffix(name).filter(|(_, unit)| parse(unit).is_ok()).map(|(name, _)| name)
}

/// A name and the word at its end.
fn suffix(name: &str) -> Option<(&str, &str)> {
    let (name, unit) = name.trim().rsplit_once(['_', ' '])?;
    // The 1 in `sensor_1` is no unit.
    let is_word = unit.contains(|c: char| c.is_alphabetic() || c == '%');
    (!name.is_empty() && is_word).then_some((name, unit))
}

/// From a unit to SI, and what it measures.
///
/// # Errors
/// The unit is not known.
pub(super) fn si(unit: &str) -> Result<(Conversion, Dimension), String> {
    let (size, zero) = parse(unit.trim())?;
    Ok((Conversion { scale: size.factor, offset: zero }, size.dimension))
}

/// Size of a unit and its zero in kelvin if it is a scale of temperature.
fn parse(unit: &str) -> Result<(Size, f64), String> {
    let temperature = |factor| Size { factor, dimension: [0, 0, 0, 0, 1, 0] };
    match unit {
        "" => return Ok((Size { factor: 1.0, dimension: NONE }, 0.0)),
        "degC" | "°C" | "C" => return Ok((temperature(1.0), 273.15)),
        "degF" | "°F" => return Ok((temperature(5.0 / 9.0), 273.15 - 32.0 * 5.0 / 9.0)),
        _ => {}
    }
    let plain = unit.replace('²', "2").replace('³', "3").replace("⁻¹", "-1").replace('μ', "µ");
    let tokens = tokens(&plain);
    let mut rest = tokens.as_slice();
    let size = product(&mut rest).filter(|_| rest.is_empty()).ok_or_else(|| unknown(unit))?;
    Ok((size, 0.0))
}

fn unknown(unit: &str) -> String {
    format!(
        "`{unit}` is not a unit known here (known are mm, kN, m/s2, g, deg, rpm, bar, … and products of them)"
    )
}

/// Symbols with their powers, and the operators between them.
fn tokens(unit: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut start = 0;
    for (i, c) in unit.char_indices() {
        if matches!(c, '/' | '*' | '.' | '·' | '(' | ')') || c.is_whitespace() {
            tokens.push(&unit[start..i]);
            start = i + c.len_utf8();
            tokens.push(&unit[i..start]);
        }
    }
    tokens.push(&unit[start..]);
    tokens.retain(|token| !token.trim().is_empty() && !matches!(*token, "*" | "." | "·"));
    tokens
}

fn product(tokens: &mut &[&str]) -> Option<Size> {
    let mut size = Size { factor: 1.0, dimension: NONE };
    let mut sign = 1;
    let mut empty = true;
    while let Some((&token, rest)) = tokens.split_first() {
        let factor = match token {
            ")" => break,
            "/" if sign == 1 => {
                *tokens = rest;
                sign = -1;
                continue;
            }
            "(" => {
                *tokens = rest;
                let inner = product(tokens)?;
                let (&close, rest) = tokens.split_first()?;
                *tokens = rest;
                (close == ")").then_some(inner)?
            }
            symbol => {
                *tokens = rest;
                power(symbol)?
            }
        };
        size = multiply(size, factor, sign)?;
        empty = false;
        // In `N.m/s.A` only the s is below the bar, by FMI; ambiguous spellings need brackets.
        sign = 1;
    }
    (!empty && sign == 1).then_some(size)
}

fn multiply(a: Size, b: Size, exponent: i8) -> Option<Size> {
    let mut dimension = a.dimension;
    for (sum, part) in dimension.iter_mut().zip(b.dimension) {
        *sum = part.checked_mul(exponent).and_then(|part| sum.checked_add(part))?;
    }
    Some(Size { factor: a.factor * b.factor.powi(i32::from(exponent)), dimension })
}

/// `s2`, `s^2`, `s^-1`, `s`.
fn power(token: &str) -> Option<Size> {
    if let Some(size) = symbol(token) {
        return Some(size);
    }
    let digits = token.find(|c: char| c.is_ascii_digit() || c == '-' || c == '^')?;
    let (name, exponent) = token.split_at(digits);
    let exponent = exponent.strip_prefix('^').unwrap_or(exponent).parse::<i8>().ok()?;
    let one = Size { factor: 1.0, dimension: NONE };
    multiply(one, symbol(name)?, exponent).filter(|_| exponent.unsigned_abs() < 10)
}

fn symbol(name: &str) -> Option<Size> {
    let find = |table: &[(&str, f64, Dimension)], name: &str| {
        let entry = table.iter().find(|entry| entry.0 == name)?;
        Some(Size { factor: entry.1, dimension: entry.2 })
    };
    let exact = find(&PLAIN, name).or_else(|| find(&PREFIXED, name)).or_else(|| {
        PREFIXES.iter().find_map(|&(prefix, factor)| {
            let base = find(&PREFIXED, name.strip_prefix(prefix)?)?;
            Some(Size { factor: factor * base.factor, ..base })
        })
    });
    let word = || {
        let own = IN_CAPITALS.iter().find(|it| it.eq_ignore_ascii_case(name))?;
        find(&PLAIN, own).or_else(|| find(&PREFIXED, own))
    };
    exact.or_else(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors() {
        for (from, to, factor) in [
            ("mm", "m", 1e-3),
            ("cm", "m", 1e-2),
            ("in", "m", 0.0254),
            ("um", "m", 1e-6),
            ("µm", "m", 1e-6),
            ("g", "m/s2", 9.80665),
            ("mg", "m/s2", 9.80665e-3),
            ("m/s²", "m/s2", 1.0),
            ("m/s^2", "m/s2", 1.0),
            ("m s^-2", "m/s2", 1.0),
            ("mm/s", "m/s", 1e-3),
            ("in/s", "m/s", 0.0254),
            ("km/h", "m/s", 1.0 / 3.6),
            ("kN", "N", 1e3),
            ("daN", "N", 10.0),
            ("lbf", "N", 4.4482216152605),
            ("kip", "N", 4448.2216152605),
            ("ms", "s", 1e-3),
            ("min", "s", 60.0),
            ("Sec", "s", 1.0),
            ("LBF", "N", 4.4482216152605),
            ("deg", "rad", PI / 180.0),
            ("rpm", "rad/s", PI / 30.0),
            ("bar", "Pa", 1e5),
            ("MPa", "Pa", 1e6),
            ("psi", "Pa", 6_894.757_293_168),
            ("mA", "A", 1e-3),
            ("mV", "V", 1e-3),
            ("1/s", "Hz", 1.0),
            ("%", "1", 0.01),
            ("l/min", "m3/s", 1e-3 / 60.0),
            ("kN/mm", "N/m", 1e6),
            ("N*s/m", "N.s/m", 1.0),
            ("kg.m2/(s2.m)", "N", 1.0),
            ("m5/(N.s)", "m5/(N.s)", 1.0),
        ] {
            let found = conversion(from, to).unwrap();
            assert!((found.scale / factor - 1.0).abs() < 1e-12, "{from} in {to}: {found:?}");
            assert_eq!(found.offset, 0.0);
        }
        assert!((conversion("degC", "K").unwrap().apply(20.0) - 293.15).abs() < 1e-12);
        assert!((conversion("°F", "degC").unwrap().apply(212.0) - 100.0).abs() < 1e-12);
    }

    #[test]
    fn a_word_in_capitals_is_a_unit_unless_it_may_be_a_name() {
        assert!(["Sec", "BAR", "RPM", "Volt", "VOLT"].iter().all(|it| si(it).is_ok()));
        assert!(["Min", "MIL", "Rev", "Second"].iter().all(|it| si(it).is_err()));
        assert_eq!((split_suffix("T_MIN", "s"), without_suffix("Force Min")), (None, None));
    }

    #[test]
    fn units_of_the_models() {
        for unit in [
            "",
            "1",
            "V",
            "s",
            "N.s/m",
            "Hz",
            "m",
            "N/m",
            "kg",
            "m3",
            "m/s",
            "Pa",
            "N",
            "m2",
            "N.m",
            "kg.m2",
            "m3/s",
            "N.m.s/rad",
            "V.s2/m",
            "1/m",
            "rad",
            "1/s",
            "m5/(N.s)",
            "N/m2",
            "V/N",
            "V/A",
            "Ohm",
            "s2/m2",
            "s/rad",
            "m2/s",
            "Pa.s/m3",
            "Hz/s",
            "A",
            "rad/s",
            "m/s2",
            "rad/(s2.N)",
            "N/A",
            "N.m.s2/rad",
            "H",
            "A.s/m",
            "1/N2",
            "K",
            "W",
        ] {
            assert_eq!(conversion(unit, unit), Ok(Conversion { scale: 1.0, offset: 0.0 }), "{unit}");
        }
        assert!(conversion("N.m.s/rad", "N.m.s").is_err());
        assert!((conversion("N.mm.min/deg", "N.m.s/rad").unwrap().scale - 0.06 * 180.0 / PI).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(conversion("V", "m").unwrap_err().contains("`V` does not measure the same as `m`"));
        assert!(conversion("rpm", "Hz").is_err());
        assert!(conversion("", "s").is_err());
        for unit in ["furlong", "m//s", "m/", "(m", "m)", "()", "m^x", "m99", "/", "..", "mkg"] {
            assert!(conversion(unit, "m").is_err(), "{unit}");
        }
    }
}
