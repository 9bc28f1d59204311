use std::f64::consts::TAU;

use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Value};

use super::*;
use crate::testing::{Bench, harmonic, rms};

type Motor = Bench<ExcitationMotor>;

fn motor(drive: Drive) -> Motor {
    let number = match drive {
        Drive::Position => 1,
        Drive::Force => 2,
        Drive::Voltage => 3,
    };
    Motor::new().choose("drive", Value::Integer(number))
}

/// A rod that cannot be moved.
fn blocked(drive: Drive) -> Motor {
    motor(drive).start("moving_mass", 1e9)
}

fn parameters() -> Parameters<f64> {
    let declared = Declarations::of::<Parameters<f64>>();
    Bundle::from_fn(|i| declared[i].start)
}

#[test]
fn peak_and_continuous_force_are_those_of_tum() {
    let derived = ExcitationMotor { drive: Drive::Position }.derive(&parameters());
    assert!((derived.peak_force - 1860.0).abs() < 1e-9);
    assert!((derived.continuous_force - 276.0).abs() < 1e-9);
}

#[test]
fn the_peak_force_lasts_one_second_and_the_continuous_one_for_ever() {
    let mut motor = blocked(Drive::Force).initialized();
    let force = motor.follow("command.force", |_| 3000.0, 1e-3, 20_000, |motor| motor.get("force"));
    let at_peak = force.iter().filter(|force| **force > 0.99 * 1860.0).count();
    // Of the second, the last 2 % are the fade.
    assert!((970..=985).contains(&at_peak), "{at_peak} ms");
    assert!(force.iter().all(|force| *force < 1860.5));
    assert!((rms(&force[10_000..]) - 276.0).abs() < 0.01, "{}", rms(&force[10_000..]));
}

#[test]
fn rest_gives_the_peak_force_back() {
    let mut motor = blocked(Drive::Force).initialized();
    motor.follow("command.force", |_| 1860.0, 1e-3, 3000, |_| ());
    let worn = motor.get("force");
    // Empty after Q/i_c² = 44.4 s without current.
    motor.follow("command.force", |_| 0.0, 0.1, 450, |_| ());
    let full = motor.follow("command.force", |_| 1860.0, 1e-3, 900, |motor| motor.get("force"));
    assert!(worn < 280.0 && full[899] > 1859.0, "{worn} {}", full[899]);
}

/// Gain and phase lag in degrees from the position command at a frequency.
fn tracking(amplitude: f64, frequency: f64) -> (f64, f64) {
    let mut motor = motor(Drive::Position).start("dead_zone", 0.0).initialized();
    let (step, command) = (0.25e-3, |t: f64| amplitude * (TAU * frequency * t).sin());
    // Settled after half a second; then whole periods.
    motor.follow("command.position", command, step, 2000, |_| ());
    let count = (4000.0 / frequency).round() as usize * 4;
    let start = motor.time() + step;
    let position = motor.follow("command.position", command, step, count, |motor| motor.get("position"));
    let (found, phase) = harmonic(&position, start, step, frequency);
    (found / amplitude, -phase.to_degrees())
}

#[test]
fn the_position_follows_beyond_25_hertz() {
    // The band that the rig is made for (2.1), within 1 dB and 20 degrees; numbers of the linear transfer function.
    for (frequency, decibels, lag) in [(1.0, -0.01, 0.8), (10.0, 0.09, 5.3), (25.0, 0.67, 17.9)] {
        let (gain, found) = tracking(1e-3, frequency);
        assert!((20.0 * gain.log10() - decibels).abs() < 0.06, "{frequency} Hz: {} dB", 20.0 * gain.log10());
        assert!((found - lag).abs() < 1.0, "{frequency} Hz: {found}");
    }
    let gain = |frequency| 20.0 * tracking(1e-4, frequency).0.log10();
    assert!(gain(125.0) > -3.0 && gain(160.0) < -3.0, "{} {}", gain(125.0), gain(160.0));
}

#[test]
fn five_centimetres_and_a_millimetre_at_25_hertz_are_within_its_means() {
    let mut motor = Motor::published("TumExcitationMotor").initialized();
    for (amplitude, frequency) in [(0.05, 2.0), (8e-4, 25.0)] {
        let command = |t: f64| amplitude * (TAU * frequency * t).sin();
        let rows =
            motor.follow("command.position", command, 1e-3, 10_000, |m| (m.get("position"), m.get("force")));
        let (position, force): (Vec<f64>, Vec<f64>) = rows[1000..].iter().copied().unzip();
        let (found, _) = harmonic(&position, 0.0, 1e-3, frequency);
        assert!((found / amplitude - 1.0).abs() < 0.08, "{frequency} Hz: {found}");
        assert!(rms(&force) < 276.0 && motor.get("overload") < 0.1, "{frequency} Hz: {}", rms(&force));
    }
}

#[test]
fn within_the_dead_zone_nothing_moves() {
    let mut motor = motor(Drive::Position).start("dead_zone", 1e-3).initialized();
    let still = motor.follow(
        "command.position",
        |t| 0.99e-3 * (TAU * 3.0 * t).sin(),
        1e-3,
        1000,
        |m| m.get("position"),
    );
    assert!(still.iter().all(|position| *position == 0.0));
    let moved = motor.follow("command.position", |_| 3e-3, 1e-3, 2000, |m| m.get("position"));
    assert!((moved[1999] - 2e-3).abs() < 1e-6, "{}", moved[1999]);
}

#[test]
fn a_large_step_is_taken_within_the_profile_and_ends_at_the_stroke_limit() {
    let mut motor = motor(Drive::Position).initialized();
    let rows = motor.follow(
        "command.position",
        |_| 0.2,
        1e-3,
        1500,
        |m| (m.get("profile.velocity"), m.get("der(profile.velocity)"), m.get("position")),
    );
    assert!(rows.iter().all(|(v, a, _)| v.abs() <= 2.6 && a.abs() <= 80.0 * (1.0 + 1e-12)));
    let highest = rows.iter().map(|row| row.2).fold(0.0, f64::max);
    assert!(highest < 0.0605, "{highest}");
    assert!((rows[1499].2 - 0.06).abs() < 1e-6 && (motor.get("stroke.reserve")).abs() < 1e-6);
}

#[test]
fn the_offset_carries_the_constant_load() {
    let settle = |offset| {
        let mut motor = motor(Drive::Force)
            .start("constant_load", 100.0)
            .start("force_offset", offset)
            .start("guide.damping", 300.0)
            .initialized();
        motor.follow("command.force", |_| 0.0, 1e-2, 1500, |_| ());
        motor.get("position")
    };
    // Without, the base springs give by 100 N over 4 kN/m.
    assert!(
        settle(100.0).abs() < 1e-4 && (settle(0.0) + 0.025).abs() < 1e-4,
        "{} {}",
        settle(100.0),
        settle(0.0)
    );
}

#[test]
fn a_constant_load_pulls_the_rod_down() {
    let mut motor = motor(Drive::Voltage).start("constant_load", 8.0).initialized();
    // 8 N on 16 kg.
    assert_eq!(motor.get("acceleration"), -0.5);
}

#[test]
fn a_wheel_that_presses_moves_the_plate_down_until_the_loop_has_answered() {
    let mut motor = motor(Drive::Position).initialized();
    let course = motor.follow("wheel.force", |_| 200.0, 1e-3, 2000, |m| (m.get("position"), m.get("force")));
    let lowest = course.iter().map(|row| row.0).fold(0.0, f64::min);
    // Against the springs alone it would be 50 mm.
    assert!((-0.5e-3..-0.1e-3).contains(&lowest), "{lowest}");
    assert!(course[1999].0.abs() < 1e-6 && (course[1999].1 - 200.0).abs() < 0.1, "{:?}", course[1999]);
}

#[test]
fn a_blocked_motor_answers_a_voltage_as_resistance_and_inductance() {
    let mut motor = blocked(Drive::Voltage).initialized();
    for k in 1..=20 {
        motor.set("command.voltage", 12.7);
        motor.step(1e-3);
        let exact = 1.0 - (-12.7 / 0.016 * f64::from(k) * 1e-3).exp();
        assert!((motor.get("current") - exact).abs() < 1e-5, "{k} ms");
    }
}

#[test]
fn currents_without_overload_are_refused() {
    let mut motor = Motor::new().start("continuous_current", 25.0);
    let error = motor.initialize().unwrap_err().to_string();
    assert!(error.contains("peak_current = 20 A") && error.contains("25 A"), "{error}");
}

fn evaluate(drive: Drive, x: [f64; 12], u: [f64; 5]) -> (State<f64>, State<f64>, Output<f64>) {
    let (model, p) = (ExcitationMotor { drive }, parameters());
    let state =
        Bundle::from_fn(|i| x[i] * [0.05, 1.0, 15.0, 200.0, 0.05, 1.0, 0.05, 1.0, 1.0, 10.0, 15.0, 100.0][i]);
    let (rates, output) = model.equations(Instant {
        time: 0.0,
        state: &state,
        input: &Bundle::from_fn(|i| u[i] * [0.05, 500.0, 300.0, 500.0, 500.0][i]),
        parameters: &p,
        derived: &model.derive(&p),
        memory: &strut_model::NoVariables,
        tick: 0,
    });
    (state, rates, output)
}

proptest! {
    #[test]
    fn energy_comes_from_the_supply_and_the_load_alone(
        x in prop::array::uniform12(-1.0..1.0_f64),
        u in prop::array::uniform5(-1.0..1.0_f64),
        drive in prop::sample::select(vec![Drive::Position, Drive::Force, Drive::Voltage]),
    ) {
        let p = parameters();
        let (state, rates, output) = evaluate(drive, x, u);
        let stored = p.inductance * state.current * rates.current
            + p.moving_mass * state.velocity * rates.velocity
            + p.base_spring.stiffness * state.position * rates.position;
        let heat = p.resistance * state.current.powi(2);
        let friction = p.guide.coulomb.resistance(state.velocity) * state.velocity
            + p.guide.damping * state.velocity.powi(2);
        let load = 500.0 * (u[3] - u[4]) * state.velocity;
        prop_assert!(friction >= 0.0);
        let balance = output.power + load - heat - friction - stored;
        prop_assert!(balance.abs() < 1e-8, "{balance}");
    }

    #[test]
    fn the_drive_keeps_to_its_limits(
        x in prop::array::uniform12(-1.0..1.0_f64),
        u in prop::array::uniform5(-20.0..20.0_f64),
    ) {
        for drive in [Drive::Position, Drive::Force, Drive::Voltage] {
            let (_, _, output) = evaluate(drive, x, u);
            prop_assert!(output.voltage.abs() <= 329.0);
        }
    }
}

#[test]
fn static_equilibrium_is_rest() {
    let (_, rates, output) = evaluate(Drive::Position, [0.0; 12], [0.0; 5]);
    rates.for_each(|_, rate| assert_eq!(rate, 0.0));
    assert_eq!((output.force, output.power, output.following_error), (0.0, 0.0, 0.0));
}
