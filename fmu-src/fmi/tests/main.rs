//! The C interface, called as a host calls it.

mod calls;
mod common;
mod exported;
mod fmi3;
mod logging;
mod saved_states;
mod simulation;
mod variables;
