//! The command line and the virtual rig.

pub mod cli;
pub mod run;
pub mod virtual_rig;
