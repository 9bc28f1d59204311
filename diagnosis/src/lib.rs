//! From measured data to a named cause, an extended model and a measured gain.
//!
//! [`data`] reads and checks records; [`findings`] is what comes out.

pub mod assembly;
pub mod catalogue;
pub mod correction;
pub mod data;
pub mod diagnosis;
pub mod findings;
pub mod fit;
pub mod hypothesis;
pub mod lsq;
pub mod naming;
pub mod plant;
pub mod recorded;
pub mod rig;
pub mod screening;
pub mod search;
pub mod whitening;
