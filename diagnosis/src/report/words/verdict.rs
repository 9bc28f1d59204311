//! The verdict as a sentence and as a badge.

use super::{effect_name, list, located, percent, small_rest};
use crate::report::findings::{Effect, Findings, NominalParameter, Verdict};

/// Names that a headline lists one by one; of more it gives the number.
pub const LISTED: usize = 3;

/// The verdict as one sentence.
pub fn headline(findings: &Findings) -> String {
    let effects: Vec<String> = findings.effects.iter().map(full_name).collect();
    match findings.verdict {
        Verdict::NoEffect => rest(findings, "These records show no effect beyond the model.", "effect"),
        Verdict::ParameterMismatch => mismatch(findings),
        Verdict::Identified if effects.is_empty() => "An effect is identified.".into(),
        Verdict::Identified => format!("The model lacks {}.", list(&effects, "and")),
        Verdict::Ambiguous => ambiguous(findings),
        Verdict::Unmodelled => unmodelled(findings),
        Verdict::SensorFault => sensor_fault(findings, &list(&effects, "and")),
        Verdict::ModelInadequate => "The model predicts too little of the data to identify an effect.".into(),
        Verdict::OutOfTime => "The time limit was reached before an effect was identified.".into(),
        Verdict::BadData => "The data cannot be used as they are.".into(),
    }
}

fn full_name(effect: &Effect) -> String {
    located(&effect.name, &effect.element)
}

fn unmodelled(findings: &Findings) -> String {
    if let Some(it) = findings.unmodelled.first() {
        return format!("The model lacks {}. No effect of the catalogue explains it.", it.description);
    }
    // A rig that was changed between two records lacks nothing.
    if let Some(it) = findings.disagreements.first() {
        return format!(
            "No model describes all records: they disagree on {}. If the rig was changed between them, diagnose them \
             separately.",
            it.name
        );
    }
    let place =
        findings.missing.as_ref().map_or(String::new(), |it| format!(", most likely at the {}", it.place));
    format!("The model lacks something{place}. No recorded signal explains it.")
}

fn mismatch(findings: &Findings) -> String {
    let rest = rest(findings, "The records show no further effect.", "further effect");
    let wrong = mismatched(findings).unwrap_or_else(|| "Parameters differ from the starting model.".into());
    format!("{wrong} {rest}")
}

/// That there is nothing else, if the records agree and leave no error that shows in a plot.
fn rest(findings: &Findings, nothing: &str, effect: &str) -> String {
    match (disagreeing(findings), small_rest(findings)) {
        (Some(they_disagree), _) => format!("{they_disagree} No {effect} is identified."),
        (None, Some(rest)) => format!(
            "No {effect} is identified, but {} of {} is unexplained.",
            percent(rest.share),
            rest.signal
        ),
        (None, None) => nothing.to_owned(),
    }
}

/// Of the plant it says what else is wrong, or that nothing is.
fn sensor_fault(findings: &Findings, faults: &str) -> String {
    let faults = if faults.is_empty() { String::new() } else { format!(": {faults}") };
    let plant: Vec<String> = [mismatched(findings), disagreeing(findings)].into_iter().flatten().collect();
    if plant.is_empty() {
        format!("A sensor is at fault, not the plant{faults}.")
    } else {
        format!("A sensor is at fault{faults}. {}", plant.join(" "))
    }
}

/// The nominal parameters that are off.
fn mismatched(findings: &Findings) -> Option<String> {
    let wrong: Vec<&NominalParameter> =
        findings.nominal_parameters.iter().filter(|parameter| parameter.mismatch).collect();
    let names: Vec<String> = wrong.iter().map(|parameter| parameter.name.clone()).collect();
    let differ = match names.len() {
        0 => return None,
        1 => format!("{} differs", names[0]),
        2..=LISTED => format!("{} differ", list(&names, "and")),
        more => format!("{more} parameters differ"),
    };
    // One effect in the place of them all.
    let instead = &wrong[0].equivalent_effects;
    let is_one = !instead.is_empty() && wrong.iter().all(|it| it.equivalent_effects == *instead);
    Some(match is_one {
        true => format!(
            "{differ} from the starting model, unless it is {}: these records cannot tell.",
            list(instead, "or")
        ),
        false => format!("{differ} from the starting model."),
    })
}

/// The clearest of what records disagree on.
fn disagreeing(findings: &Findings) -> Option<String> {
    findings.disagreements.first().map(|it| format!("The records disagree on {}.", it.name))
}

fn ambiguous(findings: &Findings) -> String {
    let (settled, open): (Vec<&Effect>, Vec<&Effect>) =
        findings.effects.iter().partition(|effect| effect.ambiguous_with.is_empty());
    let settled: Vec<String> = settled.into_iter().map(full_name).collect();
    let others = open.iter().flat_map(|effect| &effect.ambiguous_with);
    let mut rivals: Vec<String> = open.iter().map(|effect| full_name(effect)).collect();
    for other in others.map(|key| effect_name(findings, key)) {
        if !rivals.contains(&other) {
            rivals.push(other);
        }
    }
    let rivals_or = list(&rivals, "or");
    match (rivals.len(), settled.len()) {
        (0 | 1, _) => "Several effects explain the data equally well.".into(),
        (_, 0) => format!("The model lacks {rivals_or}. These records cannot tell which."),
        _ => format!(
            "The model lacks {}. It also lacks {rivals_or}; these records cannot tell which.",
            list(&settled, "and")
        ),
    }
}

/// The verdict in a word or two, with its style's class. Records that leave something open have not shown that nothing is there.
pub fn badge(findings: &Findings) -> (&'static str, &'static str) {
    let is_open = || disagreeing(findings).is_some() || small_rest(findings).is_some();
    match findings.verdict {
        Verdict::NoEffect if is_open() => ("nothing identified", "doubt"),
        Verdict::NoEffect => ("no effect", "good"),
        Verdict::ParameterMismatch => ("parameter mismatch", "found"),
        Verdict::Identified => ("identified", "found"),
        Verdict::Ambiguous => ("ambiguous", "doubt"),
        Verdict::Unmodelled => ("unmodelled", "doubt"),
        Verdict::SensorFault => ("sensor fault", "found"),
        Verdict::ModelInadequate => ("model inadequate", "bad"),
        Verdict::OutOfTime => ("out of time", "doubt"),
        Verdict::BadData => ("bad data", "bad"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::{Disagreement, RecordValue, Signal, SignalAccount};

    #[test]
    fn an_error_that_shows_is_named_where_nothing_is_identified() {
        let mut found = Findings::of_bad_data("rig", vec![], vec![], vec![]);
        found.signals =
            vec![Signal { name: "body.position".into(), fit_without_input_noise: 0.92, ..Signal::default() }];
        found.account = vec![SignalAccount {
            signal: "body.position".into(),
            unexplained: 0.4,
            noise: 0.001,
            ..SignalAccount::default()
        }];
        let of = |verdict| headline(&Findings { verdict, ..found.clone() });
        assert_eq!(
            of(Verdict::NoEffect),
            "No effect is identified, but 8.0 % of body.position is unexplained."
        );
        let told = of(Verdict::ParameterMismatch);
        assert!(
            told.ends_with("No further effect is identified, but 8.0 % of body.position is unexplained."),
            "{told}"
        );
        found.signals[0].fit_without_input_noise = 0.99;
        assert_eq!(
            headline(&Findings { verdict: Verdict::NoEffect, ..found }),
            "These records show no effect beyond the model."
        );
    }

    #[test]
    fn one_effect_in_the_place_of_several_parameters_is_named() {
        let named = |name: &str, effects: &[&str]| NominalParameter {
            name: name.into(),
            mismatch: true,
            equivalent_effects: effects.iter().map(|it| (*it).to_owned()).collect(),
            ..NominalParameter::default()
        };
        let told = |all: Vec<NominalParameter>| {
            let bad = Findings::of_bad_data("rig", vec![], vec![], vec![]);
            headline(&Findings { verdict: Verdict::ParameterMismatch, nominal_parameters: all, ..bad })
        };
        let gain: &[&str] = &["gain of the actuator"];
        assert_eq!(
            told(vec![named("a", gain), named("b", gain)]),
            "a and b differ from the starting model, unless it is gain of the actuator: these records cannot tell. The \
             records show no further effect."
        );
        assert!(
            told(vec![named("a", gain), named("b", &[])])
                .starts_with("a and b differ from the starting model.")
        );
    }

    #[test]
    fn records_of_a_rig_that_was_changed_lack_nothing() {
        let mut found =
            Findings { verdict: Verdict::Unmodelled, ..Findings::of_bad_data("rig", vec![], vec![], vec![]) };
        assert_eq!(headline(&found), "The model lacks something. No recorded signal explains it.");
        let of = |record: &str, value: f64| RecordValue {
            record: record.into(),
            value,
            low: 0.9 * value,
            high: 1.1 * value,
        };
        found.disagreements.push(Disagreement {
            name: "strut.stiffness".into(),
            unit: "N/m".into(),
            yardstick: None,
            records: [of("monday.csv", 8e3), of("tuesday.csv", 1e4)],
        });
        let told = headline(&found);
        assert!(told.contains("they disagree on strut.stiffness") && !told.contains("lacks"), "{told}");
        // Nor is it a plant without a fault.
        let with = |verdict: Verdict| headline(&Findings { verdict, ..found.clone() });
        for verdict in [Verdict::NoEffect, Verdict::ParameterMismatch, Verdict::SensorFault] {
            let told = with(verdict);
            assert!(told.contains("disagree on strut.stiffness"), "{told}");
            assert!(!told.contains("no effect beyond") && !told.contains("not the plant"), "{told}");
        }
        found.disagreements.clear();
        assert_eq!(
            headline(&Findings { verdict: Verdict::SensorFault, ..found }),
            "A sensor is at fault, not the plant."
        );
    }
}
