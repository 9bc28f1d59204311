//! The command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    strut_diagnosis::app::run::main()
}
