//! What turns measurements into a command.

mod lqr;
mod riccati;
mod skyhook;

pub use lqr::LqrController;
pub use skyhook::Skyhook;
