//! Rules for what a library does. Each has a process of its own.

mod answers;
mod ends;
mod lives;
mod signs;
mod subject;

use std::path::Path;

pub use signs::Response;
use subject::{STEPS, Subject, read};
pub use subject::{plain, uri};

use crate::description::{Description, Kind, Version};
use crate::finding::{Finding, Report};
use crate::libraries;
use crate::probe::{ABSENT, Act, Ending, Probe, Run};
use crate::related::{self, Prepared};
use crate::rules::{Rule, fmi, practice};

/// Folders that an FMU is unpacked to.
pub struct Unpacked<'a> {
    /// With a plain name.
    pub plain: &'a Path,
    /// With spaces and other characters that users' folders have.
    pub odd: &'a Path,
}

/// What is done beyond the rules, on request.
pub struct Further<'a> {
    /// Whether the signs of the outputs' responses are reported.
    pub signs: bool,
    /// Experiments that are run again.
    pub experiments: &'a [Prepared],
}

/// Runs each interface for which there is a library.
///
/// # Errors
/// If processes cannot be started.
pub fn run(
    description: &Description,
    unpacked: &Unpacked,
    probe: &Probe,
    further: &Further,
    report: &mut Report,
) -> Result<(), String> {
    let Some(version) = description.runs_as() else {
        let other = &description.version;
        report.skipped.push(format!("running it: libraries of FMI {other} are not known here"));
        return Ok(());
    };
    let mut first = true;
    for kind in [Kind::CoSimulation, Kind::ModelExchange] {
        let Some(interface) = description.interface(kind) else { continue };
        let Some(host) = libraries::host(version) else {
            report.skipped.push("running it: FMI has no name for this machine's platform".into());
            return Ok(());
        };
        let library = libraries::path(host, &interface.identifier);
        if !unpacked.plain.join(&library).is_file() {
            report.skipped.push(format!("running it: there is no `{library}` for this machine"));
            return Ok(());
        }
        let subject = Subject::new(description, version, interface, library);
        let bench = Bench { subject, unpacked, probe };
        // The rules are those of FMI 2.0.
        if version == Version::Two {
            bench.check(first, report)?;
        }
        if further.signs {
            bench.signs(report)?;
        }
        for experiment in further.experiments.iter().filter(|_| kind == Kind::CoSimulation) {
            related::replay(&bench, experiment, report)?;
            report.tell();
        }
        first = false;
    }
    Ok(())
}

/// An FMU with what it is run by.
pub struct Bench<'a> {
    /// What is run.
    pub subject: Subject<'a>,
    /// Where it is.
    pub unpacked: &'a Unpacked<'a>,
    probe: &'a Probe,
}

type Acts = Vec<(Act, bool)>;

impl Bench<'_> {
    fn check(&self, everything: bool, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let what = self.what();
        let run = self.start_values(report)?;
        if let Some(error) = &run.answers.unloadable {
            report.findings.push(
                Finding::error(practice::LOAD, format!("the library cannot be loaded here: {error}"))
                    .at(&subject.library)
                    .help("link statically what is missing, or bring it along beside the library"),
            );
            return Ok(());
        }
        let reference = self.obey(self.whole(self.unpacked.plain, true))?;
        report.findings.extend(self.words(&reference));
        if !self.ran(fmi::SIMULATION, &format!("a run of {what}"), &reference, report) {
            report.skipped.push(format!("further runs of {what}, since the first does not succeed"));
            return Ok(());
        }
        report.findings.extend(self.numbers(&reference));
        report.findings.extend(self.memory(&reference));
        report.tell();
        report.done.push(format!("{what}: {STEPS} steps of {} s", subject.step));
        if everything {
            self.guid(report)?;
            report.tell();
            self.unknown_reference(report)?;
            report.tell();
            self.nothing(report)?;
            self.terminated(report)?;
            self.again(report)?;
            report.tell();
        }
        let again = self.obey(self.whole(self.unpacked.plain, false))?;
        if read(&again) != read(&reference) {
            let message = format!("two runs of {what} with the same inputs differ");
            let help = "something is not initialised, or depends on the clock or on addresses";
            report.findings.push(Finding::warning(practice::REPEAT, message).help(help));
            report
                .skipped
                .push("comparing runs after a reset or a saved state, since equal runs differ".into());
            return Ok(());
        }
        self.resources(&reference, report)?;
        report.tell();
        self.reset(&reference, report)?;
        report.tell();
        self.states(&reference, report)?;
        report.tell();
        self.instances(&reference, report)?;
        report.tell();
        self.derivatives(report)?;
        report.tell();
        if subject.interface.kind == Kind::CoSimulation {
            self.clock(report)?;
            report.tell();
            self.parameters(report)?;
            report.tell();
            self.slopes(report)?;
            report.tell();
        } else {
            self.nominals(report)?;
            report.tell();
        }
        Ok(())
    }

    fn what(&self) -> &'static str {
        match self.subject.interface.kind {
            Kind::CoSimulation => "co-simulation",
            Kind::ModelExchange => "model exchange",
        }
    }

    /// Has a process of its own make the calls.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn obey(&self, acts: Acts) -> Result<Run, String> {
        self.probe.run(self.subject.orders(self.unpacked.plain, acts))
    }

    /// A whole life.
    fn whole(&self, folder: &Path, logging: bool) -> Acts {
        let guid = self.subject.description.guid.as_deref().unwrap_or_default();
        let mut acts = vec![self.subject.instantiate(folder, guid, logging)];
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.reads());
        acts.extend(self.subject.steps(0..STEPS, 1.0));
        acts.extend([plain("Terminate"), (Act::Free, true)]);
        acts
    }

    /// Whether a run went through; what went wrong is reported.
    pub fn ran(&self, rule: &'static Rule, what: &str, run: &Run, report: &mut Report) -> bool {
        let message = match (&run.ending, run.failure()) {
            (Ending::Crashed { function, how }, _) => {
                format!("the library crashes in {function} during {what}: {how}")
            }
            (Ending::Hung { function }, _) => {
                let seconds = self.probe.timeout.as_secs_f64();
                format!(
                    "the library does not return from {function} during {what}; it was ended after {seconds} s"
                )
            }
            (Ending::Answered, Some((act, ABSENT))) => {
                format!("{} is missing in the library", act.function(self.subject.version))
            }
            (Ending::Answered, Some((act, status))) => {
                let time = match act {
                    Act::Step(time, _) | Act::Euler { time, .. } => format!(" at {time} s"),
                    _ => String::new(),
                };
                let returns = match act {
                    Act::Instantiate { .. } => "returns null".into(),
                    _ => format!("returns {}", self.subject.status(status)),
                };
                format!("{}{time} {returns} during {what}", act.function(self.subject.version))
            }
            (Ending::Answered, None) => return true,
        };
        let mut finding = Finding::error(rule, message).at(&self.subject.library);
        if let Some(logged) = run.answers.log.messages.first() {
            finding = finding.help(format!("it says: {}", logged.trim()));
        }
        report.findings.push(finding);
        false
    }
}
