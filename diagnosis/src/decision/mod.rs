//! Decisions as pure functions of numbers: no file, no simulation.

pub mod account;
pub mod choice;
pub mod criteria;
pub mod description;
pub mod disagreement;
pub mod evidence;
pub mod mismatch;
pub mod plausible;
pub mod rules;
pub mod verdict;
