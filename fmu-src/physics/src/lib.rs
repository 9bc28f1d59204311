//! The equations of active suspensions: rigs, actuators, controllers, sensors, roads and sources, each a
//! [`Model`](strut_model::Model) written from its source document.
//!
//! Conventions: SI units; positions upwards from static equilibrium; suspension deflection = body − wheel;
//! tyre deflection = wheel − road; a positive actuator force pushes body and wheel apart; a positive wheel
//! force presses on the road.
//!
//! The sources are named TUM, Quanser, Konieczny, Ajala and Kogut after `parameters/literature.bib`.

pub mod actuators;
pub mod car;
pub mod controllers;
pub mod effects;
pub mod elements;
pub mod recording;
pub mod rigs;
pub mod roads;
pub mod sensors;
pub mod signals;
pub mod sources;
pub mod table;
pub mod waveform;

#[cfg(test)]
mod testing;

#[cfg(all(feature = "catalogue", not(test)))]
use strut_model::Entry;

/// Standard acceleration of gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// All models. A static, so that they are compiled once and not by everyone who looks into it; no unit test does.
#[cfg(all(feature = "catalogue", not(test)))]
pub static CATALOGUE: &[Entry] = &[
    Entry::of::<rigs::QuarterCar>(),
    Entry::of::<rigs::FullCar>(),
    Entry::of::<rigs::SprungMass>(),
    Entry::of::<rigs::SasRig>(),
    Entry::of::<rigs::ServoSuspension>(),
    Entry::of::<rigs::ServoSuspensionIdentified>(),
    Entry::of::<rigs::ElementDyno>(),
    Entry::of::<rigs::LinearDrive>(),
    Entry::of::<rigs::RotaryDrive>(),
    Entry::of::<rigs::PneumaticCylinder>(),
    Entry::of::<actuators::LinearMotor>(),
    Entry::of::<actuators::ServoHydraulicActuator>(),
    Entry::of::<actuators::PumpHydraulicActuator>(),
    Entry::of::<actuators::PumpHydraulicActuatorLinear>(),
    Entry::of::<actuators::ExcitationMotor>(),
    Entry::of::<actuators::MrRotaryBrake>(),
    Entry::of::<actuators::EccentricDrive>(),
    Entry::of::<controllers::ForcePid>(),
    Entry::of::<controllers::ForceTwoDof>(),
    Entry::of::<controllers::ForceTwoDofLpv>(),
    Entry::of::<controllers::LqrController>(),
    Entry::of::<controllers::Skyhook>(),
    Entry::of::<controllers::ModalSkyhook>(),
    Entry::of::<controllers::ExcitationSpeedController>(),
    Entry::of::<sensors::SensorChain>(),
    Entry::of::<sensors::AngleSensorChain>(),
    Entry::of::<sensors::VelocityEstimator>(),
    Entry::of::<sensors::SignalAdapter>(),
    Entry::of::<roads::Road>(),
    Entry::of::<roads::FourWheelRoad>(),
    Entry::of::<sources::VoltageSource>(),
    Entry::of::<sources::FrequencySource>(),
    Entry::of::<sources::RecordedSource>(),
];

// PARAMETER_SETS and SYSTEMS, as they lie in `parameters` and `systems`.
include!(concat!(env!("OUT_DIR"), "/data.rs"));

/// The documents that equations, parameter sets and effects come from, in BibTeX with a field a line.
pub const LITERATURE: &str = include_str!("../parameters/literature.bib");
