//! Reports with odd numbers.

use proptest::prelude::*;
use strut_diagnosis::report::findings::{Findings, Verdict};

use super::check;
use super::samples::sample;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        Just(0.0),
        Just(f64::MAX),
        Just(f64::MIN_POSITIVE),
        -10.0..10.0,
    ]
}

/// The findings with each of their numbers replaced.
fn with_numbers(mut findings: Findings, numbers: &[f64]) -> Findings {
    let mut cycle = numbers.iter().copied().cycle();
    let mut next = || cycle.next().unwrap_or_default();
    for effect in &mut findings.effects {
        for parameter in &mut effect.parameters {
            (parameter.value, parameter.low, parameter.high) = (next(), next(), next());
        }
        let evidence = &mut effect.evidence;
        (evidence.delta_bic, evidence.estimation_t, evidence.validation_t) = (next(), next(), next());
        (evidence.p_value, evidence.validation_p_value, evidence.variance_explained) =
            (next(), next(), next());
        (evidence.fit_improvement, evidence.residual_reduction) = (next(), next());
    }
    for parameter in &mut findings.nominal_parameters {
        (parameter.before, parameter.after, parameter.low, parameter.high) = (next(), next(), next(), next());
    }
    for signal in &mut findings.signals {
        (signal.fit_before, signal.fit_fitted, signal.fit_after) = (next(), next(), next());
        signal.fit_without_input_noise = next();
        (signal.rms_before, signal.rms_fitted, signal.rms_after) = (next(), next(), next());
        (signal.noise_floor, signal.repeatability) = (next(), Some(next()));
    }
    for candidate in &mut findings.candidates {
        (candidate.share, candidate.validation_share) = (next(), next());
    }
    for account in &mut findings.account {
        (account.error, account.noise, account.parameters) = (next(), next(), next());
        (account.unmodelled, account.unexplained) = (next(), next());
        account.open = account.noise > 0.0;
        account.effects.iter_mut().for_each(|item| item.share = next());
    }
    for it in &mut findings.unmodelled {
        (it.share, it.validation_share, it.improvement, it.frequency) =
            (next(), next(), next(), Some(next()));
    }
    let mut fill = |values: &mut Vec<f64>, count: usize| {
        values.clear();
        values.extend((0..count).map(|_| next()));
    };
    // Lists of unequal lengths must not panic either.
    if let Some(missing) = &mut findings.missing {
        let lists = [
            &mut missing.time,
            &mut missing.value,
            &mut missing.deviation,
            &mut missing.deflection,
            &mut missing.velocity,
        ];
        lists.into_iter().zip([90, 90, 80, 91, 3]).for_each(|(list, count)| fill(list, count));
        let mut likelihoods = Vec::new();
        fill(&mut likelihoods, missing.places.len());
        missing.places.iter_mut().zip(likelihoods).for_each(|(place, it)| place.log_likelihood = it);
    }
    for curve in findings.unmodelled.iter_mut().filter_map(|it| it.curve.as_mut()) {
        let lists = [&mut curve.x, &mut curve.y, &mut curve.low, &mut curve.high];
        lists.into_iter().zip([9, 9, 9, 4]).for_each(|(list, count)| fill(list, count));
    }
    for trace in &mut findings.pictures.traces {
        let lists = [&mut trace.time, &mut trace.measured, &mut trace.before, &mut trace.after];
        lists.into_iter().zip([30, 31, 30, 7]).for_each(|(list, count)| fill(list, count));
    }
    for spectrum in &mut findings.pictures.spectra {
        let lists =
            [&mut spectrum.frequency, &mut spectrum.measured, &mut spectrum.before, &mut spectrum.after];
        lists.into_iter().zip([20, 20, 3, 0]).for_each(|(list, count)| fill(list, count));
    }
    for trace in &mut findings.pictures.traces {
        for mark in &mut trace.marks {
            let mut ends = Vec::new();
            fill(&mut ends, 2);
            (mark.from, mark.to) = (ends[0], ends[1]);
        }
    }
    for coherence in &mut findings.pictures.coherences {
        fill(&mut coherence.frequency, 20);
        let mut list = Vec::new();
        fill(&mut list, 30);
        coherence.before = list[..20].iter().copied().map(Some).collect();
        coherence.after = list[20..].iter().copied().map(Some).collect();
        coherence.limit = list[0];
    }
    for periodogram in &mut findings.pictures.periodograms {
        let lists = [&mut periodogram.frequency, &mut periodogram.before, &mut periodogram.after];
        lists.into_iter().zip([20, 21, 9]).for_each(|(list, count)| fill(list, count));
        (periodogram.distance_before, periodogram.distance_after) =
            (periodogram.before[0], periodogram.after[0]);
        periodogram.limit = periodogram.before[1];
    }
    for parity in &mut findings.pictures.parity {
        let lists = [&mut parity.time, &mut parity.before, &mut parity.after];
        lists.into_iter().zip([20, 21, 9]).for_each(|(list, count)| fill(list, count));
        (parity.rms_before, parity.rms_fitted, parity.rms_after) =
            (parity.before[0], parity.before[1], parity.before[2]);
        (parity.noise, parity.band) = (parity.before[3], parity.before[4]);
    }
    for scatter in &mut findings.pictures.scatters {
        fill(&mut scatter.x, 31);
        let mut list = Vec::new();
        fill(&mut list, 93);
        scatter.rising = list[..31].iter().copied().map(Some).collect();
        scatter.falling = list[31..62].iter().copied().map(Some).collect();
        scatter.two_sigma = list[62..80].iter().copied().map(Some).collect();
    }
    findings.seconds = numbers.first().copied().unwrap_or_default();
    findings
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn no_number_breaks_a_report(numbers in prop::collection::vec(number(), 1..40)) {
        static SAMPLES: std::sync::LazyLock<[Findings; 2]> =
            std::sync::LazyLock::new(|| [sample(Verdict::Identified), sample(Verdict::Unmodelled)]);
        for findings in SAMPLES.iter() {
            let findings = with_numbers(findings.clone(), &numbers);
            check(&findings).map_err(TestCaseError::fail)?;
        }
    }
}
