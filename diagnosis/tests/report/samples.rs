//! Findings of every verdict, with curves as a rig gives them.

use std::sync::LazyLock;

use strut_diagnosis::report::findings::{
    BaseParameter, Candidate, Curve, DataProblem, Effect, EffectParameter, Evidence, FORMAT, Findings,
    Pictures, Signal, Verdict,
};

use crate::simulation::{self, Comparison, balances, binned, comparisons};

pub const VERDICTS: [Verdict; 8] = [
    Verdict::NoEffect,
    Verdict::ParameterMismatch,
    Verdict::Named,
    Verdict::Ambiguous,
    Verdict::Unnamed,
    Verdict::SensorFault,
    Verdict::ModelInadequate,
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
        effects: vec![],
        base_parameters: vec![],
        signals: vec![],
        starts: vec![],
        corrections: vec![],
        unnamed: None,
        nearest: Vec::new(),
        common: Vec::new(),
        experiment: None,
        data_problems: vec![],
        candidates: vec![],
        pictures: Pictures::default(),
        seconds: f64::NAN,
    }
}

fn friction() -> Effect {
    Effect {
        id: "01".into(),
        element: "strut".into(),
        name: "Coulomb friction".into(),
        equation: "F_strut += F_c tanh(v / v_0)".into(),
        parameters: vec![
            parameter("strut.coulomb.force", "N", 56.21, 54.8, 57.6),
            parameter("strut.coulomb.velocity", "m/s", 0.0079, 0.0071, 0.0088),
        ],
        evidence: Evidence {
            delta_bic: 18_240.0,
            block_t: 11.2,
            chance: 3e-13,
            held_out_t: 7.31,
            explained: 0.943,
            phi_gain: 0.21,
            taken: 0.35,
            usual: false,
            grave: false,
        },
        ambiguous_with: vec![],
        experiment: None,
    }
}

fn parameter(name: &str, unit: &str, value: f64, low: f64, high: f64) -> EffectParameter {
    EffectParameter { name: name.into(), value, unit: unit.into(), low, high }
}

fn base(name: &str, unit: &str, before: f64, after: f64, half: f64, mismatch: bool) -> BaseParameter {
    let (name, unit) = (name.into(), unit.into());
    BaseParameter { name, unit, before, after, low: after - half, high: after + half, mismatch }
}

fn candidates() -> Vec<Candidate> {
    let rows = [
        ("01", "strut", "Coulomb friction", 3.1, "N"),
        ("02", "strut", "Stribeck friction", 4.4, "N"),
        ("03", "strut", "presliding friction", 5.0, "N"),
        ("04", "strut", "damper asymmetry", 0.021, "1"),
        ("05", "strut", "damper knee", 0.06, "1"),
        ("06", "strut", "orifice damping", 42.0, "N.s2/m2"),
        ("07", "strut", "Maxwell branch", 900.0, "N/m"),
        ("08", "strut", "nonlinear spring", 2.1e4, "N/m2"),
        ("09", "strut", "bump stop", f64::NAN, "m"),
        ("12", "strut", "bush play", 8e-5, "m"),
        ("16", "body_guide", "guide friction", 2.4, "N"),
        ("17", "wheel_guide", "guide friction", 3.9, "N"),
        ("19", "tire", "progressive tyre", 1.2e5, "N/m2"),
        ("20", "tire", "lift-off", f64::NAN, "N"),
        ("23", "actuator", "delay", 4e-4, "s"),
        ("24", "actuator", "lag", 6e-4, "s"),
        ("27", "actuator", "cogging", 2.2, "N"),
        ("34", "body.acceleration", "gain error", 0.012, "1"),
        ("35", "body.acceleration", "bandwidth", 3e-4, "s"),
        ("36", "suspension.deflection", "time skew", 2e-4, "s"),
    ];
    let one = |(index, (id, element, name, size, unit)): (usize, (&str, &str, &str, f64, &str))| {
        let seen = size.is_finite();
        let fitted = index < 5;
        let weak = Evidence {
            delta_bic: 12.0 - 9.0 * index as f64,
            block_t: 1.3,
            chance: 1.0,
            held_out_t: 0.4,
            explained: 0.004,
            phi_gain: 0.002,
            taken: 0.35,
            usual: false,
            grave: false,
        };
        Candidate {
            id: id.into(),
            element: element.into(),
            name: name.into(),
            fitted,
            evidence: fitted.then_some(weak),
            detectable: seen.then_some(size),
            unit: unit.into(),
            outcome: if !seen {
                "not excited"
            } else if fitted {
                "no gain on held-out data"
            } else {
                "no gain"
            }
            .into(),
        }
    };
    rows.into_iter().enumerate().map(one).collect()
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
        base_parameters: vec![
            base("strut.stiffness", "N/m", 11_000.0, 11_032.0, 85.0, false),
            base("strut.damping", "N.s/m", 600.0, 423.4, 9.0, true),
            base("body.mass", "kg", 94.4, 94.3, 0.4, false),
            base("tire.stiffness", "N/m", 110_000.0, 109_400.0, 1200.0, false),
        ],
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
            findings.summary =
                "The errors on the held-out record are at the noise floor, and none of 20 candidates \
                gains anything on it."
                    .into();
            findings.experiment =
                Some("To judge bump stops and lift-off, drive over a bump of 40 mm.".into());
        }
        Verdict::ParameterMismatch => {
            findings.base_parameters[0] = base("strut.stiffness", "N/m", 11_000.0, 12_850.0, 90.0, true);
            findings.summary =
                "With two parameters fitted, the errors fall to the noise floor; no effect is needed.".into();
            for signal in &mut findings.signals {
                (signal.phi_fitted, signal.rms_fitted) = (signal.phi_after, signal.rms_after);
            }
        }
        Verdict::Named => {
            let mut cogging = friction();
            cogging.id = "27".into();
            cogging.name = "cogging".into();
            cogging.element = "actuator".into();
            cogging.equation = "F_act += A sin(2 pi x / p + phi)".into();
            cogging.parameters = vec![parameter("actuator.cogging.amplitude", "N", 11.4, 9.9, 12.9)];
            cogging.evidence = Evidence {
                delta_bic: 312.0,
                block_t: 4.6,
                chance: 0.0021,
                held_out_t: 3.4,
                explained: 0.062,
                phi_gain: 0.12,
                taken: 0.35,
                usual: true,
                grave: false,
            };
            findings.effects = vec![friction(), cogging];
            findings.summary =
                "A friction of 56 N in the strut explains 94 % of what the linear model gets wrong on \
                the bumps; cogging of the actuator explains most of the rest."
                    .into();
            accept(&mut findings, 0);
            accept(&mut findings, 16);
        }
        Verdict::Ambiguous => {
            let mut effect = friction();
            effect.ambiguous_with = vec!["16 body_guide".into(), "02 strut".into()];
            findings.effects = vec![effect];
            findings.summary =
                "Without the force cell, friction in the strut and in the guide look the same.".into();
            findings.experiment = Some(
                "Lock the wheel, drive the body slowly with a triangle of 5 mm/s and measure the strut's force: \
                 friction of the guide does not show there."
                    .into(),
            );
        }
        Verdict::Unnamed => {
            let x: Vec<f64> = (-20..=20).map(|index| f64::from(index) * 0.025).collect();
            let y: Vec<f64> =
                x.iter().map(|x| 60.0 * (x * 3.0).sin() + 25.0 * (9.0 * x).cos() - 25.0).collect();
            let width: Vec<f64> = x.iter().map(|x| 3.0 + 60.0 * x * x).collect();
            findings.unnamed = Some(Curve {
                location: "strut".into(),
                quantity: "force".into(),
                variable: "strut velocity".into(),
                variable_unit: "m/s".into(),
                unit: "N".into(),
                low: y.iter().zip(&width).map(|(y, width)| y - width).collect(),
                high: y.iter().zip(&width).map(|(y, width)| y + width).collect(),
                x,
                y,
            });
            findings.summary =
                "A force over the strut's velocity explains 88 % of the error, and no law of the \
                catalogue has its shape."
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
                "The kinematics of the three sensors contradict each other; the plant is not at fault."
                    .into();
        }
        Verdict::ModelInadequate => {
            for signal in &mut findings.signals {
                (signal.phi_before, signal.phi_fitted, signal.phi_after) = (-0.4, 0.08, 0.08);
                signal.rms_after = signal.rms_fitted;
            }
            findings.summary =
                "Even with fitted parameters the model explains 8 % of the body's acceleration. Check \
                signs, units and which column is which."
                    .into();
        }
        Verdict::BadData => {
            findings =
                Findings { rig: findings.rig, train: findings.train, test: findings.test, ..empty(verdict) };
            findings.seconds = 0.31;
            findings.summary = "Two of three records have faults that no diagnosis can work around.".into();
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
        (signal.phi_before, signal.phi_fitted, signal.phi_after) = (0.9894, 0.9898, 0.9898);
    }
    findings.base_parameters[1] = base("strut.damping", "N.s/m", 420.0, 423.4, 9.0, false);
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
