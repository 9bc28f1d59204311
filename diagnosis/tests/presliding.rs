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
const STEP: f64 = 2e-3;
const SUBSTEPS: usize = 50;

/// Dahl's friction of a strut whose lower end is moved along a sine, with noise of 10 N.
fn record(rig: &Rig, hertz: f64, count: usize, seed: u64) -> Dataset {
    let mut random = noise(seed);
    let position = |t: f64| STROKE * (TAU * hertz * t).sin();
    let velocity = |t: f64| STROKE * TAU * hertz * (TAU * hertz * t).cos();
    let mut force = 0.0;
    let mut values = Vec::with_capacity(count);
    for k in 0..count {
        values.push(force + 10.0 * random());
        for step in 0..SUBSTEPS {
            let v = velocity(STEP * (k as f64 + (step as f64 + 0.5) / SUBSTEPS as f64));
            force += STEP / SUBSTEPS as f64 * STIFFNESS * v * (1.0 - v.signum() * force / FRICTION);
        }
    }
    let time = || (0..count).map(|k| STEP * k as f64);
    let driven = [
        ("motion.position", time().map(position).collect()),
        ("motion.velocity", time().map(velocity).collect()),
    ];
    on_a_bench(rig, (format!("{seed}"), STEP), &driven, (values, 10.0))
}

/// The nominal stiffness becomes 300 kN/m and the damping 160 kN s/m before anything is looked for, and they have to give way.
#[test]
fn friction_that_nominal_parameters_stand_for_is_found() {
    let rig = Rig::published("element-dyno").unwrap();
    let records = Split::new(&[record(&rig, 0.5, 4000, 1)], vec![record(&rig, 1.0, 3000, 2)]);
    let diagnosis = diagnose(&rig, &records, Options::default(), &|_| {}).unwrap();
    let named: Vec<String> =
        diagnosis.found.accepted.iter().map(|it| name(it.term, &rig.plant).short()).collect();
    assert_eq!(named, ["03 strut"]);
    let value = |name: &str| diagnosis.found.extended.point.parameters[rig.plant.parameter(name).unwrap()];
    for (name, there) in
        [("hysteresis.presliding.force", FRICTION), ("hysteresis.presliding.stiffness", STIFFNESS)]
    {
        assert!((value(name) / there - 1.0).abs() < 2e-3, "{name}: {}", value(name));
    }
    let [stiffness, damping] = ["strut.stiffness", "strut.damping"].map(value);
    assert!(stiffness < 200.0 && damping < 100.0, "{stiffness} {damping}");
}
