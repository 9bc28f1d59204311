//! The command line.

use std::path::PathBuf;
#[cfg(feature = "tools")]
use std::time::Duration;

use clap::{Args, Parser, Subcommand};

use crate::version::Version;

const EXAMPLES: &str = "\
Examples:
  build-fmu                                     every FMU and system into fmus/
  build-fmu QuarterCar quanser-lqr              only these
  build-fmu list                                what there is
  build-fmu describe TumQuarterVehicle          its variables, equations and sources
  build-fmu check fmus/QuarterCar.fmu           whether an FMU, anyone's, is fit for other tools
  build-fmu TumQuarterVehicle --set strut.stiffness=9000 --name StiffRig
                                                with another value, under another name
  build-fmu --parameters my-rig.toml            a model with your own parameter set
  build-fmu --system my-system.toml             your own composition, as an SSP
  build-fmu new my-model                        a crate for your own model
  build-fmu --manifest-path my-model/Cargo.toml your own model
  build-fmu --fmi 3                             for FMI 3.0
  build-fmu --fmi 2 --fmi 3                     for both: FMI 3.0 in the folder fmi3 of the output
  build-fmu --target x86_64-unknown-linux-gnu.2.17
                                                for any Linux since 2012, by cargo-zigbuild
  build-fmu --target x86_64-unknown-linux-gnu.2.17 --target x86_64-pc-windows-gnu
                                                Linux and Windows in each FMU

A target is installed by `rustup target add`. On a Debian machine that cannot do so, build-fmu/cross/toolchain makes a
toolchain for Windows (x86_64-pc-windows-gnu) and Linux on ARM (aarch64-unknown-linux-gnu), to be given by --cross.

In the workspace, write `cargo run --release --` for `build-fmu`.";

const LIST_EXAMPLES: &str = "\
Examples:
  build-fmu list                                every FMU and system
  build-fmu list --json | jq -r '.[].name'      their names, for scripts
  build-fmu list --manifest-path my-model/Cargo.toml
                                                what your own crate makes";

const DESCRIBE_EXAMPLES: &str = "\
Examples:
  build-fmu describe TumQuarterVehicle          a published rig
  build-fmu describe quanser-lqr                a system: components, connections, parameters
  build-fmu describe QuarterCar --json          the same for programs
  build-fmu describe AirSpring --manifest-path examples/own-model/Cargo.toml
                                                a model of your own";

const LIBRARIES_EXAMPLES: &str = "\
Examples:
  build-fmu libraries --out libraries           for this machine
  build-fmu libraries --out libraries --target x86_64-unknown-linux-gnu.2.17 --target x86_64-pc-windows-gnu
                                                for any Linux since 2012 and for Windows
  build-fmu TumQuarterVehicle --libraries libraries
                                                an FMU of them, without cargo

The folder `libraries` beside the program, or beside its folder, is found without --libraries.";

#[cfg(feature = "tools")]
const CHECK_EXAMPLES: &str = "\
Examples:
  build-fmu check fmus/TumQuarterVehicle.fmu    one
  build-fmu check fmus/quanser-lqr.ssp          a system, and each FMU in it
  build-fmu check *.fmu --strict                several; notes on portability count too
  build-fmu check unknown.fmu --no-run          without running code of others
  build-fmu check unknown.fmu --signs           which way its outputs go when an input is raised
  build-fmu check extended.fmu --replay         whether the experiments in it come out as they state
  build-fmu check X.fmu --fmpy ~/venv/bin/python
                                                with the validation of that Python's fmpy

Exit codes: 0 nothing found, 1 problems found, 2 a file that cannot be read.";

#[cfg(feature = "tools")]
const NEW_EXAMPLES: &str = "\
Examples:
  build-fmu new my-rig                          a crate in the folder my-rig
  build-fmu new my-rig --path ~/strut           with Strut from a checkout: no network is needed

The crate needs Rust and a C linker, and Strut's sources: its crates are in no registry, so that it takes them from a
checkout or by git. `cargo test` compares the model with scipy's solution, `build-fmu --manifest-path my-rig/Cargo.toml`
makes the FMU.";

#[cfg(feature = "tools")]
const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  build-fmu completions bash > ~/.local/share/bash-completion/completions/build-fmu
  build-fmu completions zsh > ~/.zfunc/_build-fmu
  build-fmu completions fish > ~/.config/fish/completions/build-fmu.fish

Names of FMUs and systems are completed in bash and zsh; they are those of today: make the script again when there are new
ones.
It completes `build-fmu`, which `cargo install --path build-fmu` puts into the path.";

/// Packs models as FMUs (FMI 2.0, FMI 3.0) and systems as SSPs (SSP 1.0)
#[derive(Parser, Debug)]
#[command(name = "build-fmu", version = crate::VERSION, after_help = EXAMPLES)]
#[command(args_conflicts_with_subcommands = true)]
pub struct CommandLine {
    /// Subcommands
    #[command(subcommand)]
    pub command: Option<Command>,
    /// What to build.
    #[command(flatten)]
    pub build: Arguments,
}

impl CommandLine {
    /// A command without anything to build.
    pub fn of(command: Command) -> Self {
        Self { command: Some(command), build: Arguments::default() }
    }
}

/// The names of the subcommands: what a misspelt one may have been meant for.
pub const COMMANDS: &[&str] = &[
    "list",
    "describe",
    "libraries",
    #[cfg(feature = "tools")]
    "new",
    #[cfg(feature = "tools")]
    "check",
    #[cfg(feature = "tools")]
    "completions",
];

/// The subcommands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Lists the FMUs and systems that can be built
    #[command(after_help = LIST_EXAMPLES)]
    List(ListArguments),
    /// Shows an FMU's variables, equations and sources, or a system's components and connections
    #[command(after_help = DESCRIBE_EXAMPLES)]
    Describe(DescribeArguments),
    /// Checks an FMU or SSP, anyone's: description, libraries, behaviour; says what is wrong and what to do
    #[cfg(feature = "tools")]
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckArguments),
    /// Makes a crate for a model of your own, with a test against scipy
    #[cfg(feature = "tools")]
    #[command(after_help = NEW_EXAMPLES)]
    New(NewArguments),
    /// Builds the library of every model into a folder, from which FMUs are made without cargo
    #[command(after_help = LIBRARIES_EXAMPLES)]
    Libraries(LibrariesArguments),
    /// Prints a script that completes commands, options and names in a shell
    #[cfg(feature = "tools")]
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// Runs a library, for `check`: a crash ends this program and not that one
    #[cfg(feature = "tools")]
    #[command(hide = true)]
    Probe {
        /// Where the orders are and the answers go.
        folder: PathBuf,
    },
}

/// Which of them to list, and how.
#[derive(Args, Debug)]
pub struct ListArguments {
    /// FMUs and systems to list [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,

    /// The models and systems to choose from.
    #[command(flatten)]
    pub models: ModelArguments,

    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// What to describe, and how.
#[derive(Args, Debug)]
pub struct DescribeArguments {
    /// The FMU or system
    #[arg(value_name = "NAME")]
    pub name: String,

    /// The models and systems to choose from.
    #[command(flatten)]
    pub models: ModelArguments,

    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// A crate for a model of one's own.
#[cfg(feature = "tools")]
#[derive(Args, Debug)]
pub struct NewArguments {
    /// Name of the crate, also with folders before it: my-rig becomes the model MyRig
    #[arg(value_name = "NAME")]
    pub name: std::ffi::OsString,

    /// Checkout of Strut that the crate depends on [default: the one this program was built in, else the public repository]
    #[arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    pub path: Option<PathBuf>,
}

/// What to check, and how.
#[cfg(feature = "tools")]
#[derive(Args, Debug)]
pub struct CheckArguments {
    /// FMUs and SSPs to check
    #[arg(value_name = "FMU", required_unless_present = "rules", value_hint = clap::ValueHint::FilePath)]
    pub files: Vec<PathBuf>,

    /// Print the rules, section by section of the standards, as a page in Markdown
    #[arg(long, conflicts_with = "files")]
    pub rules: bool,

    /// Python with the package fmpy, for its validation [default: python3 in the path]
    #[arg(long, value_name = "PYTHON", value_hint = clap::ValueHint::ExecutablePath)]
    pub fmpy: Option<PathBuf>,

    /// Do without FMPy
    #[arg(long, conflicts_with = "fmpy")]
    pub no_fmpy: bool,

    /// Raise each input, and print which outputs rise and which fall
    #[arg(long, conflicts_with = "no_run")]
    pub signs: bool,

    /// Run the experiments that the FMU brings along (FMI-LS-REF), and compare with the errors that they state
    #[arg(long, conflicts_with = "no_run")]
    pub replay: bool,

    /// Do not load the library, so that nothing of the FMU is run
    #[arg(long)]
    pub no_run: bool,

    /// Let notes count as problems too: what is legal, but narrows where the FMU works
    #[arg(long)]
    pub strict: bool,

    /// Seconds that each call of the library may take
    #[arg(long, value_name = "SECONDS", default_value = "30", value_parser = seconds)]
    pub timeout: Duration,

    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[cfg(feature = "tools")]
fn seconds(text: &str) -> Result<Duration, String> {
    let number: f64 = text.parse().map_err(|_| "it is no number".to_owned())?;
    let some = Duration::try_from_secs_f64(number).ok().filter(|it| !it.is_zero());
    some.ok_or_else(|| "a run takes some seconds: give a number above zero".to_owned())
}

/// Models, sets and systems of your own.
#[derive(Args, Clone, Debug, Default)]
pub struct ModelArguments {
    /// Parameter set (TOML) of your own
    #[arg(long, value_name = "FILE")]
    pub parameters: Vec<PathBuf>,

    /// System (TOML) of your own
    #[arg(long = "system", value_name = "FILE")]
    pub systems: Vec<PathBuf>,

    /// Cargo.toml of a crate with a model of your own
    #[arg(long, value_name = "PATH")]
    pub manifest_path: Option<PathBuf>,
}

/// Libraries for which platforms, and where to.
#[derive(Args, Debug)]
pub struct LibrariesArguments {
    /// Folder to write to; made if it is missing
    #[arg(long, value_name = "DIR", default_value = "libraries")]
    pub out: PathBuf,

    /// Rust target to build for, several times for several platforms [default: this machine]
    #[arg(long = "target", value_name = "TRIPLE")]
    pub targets: Vec<String>,

    /// Folder of the toolchain for targets that are not installed, as build-fmu/cross/toolchain makes it
    #[arg(long, value_name = "DIR", env = "STRUT_CROSS")]
    pub cross: Option<PathBuf>,

    /// Folder of prebuilt libraries; cargo builds missing ones [env: STRUT_LIBRARIES=]
    #[arg(long, value_name = "DIR")]
    pub libraries: Option<PathBuf>,
}

/// What to build, for which platforms, and where to.
#[derive(Args, Debug, Default)]
pub struct Arguments {
    /// FMUs and systems to build [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,

    /// Folder to write to; made if it is missing
    #[arg(long, value_name = "DIR", default_value = "fmus")]
    pub out: PathBuf,

    /// Version of FMI, several times for several [default: 2]
    #[arg(long = "fmi", value_name = "VERSION")]
    pub versions: Vec<Version>,

    /// Rust target to build for, several times for FMUs with several platforms [default: this machine]
    #[arg(long = "target", value_name = "TRIPLE")]
    pub targets: Vec<String>,

    /// Folder of the toolchain for targets that are not installed, as build-fmu/cross/toolchain makes it
    #[arg(long, value_name = "DIR", env = "STRUT_CROSS")]
    pub cross: Option<PathBuf>,

    /// Value of a parameter of the FMU that is named, in its SI unit: strut.stiffness=9000
    #[arg(long, value_name = "NAME=VALUE", requires = "names")]
    pub set: Vec<String>,

    /// Name of the FMU that --set makes [default: as before]
    #[arg(long, value_name = "NAME", requires = "set")]
    pub name: Option<String>,

    /// Folder of prebuilt libraries, from `build-fmu libraries`; cargo builds missing ones [env: STRUT_LIBRARIES=]
    #[arg(long, value_name = "DIR")]
    pub libraries: Option<PathBuf>,

    /// What travels with the FMUs of `parameters`, for callers that are programs.
    #[arg(skip)]
    pub related: Option<strut_related::Files>,

    /// Parameter set (TOML) to make an FMU of
    #[arg(long, value_name = "FILE")]
    pub parameters: Vec<PathBuf>,

    /// System (TOML) to make an SSP of
    #[arg(long = "system", value_name = "FILE")]
    pub systems: Vec<PathBuf>,

    /// Cargo.toml of a crate with a model of your own
    #[arg(long, value_name = "PATH")]
    pub manifest_path: Option<PathBuf>,
}

impl ModelArguments {
    /// The arguments of a build of these names; a list of no names is that of all.
    pub fn of(&self, names: &[String]) -> Arguments {
        let Self { parameters, systems, manifest_path } = self.clone();
        Arguments { names: names.into(), parameters, systems, manifest_path, ..Arguments::default() }
    }
}
