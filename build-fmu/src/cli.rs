//! The command line.

use std::path::PathBuf;

use clap::Parser;

const EXAMPLES: &str = "\
Examples:
  build-fmu                                     every FMU and system into fmus/
  build-fmu QuarterCar quanser-lqr              only these
  build-fmu --list                              what there is
  build-fmu --parameters my-rig.toml            a model with your own parameter set
  build-fmu --system my-system.toml             your own composition, as an SSP
  build-fmu --manifest-path my-model/Cargo.toml your own model
  build-fmu --target x86_64-unknown-linux-gnu.2.17
                                                for any Linux since 2012, by cargo-zigbuild
  build-fmu --target x86_64-unknown-linux-gnu.2.17 --target x86_64-pc-windows-gnu
                                                Linux and Windows in each FMU

A target is installed by `rustup target add`. On a Debian machine that cannot do so, build-fmu/cross/toolchain makes a
toolchain for Windows (x86_64-pc-windows-gnu) and Linux on ARM (aarch64-unknown-linux-gnu), to be given by --cross.

In the workspace, write `cargo run --release --` for `build-fmu`.";

/// Packs models as FMUs (FMI 2.0) and systems as SSPs (SSP 1.0)
#[derive(Parser, Debug)]
#[command(name = "build-fmu", bin_name = "build-fmu", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// FMUs and systems to build [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,

    /// Folder to write to; made if it is missing
    #[arg(long, value_name = "DIR", default_value = "fmus")]
    pub out: PathBuf,

    /// Rust target to build for, several times for FMUs with several platforms [default: this machine]
    #[arg(long = "target", value_name = "TRIPLE")]
    pub targets: Vec<String>,

    /// Folder of the toolchain for targets that are not installed, as build-fmu/cross/toolchain makes it
    #[arg(long, value_name = "DIR", env = "STRUT_CROSS")]
    pub cross: Option<PathBuf>,

    /// Parameter set (TOML) to make an FMU of
    #[arg(long, value_name = "FILE")]
    pub parameters: Vec<PathBuf>,

    /// System (TOML) to make an SSP of
    #[arg(long = "system", value_name = "FILE")]
    pub systems: Vec<PathBuf>,

    /// Cargo.toml of a crate with a model of your own
    #[arg(long, value_name = "PATH")]
    pub manifest_path: Option<PathBuf>,

    /// List what can be built, and build nothing
    #[arg(long)]
    pub list: bool,
}
