//! Reports of causes that are in no catalogue.

use super::*;
use crate::Sensors;
use crate::catalogue::Entry;

/// A truth with an effect as its entry describes it.
fn hidden(id: &str, signal: &str) -> Truth {
    let entry = Entry::find(id).unwrap();
    let mut truth = truth(&[(id, entry.place, signal)]);
    let effect = &mut truth.effects[0];
    effect.variable = entry.variable.into();
    effect.depends_on = entry.depends_on.iter().map(|word| (*word).to_owned()).collect();
    let value = |name: &str| Value { name: name.into(), unit: String::new(), value: 5.0 };
    effect.parameters = entry.parameters.iter().map(|it| value(it.name)).collect();
    truth
}

fn report(verdict: &str, causes: &[(&str, &[&str], Option<f64>)]) -> String {
    let share = |number: usize| 0.5 / (1.0 + number as f64);
    let cause = |(number, (place, depends_on, frequency)): (usize, &(&str, &[&str], Option<f64>))| {
        serde_json::json!({
            "place": place, "share": share(number), "depends_on": depends_on, "frequency": frequency,
            "description": "a force", "further": {"field": 1},
        })
    };
    let causes: Vec<_> = causes.iter().enumerate().map(cause).collect();
    serde_json::json!({"format": 3, "verdict": verdict, "effects": [], "unmodelled": causes}).to_string()
}

fn judged(truth: &Truth, place: &str, depends_on: &[&str]) -> (Outcome, Option<bool>, Option<bool>) {
    let score = score(truth, &report("unmodelled", &[(place, depends_on, None)])).unwrap();
    (score.outcome, score.location_right, score.variable_right)
}

const RIGHT: (Outcome, Option<bool>, Option<bool>) = (Outcome::Unnamed, Some(true), Some(true));

#[test]
fn places_and_variables_of_each_kind() {
    for (id, signal, place, word) in [
        ("U1", "", "strut", "suspension.deflection"),
        ("U2", "", "strut", "velocity"),
        ("U4", "", "wheel_guide", "wheel.velocity"),
        ("U5", "wheel.force", "wheel.force", "time"),
        ("U7", "", "strut", "acceleration"),
        ("U7", "", "actuator.force", "acceleration"),
        ("U8", "", "strut", "memory"),
        ("U9", "", "guide", "memory"),
        ("U9", "", "body", "acceleration"),
        ("U9", "", "frame", "memory"),
        ("U10", "", "actuator", "bursts"),
        ("U10", "", "strut", "command"),
        ("U11", "", "tire", "time"),
        ("U11", "", "road.position", "time"),
        ("U12", "", "strut", "deflection and velocity"),
        ("U13", "body.acceleration", "body.acceleration", "bursts"),
        ("U14", "", "guide", "time"),
        ("U15", "", "guide", "actuator.force"),
        ("U15", "", "actuator", "command"),
    ] {
        let truth = hidden(id, signal);
        assert_eq!(judged(&truth, place, &[word]), RIGHT, "{id} {place} {word}");
        assert_eq!(judged(&truth, "valve", &["pressure"]), (Outcome::Unnamed, Some(false), Some(false)));
    }
}

#[test]
fn what_can_be_told_apart_is_wrong() {
    let place = |id: &str, signal: &str, place: &str| judged(&hidden(id, signal), place, &["time"]).1;
    assert_eq!(place("U7", "", "guide"), Some(false));
    assert_eq!(place("U9", "", "strut"), Some(false));
    assert_eq!(place("U14", "", "actuator"), Some(false));
    assert_eq!(place("U13", "body.acceleration", "guide"), Some(false));
    assert_eq!(place("U13", "body.acceleration", "wheel.acceleration"), Some(false));
    // The force cell sees what the tyre does, and not what the wheel's guide does.
    let mut tire = hidden("U11", "");
    assert_eq!(judged(&tire, "wheel_guide", &["time"]).1, Some(false));
    tire.case.sensors = Sensors::NoForceCell;
    assert_eq!(judged(&tire, "wheel_guide", &["time"]).1, Some(true));
}

/// Who lists every word has said nothing: two count.
#[test]
fn two_words_count() {
    let of = |words: &[&str]| judged(&hidden("U8", ""), "strut", words).2;
    assert_eq!(of(&["velocity", "memory"]), Some(true));
    assert_eq!(of(&["velocity", "deflection", "memory"]), Some(false));
    assert_eq!(of(&["deflection and velocity", "memory"]), Some(false));
    assert_eq!(of(&[]), Some(false));
}

#[test]
fn the_largest_cause_is_judged() {
    let causes: [(&str, &[&str], _); 2] = [("strut", &["memory"], None), ("guide", &["time"], None)];
    let right = score(&hidden("U8", ""), &report("unmodelled", &causes)).unwrap();
    let other = score(&hidden("U14", ""), &report("unmodelled", &causes)).unwrap();
    assert_eq!((right.location_right, right.variable_right), (Some(true), Some(true)));
    assert_eq!((other.location_right, other.variable_right), (Some(false), Some(false)));
    assert_eq!(right.first, "unmodelled strut");
}

#[test]
fn the_words_of_both_formats_are_read() {
    let truth = hidden("U1", "");
    let old =
        r#"{"verdict": "unnamed", "unnamed": {"location": "strut", "variable": "suspension.deflection"}}"#;
    let score = |text: &str| score(&truth, text).unwrap();
    assert_eq!((score(old).outcome, score(old).variable_right), (Outcome::Unnamed, Some(true)));
    let named = |verdict: &str| format!(r#"{{"verdict": "{verdict}", "effects": [{{"id": "09"}}]}}"#);
    for verdict in ["named", "identified", "ambiguous"] {
        assert_eq!(score(&named(verdict)).outcome, Outcome::WrongName);
    }
    let read: Vec<&str> = words("road.position and wheel.velocity, voltage").collect();
    assert_eq!(read, ["deflection", "velocity", "command"]);
}

#[test]
fn a_verdict_without_a_cause_is_no_effect_or_at_least_a_doubt() {
    let of = |verdict: &str| score(&hidden("U8", ""), &report(verdict, &[])).unwrap();
    for verdict in ["no_effect", "parameter_mismatch"] {
        assert_eq!(of(verdict).outcome, Outcome::Missed);
    }
    for verdict in ["model_inadequate", "unmodelled", "bad_data"] {
        let score = of(verdict);
        assert_eq!(
            (score.outcome, score.location_right, score.variable_right),
            (Outcome::Unnamed, None, None)
        );
    }
    let there = came_out(&[], &report("unmodelled", &[("strut", &["memory"], None)]));
    assert_eq!(there, Outcome::FalseAlarm);
}

/// A record that is told to be bad there is at its place.
#[test]
fn a_problem_of_a_loose_sensors_record_is_its_place() {
    let problem = |signal: &str| {
        let text = format!(r#"{{"verdict": "bad_data", "data_problems": [{{"signal": "{signal}"}}]}}"#);
        score(&hidden("U13", "body.acceleration"), &text).unwrap().location_right
    };
    assert_eq!([problem("body.acceleration"), problem("wheel.force")], [Some(true), None]);
}

#[test]
fn a_name_for_what_the_clutter_brings_does_not_hide_what_has_none() {
    let mut text: serde_json::Value =
        serde_json::from_str(&report("unmodelled", &[("guide", &["time"], Some(5.4))])).unwrap();
    text["effects"] = serde_json::json!([{"id": "07", "element": "strut"}]);
    let score = score(&hidden("U14", ""), &text.to_string()).unwrap();
    assert_eq!((score.outcome, score.beside_clutter), (Outcome::WrongName, Outcome::Unnamed));
    assert_eq!((score.location_right, score.variable_right), (Some(true), Some(true)));
}

#[test]
fn frequencies_are_judged_where_there_are_any() {
    let of = |id: &str, signal: &str, frequency| {
        let text = report("unmodelled", &[("guide", &["time"], frequency)]);
        score(&hidden(id, signal), &text).unwrap().frequency_right
    };
    assert_eq!([of("U14", "", Some(5.2)), of("U14", "", Some(7.0))], [Some(true), Some(false)]);
    assert_eq!(
        [of("U9", "", Some(5.5)), of("U14", "", None), of("U7", "", Some(5.0))],
        [Some(true), None, None]
    );
    assert_eq!(of("U5", "wheel.force", Some(5.0)), None);
}

/// A mode of the frame at the absorber's frequency is the absorber; at another one it is a false name.
#[test]
fn an_absorber_may_be_named_by_its_law() {
    let named = |low: f64, high: f64| {
        let frequency = serde_json::json!({"name": "frame.frequency", "low": low, "high": high});
        let effect = serde_json::json!({"id": "18", "element": "frame", "parameters": [frequency]});
        let text = serde_json::json!({"verdict": "identified", "effects": [effect]}).to_string();
        let score = score(&hidden("U9", ""), &text).unwrap();
        (score.outcome, score.location_right, score.variable_right)
    };
    assert_eq!(named(4.6, 5.6), (Outcome::Correct, Some(true), Some(true)));
    assert_eq!(named(9.0, 11.0).0, Outcome::WrongName);
}

#[test]
fn the_only_mass_feels_a_force_from_wherever_it_comes() {
    let mut truth = hidden("U9m", "");
    truth.case.plant = Plant::GuidedMass;
    for place in ["guide", "force", "ground_spring"] {
        assert_eq!(judged(&truth, place, &["memory"]), RIGHT, "{place}");
    }
    assert_eq!(judged(&truth, "position", &["memory"]).1, Some(false));
}

#[test]
fn the_page_tells_of_causes_out_of_the_catalogue() {
    let (one, other) = (hidden("U14", ""), hidden("U8", ""));
    let right = report("unmodelled", &[("guide", &["time"], Some(5.0))]);
    let scores = [
        score(&one, &right).unwrap(),
        score(&one, &report("no_effect", &[])).unwrap(),
        score(&other, &named(&[("07", "strut", &[])])).unwrap(),
        score(&other, &right).unwrap(),
    ];
    let text = markdown(&scores);
    for row in [
        "out of catalogue: falsely named | ≤ 5 % | 25.0 % | 1/4 |",
        "named | – | 0.0 % | 0/4 |",
        "out of catalogue: reported as no effect | – | 25.0 % | 1/4 |",
        "out of catalogue: place right | – | 50.0 % | 2/4 |",
        "out of catalogue: variable right | – | 25.0 % | 1/4 |",
        "out of catalogue: location and variable right | ≥ 85 % | 25.0 % | 1/4 |",
        "one is reported | – | 100.0 % | 1/1 |",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    let text = breakdown(&scores);
    assert!(text.contains("| U14 | 2 | 0 | 1 | 1 | 1 |"), "{text}");
    assert!(text.contains("| U8 | 2 | 1 | 0 | 1 | 0 |"), "{text}");
}

/// Of a friction and an absorber, the one has a name and the other has none.
#[test]
fn beside_an_effect_with_a_number() {
    let mut truth = hidden("U9", "");
    truth.effects.push(super::truth(&[FRICTION]).effects.remove(0));
    let of = |names: &[(&str, &str, &[&str])], causes: &[(&str, &[&str], Option<f64>)]| {
        let mut text: serde_json::Value = serde_json::from_str(&report("unmodelled", causes)).unwrap();
        let named: serde_json::Value = serde_json::from_str(&named(names)).unwrap();
        text["effects"] = named["effects"].clone();
        text["verdict"] = if causes.is_empty() { "identified" } else { "unmodelled" }.into();
        let score = score(&truth, &text.to_string()).unwrap();
        (score.outcome, score.location_right)
    };
    let (friction, other): ((_, _, &[&str]), (_, _, &[&str])) = (("01", "strut", &[]), ("16", "guide", &[]));
    let absorber: [(&str, &[&str], _); 1] = [("guide", &["memory"], None)];
    assert_eq!(of(&[friction], &absorber), (Outcome::Unnamed, Some(true)));
    assert_eq!(of(&[], &absorber), (Outcome::Unnamed, Some(true)));
    assert_eq!(of(&[friction], &[]), (Outcome::TooFew, Some(false)));
    assert_eq!(of(&[other], &absorber), (Outcome::WrongName, Some(true)));
    assert_eq!(of(&[friction, other], &absorber).0, Outcome::WrongName);
}
