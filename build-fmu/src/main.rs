//! Packs the models of Strut as FMUs and its systems as SSPs.

use std::process::ExitCode;

fn main() -> ExitCode {
    build_fmu::main(&build_fmu::strut())
}
