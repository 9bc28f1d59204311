use super::*;
use crate::report::findings::{Disagreement, Evidence, FittedValue, NominalParameter, SignalAccount};

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
    let first = "40 % of body.acceleration is still unexplained on the validation data (20 × sensor noise).";
    assert!(text.starts_with(first), "{text}");
    assert!(text.contains("Part of wheel.acceleration is unexplained, too."), "{text}");
    // Below a tenth of the signal it comes last, and below the smallest improvement of interest not at all.
    found.account.iter_mut().for_each(|it| it.open = false);
    let with = |fit: f64| of(&Findings { signals: vec![signal(0.1, fit)], ..found.clone() });
    let last = "6.0 % of body.acceleration is still unexplained on the validation data (20 × sensor noise).";
    assert!(with(0.94).ends_with(last), "{}", with(0.94));
    assert!(!with(0.99).contains("unexplained"), "{}", with(0.99));
}

#[test]
fn signs_are_to_be_checked_unless_one_was_found() {
    let mut found = Findings { signals: vec![signal(0.0, 0.1)], ..findings(Verdict::ModelInadequate) };
    assert!(
        of(&found).contains("Check the rig, the signal names, the units and the signs."),
        "{}",
        of(&found)
    );
    found
        .nominal_parameters
        .push(NominalParameter { name: "force.sign".into(), ..NominalParameter::default() });
    assert!(of(&found).contains("Check the rig, the signal names and the units."), "{}", of(&found));
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
    assert_eq!(of(-15.9, -0.57), "The starting model does not predict body.acceleration at all (fit −15.9).");
    assert!(of(-15.9, 0.8).contains("(fit −15.9). The final model reaches a fit of 0.80"));
    assert!(of(0.3, 0.8).contains("rises from 0.30 to 0.80"));
    assert!(of(0.8, 0.8).is_empty());
    // Where nothing is missing, it is the parameters that the fit rises with.
    let nothing = Findings { signals: vec![signal(0.3, 0.8)], ..findings(Verdict::NoEffect) };
    assert!(super::of(&nothing).contains("With fitted parameters, the fit of body.acceleration"));
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
        contradicted: true,
        equivalent_effects: vec!["guide friction in the guide".into()],
        ..NominalParameter::default()
    };
    let text = of(&Findings { nominal_parameters: vec![it], ..findings(Verdict::ParameterMismatch) });
    assert!(text.contains("The records contradict the given value of constant_load."), "{text}");
    assert!(!text.contains("ratios"), "{text}");
    assert!(text.contains("cannot tell constant_load from guide friction in the guide."), "{text}");
}

#[test]
fn what_does_the_same_as_several_parameters_is_told_once() {
    let named = |name: &str| NominalParameter {
        name: name.into(),
        before: 20.0,
        mismatch: true,
        equivalent_effects: vec!["gain of the actuator".into()],
        ..NominalParameter::default()
    };
    let nominal_parameters: Vec<NominalParameter> = ["a", "b", "c", "d"].into_iter().map(named).collect();
    let text = of(&Findings { nominal_parameters, ..findings(Verdict::ParameterMismatch) });
    assert!(
        text.contains("These records cannot tell these 4 parameters together from gain of the actuator."),
        "{text}"
    );
    assert_eq!(text.matches("cannot tell").count(), 1);
}

#[test]
fn a_parameter_at_its_lower_bound_has_a_limit_and_no_value() {
    let at = |after: f64| NominalParameter {
        name: "moving_mass".into(),
        unit: "kg".into(),
        before: 20.0,
        after,
        low: 1e-6,
        high: 0.36,
        mismatch: true,
        ..NominalParameter::default()
    };
    let text =
        |after| of(&Findings { nominal_parameters: vec![at(after)], ..findings(Verdict::ParameterMismatch) });
    assert!(text(1e-6).contains("moving_mass is less than 0.36"), "{}", text(1e-6));
    assert!(text(0.2).contains("moving_mass is 0.2") && !text(0.2).contains("less than"), "{}", text(0.2));
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

#[test]
fn a_rest_is_named_once() {
    let periodic =
        Unmodelled { description: "a signal that is periodic in time".into(), ..Unmodelled::default() };
    let small = Unmodelled { description: "a small one".into(), share: 0.12, ..Unmodelled::default() };
    let of = |verdict, all: [&Unmodelled; 2]| {
        of(&Findings { unmodelled: all.map(Clone::clone).to_vec(), ..findings(verdict) })
    };
    // The headline has the first.
    assert!(of(Verdict::Unmodelled, [&periodic, &small]).starts_with("The model also lacks a small one."));
    for (verdict, all) in
        [(Verdict::Unmodelled, [&small, &periodic]), (Verdict::Identified, [&periodic, &small])]
    {
        assert_eq!(of(verdict, all).matches("The rest is a signal that is periodic in time.").count(), 1);
    }
}
