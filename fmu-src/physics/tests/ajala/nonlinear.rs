//! Fig. 6: the nonlinear actuator on a rig that moves its piston, passive and controlled.

use std::f64::consts::TAU;

use strut_model::Value;

use super::STEP;
use super::response::{Complex, part};
use super::system::System;

/// Frequency in Hz and amplitude of what is wanted in newtons, and of the deflection in metres: a body that rolls and
/// heaves, a wheel that hops. No two are the same, so that the force tells them apart.
const REFERENCE: [(f64, f64); 2] = [(0.5, 400.0), (1.3, 250.0)];
const DEFLECTION: [(f64, f64); 3] = [(0.3, 0.02), (1.1, 0.015), (12.0, 0.004)];
/// Seconds of one period of all of them, and what is waited before.
const PERIOD: f64 = 10.0;
const SETTLING: f64 = 30.0;

fn sines(list: &[(f64, f64)], t: f64) -> f64 {
    list.iter().map(|(frequency, amplitude)| amplitude * (TAU * frequency * t).sin()).sum()
}

fn rates(list: &[(f64, f64)], t: f64) -> f64 {
    list.iter().map(|(frequency, amplitude)| amplitude * TAU * frequency * (TAU * frequency * t).cos()).sum()
}

/// The force of one period.
struct Record(Vec<f64>);

impl Record {
    /// With which controller, and whether the pump is free.
    fn of(controller: &str, locked: bool) -> Self {
        let mut connections = vec![
            "actuator.force -> controller.actuator.force",
            "actuator.motor.speed -> controller.motor.speed",
            "controller.motor.torque -> actuator.motor.torque",
        ];
        let scheduled = controller.ends_with("Lpv");
        if scheduled {
            connections.extend([
                "actuator.pressure.compression -> controller.pressure.compression",
                "actuator.pressure.rebound -> controller.pressure.rebound",
            ]);
        }
        let components = [("controller", controller), ("actuator", "AjalaSoftPumpHydraulicActuator")];
        let system = System::new(STEP, &components, &connections);
        let mut system = system.choose("actuator.pump.locked", Value::Boolean(locked)).initialized();
        let mut forces = Vec::new();
        for k in 0..((SETTLING + PERIOD) / STEP).round() as usize {
            let t = k as f64 * STEP;
            system.set("controller.force_reference", sines(&REFERENCE, t));
            system.set("controller.suspension.deflection", sines(&DEFLECTION, t));
            if scheduled {
                system.set("controller.suspension.velocity", rates(&DEFLECTION, t));
            }
            // The piston moves by what is in the middle of the step.
            system.set("actuator.suspension.velocity", rates(&DEFLECTION, t + 0.5 * STEP));
            system.advance();
            if t >= SETTLING - 1e-9 {
                forces.push(system.get("actuator.force"));
            }
        }
        Self(forces)
    }

    /// The part of a frequency.
    fn part(&self, frequency: f64) -> Complex {
        part(&self.0, STEP, STEP, frequency)
    }

    /// How far the parts of the references are off, relative to them.
    fn tracking_errors(&self) -> [f64; 2] {
        REFERENCE.map(|(frequency, amplitude)| {
            // A sine is -i in this notation.
            self.part(frequency).less(Complex { re: 0.0, im: -amplitude }).magnitude() / amplitude
        })
    }

    /// The root of the mean square of what is below 3 Hz and not wanted.
    fn slow_error(&self) -> f64 {
        let wanted = |frequency: f64| {
            REFERENCE.iter().find(|(f, _)| (f - frequency).abs() < 1e-9).map_or(0.0, |(_, a)| *a)
        };
        let squares = (1..=30).map(|tenths| {
            let frequency = f64::from(tenths) / PERIOD;
            self.part(frequency).less(Complex { re: 0.0, im: -wanted(frequency) }).magnitude().powi(2) / 2.0
        });
        squares.sum::<f64>().sqrt()
    }
}

#[test]
fn slow_forces_follow_the_reference_and_fast_ones_are_passive() {
    let active = Record::of("AjalaForceTwoDofLpv", false);
    let passive = Record::of("AjalaForceTwoDofLpv", true);
    for (error, without) in active.tracking_errors().into_iter().zip(passive.tracking_errors()) {
        assert!(error < 0.12 && without > 0.9, "{error} {without}");
    }
    assert!(
        active.slow_error() < 0.15 * passive.slow_error(),
        "{} {}",
        active.slow_error(),
        passive.slow_error()
    );
    // The wheel's hop: the force of the passive actuator, less what the high-pass of eq. 42 takes at 12 Hz.
    let (a, p) = (active.part(12.0), passive.part(12.0));
    assert!((a.magnitude() / p.magnitude() - 1.0).abs() < 0.05, "{}", a.magnitude() / p.magnitude());
    let (s, pole) = (Complex { re: 0.0, im: 12.0 }, Complex { re: 2.0, im: 12.0 });
    let expected = p.times(s.over(pole)).times(s.over(pole));
    let off = a.less(expected).magnitude() / p.magnitude();
    assert!(off < 0.08, "{off}");
}

#[test]
fn the_schedule_is_worth_its_measurements() {
    let scheduled = Record::of("AjalaForceTwoDofLpv", false).slow_error();
    let linear = Record::of("AjalaForceTwoDof", false).slow_error();
    assert!(scheduled < 0.75 * linear, "{scheduled} {linear}");
}
