use std::f64::consts::{PI, TAU};

use super::*;
use crate::Plant;
use crate::friction::Limit;
use crate::rig::{Rig, start};

fn kogut() -> Sas {
    Rig::new(Plant::SasRig, &start(Plant::SasRig)).sas
}

/// With a torque as command, and the wheel arm as good as locked.
fn locked() -> Sas {
    Sas { wheel_inertia: 1e12, drag: None, ..kogut() }
}

/// Half a sine of 0.2 s.
fn push(torque: f64, duration: f64) -> Profile {
    Profile::new(duration, |t| if t < 0.7 && t > 0.5 { torque * (PI * (t - 0.5) / 0.2).sin() } else { 0.0 })
}

/// Times in s at which a signal falls through its rest, and its largest deflections from one to the next.
fn swings(signal: &[f64], rest: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut times, mut peaks, mut most) = (vec![], vec![], 0.0_f64);
    for k in 1..signal.len() {
        let (before, after) = (signal[k - 1] - rest, signal[k] - rest);
        most = most.max(after.abs());
        if before > 0.0 && after <= 0.0 {
            times.push(((k - 1) as f64 + before / (before - after)) / RATE);
            peaks.push(std::mem::take(&mut most));
        }
    }
    (times, peaks)
}

/// Kogut 3.2.2 prints [−0.195, 0.354].
#[test]
fn it_rests_where_it_was_seen_to() {
    let ([wheel, body], load) = kogut().rest();
    assert!((wheel + 0.195).abs() < 5e-4 && (body - 0.354).abs() < 2e-3, "{wheel} rad, {body} rad");
    // On the wheel arm M_1 cos(β − α_1) and the spring's moment r_s1/r_s2 M_2 cos γ, over the lever R cos(β − α_1).
    let cosine = 0.429_243_f64.cos();
    let due = (9.883_836 * cosine + 0.275 / 0.191 * 30.2359 * 0.352_884_f64.cos()) / (0.21 * cosine);
    assert!((load - due).abs() < 0.01, "{load} N for {due} N");
}

#[test]
fn rest_stays_rest() {
    for sas in [kogut(), Sas { tire_quadratic: 2e7, stiffness: 3600.0, ..kogut() }] {
        let motion = sas.run(&Profile::still(), &Profile::still(), 2.0);
        for name in ["body_arm.angle", "relative.angle"] {
            let signal = &motion.signals[name];
            assert!(signal.iter().all(|angle| (angle - signal[0]).abs() < 1e-10), "{name}");
        }
        assert!(motion.command.iter().all(|torque| torque.abs() < 1e-8));
    }
}

/// ω² = (k_s r_s2 ∂l/∂γ − M_2 sin γ)/I_2 with ∂l/∂γ = r_s1 r_s2 sin(γ − α_1)/l = 0.182689 m: 9.43061 rad/s. A brake of c has
/// the amplitude fall by exp(−c t/(2 I_2)).
#[test]
fn the_body_arm_swings_as_a_pendulum_on_its_spring() {
    let swung = |drag: Option<f64>| {
        let sas = Sas { drag, ..locked() };
        let ([wheel, body], _) = sas.rest();
        let motion =
            sas.run_from([wheel, 0.0, body + 2e-3, 0.0, 0.0], &Profile::still(), &Profile::still(), 8.0);
        swings(&motion.signals["body_arm.angle"], body)
    };
    let (times, peaks) = swung(None);
    let count = times.len() - 1;
    let omega = TAU * count as f64 / (times[count] - times[0]);
    assert!((omega / 9.430_61 - 1.0).abs() < 1e-5, "{omega} rad/s");
    assert!((peaks[count] / peaks[1] - 1.0).abs() < 1e-6, "{peaks:?}");
    let (times, peaks) = swung(Some(0.2632));
    let rate = (peaks[8] / peaks[1]).ln() / (times[8] - times[1]);
    assert!((rate / (-0.2632 / (2.0 * 1.37)) - 1.0).abs() < 1e-3, "{rate} 1/s");
}

/// A torque that resists the body arm's turning drives the wheel arm along.
#[test]
fn the_brake_acts_on_both_arms_against_each_other() {
    let sas = Sas { drag: None, ..kogut() };
    let torque = Profile::new(1.0, |t| if t > 0.2 { 0.5 } else { 0.0 });
    let motion = sas.run(&Profile::still(), &torque, 1.0);
    let k = ((crate::excitation::STANDSTILL + 0.2005) * RATE) as usize;
    let acting = motion.command[k];
    let [body, wheel] =
        ["body_arm.acceleration", "wheel_arm.acceleration"].map(|name| motion.signals[name][k]);
    assert!(acting > 0.01 && (body + acting / 1.37).abs() < 0.05 * acting, "{body} rad/s² by {acting} N m");
    assert!((wheel - acting / 0.2116).abs() < 0.2 * acting / 0.2116, "{wheel} rad/s² by {acting} N m");
}

/// Friction and brake take what the spring and gravity put into the body arm, until it stands.
#[test]
fn the_energy_balance_closes() {
    let contacts = vec![Contact { along: [1.0, -1.0], limit: Limit::Coulomb(0.2) }];
    let sas = Sas { contacts, drag: Some(0.2632), ..locked() };
    let ([wheel, rest], _) = sas.rest();
    let command = Profile::new(4.0, |t| 1.0 + (TAU * t).sin());
    let motion = sas.run_from([wheel, 0.0, rest + 0.05, 0.0, 0.0], &Profile::still(), &command, 4.0);
    let body = &motion.signals["body_arm.angle"];
    let torque = |angle: f64| sas.torques([wheel, angle], (0.0, 0.0))[1];
    let (mut put_in, mut lost) = (0.0, 0.0);
    for k in 1..body.len() {
        let turned = body[k] - body[k - 1];
        put_in += 0.5 * (torque(body[k]) + torque(body[k - 1])) * turned;
        lost += 0.5 * (motion.command[k] + motion.command[k - 1]) * turned + 0.2 * turned.abs();
    }
    let (last, before) = (body[body.len() - 1], body[body.len() - 2000]);
    assert!((last - before).abs() < 1e-9 && (last - rest).abs() > 1e-6, "{before} rad, {last} rad");
    assert!(lost > 0.1 && (put_in - lost).abs() < 1e-3 * lost, "{put_in} J put in, {lost} J lost");
}

#[test]
fn friction_holds_the_arms_together() {
    let turned = |torque: f64| {
        let contacts = vec![Contact { along: [1.0, -1.0], limit: Limit::Coulomb(0.4) }];
        let motion = Sas { contacts, ..locked() }.run(&Profile::still(), &push(torque, 2.0), 2.0);
        let angle = &motion.signals["relative.angle"];
        angle.iter().fold(0.0_f64, |most, x| most.max((x - angle[0]).abs()))
    };
    assert!(turned(0.39) < 1e-9, "{} rad", turned(0.39));
    assert!(turned(0.6) > 1e-4, "{} rad", turned(0.6));
}

#[test]
fn a_tyre_does_not_pull() {
    let drop = Profile::new(2.0, |t| if t > 0.6 { -6e-3 } else { 0.0 });
    let motion = kogut().run(&drop, &Profile::still(), 2.0);
    let least = motion.tire_force.iter().fold(f64::INFINITY, |least, force| least.min(*force));
    assert_eq!(least, 0.0);
}

/// The late torque comes from a record of steps, straight between them.
#[test]
fn a_late_and_weak_brake_does_the_same_later() {
    let sas = Sas { drag: None, ..kogut() };
    let torque = Profile::new(2.0, |t| 0.5 * (TAU * 3.0 * t).sin());
    let now = sas.run(&Profile::still(), &torque.scaled(0.9), 2.0);
    let actuator = Actuator { delay: 7.025e-3, gain: 0.9, ..Actuator::default() };
    let later = Sas { actuator, ..sas }.run(&Profile::still(), &torque, 2.0);
    for k in 141..now.command.len() {
        let signal = &now.signals["relative.angle"];
        // 140.5 steps.
        let due = 0.5 * (signal[k - 140] + signal[k - 141]);
        let later = later.signals["relative.angle"][k];
        assert!((later - due).abs() < 1e-8, "{later} rad for {due} rad at {k}");
    }
}
