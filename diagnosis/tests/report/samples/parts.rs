//! Parts of sample findings.

use strut_diagnosis::report::findings::{
    AccountItem, Candidate, ColumnRead, Curve, DecidingExperiment, Distinction, Drive, Effect,
    EffectParameter, Evidence, ExperimentLimit, NominalParameter, RecordRead, Setting, Signal, SignalAccount,
    SourceFmu, Unmodelled, Value,
};

pub fn records() -> Vec<RecordRead> {
    let column = |signal: &str, column: &str, unit: &str, unit_assumed: bool| ColumnRead {
        signal: signal.into(),
        column: column.into(),
        unit: unit.into(),
        unit_assumed,
    };
    let read = |record: &str| RecordRead {
        record: record.into(),
        samples: 30_000,
        seconds: 29.999,
        rate: 1000.0,
        columns: vec![
            column("road.position", "Laser_road", "mm", false),
            column("suspension.deflection", "suspension.deflection", "m", true),
        ],
        unused: vec!["Temperature [degC]".into()],
        left_out: vec!["Remark: `Start` in line 2 is not a number: leave missing samples empty".into()],
        notes: vec![],
    };
    vec![read("monday.csv"), read("tuesday.csv")]
}

pub fn friction() -> Effect {
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
            estimation_t: 11.2,
            p_value: 3e-13,
            validation_t: 7.31,
            validation_p_value: 2e-9,
            variance_explained: 0.943,
            fit_improvement: 0.21,
            residual_reduction: 0.35,
            background: false,
            expected: false,
        },
        ambiguous_with: vec![],
        experiment: None,
    }
}

pub fn parameter(name: &str, unit: &str, value: f64, low: f64, high: f64) -> EffectParameter {
    EffectParameter {
        name: name.into(),
        value,
        unit: unit.into(),
        low,
        high,
        of_ratio: None,
        limit: None,
        reached: true,
    }
}

pub fn base(name: &str, unit: &str, before: f64, after: f64, half: f64, mismatch: bool) -> NominalParameter {
    let (name, unit) = (name.into(), unit.into());
    let (low, high) = (after - half, after + half);
    NominalParameter { name, unit, before, after, low, high, mismatch, ..NominalParameter::default() }
}

pub fn candidates() -> Vec<Candidate> {
    let rows = [
        ("01", "strut", "Coulomb friction", 0.91, 0.88),
        ("02", "strut", "Stribeck friction", 0.92, 0.86),
        ("03", "strut", "presliding friction", 0.90, 0.84),
        ("04", "strut", "damper asymmetry", 0.12, 0.08),
        ("05", "strut", "damper knee", 0.31, 0.22),
        ("06", "strut", "orifice damping", 0.28, -0.31),
        ("07", "strut", "Maxwell branch", 0.09, 0.05),
        ("08", "strut", "nonlinear spring", 0.04, 0.01),
        ("09", "strut", "bump stop", 0.0, f64::NAN),
        ("12", "strut", "bush backlash", 0.03, 0.01),
        ("16", "body_guide", "guide friction", 0.62, 0.55),
        ("17", "wheel_guide", "guide friction", 0.21, 0.12),
        ("19", "tire", "progressive tyre", 0.02, -0.01),
        ("20", "tire", "lift-off", 0.0, f64::NAN),
        ("23", "actuator", "delay", 0.05, 0.02),
        ("24", "actuator", "lag", 0.06, 0.03),
        ("27", "actuator", "cogging", 0.07, 0.06),
        ("34", "body.acceleration", "gain error", 0.02, 0.01),
        ("35", "body.acceleration", "bandwidth", 0.03, 0.01),
        ("36", "suspension.deflection", "time skew", 0.02, 0.0),
    ];
    let one = |(index, (id, element, name, share, validated)): (usize, (&str, &str, &str, f64, f64))| {
        let fitted = index < 5;
        let weak = Evidence {
            delta_bic: 12.0 - 9.0 * index as f64,
            estimation_t: 1.3,
            p_value: 1.0,
            validation_t: 0.4,
            validation_p_value: 1.0,
            variance_explained: 0.004,
            fit_improvement: 0.002,
            residual_reduction: 0.35,
            background: false,
            expected: false,
        };
        Candidate {
            id: id.into(),
            element: element.into(),
            name: name.into(),
            fitted,
            values: Vec::new(),
            evidence: fitted.then_some(weak),
            share,
            validation_share: validated,
            outcome: if fitted {
                "no improvement on the validation data (t = 0.4)"
            } else {
                "not fitted: its share of the missing signal is smaller"
            }
            .into(),
        }
    };
    rows.into_iter().enumerate().map(one).collect()
}

/// The account of each signal: parts of the fall to the fitted error, then of the fall to the final error.
pub fn account(signals: &[Signal], effects: &[(&str, f64)], unmodelled: f64) -> Vec<SignalAccount> {
    let of = |signal: &Signal| {
        let share = |rms: f64| (rms / signal.rms_before).powi(2);
        let (fitted, after) = (share(signal.rms_fitted), share(signal.rms_after));
        let noise = share(signal.noise_floor).min(after);
        let item =
            |(name, part): &(&str, f64)| AccountItem { name: (*name).into(), share: part * (fitted - after) };
        let rest = after - noise;
        SignalAccount {
            signal: signal.name.clone(),
            error: signal.rms_before,
            noise,
            parameters: 1.0 - fitted,
            effects: effects.iter().map(item).collect(),
            unmodelled: unmodelled * rest,
            unexplained: (1.0 - unmodelled) * rest,
            open: rest > 8.0 * noise && (1.0 - signal.fit_after) > 0.1,
        }
    };
    signals.iter().map(of).collect()
}

pub fn unmodelled(curve: Option<Curve>) -> Unmodelled {
    Unmodelled {
        place: "strut".into(),
        unit: "N".into(),
        depends_on: vec!["velocity".into(), "deflection".into()],
        share: 0.88,
        validation_share: 0.81,
        improvement: 0.21,
        frequency: None,
        band: None,
        description:
            "a signal that follows the velocity and the deflection at the strut (88 % of what is missing \
                      there)"
                .into(),
        curve,
    }
}

/// A chirp of the road that separates friction from that of a guide, and not from Stribeck's.
pub fn deciding() -> DecidingExperiment {
    let value = |name: &str, value: f64, unit: &str| Value { name: name.into(), value, unit: unit.into() };
    let source = SourceFmu {
        fmu: "Road".into(),
        settings: vec![Setting { name: "kind".into(), choice: "Chirp".into() }],
        parameters: vec![
            value("amplitude", 0.006_12, "m"),
            value("chirp.start_frequency", 0.3, "Hz"),
            value("chirp.end_frequency", 15.0, "Hz"),
            value("chirp.duration", 20.0, "s"),
        ],
        adapter: false,
    };
    let pair = |rival: &str, distance: f64, probability: f64, decides: bool| Distinction {
        effect: "01 strut".into(),
        rival: rival.into(),
        distance,
        probability,
        excess: 5e-4 * distance * distance,
        decides,
        recorded: 0.5,
    };
    DecidingExperiment {
        decides: true,
        compared: 69,
        duration: 20.0,
        drives: vec![Drive {
            input: "road.position".into(),
            unit: "m".into(),
            shape: "chirp".into(),
            amplitude: 0.006_12,
            frequency: 0.3,
            last_frequency: Some(15.0),
            source: Some(source),
        }],
        limits: vec![ExperimentLimit {
            signal: "suspension.deflection".into(),
            unit: "m".into(),
            limit: 0.0214,
            reached: Some(0.0192),
        }],
        pairs: vec![pair("16 body_guide", 8.21, 0.99998, true), pair("02 strut", 1.12, 0.712, false)],
        files: vec![("experiment.csv".into(), "time [s],road.position [m]\n".into())],
    }
}
