//! `build-fmu check`: findings on a terminal or for programs.

use std::cell::RefCell;
use std::collections::HashSet;
use std::fmt::Write;
use std::io::Write as _;
use std::process::ExitCode;

use serde_json::{Value, json};
use strut_check::{Finding, Fmpy, Level, Listener, Options, Report};

use crate::cli::CheckArguments;
use crate::failure::Failure;
use crate::style::{ASIDE, ERROR, HEADING, HELP, NAME, WARNING};

/// Checks the files, or prints the rules. The exit code is 0 if nothing is found, 1 after problems, 2 if a file cannot be read.
pub fn check(arguments: &CheckArguments) -> ExitCode {
    if arguments.rules {
        let _ = anstream::stdout().write_all(strut_check::rules_page().as_bytes());
        return ExitCode::SUCCESS;
    }
    let program = match std::env::current_exe() {
        Ok(program) => vec![program, "probe".into()],
        Err(_) => vec!["build-fmu".into(), "probe".into()],
    };
    let options = Options {
        fmpy: match &arguments.fmpy {
            Some(python) => Fmpy::In(python.clone()),
            None if arguments.no_fmpy => Fmpy::Without,
            None => Fmpy::Found,
        },
        run: !arguments.no_run,
        signs: arguments.signs,
        replay: arguments.replay,
        timeout: arguments.timeout,
        program,
        listener: None,
    };
    let mut code = 0;
    for file in &arguments.files {
        let name = file.display().to_string();
        let options = Options { listener: arguments.json.then(|| listener(&name)), ..options.clone() };
        match strut_check::check(file, &options) {
            Ok(report) => {
                let worst = if arguments.strict { Level::Note } else { Level::Warning };
                let problems = report.findings.iter().filter(|finding| finding.level <= worst).count();
                code = code.max(u8::from(problems > 0));
                if arguments.json {
                    let Report { about, done, skipped, signs, .. } = report;
                    line(&json!({
                        "file": name, "problems": problems, "about": about, "done": done, "skipped": skipped,
                        "signs": signs,
                    }));
                } else {
                    let _ = anstream::stdout().write_all(page(&name, &report).as_bytes());
                }
            }
            Err(error) => {
                code = 2;
                if arguments.json {
                    line(&json!({"file": name, "unreadable": error}));
                }
                let mut failure = Failure::new(format!("`{name}` cannot be checked: {error}"));
                if !file.exists() {
                    failure = failure
                        .help("give the path of an .fmu or .ssp file; `build-fmu NAME` makes one in `fmus/`");
                }
                anstream::eprintln!("{failure:#}");
            }
        }
    }
    ExitCode::from(code)
}

/// Writes each finding as a line of its own, as soon as it is made, and once.
fn listener(file: &str) -> Listener {
    let (file, said) = (file.to_owned(), RefCell::new(HashSet::new()));
    Listener::new(move |finding| {
        if said.borrow_mut().insert(finding.clone()) {
            line(&json!({"file": file, "finding": finding}));
        }
    })
}

/// A line of JSON, which is out when this returns.
fn line(value: &Value) {
    let mut stdout = anstream::stdout();
    let _ = stdout.write_all(format!("{value}\n").as_bytes()).and_then(|()| stdout.flush());
}

fn page(name: &str, report: &Report) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{NAME}{name}{NAME:#}  {ASIDE}{}{ASIDE:#}\n", report.about.join("; "));
    for finding in &report.findings {
        finding_text(&mut text, finding);
    }
    for response in &report.signs {
        let _ = writeln!(text, "{HELP}sign:{HELP:#} {response}");
    }
    for (mark, lines) in [("checked", &report.done), ("skipped", &report.skipped)] {
        for line in lines {
            let _ = writeln!(text, "{ASIDE}{mark}: {line}{ASIDE:#}");
        }
    }
    let counted: Vec<String> = [Level::Error, Level::Warning, Level::Note]
        .into_iter()
        .map(|level| (level, report.count(level)))
        .filter(|(_, number)| *number > 0)
        .map(|(level, number)| format!("{number} {level}{}", if number == 1 { "" } else { "s" }))
        .collect();
    let _ = match (report.count(Level::Error) + report.count(Level::Warning), counted.is_empty()) {
        (_, true) => writeln!(text, "{HEADING}{name}: nothing found{HEADING:#}\n"),
        (0, false) => writeln!(text, "{HEADING}{name}: no problems{HEADING:#}, {}\n", counted.join(", ")),
        _ => writeln!(text, "{ERROR}{name}: {}{ERROR:#}\n", counted.join(", ")),
    };
    text
}

fn finding_text(text: &mut String, finding: &Finding) {
    let style = match finding.level {
        Level::Error => ERROR,
        Level::Warning => WARNING,
        Level::Note => HEADING,
    };
    let (level, rule) = (finding.level, finding.rule.name);
    let _ = writeln!(text, "{style}{level}[{rule}]{style:#}: {}", finding.message);
    if let Some(place) = &finding.place {
        let _ = writeln!(text, "  {ASIDE}--> {place}{ASIDE:#}");
    }
    for help in &finding.help {
        let _ = writeln!(text, "  {HELP}help:{HELP:#} {help}");
    }
    text.push('\n');
}
