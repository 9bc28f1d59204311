//! Numbers, units and places in words that an engineer reads.

use crate::report::findings::{Effect, Findings, Verdict};

/// A number with a few significant digits: `57.3`, `−0.0042`, `1.2e7`; a dash if there is none.
pub fn number(value: f64) -> String {
    digits(value, 3)
}

/// The same with the number of significant digits.
pub fn digits(value: f64, significant: usize) -> String {
    if value.is_nan() {
        return "–".into();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞".into() } else { "−∞".into() };
    }
    if value == 0.0 {
        return "0".into();
    }
    let exact = format!("{value:.*e}", significant.saturating_sub(1));
    let exponent: i32 = exact.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    let text = if (-4..6).contains(&exponent) {
        decimals(value, (significant as i32 - 1 - exponent).max(0) as usize)
    } else {
        let (mantissa, exponent) = exact.split_once('e').unwrap_or((&exact, "0"));
        let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0') } else { mantissa };
        format!("{}e{exponent}", mantissa.trim_end_matches('.'))
    };
    text.replace('-', "−")
}

fn decimals(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}").replace('-', "−");
    if text.trim_start_matches('−').chars().all(|c| c == '0' || c == '.') {
        text.replace('−', "")
    } else {
        text
    }
}

/// A value with the ends of its interval, to the digits that the interval's width gives meaning to.
pub fn interval(value: f64, low: f64, high: f64) -> [String; 3] {
    let width = (high - low).abs();
    let largest = value.abs().max(low.abs()).max(high.abs());
    if !(width > 0.0 && width.is_finite() && (1e-4..1e6).contains(&largest)) {
        return [digits(value, 4), digits(low, 4), digits(high, 4)];
    }
    let places = (1.0 - (width / 2.0).log10().floor()).clamp(0.0, 8.0) as usize;
    [value, low, high]
        .map(|number| if number.is_finite() { decimals(number, places) } else { self::number(number) })
}

/// A fit Φ to so many decimals: `0.08`, `−0.40`.
pub fn fit(phi: f64, places: usize) -> String {
    if phi.is_finite() && phi.abs() < 1e3 { decimals(phi, places) } else { number(phi) }
}

/// A share of one in per cent: `83 %`.
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".into();
    }
    let value = 100.0 * share;
    let sign = if value < 0.0 { "−" } else { "" };
    match value.abs() {
        size if size > 0.0 && size < 0.05 => return format!("{sign}<\u{2009}0.1 %"),
        size if size > 99.95 && size < 100.0 => return format!("{sign}>\u{2009}99.9 %"),
        _ => {}
    }
    let fine = value.abs() < 9.95 || (99.0..100.0).contains(&value.abs());
    let places = usize::from(fine && value != 0.0);
    if value.abs() < 1e6 {
        format!("{} %", decimals(value, places))
    } else {
        format!("{} %", digits(value, 2))
    }
}

/// A unit as it is printed: `N·s/m`, `m/s²`; nothing for a plain number.
pub fn unit(symbol: &str) -> String {
    if symbol == "1" || symbol == "-" {
        return String::new();
    }
    let mut text = String::new();
    let mut after_letter = false;
    for c in symbol.chars() {
        text.push(match c {
            '.' => '·',
            '2' if after_letter => '²',
            '3' if after_letter => '³',
            '4' if after_letter => '⁴',
            other => other,
        });
        after_letter = c.is_alphabetic();
    }
    text
}

/// A number with its unit.
pub fn quantity(value: f64, symbol: &str) -> String {
    format!("{} {}", number(value), unit(symbol)).trim_end().to_owned()
}

/// The same to the digits of a result.
pub fn value(value: f64, symbol: &str) -> String {
    format!("{} {}", digits(value, 4), unit(symbol)).trim_end().to_owned()
}

/// What an effect is, where, and how much of it there is: `friction in the strut (strut.coulomb.force = 61.2 N)`.
pub fn sized(effect: &Effect) -> String {
    let named = located(&effect.name, &effect.element);
    match effect.parameters.first() {
        Some(it) => format!("{named} ({} = {})", it.name, value(it.value, &it.unit)),
        None => named,
    }
}

/// `name / unit`, for axes.
pub fn labelled(name: &str, symbol: &str) -> String {
    let unit = unit(symbol);
    if unit.is_empty() { name.to_owned() } else { format!("{name} / {unit}") }
}

/// A part of the rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The body's mass.
    Body,
    /// The body's or the wheel's guide.
    Guide,
    /// Spring and damper between body and wheel.
    Strut,
    /// The actuator.
    Actuator,
    /// The wheel's mass.
    Wheel,
    /// The tyre.
    Tire,
    /// The road.
    Road,
}

/// The part that an element's name means; none for a sensor.
pub fn part(element: &str) -> Option<Part> {
    Some(match element {
        "body" => Part::Body,
        "guide" | "body_guide" | "wheel_guide" => Part::Guide,
        "strut" => Part::Strut,
        "actuator" => Part::Actuator,
        "wheel" => Part::Wheel,
        "tire" => Part::Tire,
        "road" => Part::Road,
        _ => return None,
    })
}

/// An element as a place: `in the strut`, `at body.acceleration`.
pub fn place(element: &str) -> String {
    match (part(element), element) {
        (Some(Part::Tire), _) => "in the tyre".into(),
        (Some(_), "body_guide") => "in the body’s guide".into(),
        (Some(_), "wheel_guide") => "in the wheel’s guide".into(),
        (Some(_), _) | (None, "pump" | "valve") => format!("in the {element}"),
        (None, _) => format!("at {element}"),
    }
}

/// A cause with its place, which a name such as `guide friction` holds already.
pub fn located(name: &str, element: &str) -> String {
    match name.split(' ').any(|word| word == element) {
        true => name.to_owned(),
        false => format!("{name} {}", place(element)),
    }
}

/// `a, b and c`.
pub fn list(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., end] => format!("{} {last} {end}", rest.join(", ")),
    }
}

/// The text with a capital at its start.
pub fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or(String::new(), |first| first.to_uppercase().chain(rest).collect())
}

/// `3 records`, `1 record`.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Number and element of a cause that is given as `01 strut`.
fn split(key: &str) -> (&str, &str) {
    let key = key.trim();
    let (id, element) = key.split_once([' ', '@', ':', '/']).unwrap_or((key, ""));
    (id, element.trim())
}

/// The element of a cause that is given as `01 strut`.
pub fn element(key: &str) -> &str {
    split(key).1
}

/// The name of a cause that is given by number and place, as `01 strut`, if the catalogue's list has it.
pub fn cause(findings: &Findings, key: &str) -> String {
    let (id, element) = split(key);
    let known = findings.candidates.iter().filter(|candidate| candidate.id == id);
    match known.max_by_key(|candidate| candidate.element == element) {
        Some(known) if element.is_empty() => located(&known.name, &known.element),
        Some(known) => located(&known.name, element),
        None => key.to_owned(),
    }
}

/// The verdict as one sentence.
pub fn headline(findings: &Findings) -> String {
    let named = |effect: &Effect| located(&effect.name, &effect.element);
    let effects: Vec<String> = findings.effects.iter().map(named).collect();
    match findings.verdict {
        Verdict::NoEffect => "These records show no cause beyond the model.".into(),
        Verdict::ParameterMismatch => {
            let wrong: Vec<_> =
                findings.base_parameters.iter().filter(|parameter| parameter.mismatch).collect();
            let names: Vec<String> = wrong.iter().map(|parameter| parameter.name.clone()).collect();
            match names.len() {
                0..=3 => {
                    format!("What differs is {}; no cause beyond that could be shown.", list(&names, "and"))
                }
                more => format!("{more} parameters differ; no cause beyond that could be shown."),
            }
        }
        Verdict::Identified if effects.is_empty() => "An effect is identified.".into(),
        Verdict::Identified => format!("The model lacks {}.", list(&effects, "and")),
        Verdict::Ambiguous => {
            let (settled, open): (Vec<&Effect>, Vec<&Effect>) =
                findings.effects.iter().partition(|effect| effect.ambiguous_with.is_empty());
            let settled: Vec<String> = settled.into_iter().map(named).collect();
            let others = open.iter().flat_map(|effect| &effect.ambiguous_with);
            let mut causes: Vec<String> = open.iter().map(|effect| named(effect)).collect();
            for other in others.map(|key| cause(findings, key)) {
                if !causes.contains(&other) {
                    causes.push(other);
                }
            }
            match (causes.len(), settled.len()) {
                (0 | 1, _) => "Several causes explain the data equally well.".into(),
                (_, 0) => format!("The model lacks {}: these data cannot tell which.", list(&causes, "or")),
                _ => format!(
                    "The model lacks {}; and {}: these data cannot tell which of the latter.",
                    list(&settled, "and"),
                    list(&causes, "or")
                ),
            }
        }
        Verdict::Unmodelled => match findings.unmodelled.first() {
            Some(unmodelled) => {
                format!("The model lacks {}. No effect of the catalogue explains it.", unmodelled.description)
            }
            None => "Something is missing in the model, and it follows nothing that was recorded.".into(),
        },
        Verdict::SensorFault if effects.is_empty() => "A sensor is at fault, not the plant.".into(),
        Verdict::SensorFault => format!("A sensor is at fault, not the plant: {}.", list(&effects, "and")),
        Verdict::ModelInadequate => "The model explains too little of the data to tell a cause.".into(),
        Verdict::BadData => "The data cannot be used as they are.".into(),
    }
}

/// The verdict in a word or two, with its style's class.
pub fn badge(verdict: Verdict) -> (&'static str, &'static str) {
    match verdict {
        Verdict::NoEffect => ("no effect", "good"),
        Verdict::ParameterMismatch => ("parameter mismatch", "found"),
        Verdict::Identified => ("identified", "found"),
        Verdict::Ambiguous => ("ambiguous", "doubt"),
        Verdict::Unmodelled => ("unmodelled", "doubt"),
        Verdict::SensorFault => ("sensor fault", "found"),
        Verdict::ModelInadequate => ("model inadequate", "bad"),
        Verdict::BadData => ("bad data", "bad"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_mean_something() {
        let texts = [57.34, -0.00423, 1.234e7, 0.0, f64::NAN, f64::NEG_INFINITY, 123_456.0].map(number);
        assert_eq!(texts, ["57.3", "−0.00423", "1.23e7", "0", "–", "−∞", "123456"]);
        assert_eq!(interval(57.34, 55.1, 59.4), ["57.3", "55.1", "59.4"]);
        assert_eq!(interval(0.01, f64::NAN, 0.02), ["0.01000", "–", "0.02000"]);
        assert_eq!(interval(2.0e7, 1.9e7, 2.1e7), ["2e7", "1.9e7", "2.1e7"]);
        assert_eq!(
            [0.834, 0.012, f64::NAN, -0.0, 0.9999, 1.0].map(percent),
            ["83 %", "1.2 %", "–", "0 %", ">\u{2009}99.9 %", "100 %"]
        );
    }

    #[test]
    fn fits_have_decimals() {
        assert_eq!([0.08, -0.4, f64::NAN, -1e7].map(|phi| fit(phi, 2)), ["0.08", "−0.40", "–", "−1e7"]);
    }

    #[test]
    fn units_are_printed_with_raised_digits() {
        assert_eq!(["m/s2", "N.s/m", "1", "m3"].map(unit), ["m/s²", "N·s/m", "", "m³"]);
    }

    #[test]
    fn a_place_is_told_once() {
        let names = [("viscous guide", "guide"), ("constant force", "guide"), ("soft mount", "strut")];
        let located = names.map(|(name, element)| located(name, element));
        assert_eq!(located, ["viscous guide", "constant force in the guide", "soft mount in the strut"]);
    }

    #[test]
    fn what_is_inside_an_actuator_is_no_sensor() {
        let places = ["pump", "valve", "tire", "motor.speed"].map(place);
        assert_eq!(places, ["in the pump", "in the valve", "in the tyre", "at motor.speed"]);
    }

    #[test]
    fn lists_are_read_aloud() {
        let items = ["a".to_owned(), "b".to_owned(), "c".to_owned()];
        assert_eq!(list(&items, "or"), "a, b or c");
        assert_eq!((list(&items[..1], "or"), list(&[], "or")), ("a".into(), String::new()));
    }
}
