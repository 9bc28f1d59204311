//! From measured data to a named cause, an extended model and a measured gain.
//!
//! [`data`] reads and checks records, [`dataset`] puts them on a [`rig`]'s inputs and outputs. [`diagnosis`] fits the
//! starting model ([`estimation`], [`plant`]), compares every cause of the [`catalogue`] to what is missing
//! ([`screening`]) and lets those in that pass all gates ([`search`]). [`report`] shows what comes
//! out and writes the extended model.

pub mod app;
pub mod catalogue;
pub mod confirm;
pub mod data;
pub mod dataset;
pub mod decision;
pub mod diagnosis;
pub mod estimation;
pub mod explain;
pub mod missing;
pub mod report;
pub mod rig;
pub mod screening;
pub mod signal;

pub use strut_plant as plant;
