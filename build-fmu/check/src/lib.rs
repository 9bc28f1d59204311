//! Finds out whether an FMU (FMI 2.0), or a system of them (SSP 1.0), is fit for other people's tools, whoever made it.
//!
//! The description is read, the libraries' files are looked into, and the library for this machine is run in
//! processes of their own, so that a crash is a finding and not an end. What is found is said in plain
//! sentences, with what to do.

mod aliases;
mod behaviour;
mod declared;
mod derivatives;
mod description;
mod finding;
mod fmpy;
mod fmu;
pub mod functions;
mod head;
mod libraries;
mod lines;
mod names;
mod package;
mod probe;
mod related;
mod rules;
mod schema;
mod structure;
mod system;
mod text;
pub mod unit;
mod variables;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What else it takes to run somebody's FMU: its archive, its description and its library.
pub mod import {
    pub use crate::behaviour::uri;
    pub use crate::description::{Description, Interface, Kind, Unknown, Variable, Version};
    pub use crate::fmu::description;
    pub use crate::libraries::{host, path as library_path};
    pub use crate::package::Package;
    pub use crate::probe::{Instance, Library, Status};
    pub use crate::unit::Unit;
}

pub use behaviour::Response;
pub use finding::{Finding, Level, Listener, Report};
pub use fmpy::Fmpy;
pub use probe::probe;
pub use rules::{Rule, page as rules_page};

use package::Package;

/// How to check.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where FMPy is.
    pub fmpy: Fmpy,
    /// Whether the library is run.
    pub run: bool,
    /// Whether the signs of the outputs' responses to a raised input are reported.
    pub signs: bool,
    /// Whether the experiments in the FMU are run again.
    pub replay: bool,
    /// How long each call of a library may take.
    pub timeout: Duration,
    /// The program that calls [`probe`], with its arguments before the folder.
    pub program: Vec<PathBuf>,
    /// Who hears of findings as they are made.
    pub listener: Option<Listener>,
}

/// Checks an FMU, or a system with the FMUs in it.
///
/// # Errors
/// If it cannot be read, or there is nothing to check it by.
pub fn check(file: &Path, options: &Options) -> Result<Report, String> {
    let mut package = Package::open(file)?;
    let has = |name: &str| package.files().any(|file| file == name);
    let mut report = match (has(system::FILE), has(fmu::FILE)) {
        (true, _) => system::check(file, &mut package, options)?,
        (false, true) => fmu::check(file, &mut package, options)?,
        (false, false) => {
            let (fmu, system) = (fmu::FILE, system::FILE);
            return Err(format!("there is neither {fmu} nor {system} at the root of the archive"));
        }
    };
    report.tell();
    // The worst first; within a level in the order of the archive.
    report.findings.sort_by_key(|finding| finding.level);
    // What both interfaces do wrong is said once.
    let mut said: HashSet<Finding> = HashSet::new();
    report.findings.retain(|finding| said.insert(finding.clone()));
    Ok(report)
}
