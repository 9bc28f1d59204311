//! What turns a command into a force.

mod eccentric_drive;
mod excitation_motor;
mod linear_motor;
mod mr_rotary_brake;
mod overload;
mod pump_hydraulic_actuator;
mod pump_hydraulic_actuator_linear;
pub(crate) mod servo_hydraulic_actuator;

pub use eccentric_drive::EccentricDrive;
pub use excitation_motor::ExcitationMotor;
pub use linear_motor::LinearMotor;
pub use mr_rotary_brake::MrRotaryBrake;
pub use overload::Overload;
pub use pump_hydraulic_actuator::PumpHydraulicActuator;
pub use pump_hydraulic_actuator_linear::PumpHydraulicActuatorLinear;
pub use servo_hydraulic_actuator::ServoHydraulicActuator;
