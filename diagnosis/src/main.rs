//! The command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    strut_diagnosis::run::main()
}
