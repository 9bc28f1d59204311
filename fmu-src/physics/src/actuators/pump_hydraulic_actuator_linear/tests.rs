use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Declarations, NoVariables};

use super::*;
use crate::actuators::PumpHydraulicActuator;

const ACTUATOR: PumpHydraulicActuatorLinear = PumpHydraulicActuatorLinear { locked: false };

fn starts<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    Bundle::from_fn(|i| declared[i].start)
}

/// Rates and outputs at speed and pressure difference, with torque and suspension velocity.
fn evaluate(p: &Parameters<f64>, x: [f64; 2], u: [f64; 2]) -> [f64; 3] {
    let (rates, output) = ACTUATOR.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &ACTUATOR.derive(p),
        memory: &NoVariables,
        tick: 0,
    });
    [rates.motor.speed, rates.pressure.difference, output.force]
}

#[test]
fn the_declared_actuator_is_a_mass_on_spring_and_damper() {
    let derived = ACTUATOR.derive(&starts());
    for (found, expected) in [
        (derived.mass, 79.94),
        (derived.stiffness, 13_784.0),
        (derived.damping, 1413.8),
        (derived.natural_frequency, 2.090),
        (derived.damping_ratio, 0.6734),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    }
}

/// The slopes of the nonlinear actuator's speed rate, pressure difference rate and force at rest, along a change
/// of [speed, both overpressures, torque, suspension velocity].
fn slopes(areas: f64, direction: [f64; 5]) -> [f64; 3] {
    use strut_model::Settings;
    type P<R> = <PumpHydraulicActuator as Model>::Parameters<R>;
    let mut p: P<f64> = starts();
    p.piston.ideal.compression_area = areas;
    p.piston.ideal.rebound_area = areas;
    // An unequal split of volumes: only the sum of p_0/V_0 counts in eq. 18.
    p.gas.rebound_volume = 0.4e-3;
    let mut numbers = Vec::new();
    Bundle::<f64>::for_each(&p, |_, number| numbers.push(number));
    let p: P<Dual64> = Bundle::from_fn(|i| numbers[i].into());
    let nonlinear =
        PumpHydraulicActuator::prepare(&<PumpHydraulicActuator as Model>::Settings::starts(), None).unwrap();
    let (rates, output) = nonlinear.equations(Instant {
        time: Dual64::from(0.0),
        state: &Bundle::from_fn(|i| Dual64::new(0.0, direction[i])),
        input: &Bundle::from_fn(|i| Dual64::new(0.0, direction[3 + i])),
        parameters: &p,
        derived: &nonlinear.derive(&p),
        memory: &NoVariables,
        tick: 0,
    });
    let difference = rates.overpressure.compression - rates.overpressure.rebound;
    [rates.motor.speed.eps, difference.eps, output.force.eps]
}

proptest! {
    /// Eq. 17 and 18 are the derivative of eq. 16 at rest.
    #[test]
    fn it_is_the_derivative_of_the_nonlinear_actuator(
        speed in -100.0..100.0_f64, compression in -1e6..1e6_f64, rebound in -1e6..1e6_f64,
        torque in -5.0..5.0_f64, velocity in -1.0..1.0_f64,
    ) {
        let mut p: Parameters<f64> = starts();
        p.gas.rebound_volume = 0.4e-3;
        let linear = evaluate(&p, [speed, compression - rebound], [torque, velocity]);
        let slopes = slopes(p.piston.area, [speed, compression, rebound, torque, velocity]);
        for (linear, slope) in linear.into_iter().zip(slopes) {
            prop_assert!((linear - slope).abs() < 1e-9 * (1.0 + slope.abs()), "{} {}", linear, slope);
        }
    }

    /// Eq. 24 to 26: the same motion, told by ways and forces.
    #[test]
    fn it_is_a_mass_on_a_spring_and_a_damper(
        speed in -100.0..100.0_f64, spring in -0.1..0.1_f64, torque in -5.0..5.0_f64, velocity in -1.0..1.0_f64,
    ) {
        let p: Parameters<f64> = starts();
        let Derived { mass, stiffness, damping, gear, .. } = ACTUATOR.derive(&p);
        // z_e - z_m is the way of the spring; A_0 Δp its force.
        let difference = stiffness * spring / p.piston.area;
        let [acceleration, rate, force] = evaluate(&p, [speed, difference], [torque, velocity]);
        let (mass_velocity, closing) = (-speed / gear, -velocity);
        let expected = damping * (closing - mass_velocity) + stiffness * spring;
        prop_assert!((force - expected).abs() < 1e-9 * (1.0 + expected.abs()));
        let mass_acceleration = -acceleration / gear;
        prop_assert!((mass * mass_acceleration - (force - gear * torque)).abs() < 1e-9 * (1.0 + force.abs()));
        let spring_rate = p.piston.area * rate / stiffness;
        prop_assert!((spring_rate - (closing - mass_velocity)).abs() < 1e-12);
    }

    /// Motor and piston give what spring and mass store and the damper takes.
    #[test]
    fn what_is_not_stored_is_lost(
        speed in -100.0..100.0_f64, spring in -0.1..0.1_f64, torque in -5.0..5.0_f64, velocity in -1.0..1.0_f64,
    ) {
        let p: Parameters<f64> = starts();
        let Derived { stiffness, damping, gear, .. } = ACTUATOR.derive(&p);
        let [acceleration, _, force] =
            evaluate(&p, [speed, stiffness * spring / p.piston.area], [torque, velocity]);
        let opening = -velocity + speed / gear;
        let stored = p.motor.inertia * speed * acceleration + stiffness * spring * opening;
        let given = torque * speed - force * velocity;
        let lost = damping * opening * opening;
        prop_assert!((given - stored - lost).abs() < 1e-8 * (1.0 + given.abs() + lost));
    }
}

#[test]
fn locked_it_is_a_spring_and_a_damper() {
    let locked = PumpHydraulicActuatorLinear { locked: true };
    let p: Parameters<f64> = starts();
    let (rates, output) = locked.equations(Instant {
        time: 0.0,
        state: &State { motor: Speed { speed: 0.0 }, pressure: Difference { difference: 2e5 } },
        input: &Bundle::from_fn(|i| [4.0, 0.3][i]),
        parameters: &p,
        derived: &locked.derive(&p),
        memory: &NoVariables,
        tick: 0,
    });
    let damping = ACTUATOR.derive(&p).damping;
    assert_eq!(rates.motor.speed, 0.0);
    assert!((output.force - (p.piston.area * 2e5 - damping * 0.3)).abs() < 1e-9);
}
