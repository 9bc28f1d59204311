use super::*;
use crate::Plant;
use crate::friction::Limit;
use crate::rig::{Rig, start};

fn ajala() -> Pump {
    Rig::new(Plant::PumpDyno, &start(Plant::PumpDyno)).pump
}

fn held(torque: f64, duration: f64) -> Profile {
    Profile::new(duration, |_| torque)
}

fn last(motion: &Motion, name: &str) -> f64 {
    *motion.signals[name].last().unwrap()
}

#[test]
fn a_valve_is_straight_between_its_points_and_beyond() {
    let valve = ajala().valves[0];
    for (flow, drop) in [(0.0, 0.0), (3e-4, 1.6e5), (4.5e-4, 2.15e5), (1.2e-3, 4.5e5), (-1.75e-4, -0.55e5)] {
        assert!((valve.at(flow) - drop).abs() < 1e-6, "{} Pa at {flow} m³/s", valve.at(flow));
    }
}

#[test]
fn rest_stays_rest() {
    let motion = ajala().run(&Profile::still(), &Profile::still(), 1.0);
    for (name, rest) in [("force", 0.0), ("motor.speed", 0.0), ("pressure.compression", 3e6)] {
        assert!(motion.signals[name].iter().all(|value| *value == rest), "{name}");
    }
}

/// 2 N m · 2π/12 cm³ = 10.472 bar; the gas follows p V^κ, and its volumes add up.
#[test]
fn a_held_torque_is_carried_by_a_difference_of_pressure() {
    let motion = ajala().run(&Profile::still(), &held(2.0, 6.0), 6.0);
    let [one, other] = ["pressure.compression", "pressure.rebound"].map(|name| last(&motion, name));
    assert!((one - other - 1_047_197.55).abs() < 1.0, "{one} Pa, {other} Pa");
    let volume = |pressure: f64| (3e6 / pressure).powf(1.0 / 1.3);
    assert!((volume(one) + volume(other) - 2.0).abs() < 1e-9);
    let force = (one - 3e6) * 10.2e-4 - (other - 3e6) * 8.6e-4;
    assert!((last(&motion, "force") - force).abs() < 1e-3, "{} N for {force} N", last(&motion, "force"));
    // Gas that gets cold follows p V.
    let cooling = Pump { cooling: Some(2.0), ..ajala() };
    let motion = cooling.run(&Profile::still(), &held(2.0, 40.0), 40.0);
    let volumes: f64 =
        ["pressure.compression", "pressure.rebound"].map(|name| 3e6 / last(&motion, name)).iter().sum();
    assert!((volumes - 2.0).abs() < 1e-6, "{volumes}");
}

/// C_l T (2π/V_c)² = 2e-11 · 1.5 · 2.741557e11 rad/s.
#[test]
fn with_a_leak_the_motor_turns_at_a_held_torque() {
    let motion = Pump { leakage: 2e-11, ..ajala() }.run(&Profile::still(), &held(1.5, 8.0), 8.0);
    let speed = last(&motion, "motor.speed");
    assert!((speed - 8.224_67).abs() < 1e-4, "{speed} rad/s");
}

#[test]
fn what_leaks_is_driven_by_the_pressures_that_it_makes() {
    let pump = Pump { leakage: 5e-11, ..ajala() };
    let mut random = Random::new(4, "test");
    for _ in 0..1000 {
        let gas = [random.between(1e6, 6e6), random.between(1e6, 6e6)];
        let (speed, velocity) = (random.between(-2000.0, 2000.0), random.between(-2.0, 2.0));
        let pumped = pump.pumped(gas, speed, velocity);
        let [one, other] = pump.on_piston(gas, pump.gas_flows(pumped, velocity));
        let apart = pumped + 5e-11 * (one - other) - pump.moved(speed);
        assert!(apart.abs() < 1e-15, "{apart} m³/s at {gas:?}, {speed}, {velocity}");
    }
}

/// What motor and piston put in is in the gas and the rotor, or was lost in valves, leak and friction.
#[test]
fn the_energy_balance_closes() {
    let pump = Pump {
        leakage: 2e-11,
        contacts: vec![Contact { along: [1.0, 0.0], limit: Limit::Coulomb(0.2) }],
        ..ajala()
    };
    let velocity = Profile::new(3.0, |t| 0.3 * (TAU * 1.3 * t).sin());
    let torque = Profile::new(3.0, |t| 2.0 * (TAU * 0.7 * t).sin());
    let motion = pump.run(&velocity, &torque, 3.0);
    let at = |name: &str, k: usize| motion.signals[name][k];
    let stored = |k: usize| {
        let gas = |name: &str| {
            let pressure = at(name, k);
            pressure * 0.5e-3 * (3e6 / pressure).powf(1.0 / 1.3) / 0.3
        };
        0.5 * 3.3e-4 * at("motor.speed", k).powi(2) + gas("pressure.compression") + gas("pressure.rebound")
    };
    let powers = |k: usize| {
        let (gas, speed) = ([at("pressure.compression", k), at("pressure.rebound", k)], at("motor.speed", k));
        let velocity = at("suspension.velocity", k);
        let flows = pump.gas_flows(pump.pumped(gas, speed, velocity), velocity);
        let [one, other] = pump.on_piston(gas, flows);
        let throttled = pump.valves[0].at(flows[0]) * flows[0] + pump.valves[1].at(flows[1]) * flows[1];
        let lost = throttled + 2e-11 * (one - other).powi(2) + 0.2 * speed.abs();
        let put_in = at("motor.torque", k) * speed - (one * 10.2e-4 - other * 8.6e-4) * velocity;
        (put_in, lost)
    };
    let all: Vec<(f64, f64)> = (0..motion.command.len()).map(powers).collect();
    let sum = |of: fn(&(f64, f64)) -> f64| {
        all.windows(2).map(|pair| 0.5 * (of(&pair[0]) + of(&pair[1])) / RATE).sum::<f64>()
    };
    let (put_in, lost) = (sum(|it| it.0), sum(|it| it.1));
    let gained = stored(all.len() - 1) - stored(0);
    assert!(lost > 50.0, "{lost} J");
    assert!((put_in - lost - gained).abs() < 1e-3 * lost, "{put_in} J in, {lost} J lost, {gained} J stored");
}

#[test]
fn friction_holds_the_pump_up_to_its_torque() {
    // Slowly, so that it does not swing beyond the balance and stay there.
    let turned = |torque: f64| {
        let contacts = vec![Contact { along: [1.0, 0.0], limit: Limit::Coulomb(0.2) }];
        let rising = Profile::new(8.0, |t| torque * (t / 6.0).min(1.0));
        let motion = Pump { contacts, ..ajala() }.run(&Profile::still(), &rising, 8.0);
        let [one, other] = ["pressure.compression", "pressure.rebound"].map(|name| last(&motion, name));
        (motion.signals["motor.speed"].iter().fold(0.0_f64, |most, x| most.max(x.abs())), one - other)
    };
    assert!(turned(0.19).0 < 1e-12, "{} rad/s", turned(0.19).0);
    // Beyond the limit the pressures carry the rest: 0.8 N m · 2π/12 cm³.
    let (speed, pressure) = turned(1.0);
    assert!(speed > 1.0 && (pressure - 418_879.0).abs() < 1000.0, "{speed} rad/s, {pressure} Pa");
}

#[test]
fn a_late_and_strong_torque_does_the_same_later() {
    let torque = Profile::new(2.0, |t| (TAU * 3.0 * t).sin());
    let now = ajala().run(&Profile::still(), &torque.scaled(1.2), 2.0);
    let actuator = Actuator { delay: 7e-3, gain: 1.2, ..Actuator::default() };
    let later = Pump { actuator, ..ajala() }.run(&Profile::still(), &torque, 2.0);
    for k in 140..now.command.len() {
        let [now, later] = [&now.signals["motor.speed"][k - 140], &later.signals["motor.speed"][k]];
        assert!((now - later).abs() < 1e-6, "{now} rad/s, {later} rad/s");
    }
    assert_eq!(later.signals["motor.torque"], later.command);
    assert!((later.command[20_000] - torque.at(1.0).0).abs() < 1e-12);
}

/// Half of it at 0.05 m/s, against the motion.
#[test]
fn seals_resist_the_piston() {
    let pump = Pump { seals: Some((10.0, 0.05)), ..ajala() };
    for (velocity, resistance) in [(0.05, 5.0), (-0.05, -5.0), (0.45, 9.0)] {
        assert!(
            (ajala().force([3e6; 2], velocity) - pump.force([3e6; 2], velocity) - resistance).abs() < 1e-9
        );
    }
}
