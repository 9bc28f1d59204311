//! The experiment that separates rivals.

use super::{digits, effect_name, list, percent, trimmed, unit};
use crate::report::findings::{DecidingExperiment, Distinction, Drive, Findings, SourceFmu};

/// Digits of amplitudes and frequencies.
const DIGITS: usize = 3;
/// Digits of a number that is typed into a tool.
const TYPED: usize = 6;

/// What to do, or that nothing within the limits decides.
pub fn experiment(findings: &Findings, deciding: &DecidingExperiment) -> String {
    if deciding.compared == 0 {
        return "The model diverges under each excitation within the limits. Smaller ones (--stroke, --force, --rate) may keep \
                it where it is valid."
            .into();
    }
    let mut effects: Vec<&str> = deciding.pairs.iter().map(|it| &it.effect[..]).collect();
    effects.dedup();
    if !deciding.decides {
        let effects = effects.into_iter().map(|it| separation(findings, deciding, it, false));
        return format!(
            "None of {} excitations within the limits separates {}. Wider limits (--stroke, --force, --rate) or less \
             noise may.",
            deciding.compared,
            list(&effects.flatten().collect::<Vec<_>>(), "or")
        );
    }
    let drives: Vec<String> = deciding.drives.iter().map(drive).collect();
    let all = effects.into_iter().map(|effect| {
        let [yes, no] = [true, false].map(|it| separation(findings, deciding, effect, it));
        match (yes, no) {
            (Some(yes), None) => format!("It separates {yes}."),
            (None, Some(no)) => format!("It does not separate {no}."),
            (Some(yes), Some(_)) => {
                format!("It separates {yes}, not from {}.", rivals(findings, deciding, effect, false))
            }
            (None, None) => String::new(),
        }
    });
    format!(
        "Drive {} for {} s, with all other inputs at rest (experiment.csv). {}",
        list(&drives, "and"),
        trimmed(deciding.duration, DIGITS),
        all.collect::<Vec<_>>().join(" ")
    )
}

/// An effect and those of its rivals from which the experiment separates it, or does not; nothing if there are none.
fn separation(
    findings: &Findings,
    deciding: &DecidingExperiment,
    effect: &str,
    decides: bool,
) -> Option<String> {
    let rivals = rivals(findings, deciding, effect, decides);
    (!rivals.is_empty()).then(|| format!("{} from {rivals}", effect_name(findings, effect)))
}

fn rivals(findings: &Findings, deciding: &DecidingExperiment, effect: &str, decides: bool) -> String {
    let rivals = deciding.pairs.iter().filter(|it| it.effect == effect && it.decides == decides);
    let names: Vec<String> = rivals.map(|it| effect_name(findings, &it.rival)).collect();
    list(&names, if decides { "and" } else { "or" })
}

/// An effect and its rival.
pub fn pair(findings: &Findings, pair: &Distinction) -> String {
    format!("{} or {}", effect_name(findings, &pair.effect), effect_name(findings, &pair.rival))
}

/// `road.position with a chirp of 0.006 m from 0.3 to 15 Hz`.
fn drive(it: &Drive) -> String {
    let amplitude = format!("{} {}", trimmed(it.amplitude, DIGITS), unit(&it.unit));
    let frequency = match it.last_frequency {
        None => format!("at {} Hz", trimmed(it.frequency, DIGITS)),
        Some(last) => format!("from {} to {} Hz", trimmed(it.frequency, DIGITS), trimmed(last, DIGITS)),
    };
    format!("{} with a {} of {amplitude} {frequency}", it.input, it.shape)
}

/// `Road: kind = Chirp, amplitude = 0.006 m`.
pub fn source(source: &SourceFmu) -> String {
    let settings = source.settings.iter().map(|it| format!("{} = {}", it.name, it.choice));
    // No tool takes a typographic minus.
    let typed = |value: f64| trimmed(value, TYPED).replace('−', "-");
    let parameters =
        source.parameters.iter().map(|it| format!("{} = {} {}", it.name, typed(it.value), it.unit));
    let all: Vec<String> = settings.chain(parameters).collect();
    let behind = if source.adapter { ", behind it a SignalAdapter with factor = 1" } else { "" };
    format!("{}: {}{behind}", source.fmu, all.join(", "))
}

/// `right decision against damper knee in the strut: 99.5 % (d' = 5.2, records 1.0)`.
pub fn chance(findings: &Findings, pair: &Distinction) -> String {
    let [expected, recorded] = [pair.distance, pair.recorded].map(|it| digits(it, 2));
    let rival = effect_name(findings, &pair.rival);
    format!(
        "right decision against {rival}: {} (d' = {expected}, records {recorded})",
        percent(pair.probability)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::{Setting, Value};

    fn pair(rival: &str, decides: bool) -> Distinction {
        Distinction {
            effect: "01 strut".into(),
            rival: rival.into(),
            distance: 5.2,
            probability: 0.995,
            excess: 0.1,
            decides,
            recorded: 1.0,
        }
    }

    fn deciding(pairs: Vec<Distinction>) -> DecidingExperiment {
        let drive = Drive {
            input: "road.position".into(),
            unit: "m".into(),
            shape: "chirp".into(),
            amplitude: 0.00612,
            frequency: 0.3,
            last_frequency: Some(15.0),
            source: None,
        };
        let decides = pairs.iter().any(|it| it.decides);
        DecidingExperiment {
            decides,
            compared: 69,
            duration: 20.0,
            drives: vec![drive],
            pairs,
            ..Default::default()
        }
    }

    #[test]
    fn what_decides_is_said_and_what_does_not() {
        let mut findings = Findings::of_bad_data("rig", vec![], vec![], vec![]);
        findings.decide(deciding(vec![pair("05 strut", true), pair("06 strut", false)]));
        assert_eq!(
            findings.experiment.as_deref(),
            Some(
                "Drive road.position with a chirp of 0.00612 m from 0.3 to 15 Hz for 20 s, with all other inputs at rest \
                 (experiment.csv). It separates 01 strut from 05 strut, not from 06 strut."
            )
        );
        findings.decide(deciding(vec![pair("06 strut", false)]));
        let text = findings.experiment.unwrap();
        let start = "None of 69 excitations within the limits separates 01 strut from 06 strut. Wider limits";
        assert!(text.starts_with(start), "{text}");
    }

    #[test]
    fn a_source_has_its_settings_and_units() {
        let it = SourceFmu {
            fmu: "VoltageSource".into(),
            settings: vec![Setting { name: "shape".into(), choice: "Sine".into() }],
            parameters: vec![Value { name: "amplitude".into(), value: 123.4567, unit: "V".into() }],
            adapter: true,
        };
        assert_eq!(
            source(&it),
            "VoltageSource: shape = Sine, amplitude = 123.457 V, behind it a SignalAdapter with factor = 1"
        );
    }
}
