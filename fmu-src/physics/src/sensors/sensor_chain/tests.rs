use std::f64::consts::TAU;

use proptest::prelude::*;
use strut_model::Value;

use super::*;
use crate::GRAVITY;
use crate::testing::{Bench, harmonic, rms};

type Chain = Bench<SensorChain>;

/// Every analogue channel: its input and the group of its parameters.
const CHANNELS: [(&str, &str); 4] = [
    ("body.acceleration", "body_acceleration"),
    ("wheel.acceleration", "wheel_acceleration"),
    ("wheel.force", "wheel_force"),
    ("actuator.current", "actuator_current"),
];

/// What is read of an input at each sampling, which is every step.
fn read(chain: &mut Chain, input: &str, signal: impl Fn(f64) -> f64, step: f64, count: usize) -> Vec<f64> {
    let reading = format!("measured.{input}");
    chain.follow(input, signal, step, count, |chain| chain.get(&reading))
}

#[test]
fn noise_and_rounding_of_the_tum_rig_are_the_ratios_of_table_5() {
    // Full scale in volts and in the unit of the quantity, ratio.
    let rows = [(4.0, 5.0 * GRAVITY, 70.0), (4.0, 25.0 * GRAVITY, 65.0), (10.0, 5000.0, 75.0)];
    for ((input, group), (volts, full_scale, decibels)) in CHANNELS.into_iter().zip(rows) {
        let mut chain = Chain::published("TumSensorChain").initialized();
        // A slow sweep over ten steps of a 12-bit converter in 20 s: its rounding is spread evenly.
        let slope = 10.0 * 20.0 / 4096.0 / 20.0 * full_scale / volts;
        let readings = read(&mut chain, input, |t| slope * t, 1e-3, 20_000);
        let late = 1.0 / TAU / 380.0 + lag(&mut chain, group);
        let errors: Vec<f64> =
            readings.iter().enumerate().skip(20).map(|(k, x)| x - slope * (k as f64 * 1e-3 - late)).collect();
        let found = 20.0 * (full_scale / 2.0_f64.sqrt() / rms(&errors)).log10();
        assert!((found - decibels).abs() < 0.1, "{input}: {found} dB");
    }
}

/// By how much a sensor is late with a ramp.
fn lag(chain: &mut Chain, group: &str) -> f64 {
    if group == "wheel_force" {
        return 1.0 / TAU / chain.get("wheel_force.sensor.bandwidth");
    }
    let damping = chain.get(&format!("{group}.sensor.damping"));
    2.0 * damping / TAU / chain.get(&format!("{group}.natural_frequency"))
}

#[test]
fn noise_has_the_given_size_is_each_channel_s_own_and_repeats_with_its_seed() {
    let noisy = |seed: i32| -> Vec<(f64, f64)> {
        let mut chain = Chain::new()
            .choose("seed", Value::Integer(seed))
            .start("body_acceleration.noise", 2e-3)
            .start("wheel_force.noise", 5e-3)
            .initialized();
        (0..20_000)
            .map(|_| {
                chain.step(1e-3);
                (chain.get("measured.body.acceleration") * 0.08, chain.get("measured.wheel.force") * 2e-3)
            })
            .collect()
    };
    let rows = noisy(7);
    let (body, force): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    // Five standard errors of 20 000 samples.
    assert!((rms(&body) / 2e-3 - 1.0).abs() < 0.025 && (rms(&force) / 5e-3 - 1.0).abs() < 0.025);
    let cross = body.iter().zip(&force).map(|(a, b)| a * b).sum::<f64>() / 20_000.0 / (2e-3 * 5e-3);
    assert!(cross.abs() < 0.035, "{cross}");
    assert_eq!(rows, noisy(7));
    assert_ne!(rows, noisy(8));
}

/// Gain at a multiple of 50 Hz, read so often that holding does nothing.
fn gain(chain: Chain, input: &str, frequency: f64) -> f64 {
    let step = 20e-6;
    let mut chain = chain.start("period", step).initialized();
    let signal = |t: f64| (TAU * frequency * t).sin();
    read(&mut chain, input, signal, step, 2000);
    harmonic(&read(&mut chain, input, signal, step, 1000), 0.0, step, frequency).0
}

#[test]
fn sensors_and_filters_pass_what_they_say() {
    let bandwidths = [400.0, 1000.0, 1000.0, 1000.0];
    for ((input, group), bandwidth) in CHANNELS.into_iter().zip(bandwidths) {
        let smooth = || {
            Chain::published("TumSensorChain")
                .start(&format!("{group}.converter.resolution"), 0.0)
                .start(&format!("{group}.noise"), 0.0)
        };
        let sensor = gain(smooth().choose("filter.enabled", Value::Boolean(false)), input, bandwidth);
        assert!((sensor * 2.0_f64.sqrt() - 1.0).abs() < 2e-3, "{input}: {sensor}");
        let direct = smooth().choose(&format!("{group}.dynamics"), Value::Integer(1));
        let filter = gain(direct, input, 400.0);
        let exact = 1.0 / 1.0_f64.hypot(400.0 / 380.0);
        assert!((filter / exact - 1.0).abs() < 2e-3, "{input}: {filter}");
    }
}

#[test]
fn readings_are_steps_of_the_converter_and_of_the_encoder() {
    let mut chain = Chain::published("TumSensorChain").initialized();
    for k in 0..500 {
        let t = f64::from(k) * 1e-3;
        let deflection = 0.02 * (TAU * 2.0 * t).sin();
        chain.set("wheel.acceleration", 30.0 * (TAU * 3.0 * t).sin());
        chain.set("suspension.deflection", deflection);
        chain.step(1e-3);
        let volts = chain.get("measured.wheel.acceleration") * (0.16 / GRAVITY);
        let pulses = chain.get("measured.suspension.deflection") * 12e3;
        for steps in [volts / (20.0 / 4096.0), pulses] {
            assert!((steps - steps.round()).abs() < 1e-9, "{steps}");
        }
        // A counter is late by less than a pulse.
        let late = deflection * 12e3 - pulses;
        assert!((-1e-9..1.0 + 1e-9).contains(&late), "{late}");
    }
}

#[test]
fn sensors_and_converters_saturate() {
    let quiet = || Chain::published("TumSensorChain").start("body_acceleration.noise", 0.0);
    let settled = |chain: Chain, value: f64| -> f64 {
        *read(&mut chain.initialized(), "body.acceleration", |_| value, 1e-3, 100).last().unwrap()
    };
    let step = 20.0 / 65536.0 / 0.8 * GRAVITY;
    for sign in [1.0, -1.0] {
        let sensor = settled(quiet(), sign * 70.0);
        assert!((sensor - sign * 5.0 * GRAVITY).abs() <= 0.5 * step, "{sensor}");
        // A converter of less range than the sensor; upwards it has one step less.
        let converter = settled(quiet().start("body_acceleration.converter.range", 2.0), sign * 70.0);
        let lost = if sign > 0.0 { step } else { 0.0 };
        assert!((converter - sign * 2.5 * GRAVITY + lost).abs() < 1e-9, "{converter}");
    }
}

#[test]
fn a_reading_is_held_for_a_period() {
    let mut chain = Chain::published("TumSensorChain").initialized();
    let readings: Vec<f64> = (0..40)
        .map(|k| {
            chain.set("road.position", f64::from(k) * 1e-4);
            chain.step(0.25e-3);
            chain.get("measured.road.position")
        })
        .collect();
    for (k, reading) in readings.iter().enumerate() {
        let sampled = k / 4 * 4;
        assert_eq!(*reading, readings[sampled]);
        assert!((reading - sampled as f64 * 1e-4).abs() <= 1e-5 + 1e-12, "{k}: {reading}");
    }
}

#[test]
fn errors_at_their_limits_add_up() {
    let mut chain =
        Chain::published("TumUncalibratedSensorChain").start("wheel_acceleration.noise", 0.0).initialized();
    let readings = read(&mut chain, "wheel.acceleration", |_| 10.0 * GRAVITY, 1e-3, 200);
    let found = readings[199] / GRAVITY;
    // 1 % and 0.75 g of the sensor, 0.5 % and 5 mV of the converter.
    let exact = (10.0 * 1.01 + 0.75) * 1.005 + 0.005 / 0.16;
    assert!((found - exact).abs() < 0.5 * 20.0 / 4096.0 / 0.16 + 1e-9, "{found} {exact}");
}

#[test]
fn a_converter_without_steps_in_its_range_is_refused() {
    let mut chain = Chain::new().start("actuator_current.converter.resolution", 12.0);
    let error = chain.initialize().unwrap_err().to_string();
    assert!(error.contains("actuator_current.converter.resolution = 12 V"), "{error}");
}

proptest! {
    #[test]
    fn an_ideal_chain_is_absent(values in prop::array::uniform5(-1.0..1.0_f64)) {
        let mut chain = Chain::new().choose("filter.enabled", Value::Boolean(false));
        for (_, group) in CHANNELS {
            chain = chain.choose(&format!("{group}.dynamics"), Value::Integer(1));
        }
        let mut chain = chain.initialized();
        let inputs =
            ["body.acceleration", "wheel.acceleration", "wheel.force", "actuator.current", "road.position"];
        for (name, value) in inputs.into_iter().zip(values) {
            chain.set(name, value);
        }
        chain.step(1e-3);
        for (name, value) in inputs.into_iter().zip(values) {
            let reading = chain.get(&format!("measured.{name}"));
            prop_assert!((reading - value).abs() < 1e-15);
        }
    }
}
