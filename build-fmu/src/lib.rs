//! The packager: models become FMUs, compositions of them become SSPs.
//!
//! An FMU is a zip archive of a shared library, its description and its documentation. The library is
//! built by cargo; the description comes from the same declarations that the library was compiled from,
//! which are linked into this program. Nothing is loaded to be asked for its variables, so that FMUs for
//! any platform can be made on any other.
//!
//! A project hands its models to [`main`]:
//!
//! ```no_run
//! use build_fmu::{Project, Source};
//!
//! let project = Project {
//!     catalogue: strut_physics::CATALOGUE,
//!     parameter_sets: strut_physics::PARAMETER_SETS,
//!     systems: strut_physics::SYSTEMS,
//!     source: Source::Workspace { files: "fmu-src/physics/parameters/resources" },
//!     license: "MIT",
//! };
//! build_fmu::main(&project);
//! ```
//!
//! # A model of one's own
//!
//! `build-fmu --manifest-path my-model/Cargo.toml` packs a model of a crate outside this workspace. It is
//! both a shared library and a Rust library (`crate-type = ["cdylib", "rlib"]`) and ends with
//!
//! ```ignore
//! strut_fmi::export_fmu!(MyModel);
//! ```
//! which exports the functions of FMI and, for us, the constant `ENTRY` with the declarations.
//! A packager for it, a few lines long, is generated under the target folder and run: a program
//! that links the crate knows its declarations, for whatever platform the library itself is built.

mod archive;
mod cargo;
#[cfg(feature = "tools")]
mod check;
mod cli;
#[cfg(feature = "tools")]
mod completions;
mod describe;
mod documentation;
mod failure;
mod fmu;
mod foreign;
mod icon;
mod list;
mod needs;
mod plan;
mod platform;
mod plot;
mod run;
mod style;
mod system;
mod table;
mod toolchain;
mod version;

#[cfg(feature = "strut")]
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use strut_model::Entry;

/// What there is to build.
#[derive(Clone, Copy, Debug)]
pub struct Project<'a> {
    /// The models.
    pub catalogue: &'a [Entry],
    /// File name and text of each parameter set; each gives an FMU.
    pub parameter_sets: &'a [(&'a str, &'a str)],
    /// File name and text of each system.
    pub systems: &'a [(&'a str, &'a str)],
    /// Where the libraries come from.
    pub source: Source<'a>,
    /// Text of the license; its first line goes into the descriptions.
    pub license: &'a str,
}

/// Where cargo finds the libraries of models.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// In the workspace around: the library of `QuarterCar` is made by the package `fmu-quarter-car`.
    Workspace {
        /// The folder of the files that parameter sets bring, from the workspace's root.
        files: &'a str,
    },
    /// In one package.
    Package {
        /// Its manifest.
        manifest: &'a str,
        /// Its name.
        name: &'a str,
    },
}

/// Strut's own models.
#[cfg(feature = "strut")]
pub fn strut() -> Project<'static> {
    Project {
        catalogue: strut_physics::CATALOGUE,
        parameter_sets: strut_physics::PARAMETER_SETS,
        systems: strut_physics::SYSTEMS,
        source: Source::Workspace { files: "fmu-src/physics/parameters/resources" },
        license: include_str!("../../LICENSE"),
    }
}

/// Packs the FMU of a parameter set of one of Strut's models into a folder.
///
/// # Errors
/// If the set does not fit its model, or cargo cannot build the model's library: what to do.
#[cfg(feature = "strut")]
pub fn pack(project: &Project, parameters: &Path, out: &Path) -> Result<(), String> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let arguments = cli::Arguments {
        names: Vec::new(),
        out: out.into(),
        versions: Vec::new(),
        targets: Vec::new(),
        cross: None,
        parameters: vec![parameters.into()],
        systems: Vec::new(),
        manifest_path: Some(workspace),
    };
    let told = run::build(project, &arguments);
    told.and_then(|told| told.failed.map_or(Ok(()), Err)).map_err(|failure| failure.to_string())
}

/// Builds what the command line asks for; failures are told on stderr.
///
/// The exit code is 0, 1 after a failure, and 2 if the command line was not understood.
pub fn main(project: &Project) -> ExitCode {
    match run::run(project, &cli::CommandLine::parse()) {
        Ok(code) => code,
        Err(failure) => {
            anstream::eprintln!("{failure:#}");
            ExitCode::FAILURE
        }
    }
}
