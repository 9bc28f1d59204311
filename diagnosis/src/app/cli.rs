//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::diagnosis::component::Component;

const EXAMPLES: &str = "\
Examples:
  diagnose rigs tum-quarter-vehicle   what its records may hold: names, units, and what is looked for in them
  diagnose simulate --hide strut.coulomb.force=60 --out records
                                      records of a virtual rig with friction hidden in it
  diagnose --rig tum-linear-measured-quarter-car --train records/train.csv --test records/test.csv --out report
                                      what the model lacks, where, and how much of the error it explains

In the workspace, write `cargo run --release --package strut-diagnosis --` for `diagnose`.";

const SIMULATE_EXAMPLES: &str = "\
Examples:
  diagnose simulate --hide strut.coulomb.force=60
                                      60 N of friction; records/train.csv and records/test.csv
  diagnose simulate --rig tum-quarter-vehicle --hide strut.stiffness=10000 --duration 60 --sample-rate 500
                                      a stiffer spring, a minute at 500 Hz
  diagnose simulate --hide body.acceleration.gain=0.05 --hide body.acceleration.delay=0.002 --amplitude 0.5
                                      a sensor that shows 5 % too much, 2 ms late, on half the road

`diagnose rigs NAME` lists the parameters for --hide. Each signal has the distortions gain, offset, drift, lag, delay, quadratic,
cubic, rate and limit.";

const RIGS_EXAMPLES: &str = "\
Examples:
  diagnose rigs                       the rigs with their models
  diagnose rigs tum-quarter-vehicle   its signals, nominal parameters and effects
  diagnose rigs my-rig.toml           the same of a rig file";

const NEW_RIG_EXAMPLES: &str = "\
Examples:
  diagnose new-rig Quarter.fmu        quarter.toml: parameters to fit, a guess of the strut, all signals
  diagnose new-rig tum-quarter-vehicle --out mine.toml
                                      the library's rig, to be changed

Guesses from names and units are marked GUESS in the file. Check them, then run `diagnose check FILE`.";

const CHECK_EXAMPLES: &str = "\
Examples:
  diagnose check quarter.toml         columns, places, effects and parameters, or everything that is wrong in the file";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  diagnose completions bash > ~/.local/share/bash-completion/completions/diagnose
  diagnose completions zsh > ~/.zfunc/_diagnose
  diagnose completions fish > ~/.config/fish/completions/diagnose.fish

Names of rigs are completed in bash and zsh.";

/// Finds out what a simulation gets wrong, from measured data
#[derive(Parser, Debug)]
#[command(name = "diagnose", version = build_fmu::VERSION, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    /// Subcommands
    #[command(subcommand)]
    pub command: Option<Command>,
    /// The diagnosis.
    #[command(flatten)]
    pub diagnosis: Option<DiagnosisArguments>,
}

/// What else there is to do.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Makes records of a virtual rig, to try the diagnosis with
    #[command(after_help = SIMULATE_EXAMPLES)]
    Simulate(SimulateArguments),
    /// Lists the rigs, or the signals, parameters and effects of one
    #[command(after_help = RIGS_EXAMPLES)]
    Rigs {
        /// The rig, e.g. tum-quarter-vehicle, or a rig file: my-rig.toml
        #[arg(value_name = "NAME|FILE")]
        name: Option<String>,
    },
    /// Drafts a rig file of an FMU, of a crate with a model, or of a rig of the library
    #[command(after_help = NEW_RIG_EXAMPLES)]
    NewRig {
        /// An FMU for FMI 2.0 model exchange: model.fmu; the Cargo.toml of a crate with a model of your own; or a rig of the
        /// library (`diagnose rigs` lists them)
        #[arg(value_name = "FMU|CRATE|NAME")]
        model: String,
        /// The rig file, which must not exist yet [default: the model's name with .toml, in this folder]
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Checks a rig file, and says what can be identified with it and from which columns
    #[command(after_help = CHECK_EXAMPLES)]
    Check {
        /// The rig file: my-rig.toml
        file: PathBuf,
    },
    /// Prints the catalogue of effects as a page in Markdown: laws, parameters, literature, experiments
    Effects,
    /// Prints a script that completes commands, options and rigs in a shell
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
}

/// A diagnosis.
#[derive(Args, Debug)]
pub struct DiagnosisArguments {
    /// The rig, e.g. tum-quarter-vehicle (`diagnose rigs` lists them), or a rig file: my-rig.toml
    #[arg(long, value_name = "NAME|FILE")]
    pub rig: Option<String>,

    /// Parameter set (TOML) of the starting model, in place of a rig's
    #[arg(long, value_name = "FILE")]
    pub parameters: Option<PathBuf>,

    /// Estimation record; several times for several
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    pub train: Vec<PathBuf>,

    /// Validation record, of another excitation; several times for several
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    pub test: Vec<PathBuf>,

    /// Names, units, signs and delays of the records' columns (TOML)
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,

    /// Samples per second of records without a column of time
    #[arg(long, value_name = "HZ", value_parser = positive)]
    pub sampling_rate: Option<f64>,

    /// Lines above the row that names the columns, where that row is not found
    #[arg(long, value_name = "LINES")]
    pub skip_rows: Option<usize>,

    /// Independently measured parameter with its standard deviation: sprung_mass=94.4±0.5
    #[arg(long, value_name = "NAME=VALUE±DEVIATION")]
    pub known: Vec<String>,

    /// Only these effects, by their numbers in the catalogue: 01,04
    #[arg(long, value_delimiter = ',', value_name = "NUMBER")]
    pub effects: Vec<String>,

    /// Largest stroke of a deciding experiment in m, or rad of a pivot [default: as in the records]
    #[arg(long, value_name = "M", value_parser = positive)]
    pub stroke: Option<f64>,

    /// Largest force of a deciding experiment in N, or N.m of a torque [default: as in the records]
    #[arg(long, value_name = "N", value_parser = positive)]
    pub force: Option<f64>,

    /// Largest rate of the road or motion in a deciding experiment in m/s [default: as in the records]
    #[arg(long, value_name = "M/S", value_parser = positive)]
    pub rate: Option<f64>,

    /// Highest frequency of a deciding experiment in Hz [default: the rig's usual one]
    #[arg(long, value_name = "HZ", value_parser = positive)]
    pub bandwidth: Option<f64>,

    /// Duration of a deciding experiment in s [default: as the records, at most 20 s]
    #[arg(long, value_name = "S", value_parser = positive)]
    pub duration: Option<f64>,

    /// Leave a component of the method out, to measure its contribution
    #[arg(long, value_enum, value_name = "COMPONENT", hide = true)]
    pub without: Option<Component>,

    /// Folder for the report and the extended model; made if it is missing
    #[arg(long, value_name = "DIR", default_value = "report")]
    pub out: PathBuf,

    /// Threads [default: one for each core]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,

    /// Time after which the best answer so far is reported, in seconds; extended.fmu is built afterwards
    #[arg(long, value_name = "SECONDS", default_value_t = 600)]
    pub time_limit: u64,

    /// Folder of prebuilt libraries for extended.fmu, from `build-fmu libraries` [env: STRUT_LIBRARIES=]
    #[arg(long, value_name = "DIR")]
    pub libraries: Option<PathBuf>,

    /// Do not build extended.fmu or augmented.ssp
    #[arg(long)]
    pub no_fmu: bool,

    /// Leave the part of a validation record out of extended.fmu, and write no augmented.ssp
    #[arg(long)]
    pub no_record: bool,
}

/// A virtual rig.
#[derive(Args, Debug)]
pub struct SimulateArguments {
    /// The rig (`diagnose rigs` lists them), or a rig file
    #[arg(long, value_name = "NAME|FILE", default_value = "tum-linear-measured-quarter-car")]
    pub rig: String,

    /// A parameter that differs from the rig's, or the distortion of a sensor, in SI units; several times for several
    #[arg(long, value_name = "NAME=VALUE")]
    pub hide: Vec<String>,

    /// Duration of each record in s
    #[arg(long, value_name = "S", default_value_t = 20.0, value_parser = positive)]
    pub duration: f64,

    /// Samples per second in Hz
    #[arg(long, value_name = "HZ", default_value_t = 1000.0, value_parser = positive)]
    pub sample_rate: f64,

    /// Size of the excitation, relative to the rig's usual one
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub amplitude: f64,

    /// Standard deviation of the noise, relative to the root mean square of each signal
    #[arg(long, value_name = "SHARE", default_value_t = 0.01)]
    pub noise: f64,

    /// Seed of phases and noise: the same seed gives the same records
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,

    /// Folder for train.csv and test.csv; made if it is missing
    #[arg(long, value_name = "DIR", default_value = "records")]
    pub out: PathBuf,
}

/// A limit of an experiment.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|it| it.is_finite() && *it > 0.0);
    number.ok_or_else(|| "write a positive number in SI units".into())
}
