//! The integrators on textbook problems.

mod accuracy;
mod allocation;
mod common;
mod contract;
mod failures;
mod properties;
