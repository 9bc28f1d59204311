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
//!     literature: strut_physics::LITERATURE,
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
mod custom;
mod declared;
mod describe;
mod documentation;
mod failure;
mod fmu;
mod foreign;
mod icon;
mod libraries;
mod list;
pub mod literature;
mod needs;
#[cfg(feature = "tools")]
mod new;
mod plan;
mod platform;
mod plot;
mod prebuilt;
mod related;
mod run;
mod style;
mod system;
mod table;
mod toolchain;
#[cfg(feature = "strut")]
mod variables;
mod version;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
pub use cli::{Arguments, Command, CommandLine, DescribeArguments, ListArguments};
#[cfg(feature = "tools")]
pub use cli::{CheckArguments, NewArguments};
#[cfg(feature = "tools")]
pub use completions::with_names;
use strut_model::{Entry, ParameterSet};
#[cfg(feature = "strut")]
use strut_model::{Inputs, Trajectory};
pub use system::stated_unit;

/// The version of this program, with the commit in release builds: `0.1.0 (1a2b3c4d5e6f)`.
pub const VERSION: &str = match option_env!("STRUT_VERSION") {
    Some(version) => version,
    None => env!("CARGO_PKG_VERSION"),
};

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
    /// The documents that sources name, in BibTeX with a field a line.
    pub literature: &'a str,
}

impl Project<'_> {
    /// The files that its parameter sets bring.
    fn resources(&self) -> Vec<String> {
        let sets = self.parameter_sets.iter().filter_map(|(_, text)| ParameterSet::parse(text).ok());
        let files: std::collections::BTreeSet<String> = sets.flat_map(|set| set.files).collect();
        files.into_iter().collect()
    }
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
        literature: strut_physics::LITERATURE,
    }
}

/// One FMU or system to make.
#[cfg(feature = "strut")]
#[derive(Clone, Debug)]
pub enum Wanted<'a> {
    /// That of a parameter set in a file, with what travels with it.
    Parameters(&'a Path, strut_related::Files),
    /// That of a name, with values `NAME=VALUE` and perhaps another name.
    Values(&'a str, &'a [String], Option<&'a str>),
    /// The system of this name in a file.
    System(&'a Path, &'a str),
}

/// Makes an FMU of one of Strut's models, or a system, in a folder. `libraries` is a folder of prebuilt ones, else the one beside the
/// program; cargo builds missing ones.
///
/// # Errors
/// If the values do not fit the model, the system does not fit its components, there is neither a library nor cargo, or the
/// folder cannot be written: what to do.
#[cfg(feature = "strut")]
pub fn make(
    project: &Project,
    wanted: Wanted,
    out: &Path,
    libraries: Option<&Path>,
) -> Result<PathBuf, String> {
    let mut arguments = Arguments { out: out.into(), ..arguments(libraries) };
    let mut system = None;
    match wanted {
        Wanted::System(path, name) => {
            arguments.systems.push(path.into());
            system = Some(name);
        }
        Wanted::Parameters(path, related) => {
            arguments.parameters.push(path.into());
            arguments.related = Some(related);
        }
        Wanted::Values(fmu, values, name) => {
            arguments.names.push(fmu.into());
            arguments.set = values.into();
            arguments.name = name.map(Into::into);
        }
    }
    let told = run::build(project, &arguments).map_err(|failure| failure.to_string())?;
    if let Some(name) = system {
        return Ok(out.join(format!("{name}.ssp")));
    }
    let [name] = &told.fmus[..] else { unreachable!("one was asked for") };
    Ok(out.join(format!("{name}.fmu")))
}

/// Makes the FMU of a model in a crate of one's own, below the crate's target folder; its path. Cargo compiles what has changed.
///
/// # Errors
/// If there is no such crate, it is none with a model of Strut's, or it cannot be compiled: what to do.
pub fn make_own(manifest: &Path) -> Result<PathBuf, String> {
    let package = foreign::package(manifest).map_err(|failure| failure.to_string())?;
    let package =
        package.ok_or_else(|| format!("`{}` is a part of Strut: name its model", manifest.display()))?;
    package.fmu().map_err(|failure| failure.to_string())
}

/// All FMUs and systems in JSON, as `build-fmu list --json` prints them.
///
/// # Errors
/// If there is neither a folder of libraries nor a workspace.
#[cfg(feature = "strut")]
pub fn list(project: &Project, libraries: Option<&Path>) -> Result<String, String> {
    let plan = run::plan(project, &arguments(libraries));
    plan.and_then(|plan| list::text(&plan, true)).map_err(|failure| failure.to_string())
}

/// Variables, equations and sources of an FMU, or a system's components and connections, in JSON, as
/// `build-fmu describe --json` prints them.
///
/// # Errors
/// If there is none of this name.
#[cfg(feature = "strut")]
pub fn describe(project: &Project, name: &str, libraries: Option<&Path>) -> Result<String, String> {
    let plan = run::plan(project, &arguments(libraries));
    plan.and_then(|plan| describe::text(&plan, name, true)).map_err(|failure| failure.to_string())
}

/// The variables of all FMUs as pages in Markdown, each with its file's name.
///
/// # Errors
/// If a parameter set does not fit its model.
#[cfg(feature = "strut")]
pub fn variables(project: &Project) -> Result<Vec<(String, String)>, String> {
    let plan = run::plan(project, &arguments(None));
    let works = literature::works(project.literature);
    plan.and_then(|plan| variables::pages(&plan, &works)).map_err(|failure| failure.to_string())
}

/// Simulates an FMU's model with values `NAME=VALUE`, in this process: its driven inputs and all outputs. What is not given
/// is that of its default experiment: the inputs, and step and stop time in seconds.
///
/// # Errors
/// If there is no such FMU, a value or an input does not fit it, or the integration fails.
#[cfg(feature = "strut")]
pub fn simulate(
    project: &Project,
    (name, values): (&str, &[String]),
    inputs: Option<&Inputs>,
    [step, stop]: [Option<f64>; 2],
    libraries: Option<&Path>,
) -> Result<Trajectory, String> {
    let arguments = Arguments { names: vec![name.into()], set: values.into(), ..arguments(libraries) };
    let plan = run::plan(project, &arguments).map_err(|failure| failure.to_string())?;
    let [index] = plan.wanted[..] else { return Err(plan.unknown(name).to_string()) };
    let experiment = plan.fmus[index].entry.about.experiment;
    let times = [step.unwrap_or(experiment.step), stop.unwrap_or(experiment.stop)];
    plan.fmus[index].simulate(inputs, times).map_err(|failure| failure.to_string())
}

/// Of all that there is; an installed program has no workspace.
#[cfg(feature = "strut")]
fn arguments(libraries: Option<&Path>) -> Arguments {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    Arguments {
        libraries: libraries.map(Into::into),
        manifest_path: Some(workspace).filter(|manifest| manifest.exists()),
        ..Arguments::default()
    }
}

/// The names of the FMUs and systems of a project: those of its published files, whatever folder it is asked in.
#[cfg(all(feature = "strut", feature = "tools"))]
pub fn names(project: &Project) -> Vec<String> {
    run::plan(project, &arguments(None)).map_or_else(|_| Vec::new(), |plan| completions::names(&plan))
}

/// Builds what the command line asks for; failures are told on stderr.
///
/// The exit code is 0, 1 after a failure, and 2 if the command line was not understood.
pub fn main(project: &Project) -> ExitCode {
    run(project, &CommandLine::parse())
}

/// Runs a command line; failures are printed on stderr.
pub fn run(project: &Project, line: &CommandLine) -> ExitCode {
    match run::run(project, line) {
        Ok(code) => code,
        Err(failure) => {
            anstream::eprintln!("{failure:#}");
            ExitCode::FAILURE
        }
    }
}
