//! What turns measurements into a command.

mod excitation_speed_controller;
mod filters;
mod force_pid;
mod force_two_dof;
mod force_two_dof_lpv;
mod lqr;
mod modal_skyhook;
mod riccati;
mod skyhook;

pub use excitation_speed_controller::ExcitationSpeedController;
pub use force_pid::ForcePid;
pub use force_two_dof::ForceTwoDof;
pub use force_two_dof_lpv::ForceTwoDofLpv;
pub use lqr::LqrController;
pub use modal_skyhook::ModalSkyhook;
pub use skyhook::Skyhook;
