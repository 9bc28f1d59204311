//! What a missing signal depends on: effects with a name and features without one, compared on the same innovations.

pub mod candidates;
pub mod columns;
pub mod describe;
pub mod features;
pub mod resonance;
pub mod selection;
pub mod signal;
mod simulated;
