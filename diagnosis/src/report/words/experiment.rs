//! The experiment that separates rivals.

use super::{digits, effect_name, list, percent, trimmed, unit};
use crate::report::findings::{DecidingExperiment, Distinction, Drive, Findings, SourceFmu};

/// Digits of amplitudes and frequencies.
const DIGITS: usize = 3;
/// Digits of a number that is typed into a tool.
const TYPED: usize = 6;

/// What to do, or that nothing within the limits decides.
pub fn experiment(findings: &Findings, deciding: &DecidingExperiment) -> String {
    let of = |decides: bool| {
        let pairs = deciding.pairs.iter().filter(move |it| it.decides == decides);
        pairs.map(|it| pair(findings, it)).collect::<Vec<_>>()
    };
    if deciding.compared == 0 {
        return "No excitation could be simulated within the limits.".into();
    }
    let undecided = of(false);
    if !deciding.decides {
        return format!(
            "None of {} excitations within the limits decides between {}. Wider limits (--stroke, --force, --rate) or less \
             noise may.",
            deciding.compared,
            list(&undecided, "and between")
        );
    }
    let drives: Vec<String> = deciding.drives.iter().map(drive).collect();
    let mut text = format!(
        "Drive {} for {}, with all other inputs at rest. This decides between {}.",
        list(&drives, "and"),
        format_args!("{} s", trimmed(deciding.duration, DIGITS)),
        list(&of(true), "and between")
    );
    if !undecided.is_empty() {
        text += &format!(" It does not decide between {}.", list(&undecided, "and between"));
    }
    text
}

/// An effect and its rival.
pub fn pair(findings: &Findings, pair: &Distinction) -> String {
    format!("{} and {}", effect_name(findings, &pair.effect), effect_name(findings, &pair.rival))
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

/// `99.5 % right (d' = 5.2)`.
pub fn chance(pair: &Distinction) -> String {
    format!("{} (d' = {})", percent(pair.probability), digits(pair.distance, 2))
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
                "Drive road.position with a chirp of 0.00612 m from 0.3 to 15 Hz for 20 s, with all other inputs at rest. \
                 This decides between 01 strut and 05 strut. It does not decide between 01 strut and 06 strut."
            )
        );
        findings.decide(deciding(vec![pair("06 strut", false)]));
        let text = findings.experiment.unwrap();
        let start =
            "None of 69 excitations within the limits decides between 01 strut and 06 strut. Wider limits";
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
