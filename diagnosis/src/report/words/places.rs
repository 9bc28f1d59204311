//! Effects and the places where they act.

use super::{digits, interval, value};
use crate::catalogue::Element;
use crate::report::findings::{AccountItem, Candidate, Effect, EffectParameter, Findings};

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
    Some(match only(element).0 {
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

/// What an element is, and in brackets where, if its rig has several: `strut` and ` (front left)`.
fn only(element: &str) -> (&str, String) {
    match Element::named(element).and_then(|it| Some((it, it.place()?))) {
        Some((it, place)) => (it.only().name(), format!(" ({})", place.replace('_', " "))),
        None => (element, String::new()),
    }
}

/// An element as a place: `in the strut`, `in the strut (front left)`, `at body.acceleration`.
pub fn place(element: &str) -> String {
    let (element, at) = only(element);
    let place = match (part(element), element) {
        (Some(Part::Tire), _) => "in the tyre".into(),
        (Some(_), "body_guide") => "in the body’s guide".into(),
        (Some(_), "wheel_guide") => "in the wheel’s guide".into(),
        (Some(_), _) | (None, "pump" | "valve") => format!("in the {element}"),
        (None, _) => format!("at {element}"),
    };
    place + &at
}

/// An effect with its place, which a name such as `guide friction` holds already.
pub fn located(name: &str, element: &str) -> String {
    let (own, at) = only(element);
    match name.split(' ').any(|word| word == own) {
        true => format!("{name}{at}"),
        false => format!("{name} {}", place(element)),
    }
}

/// An effect with its place and its first parameter that is not zero for sure, an offset or its drift:
/// `friction in the strut (strut.coulomb.force = 61.2 N)`.
pub fn sized(effect: &Effect) -> String {
    let named = located(&effect.name, &effect.element);
    let sure = effect.parameters.iter().find(|it| it.low > 0.0 || it.high < 0.0);
    match sure.or(effect.parameters.first()) {
        Some(it) => format!("{named} ({} = {})", it.name, value(it.value, &it.unit)),
        None => named,
    }
}

/// How sure a parameter is beside the one that keeps its value: `39.8 … 40.2 if sprung_mass is 90.00 kg`.
pub fn of_ratio(findings: &Findings, of: f64, ratio: Option<[f64; 2]>) -> Option<String> {
    let [low, high] = ratio?;
    let held = findings.nominal_parameters.iter().find(|it| it.is_yardstick)?;
    let [_, low, high] = interval(of, low, high);
    Some(format!("{low} … {high} if {} is {}", held.name, value(held.after, &held.unit)))
}

/// Digits of a limit.
const LIMIT_DIGITS: usize = 2;

/// The limit of a parameter where the records tell no value: `≤ 0.00087`.
pub fn limit(parameter: &EffectParameter) -> Option<String> {
    let limit = parameter.limit?;
    let sign = if limit > parameter.value { "≤" } else { "≥" };
    Some(format!("{sign} {}", digits(limit, LIMIT_DIGITS)))
}

/// Number and element of an effect that is given as `01 strut`.
fn split(key: &str) -> (&str, &str) {
    let key = key.trim();
    let (id, element) = key.split_once([' ', '@', ':', '/']).unwrap_or((key, ""));
    (id, element.trim())
}

/// The element of an effect that is given as `01 strut`.
pub fn element(key: &str) -> &str {
    split(key).1
}

/// The name of an effect that is given by number and place, as `01 strut`, if a candidate has them.
pub fn effect_name(findings: &Findings, key: &str) -> String {
    let (id, element) = split(key);
    let known = findings.candidates.iter().filter(|candidate| candidate.id == id);
    // A family shares one number: the member that explains most is meant, the lag of an input and not its gain.
    let fall = |it: &Candidate| it.evidence.map_or(f64::NEG_INFINITY, |it| it.delta_bic);
    let rank = |it: &Candidate| (it.element == element, it.fitted);
    let known = known.max_by(|a, b| rank(a).cmp(&rank(b)).then(fall(a).total_cmp(&fall(b))));
    match known {
        Some(known) if element.is_empty() => located(&known.name, &known.element),
        Some(known) => located(&known.name, element),
        None => key.to_owned(),
    }
}

/// The number of an account's item in the list of effects, from one; a curve, which is unmodelled, has none.
pub fn effect_rank(findings: &Findings, item: &AccountItem) -> Option<usize> {
    let of_item = |effect: &Effect| located(&effect.name, &effect.element) == item.name;
    findings.effects.iter().position(of_item).map(|index| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decision::evidence::Evidence;

    #[test]
    fn a_place_is_named_once() {
        let names = [("viscous guide", "guide"), ("force offset", "guide"), ("soft mount", "strut")];
        let located = names.map(|(name, element)| located(name, element));
        assert_eq!(located, ["viscous guide", "force offset in the guide", "soft mount in the strut"]);
    }

    #[test]
    fn of_a_family_the_member_that_explains_most_is_named() {
        let member = |name: &str, delta_bic: Option<f64>| Candidate {
            id: "42".into(),
            element: "tau".into(),
            name: name.into(),
            share: 0.0,
            validation_share: 0.0,
            fitted: delta_bic.is_some(),
            values: Vec::new(),
            evidence: delta_bic.map(|delta_bic| Evidence { delta_bic, ..Evidence::default() }),
            outcome: String::new(),
        };
        let candidates = vec![
            member("lag of the sensor", Some(900.0)),
            member("gain of the sensor", Some(4.0)),
            member("drift", None),
        ];
        let findings = Findings { candidates, ..Findings::of_bad_data("rig", vec![], vec![], vec![]) };
        assert_eq!(effect_name(&findings, "42 tau"), "lag of the sensor at tau");
        assert_eq!(effect_name(&findings, "43 tau"), "43 tau");
    }

    #[test]
    fn one_of_several_is_told_with_its_place() {
        let [strut, guide] = [Element::STRUT, Element::GUIDE].map(|it| it.at("rear_left").name());
        assert_eq!(located("Coulomb friction", strut), "Coulomb friction in the strut (rear left)");
        assert_eq!(located("viscous guide", guide), "viscous guide (rear left)");
        assert_eq!((part(strut), part("strut.deflection")), (Some(Part::Strut), None));
        assert_eq!(place("tire.deflection"), "at tire.deflection");
    }

    #[test]
    fn the_inside_of_an_actuator_is_no_sensor() {
        let places = ["pump", "valve", "tire", "motor.speed"].map(place);
        assert_eq!(places, ["in the pump", "in the valve", "in the tyre", "at motor.speed"]);
    }
}
