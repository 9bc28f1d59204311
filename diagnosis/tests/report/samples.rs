//! Findings of every verdict, with curves as a rig gives them.

mod parts;

use std::sync::LazyLock;

use strut_diagnosis::data::check::DataProblem;
use strut_diagnosis::report::findings::{
    Curve, Disagreement, Evidence, FORMAT, Findings, Pictures, RecordValue, Signal, Verdict,
};

use super::simulation::{self, Comparison, balances, binned, comparisons, missing};
use parts::{account, base, candidates, deciding, friction, parameter, unmodelled};

pub const VERDICTS: [Verdict; 9] = [
    Verdict::NoEffect,
    Verdict::ParameterMismatch,
    Verdict::Identified,
    Verdict::Ambiguous,
    Verdict::Unmodelled,
    Verdict::SensorFault,
    Verdict::ModelInadequate,
    Verdict::OutOfTime,
    Verdict::BadData,
];

/// Findings without anything in them.
pub fn empty(verdict: Verdict) -> Findings {
    Findings {
        format: FORMAT,
        rig: String::new(),
        train: vec![],
        test: vec![],
        verdict,
        summary: String::new(),
        unfinished: None,
        disagreements: vec![],
        effects: vec![],
        nominal_parameters: vec![],
        signals: vec![],
        initial_states: vec![],
        distortions: vec![],
        account: vec![],
        unmodelled: vec![],
        missing: None,
        experiment: None,
        deciding_experiment: None,
        data_problems: vec![],
        records: parts::records(),
        candidates: vec![],
        pictures: Pictures::default(),
        seconds: f64::NAN,
        provenance: None,
    }
}

fn accept(findings: &mut Findings, index: usize) {
    findings.candidates[index].outcome = "accepted".into();
    findings.candidates[index].fitted = true;
    findings.candidates[index].evidence = findings.effects.first().map(|effect| effect.evidence);
}

fn car() -> (Vec<Signal>, Pictures) {
    let comparisons = comparisons(60.0);
    let pictures = Pictures {
        traces: comparisons.iter().map(Comparison::trace).collect(),
        spectra: comparisons.iter().map(Comparison::spectrum).collect(),
        coherences: comparisons.iter().map(Comparison::coherence).collect(),
        periodograms: comparisons.iter().map(Comparison::periodogram).collect(),
        parity: balances(),
        scatters: vec![
            binned("strut velocity", "m/s", |run, index| run.speed[index]),
            binned("strut deflection", "m", |run, index| run.deflection[index]),
        ],
    };
    (comparisons.iter().map(Comparison::signal).collect(), pictures)
}

/// Findings of a verdict as a diagnosis of a rig would give them.
pub fn sample(verdict: Verdict) -> Findings {
    /// The same car for every verdict.
    static CAR: LazyLock<(Vec<Signal>, Pictures)> = LazyLock::new(car);
    let (signals, pictures) = CAR.clone();
    let mut findings = Findings {
        rig: "tum-quarter-vehicle".into(),
        train: vec!["multisine-1.csv".into(), "prbs-2.csv".into()],
        test: vec!["bumps.csv".into()],
        nominal_parameters: vec![
            base("strut.stiffness", "N/m", 11_000.0, 11_032.0, 85.0, false),
            base("strut.damping", "N.s/m", 600.0, 423.4, 9.0, true),
            base("body.mass", "kg", 94.4, 94.3, 0.4, false),
            base("tire.stiffness", "N/m", 110_000.0, 109_400.0, 1200.0, false),
        ],
        account: account(&signals, &[], 0.0),
        missing: Some(missing()),
        signals,
        candidates: candidates(),
        pictures,
        data_problems: vec![DataProblem {
            record: "prbs-2.csv".into(),
            signal: "suspension.deflection".into(),
            text: "values lie on a lattice of 12 µm: the quantisation is larger than the noise; use a finer range".into(),
            fatal: false,
        }],
        seconds: 41.7,
        ..empty(verdict)
    };
    match verdict {
        Verdict::NoEffect => {
            unchanged(&mut findings);
            findings.missing = None;
            findings.summary = "No effect beyond the model improves the fit.".into();
            findings.experiment =
                Some("To excite bump stops and lift-off, drive over a bump of 40 mm.".into());
        }
        Verdict::ParameterMismatch => {
            findings.nominal_parameters[0] = base("strut.stiffness", "N/m", 11_000.0, 12_850.0, 90.0, true);
            findings.summary =
                "Parameters: strut.stiffness is 12850 N/m instead of 11000; strut.damping is 423.4 N·s/m instead \
                of 600. No effect beyond these parameters improves the fit."
                    .into();
            for signal in &mut findings.signals {
                (signal.fit_fitted, signal.rms_fitted) = (signal.fit_after, signal.rms_after);
            }
            findings.account = account(&findings.signals, &[], 0.0);
        }
        Verdict::Identified => {
            let mut cogging = friction();
            cogging.id = "27".into();
            cogging.name = "cogging".into();
            cogging.element = "actuator".into();
            cogging.equation = "F_act += A sin(2 pi x / p + phi)".into();
            cogging.parameters = vec![parameter("actuator.cogging.amplitude", "N", 11.4, 9.9, 12.9)];
            cogging.evidence = Evidence {
                delta_bic: 312.0,
                estimation_t: 4.6,
                p_value: 0.0021,
                validation_t: 3.4,
                validation_p_value: 0.004,
                variance_explained: 0.062,
                fit_improvement: 0.12,
                residual_reduction: 0.35,
                background: true,
                expected: false,
            };
            findings.effects = vec![friction(), cogging];
            findings.summary =
                "Identified effects: Coulomb friction in the strut (strut.coulomb.force = 56.21 N); cogging in \
                the actuator (actuator.cogging.amplitude = 11.40 N). The fit of body.acceleration on the validation \
                data rises from 0.43 to 0.93."
                    .into();
            findings.account = account(
                &findings.signals,
                &[("Coulomb friction in the strut", 0.93), ("cogging in the actuator", 0.07)],
                0.0,
            );
            // Another excitation would be worse with these parameters.
            let wheel = &mut findings.account[1];
            (wheel.parameters, wheel.unexplained) = (wheel.parameters - 0.15, wheel.unexplained + 0.15);
            accept(&mut findings, 0);
            accept(&mut findings, 16);
        }
        Verdict::Ambiguous => {
            let mut effect = friction();
            effect.ambiguous_with = vec!["16 body_guide".into(), "02 strut".into()];
            findings.effects = vec![effect];
            findings.summary =
                "Identified effect: Coulomb friction in the strut (strut.coulomb.force = 56.21 N). These records cannot \
                tell Coulomb friction in the strut from guide friction in the body’s guide or Stribeck friction in the \
                strut."
                    .into();
            findings.account = account(&findings.signals, &[("Coulomb friction in the strut", 1.0)], 0.0);
            findings.decide(deciding());
        }
        Verdict::Unmodelled => {
            let x: Vec<f64> = (-20..=20).map(|index| f64::from(index) * 0.025).collect();
            let y: Vec<f64> =
                x.iter().map(|x| 60.0 * (x * 3.0).sin() + 25.0 * (9.0 * x).cos() - 25.0).collect();
            let width: Vec<f64> = x.iter().map(|x| 3.0 + 60.0 * x * x).collect();
            let curve = Curve {
                location: "strut".into(),
                quantity: "force".into(),
                variable: "strut velocity".into(),
                variable_unit: "m/s".into(),
                unit: "N".into(),
                low: y.iter().zip(&width).map(|(y, width)| y - width).collect(),
                high: y.iter().zip(&width).map(|(y, width)| y + width).collect(),
                x,
                y,
            };
            let mut vibration = unmodelled(None);
            (vibration.place, vibration.unit) = ("wheel.acceleration".into(), "m/s2".into());
            (vibration.depends_on, vibration.frequency) = (vec!["time".into()], Some(17.3));
            (vibration.share, vibration.validation_share, vibration.improvement) = (0.34, 0.12, 0.04);
            vibration.description =
                "a signal that is periodic in time, at 17.30 Hz in the measurement of wheel.acceleration"
                    .into();
            findings.unmodelled = vec![unmodelled(Some(curve)), vibration];
            for signal in &mut findings.signals {
                signal.rms_after = 0.6 * signal.rms_fitted;
                signal.fit_after = 1.0 - 0.6 * (1.0 - signal.fit_fitted);
                signal.fit_without_input_noise = signal.fit_after;
            }
            findings.account =
                account(&findings.signals, &[("unnamed force over velocity in the strut", 1.0)], 0.4);
            findings.missing.iter_mut().for_each(|it| it.equivalent_places = vec!["actuator.force".into()]);
            findings.summary = "37 % of wheel.acceleration is explained by no known effect on the validation data (37 × sensor \
                noise). Parts of 2 other signals are unexplained, too. The description covers 88 % of the missing \
                signal on the estimation data and 81 % on the validation data."
                .into();
            findings.experiment =
                Some("Take the strut to a dyno and sweep its velocity up to 0.5 m/s.".into());
        }
        Verdict::SensorFault => {
            let mut effect = friction();
            effect.id = "35".into();
            effect.element = "body.acceleration".into();
            effect.name = "limited bandwidth".into();
            effect.equation = "tau y' + y = body.acceleration".into();
            effect.parameters = vec![parameter("body.acceleration.lag", "s", 0.00412, 0.0039, 0.0043)];
            effect.ambiguous_with = vec!["36 body.acceleration".into()];
            effect.experiment = Some("Tap the body: a delay moves the impact, a lag rounds it.".into());
            findings.effects = vec![effect];
            findings.summary =
                "Identified effect: limited bandwidth at body.acceleration (body.acceleration.lag = 0.004120 s)."
                    .into();
            findings.account =
                account(&findings.signals, &[("limited bandwidth at body.acceleration", 1.0)], 0.0);
        }
        Verdict::ModelInadequate => {
            for signal in &mut findings.signals {
                (signal.fit_before, signal.fit_fitted, signal.fit_after) = (-0.4, 0.08, 0.08);
                signal.rms_after = signal.rms_fitted;
                signal.fit_without_input_noise = 0.08;
            }
            findings.account = account(&findings.signals, &[], 0.0);
            findings.summary =
                "92 % of wheel.acceleration is still unexplained on the validation data (62 × sensor \
                noise). Parts of 2 other signals are unexplained, too. The model predicts too little of the validation \
                data. Check the rig, the signal names, the units and the signs."
                .into();
        }
        Verdict::OutOfTime => {
            findings.unfinished = Some(
                "The time limit of 30 s was reached. The search for effects is not complete. There may be others.".into(),
            );
            let value = |record: &str, value: f64, half: f64| RecordValue {
                record: record.into(),
                value,
                low: value - half,
                high: value + half,
            };
            findings.disagreements = vec![Disagreement {
                name: "strut.damping".into(),
                unit: "N.s/m".into(),
                yardstick: None,
                records: [value("multisine-1.csv", 423.0, 9.0), value("prbs-2.csv", 522.0, 14.0)],
            }];
            findings.summary = "The time limit of 30 s was reached. The search for effects is not complete. There may be \
                others. The records disagree on strut.damping, in N·s/m: 423 (95 %: 414 … 432) in multisine-1.csv, 522 \
                (95 %: 508 … 536) in prbs-2.csv."
                .into();
        }
        Verdict::BadData => {
            findings =
                Findings { rig: findings.rig, train: findings.train, test: findings.test, ..empty(verdict) };
            findings.seconds = 0.31;
            findings.summary = "The data cannot be used.".into();
            let problem = |record: &str, signal: &str, text: &str, fatal| DataProblem {
                record: record.into(),
                signal: signal.into(),
                text: text.into(),
                fatal,
            };
            findings.data_problems = vec![
                problem(
                    "multisine-1.csv",
                    "time",
                    "goes back by 0.2 s at sample 4211; export the record again",
                    true,
                ),
                problem(
                    "prbs-2.csv",
                    "body.acceleration",
                    "stuck at 19.62 m/s² for 38 % of the record: saturated; use a larger range",
                    true,
                ),
                problem("bumps.csv", "wheel.acceleration", "12 samples missing between 3.1 and 3.2 s", false),
            ];
        }
    }
    findings
}

/// A model that was right from the start.
fn unchanged(findings: &mut Findings) {
    for signal in &mut findings.signals {
        let noise = signal.noise_floor;
        (signal.rms_before, signal.rms_fitted, signal.rms_after) = (1.06 * noise, 1.02 * noise, 1.02 * noise);
        (signal.fit_before, signal.fit_fitted, signal.fit_after) = (0.9894, 0.9898, 0.9898);
    }
    findings.account = account(&findings.signals, &[], 0.0);
    findings.nominal_parameters[1] = base("strut.damping", "N.s/m", 420.0, 423.4, 9.0, false);
    for trace in &mut findings.pictures.traces {
        trace.before.clone_from(&trace.after);
    }
    for spectrum in &mut findings.pictures.spectra {
        spectrum.before.clone_from(&spectrum.after);
    }
    for parity in &mut findings.pictures.parity {
        parity.before.clone_from(&parity.after);
        (parity.rms_before, parity.rms_fitted) = (parity.rms_after, parity.rms_after);
    }
    findings.pictures.scatters = vec![binned("strut velocity", "m/s", |run, index| run.speed[index])];
    for scatter in &mut findings.pictures.scatters {
        for (index, value) in scatter.rising.iter_mut().chain(&mut scatter.falling).enumerate() {
            *value = value.map(|_| 0.9 * simulation::noise(index));
        }
    }
}
