//! The diagnosis as a library and as a program.

mod blind;
mod certified;
mod coil;
mod common;
mod data_files;
mod drive;
mod experiment;
mod finer_motion;
mod foreign;
mod hidden_motion;
mod invariance;
mod nist;
mod nist_sets;
mod plants;
mod plausibility;
mod presliding;
mod program;
mod report;
mod search;
#[path = "common/drive.rs"]
mod simulated;
