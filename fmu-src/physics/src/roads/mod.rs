//! Excitations: the height of the road under a wheel and its exact rate of change.

mod four_wheel_road;
mod iso8608;
mod profile;
mod recorded;
mod road;

pub use four_wheel_road::FourWheelRoad;
pub use iso8608::{IsoClass, IsoTrack};
pub use profile::{Course, Profile, RoadKind, Shape};
pub use recorded::Recorded;
pub use road::Road;
