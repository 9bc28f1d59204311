//! The command line, the whole diagnosis that it asks for, and the virtual rig.

pub mod cli;
pub mod completions;
mod guard;
pub mod rig_file;
pub mod run;
pub mod study;
pub mod virtual_rig;
