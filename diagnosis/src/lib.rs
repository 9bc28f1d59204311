//! From measured data to an identified effect, an extended model and a measured gain.
//!
//! [`data`] reads and checks records, [`dataset`] puts them on a [`rig`]'s inputs and outputs. Their [`plausibility`] is seen
//! from one simulation. [`diagnosis`] fits the
//! starting model ([`estimation`], [`plant`]), estimates what signal is [`missing`] and where, compares the effects of the
//! [`catalogue`] and features without a name to it ([`explain`]), lets the data [`confirm`] them and makes the account and
//! the verdict ([`decision`]). Where rivals remain, an [`experiment`] is computed that separates them. [`report`] shows what
//! comes out and writes the extended model.

pub mod app;
pub mod catalogue;
pub mod confirm;
pub mod dataset;
pub mod decision;
pub mod diagnosis;
pub mod estimation;
pub mod experiment;
pub mod explain;
pub mod missing;
pub mod plausibility;
pub mod report;
pub mod rig;
pub mod screening;

pub use strut_plant as plant;
pub use strut_records as data;
pub use strut_signal as signal;
