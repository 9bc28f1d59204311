//! A table of columns as a rig's inputs and outputs: import, conditioning, segments, witnesses.

mod columns;
pub mod conditioning;
mod driven;
mod driving;
mod import;
pub mod inverse;
pub mod load;
pub(crate) mod rate;
pub mod recorded;
pub mod split;
pub mod witness;
pub mod zero;
