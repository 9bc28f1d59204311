//! Runs a diagnosis on cases, and writes down what came out.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::case::Case;
use crate::score::{Outcome, Score, breakdown, markdown};
use crate::{files, generate};

/// What is run on which cases.
#[derive(Clone, Debug)]
pub struct Run {
    /// The program, called as `diagnose` is.
    pub program: PathBuf,
    /// Its further arguments.
    pub arguments: Vec<String>,
    /// Where the cases' folders go. One that has a report already is not run again.
    pub out: PathBuf,
}

impl Run {
    /// Makes a case, runs the program on it and judges its report; the records are deleted once there is one.
    ///
    /// # Errors
    /// If the program cannot be run, or leaves no report: with what it printed.
    pub fn case(&self, case: &Case) -> Result<Score, String> {
        let folder = self.out.join(&case.name);
        if let Ok(score) = files::judge(&folder) {
            return Ok(score);
        }
        let folder = files::write(&generate(case)?, &self.out)?;
        let data = folder.join("data");
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).arg("--parameters").arg(data.join("start.toml"));
        command.arg("--train").args(records(&data, "train")?).arg("--test").args(records(&data, "test")?);
        command.arg("--out").arg(folder.join("report")).arg("--no-fmu");
        let output =
            command.output().map_err(|error| format!("{} cannot be run: {error}", self.program.display()))?;
        let score = files::judge(&folder).map_err(|error| {
            let said = String::from_utf8_lossy(&output.stderr);
            format!("{}: {error}; it said: {}", case.name, said.trim())
        })?;
        fs::remove_dir_all(&data)
            .map_err(|error| format!("{} cannot be removed: {error}", data.display()))?;
        Ok(score)
    }
}

/// The records of a kind, in the order of their names.
fn records(data: &Path, kind: &str) -> Result<Vec<PathBuf>, String> {
    let entries =
        fs::read_dir(data).map_err(|error| format!("{} cannot be read: {error}", data.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(kind)));
    paths.sort();
    Ok(paths)
}

/// The heading of the page's list of wrong cases.
const WRONG: &str = "## Not as it should be";

/// The hidden effect is named, or an unknown one is found in its place without a name.
pub fn is_right(score: &Score) -> bool {
    matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo)
        || score.out_of_catalogue && score.outcome == Outcome::Unnamed && score.location_right == Some(true)
}

/// The wrong cases that an earlier page does not list as wrong.
pub fn worse<'a>(scores: &'a [Score], page: &str) -> Vec<&'a Score> {
    let (_, list) = page.split_once(WRONG).unwrap_or_default();
    let known = |score: &Score| list.lines().any(|row| row.starts_with(&format!("| {} |", score.case)));
    scores.iter().filter(|score| !is_right(score) && !known(score)).collect()
}

/// The page: figures, confusion matrix, figures by condition and plant, and every case that did not come out as it
/// should.
pub fn page(command: &str, scores: &[Score]) -> String {
    let mut text = format!(
        "# Results of the blind benchmark\n\n{} cases, by\n\n```\n{command}\n```\n\n{}\n{}\n{WRONG}\n\n\
         | case | outcome | there | called first |\n|---|---|---|---|\n",
        scores.len(),
        markdown(scores),
        breakdown(scores)
    );
    for it in scores.iter().filter(|it| !is_right(it)) {
        writeln!(text, "| {} | {:?} | {} | {} |", it.case, it.outcome, it.truth, it.first)
            .expect("a string takes everything");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Hidden;

    #[cfg(unix)]
    #[test]
    fn a_program_is_run_once_a_case_and_its_records_go() {
        use std::os::unix::fs::PermissionsExt;
        let below = tempfile::tempdir().unwrap();
        let program = below.path().join("program");
        // The folder for the results comes before the last argument.
        let script = "#!/bin/sh\nwhile [ $# -gt 2 ]; do shift; done\nmkdir -p \"$1\"\n\
                      echo '{\"verdict\": \"no_effect\"}' > \"$1/report.json\"\n";
        fs::write(&program, script).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let run = Run { program: program.clone(), arguments: vec![], out: below.path().join("cases") };
        let case = Case { duration: 4.0, rate: 100.0, ..Case::standard("case", vec![Hidden::new("01")], 5) };
        let score = run.case(&case).unwrap();
        assert_eq!(score.outcome, Outcome::Missed);
        assert!(!run.out.join("case/data").exists() && run.out.join("case/sealed/truth.json").exists());
        fs::remove_file(&program).unwrap();
        assert_eq!(run.case(&case).unwrap(), score, "it has its report");
        assert!(page("blind run", &[score]).contains("| case | Missed | 01 | - |"));
        let error = run.case(&Case { name: "other".into(), ..case }).unwrap_err();
        assert!(error.contains("cannot be run"), "{error}");
    }

    #[test]
    fn what_has_become_wrong_is_told_from_what_was_wrong() {
        let page = page("blind run", &[Score::of("a", Outcome::WrongName), Score::of("b", Outcome::Correct)]);
        let unnamed = Score { out_of_catalogue: true, ..Score::of("d", Outcome::Unnamed) };
        let now = [
            Score::of("a", Outcome::Missed),
            Score::of("b", Outcome::Missed),
            Score::of("c", Outcome::OneOfTwo),
            unnamed.clone(),
            Score { location_right: Some(false), ..unnamed },
        ];
        let worse: Vec<_> = worse(&now, &page).into_iter().map(|it| (&it.case, it.location_right)).collect();
        assert_eq!(worse, [(&now[1].case, Some(true)), (&now[4].case, Some(false))]);
    }
}
