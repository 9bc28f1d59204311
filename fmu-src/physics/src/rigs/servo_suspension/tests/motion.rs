//! Motions over time, of the model in one and of rig and actuator apart.

use proptest::prelude::*;

use super::*;
use crate::testing::Bench;

fn bench(law: ValveLaw, start: &[(&str, f64)]) -> Bench<ServoSuspension> {
    let bench =
        Bench::published("KoniecznyServoSuspension").choose("actuator.law", Value::Integer(law as i32 + 1));
    start.iter().fold(bench, |bench, (name, value)| bench.start(name, *value)).initialized()
}

const STATES: [&str; 6] = [
    "body.position",
    "body.velocity",
    "wheel.position",
    "wheel.undamped_velocity",
    "pressure",
    "spool.position",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn left_alone_it_loses_energy_in_every_step(x in any_state(), index in 0..3_usize) {
        // The spool rests.
        let start: Vec<(&str, f64)> = STATES.into_iter().zip(x).take(5).chain([("solver.tolerance", 1e-10)]).collect();
        let mut suspension = bench(LAWS[index], &start);
        let p = parameters::<f64>(&[]);
        let mut before = energy(&p, STATES.map(|name| suspension.get(name)), 0.0);
        for _ in 0..1000 {
            suspension.step(1e-3);
            let after = energy(&p, STATES.map(|name| suspension.get(name)), 0.0);
            prop_assert!(after <= before * (1.0 + 1e-9), "{before} {after} at {}", suspension.time());
            before = after;
        }
    }
}

#[test]
fn small_motions_are_those_of_the_linear_law() {
    // The largest difference of the body's position, relative to its largest value.
    let difference = |size: f64| {
        let mut both =
            [ValveLaw::Nonlinear, ValveLaw::Linear].map(|law| bench(law, &[("solver.tolerance", 1e-9)]));
        let (mut largest, mut apart) = (0.0_f64, 0.0_f64);
        for k in 0..1500 {
            let t = f64::from(k) * 1e-3;
            let [a, b] = both.each_mut().map(|suspension| {
                suspension.set("voltage", size * 5.0 * (25.0 * t).sin());
                suspension.set("road.position", size * 0.02 * (9.0 * t).sin());
                suspension.step(1e-3);
                suspension.get("body.position")
            });
            (largest, apart) = (largest.max(b.abs()), apart.max((a - b).abs()));
        }
        apart / largest
    };
    let [coarse, fine, finest] = [0.1, 0.01, 0.001].map(difference);
    assert!(finest < 1e-3, "{finest}");
    // The difference of the laws is of second order.
    assert!(
        (coarse / fine / 10.0 - 1.0).abs() < 0.2 && (fine / finest / 10.0 - 1.0).abs() < 0.2,
        "{coarse} {fine} {finest}"
    );
}

#[test]
fn where_the_road_jumps_the_wheel_gets_the_impulse_of_the_tyres_damper() {
    let mut suspension = bench(ValveLaw::Nonlinear, &[("body.velocity", 0.1)]);
    (0..20).for_each(|_| suspension.step(1e-3));
    let kept = ["body.position", "body.velocity", "wheel.position", "pressure", "suspension.deflection"];
    let before = kept.map(|name| suspension.get(name));
    let velocity = suspension.get("wheel.velocity");
    suspension.set("road.position", 0.1);
    assert_eq!(kept.map(|name| suspension.get(name)), before);
    assert!((suspension.get("wheel.velocity") - velocity - 72.0 * 0.1 / 11.5).abs() < 1e-12);

    // It is the limit of a fast rise: 0.1 m in a nanosecond.
    let mut gradual = bench(ValveLaw::Nonlinear, &[("body.velocity", 0.1)]);
    (0..20).for_each(|_| gradual.step(1e-3));
    gradual.slope("road.position", 1e8);
    gradual.step(1e-9);
    for name in ["body.position", "body.velocity", "wheel.position", "wheel.velocity", "pressure"] {
        let (jump, rise) = (suspension.get(name), gradual.get(name));
        let scale = if name == "pressure" { 1e6 } else { 1.0 };
        assert!((jump - rise).abs() < 2e-5 * scale, "{name}: {jump} {rise}");
    }
}

/// The largest difference of the pressures, and the largest pressure, of the model in one and of rig and actuator
/// that exchange force and velocity every `step`.
fn apart_and_in_one(step: f64, law: ValveLaw, load: f64) -> (f64, f64) {
    let start = [("solver.tolerance", 1e-10)];
    let mut one = bench(law, &start);
    let mut rig =
        Bench::<QuarterCar>::published("KoniecznyQuarterCar").start("solver.tolerance", 1e-10).initialized();
    let actuator = Bench::<ServoHydraulicActuator>::published("KoniecznyServoHydraulicActuator");
    let actuator = actuator.choose("law", Value::Integer(law as i32 + 1)).start("solver.tolerance", 1e-10);
    let mut actuator = actuator.start("load.mass", load).start("load.interval", step).initialized();
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for k in 0..(0.3 / step).round() as u32 {
        let t = f64::from(k) * step;
        let (voltage, omega) = (3.0 * (60.0 * t).sin(), 30.0);
        let (w, rate) = (5e-3 * (1.0 - (omega * t).cos()), 5e-3 * omega * (omega * t).sin());
        one.set("voltage", voltage);
        one.set("road.position", w);
        actuator.set("voltage", voltage);
        rig.set("road.position", w);
        rig.set("road.velocity", rate);
        let (force, velocity) = (actuator.get("force"), rig.get("suspension.velocity"));
        rig.set("actuator.force", force);
        actuator.set("suspension.velocity", velocity);
        one.step(step);
        rig.step(step);
        actuator.step(step);
        let pressure = one.get("pressure");
        (apart, largest) =
            (apart.max((actuator.get("pressure") - pressure).abs()), largest.max(pressure.abs()));
    }
    (apart, largest)
}

#[test]
fn rig_and_actuator_apart_come_to_the_same_with_small_steps() {
    for law in [ValveLaw::Nonlinear, ValveLaw::Linear] {
        let (coarse, _) = apart_and_in_one(1e-4, law, 0.0);
        let (fine, largest) = apart_and_in_one(0.5e-4, law, 0.0);
        let (finest, _) = apart_and_in_one(0.25e-4, law, 0.0);
        assert!(fine < 0.02 * largest, "{law:?}: {fine} of {largest}");
        // Of first order in the step, as an exchange of held values is.
        assert!(
            (coarse / fine - 2.0).abs() < 0.4 && (fine / finest - 2.0).abs() < 0.3,
            "{coarse} {fine} {finest}"
        );
    }
}

#[test]
fn held_for_a_millisecond_the_exchange_does_not_converge() {
    // The known hard case: the exchange of one step has a spectral radius of 1.49 for held values at 1 ms.
    let (apart, largest) = apart_and_in_one(1e-3, ValveLaw::Linear, 0.0);
    assert!(apart > 10.0 * largest, "{apart} {largest}");
}

#[test]
fn held_for_a_millisecond_it_converges_where_the_actuator_knows_its_load() {
    let mass = 86.0 * 11.5 / (86.0 + 11.5);
    for law in [ValveLaw::Nonlinear, ValveLaw::Linear] {
        let (coarse, largest) = apart_and_in_one(1e-3, law, mass);
        let (fine, _) = apart_and_in_one(0.5e-3, law, mass);
        // Of second order: the pressure is what differs most, the force that goes out by a tenth of it.
        assert!(coarse < 0.2 * largest && fine < 0.3 * coarse, "{law:?}: {coarse}, {fine} of {largest}");
    }
}
