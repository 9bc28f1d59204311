//! What is measured on each rig.

use crate::car::Motion;
use crate::case::{Plant, Sensors};

/// Signals and their units, inputs first.
pub fn signals(plant: Plant, sensors: Sensors) -> Vec<(&'static str, &'static str)> {
    let command = match plant {
        Plant::PumpDyno => {
            return vec![
                ("suspension.velocity", "m/s"),
                ("motor.torque", "N.m"),
                ("force", "N"),
                ("motor.speed", "rad/s"),
                ("pressure.compression", "Pa"),
                ("pressure.rebound", "Pa"),
            ];
        }
        Plant::SasRig => {
            return vec![
                ("eccentric.height", "m"),
                ("brake.torque", "N.m"),
                ("body_arm.angle", "rad"),
                ("relative.angle", "rad"),
                ("body_arm.acceleration", "rad/s2"),
                ("wheel_arm.acceleration", "rad/s2"),
            ];
        }
        Plant::PneumaticCylinder => {
            return vec![
                ("valve.voltage", "V"),
                ("position", "m"),
                ("acceleration", "m/s2"),
                ("chamber_a.pressure", "Pa"),
                ("chamber_b.pressure", "Pa"),
            ];
        }
        Plant::StrutDyno | Plant::MrDyno => return vec![("motion.position", "m"), ("force", "N")],
        Plant::LinearDrive => return vec![("force", "N"), ("position", "m")],
        Plant::GuidedMass => return vec![("force", "N"), ("position", "m"), ("acceleration", "m/s2")],
        Plant::LinearQuarter | Plant::RegulatedQuarter | Plant::PublishedQuarter => ("actuator.force", "N"),
        Plant::ServoQuarter => ("voltage", "V"),
    };
    let road = (sensors != Sensors::NoRoad).then_some(("road.position", "m"));
    let mut all: Vec<_> = road.into_iter().chain([command, ("body.acceleration", "m/s2")]).collect();
    if sensors != Sensors::Poor {
        all.push(("wheel.acceleration", "m/s2"));
    }
    all.push(("suspension.deflection", "m"));
    if sensors == Sensors::Full {
        all.push(("wheel.force", "N"));
    }
    if plant == Plant::ServoQuarter {
        all.push(("pressure", "Pa"));
    }
    all
}

/// A signal of a plant without its sensor.
pub fn true_signal(plant: Plant, motion: &Motion, name: &str) -> Vec<f64> {
    if let Some(signal) = motion.signals.get(name) {
        return signal.clone();
    }
    match name {
        "road.position" | "motion.position" => motion.road.clone(),
        "actuator.force" | "voltage" => motion.command.clone(),
        "force" if matches!(plant, Plant::LinearDrive | Plant::GuidedMass) => motion.command.clone(),
        "position" => motion.body.clone(),
        "body.acceleration" | "acceleration" => motion.body_acceleration.clone(),
        "wheel.acceleration" => motion.wheel_acceleration.clone(),
        "suspension.deflection" => motion.body.iter().zip(&motion.wheel).map(|(z, w)| z - w).collect(),
        "pressure" => motion.pressure.clone(),
        // Of the rig's tyre, or of the dyno's end.
        _ => motion.tire_force.clone(),
    }
}
