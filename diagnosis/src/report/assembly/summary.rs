//! The verdict in a few sentences, with the numbers that matter.

use crate::report::findings::{Effect, Findings, Signal, Verdict};
use crate::report::words::{digits, sized, value};

/// Errors that exceed a signal's noise by this factor are told as not explained …
const ABOVE_NOISE: f64 = 3.0;
/// … if they are more than this share of the signal.
const VISIBLE: f64 = 0.1;
/// Φ that the noise of the inputs costs, to be worth a word.
const NOISY: f64 = 0.1;

/// The summary of findings that are complete otherwise.
pub(super) fn of(findings: &Findings) -> String {
    let Findings { effects, unmodelled, .. } = findings;
    let text = match findings.verdict {
        Verdict::NoEffect => "No cause could be shown by these records.".to_owned(),
        Verdict::ParameterMismatch => "No cause beyond parameters could be shown.".to_owned(),
        Verdict::Identified | Verdict::Ambiguous => format!("The model lacks: {}.", list(effects)),
        Verdict::SensorFault => format!("The measurement is wrong, not the plant: {}.", list(effects)),
        Verdict::Unmodelled if effects.is_empty() => String::new(),
        Verdict::Unmodelled => format!("Beside it: {}.", list(effects)),
        Verdict::ModelInadequate => {
            "The model explains too little of the held-out data, and nothing that was looked for explains the rest: \
             check the rig, the signals' names, units and signs. If they are right, something acts that is not in the \
             catalogue."
                .to_owned()
        }
        Verdict::BadData => "The data cannot be used.".to_owned(),
    };
    let more = unmodelled.iter().skip(usize::from(findings.verdict == Verdict::Unmodelled));
    let more: Vec<String> = more.map(|it| format!("Also missing: {}.", it.description)).collect();
    let curve = Some(more.join(" "));
    let sentences =
        [parameters(findings), Some(text), curve, gained(findings), noisy(findings), left(findings)];
    sentences.into_iter().flatten().filter(|it| !it.is_empty()).collect::<Vec<_>>().join(" ")
}

fn list(effects: &[Effect]) -> String {
    let told = effects.iter().map(|effect| {
        let sized = sized(effect);
        match effect.ambiguous_with.as_slice() {
            [] => sized,
            rivals => format!("{sized}, which these records cannot tell from {}", rivals.join(", ")),
        }
    });
    told.collect::<Vec<_>>().join("; ")
}

fn parameters(findings: &Findings) -> Option<String> {
    let changed = findings.base_parameters.iter().filter(|it| it.mismatch);
    let changed: Vec<String> = changed
        .map(|it| {
            let (after, before) = (value(it.after, &it.unit), digits(it.before, 4));
            format!("{} is {after} instead of {before}", it.name)
        })
        .collect();
    (!changed.is_empty()).then(|| format!("Parameters: {}.", changed.join("; ")))
}

fn gained(findings: &Findings) -> Option<String> {
    let gain = |signal: &Signal| signal.phi_after - signal.phi_fitted;
    let most = findings.signals.iter().max_by(|a, b| gain(a).total_cmp(&gain(b)))?;
    let Signal { name, phi_fitted, phi_after, .. } = most;
    let text = format!("On held-out data Φ of {name} rises from {phi_fitted:.3} to {phi_after:.3}.");
    (gain(most) > 0.0).then_some(text)
}

/// Where the noise of what drives the model, as of the position that a velocity is derived from, hides how good it is.
fn noisy(findings: &Findings) -> Option<String> {
    let cost = |signal: &Signal| signal.phi_quiet - signal.phi_after;
    let most = findings.signals.iter().max_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    (cost(most) > NOISY && findings.verdict != Verdict::ModelInadequate).then(|| {
        format!(
            "The noise of the measured inputs costs much of it: without, Φ of {} is {:.3}.",
            most.name, most.phi_quiet
        )
    })
}

/// Where nothing is found although the errors are no noise, that is told, too.
fn left(findings: &Findings) -> Option<String> {
    if !matches!(findings.verdict, Verdict::NoEffect | Verdict::ParameterMismatch) {
        return None;
    }
    // What the inputs' noise brings is no lack of the model.
    let missed = |it: &Signal| (1.0 - it.phi_quiet).min(1.0 - it.phi_after);
    let error = |it: &Signal| it.rms_after * missed(it) / (1.0 - it.phi_after).max(f64::MIN_POSITIVE);
    let visible = |it: &&Signal| {
        error(it) > ABOVE_NOISE * it.noise_floor && missed(it) > VISIBLE && it.noise_floor > 0.0
    };
    let most = findings.signals.iter().filter(visible).max_by(|a, b| missed(a).total_cmp(&missed(b)))?;
    Some(format!(
        "Yet {:.0} % of {} is missed on held-out data, {:.0} times its noise: something is left that none of the \
         candidates explains well enough to be told.",
        100.0 * missed(most),
        most.name,
        error(most) / most.noise_floor
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(verdict: Verdict) -> Findings {
        Findings { verdict, ..Findings::of_bad_data("rig", vec![], vec![], vec![]) }
    }

    fn signal(phi_after: f64, noise_floor: f64) -> Signal {
        Signal {
            name: "body.acceleration".into(),
            unit: "m/s2".into(),
            phi_before: 0.1,
            phi_fitted: phi_after,
            phi_after,
            phi_quiet: phi_after,
            rms_before: 8.0,
            rms_fitted: 4.0,
            rms_after: 4.0,
            noise_floor,
            repeatability: None,
        }
    }

    #[test]
    fn errors_beyond_the_noise_are_told_where_nothing_is_found() {
        let of = |phi, floor| {
            of(&Findings { signals: vec![signal(phi, floor)], ..findings(Verdict::ParameterMismatch) })
        };
        let text = of(0.7, 1.0);
        assert!(text.contains("Yet 30 % of body.acceleration"), "{text}");
        assert!(text.contains("4 times its noise"), "{text}");
        // What is little beside the signal, or about as large as its noise, is not worth a word.
        assert!(!of(0.95, 1.0).contains("Yet") && !of(0.7, 2.0).contains("Yet"));
    }

    #[test]
    fn what_the_noise_of_the_inputs_brings_is_not_left_over() {
        let of = |phi_quiet| {
            let signals = vec![Signal { phi_quiet, ..signal(0.2, 0.1) }];
            of(&Findings { signals, ..findings(Verdict::NoEffect) })
        };
        let text = of(0.95);
        assert!(text.contains("without, Φ of body.acceleration is 0.950") && !text.contains("Yet"), "{text}");
        let text = of(0.6);
        assert!(text.contains("is 0.600") && text.contains("Yet 40 % of body.acceleration"), "{text}");
        assert!(text.contains("20 times its noise"), "{text}");
    }
}
