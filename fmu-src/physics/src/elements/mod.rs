//! Elements between masses: the textbook law with the effects that may sit on it.

mod actuation;
mod anti_roll_bar;
mod control;
mod corner;
mod guide;
mod hydraulics;
mod hysteresis;
mod mode;
mod pneumatics;
mod servo_cylinder;
mod strut;
mod tire;
mod valve;

pub use actuation::{Actuation, ActuationState};
pub use anti_roll_bar::AntiRollBar;
pub use control::{Control, ControlState};
pub use corner::{Corner, Moving};
pub use guide::{DriveGuide, Guide, WheelGuide};
pub use hydraulics::{Gas, Piston, PistonWithPreload, Pump, PumpWithLosses};
pub use hysteresis::{Hysteresis, HysteresisState};
pub use mode::Mode;
pub(crate) use pneumatics::AMBIENT_PRESSURE;
pub use pneumatics::{AirFlows, PneumaticServo, Pressures};
pub use servo_cylinder::{
    Cylinder, Flow, Fluid, Hydraulics, ServoCylinder, ServoValve, Spool, Supply, ValveLaw,
};
pub use strut::Strut;
pub use tire::{Load, Tire};
pub use valve::{Valve, Valves};
