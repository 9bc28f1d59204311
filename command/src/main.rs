//! One command for all: `strut fmu` is `build-fmu`, `strut diagnose` is `diagnose`.

use std::path::PathBuf;
use std::process::ExitCode;

use build_fmu::{CheckArguments, CommandLine, DescribeArguments, ListArguments};
use clap::{Parser, Subcommand};
use strut_diagnosis::app::cli::Arguments as DiagnoseArguments;

const EXAMPLES: &str = "\
Examples:
  strut list                                  the FMUs and systems that there are
  strut fmu TumQuarterVehicle --set strut.stiffness=9000
                                              an FMU with another value, into fmus/
  strut check fmus/TumQuarterVehicle.fmu      whether an FMU, anyone's, is fit for other tools
  strut diagnose simulate --hide strut.coulomb.force=60 --out records
                                              records of a virtual rig with friction hidden in it
  strut diagnose --rig tum-linear-measured-quarter-car --train records/train.csv --test records/test.csv
                                              what the model lacks, where and how much, into report/

`build-fmu` is the same as `strut fmu`, and `diagnose` as `strut diagnose`.";

/// FMUs of active suspensions, and a diagnosis that finds in measured data what a model lacks
#[derive(Parser)]
#[command(name = "strut", version = build_fmu::VERSION, after_help = EXAMPLES)]
struct Strut {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Makes FMUs and systems of them (SSP)
    #[command(name = "fmu")]
    Fmu(Box<CommandLine>),
    /// Finds in measured data what a model lacks; lists rigs and effects, makes records of a virtual rig
    #[command(name = "diagnose")]
    Diagnose(Box<DiagnoseArguments>),
    /// Checks an FMU or SSP, anyone's: description, libraries, behaviour
    Check(CheckArguments),
    /// Lists the FMUs and systems that can be built
    List(ListArguments),
    /// Shows an FMU's variables, equations and sources, or a system's components and connections
    Describe(DescribeArguments),
    /// Runs a library, for `check`: a crash ends this program and not that one
    #[command(hide = true)]
    Probe {
        /// Where the orders are and the answers go.
        folder: PathBuf,
    },
}

fn main() -> ExitCode {
    let line = match Strut::parse().command {
        Command::Fmu(line) => *line,
        Command::Diagnose(arguments) => return strut_diagnosis::app::run::execute(&arguments),
        Command::Check(arguments) => CommandLine::of(build_fmu::Command::Check(arguments)),
        Command::List(arguments) => CommandLine::of(build_fmu::Command::List(arguments)),
        Command::Describe(arguments) => CommandLine::of(build_fmu::Command::Describe(arguments)),
        Command::Probe { folder } => return strut_check::probe(&folder),
    };
    build_fmu::run(&build_fmu::strut(), &line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Strut::command().debug_assert();
    }

    #[test]
    fn the_names_of_old_lead_to_the_same() {
        for line in
            ["fmu QuarterCar --out x", "fmu check a.fmu", "check a.fmu", "list --json", "diagnose rigs"]
        {
            assert!(Strut::try_parse_from(["strut"].into_iter().chain(line.split(' '))).is_ok(), "{line}");
        }
    }
}
