//! The verdict as a sentence and as a badge.

use super::{effect_name, list, located};
use crate::report::findings::{Effect, Findings, Verdict};

/// Names that a headline lists one by one; of more it gives the number.
const LISTED: usize = 3;

/// The verdict as one sentence.
pub fn headline(findings: &Findings) -> String {
    let effects: Vec<String> = findings.effects.iter().map(full_name).collect();
    match findings.verdict {
        Verdict::NoEffect => "These records show no effect beyond the model.".into(),
        Verdict::ParameterMismatch => mismatch(findings),
        Verdict::Identified if effects.is_empty() => "An effect is identified.".into(),
        Verdict::Identified => format!("The model lacks {}.", list(&effects, "and")),
        Verdict::Ambiguous => ambiguous(findings),
        Verdict::Unmodelled => unmodelled(findings),
        Verdict::SensorFault if effects.is_empty() => "A sensor is at fault, not the plant.".into(),
        Verdict::SensorFault => format!("A sensor is at fault, not the plant: {}.", list(&effects, "and")),
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
    format!("The model lacks something{place}. It follows no recorded signal.")
}

fn mismatch(findings: &Findings) -> String {
    let wrong = findings.nominal_parameters.iter().filter(|parameter| parameter.mismatch);
    let names: Vec<String> = wrong.map(|parameter| parameter.name.clone()).collect();
    let rest = "The records show no further effect.";
    match names.len() {
        0 => format!("Parameters differ from the starting model. {rest}"),
        1 => format!("{} differs from the starting model. {rest}", names[0]),
        2..=LISTED => format!("{} differ from the starting model. {rest}", list(&names, "and")),
        more => format!("{more} parameters differ from the starting model. {rest}"),
    }
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
        Verdict::OutOfTime => ("out of time", "doubt"),
        Verdict::BadData => ("bad data", "bad"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::{Disagreement, RecordValue};

    #[test]
    fn records_of_a_rig_that_was_changed_lack_nothing() {
        let mut found =
            Findings { verdict: Verdict::Unmodelled, ..Findings::of_bad_data("rig", vec![], vec![], vec![]) };
        assert_eq!(headline(&found), "The model lacks something. It follows no recorded signal.");
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
    }
}
