mod unmodelled;

use super::*;
use crate::case::{Case, Oracle, Value};

fn truth(effects: &[(&str, Place, &str)]) -> Truth {
    let present = |&(id, place, signal): &(&str, Place, &str)| Present {
        id: id.into(),
        name: String::new(),
        place,
        signal: signal.into(),
        variable: "suspension.deflection".into(),
        depends_on: vec!["deflection".into()],
        parameters: vec![Value { name: "strut.coulomb.force".into(), unit: "N".into(), value: 60.0 }],
        ratio: None,
    };
    let case = Case::standard("test", vec![], 1);
    let value = |name: &str, unit: &str, value| Value { name: name.into(), unit: unit.into(), value };
    Truth {
        case,
        effects: effects.iter().map(present).collect(),
        base: vec![value("sprung_mass", "kg", 95.0), value("unsprung_mass", "kg", 24.0)],
        noise: vec![],
        oracle: Oracle {
            recorded: vec![value("wheel.force", "N", 12.5)],
            exact: vec![value("wheel.force", "N", 10.0)],
        },
    }
}

fn named(effects: &[(&str, &str, &[&str])]) -> String {
    let effects: Vec<serde_json::Value> = effects
        .iter()
        .map(|(id, element, alike)| {
            let force = serde_json::json!({"name": "strut.coulomb.force", "low": 55.0, "high": 65.0});
            serde_json::json!({"id": id, "element": element, "parameters": [force], "ambiguous_with": alike})
        })
        .collect();
    serde_json::json!({"verdict": "named", "effects": effects, "seconds": 2.0}).to_string()
}

const FRICTION: (&str, Place, &str) = ("01", Place::Strut, "");
const SPRING: (&str, Place, &str) = ("08", Place::Strut, "");
const GAIN: (&str, Place, &str) = ("34", Place::Sensor, "wheel.force");

fn came_out(effects: &[(&str, Place, &str)], report: &str) -> Outcome {
    score(&truth(effects), report).unwrap().outcome
}

#[test]
fn one_effect() {
    let of = |report: &str| came_out(&[FRICTION], report);
    assert_eq!(of(&named(&[("01", "strut", &[])])), Outcome::Correct);
    assert_eq!(of(&named(&[("01", "strut", &["16 guide"])])), Outcome::OneOfTwo);
    assert_eq!(of(&named(&[("16", "guide", &["01 strut"])])), Outcome::OneOfTwo);
    assert_eq!(of(&named(&[("16", "guide", &["01", "04"])])), Outcome::OneOfMany);
    assert_eq!(of(&named(&[("16", "guide", &[])])), Outcome::WrongName);
    assert_eq!(of(&named(&[("01", "strut", &[]), ("16", "guide", &[])])), Outcome::TooMany);
    assert_eq!(of(r#"{"verdict": "no_effect"}"#), Outcome::Missed);
    assert_eq!(of(r#"{"verdict": "unnamed", "unnamed": {"location": "strut"}}"#), Outcome::Unnamed);
}

#[test]
fn a_law_with_a_letter_of_its_own_is_not_called_by_the_number_alone() {
    let of = |report: &str| came_out(&[("28h", Place::Actuator, "")], report);
    assert_eq!(of(&named(&[("28h", "valve", &[])])), Outcome::Correct);
    assert_eq!(of(&named(&[("28", "valve", &["28h valve"])])), Outcome::OneOfTwo);
    assert_eq!(of(&named(&[("28", "valve", &[])])), Outcome::WrongName);
}

/// The clutter's weak Maxwell branch is there, too; its own name counts for itself where it was hidden.
#[test]
fn what_of_the_clutter_is_named_besides_is_told_apart() {
    let of = |effects: &[(&str, &str, &[&str])]| {
        let score = score(&truth(&[FRICTION]), &named(effects)).unwrap();
        (score.outcome, score.beside_clutter)
    };
    let friction: (&str, &str, &[&str]) = ("01", "strut", &[]);
    assert_eq!(of(&[friction, ("07", "strut", &[])]), (Outcome::TooMany, Outcome::Correct));
    assert_eq!(of(&[friction, ("36", "body.acceleration", &[])]), (Outcome::TooMany, Outcome::Correct));
    assert_eq!(of(&[friction, ("36", "wheel.force", &[])]), (Outcome::TooMany, Outcome::TooMany));
    assert_eq!(of(&[("07", "strut", &[])]), (Outcome::WrongName, Outcome::Missed));
    let score = score(&truth(&[SPRING]), &named(&[("08", "strut", &[])])).unwrap();
    assert_eq!(score.beside_clutter, Outcome::Correct);
}

#[test]
fn a_rest_that_is_described_beside_a_name_claims_nothing() {
    let friction = ("01", Place::Strut, "");
    let report = |share: f64| {
        format!(
            r#"{{"verdict": "identified", "unmodelled": [{{"place": "strut", "share": {share}}}],
            "effects": [{{"id": "01", "element": "strut", "parameters": [], "ambiguous_with": []}}]}}"#
        )
    };
    assert_eq!(came_out(&[friction], &report(0.0)), Outcome::Correct);
    assert_eq!(came_out(&[friction], &report(0.3)), Outcome::TooMany);
}

#[test]
fn gain_and_delay_of_one_input_are_one_effect() {
    let input = ("42", Place::Sensor, "road.position");
    let twice = named(&[("42", "road.position", &[]), ("42", "road.position", &[])]);
    assert_eq!(came_out(&[input], &twice), Outcome::Correct);
    let others = named(&[("42", "road.position", &[]), ("42", "actuator.force", &[])]);
    assert_eq!(came_out(&[input], &others), Outcome::TooMany);
}

#[test]
fn several_effects() {
    let of = |report: &str| came_out(&[FRICTION, SPRING], report);
    assert_eq!(of(&named(&[("08", "strut", &[]), ("01", "strut", &[])])), Outcome::Correct);
    assert_eq!(of(&named(&[("01", "strut", &[])])), Outcome::TooFew);
    assert_eq!(of(&named(&[("01", "strut", &[]), ("16", "guide", &[])])), Outcome::WrongName);
}

#[test]
fn a_sensor_is_told_by_its_signal() {
    assert_eq!(came_out(&[GAIN], &named(&[("34", "wheel.force", &[])])), Outcome::Correct);
    assert_eq!(came_out(&[GAIN], &named(&[("34", "body.acceleration", &[])])), Outcome::WrongName);
    let said = |report: &str| score(&truth(&[GAIN]), report).unwrap().sensor_or_plant;
    assert_eq!(said(&named(&[("34", "body.acceleration", &[])])), Some(true));
    assert_eq!(said(&named(&[("01", "strut", &[])])), Some(false));
    let lost = ("38d", Place::Sensor, "wheel.force");
    let report = r#"{"verdict": "bad_data", "data_problems": [{"signal": "wheel.force"}]}"#;
    assert_eq!(came_out(&[lost], report), Outcome::Correct);
}

#[test]
fn what_an_actuator_does_is_told_by_its_signal_and_is_the_plants() {
    let of = |effect, id: &str, element: &str| {
        let judged = score(&truth(&[effect]), &named(&[(id, element, &[])])).unwrap();
        (judged.outcome, judged.location_right, judged.sensor_or_plant)
    };
    for id in ["23", "24", "25"] {
        let there = (id, Place::Actuator, "");
        for element in ["actuator.force", "actuator"] {
            assert_eq!(of(there, id, element), (Outcome::Correct, Some(true), Some(true)), "{id} {element}");
        }
    }
    let gain = ("25", Place::Actuator, "");
    assert_eq!(of(gain, "24", "voltage"), (Outcome::WrongName, Some(true), Some(true)));
    assert_eq!(of(gain, "34", "wheel.force"), (Outcome::WrongName, Some(false), Some(false)));
    assert_eq!(of(gain, "36", "actuator.force"), (Outcome::WrongName, Some(false), Some(false)));
    assert_eq!(of(GAIN, "25", "actuator.force"), (Outcome::WrongName, Some(false), Some(false)));
}

#[test]
fn a_curve_beside_what_is_there_is_too_much() {
    let damping = ("21", Place::Tire, "");
    let report = |unnamed: &str| {
        format!(
            r#"{{"verdict": "parameter_mismatch", {unnamed}
            "nominal_parameters": [{{"name": "tire.damping", "low": 60, "high": null, "mismatch": true}}]}}"#
        )
    };
    assert_eq!(came_out(&[damping], &report("")), Outcome::Correct);
    assert_eq!(came_out(&[damping], &report(r#""unnamed": {"location": "strut"},"#)), Outcome::TooMany);
}

#[test]
fn nothing_is_there() {
    assert_eq!(came_out(&[], r#"{"verdict": "no_effect"}"#), Outcome::Correct);
    assert_eq!(came_out(&[], r#"{"verdict": "parameter_mismatch"}"#), Outcome::Correct);
    assert_eq!(came_out(&[], &named(&[("01", "strut", &[])])), Outcome::FalseAlarm);
    assert_eq!(came_out(&[], r#"{"verdict": "model_inadequate"}"#), Outcome::FalseAlarm);
}

#[test]
fn without_a_number_it_wants_no_name() {
    let hump = [("U1", Place::Strut, "")];
    let report =
        r#"{"verdict": "unnamed", "unnamed": {"location": "strut", "variable": "suspension.deflection"}}"#;
    let judged = score(&truth(&hump), report).unwrap();
    assert_eq!(judged.outcome, Outcome::Unnamed);
    assert_eq!((judged.location_right, judged.variable_right), (Some(true), Some(true)));
    assert_eq!(came_out(&hump, &named(&[("01", "strut", &[])])), Outcome::WrongName);
}

#[test]
fn intervals_are_counted_for_rightly_named_effects() {
    let covered = |report: &str| score(&truth(&[FRICTION]), report).unwrap().covered;
    assert_eq!(covered(&named(&[("01", "strut", &[])])), (1, 1));
    assert_eq!(covered(&named(&[("16", "guide", &[])])), (0, 0));
}

#[test]
fn nominal_parameters_are_judged_where_the_causes_are_right() {
    let report = |id: &str| {
        let mass = |name: &str| serde_json::json!({"name": name, "low": 94.0, "high": 96.0});
        let force = serde_json::json!({"name": "wheel.force", "fit_after": 0.8, "rms_fitted": 50.0, "rms_after": 20.0});
        serde_json::json!({
            "verdict": "named", "effects": [{"id": id, "element": "strut"}], "signals": [force],
            "nominal_parameters": [mass("sprung_mass"), mass("unsprung_mass")],
        })
        .to_string()
    };
    let right = score(&truth(&[FRICTION]), &report("01")).unwrap();
    assert_eq!(right.base_covered, (1, 2));
    // Of a signal of 100 N, 50 N were left, then 20 N; oracles leave 12.5 and 10 N.
    let text = markdown(std::slice::from_ref(&right));
    assert!(
        text.contains("| Φ gained on validation data, of an oracle's | ≥ 90 % | 80.0 % | 1 | – |"),
        "{text}"
    );
    assert!(text.contains("without noise | – | 75.0 % | 1 | – |"), "{text}");
    assert_eq!(score(&truth(&[FRICTION]), &report("16")).unwrap().base_covered, (0, 0));
}

/// Newcombe (1998), table I: 81 of 263 and 0 of 20.
#[test]
fn wilson_is_the_published_interval() {
    let near = |(low, high): (f64, f64), a: f64, b: f64| (low - a).abs() < 5e-5 && (high - b).abs() < 5e-5;
    assert!(near(wilson(81, 263), 0.2553, 0.3662), "{:?}", wilson(81, 263));
    assert!(near(wilson(0, 20), 0.0, 0.1611), "{:?}", wilson(0, 20));
}

#[test]
fn the_table_counts() {
    let report = named(&[("01", "strut", &[])]);
    let scores = [
        score(&truth(&[FRICTION]), &report).unwrap(),
        score(&truth(&[SPRING]), &report).unwrap(),
        score(&truth(&[]), r#"{"verdict": "no_effect"}"#).unwrap(),
    ];
    let text = markdown(&scores);
    assert!(text.contains("| correct, or one of two | ≥ 95 % | 50.0 % | 1/2 |"), "{text}");
    assert!(text.contains("| false alarms with clutter | ≤ 5 % | 0.0 % | 0/1 |"), "{text}");
    assert!(text.contains("| 08 | 01 (1) |"), "{text}");
}

#[test]
fn conditions_are_compared_by_the_effects_that_were_tried_under_several() {
    let under = |change: &dyn Fn(Case) -> Case, effect, report: &str| {
        let plain = truth(&[effect]);
        score(&Truth { case: change(plain.case.clone()), ..plain }, report).unwrap()
    };
    let right = named(&[("01", "strut", &[])]);
    let standard = |case| case;
    let scores = [
        under(&standard, FRICTION, &right),
        under(&|case| Case { noise_db: Some(30.0), ..case }, FRICTION, &right),
        under(&|case| Case { noise_db: Some(30.0), ..case }, FRICTION, &named(&[("16", "guide", &[])])),
        under(&|case| Case { rate: 100.0, nominal_off: 0.2, ..case }, FRICTION, &right),
        under(&standard, SPRING, &right),
        under(&|case| Case { plant: Plant::ServoQuarter, ..case }, FRICTION, r#"{"verdict": "no_effect"}"#),
    ];
    let text = breakdown(&scores);
    assert!(text.contains("| standard | 1 | 1 (100 %) | 0 |"), "{text}");
    assert!(text.contains("| noise 30 dB below | 2 | 1 (50 %) | 1 |"), "{text}");
    assert!(text.contains("| 100 Hz, parameters 20 % off | 1 | 1 (100 %) | 0 |"), "{text}");
    assert!(text.contains("| quarter car, linear | 5 | 3 (60 %) | 2 |"), "{text}");
    assert!(text.contains("| quarter car with a servo valve | 1 | 0 (0 %) | 0 |"), "{text}");
}

#[test]
fn another_base_parameter_is_the_effect_of_the_valve() {
    let leakage = ("30", Place::Actuator, "");
    let report = |name: &str| {
        format!(
            r#"{{"verdict": "parameter_mismatch",
            "nominal_parameters": [{{"name": "{name}", "low": 1e-11, "high": 4e-11, "mismatch": true}}]}}"#
        )
    };
    assert_eq!(came_out(&[leakage], &report("actuator.cylinder.leakage")), Outcome::Correct);
    assert_eq!(came_out(&[leakage], &report("sprung_mass")), Outcome::Missed);
}

/// A pump's friction has a letter in the diagnosis, too; its gas and its valves are parameters of the model.
#[test]
fn a_pump_actuators_causes_are_told_in_their_own_ways() {
    let of = |id: &str, report: &str| {
        let judged = score(&truth(&[(id, Place::Pump, "")]), report).unwrap();
        (judged.outcome, judged.location_right)
    };
    assert_eq!(of("32c", &named(&[("32c", "pump", &[])])), (Outcome::Correct, Some(true)));
    assert_eq!(of("32c", &named(&[("32", "pump", &[])])).0, Outcome::WrongName);
    assert_eq!(of("30p", &named(&[("30", "pump", &[])])), (Outcome::Correct, Some(true)));
    assert_eq!(of("30p", &named(&[("32c", "pump", &[])])), (Outcome::WrongName, Some(true)));
    let another = |name: &str| {
        format!(
            r#"{{"verdict": "parameter_mismatch",
            "nominal_parameters": [{{"name": "{name}", "low": 1, "high": 2, "mismatch": true}}]}}"#
        )
    };
    let rebound = another("valve.rebound.pressure_drop[7]");
    assert_eq!(of("32b", &rebound).0, Outcome::Correct);
    assert_eq!(of("32b", &another("valve.compression.pressure_drop[7]")).0, Outcome::Missed);
    assert_eq!(of("32a", &another("gas.charge_pressure")).0, Outcome::Correct);
    assert_eq!(of("32a", &rebound).0, Outcome::Missed);
    // On a damper, its own laws are a family, and a pump's friction is none of it.
    let damper = |id: &str| came_out(&[("32h", Place::Strut, "")], &named(&[(id, "strut", &[])]));
    assert_eq!(
        [damper("32"), damper("32f"), damper("32c")],
        [Outcome::Correct, Outcome::Correct, Outcome::WrongName]
    );
}

#[test]
fn a_pivots_friction_and_a_brake_are_the_plants() {
    let of = |effect, id: &str, element: &str| {
        let mut truth = truth(&[effect]);
        truth.case.plant = Plant::SasRig;
        let judged = score(&truth, &named(&[(id, element, &[])])).unwrap();
        (judged.outcome, judged.location_right, judged.sensor_or_plant)
    };
    let right = (Outcome::Correct, Some(true), Some(true));
    assert_eq!(of(("01p", Place::Pivot, ""), "01", "pivot"), right);
    assert_eq!(of(("23", Place::Actuator, ""), "23", "brake.torque"), right);
    assert_eq!(of(("33", Place::Sensor, "relative.angle"), "33", "relative.angle"), right);
    assert_eq!(of(("01p", Place::Pivot, ""), "33", "relative.angle").2, Some(false));
}

/// Damping and conductance are parameters of its model; its valve and its chambers are places of their own.
#[test]
fn a_pneumatic_cylinders_causes_are_the_plants() {
    let of = |effect: (&str, Place, &str), report: &str| {
        let mut truth = truth(&[effect]);
        truth.case.plant = Plant::PneumaticCylinder;
        let judged = score(&truth, report).unwrap();
        (judged.outcome, judged.location_right)
    };
    let right = (Outcome::Correct, Some(true));
    for (id, element) in [("28", "valve"), ("30", "cylinder")] {
        assert_eq!(of((&format!("{id}c"), Place::Cylinder, ""), &named(&[(id, element, &[])])), right);
    }
    assert_eq!(of(("28c", Place::Cylinder, ""), &named(&[("30", "cylinder", &[])])).0, Outcome::WrongName);
    assert_eq!(of(("28c", Place::Cylinder, ""), &named(&[("33", "chamber_a.pressure", &[])])).1, Some(false));
    let another = |name: &str| {
        format!(
            r#"{{"verdict": "parameter_mismatch",
            "nominal_parameters": [{{"name": "{name}", "low": 1, "high": 2, "mismatch": true}}]}}"#
        )
    };
    let (damping, conductance) = (("15c", Place::Guide, ""), ("29c", Place::Cylinder, ""));
    assert_eq!(of(damping, &another("guide.damping")).0, Outcome::Correct);
    assert_eq!(of(conductance, &another("actuator.valve.conductance")).0, Outcome::Correct);
    assert_eq!(of(conductance, &another("guide.damping")).0, Outcome::Missed);
}

#[test]
fn a_constant_load_is_no_offset_of_a_sensor() {
    let load = ("33g", Place::Guide, "");
    assert_eq!(came_out(&[load], &named(&[("33", "guide", &[])])), Outcome::Correct);
    assert_eq!(came_out(&[load], &named(&[("33", "position", &[])])), Outcome::WrongName);
    assert_eq!(came_out(&[load], &named(&[("33", "position", &["33 force"])])), Outcome::WrongName);
    assert_eq!(came_out(&[load], &named(&[("33", "force", &["33 guide"])])), Outcome::OneOfTwo);
    let place = |element: &str| {
        let mut truth = truth(&[("33", Place::Sensor, "position")]);
        truth.case.plant = Plant::LinearDrive;
        let judged = score(&truth, &named(&[("33", element, &[])])).unwrap();
        (judged.first, judged.sensor_or_plant)
    };
    assert_eq!(place("position"), ("33 position".into(), Some(true)));
    assert_eq!(place("guide"), ("33".into(), Some(false)));
}

#[test]
fn what_is_no_report_is_refused() {
    assert!(score(&truth(&[]), "{}").unwrap_err().contains("verdict"));
}

impl Score {
    /// A single effect of the catalogue that came out in some way.
    pub fn of(case: &str, outcome: Outcome) -> Self {
        Self {
            case: case.into(),
            plant: Plant::LinearQuarter,
            condition: String::new(),
            truth: "01".into(),
            first: "02".into(),
            outcome,
            beside_clutter: outcome,
            effects: 1,
            out_of_catalogue: false,
            clutter: false,
            full_size: true,
            first_right: None,
            location_right: Some(true),
            variable_right: None,
            frequency_right: None,
            sensor_or_plant: None,
            covered: (0, 0),
            base_covered: (0, 0),
            gained: None,
            seconds: 1.0,
        }
    }
}
