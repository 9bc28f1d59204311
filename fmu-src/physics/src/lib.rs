//! The equations of active suspensions: rigs, actuators, controllers and roads, each a
//! [`Model`](strut_model::Model) written from its source document.
//!
//! Conventions: SI units; positions upwards from static equilibrium; suspension deflection = body − wheel;
//! tyre deflection = wheel − road; a positive actuator force pushes body and wheel apart; a positive wheel
//! force presses on the road.
//!
//! The sources are named TUM, Quanser, Konieczny, Ajala and Kogut after `parameters/literature.bib`.

pub mod actuators;
pub mod controllers;
pub mod effects;
pub mod elements;
pub mod rigs;
pub mod roads;
pub mod signals;

use strut_model::Entry;

/// Standard acceleration of gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// All models.
pub const CATALOGUE: &[Entry] = &[
    Entry::of::<rigs::QuarterCar>(),
    Entry::of::<actuators::LinearMotor>(),
    Entry::of::<controllers::LqrController>(),
    Entry::of::<controllers::Skyhook>(),
    Entry::of::<roads::Road>(),
    Entry::of::<roads::FourWheelRoad>(),
];

/// File name and text of each published parameter set.
pub const PARAMETER_SETS: &[(&str, &str)] = &[
    ("AjalaQuarterCar.toml", include_str!("../parameters/AjalaQuarterCar.toml")),
    ("KogutRampRoad.toml", include_str!("../parameters/KogutRampRoad.toml")),
    ("KoniecznyQuarterCar.toml", include_str!("../parameters/KoniecznyQuarterCar.toml")),
    ("KoniecznyStepRoad.toml", include_str!("../parameters/KoniecznyStepRoad.toml")),
    ("QuanserChirpRoad.toml", include_str!("../parameters/QuanserChirpRoad.toml")),
    ("QuanserLqrController.toml", include_str!("../parameters/QuanserLqrController.toml")),
    ("QuanserQuarterCar.toml", include_str!("../parameters/QuanserQuarterCar.toml")),
    ("QuanserRoad.toml", include_str!("../parameters/QuanserRoad.toml")),
    ("QuanserTable31QuarterCar.toml", include_str!("../parameters/QuanserTable31QuarterCar.toml")),
    ("RecordedRoad.toml", include_str!("../parameters/RecordedRoad.toml")),
    ("TumLinearMeasuredQuarterCar.toml", include_str!("../parameters/TumLinearMeasuredQuarterCar.toml")),
    ("TumLinearOptimisedQuarterCar.toml", include_str!("../parameters/TumLinearOptimisedQuarterCar.toml")),
    ("TumQuarterVehicle.toml", include_str!("../parameters/TumQuarterVehicle.toml")),
    ("TumRoad.toml", include_str!("../parameters/TumRoad.toml")),
    ("TumSkyhook.toml", include_str!("../parameters/TumSkyhook.toml")),
    (
        "TumTable7MeasuredQuarterVehicle.toml",
        include_str!("../parameters/TumTable7MeasuredQuarterVehicle.toml"),
    ),
    (
        "TumTable7OptimisedQuarterVehicle.toml",
        include_str!("../parameters/TumTable7OptimisedQuarterVehicle.toml"),
    ),
];

/// File name and text of each composition of components to a system.
pub const SYSTEMS: &[(&str, &str)] = &[
    ("quanser-lqr.toml", include_str!("../systems/quanser-lqr.toml")),
    ("tum-active.toml", include_str!("../systems/tum-active.toml")),
];
