//! The equations of active suspensions: rigs, actuators, controllers and roads, each a
//! [`Model`](strut_model::Model) written from its source document.
//!
//! Conventions: SI units; positions upwards from static equilibrium; suspension deflection = body − wheel;
//! tyre deflection = wheel − road; a positive actuator force pushes body and wheel apart; a positive wheel
//! force presses on the road.
//!
//! The sources are named TUM, Quanser, Konieczny, Ajala and Kogut after `parameters/literature.bib`.

pub mod effects;
pub mod elements;
pub mod rigs;
pub mod roads;

use strut_model::Entry;

/// Standard acceleration of gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// All models.
pub const CATALOGUE: &[Entry] = &[
    Entry::of::<rigs::QuarterCar>(),
    Entry::of::<roads::Road>(),
    Entry::of::<roads::FourWheelRoad>(),
];

/// File name and text of each published parameter set.
pub const PARAMETER_SETS: &[(&str, &str)] = &[];

/// File name and text of each composition of components to a system.
pub const SYSTEMS: &[(&str, &str)] = &[];
