//! From measured data to a named cause, an extended model and a measured gain.
//!
//! [`data`] reads and checks records, [`import`] puts them on a [`rig`]'s inputs and outputs. [`diagnosis`] fits the
//! starting model ([`fit`], [`lsq`], [`plant`]), compares every cause of the [`catalogue`] to what is missing
//! ([`screening`]) and lets those in that pass all gates ([`search`]). [`findings`] is what comes out, [`report`]
//! shows it, [`extend`] makes the extended model.

pub mod assembly;
pub mod catalogue;
pub mod cli;
pub mod comparison;
pub mod conditioning;
pub mod correction;
pub mod data;
pub mod diagnosis;
pub mod extend;
pub mod file;
pub mod findings;
pub mod fit;
pub mod held;
pub mod hypothesis;
pub mod import;
pub mod intervals;
pub mod lsq;
pub mod naming;
mod random;
pub mod recorded;
pub mod records;
pub mod report;
pub mod rig;
pub mod run;
pub mod screening;
pub mod search;
mod spectral;
pub mod virtual_rig;

pub use strut_plant as plant;
