//! What Ajala claims, measured on the models and the systems as they are shipped: Fig. 2b, 4, 6 and 8.

mod nonlinear;
mod response;
mod ride;
mod system;

use std::f64::consts::TAU;
use std::sync::LazyLock;

use crate::common::Named;
use response::{Complex, Response};
use strut_model::{ParameterSet, Value};
use strut_physics::PARAMETER_SETS;
use system::System;

/// The systems' own communication step.
const STEP: f64 = 1e-3;
/// Periods until the slowest mode is gone: that of the weak force feedback has a time constant of 3 s.
const SETTLING: usize = 5;
/// s² z_a/y_s, eq. 43.
const ACCELERATION: usize = 0;
/// k_r (y_s - z_r)/y_s, eq. 44 with the sign of a load.
const LOAD: usize = 1;

/// From the road to both.
fn from_road(mut system: System, settling: usize) -> Response {
    let outputs = ["rig.body.acceleration", "rig.wheel.force"];
    Response::measured(&mut system, settling, "rig.road.position", 1e-5, &outputs)
}

fn of_system(name: &str) -> Response {
    from_road(System::published(name, STEP).initialized(), SETTLING)
}

fn passive(step: f64) -> System {
    System::published("ajala-two-dof", step)
        .choose("actuator.pump.locked", Value::Boolean(true))
        .initialized()
}

static PASSIVE: LazyLock<Response> = LazyLock::new(|| from_road(passive(STEP), 1));
static PID_H: LazyLock<Response> = LazyLock::new(|| of_system("ajala-pid-h"));
static PID_L: LazyLock<Response> = LazyLock::new(|| of_system("ajala-pid-l"));
static TWO_DOF: LazyLock<Response> = LazyLock::new(|| of_system("ajala-two-dof"));

/// From reference to force, the piston held (Fig. 2b).
fn closed_loop(controller: &str) -> Response {
    let connections =
        ["actuator.force -> controller.actuator.force", "controller.motor.torque -> actuator.motor.torque"];
    let components = [("controller", controller), ("actuator", "AjalaPumpHydraulicActuatorLinear")];
    let mut system = System::new(STEP, &components, &connections).initialized();
    Response::measured(&mut system, SETTLING, "controller.force_reference", 0.1, &["actuator.force"])
}

/// k and c of the linear actuator.
const STIFFNESS: f64 = 13_784.16;
const DAMPING: f64 = 1413.76;

/// Both magnitudes of the passive corner, eq. 27 with F_a = (c s + k) z_e (38), in closed form.
fn passive_by_hand(frequency: f64) -> [f64; 2] {
    let (ma, mr, ka, kr) = (350.0, 36.0, 20e3, 290e3);
    let omega = TAU * frequency;
    let strut = Complex { re: ka + STIFFNESS, im: DAMPING * omega };
    // m_a s² z_a = strut (z_r - z_a), m_r s² z_r = -strut (z_r - z_a) + k_r (y_s - z_r).
    let body = Complex { re: strut.re - ma * omega * omega, im: strut.im };
    let ratio = strut.over(body);
    let inertia = Complex { re: kr - mr * omega * omega, im: 0.0 };
    let passed = strut.less(strut.times(ratio));
    let wheel = Complex { re: kr, im: 0.0 }.over(Complex { re: inertia.re + passed.re, im: passed.im });
    let tire = Complex { re: 1.0, im: 0.0 }.less(wheel);
    [omega * omega * wheel.times(ratio).magnitude(), kr * tire.magnitude()]
}

/// What a set says about a variable.
fn published(fmu: &str) -> ParameterSet {
    let file = format!("{fmu}.toml");
    ParameterSet::parse(PARAMETER_SETS.iter().find(|(name, _)| *name == file).unwrap().1).unwrap()
}

#[test]
fn controllers_are_told_of_the_actuators_that_they_have() {
    let mut actuator = Named::published("AjalaPumpHydraulicActuatorLinear");
    actuator.initialize();
    for set in ["AjalaForceTwoDof", "AjalaPidHForcePid", "AjalaPidLForcePid"] {
        let mut controller = Named::published(set);
        for name in ["pump.displacement", "piston.area"] {
            assert_eq!(controller.get(name), actuator.get(name), "{set}: {name}");
        }
    }
    let mut controller = Named::published("AjalaForceTwoDof");
    for (own, of_actuator) in [("plant.stiffness", "stiffness"), ("plant.damping", "damping")] {
        assert!((controller.get(own) / actuator.get(of_actuator) - 1.0).abs() < 1e-9, "{own}");
        let by_hand = if own == "plant.stiffness" { STIFFNESS } else { DAMPING };
        assert_eq!(controller.get(own), by_hand);
    }
    let (scheduled, soft) = (published("AjalaForceTwoDofLpv"), published("AjalaSoftPumpHydraulicActuator"));
    let own = ["motor.", "pump.coulomb."];
    let shared = soft.values.iter().filter(|(name, _)| !own.iter().any(|group| name.starts_with(group)));
    for (name, given) in shared {
        assert_eq!(scheduled.values[name].value, given.value, "{name}");
    }
}

#[test]
fn the_passive_corner_is_equations_27_and_38() {
    // At the systems' own step the force of the damper is late by a step and a half, which is felt: 12 % of the
    // wheel load at 8 Hz.
    let response = from_road(passive(1e-4), 1);
    for frequency in [0.5, 1.0, 1.5, 3.0, 8.0, 14.0, 16.0, 20.0] {
        for (output, expected) in [ACCELERATION, LOAD].into_iter().zip(passive_by_hand(frequency)) {
            let found = response.at(output, frequency);
            assert!((found / expected - 1.0).abs() < 0.015, "{frequency} Hz, {output}: {found} {expected}");
        }
    }
}

#[test]
fn every_control_takes_the_peak_from_the_body_mode() {
    let (_, passive) = PASSIVE.largest(ACCELERATION, 0.5, 2.0);
    for (name, response) in [("PID-H", &PID_H), ("PID-L", &PID_L), ("2-DOF", &TWO_DOF)] {
        let (_, active) = response.largest(ACCELERATION, 0.5, 2.0);
        assert!(active < 0.3 * passive, "{name}: {active} of {passive}");
    }
    // And all three are alike below and at the mode.
    for frequency in [0.5, 0.7, 1.0, 1.2] {
        let all = [&PID_H, &PID_L, &TWO_DOF].map(|response| response.at(ACCELERATION, frequency));
        let (low, high) =
            (all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(0.0, f64::max));
        assert!(high < 1.4 * low, "{frequency} Hz: {all:?}");
    }
}

#[test]
fn pid_h_has_a_peak_at_the_wheel_mode_and_none_at_3_hertz() {
    for (output, factor) in [(ACCELERATION, 1.2), (LOAD, 3.0)] {
        let (frequency, peak) = PID_H.largest(output, 8.0, 20.0);
        let (_, passive) = PASSIVE.largest(output, 8.0, 20.0);
        assert!(
            (13.0..14.5).contains(&frequency) && peak > factor * passive,
            "{frequency} Hz: {peak} of {passive}"
        );
    }
    assert!(PID_H.peaks(ACCELERATION, 2.2, 6.0).is_empty());
    assert!(PID_H.at(ACCELERATION, 3.0) < 0.5 * PASSIVE.at(ACCELERATION, 3.0));
}

#[test]
fn pid_l_has_a_peak_at_3_hertz_and_is_like_passive_at_the_wheel_mode() {
    for output in [ACCELERATION, LOAD] {
        let peaks = PID_L.peaks(output, 2.2, 6.0);
        assert!(peaks.len() == 1 && (2.8..3.6).contains(&peaks[0]), "{peaks:?}");
        assert!(PID_L.at(output, peaks[0]) > 1.2 * PASSIVE.at(output, peaks[0]));
        assert!(PID_L.at(output, peaks[0]) > 3.0 * TWO_DOF.at(output, peaks[0]));
    }
    assert!(PID_L.largest(LOAD, 8.0, 20.0).1 < 0.4 * PID_H.largest(LOAD, 8.0, 20.0).1);
}

#[test]
fn two_degrees_of_freedom_have_neither_peak_and_are_like_passive_above_the_body_mode() {
    assert!(TWO_DOF.peaks(ACCELERATION, 2.2, 8.0).is_empty() && TWO_DOF.peaks(LOAD, 2.2, 8.0).is_empty());
    for output in [ACCELERATION, LOAD] {
        let (active, passive) = (TWO_DOF.largest(output, 8.0, 20.0).1, PASSIVE.largest(output, 8.0, 20.0).1);
        assert!(active < 1.15 * passive, "{active} of {passive}");
    }
    for frequency in [8.0, 12.0, 14.0, 20.0] {
        let ratio = TWO_DOF.at(ACCELERATION, frequency) / PASSIVE.at(ACCELERATION, frequency);
        assert!((0.75..1.25).contains(&ratio), "{frequency} Hz: {ratio}");
    }
}

#[test]
fn the_closed_loops_are_those_of_figure_2b() {
    let (high, low) = (closed_loop("AjalaPidHForcePid"), closed_loop("AjalaPidLForcePid"));
    // PID-H tracks without a resonance, far beyond the wheel mode.
    assert!(high.largest(0, 0.3, 25.0).1 < 1.05 && high.at(0, 14.0) > 0.8);
    // PID-L has a small resonance at 3 Hz, and its bandwidth ends below the wheel mode.
    let (frequency, peak) = low.largest(0, 0.3, 25.0);
    assert!((2.5..3.5).contains(&frequency) && (1.2..2.0).contains(&peak), "{frequency} Hz: {peak}");
    assert!(low.at(0, 14.0) < 0.4);
    // Even at low frequencies it tracks worse.
    assert!((low.at(0, 2.0) - 1.0).abs() > 3.0 * (high.at(0, 2.0) - 1.0).abs());
}
