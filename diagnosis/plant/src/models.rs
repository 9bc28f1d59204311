//! The models that can be diagnosed: their equations with derivatives are compiled here and nowhere else.

use strut_physics::actuators::{ExcitationMotor, PumpHydraulicActuator};
use strut_physics::rigs::{
    ElementDyno, FullCar, LinearDrive, PneumaticCylinder, QuarterCar, RotaryDrive, SasRig, ServoSuspension,
    SprungMass,
};

use crate::Plant;

/// The models of the library.
const ALL: [fn() -> Plant; 11] = [
    Plant::of::<QuarterCar>,
    Plant::of::<FullCar>,
    Plant::of::<SprungMass>,
    Plant::of::<ElementDyno>,
    Plant::of::<LinearDrive>,
    Plant::of::<RotaryDrive>,
    Plant::of::<PneumaticCylinder>,
    Plant::of::<ExcitationMotor>,
    Plant::of::<ServoSuspension>,
    Plant::of::<PumpHydraulicActuator>,
    Plant::of::<SasRig>,
];

/// The model of a name.
pub fn named(name: &str) -> Option<Plant> {
    ALL.iter().map(|plant| plant()).find(|plant| plant.name == name)
}
