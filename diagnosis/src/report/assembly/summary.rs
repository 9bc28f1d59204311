//! The verdict in a few sentences, with the numbers that matter.

use crate::decision::rules::FALL;
use crate::report::findings::{
    Candidate, Effect, Findings, NominalParameter, RecordValue, Signal, Unmodelled, Verdict,
};
use crate::report::words::{
    count, digits, effect_name, fit, interval, list, located, none_beyond, open_signals, percent,
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
        Verdict::ModelInadequate => Some(
            "The model predicts too little of the validation data. No effect of the catalogue explains the rest. \
             Check the rig, the signal names, the units and the signs. If they are right, an effect outside the \
             catalogue acts."
                .to_owned(),
        ),
        Verdict::OutOfTime => None,
        Verdict::BadData => Some("The data cannot be used.".to_owned()),
        Verdict::Identified | Verdict::Ambiguous | Verdict::SensorFault | Verdict::Unmodelled => {
            let sizes: Vec<String> = effects.iter().map(sized).collect();
            let noun = if effects.len() == 1 { "Identified effect" } else { "Identified effects" };
            let rivals = effects.iter().filter(|it| !it.ambiguous_with.is_empty()).map(|it| rivals(findings, it));
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
            return format!("The rest is {}.", it.description);
        }
        let what = match index {
            0 if first => "The description".to_owned(),
            _ => format!("The model also lacks {}. This description", it.description),
        };
        format!(
            "{what} covers {} of the missing signal on the estimation data and {} on the validation data.",
            percent(it.share),
            percent(it.validation_share)
        )
    };
    let all: Vec<String> = findings.unmodelled.iter().enumerate().map(of).collect();
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
            let (after, before) = (value(it.after, &it.unit), digits(it.before, 4));
            format!("{} is {after} instead of {before}", it.name)
        })
        .collect();
    let reservation = reservation(findings).map_or(String::new(), |it| format!(" {it}"));
    (!changed.is_empty()).then(|| format!("Parameters: {}.{reservation}", changed.join("; ")))
}

/// That the data tell some nominal parameters only together.
fn scale(findings: &Findings) -> Option<String> {
    let held = findings.nominal_parameters.iter().filter(|it| it.from_parameter_set);
    let held: Vec<String> = held.map(|it| it.name.clone()).collect();
    (held.len() > 1).then(|| {
        format!(
            "These records tell only the ratios of {}. Their common scale, and that of the effects, is the parameter set's. \
             Record a force, or weigh a mass and give it (--known).",
            list(&held, "and")
        )
    })
}

/// A value that the user was sure of and that the data refuse: more likely it is wrong than all the data.
fn contradictions(findings: &Findings) -> Option<String> {
    let all: Vec<String> =
        findings.nominal_parameters.iter().filter(|it| it.contradicted).map(|it| it.name.clone()).collect();
    (!all.is_empty())
        .then(|| format!("The records contradict the given value of {}. Check it.", list(&all, "and")))
}

fn twins(findings: &Findings) -> Option<String> {
    let of = |it: &NominalParameter| {
        format!("These records cannot tell {} from {}.", it.name, list(&it.equivalent_effects, "or"))
    };
    let all: Vec<String> =
        findings.nominal_parameters.iter().filter(|it| !it.equivalent_effects.is_empty()).map(of).collect();
    (!all.is_empty()).then(|| all.join(" "))
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
            format!("The fit of {name} on the validation data rises from {} to {after}.", fit(*fit_before, 2))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::findings::{Disagreement, Evidence, FittedValue, SignalAccount};

    fn findings(verdict: Verdict) -> Findings {
        Findings { verdict, ..Findings::of_bad_data("rig", vec![], vec![], vec![]) }
    }

    fn signal(fit_before: f64, fit_after: f64) -> Signal {
        Signal {
            name: "body.acceleration".into(),
            unit: "m/s2".into(),
            fit_before,
            fit_fitted: fit_after,
            fit_after,
            fit_without_input_noise: fit_after,
            rms_before: 8.0,
            rms_fitted: 4.0,
            rms_after: 4.0,
            noise_floor: 0.1,
            repeatability: None,
        }
    }

    fn open() -> SignalAccount {
        SignalAccount {
            signal: "body.acceleration".into(),
            error: 8.0,
            noise: 0.001,
            parameters: 0.2,
            effects: vec![],
            unmodelled: 0.0,
            unexplained: 0.4,
            open: true,
        }
    }

    #[test]
    fn an_open_signal_comes_first_whatever_was_identified() {
        let mut found = Findings { signals: vec![signal(0.1, 0.6)], ..findings(Verdict::Identified) };
        found.account = vec![open(), SignalAccount { signal: "wheel.acceleration".into(), ..open() }];
        let text = of(&found);
        let first =
            "40 % of body.acceleration is still unexplained on the validation data (20 × sensor noise).";
        assert!(text.starts_with(first), "{text}");
        assert!(text.contains("Part of wheel.acceleration is unexplained, too."), "{text}");
        // Below a tenth of the signal it comes last, and below the smallest improvement of interest not at all.
        found.account.iter_mut().for_each(|it| it.open = false);
        let with = |fit: f64| of(&Findings { signals: vec![signal(0.1, fit)], ..found.clone() });
        let last =
            "6.0 % of body.acceleration is still unexplained on the validation data (20 × sensor noise).";
        assert!(with(0.94).ends_with(last), "{}", with(0.94));
        assert!(!with(0.99).contains("unexplained"), "{}", with(0.99));
    }

    #[test]
    fn what_was_left_undone_comes_first_and_what_is_open_before_what_records_disagree_on() {
        let value = |record: &str, value: f64| RecordValue {
            record: record.into(),
            value,
            low: value - 10.0,
            high: value + 10.0,
        };
        let records = [value("a.csv", 700.0), value("b.csv", 900.0)];
        let of = |name: &str| Disagreement {
            name: name.into(),
            unit: "N.s/m".into(),
            yardstick: None,
            records: records.clone(),
        };
        let found = Findings {
            unfinished: Some("The time limit of 5 s was reached.".into()),
            disagreements: vec![of("strut.damping"), of("tire.damping")],
            account: vec![open()],
            signals: vec![signal(0.1, 0.6)],
            ..findings(Verdict::OutOfTime)
        };
        let text = self::of(&found);
        let first = "The time limit of 5 s was reached. 40 % of body.acceleration is still unexplained on the validation \
                     data (20 × sensor noise). The records disagree on strut.damping, in N·s/m: 700 (95 %: 690 \
                     … 710) in a.csv, 900 (95 %: 890 … 910) in b.csv. They also disagree on tire.damping.";
        assert!(text.starts_with(first), "{text}");
    }

    #[test]
    fn a_fit_below_zero_is_no_number_to_compare_with() {
        let of = |before, after| {
            of(&Findings { signals: vec![signal(before, after)], ..findings(Verdict::Identified) })
        };
        assert_eq!(
            of(-15.9, -0.57),
            "The starting model does not predict body.acceleration at all (fit −15.9)."
        );
        assert!(of(-15.9, 0.8).contains("(fit −15.9). The final model reaches a fit of 0.80"));
        assert!(of(0.3, 0.8).contains("rises from 0.30 to 0.80"));
        assert!(of(0.8, 0.8).is_empty());
    }

    #[test]
    fn a_signal_that_is_met_less_well_is_told() {
        let of = |before, after| {
            of(&Findings { signals: vec![signal(before, after)], ..findings(Verdict::ParameterMismatch) })
        };
        assert!(of(0.4, 0.2).contains("falls from 0.40 to 0.20"), "{}", of(0.4, 0.2));
        assert!(!of(0.4, 0.38).contains("falls") && !of(-3.0, -7.0).contains("falls"));
    }

    #[test]
    fn what_the_records_say_of_a_parameter_beyond_its_value_is_told() {
        let it = NominalParameter {
            name: "constant_load".into(),
            unit: "N".into(),
            before: 0.0,
            after: 15.0,
            low: 12.0,
            high: 18.0,
            mismatch: true,
            from_parameter_set: false,
            contradicted: true,
            equivalent_effects: vec!["guide friction in the guide".into()],
        };
        let text = of(&Findings { nominal_parameters: vec![it], ..findings(Verdict::ParameterMismatch) });
        assert!(text.contains("The records contradict the given value of constant_load."), "{text}");
        assert!(!text.contains("ratios"), "{text}");
        assert!(text.contains("cannot tell constant_load from guide friction in the guide."), "{text}");
    }

    #[test]
    fn an_effect_that_only_the_validation_data_show_is_the_nearest_one() {
        let shows = Evidence {
            delta_bic: 0.8,
            estimation_t: 2.0,
            p_value: 0.04,
            validation_t: 3.3,
            validation_p_value: 0.02,
            variance_explained: 0.38,
            fit_improvement: 0.05,
            residual_reduction: 0.3,
            ..Evidence::default()
        };
        let friction = Candidate {
            id: "16".into(),
            element: "guide".into(),
            name: "guide friction".into(),
            share: 0.1,
            validation_share: 0.2,
            fitted: true,
            values: vec![FittedValue { name: "guide.coulomb.force".into(), value: 480.0, unit: "N".into() }],
            evidence: Some(shows),
            outcome: "explains too little for its parameters (the BIC falls by 1 instead of 20)".into(),
        };
        let less = Candidate {
            evidence: Some(Evidence { validation_t: 2.0, variance_explained: 0.9, ..shows }),
            ..friction.clone()
        };
        let of =
            |verdict| of(&Findings { candidates: vec![less.clone(), friction.clone()], ..findings(verdict) });
        let wanted = "The effect that comes nearest is guide friction (guide.coulomb.force = 480.0 N): it would explain 38 % \
                      of the error power on the validation data. It is not identified: explains too little for its \
                      parameters (the BIC falls by 1 instead of 20).";
        assert_eq!(of(Verdict::Unmodelled), wanted);
        assert!(!of(Verdict::ParameterMismatch).contains("nearest"));
    }

    #[test]
    fn noise_of_the_inputs_is_no_lack_of_the_model() {
        let signals = vec![Signal { fit_without_input_noise: 0.95, ..signal(0.1, 0.2) }];
        let text = of(&Findings { signals, ..findings(Verdict::NoEffect) });
        assert!(text.contains("Without that noise, the fit of body.acceleration is 0.95."), "{text}");
    }

    #[test]
    fn a_signal_without_a_name_has_shares_of_both_data() {
        let it = Unmodelled {
            description: "a signal that follows the velocity at the strut".into(),
            share: 0.88,
            validation_share: 0.81,
            ..Unmodelled::default()
        };
        let text = of(&Findings { unmodelled: vec![it.clone(), it], ..findings(Verdict::Unmodelled) });
        assert!(text.starts_with("The description covers 88 % of the missing signal"), "{text}");
        assert!(text.contains("The model also lacks a signal that follows"), "{text}");
    }
}
