//! Dampers that a coil sets, by equations of this file: what is hidden is found, and nothing where the current does nothing.

use std::f64::consts::TAU;

use strut_diagnosis::catalogue::naming::name;
use strut_diagnosis::dataset::recorded::Dataset;
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::diagnosis::{Options, diagnose};
use strut_diagnosis::rig::Rig;
use strut_model::Value;

use crate::common::{noise, on_a_bench};

const STEP: f64 = 2.5e-3;
const COUNT: usize = 4000;
/// Sines of the motion, 7 mm in all.
const SINES: usize = 24;

/// Ten seconds on a bench by a force over deflection, velocity and the magnitude of the current, with noise of 0.5 N.
fn record(force: impl Fn(f64, f64, f64) -> f64, seed: u64) -> Dataset {
    let mut random = noise(seed);
    let sines: Vec<[f64; 3]> = (0..SINES)
        .map(|k| {
            let frequency = 0.4 * 1.14_f64.powi(k as i32) * (1.0 + 0.02 * random());
            [2.5e-3 / frequency.max(1.0), TAU * frequency, TAU * random()]
        })
        .collect();
    let phase = TAU * random();
    let at = |k: usize| {
        let t = k as f64 * STEP;
        let position: f64 = sines.iter().map(|[a, w, p]| a * (w * t + p).sin()).sum();
        let velocity: f64 = sines.iter().map(|[a, w, p]| a * w * (w * t + p).cos()).sum();
        let current = 0.9 + 0.5 * (TAU * 0.37 * t + phase).sin() + 0.3 * (TAU * 1.3 * t + 2.0 * phase).sin();
        (position, velocity, current)
    };
    let moved: Vec<(f64, f64, f64)> = (0..COUNT).map(at).collect();
    // The lower end is moved: a positive position compresses.
    let values = moved.iter().map(|(x, v, i)| force(*x, *v, *i) + 0.5 * random()).collect();
    let signal = |of: fn(&(f64, f64, f64)) -> f64| moved.iter().map(of).collect();
    let driven = [
        ("motion.position", signal(|it| it.0)),
        ("motion.velocity", signal(|it| it.1)),
        ("control.current", signal(|it| it.2)),
    ];
    on_a_bench(&rig(), (format!("{seed}"), STEP), &driven, (values, 0.5))
}

/// A bench whose damper is set by a current.
fn rig() -> Rig {
    let mut rig = Rig::published("element-dyno").unwrap();
    let setting = rig.plant.setting("controlled_by").unwrap();
    // Nothing, current, voltage.
    rig.choices[setting] = Value::Integer(2);
    rig
}

/// Names of what is found, and the amounts.
fn found(force: impl Fn(f64, f64, f64) -> f64) -> Vec<(String, f64)> {
    let records = Split::new(&[record(&force, 1)], vec![record(&force, 2)]);
    let rig = rig();
    let diagnosis = diagnose(&rig, &records, Options::default(), &|_| {}).unwrap();
    let fitted = &diagnosis.found.extended.point;
    let amount = |it: &str| fitted.parameters[rig.plant.parameter(it).unwrap()];
    let named = diagnosis.found.accepted.iter().map(|it| name(it.term, &rig.plant).id);
    named
        .map(|id| {
            let parameter = match &*id {
                "01" => "strut.coulomb.force",
                "32m" => "control.damping",
                "32n" => "control.yield_force",
                other => panic!("{other} was not hidden"),
            };
            (id.to_string(), amount(parameter))
        })
        .collect()
}

#[test]
fn damping_that_a_current_sets_is_found_beside_friction() {
    let said = found(|x, v, i| 6000.0 * x + (900.0 + 700.0 * i) * v + 35.0 * (v / 0.005).tanh());
    let mut named: Vec<&str> = said.iter().map(|it| &*it.0).collect();
    named.sort_unstable();
    assert_eq!(named, ["01", "32m"]);
    for (id, amount) in said {
        let truth = if id == "01" { 35.0 } else { 700.0 };
        assert!((amount / truth - 1.0).abs() < 0.05, "{id}: {amount}");
    }
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_yield_force_that_a_current_sets_is_found() {
    let said = found(|x, v, i| 6000.0 * x + 900.0 * v + (60.0 + 200.0 * i) * (v / 0.02).tanh());
    assert_eq!(said.len(), 1);
    assert_eq!(said[0].0, "32n");
    assert!((said[0].1 / 200.0 - 1.0).abs() < 0.05, "{said:?}");
}

#[test]
fn a_current_that_sets_nothing_has_no_name() {
    assert_eq!(found(|x, v, _| 6000.0 * x + 900.0 * v), []);
}
