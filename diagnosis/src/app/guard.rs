//! A separate process for another maker's FMU: a crash ends that process only, and becomes a message.

use std::env;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::app::cli::{Arguments, Command as Subcommand};
use crate::rig::{Kind, MADE, fmu_of, is_fmu, is_manifest};

/// In the process that runs the FMU: the file that its output goes to. Its own standard output is the FMU's, of which some
/// print there.
const INSIDE: &str = "STRUT_RUNS_FMU";
/// In the same process: the number of threads of everything that runs in parallel.
const THREADS: &str = "RAYON_NUM_THREADS";
/// How much longer than the time limit the process may live: the report and the page are written afterwards.
const GRACE: Duration = Duration::from_secs(60);

/// Runs the command line in a process of its own if it takes another maker's FMU; none if it takes none.
pub fn elsewhere(arguments: &Arguments) -> Option<ExitCode> {
    let (model, limit) = foreign(arguments)?;
    if env::var_os(INSIDE).is_some() {
        return None;
    }
    // Compiling a crate takes as long as it takes.
    let fmu = match fmu_of(&model) {
        Ok(fmu) => fmu,
        Err(text) => return Some(failed(&text)),
    };
    let limit = limit.saturating_add(GRACE);
    let mut end = run(&fmu, limit, None);
    // Libraries of some exporters keep global state, though they allow several instances.
    let several = arguments.diagnosis.as_ref().is_some_and(|it| it.jobs.is_none());
    if several && end.as_ref().is_ok_and(|it| it.code().is_none()) {
        eprintln!(
            "note: the FMU crashed while several threads used it; trying once more with one thread, as `--jobs 1` does"
        );
        end = run(&fmu, limit, Some(1));
    }
    Some(match end {
        Ok(status) => match told(status, &fmu) {
            None => ExitCode::from(u8::try_from(status.code().unwrap_or(1)).unwrap_or(1)),
            Some(text) => failed(&text),
        },
        Err(text) => failed(&text),
    })
}

/// The FMU, or the crate with the model, that a command line runs, and how long that may take; none if it runs none.
fn foreign(arguments: &Arguments) -> Option<(PathBuf, Duration)> {
    let of_rig = |file: &Path| {
        // The reader of the file reports its mistakes.
        let kind = Kind::parse(&std::fs::read_to_string(file).ok()?).ok()?;
        kind.is_foreign().then(|| file.with_file_name(&kind.model))
    };
    let of_name = |name: &str| name.ends_with(".toml").then(|| of_rig(Path::new(name))).flatten();
    let fmu = match &arguments.command {
        Some(Subcommand::Check { file }) => of_rig(file),
        Some(Subcommand::Rigs { name: Some(name) }) => of_name(name),
        Some(Subcommand::Simulate(simulated)) => of_name(&simulated.rig),
        Some(Subcommand::NewRig { model, .. }) => {
            let path = PathBuf::from(model);
            (is_fmu(&path) || is_manifest(&path)).then_some(path)
        }
        Some(_) => None,
        None => {
            let diagnosis = arguments.diagnosis.as_ref()?;
            return Some((of_name(diagnosis.rig.as_deref()?)?, Duration::from_secs(diagnosis.time_limit)));
        }
    };
    // Without a diagnosis, an FMU is run for a second.
    fmu.map(|fmu| (fmu, Duration::ZERO))
}

fn failed(text: &str) -> ExitCode {
    eprintln!("error: {text}");
    ExitCode::FAILURE
}

/// Runs this command line in another process, with a number of threads if one is given.
fn run(fmu: &Path, limit: Duration, threads: Option<usize>) -> Result<ExitStatus, String> {
    let started = |error: std::io::Error| format!("cannot start a process for the FMU: {error}");
    let program = env::current_exe().map_err(started)?;
    let told = tempfile::NamedTempFile::new().map_err(started)?;
    let mut command = Command::new(program);
    command.args(env::args_os().skip(1)).env(INSIDE, told.path()).env(MADE, fmu).stdout(Stdio::null());
    command.envs(threads.map(|number| (THREADS, number.to_string())));
    let end = command.spawn().map_err(started).and_then(|mut child| ended(&mut child, limit));
    // Whoever closed the pipe has read enough; what was not written has its error in the other process.
    let _ = std::io::copy(&mut told.as_file(), &mut std::io::stdout());
    end
}

/// Prints to the standard output of the process that the user has started.
pub fn tell(text: &str) {
    let bytes = text.as_bytes();
    // Whoever closed the pipe has read enough.
    let _ = match env::var_os(INSIDE) {
        Some(path) => OpenOptions::new().append(true).open(path).and_then(|mut file| file.write_all(bytes)),
        None => std::io::stdout().write_all(bytes),
    };
}

fn ended(child: &mut Child, limit: Duration) -> Result<ExitStatus, String> {
    let begin = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status),
            Ok(None) if begin.elapsed() < limit => sleep(Duration::from_millis(20)),
            Ok(None) => {
                // It is killed or has ended by itself.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!(
                    "the FMU does not return from a call: stopped after {} s. `build-fmu check` tells which call",
                    limit.as_secs()
                ));
            }
            Err(error) => return Err(format!("lost the process of the FMU: {error}")),
        }
    }
}

/// What an end by a signal means; none if the process ended by itself.
fn told(status: ExitStatus, fmu: &Path) -> Option<String> {
    if status.code().is_some() {
        return None;
    }
    Some(format!(
        "`{}` crashed the process that ran it ({status}); nothing is written. `build-fmu check {}` tells which call does it",
        fmu.display(),
        fmu.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_process_that_is_killed_is_told_and_one_that_fails_has_told_itself() {
        let ended = |script: &str| Command::new("sh").args(["-c", script]).status().unwrap();
        let text = told(ended("kill -SEGV $$"), Path::new("rigs/car.fmu")).unwrap();
        assert!(text.starts_with("`rigs/car.fmu` crashed") && text.contains("SIGSEGV"), "{text}");
        assert_eq!(told(ended("exit 1"), Path::new("car.fmu")), None);
    }

    #[test]
    #[cfg(unix)]
    fn a_process_that_does_not_end_is_stopped() {
        let mut child = Command::new("sleep").arg("100").spawn().unwrap();
        let text = ended(&mut child, Duration::from_millis(50)).unwrap_err();
        assert!(text.contains("does not return"), "{text}");
    }
}
