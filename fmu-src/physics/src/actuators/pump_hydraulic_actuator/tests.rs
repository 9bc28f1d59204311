use proptest::prelude::*;
use strut_model::{Access, Bundle, Declarations, Interface, NoVariables, Simulation, Value};

use super::*;

pub fn parameters() -> Parameters<f64> {
    let declared = Declarations::of::<Parameters<f64>>();
    Bundle::from_fn(|i| declared[i].start)
}

/// Rates and outputs at speed and overpressures, with torque and suspension velocity.
fn evaluate(p: &Parameters<f64>, x: [f64; 3], u: [f64; 2]) -> (State<f64>, Output<f64>) {
    let model = PumpHydraulicActuator { locked: false };
    model.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &model.derive(p),
        memory: &NoVariables,
        tick: 0,
    })
}

#[test]
fn rest_is_an_equilibrium_with_the_static_force_of_the_rod() {
    let (rates, output) = evaluate(&parameters(), [0.0; 3], [0.0; 2]);
    rates.for_each(|_, rate| assert!(rate.abs() < 1e-9, "{rate}"));
    assert!(output.force.abs() < 1e-9);
    // (10.2 - 8.6) cm² times 30 bar.
    assert!((output.total_force - 480.0).abs() < 1e-9, "{}", output.total_force);
    assert_eq!((output.pressure.compression, output.chamber.rebound), (3e6, 3e6));
}

/// Eq. 16b as it is printed, with the rate of compression and resistances.
fn printed(p: &Parameters<f64>, x: [f64; 3], torque: f64, closing: f64) -> [f64; 4] {
    let [speed, pks, prs] = [x[0], x[1] + p.gas.charge_pressure, x[2] + p.gas.charge_pressure];
    let (ak, ar, kappa) = (p.piston.ideal.compression_area, p.piston.ideal.rebound_area, p.gas.exponent);
    let vc = p.pump.ideal.displacement / std::f64::consts::TAU;
    let volume = |rest: f64, pressure: f64| rest * (p.gas.charge_pressure / pressure).powf(1.0 / kappa);
    let ck = p.valve.compression.resistance(vc * speed + closing * ak);
    let cr = p.valve.rebound.resistance(-vc * speed - closing * ar);
    [
        (torque - vc * (pks - prs) - vc * vc * (ck + cr) * speed - vc * (ck * ak + cr * ar) * closing)
            / p.motor.inertia,
        kappa * (vc * speed + closing * ak) * pks / volume(p.gas.compression_volume, pks),
        -kappa * (vc * speed + closing * ar) * prs / volume(p.gas.rebound_volume, prs),
        ak * pks - ar * prs + vc * (ck * ak + cr * ar) * speed + (ck * ak * ak + cr * ar * ar) * closing,
    ]
}

/// Energy of the gas above that at rest: the integral of p q.
fn gas_energy(p: &Parameters<f64>, overpressure: f64, volume: f64) -> f64 {
    let (p0, kappa) = (p.gas.charge_pressure, p.gas.exponent);
    p0 * volume / (kappa - 1.0) * ((1.0 + overpressure / p0).powf((kappa - 1.0) / kappa) - 1.0)
}

fn stored(p: &Parameters<f64>, x: [f64; 3]) -> f64 {
    0.5 * p.motor.inertia * x[0] * x[0]
        + gas_energy(p, x[1], p.gas.compression_volume)
        + gas_energy(p, x[2], p.gas.rebound_volume)
}

/// States that a strong excitation reaches: 200 rad/s, 10 bar.
fn states() -> impl Strategy<Value = [f64; 3]> {
    (-200.0..200.0_f64, -1e6..1e6_f64, -1e6..1e6_f64).prop_map(|(speed, k, r)| [speed, k, r])
}

/// Every number's bits.
fn bits((rates, output): (State<f64>, Output<f64>)) -> Vec<u64> {
    let mut bits = Vec::new();
    rates.for_each(|_, number| bits.push(number.to_bits()));
    output.for_each(|_, number| bits.push(number.to_bits()));
    bits
}

proptest! {
    /// A pump without losses is computed another way than one with losses that are next to nothing.
    #[test]
    fn without_losses_none_are_left(x in states(), torque in -8.0..8.0_f64, velocity in -1.0..1.0_f64) {
        let mut p = parameters();
        let without = bits(evaluate(&p, x, [torque, velocity]));
        (p.pump.leakage, p.pump.coulomb.torque) = (f64::MIN_POSITIVE, f64::MIN_POSITIVE);
        prop_assert_eq!(bits(evaluate(&p, x, [torque, velocity])), without);
    }

    #[test]
    fn it_is_equation_16(x in states(), torque in -8.0..8.0_f64, velocity in -1.0..1.0_f64) {
        let p = parameters();
        let (rates, output) = evaluate(&p, x, [torque, velocity]);
        let expected = printed(&p, x, torque, -velocity);
        let found =
            [rates.motor.speed, rates.overpressure.compression, rates.overpressure.rebound, output.total_force];
        for (found, expected) in found.into_iter().zip(expected) {
            prop_assert!((found - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{} {}", found, expected);
        }
    }

    /// Up to ten times what the catalogue expects of a leak.
    #[test]
    fn power_goes_into_rotor_and_gas_or_is_lost_in_valves_leak_and_friction(
        x in states(), torque in -8.0..8.0_f64, velocity in -1.0..1.0_f64,
        leakage in 0.0..1e-10_f64, friction in 0.0..0.5_f64,
    ) {
        let mut p = parameters();
        (p.pump.leakage, p.pump.coulomb.torque) = (leakage, friction);
        let (rates, output) = evaluate(&p, x, [torque, velocity]);
        let rate = [rates.motor.speed, rates.overpressure.compression, rates.overpressure.rebound];
        let moved = |h: f64| -> [f64; 3] { std::array::from_fn(|i| x[i] + h * rate[i]) };
        let h = 1e-6;
        let growing = (stored(&p, moved(h)) - stored(&p, moved(-h))) / (2.0 * h);
        let pumped = p.pump.ideal.per_radian() * x[0];
        let (qk, qr) =
            (pumped - velocity * p.piston.ideal.compression_area, -pumped + velocity * p.piston.ideal.rebound_area);
        let (vk, vr) = (&p.valve.compression, &p.valve.rebound);
        let leak = leakage * (x[1] + vk.pressure_drop(qk) - x[2] - vr.pressure_drop(qr));
        let (qk, qr) = (qk - leak, qr + leak);
        let losses = [
            vk.pressure_drop(qk) * qk + vr.pressure_drop(qr) * qr,
            leak * (output.chamber.compression - output.chamber.rebound),
            friction * (x[0] / p.pump.coulomb.speed).tanh() * x[0],
        ];
        prop_assert!(losses.iter().all(|loss| *loss >= 0.0), "{:?}", losses);
        let lost: f64 = losses.iter().sum();
        let given = output.motor.power - output.total_force * velocity;
        prop_assert!((given - growing - lost).abs() < 1e-4 * (1.0 + growing.abs() + lost), "{}", given - growing);
    }
}

#[test]
fn a_leak_lets_the_pressures_meet() {
    // 2 bar above rest against 1 bar below: 3 ml/s, which cost 24 mbar in either valve.
    let mut p = parameters();
    p.pump.leakage = 1e-11;
    let (rates, output) = evaluate(&p, [0.0, 2e5, -1e5], [0.0; 2]);
    // 1.3 times 3 ml/s of 32 bar in 0.4758 l, and of 29 bar in 0.5132 l.
    assert!((rates.overpressure.compression + 26_230.5).abs() < 0.1, "{rates:?}");
    assert!((rates.overpressure.rebound - 22_037.7).abs() < 0.1, "{rates:?}");
    // 10.2 cm² times 1.976 bar and 8.6 cm² times 0.976 bar.
    assert!((output.force - 285.488).abs() < 1e-9, "{}", output.force);
}

#[test]
fn friction_holds_pump_and_motor_back() {
    // At the speed at which it turns over: 0.2 N.m tanh(1) on 3.3 kg.cm².
    let mut p = parameters();
    (p.pump.coulomb.torque, p.pump.coulomb.speed) = (0.2, 2.0);
    let without = evaluate(&parameters(), [2.0, 0.0, 0.0], [0.0; 2]);
    let with = evaluate(&p, [2.0, 0.0, 0.0], [0.0; 2]);
    let lost = without.0.motor.speed - with.0.motor.speed;
    assert!((lost - 0.2 * 0.761_594_155_956 / 3.3e-4).abs() < 1e-6, "{lost}");
    assert_eq!((with.0.overpressure, with.1), (without.0.overpressure, without.1));
}

#[test]
fn a_leak_that_would_feed_energy_in_is_refused() {
    let mut p = parameters();
    let model = PumpHydraulicActuator { locked: false };
    // Both valves have 8e8 Pa.s/m3 at most.
    p.pump.leakage = 0.9 / 1.6e9;
    assert_eq!(model.check(&p, &model.derive(&p)), Ok(()));
    p.pump.leakage = 1.1 / 1.6e9;
    assert!(model.check(&p, &model.derive(&p)).unwrap_err().starts_with("pump.leakage"));
}

#[test]
fn constants_act_where_their_equations_say() {
    let (x, u) = ([20.0, 2e5, -1e5], [1.5, 0.2]);
    let signals = |p: &Parameters<f64>| {
        let (rates, output) = evaluate(p, x, u);
        (rates, output.force, output.total_force)
    };
    let mut p = parameters();
    let neutral = signals(&p);
    p.pump.load = 0.033;
    // 0.033 N.m on 3.3e-4 kg.m2.
    let braked = signals(&p);
    assert!((braked.0.motor.speed - neutral.0.motor.speed + 100.0).abs() < 1e-9);
    assert_eq!((braked.0.overpressure, braked.1), (neutral.0.overpressure, neutral.1));

    let mut p = parameters();
    p.piston.preload = 10.0;
    let pulled = signals(&p);
    assert!((pulled.1 - neutral.1 + 10.0).abs() < 1e-9 && (pulled.2 - neutral.2 + 10.0).abs() < 1e-9);
    assert_eq!(pulled.0, neutral.0);

    // The pump's own flow at a speed of 1 rad/s does the same to everything but the power.
    let mut p = parameters();
    p.pump.flow_offset = 12e-6 / std::f64::consts::TAU;
    let (rates, force, _) = signals(&p);
    let (faster, output) = evaluate(&parameters(), [21.0, x[1], x[2]], u);
    assert!((force - output.force).abs() < 1e-9 && (force - neutral.1).abs() > 0.1);
    assert!((rates.overpressure.compression / faster.overpressure.compression - 1.0).abs() < 1e-12);
    assert!((rates.overpressure.rebound / faster.overpressure.rebound - 1.0).abs() < 1e-12);
    assert!((rates.motor.speed - faster.motor.speed).abs() < 1e-6);
}

/// With piston and pump held, only the leak moves oil: κ p_0 C_l (1/V_k + 1/V_r) is 0.156 1/s.
#[test]
fn the_force_of_a_held_piston_decays_by_the_leak() {
    let mut simulation = Simulation::<PumpHydraulicActuator>::new(None, None).unwrap();
    let interface = Interface::of::<PumpHydraulicActuator>(None, None).unwrap();
    let reference = |name: &str| interface.variable(name).unwrap().reference;
    simulation.set_setting(reference("pump.locked"), Value::Boolean(true), Access::All).unwrap();
    // So small a pressure that the gas is a spring.
    let started =
        [("pump.leakage", 1e-11), ("overpressure.compression", 100.0), ("overpressure.rebound", -100.0)];
    for (name, value) in started {
        simulation.set_real(&[reference(name)], &[value], Access::All).unwrap();
    }
    simulation.set_up(0.0, Some(1e-10)).unwrap();
    simulation.initialize().unwrap();
    let force = |simulation: &mut Simulation<PumpHydraulicActuator>| {
        let mut force = [0.0];
        simulation.real(&[reference("force")], &mut force).unwrap();
        force[0]
    };
    let before = force(&mut simulation);
    simulation.step(0.0, 5.0).unwrap();
    let left = force(&mut simulation) / before;
    assert!((left / (-0.78_f64).exp() - 1.0).abs() < 1e-3, "{left}");
}

fn simulation(locked: bool) -> (Simulation<PumpHydraulicActuator>, Interface) {
    let interface = Interface::of::<PumpHydraulicActuator>(None, None).unwrap();
    let mut simulation = Simulation::new(None, None).unwrap();
    let reference = interface.variable("pump.locked").unwrap().reference;
    simulation.set_setting(reference, Value::Boolean(locked), Access::All).unwrap();
    simulation.set_up(0.0, Some(1e-10)).unwrap();
    simulation.initialize().unwrap();
    (simulation, interface)
}

/// Drives the actuator round; the work that piston and motor have put in at the end of every step, and the speed.
/// Not that of the static force: at rest the gas is ready to push the piston out.
fn work_put_in(locked: bool, torque: impl Fn(f64) -> f64, seconds: f64) -> Vec<(f64, f64)> {
    let (mut simulation, interface) = simulation(locked);
    let reference = |name: &str| interface.variable(name).unwrap().reference;
    let inputs = [reference("motor.torque"), reference("suspension.velocity")];
    let outputs = [reference("force"), reference("motor.speed")];
    let (step, mut work, mut values, mut history) = (1e-4, 0.0, [0.0; 2], Vec::new());
    for k in 0..(seconds / step) as usize {
        let t = k as f64 * step;
        let velocity =
            0.4 * (std::f64::consts::TAU * 1.3 * t).sin() + 0.5 * (std::f64::consts::TAU * 11.0 * t).sin();
        simulation.set_real(&inputs, &[torque(t), velocity], Access::Continuous).unwrap();
        simulation.real(&outputs, &mut values).unwrap();
        let before = values;
        simulation.step(t, step).unwrap();
        simulation.real(&outputs, &mut values).unwrap();
        let mean = |i: usize| 0.5 * (before[i] + values[i]);
        work += (mean(1) * torque(t) - mean(0) * velocity) * step;
        history.push((work, mean(1)));
    }
    history
}

#[test]
fn locked_it_takes_energy_and_the_motor_gives_none() {
    // Whatever the motor tries. The gas may give back what it was given, never more than that.
    let history = work_put_in(true, |t| 5.0 * (3.0 * t).sin(), 4.0);
    assert!(history.iter().all(|(work, speed)| *work > -1e-2 && *speed == 0.0));
    let (end, _) = history.last().unwrap();
    assert!(*end > 100.0, "{end}");
}

#[test]
fn with_an_idle_motor_it_takes_energy_too() {
    let history = work_put_in(false, |_| 0.0, 4.0);
    assert!(history.iter().all(|(work, _)| *work > -1e-2));
    assert!(history.iter().any(|(_, speed)| speed.abs() > 50.0));
}

/// With the pump held and the piston moved slowly, the gas alone makes the force: eq. 1 to the letter.
#[test]
fn a_slow_stroke_of_the_locked_actuator_is_polytropic() {
    let (mut simulation, interface) = simulation(true);
    let reference = |name: &str| interface.variable(name).unwrap().reference;
    simulation.set_real(&[reference("suspension.velocity")], &[-0.05], Access::Continuous).unwrap();
    simulation.step(0.0, 1.0).unwrap();
    simulation.set_real(&[reference("suspension.velocity")], &[0.0], Access::Continuous).unwrap();
    let mut force = [0.0];
    simulation.real(&[reference("total_force")], &mut force).unwrap();
    let (ak, ar) = (10.2e-4, 8.6e-4);
    let pressure = |volume: f64| 3e6 * (0.5e-3 / volume).powf(1.3);
    let expected = ak * pressure(0.5e-3 - 0.05 * ak) - ar * pressure(0.5e-3 + 0.05 * ar);
    assert!((force[0] - expected).abs() < 1e-4, "{} {expected}", force[0]);
}

#[test]
fn a_valve_that_would_feed_energy_in_is_refused() {
    let mut p = parameters();
    p.valve.rebound.pressure_drop[5] = -0.1e5;
    let model = PumpHydraulicActuator { locked: false };
    let error = model.check(&p, &model.derive(&p)).unwrap_err();
    assert!(error.contains("valve.rebound.pressure_drop[6] = -10000"), "{error}");
}

#[test]
fn gas_without_a_volume_is_refused() {
    let (mut simulation, interface) = simulation(false);
    for (name, value) in [("gas.rebound_volume", 0.0), ("gas.charge_pressure", -1.0), ("motor.inertia", 0.0)]
    {
        let reference = interface.variable(name).unwrap().reference;
        let error = simulation.set_real(&[reference], &[value], Access::All).unwrap_err();
        assert!(matches!(error, strut_model::Error::OutOfBounds { .. }), "{error}");
    }
}
