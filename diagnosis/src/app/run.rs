//! From the command line to the report.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Once;
use std::time::Duration;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use crate::app::cli::{Arguments, Command, DiagnosisArguments, SimulateArguments};
use crate::app::guard::tell;
use crate::app::study::{self, Outcome, Progress, Study};
use crate::app::virtual_rig::{self, Experiment};
use crate::app::{completions, guard, rig_file};
use crate::catalogue;
use crate::data::Origin;
use crate::data::map::Map;
use crate::estimation::deadline::Deadline;
use crate::experiment::Limits;
use crate::report;
use crate::report::extend::Packing;
use crate::report::file::replace;
use crate::report::findings::Verdict;

/// Does what the command line says; failures are told on stderr.
///
/// The exit code is 0, 1 after a failure, and 2 if the command line was not understood.
pub fn main() -> ExitCode {
    execute(&Arguments::parse())
}

/// Runs a command line; failures are printed on stderr.
pub fn execute(arguments: &Arguments) -> ExitCode {
    if let Some(code) = guard::elsewhere(arguments) {
        return code;
    }
    let done = match (&arguments.command, &arguments.diagnosis) {
        (Some(Command::Simulate(arguments)), _) => simulate(arguments),
        (Some(Command::Rigs { name: None }), _) => {
            tell(&report::rigs());
            Ok(())
        }
        (Some(Command::Rigs { name: Some(name) }), _) => {
            study::rig(Some(name), None).map(|rig| tell(&report::sheet(&rig)))
        }
        (Some(Command::NewRig { model, out }), _) => {
            rig_file::create(model, out.as_deref()).map(|text| tell(&text))
        }
        (Some(Command::Check { file }), _) => rig_file::check(file).map(|text| tell(&text)),
        (Some(Command::Effects), _) => {
            tell(&catalogue::page());
            Ok(())
        }
        (Some(Command::Completions { shell }), _) => {
            tell(&completions::script(*shell));
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

fn run(arguments: &DiagnosisArguments) -> Result<(), String> {
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
    let study = study(arguments)?;
    let deadline = Deadline::after(Duration::from_secs(arguments.time_limit));
    let bar = spinner("reading the records");
    // Once the records are read: an error there comes alone.
    let limit = Once::new();
    let outcome = study.run(deadline, &|progress: Progress<'_>| match progress {
        Progress::Read(records) => bar.suspend(|| eprint!("{}", report::read(records))),
        Progress::Stage(text) => {
            let limit_of = || eprintln!("time limit {} s (--time-limit)", arguments.time_limit);
            limit.call_once(|| bar.suspend(limit_of));
            bar.set_message(text.to_owned());
        }
    });
    bar.finish_and_clear();
    let Outcome { mut findings, extended } = outcome?;
    if let Some(provenance) = &mut findings.provenance {
        provenance.command = command();
    }
    // The verdict first: a disk that is full or an FMU that cannot be built does not take it away.
    tell(&report::terminal(&findings));
    let mut failures = Vec::new();
    match report::write(&findings, &arguments.out) {
        Ok(()) => tell(&format!("\nreport: {}\n", arguments.out.join("report.html").display())),
        Err(errors) => failures.extend(errors.iter().map(ToString::to_string)),
    }
    if let Some(extended) = extended.filter(|_| arguments.out.is_dir()) {
        let bar = spinner("building the extended model");
        let packing = Packing { libraries: arguments.libraries.as_deref(), record: !arguments.no_record };
        let packing = (!arguments.no_fmu).then_some(packing);
        let done = extended.write(&findings, &arguments.out, packing);
        bar.finish_and_clear();
        extended.notes(packing).iter().for_each(|note| eprintln!("note: {note}"));
        failures.extend(done.err().into_iter().flatten());
    }
    if findings.verdict == Verdict::BadData {
        let fatal = findings.data_problems.iter().filter(|problem| problem.fatal);
        let fatal = fatal.map(|it| format!("{}, {}: {}", it.record, it.signal, it.text)).next();
        let page = arguments.out.join("report.html");
        let text = fatal.unwrap_or_default();
        failures.insert(0, format!("the data cannot be used; {text}; the whole list: {}", page.display()));
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\nerror: ")) }
}

/// What the command line asks for.
fn study(arguments: &DiagnosisArguments) -> Result<Study, String> {
    let origins = |paths: &[PathBuf]| paths.iter().cloned().map(Origin::File).collect();
    let rig = study::rig(arguments.rig.as_deref(), arguments.parameters.as_deref())?;
    let mut study = Study::new(rig, origins(&arguments.train), origins(&arguments.test));
    for text in &arguments.known {
        study.know(text).map_err(|error| format!("--known {error}"))?;
    }
    study.look_at(&arguments.effects).map_err(|error| format!("--effects {error}"))?;
    if let Some(path) = &arguments.map {
        study.map = Map::parse(&read(path)?).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    study.without = arguments.without;
    study.map.reading = study.map.reading.or(arguments.sampling_rate, arguments.skip_rows);
    study.limits = Limits {
        stroke: arguments.stroke,
        force: arguments.force,
        rate: arguments.rate,
        duration: arguments.duration,
        bandwidth: arguments.bandwidth,
    };
    Ok(study)
}

/// A spinner on stderr.
fn spinner(message: &'static str) -> ProgressBar {
    let bar = ProgressBar::new_spinner()
        .with_style(ProgressStyle::with_template("{spinner} {elapsed}  {msg}").expect("a valid template"));
    bar.enable_steady_tick(Duration::from_millis(100));
    bar.set_message(message);
    bar
}

/// The command line, as a shell takes it.
fn command() -> String {
    let quoted = |word: String| {
        let plain = |c: char| c.is_alphanumeric() || "-_./=,:±+@%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', "'\\''"))
        }
    };
    let mut words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
    let program = words.next().unwrap_or_default();
    let program = Path::new(&program).file_name().map(|name| name.to_string_lossy().into_owned());
    program.into_iter().chain(words).map(quoted).collect::<Vec<_>>().join(" ")
}

fn simulate(arguments: &SimulateArguments) -> Result<(), String> {
    let rig = study::rig(Some(&arguments.rig), None)?;
    let hidden = arguments.hide.iter().map(|text| virtual_rig::hidden(&rig, text));
    let hidden = hidden.collect::<Result<Vec<_>, _>>().map_err(|error| format!("--hide {error}"))?;
    if !arguments.noise.is_finite() || arguments.noise < 0.0 {
        return Err(format!(
            "--noise {}: the share of a signal has to be finite and not negative",
            arguments.noise
        ));
    }
    let (step, length) = (arguments.sample_rate.recip(), arguments.duration);
    if !(100.0..=1e7).contains(&(length / step)) {
        let samples = (length / step).round();
        return Err(format!(
            "--duration {length} and --sample-rate {} give {samples} samples: a record has from 100 to 10 000 000",
            arguments.sample_rate
        ));
    }
    let SimulateArguments { amplitude, noise, seed, .. } = *arguments;
    let experiment = Experiment { hidden, amplitude, noise, seed, step, length };
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

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))
}
