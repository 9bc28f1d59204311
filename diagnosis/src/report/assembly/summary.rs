//! The verdict in a few sentences, with the numbers that matter.

#[cfg(test)]
mod tests;

use crate::decision::rules::FALL;
use crate::report::findings::{Candidate, Effect, Findings, RecordValue, Signal, Unmodelled, Verdict};
use crate::report::words::{
    LISTED, count, digits, effect_name, fit, interval, list, located, none_beyond, open_signals, percent,
    reservation, sized, small_rest, unit, value,
};

/// Fit that the noise of the inputs costs, to be worth a sentence.
const NOISY: f64 = 0.1;
/// Improvement of the fit that is worth a sentence.
const IMPROVED: f64 = 0.005;

/// The summary of findings that are complete otherwise.
pub(super) fn of(findings: &Findings) -> String {
    let parts = [
        findings.unfinished.clone(),
        open(findings),
        disagreements(findings),
        parameters(findings),
        scale(findings),
        contradictions(findings),
        twins(findings),
        effects(findings),
        unmodelled(findings),
        nearest(findings),
        improvement(findings),
        worse(findings),
        noisy(findings),
        small_rest(findings).map(|it| it.sentence()),
    ];
    parts.into_iter().flatten().filter(|it| !it.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The error that no known effect explains comes first, whatever was found.
fn open(findings: &Findings) -> Option<String> {
    let all = open_signals(findings);
    let first = all.first()?.sentence();
    Some(match all.len() - 1 {
        0 => first,
        1 => format!("{first} Part of {} is unexplained, too.", all[1].signal),
        more => format!("{first} Parts of {} are unexplained, too.", count(more, "other signal")),
    })
}

/// Records that want different parameters come before whatever was identified from them.
fn disagreements(findings: &Findings) -> Option<String> {
    let first = findings.disagreements.first()?;
    let wish = |it: &RecordValue| {
        let [value, low, high] = interval(it.value, it.low, it.high);
        format!("{value} (95 %: {low} … {high}) in {}", it.record)
    };
    let [low, high] = &first.records;
    let (low, high) = (wish(low), wish(high));
    let unit = unit(&first.unit);
    let of = if unit.is_empty() { String::new() } else { format!(", in {unit}") };
    let others: Vec<String> = findings.disagreements[1..].iter().map(|it| it.name.clone()).collect();
    let more = match others.len() {
        0 => String::new(),
        _ => format!(" They also disagree on {}.", list(&others, "and")),
    };
    let beside = first.yardstick.as_ref().map_or(String::new(), |it| format!(" for the same {it}"));
    Some(format!("The records disagree on {}{beside}{of}: {low}, {high}.{more}", first.name))
}

fn effects(findings: &Findings) -> Option<String> {
    let effects = &findings.effects;
    match findings.verdict {
        Verdict::NoEffect => Some(none_beyond(findings, "the model")),
        Verdict::ParameterMismatch => Some(none_beyond(findings, "these parameters")),
        Verdict::ModelInadequate => {
            // A sign that was found is told by itself.
            let turned = findings.nominal_parameters.iter().any(|it| it.name.ends_with(".sign"));
            let checks = if turned {
                "the signal names and the units"
            } else {
                "the signal names, the units and the signs"
            };
            Some(format!(
                "The model predicts too little of the validation data. No effect of the catalogue explains the rest. \
                 Check the rig, {checks}. If they are right, an effect outside the catalogue acts."
            ))
        }
        Verdict::OutOfTime => None,
        Verdict::BadData => Some("The data cannot be used.".to_owned()),
        Verdict::Identified | Verdict::Ambiguous | Verdict::SensorFault | Verdict::Unmodelled => {
            let sizes: Vec<String> = effects.iter().map(sized).collect();
            let noun = if effects.len() == 1 { "Identified effect" } else { "Identified effects" };
            let rivals =
                effects.iter().filter(|it| !it.ambiguous_with.is_empty()).map(|it| rivals(findings, it));
            let sentences = [format!("{noun}: {}.", sizes.join("; "))].into_iter().chain(rivals);
            (!effects.is_empty()).then(|| sentences.collect::<Vec<_>>().join(" "))
        }
    }
}

fn rivals(findings: &Findings, effect: &Effect) -> String {
    let others: Vec<String> = effect.ambiguous_with.iter().map(|key| effect_name(findings, key)).collect();
    let own = located(&effect.name, &effect.element);
    format!("These records cannot tell {own} from {}.", list(&others, "or"))
}

/// What a headline on it does not say.
fn unmodelled(findings: &Findings) -> Option<String> {
    let first = findings.verdict == Verdict::Unmodelled;
    let of = |(index, it): (usize, &Unmodelled)| {
        if it.share == 0.0 {
            return (index > 0 || !first).then(|| format!("The rest is {}.", it.description));
        }
        let what = match index {
            0 if first => "The description".to_owned(),
            _ => format!("The model also lacks {}. This description", it.description),
        };
        Some(format!(
            "{what} covers {} of the missing signal on the estimation data and {} on the validation data.",
            percent(it.share),
            percent(it.validation_share)
        ))
    };
    let all: Vec<String> = findings.unmodelled.iter().enumerate().filter_map(of).collect();
    (!all.is_empty()).then(|| all.join(" "))
}

/// Where nothing is identified, the effect that comes nearest to it, and what it lacks.
fn nearest(findings: &Findings) -> Option<String> {
    let lacks = matches!(findings.verdict, Verdict::Unmodelled | Verdict::ModelInadequate);
    let shown = |it: &&Candidate| it.evidence.is_some_and(|evidence| evidence.is_nearest());
    let explained = |it: &Candidate| it.evidence.map_or(0.0, |evidence| evidence.variance_explained);
    let candidates =
        findings.candidates.iter().filter(|_| lacks && findings.effects.is_empty()).filter(shown);
    let nearest = candidates.max_by(|a, b| explained(a).total_cmp(&explained(b)))?;
    let size = nearest.values.first().map(|it| format!(" ({} = {})", it.name, value(it.value, &it.unit)));
    Some(format!(
        "The effect that comes nearest is {}{}: it would explain {} of the error power on the validation data. It is not \
         identified: {}.",
        located(&nearest.name, &nearest.element),
        size.unwrap_or_default(),
        percent(explained(nearest)),
        nearest.outcome
    ))
}

fn parameters(findings: &Findings) -> Option<String> {
    let changed = findings.nominal_parameters.iter().filter(|it| it.mismatch);
    let changed: Vec<String> = changed
        .map(|it| {
            let before = digits(it.before, 4);
            // At its lower bound a parameter has no value, only a limit.
            if it.after <= it.low && it.high > it.low && it.after >= 0.0 {
                return format!("{} is less than {} instead of {before}", it.name, value(it.high, &it.unit));
            }
            format!("{} is {} instead of {before}", it.name, value(it.after, &it.unit))
        })
        .collect();
    let reservation = reservation(findings).map_or(String::new(), |it| format!(" {it}"));
    (!changed.is_empty()).then(|| format!("Parameters: {}.{reservation}", changed.join("; ")))
}

/// That the data tell some nominal parameters only together.
fn scale(findings: &Findings) -> Option<String> {
    let held = findings.nominal_parameters.iter().find(|it| it.is_yardstick)?;
    Some(format!(
        "These records tell only ratios of masses, stiffnesses and dampings: {} keeps the {} of the parameter set, and all forces scale with \
         it. Record a force, or weigh a mass and give it (--known).",
        held.name,
        value(held.before, &held.unit)
    ))
}

/// A value that the user was sure of and that the data refuse: more likely it is wrong than all the data.
fn contradictions(findings: &Findings) -> Option<String> {
    let all: Vec<String> =
        findings.nominal_parameters.iter().filter(|it| it.contradicted).map(|it| it.name.clone()).collect();
    (!all.is_empty())
        .then(|| format!("The records contradict the given value of {}. Check it.", list(&all, "and")))
}

fn twins(findings: &Findings) -> Option<String> {
    let mut all: Vec<(&[String], Vec<String>)> = Vec::new();
    for it in findings.nominal_parameters.iter().filter(|it| !it.equivalent_effects.is_empty()) {
        // An absent parameter has an effect of its own in its place.
        let beside =
            all.iter_mut().find(|(effects, _)| it.before != 0.0 && *effects == it.equivalent_effects);
        match beside {
            Some((_, names)) => names.push(it.name.clone()),
            None => all.push((&it.equivalent_effects, vec![it.name.clone()])),
        }
    }
    let of = |(effects, names): (&[String], Vec<String>)| {
        let (these, together) = match names.len() {
            1..=LISTED => (list(&names, "and"), if names.len() > 1 { " together" } else { "" }),
            more => (format!("these {more} parameters"), " together"),
        };
        let remedy = if names.len() > 1 { " Measure one of them independently (--known)." } else { "" };
        format!("These records cannot tell {these}{together} from {}.{remedy}", list(effects, "or"))
    };
    (!all.is_empty()).then(|| all.into_iter().map(of).collect::<Vec<_>>().join(" "))
}

/// A signal that the final model meets less well than the starting model: the records want something else of it.
fn worse(findings: &Findings) -> Option<String> {
    // Noise of the measured inputs costs any model its fit.
    let fall = |signal: &Signal| signal.fit_before - signal.fit_after.max(signal.fit_without_input_noise);
    let worst = findings.signals.iter().max_by(|a, b| fall(a).total_cmp(&fall(b)))?;
    (worst.fit_before > 0.0 && fall(worst) > FALL).then(|| {
        format!(
            "The fit of {} on the validation data falls from {} to {}: what the estimation data ask for does not \
             hold there.",
            worst.name,
            fit(worst.fit_before, 2),
            fit(worst.fit_after, 2)
        )
    })
}

/// The fit of the signal that improves most; a fit below zero is no number to compare with.
fn improvement(findings: &Findings) -> Option<String> {
    let improvement = |signal: &Signal| signal.fit_after.max(0.0) - signal.fit_before.max(0.0);
    let known = findings.signals.iter().filter(|it| it.fit_before.is_finite() && it.fit_after.is_finite());
    let most = known.max_by(|a, b| improvement(a).total_cmp(&improvement(b)))?;
    let Signal { name, fit_before, fit_after, .. } = most;
    if *fit_before < 0.0 && *fit_after < IMPROVED {
        return (findings.verdict != Verdict::BadData).then(|| {
            format!("The starting model does not predict {name} at all (fit {}).", fit(*fit_before, 1))
        });
    }
    if improvement(most) < IMPROVED {
        return None;
    }
    let after = fit(*fit_after, 2);
    Some(match *fit_before < 0.0 {
        true => format!(
            "The starting model does not predict {name} at all (fit {}). The final model reaches a fit of {after} \
             on the validation data.",
            fit(*fit_before, 1)
        ),
        false => {
            // Nothing else than the parameters has changed.
            let start =
                if findings.verdict == Verdict::NoEffect { "With fitted parameters, the" } else { "The" };
            format!(
                "{start} fit of {name} on the validation data rises from {} to {after}.",
                fit(*fit_before, 2)
            )
        }
    })
}

/// The cost of noise in the measured inputs, such as a position from which a velocity is derived.
fn noisy(findings: &Findings) -> Option<String> {
    let cost = |signal: &Signal| signal.fit_without_input_noise - signal.fit_after;
    let most = findings.signals.iter().max_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    (cost(most) > NOISY && findings.verdict != Verdict::ModelInadequate).then(|| {
        format!(
            "Noise of the measured inputs lowers the fit. Without that noise, the fit of {} is {}.",
            most.name,
            fit(most.fit_without_input_noise, 2)
        )
    })
}
