use proptest::prelude::*;
use strut_model::{Access, Interface, Simulation, Value};

use super::*;
use crate::testing::Bench;

fn actuator(law: ValveLaw, start: &[(&str, f64)]) -> Bench<ServoHydraulicActuator> {
    let bench =
        Bench::published("KoniecznyServoHydraulicActuator").choose("law", Value::Integer(law as i32 + 1));
    start.iter().fold(bench, |bench, (name, value)| bench.start(name, *value)).initialized()
}

const LAWS: [ValveLaw; 3] = [ValveLaw::Nonlinear, ValveLaw::Linear, ValveLaw::Regression];

#[test]
fn the_spool_answers_as_a_lag_of_2_32_milliseconds() {
    let mut bench = actuator(ValveLaw::Nonlinear, &[("voltage", 4.0)]);
    for _ in 0..20 {
        bench.step(1e-3);
        let time = bench.time();
        let exact = 0.1e-3 * (1.0 - (-time / 2.32e-3).exp());
        assert!((bench.get("spool.position") - exact).abs() < 1e-10, "{time}");
    }
}

#[test]
fn at_the_stop_a_higher_voltage_changes_nothing() {
    let mut bench = actuator(ValveLaw::Nonlinear, &[("voltage", 1000.0)]);
    (0..50).for_each(|_| bench.step(1e-3));
    assert!((bench.get("spool.position") - 0.5e-3).abs() < 1e-9);
}

#[test]
fn a_piston_that_moves_at_its_free_speed_has_no_load() {
    for law in [ValveLaw::Nonlinear, ValveLaw::Linear] {
        let mut bench =
            actuator(law, &[("voltage", 2.0), ("spool.position", 0.05e-3), ("suspension.velocity", 0.0)]);
        let speed = 2.0 * bench.get("velocity_gain");
        let mut bench =
            actuator(law, &[("voltage", 2.0), ("spool.position", 0.05e-3), ("suspension.velocity", speed)]);
        (0..100).for_each(|_| bench.step(1e-3));
        assert!(bench.get("pressure").abs() < 1e-3, "{law:?}");
        // All of the supply's power drives the flow through the valve: 336 W for a volt.
        assert!((bench.get("supply.power") / (2.0 * 336.2) - 1.0).abs() < 1e-3);
    }
}

#[test]
fn a_held_piston_stalls_just_below_the_supply_pressure() {
    let mut bench = actuator(ValveLaw::Nonlinear, &[("voltage", 2.0)]);
    (0..200).for_each(|_| bench.step(1e-3));
    let pressure = bench.get("pressure");
    // What still flows is the leakage, eq. 2.9 = eq. 2.7.
    let flow = 0.05e-3 * 15.708e-3 * 0.611 * ((12e6 - pressure) / 880.0).sqrt();
    assert!(pressure < 12e6 && (flow / (15e-12 * pressure) - 1.0).abs() < 1e-4, "{pressure}");
    assert!((bench.get("force") - 0.765_786e-3 * pressure).abs() < 1e-9);
}

#[test]
fn behind_a_hysteresis_the_opening_stays_where_it_was_until_the_spool_is_a_band_away() {
    // 50 µm and back to 36 µm, with 10 µm to either side of the opening: it stays at 40 µm, the spool of 1.6 V.
    let held = |hysteresis: f64, voltage: f64| {
        let mut bench = actuator(ValveLaw::Linear, &[("voltage", 2.0), ("spool.hysteresis", hysteresis)]);
        (0..50).for_each(|_| bench.step(1e-3));
        bench.set("voltage", voltage);
        (0..50).for_each(|_| bench.step(1e-3));
        bench.get("supply.flow")
    };
    let due = |voltage: f64| held(0.0, voltage);
    for (voltage, opened) in [(2.0, 1.6), (1.44, 1.6), (1.0, 1.4), (2.4, 2.0)] {
        let flow = held(10e-6, voltage);
        assert!((flow / due(opened) - 1.0).abs() < 1e-4, "{voltage} V: {flow}, not {}", due(opened));
    }
}

proptest! {
    #[test]
    fn what_goes_in_comes_out_is_stored_or_lost(
        pressure in -15e6..15e6_f64, position in -0.5e-3..0.5e-3_f64, velocity in -1.0..1.0_f64,
        voltage in -10.0..10.0_f64, index in 0..3_usize,
    ) {
        prop_assume!(LAWS[index] == ValveLaw::Nonlinear || pressure.abs() <= 12e6);
        let actuator = ServoHydraulicActuator { law: LAWS[index] };
        let declared = strut_model::Declarations::of::<Parameters<f64>>();
        let p: Parameters<f64> = strut_model::Bundle::from_fn(|i| declared[i].start);
        let derived = actuator.derive(&p);
        let (rates, output) = actuator.equations(Instant {
            time: 0.0,
            state: &State { pressure, spool: SpoolState { position, follower: 0.0 } },
            input: &Input { voltage, suspension: TravelRate { velocity } },
            parameters: &p,
            derived: &derived,
            memory: &strut_model::Bundle::from_fn(|_| 0.0),
            tick: 0,
        });
        let stored = pressure * rates.pressure / derived.coefficient;
        let lost = output.supply.power - output.force * velocity - stored;
        prop_assert!(lost >= 15e-12 * pressure * pressure * (1.0 - 1e-9) - 1e-6, "{lost}");
    }
}

proptest! {
    #[test]
    fn without_an_estimate_of_the_load_every_bit_is_the_cylinders(
        pressure in -15e6..15e6_f64, position in -0.5e-3..0.5e-3_f64, velocity in -1.0..1.0_f64,
        remembered in -1e3..1e3_f64, tick in 0..3_u64, index in 0..3_usize,
    ) {
        let actuator = ServoHydraulicActuator { law: LAWS[index] };
        let declared = strut_model::Declarations::of::<Parameters<f64>>();
        let p: Parameters<f64> = strut_model::Bundle::from_fn(|i| declared[i].start);
        let (cylinder, derived) = (p.cylinder(), actuator.derive(&p));
        prop_assert_eq!(ServoHydraulicActuator::period(&p), None);
        let (rates, output) = actuator.equations(Instant {
            time: 0.0,
            state: &State { pressure, spool: SpoolState { position, follower: 0.0 } },
            input: &Input { voltage: 0.0, suspension: TravelRate { velocity } },
            parameters: &p,
            derived: &derived,
            memory: &strut_model::Bundle::from_fn(|_| remembered),
            tick,
        });
        let flow = cylinder.flow(LAWS[index], &derived, position, pressure).load;
        let rate = cylinder.pressure_rate(&derived, flow, velocity, pressure);
        prop_assert_eq!(rates.pressure.to_bits(), rate.to_bits());
        prop_assert_eq!(output.force.to_bits(), cylinder.force(pressure).to_bits());
    }
}

/// An actuator that knows its load.
fn loaded(mass: f64, interval: f64) -> Bench<ServoHydraulicActuator> {
    Bench::published("KoniecznyServoHydraulicActuator")
        .choose("law", Value::Integer(ValveLaw::Linear as i32 + 1))
        .start("load.mass", mass)
        .start("load.interval", interval)
        .start("pressure", 1e6)
        .initialized()
}

/// Against a mass on the compressed oil: m v' = f, f' = -k v, without leakage f = f_0 cos(w t). What is put out at the
/// start is its mean over the interval, up to the error of the midpoint rule.
#[test]
fn what_a_loaded_actuator_puts_out_is_the_mean_force_to_come() {
    let (mass, interval) = (10.0, 0.2e-3);
    let mut bench = loaded(mass, interval);
    let angle = (bench.get("stiffness") / mass).sqrt() * interval;
    let mean = 1e6 * 0.765_786e-3 * angle.sin() / angle;
    // The leakage takes 6 % of the force in this time, half of that on average.
    let leakage = 0.5 * 15e-12 * bench.get("coefficient") * interval;
    assert!(
        (bench.get("force") / (mean * (1.0 - leakage)) - 1.0).abs() < 0.01,
        "{} {mean}",
        bench.get("force")
    );
}

/// The mass itself, held forces and velocities: it swings and comes to rest, in steps in which it would not without.
#[test]
fn with_its_load_known_a_held_exchange_converges() {
    for (interval, known) in [(1e-3, true), (2e-3, true), (5e-3, true), (1e-3, false)] {
        let (mass, count) = (10.0, (1.0_f64 / interval) as usize);
        let mut bench = loaded(if known { mass } else { 0.0 }, interval);
        let mut velocity = 0.0;
        let mut last = 0.0;
        for _ in 0..count {
            bench.set("suspension.velocity", velocity);
            velocity += interval * bench.get("force") / mass;
            bench.step(interval);
            last = bench.get("force");
        }
        assert_eq!(last.abs() < 1.0, known, "{interval}: {last}");
    }
}

#[test]
fn constants_of_the_cylinder_are_part_of_the_mean_force() {
    let actuator = ServoHydraulicActuator { law: ValveLaw::Linear };
    let declared = strut_model::Declarations::of::<Parameters<f64>>();
    let mut p: Parameters<f64> = strut_model::Bundle::from_fn(|i| declared[i].start);
    (p.load.mass, p.cylinder.preload, p.cylinder.flow_offset) = (10.0, 50.0, 2e-6);
    let (cylinder, derived) = (p.cylinder(), actuator.derive(&p));
    let now = Pressed { pressure: 1e6, flow: cylinder.flow(ValveLaw::Linear, &derived, 0.0, 1e6).load };
    let known = LoadMemory { velocity: 0.01, force: 0.0, acceleration: 0.3 };
    let force = p.load.force(&cylinder, &derived, now, &known, 0);
    // The midpoint rule as it is printed, with T = 1 ms, m = 10 kg and a closed valve.
    let pressure = (force + 50.0) / 0.765_786e-3;
    let velocity = 0.01 + 0.5e-3 * (force / 10.0 + 0.3);
    let flow = 2e-6 - 0.765_786e-3 * velocity - 15e-12 * pressure;
    assert!((1e6 + 0.5e-3 * derived.coefficient * flow - pressure).abs() < 1e-3, "{force} {pressure}");
}

#[test]
fn what_cannot_be_is_refused() {
    let interface = Interface::of::<ServoHydraulicActuator>(None, None).unwrap();
    for (name, value) in [
        ("supply.pressure", 17e6),
        ("fluid.density", 0.0),
        ("fluid.bulk_modulus", -1.0),
        ("cylinder.area", 0.0),
        ("cylinder.volume", 0.0),
        ("cylinder.leakage", -1e-12),
        ("valve.discharge_coefficient", 1.1),
        ("spool.time_constant", 0.0),
        ("spool.stroke", 0.0),
    ] {
        let mut simulation = Simulation::<ServoHydraulicActuator>::new(None, None).unwrap();
        let reference = interface.variable(name).unwrap().reference;
        let error = simulation.set_real(&[reference], &[value], Access::All).unwrap_err();
        assert!(matches!(error, strut_model::Error::OutOfBounds { .. }), "{name}: {error}");
    }
}
