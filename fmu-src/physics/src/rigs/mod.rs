//! Plants: masses and what holds them together.

mod element_dyno;
mod full_car;
mod linear_drive;
mod pneumatic_cylinder;
mod quarter_car;
mod rotary_drive;
mod sas_rig;
mod servo_suspension;
mod servo_suspension_identified;
mod sprung_mass;

pub use element_dyno::ElementDyno;
pub use full_car::FullCar;
pub use linear_drive::LinearDrive;
pub use pneumatic_cylinder::PneumaticCylinder;
pub use quarter_car::QuarterCar;
pub use rotary_drive::RotaryDrive;
pub use sas_rig::{SasRig, SpringLever};
pub use servo_suspension::ServoSuspension;
pub use servo_suspension_identified::ServoSuspensionIdentified;
pub use sprung_mass::SprungMass;
