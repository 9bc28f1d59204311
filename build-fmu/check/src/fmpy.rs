//! FMPy's validation, in a Python of the user's.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use crate::finding::{Finding, Report};
use crate::rules::practice;

/// Prints version and problems. FMPy warns on stdout about some files: the answer is the last line.
const FMU: &str = "\
import json, sys
import fmpy, fmpy.validation
problems = [str(problem) for problem in fmpy.validation.validate_fmu(sys.argv[1])]
print(json.dumps({'version': fmpy.__version__, 'problems': problems}))
";

/// The same of a system, whose parameter sets are read along. The first problem ends it.
const SYSTEM: &str = "\
import json, sys
import fmpy, fmpy.ssp.ssd
problems = []
try:
    fmpy.ssp.ssd.read_ssd(sys.argv[1], validate=True)
except Exception as problem:
    problems = [str(problem)]
print(json.dumps({'version': fmpy.__version__, 'problems': problems}))
";

/// What is to be validated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// An FMU.
    Fmu,
    /// A system (SSP 1.0).
    System,
}

#[derive(Deserialize)]
struct Answer {
    version: String,
    problems: Vec<String>,
}

/// Where FMPy is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fmpy {
    /// In the Python of this path; it is an error if it is not.
    In(PathBuf),
    /// In the Python that is found in the path, if there is any.
    Found,
    /// It is not wanted.
    Without,
}

/// Validates a file; says so if there is no FMPy. Returns whether it was done.
///
/// # Errors
/// If the Python that the user has named has none.
pub fn validate(file: &Path, what: What, fmpy: &Fmpy, report: &mut Report) -> Result<bool, String> {
    let candidates = match fmpy {
        Fmpy::In(python) => vec![python.clone()],
        Fmpy::Found => vec![PathBuf::from("python3"), PathBuf::from("python")],
        Fmpy::Without => {
            report.skipped.push("FMPy's validation: not wanted".into());
            return Ok(false);
        }
    };
    let mut why = "there is no python3 in the path".to_owned();
    for candidate in candidates {
        match ask(&candidate, what, file) {
            Ok(answer) => {
                for problem in &answer.problems {
                    // What follows an empty line is its parser's view of the matter.
                    let text: Vec<&str> =
                        problem.trim().lines().take_while(|line| !line.trim().is_empty()).collect();
                    let text = text.join(" ");
                    let text = text.trim_end_matches('.');
                    let message = format!("FMPy {} finds: {text}", answer.version);
                    report.findings.push(Finding::error(practice::FMPY, message));
                }
                report.done.push(format!("validation of FMPy {}", answer.version));
                return Ok(true);
            }
            Err(error) if matches!(fmpy, Fmpy::In(_)) => return Err(error),
            // Without python3 there may be a python; what the first one says is more telling.
            Err(error) if candidate.ends_with("python3") => why = error,
            Err(_) => {}
        }
    }
    report.skipped.push(format!(
        "FMPy's validation: {why}; run `pip install fmpy lxml`, or name a Python that has it with --fmpy"
    ));
    Ok(false)
}

fn ask(python: &Path, what: What, file: &Path) -> Result<Answer, String> {
    let shown = python.display();
    let script = match what {
        What::Fmu => FMU,
        What::System => SYSTEM,
    };
    let output = Command::new(python)
        .args(["-c", script])
        .arg(file)
        .output()
        .map_err(|error| format!("`{shown}` cannot be run: {error}"))?;
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if !output.status.success() {
        let last = stderr.trim().lines().last().unwrap_or("it says nothing").to_owned();
        return Err(if last.contains("No module named") {
            format!("`{shown}` has no package fmpy ({last})")
        } else {
            format!("`{shown}` cannot validate: {last}")
        });
    }
    let line = stdout.trim().lines().last().unwrap_or_default();
    serde_json::from_str(line).map_err(|_| format!("`{shown}` gives an unexpected answer: {line}"))
}
