//! Rules for what a library does. Each has a process of its own.

mod subject;

use std::path::Path;

use subject::{HALF, STEPS, Subject, number, plain, read, reals};

use crate::description::{Description, Kind};
use crate::finding::{Finding, Report, count, names};
use crate::libraries;
use crate::probe::{ABSENT, Act, Ending, Outcome, Probe, RESTLESS, Run};

/// Folders that an FMU is unpacked to.
pub struct Unpacked<'a> {
    /// With a plain name.
    pub plain: &'a Path,
    /// With spaces and other characters that users' folders have.
    pub odd: &'a Path,
}

/// Runs each interface for which there is a library.
///
/// # Errors
/// If processes cannot be started.
pub fn run(
    description: &Description,
    unpacked: &Unpacked,
    probe: &Probe,
    report: &mut Report,
) -> Result<(), String> {
    let mut first = true;
    for kind in [Kind::CoSimulation, Kind::ModelExchange] {
        let Some(interface) = description.interface(kind) else { continue };
        let Some(host) = libraries::HOST else {
            report.skipped.push("running it: FMI has no name for this machine's platform".into());
            return Ok(());
        };
        let library = libraries::path(host, &interface.identifier);
        if !unpacked.plain.join(&library).is_file() {
            report.skipped.push(format!("running it: there is no `{library}` for this machine"));
            return Ok(());
        }
        let subject = Subject::new(description, interface, library);
        let bench = Bench { subject, unpacked, probe };
        bench.check(first, report)?;
        first = false;
    }
    Ok(())
}

struct Bench<'a> {
    subject: Subject<'a>,
    unpacked: &'a Unpacked<'a>,
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
                Finding::error("run.load", format!("the library cannot be loaded here: {error}"))
                    .at(&subject.library)
                    .help("link statically what is missing, or bring it along beside the library"),
            );
            return Ok(());
        }
        let reference = self.obey(self.whole(self.unpacked.plain, true))?;
        report.findings.extend(self.words(&reference));
        if !self.ran("run.simulate", &format!("a run of {what}"), &reference, report) {
            report.skipped.push(format!("further runs of {what}, since the first does not succeed"));
            return Ok(());
        }
        report.findings.extend(self.numbers(&reference));
        report.done.push(format!("{what}: {STEPS} steps of {} s", subject.step));
        if everything {
            self.guid(report)?;
            self.unknown_reference(report)?;
        }
        let again = self.obey(self.whole(self.unpacked.plain, false))?;
        if read(&again) != read(&reference) {
            let message = format!("two runs of {what} with the same inputs differ");
            let help = "something is not initialised, or depends on the clock or on addresses";
            report.findings.push(Finding::warning("run.repeat", message).help(help));
            report
                .skipped
                .push("comparing runs after a reset or a saved state, since equal runs differ".into());
            return Ok(());
        }
        self.resources(&reference, report)?;
        self.reset(&reference, report)?;
        self.states(&reference, report)?;
        self.instances(&reference, report)?;
        self.derivatives(report)?;
        if subject.interface.kind == Kind::CoSimulation {
            self.clock(&reference, report)?;
            self.parameters(report)?;
        }
        Ok(())
    }

    fn what(&self) -> &'static str {
        match self.subject.interface.kind {
            Kind::CoSimulation => "co-simulation",
            Kind::ModelExchange => "model exchange",
        }
    }

    fn obey(&self, acts: Acts) -> Result<Run, String> {
        self.probe.run(self.subject.orders(self.unpacked.plain, acts))
    }

    /// A whole life.
    fn whole(&self, folder: &Path, logging: bool) -> Acts {
        let guid = self.subject.description.guid.as_deref().unwrap_or_default();
        let mut acts = vec![self.subject.instantiate(folder, guid, logging)];
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.reads());
        acts.extend(self.subject.steps(0..STEPS, 1.0));
        acts.extend([plain("fmi2Terminate"), (Act::Free, true)]);
        acts
    }

    /// Whether a run went through; what went wrong is reported.
    fn ran(&self, rule: &'static str, what: &str, run: &Run, report: &mut Report) -> bool {
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
                format!("{} is missing in the library", act.function())
            }
            (Ending::Answered, Some((act, status))) => {
                let time = match act {
                    Act::Step(time, _) | Act::Euler { time, .. } => format!(" at {time} s"),
                    _ => String::new(),
                };
                let returns = match act {
                    Act::Instantiate { .. } => "returns null".into(),
                    _ => format!("returns {}", status_name(status)),
                };
                format!("{}{time} {returns} during {what}", act.function())
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

    /// The first run goes no further than the initialisation, and compares what is described.
    fn start_values(&self, report: &mut Report) -> Result<Run, String> {
        let exact = |variable: &crate::description::Variable| {
            let set = matches!(variable.causality.as_str(), "parameter" | "input");
            set || (variable.effective_initial() == Some("exact") && variable.variability != "constant")
        };
        let (references, variables): (Vec<u32>, Vec<_>) = reals(self.subject.description, &exact)
            .filter(|(_, variable)| number(variable).is_some())
            .unzip();
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.begin());
        acts.push((Act::Reals(references), false));
        let run = self.obey(acts)?;
        let Some(outcome) = run.answers.outcomes.last().filter(|outcome| outcome.is_fine()) else {
            return Ok(run);
        };
        let differs = |(variable, value): &(&&crate::description::Variable, f64)| {
            number(variable).is_some_and(|start| (start - value).abs() > 1e-12 * start.abs().max(value.abs()))
        };
        let wrong: Vec<_> = variables.iter().zip(outcome.values()).filter(differs).collect();
        if let Some((variable, value)) = wrong.first() {
            let list: Vec<&str> = wrong.iter().map(|(variable, _)| variable.name.as_str()).collect();
            let start = number(variable).unwrap_or_default();
            let message = format!(
                "the start values of {} are others in an instance than in the description: `{}` is {value}, not {start}",
                names(&list),
                variable.name
            );
            let help =
                "description and library are of different builds, or values are read before they are set";
            report.findings.push(Finding::error("run.start", message).line(variable.line).help(help));
        }
        Ok(run)
    }

    fn words(&self, run: &Run) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut wrong = |function: &str, found: &Option<String>, wanted: &str| {
            if let Some(found) = found.as_ref().filter(|found| *found != wanted) {
                let message = format!("{function} returns \"{found}\", but must return \"{wanted}\"");
                findings.push(Finding::error("run.version", message).at(&self.subject.library));
            }
        };
        wrong("fmi2GetVersion", &run.answers.version, "2.0");
        wrong("fmi2GetTypesPlatform", &run.answers.types, "default");
        let log = &run.answers.log;
        if log.null_category || log.null_text {
            let what = if log.null_category { "category" } else { "text or name" };
            let message = format!("the library logs messages whose {what} is null");
            let help = "masters build a string of it, and some crash; give one of the declared categories";
            findings.push(Finding::warning("run.logger", message).at(&self.subject.library).help(help));
        }
        findings
    }

    /// Outputs are numbers, and no text is null.
    fn numbers(&self, run: &Run) -> Vec<Finding> {
        let mut findings = Vec::new();
        let outcomes = read(run);
        let wild = |outcome: &&&Outcome| outcome.values().any(|value| !value.is_finite());
        if let Some((row, outcome)) = outcomes.iter().enumerate().find(|(_, outcome)| wild(outcome)) {
            let place = outcome.values().position(|value| !value.is_finite()).unwrap_or_default();
            let references = self.subject.reads().into_iter().find_map(|(act, _)| match act {
                Act::Reals(references) => Some(references),
                _ => None,
            });
            let reference = references.and_then(|references| references.get(place).copied());
            let variables = &self.subject.description.variables;
            let variable = variables.iter().find(|it| it.kind == "Real" && it.reference == reference);
            let name = variable.map_or("an output", |variable| variable.name.as_str());
            let time = self.subject.time(row / self.subject.width().max(1));
            let message = format!(
                "`{name}` is no finite number at {time} s, with inputs at or near their start values"
            );
            findings.push(Finding::error("run.finite", message).at(&self.subject.library));
        }
        if outcomes.iter().any(|outcome| outcome.texts.contains(&None)) {
            findings.push(Finding::error("run.text", "fmi2GetString gives a null").at(&self.subject.library));
        }
        findings
    }

    fn guid(&self, report: &mut Report) -> Result<(), String> {
        let (act, _) = self.subject.instantiate(self.unpacked.plain, "{00000000-no-such-guid}", false);
        let run = self.obey(vec![(act, false)])?;
        if run.ending != Ending::Answered {
            self.ran("run.guid", "an instantiation with a wrong GUID", &run, report);
        } else if run.answers.outcomes.first().is_some_and(Outcome::is_fine) {
            let message = "fmi2Instantiate accepts a wrong GUID";
            let help = "it should log an error and return null: with it, a library and a description that do not belong \
                together run, with values mixed up";
            report.findings.push(Finding::warning("run.guid", message).at(&self.subject.library).help(help));
        } else {
            report.done.push("a wrong GUID is refused".into());
        }
        Ok(())
    }

    fn unknown_reference(&self, report: &mut Report) -> Result<(), String> {
        let known = |reference: u32| {
            let all = &self.subject.description.variables;
            all.iter().any(|variable| variable.kind == "Real" && variable.reference == Some(reference))
        };
        let Some(unknown) = (0..64).map(|back| u32::MAX - back).find(|reference| !known(*reference)) else {
            return Ok(());
        };
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.initialize());
        acts.push((Act::Reals(vec![unknown]), false));
        let run = self.obey(acts)?;
        let what = "reading a value reference that does not exist";
        if run.ending != Ending::Answered {
            self.ran("run.reference", what, &run, report);
        } else if run.answers.outcomes.last().is_some_and(Outcome::is_fine) {
            let message = format!(
                "fmi2GetReal returns fmi2OK for the value reference {unknown}, which there is none of"
            );
            let help = "it should return fmi2Error, so that a mistake in a master is found";
            report
                .findings
                .push(Finding::warning("run.reference", message).at(&self.subject.library).help(help));
        }
        Ok(())
    }

    /// In a folder whose name has spaces and umlauts.
    fn resources(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let acts = self.whole(self.unpacked.odd, false);
        let run = self.probe.run(self.subject.orders(self.unpacked.odd, acts))?;
        let what = "a run in a folder whose name has spaces, percent signs and umlauts";
        let help = "fmuResourceLocation is an address: `%20` in it is a space in the path";
        if let Some(error) = &run.answers.unloadable {
            let message = format!("the library does not load from such a folder: {error}");
            report.findings.push(Finding::error("run.resources", message).at(&self.subject.library));
        } else if !self.ran("run.resources", what, &run, report) {
            report.findings.last_mut().into_iter().for_each(|finding| finding.help.push(help.into()));
        } else if read(&run) != read(reference) {
            let message = format!("{what} has other results");
            report.findings.push(Finding::error("run.resources", message).help(help));
        }
        Ok(())
    }

    fn reset(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.steps(0..HALF, -3.0));
        let before = self.subject.width() * HALF;
        acts.push(plain("fmi2Reset"));
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.reads());
        acts.extend(self.subject.steps(0..STEPS, 1.0));
        let run = self.obey(acts)?;
        if !self.ran("run.reset", "a run after fmi2Reset", &run, report) {
            return Ok(());
        }
        self.same(
            "run.reset",
            "after fmi2Reset",
            &read(&run)[before..],
            &read(reference),
            report,
            &["a reset instance must be as a new one: states, inputs, parameters, time, memory of events"],
        );
        Ok(())
    }

    fn states(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if !subject.interface.can("canGetAndSetFMUstate") {
            report
                .skipped
                .push(format!("{}: saving and restoring states, which is not declared", self.what()));
            return Ok(());
        }
        let serializes = subject.interface.can("canSerializeFMUstate");
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.extend(subject.steps(0..HALF, 1.0));
        acts.push((Act::Save(0), true));
        acts.extend(subject.steps(HALF..STEPS, -3.0));
        acts.push((Act::Restore(0), true));
        acts.extend(subject.steps(HALF..STEPS, 1.0));
        if serializes {
            acts.push((Act::Serialize(0, 1), true));
            acts.push((Act::FreeState(0), true));
            acts.push((Act::Restore(1), true));
            acts.extend(subject.steps(HALF..STEPS, 1.0));
            acts.push((Act::FreeState(1), true));
        }
        let run = self.obey(acts)?;
        if !self.ran("run.state", "a run with a saved state", &run, report) {
            return Ok(());
        }
        let width = subject.width();
        // The reference has read its initial values too.
        let rows = read(reference);
        let wanted = &rows[width * (HALF + 1)..];
        let found = read(&run);
        let half = wanted.len();
        let after = &found[width * STEPS..];
        let help =
            ["a restored state must be complete: states, inputs, time, memory of events and of the solver"];
        self.same("run.state", "after fmi2SetFMUstate", &after[..half], wanted, report, &help);
        if serializes {
            let what = "after a state went through bytes";
            self.same("run.state", what, &after[half..2 * half], wanted, report, &help);
        }
        Ok(())
    }

    fn instances(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if subject.interface.can("canBeInstantiatedOnlyOncePerProcess") {
            report.findings.push(
                Finding::note("run.instances", "there can be only one instance in a process")
                    .line(subject.interface.line)
                    .help("a system with two of them cannot be run in one process; keep nothing in global variables"),
            );
            return Ok(());
        }
        let mut acts = Vec::new();
        for _ in 0..2 {
            acts.extend(subject.fresh(self.unpacked.plain));
            acts.extend(subject.initialize());
        }
        acts.push((Act::Use(0), true));
        acts.extend(subject.reads());
        for index in 0..STEPS {
            // The other one is ahead, and gets other inputs; it is not read.
            acts.push((Act::Use(1), true));
            acts.extend(subject.excite(index, -3.0));
            acts.push(subject.advance(subject.time(index)));
            acts.push((Act::Use(0), true));
            acts.extend(subject.steps(index..index + 1, 1.0));
        }
        let run = self.obey(acts)?;
        if self.ran("run.instances", "a run of two instances side by side", &run, report) {
            let what = "beside a second instance";
            let help = ["the instances share something: global or static variables"];
            self.same("run.instances", what, &read(&run), &read(reference), report, &help);
        }
        Ok(())
    }

    fn derivatives(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if !subject.interface.can("providesDirectionalDerivative") {
            return Ok(());
        }
        let of = |role: &'static str| {
            let wanted = move |it: &crate::description::Variable| {
                it.causality == role && it.variability == "continuous"
            };
            reals(subject.description, &wanted).map(|(reference, _)| reference).collect::<Vec<u32>>()
        };
        let (inputs, outputs) = (of("input"), of("output"));
        if inputs.is_empty() || outputs.is_empty() {
            return Ok(());
        }
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.extend(subject.steps(0..2, 1.0));
        acts.extend(inputs.iter().map(|input| (Act::Directional(outputs.clone(), *input), true)));
        let run = self.obey(acts)?;
        if self.ran("run.directional", "asking for directional derivatives", &run, report) {
            let derivatives = run.answers.outcomes.iter().rev().take(inputs.len());
            if derivatives.flat_map(Outcome::values).any(|value| !value.is_finite()) {
                let message = "a directional derivative is no finite number";
                report.findings.push(Finding::error("run.directional", message).at(&subject.library));
            }
            report.done.push(format!(
                "{}: directional derivatives to {}",
                self.what(),
                count(inputs.len(), "input")
            ));
        }
        Ok(())
    }

    /// Masters add up their clocks: the last digits of the communication points differ.
    fn clock(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.extend(subject.reads());
        let mut time = subject.time(0);
        for index in 0..STEPS {
            acts.extend(subject.excite(index, 1.0));
            acts.push(subject.advance(time));
            acts.extend(subject.reads());
            time += subject.step;
        }
        let run = self.obey(acts)?;
        if self.ran("run.clock", "a run whose communication points are added up", &run, report)
            && read(&run).len() != read(reference).len()
        {
            report.skipped.push("comparing a run whose communication points are added up".into());
        }
        Ok(())
    }

    fn parameters(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let of = |variability: &'static str| {
            let wanted = move |it: &crate::description::Variable| {
                it.causality == "parameter" && it.variability == variability
            };
            let some = reals(subject.description, &wanted)
                .filter_map(|(reference, variable)| Some((reference, number(variable)?)));
            some.unzip::<u32, f64, Vec<u32>, Vec<f64>>()
        };
        let begin = || {
            let mut acts = subject.fresh(self.unpacked.plain);
            acts.extend(subject.initialize());
            acts.extend(subject.steps(0..2, 1.0));
            acts
        };
        let (references, values) = of("tunable");
        if !references.is_empty() {
            let mut acts = begin();
            acts.push((Act::SetReals(references, values), true));
            acts.extend(subject.steps(2..4, 1.0));
            let run = self.obey(acts)?;
            self.ran("run.tunable", "setting tunable parameters between steps", &run, report);
        }
        let (references, values) = of("fixed");
        if !references.is_empty() {
            let mut acts = begin();
            acts.push((Act::SetReals(references, values), false));
            let run = self.obey(acts)?;
            if run.ending == Ending::Answered && run.answers.outcomes.last().is_some_and(Outcome::is_fine) {
                let message = "fixed parameters can be set between steps, without a word";
                report.findings.push(
                    Finding::note("run.fixed", message)
                        .at(&subject.library)
                        .help("a user believes that they take effect: refuse them, or declare them tunable"),
                );
            }
        }
        Ok(())
    }

    fn same(
        &self,
        rule: &'static str,
        when: &str,
        found: &[&Outcome],
        wanted: &[&Outcome],
        report: &mut Report,
        help: &[&str],
    ) {
        let width = self.subject.width().max(1);
        match found.iter().zip(wanted).position(|(found, wanted)| found != wanted) {
            None if found.len() == wanted.len() => {
                report.done.push(format!("{}: the same results {when}, bit for bit", self.what()));
            }
            place => {
                let step = place.unwrap_or(found.len().min(wanted.len())) / width;
                let message =
                    format!("{when}, the outputs are others than in a plain run, first in row {step}");
                let finding = Finding::error(rule, message).at(&self.subject.library);
                report.findings.push(help.iter().fold(finding, |finding, help| finding.help(*help)));
            }
        }
    }
}

fn status_name(status: i32) -> &'static str {
    match status {
        0 => "fmi2OK",
        1 => "fmi2Warning",
        2 => "fmi2Discard",
        3 => "fmi2Error",
        4 => "fmi2Fatal",
        5 => "fmi2Pending",
        RESTLESS => "without ever coming to rest: it asks for another event iteration a hundred times",
        _ => "a status that FMI does not know",
    }
}
