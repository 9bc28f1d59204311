use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Settings};

use super::super::force_two_dof::{self, ForceTwoDof};
use super::*;
use crate::signals::Deflection;

fn starts<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    Bundle::from_fn(|i| declared[i].start)
}

fn now<'a, M: Model<Derived<f64> = NoVariables, State<f64> = NoVariables>>(
    input: &'a M::Input<f64>,
    parameters: &'a M::Parameters<f64>,
    memory: &'a M::Memory<f64>,
) -> Instant<'a, M, f64> {
    Instant { time: 0.0, state: &NoVariables, input, parameters, derived: &NoVariables, memory, tick: 0 }
}

/// What is measured.
fn input([force_reference, force, deflection, velocity, speed]: [f64; 5], pressure: [f64; 2]) -> Input<f64> {
    let [compression, rebound] = pressure;
    Input {
        force_reference,
        actuator: Pushing { force },
        suspension: Travel { deflection, velocity },
        motor: Speed { speed },
        pressure: Pressures { compression, rebound },
    }
}

/// Measurements, each within ± its size.
fn measurements(sizes: [f64; 5]) -> impl Strategy<Value = [f64; 5]> {
    prop::array::uniform5(-1.0..1.0_f64).prop_map(move |x| std::array::from_fn(|i| x[i] * sizes[i]))
}

#[test]
fn at_rest_the_schedule_is_that_of_the_linear_actuator() {
    let p: Parameters<f64> = starts();
    let at_rest = scheduled(&input([0.0; 5], [3e6; 2]), &p);
    let (ak, ar, per_volume) = (10.2e-4, 8.6e-4, 1.3 * 3e6 / 0.5e-3);
    for (found, expected) in [
        (at_rest.flow_damping, 8e8 * (ak + ar)),
        (at_rest.damping, 8e8 * (ak * ak + ar * ar)),
        (at_rest.flow_stiffness, per_volume * (ak + ar)),
        (at_rest.stiffness, per_volume * (ak * ak + ar * ar)),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
}

/// κ p/V is dp/dV times -1, along p V^κ = const.
#[test]
fn compressed_gas_is_stiffer() {
    let p: Parameters<f64> = starts();
    let pressure = |volume: f64| 3e6 * (0.5e-3 / volume).powf(1.3);
    let (volume, h) = (0.42e-3, 1e-9);
    let expected = (pressure(volume - h) - pressure(volume + h)) / (2.0 * h);
    let scheduled = scheduled(&input([0.0; 5], [pressure(volume), 3e6]), &p);
    let found = (scheduled.flow_stiffness - 1.3 * 3e6 / 0.5e-3 * 8.6e-4) / 10.2e-4;
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
}

#[test]
fn a_measured_pressure_of_nothing_is_no_harm() {
    let p: Parameters<f64> = starts();
    let memory = ForceTwoDofLpv { order: 2 }.tick(now(
        &input([300.0, 0.0, 0.0, 0.0, 0.0], [0.0, -1e5]),
        &p,
        &starts(),
    ));
    memory.for_each(|i, number| assert!(number.is_finite(), "{i}"));
}

proptest! {
    /// The flow that is asked for makes the wanted force in the model of eq. 15, 10 and 11.
    #[test]
    fn the_inverse_undoes_the_model(
        x in measurements([0.0, 0.0, 0.0, 1.0, 200.0]), k in 2e6..5e6_f64, r in 2e6..5e6_f64,
        memory in -500.0..500.0_f64, force in -2e3..2e3_f64, rate in -0.5..0.5_f64,
    ) {
        let scheduled = scheduled(&input(x, [k, r]), &starts());
        let (flow, next) = scheduled.inverse(memory, force, rate, 1e-3);
        let growth = scheduled.flow_stiffness * flow + scheduled.stiffness * rate;
        let gas = memory + 0.5e-3 * growth;
        let made = gas + scheduled.flow_damping * flow + scheduled.damping * rate;
        prop_assert!((made - force).abs() < 1e-8 * (1.0 + force.abs() + memory.abs()));
        prop_assert!((next - gas - 0.5e-3 * growth).abs() < 1e-8 * (1.0 + next.abs()));
    }

    /// With equal areas, gas at rest and flows within the first pieces of the tables, both controllers are one.
    #[test]
    fn near_rest_with_equal_areas_it_is_the_linear_controller(
        samples in prop::collection::vec(measurements([200.0, 200.0, 0.01, 0.01, 5.0]), 1..60),
    ) {
        let mut p: Parameters<f64> = starts();
        (p.piston.compression_area, p.piston.rebound_area) = (9.4e-4, 9.4e-4);
        let mut q: force_two_dof::Parameters<f64> = starts();
        let gear = TAU * q.piston.area / q.pump.displacement;
        q.plant.stiffness = 1.3 * 9.4e-4_f64.powi(2) * 3e6 * 4e3;
        q.plant.damping = 1.6e9 * 9.4e-4_f64.powi(2);
        q.force.proportional = p.force.proportional / gear;
        q.force.integral = p.force.integral / gear;
        q.velocity.proportional = p.speed.proportional * gear * gear;
        q.velocity.integral = p.speed.integral * gear * gear;
        let (scheduled, linear) = (ForceTwoDofLpv { order: 2 }, ForceTwoDof::prepare(&Options::starts(), None).unwrap());
        let (mut a, mut b) = (starts(), starts());
        for x in samples {
            a = scheduled.tick(now(&input(x, [3e6; 2]), &p, &a));
            let [force_reference, force, deflection, _, speed] = x;
            let seen = force_two_dof::Input {
                force_reference,
                actuator: Pushing { force },
                suspension: Deflection { deflection },
                motor: Speed { speed },
            };
            b = linear.tick(now(&seen, &q, &b));
            prop_assert!((a.motor.torque - b.motor.torque).abs() < 1e-5, "{} {}", a.motor.torque, b.motor.torque);
        }
    }

    #[test]
    fn the_torque_keeps_to_its_limit(
        samples in prop::collection::vec(measurements([1e4, 1e4, 0.1, 2.0, 300.0]), 1..40),
    ) {
        let (p, mut memory) = (starts(), starts());
        for x in samples {
            memory = ForceTwoDofLpv { order: 2 }.tick(now(&input(x, [3.4e6, 2.7e6]), &p, &memory));
            prop_assert!(memory.motor.torque.abs() <= 8.0 + 1e-12);
        }
    }
}

#[test]
fn a_valve_that_turns_is_refused() {
    let mut p: Parameters<f64> = starts();
    p.valve.compression.flow[3] = 1e-5;
    let error = ForceTwoDofLpv { order: 2 }.check(&p, &NoVariables).unwrap_err();
    assert!(error.contains("valve.compression.flow[5] = 0 must be larger"), "{error}");
}
