//! Friction that slides soon, in a strut that is stroked far, by equations of this file: a spring and a damper stand for it as well as
//! they can.

use std::f64::consts::TAU;

use strut_diagnosis::catalogue::naming::name;
use strut_diagnosis::dataset::recorded::Dataset;
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::diagnosis::{Options, diagnose};
use strut_diagnosis::rig::Rig;

use crate::common::{noise, on_a_bench};

/// In N.
const FRICTION: f64 = 11_000.0;
/// In N/m: it slides after two millimetres.
const STIFFNESS: f64 = 5e6;
/// In m.
const STROKE: f64 = 0.025;
const SUBSTEPS: usize = 50;

/// Dahl's friction of a strut whose lower end is moved along a sine a thousand samples for a period, with noise of 10 N. The machine
/// has run for some samples before.
fn record(rig: &Rig, hertz: f64, (before, count): (usize, usize), seed: u64) -> Dataset {
    let mut random = noise(seed);
    let step = 1e-3 / hertz;
    let position = |t: f64| STROKE * (TAU * hertz * t).sin();
    let velocity = |t: f64| STROKE * TAU * hertz * (TAU * hertz * t).cos();
    let mut force = 0.0;
    let mut values = Vec::with_capacity(count);
    for k in 0..before + count {
        values.push(force + 10.0 * random());
        for part in 0..SUBSTEPS {
            let v = velocity(step * (k as f64 + (part as f64 + 0.5) / SUBSTEPS as f64));
            force += step / SUBSTEPS as f64 * STIFFNESS * v * (1.0 - v.signum() * force / FRICTION);
        }
    }
    let time = || (before..before + count).map(|k| step * k as f64);
    let driven = [
        ("motion.position", time().map(position).collect()),
        ("motion.velocity", time().map(velocity).collect()),
    ];
    on_a_bench(rig, (format!("{seed}"), step), &driven, (values.split_off(before), 10.0))
}

/// What is found in records of a strut: the effects' names, and parameters' values.
fn found(records: [Dataset; 2]) -> (Vec<String>, impl Fn(&str) -> f64) {
    let rig = Rig::published("element-dyno").unwrap();
    let [train, test] = records;
    let records = Split::new(&[train], vec![test]);
    let diagnosis = diagnose(&rig, &records, Options::default(), &|_| {}).unwrap();
    let accepted = diagnosis.found.accepted.iter();
    let named = accepted.map(|it| name(it.term, &rig.plant).short()).collect();
    let parameters = diagnosis.found.extended.point.parameters.clone();
    let plant = rig.plant.clone();
    (named, move |name: &str| parameters[plant.parameter(name).unwrap()])
}

/// That nothing but the friction is found, in its size.
fn assert_is_dahl(named: &[String], value: &impl Fn(&str) -> f64) {
    assert_eq!(named, ["03 strut"]);
    for (name, there) in
        [("hysteresis.presliding.force", FRICTION), ("hysteresis.presliding.stiffness", STIFFNESS)]
    {
        assert!((value(name) / there - 1.0).abs() < 2e-3, "{name}: {}", value(name));
    }
}

/// The nominal stiffness becomes 300 kN/m and the damping 160 kN s/m before anything is looked for, and they have to give way.
#[test]
fn friction_that_nominal_parameters_stand_for_is_found() {
    let rig = Rig::published("element-dyno").unwrap();
    let (named, value) = found([record(&rig, 0.5, (0, 4000), 1), record(&rig, 1.0, (0, 3000), 2)]);
    assert_is_dahl(&named, &value);
    let [stiffness, damping] = ["strut.stiffness", "strut.damping"].map(value);
    assert!(stiffness < 200.0 && damping < 100.0, "{stiffness} {damping}");
}

/// The record is longer than a minute and begins where the friction slides: it has this force from the first sample to the first turn.
#[test]
fn a_slow_machine_s_friction_has_its_force_before_the_record_begins() {
    let rig = Rig::published("element-dyno").unwrap();
    let (named, value) = found([record(&rig, 0.02, (3450, 2600), 3), record(&rig, 0.04, (3550, 2600), 4)]);
    assert_is_dahl(&named, &value);
}
