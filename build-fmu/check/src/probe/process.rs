//! The other process: started, waited for, and its end understood.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::{ANSWERS, Act, Answers, CALLING, ORDERS, Orders};

/// Runs orders in processes of their own.
#[derive(Clone, Debug)]
pub struct Probe {
    /// The program that [`probe`](super::probe) is run by, and its arguments before the folder.
    pub program: Vec<PathBuf>,
    /// How long a call may take.
    pub timeout: Duration,
}

/// How a process ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// With answers.
    Answered,
    /// Without, in this function: how.
    Crashed { function: String, how: String },
    /// It was ended, in this function, since it took too long.
    Hung { function: String },
}

/// What came of a process.
#[derive(Clone, Debug)]
pub struct Run {
    /// How it ended.
    pub ending: Ending,
    /// What it answered; empty if it did not.
    pub answers: Answers,
    /// The orders, to tell what an outcome belongs to.
    pub acts: Vec<(Act, bool)>,
}

impl Run {
    /// The act that ended it before its time, with the status that it returned.
    pub fn failure(&self) -> Option<(&Act, i32)> {
        let last = self.answers.outcomes.len().checked_sub(1)?;
        let (act, must) = self.acts.get(last)?;
        let outcome = &self.answers.outcomes[last];
        (outcome.status == 4 || (*must && !outcome.is_fine())).then_some((act, outcome.status))
    }
}

impl Probe {
    /// Has a process obey.
    ///
    /// # Errors
    /// If there is no folder to write to, or the process cannot be started.
    pub fn run(&self, orders: Orders) -> Result<Run, String> {
        let failed = |error: std::io::Error| format!("cannot run a library in another process: {error}");
        let folder = tempfile::tempdir().map_err(failed)?;
        let text = serde_json::to_vec(&orders).map_err(|error| failed(error.into()))?;
        fs::write(folder.path().join(ORDERS), text).map_err(failed)?;
        let (program, arguments) =
            self.program.split_first().ok_or_else(|| "no program to run a library by is given".to_owned())?;
        let mut child = Command::new(program)
            .args(arguments)
            .arg(folder.path())
            // What a library prints is not what this program says.
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .current_dir(folder.path())
            .spawn()
            .map_err(failed)?;
        let status = wait(&mut child, self.timeout, &folder.path().join(CALLING)).map_err(failed)?;
        let function = fs::read_to_string(folder.path().join(CALLING)).unwrap_or_default();
        let function = function.trim_end().to_owned();
        let answers = fs::read(folder.path().join(ANSWERS)).ok();
        let answers = answers.and_then(|text| serde_json::from_slice::<Answers>(&text).ok());
        let ending = match status {
            None => Ending::Hung { function },
            Some(status) if status.success() && answers.is_some() => Ending::Answered,
            Some(status) => Ending::Crashed { function, how: how(status) },
        };
        Ok(Run { ending, answers: answers.unwrap_or_default(), acts: orders.acts })
    }
}

/// How many times the timeout a process may take that goes on from call to call.
const SLOW: u32 = 10;

/// The status at the end; none if a call took too long, or all of them together. Who is slow does not hang: the time begins anew
/// with each call, which the child notes in a file.
fn wait(child: &mut Child, timeout: Duration, calling: &Path) -> std::io::Result<Option<ExitStatus>> {
    let begin = Instant::now();
    let (mut end, mut last) = (begin + timeout, None);
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        let told = fs::metadata(calling).and_then(|it| it.modified()).ok();
        if told != last {
            (end, last) = ((Instant::now() + timeout).min(begin + SLOW * timeout), told);
        }
        if Instant::now() >= end {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(pause);
        pause = (2 * pause).min(Duration::from_millis(50));
    }
}

fn how(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(signal) = status.signal() {
            let name = match signal {
                libc::SIGSEGV => " (SIGSEGV: it reads or writes memory that it does not have)",
                libc::SIGABRT => " (SIGABRT: it gives up, as after an assertion or an uncaught exception)",
                libc::SIGFPE => " (SIGFPE: an integer is divided by zero)",
                libc::SIGILL => " (SIGILL: the processor does not know an instruction)",
                libc::SIGBUS => " (SIGBUS: it reads or writes memory that is not there)",
                _ => "",
            };
            return format!("signal {signal}{name}");
        }
    }
    match status.code() {
        Some(code) => format!("it ends the process with code {code}"),
        None => "it ends the process".into(),
    }
}
