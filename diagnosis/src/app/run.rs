//! From the command line to the report.

use std::cell::OnceCell;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use strut_model::ParameterSet;

use crate::app::cli::{Arguments, Command, DiagnosisArguments, SimulateArguments};
use crate::app::virtual_rig::{self, Experiment};
use crate::catalogue::{self, naming};
use crate::data::map::Map;
use crate::data::table::did_you_mean;
use crate::dataset::import::{Loaded, load};
use crate::dataset::recorded::Recorded;
use crate::dataset::split::Records;
use crate::dataset::witness;
use crate::diagnosis::Options;
use crate::estimation::deadline::{Deadline, Stage};
use crate::experiment::Limits;
use crate::plausibility;
use crate::report;
use crate::report::file::replace;
use crate::report::findings::{DataProblem, Findings};
use crate::rig::Rig;

/// Time between two samples of a virtual rig's record in seconds.
const STEP: f64 = 1e-3;
/// Length of a virtual rig's record in seconds.
const LENGTH: f64 = 20.0;

/// How often stretches are made shorter over which a model that drifts is compared.
const SHORTER: usize = 2;

/// Does what the command line says; failures are told on stderr.
///
/// The exit code is 0, 1 after a failure, and 2 if the command line was not understood.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match (&arguments.command, &arguments.diagnosis) {
        (Some(Command::Simulate(arguments)), _) => simulate(arguments),
        (Some(Command::Rigs { name: None }), _) => {
            tell(&format!("{}\n", Rig::names().join("\n")));
            Ok(())
        }
        (Some(Command::Rigs { name: Some(name) }), _) => {
            Rig::published(name).map(|rig| tell(&report::sheet(&rig)))
        }
        (Some(Command::Effects), _) => {
            tell(&catalogue::page());
            Ok(())
        }
        (None, Some(arguments)) => run(arguments),
        (None, None) => Err("nothing to do: run with --help".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints; whoever closed the pipe has read enough.
fn tell(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

fn run(arguments: &DiagnosisArguments) -> Result<(), String> {
    let clock = Instant::now();
    if let Some(jobs) = arguments.jobs {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.max(1)).build_global();
        pool.map_err(|error| format!("cannot start {jobs} threads: {error}"))?;
    }
    // A diagnosis takes a while: what would not be written is told at once.
    if arguments.out.exists() && !arguments.out.is_dir() {
        return Err(format!(
            "`{}` is a file: choose a folder for the report with --out",
            arguments.out.display()
        ));
    }
    let mut rig = rig(arguments)?;
    let known = arguments.known.iter().map(|text| known(&rig, text)).collect::<Result<Vec<_>, _>>()?;
    let numbers = naming::numbers(&rig.plant);
    if let Some(wrong) = arguments.effects.iter().find(|it| !numbers.contains(it)) {
        return Err(format!("--effects {wrong}: {} has the effects {}", rig.name, numbers.join(", ")));
    }
    let map = match &arguments.map {
        None => Map::default(),
        Some(path) => Map::parse(&read(path)?).map_err(|error| format!("{}: {error}", path.display()))?,
    };
    let paths: Vec<&Path> = arguments.train.iter().chain(&arguments.test).map(PathBuf::as_path).collect();
    let Loaded { mut records, mut problems } = load(&mut rig, &paths, &map)?;
    refuse(&rig, arguments, &problems)?;
    let test: Vec<Recorded> = records.split_off(arguments.train.len());
    problems.extend(witness::notes(&records, &test));
    eprintln!("time limit {} s (--time-limit)", arguments.time_limit);
    let deadline = Deadline::after(Duration::from_secs(arguments.time_limit));
    let options = Options { known, only: arguments.effects.clone(), deadline };
    let bar = ProgressBar::new_spinner()
        .with_style(ProgressStyle::with_template("{spinner} {elapsed}  {msg}").expect("a valid template"));
    bar.enable_steady_tick(Duration::from_millis(100));
    let progress = |text: &str| bar.set_message(text.to_owned());
    bar.set_message("taking the noise off the inputs");
    let whole = Records::new(&records, test);
    bar.set_message("comparing each column with the model");
    problems.extend(plausibility::problems(&rig, &whole, &options)?);
    refuse(&rig, arguments, &problems)?;
    let mut diagnosis = whole.diagnosed(&rig, options.clone(), &progress)?;
    let shorter = [const { OnceCell::new() }; SHORTER];
    let mut last = &whole;
    for cell in &shorter {
        if !diagnosis.is_lost() {
            break;
        }
        let Some(parts) = last.in_parts(&rig) else { break };
        if diagnosis.world.deadline.is_over(Stage::Segments) {
            break;
        }
        last = cell.get_or_init(|| parts);
        bar.set_message("comparing over shorter stretches");
        let options = Options { deadline: options.deadline.again(), ..options.clone() };
        let again = last.diagnosed(&rig, options, &progress)?;
        if !again.is_lost() {
            problems.push(last.note());
            diagnosis = again;
        }
    }
    bar.set_message("comparing experiments that separate the rivals");
    let limits = Limits {
        stroke: arguments.stroke,
        force: arguments.force,
        rate: arguments.rate,
        duration: arguments.duration,
        bandwidth: arguments.bandwidth,
    };
    let deciding = diagnosis.deciding_experiment(limits).unwrap_or_else(|error| {
        problems.push(DataProblem {
            record: "all".into(),
            signal: "experiment".into(),
            text: format!("no experiment is computed: {error}"),
            fatal: false,
        });
        None
    });
    bar.set_message("writing the report");
    let mut findings = diagnosis.findings(problems, clock.elapsed().as_secs_f64());
    if let Some(deciding) = deciding {
        findings.decide(deciding);
    }
    report::write(&findings, &arguments.out).map_err(|error| error.to_string())?;
    bar.set_message("building the extended model");
    diagnosis.write_extended(&arguments.out, !arguments.no_fmu)?;
    bar.finish_and_clear();
    tell(&report::terminal(&findings));
    tell(&format!("\nreport: {}\n", arguments.out.join("report.html").display()));
    Ok(())
}

/// Reports data that cannot be used, if they cannot.
fn refuse(rig: &Rig, arguments: &DiagnosisArguments, problems: &[DataProblem]) -> Result<(), String> {
    let Some(fatal) = problems.iter().find(|problem| problem.fatal) else { return Ok(()) };
    let text = format!("{}, {}: {}", fatal.record, fatal.signal, fatal.text);
    let (train, test) = (names(&arguments.train), names(&arguments.test));
    let findings = Findings::of_bad_data(&rig.name, train, test, problems.to_vec());
    report::write(&findings, &arguments.out).map_err(|error| error.to_string())?;
    tell(&report::terminal(&findings));
    let page = arguments.out.join("report.html");
    Err(format!("the data cannot be used; {text}; the whole list: {}", page.display()))
}

fn rig(arguments: &DiagnosisArguments) -> Result<Rig, String> {
    match (&arguments.parameters, &arguments.rig) {
        (Some(path), name) => {
            let set =
                ParameterSet::parse(&read(path)?).map_err(|error| format!("{}: {error}", path.display()))?;
            let mut rig = Rig::of(&set).map_err(|error| format!("{}: {error}", path.display()))?;
            if let Some(name) = name {
                let named = Rig::published(name)?;
                if named.plant.name != rig.plant.name {
                    return Err(format!(
                        "`{}` is a set for a {}, and the rig {name} is a {}",
                        path.display(),
                        rig.plant.name,
                        named.plant.name
                    ));
                }
                rig.name.clone_from(name);
            }
            Ok(rig)
        }
        (None, Some(name)) => Rig::published(name),
        (None, None) => Err(format!("which rig? Give --rig with one of {}", Rig::names().join(", "))),
    }
}

/// `sprung_mass=94.4±0.5`, or with `+-`.
fn known(rig: &Rig, text: &str) -> Result<(usize, f64, f64), String> {
    let wrong = || format!("--known {text}: write NAME=VALUE±DEVIATION, as in sprung_mass=94.4±0.5");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let (value, deviation) = value.split_once('±').or_else(|| value.split_once("+-")).ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    let (value, deviation) = (number(value)?, number(deviation)?);
    let index = rig
        .base()
        .into_iter()
        .find(|index| rig.plant.parameters[*index].name == name.trim())
        .ok_or_else(|| {
            let names = rig.base().into_iter().map(|index| rig.plant.parameters[index].name.as_str());
            let hint = did_you_mean(name.trim(), names);
            format!("--known {text}: {} has no parameter `{}` that is fitted{hint}", rig.name, name.trim())
        })?;
    if !value.is_finite() || !deviation.is_finite() || deviation <= 0.0 {
        return Err(format!("--known {text}: the value has to be finite, its deviation finite and positive"));
    }
    let declared = &rig.plant.parameters[index];
    let below = declared.min.filter(|least| value < *least).map(|least| format!("at least {least}"));
    let above = declared.max.filter(|most| value > *most).map(|most| format!("at most {most}"));
    if let Some(bound) = below.or(above) {
        let unit = declared.unit.symbol;
        return Err(format!("--known {text}: {} has to be {bound} {unit}", declared.name));
    }
    Ok((index, value, deviation))
}

fn simulate(arguments: &SimulateArguments) -> Result<(), String> {
    let rig = Rig::published(&arguments.rig)?;
    let hidden = arguments.hide.iter().map(|text| hidden(&rig, text)).collect::<Result<Vec<_>, _>>()?;
    if !arguments.noise.is_finite() || arguments.noise < 0.0 {
        return Err(format!(
            "--noise {}: the share of a signal has to be finite and not negative",
            arguments.noise
        ));
    }
    let experiment =
        Experiment { hidden, noise: arguments.noise, seed: arguments.seed, step: STEP, length: LENGTH };
    // All of them first: a mistake leaves nothing behind.
    let records = [(1, "train.csv"), (2, "test.csv")]
        .map(|(number, name)| virtual_rig::record(&rig, &experiment, number).map(|text| (name, text)));
    let records = records.into_iter().collect::<Result<Vec<_>, _>>()?;
    fs::create_dir_all(&arguments.out)
        .map_err(|error| format!("cannot make the folder `{}`: {error}", arguments.out.display()))?;
    for (name, text) in records {
        let path = arguments.out.join(name);
        replace(&path, &text).map_err(|error| format!("cannot write `{}`: {error}", path.display()))?;
        tell(&format!("{}\n", path.display()));
    }
    Ok(())
}

/// `strut.coulomb.force=60`.
fn hidden(rig: &Rig, text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("--hide {text}: write NAME=VALUE, as in strut.coulomb.force=60");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let (name, value) = (name.trim(), value.trim().parse::<f64>().map_err(|_| wrong())?);
    let index = rig.plant.parameter(name).ok_or_else(|| {
        let hint = did_you_mean(name, rig.plant.parameters.iter().map(|it| it.name.as_str()));
        format!("--hide {text}: {} has no parameter `{name}`{hint}", rig.name)
    })?;
    let declared = &rig.plant.parameters[index];
    let (low, high) = (declared.min.unwrap_or(f64::MIN), declared.max.unwrap_or(f64::MAX));
    if !(low..=high).contains(&value) {
        let unit = declared.unit.symbol;
        let limits = match (declared.min, declared.max) {
            (Some(low), Some(high)) => format!("from {low} to {high} {unit}"),
            (Some(low), None) => format!("at least {low} {unit}"),
            (None, Some(high)) => format!("at most {high} {unit}"),
            (None, None) => "finite".into(),
        };
        return Err(format!("--hide {text}: {name} has to be {limits}"));
    }
    Ok((name.to_owned(), value))
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))
}

fn names(paths: &[PathBuf]) -> Vec<String> {
    paths.iter().map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned()).collect()
}
