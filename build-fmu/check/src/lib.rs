//! Finds out whether an FMU (FMI 2.0) is fit for other people's tools, whoever made it.
//!
//! The description is read, the libraries' files are looked into, and the library for this machine is run in
//! processes of their own, so that a crash is a finding and not an end. What is found is said in plain
//! sentences, with what to do.

mod behaviour;
mod description;
mod finding;
mod fmpy;
pub mod functions;
mod libraries;
mod names;
mod package;
mod probe;
mod structure;
mod variables;

use std::path::{Path, PathBuf};
use std::time::Duration;

pub use finding::{Finding, Level, Report};
pub use fmpy::Fmpy;
pub use probe::probe;

use description::{Description, Kind};
use finding::count;

/// How to check.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where FMPy is.
    pub fmpy: Fmpy,
    /// Whether the library is run.
    pub run: bool,
    /// How long each run may take.
    pub timeout: Duration,
    /// The program that calls [`probe`], with its arguments before the folder.
    pub program: Vec<PathBuf>,
}

/// Checks an FMU.
///
/// # Errors
/// If it cannot be read, or there is nothing to check it by.
pub fn check(file: &Path, options: &Options) -> Result<Report, String> {
    let mut package = package::Package::open(file)?;
    let text = package
        .read("modelDescription.xml")?
        .ok_or_else(|| "there is no modelDescription.xml at the root of the archive".to_owned())?;
    let text =
        String::from_utf8(text).map_err(|_| "modelDescription.xml is not encoded in UTF-8".to_owned())?;
    // A mark of the byte order is no part of the text.
    let description = Description::parse(text.trim_start_matches('\u{feff}'))?;
    let mut report = Report { findings: package.findings(), ..Report::default() };
    report.about = about(&description);
    if description.version != "2.0" {
        let version = &description.version;
        report.skipped.push(format!("the rules for FMI 2.0 and running it: this is FMI {version}"));
        return if fmpy::validate(file, &options.fmpy, &mut report)? {
            Ok(report)
        } else {
            Err(format!(
                "this is FMI {version}; only FMPy could check it, and there is none (name a Python with --fmpy)"
            ))
        };
    }
    report.findings.extend(variables::findings(&description));
    report.findings.extend(structure::findings(&description));
    report.done.push(format!(
        "description: {}, model structure, units, start values",
        count(description.variables.len(), "variable")
    ));
    let (found, platforms) = libraries::findings(&mut package, &description)?;
    report.findings.extend(found);
    if !platforms.is_empty() {
        report.about.push(platforms.join(", "));
        report.done.push(format!("libraries: {}", platforms.join(", ")));
    }
    if options.run {
        let failed = |error: std::io::Error| format!("there is no folder to unpack to: {error}");
        let folder = tempfile::tempdir().map_err(failed)?;
        let (plain, odd) = (folder.path().join("fmu"), folder.path().join("100 % Räder (Kopie)"));
        for path in [&plain, &odd] {
            std::fs::create_dir(path).map_err(failed)?;
            package.unpack(path)?;
        }
        let unpacked = behaviour::Unpacked { plain: &plain, odd: &odd };
        let probe = probe::Probe { program: options.program.clone(), timeout: options.timeout };
        behaviour::run(&description, &unpacked, &probe, &mut report)?;
    } else {
        report.skipped.push("running it: not wanted".into());
    }
    fmpy::validate(file, &options.fmpy, &mut report)?;
    // The worst first; within a level in the order of the archive.
    report.findings.sort_by_key(|finding| finding.level);
    // What both interfaces do wrong is said once.
    let mut said: Vec<Finding> = Vec::new();
    report.findings.retain(|finding| {
        let new = !said.contains(finding);
        if new {
            said.push(finding.clone());
        }
        new
    });
    Ok(report)
}

fn about(description: &Description) -> Vec<String> {
    let kinds: Vec<&str> = description
        .interfaces
        .iter()
        .map(|interface| match interface.kind {
            Kind::CoSimulation => "co-simulation",
            Kind::ModelExchange => "model exchange",
        })
        .collect();
    let of = |causality: &str| description.variables.iter().filter(|it| it.causality == causality).count();
    let mut about =
        vec![format!("FMI {} {}", description.version, kinds.join(" and ")).trim_end().to_owned()];
    // Other versions declare their variables in other ways.
    if description.version == "2.0" {
        about.push(format!("{}, {}", count(of("input"), "input"), count(of("output"), "output")));
    }
    about
}
