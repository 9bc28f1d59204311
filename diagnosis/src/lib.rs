//! From measured data to a named cause, an extended model and a measured gain.
//!
//! [`data`] reads and checks records; [`findings`] is what comes out, and [`report`] shows it.

pub mod data;
pub mod findings;
pub mod report;
