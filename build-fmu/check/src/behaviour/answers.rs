//! Rules for what single calls answer.

use super::Bench;
use super::subject::{number, plain, read, reals};
use crate::description::Variable;
use crate::finding::{Finding, Report, count, names};
use crate::probe::{Act, Ending, Log, Memory, Outcome, Run};
use crate::rules::{Rule, fmi, practice};

impl Bench<'_> {
    /// The first run goes no further than the initialisation, and compares what is described. While it is initialised,
    /// only outputs and initial unknowns may be read, so the values are read directly after.
    pub(super) fn start_values(&self, report: &mut Report) -> Result<Run, String> {
        let exact = |variable: &Variable| {
            let set = matches!(variable.causality.as_str(), "parameter" | "input");
            set || (variable.effective_initial() == Some("exact") && variable.variability != "constant")
        };
        let (references, variables): (Vec<u32>, Vec<_>) = reals(self.subject.description, &exact)
            .filter(|(_, variable)| number(variable).is_some())
            .unzip();
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.begin());
        acts.push(plain("ExitInitializationMode"));
        acts.push((Act::Reals(references), false));
        let run = self.obey(acts)?;
        let Some(outcome) = run.answers.outcomes.last().filter(|outcome| outcome.is_fine()) else {
            return Ok(run);
        };
        let differs = |(variable, value): &(&&Variable, f64)| {
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
            report.findings.push(Finding::error(fmi::START_KEPT, message).line(variable.line).help(help));
        }
        Ok(run)
    }

    /// What the library says of itself and logs.
    pub(super) fn words(&self, run: &Run) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut wrong = |rule: &'static Rule, function: &str, found: &Option<String>, wanted: &str| {
            if let Some(found) = found.as_ref().filter(|found| *found != wanted) {
                let message = format!("{function} returns \"{found}\", but must return \"{wanted}\"");
                findings.push(Finding::error(rule, message).at(&self.subject.library));
            }
        };
        wrong(fmi::VERSION, "fmi2GetVersion", &run.answers.version, "2.0");
        wrong(fmi::TYPES_PLATFORM, "fmi2GetTypesPlatform", &run.answers.types, "default");
        findings.extend(self.log(&run.answers.log));
        findings
    }

    fn log(&self, log: &Log) -> Vec<Finding> {
        let mut findings = Vec::new();
        let library = &self.subject.library;
        if log.null_text || log.invalid_text {
            let what = if log.null_text { "name or text is null" } else { "text is not encoded in UTF-8" };
            let message = format!("the library logs messages whose {what}");
            findings.push(Finding::warning(fmi::LOG_TEXT, message).at(library));
        }
        let declared = &self.subject.description.categories;
        let help = "importers build a string of it, and some crash; give one of the declared categories";
        if log.null_category {
            let message = "the library logs messages whose category is null";
            // Without categories, the standard wants a null.
            findings.push(if declared.is_empty() {
                Finding::note(fmi::LOG_CATEGORY, message)
                    .at(library)
                    .help("declare <LogCategories>")
                    .help(help)
            } else {
                Finding::warning(fmi::LOG_CATEGORY, message).at(library).help(help)
            });
        }
        let others: Vec<&str> = log
            .categories
            .iter()
            .map(String::as_str)
            .filter(|name| !declared.iter().any(|it| it == name))
            .collect();
        if !others.is_empty() {
            let message =
                format!("messages are logged in categories that are not declared: {}", names(&others));
            findings.push(
                Finding::note(fmi::LOG_CATEGORY, message).at(library).help(
                    "declare them in <LogCategories>: importers show and choose what is declared there",
                ),
            );
        }
        findings
    }

    /// Outputs are numbers, and no text is null.
    pub(super) fn numbers(&self, run: &Run) -> Vec<Finding> {
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
            findings.push(Finding::error(practice::FINITE, message).at(&self.subject.library));
        }
        if outcomes.iter().any(|outcome| outcome.texts.contains(&None)) {
            let message = "fmi2GetString gives a null, or a text that is not encoded in UTF-8";
            findings.push(Finding::error(fmi::TEXT_VALUE, message).at(&self.subject.library));
        }
        findings
    }

    /// What is got from the importer's memory goes back to it.
    pub(super) fn memory(&self, run: &Run) -> Vec<Finding> {
        let Memory { allocated, left, bytes, foreign } = run.answers.memory;
        let mut findings = Vec::new();
        let library = &self.subject.library;
        if self.subject.interface.can("canNotUseMemoryManagementFunctions") && allocated + foreign > 0 {
            let message =
                "allocateMemory or freeMemory is called, although canNotUseMemoryManagementFunctions is true";
            let help = "importers may give null pointers for them";
            return vec![Finding::error(fmi::MEMORY_OWN, message).at(library).help(help)];
        }
        if foreign > 0 {
            let message = format!(
                "freeMemory is given {}",
                count(foreign, "pointer that allocateMemory has not given")
            );
            let help = "or one that is freed already: importers with an allocator of their own crash";
            findings.push(Finding::error(fmi::MEMORY_FOREIGN, message).at(library).help(help));
        }
        if left > 0 && run.ending == Ending::Answered && run.failure().is_none() {
            let message = format!(
                "{} of {allocated} from allocateMemory ({bytes} bytes) are not freed when all instances and states are",
                count(left, "block")
            );
            findings.push(
                Finding::error(fmi::MEMORY_FREED, message).at(library).help(
                    "an importer that makes many instances, as an optimisation does, runs out of memory",
                ),
            );
        }
        findings
    }

    /// Derivatives of inputs and outputs, up to the order that is promised.
    pub(super) fn slopes(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let of = |role: &'static str| {
            let wanted = move |it: &Variable| it.causality == role && it.variability == "continuous";
            reals(subject.description, &wanted).map(|(reference, _)| reference).collect::<Vec<u32>>()
        };
        let (inputs, outputs) = (of("input"), of("output"));
        if subject.interface.can("canInterpolateInputs") && !inputs.is_empty() {
            let mut acts = subject.fresh(self.unpacked.plain);
            acts.extend(subject.initialize());
            acts.extend(subject.excite(0, 1.0));
            // Derivatives of zero leave a run as it is.
            let rates = vec![0.0; inputs.len()];
            acts.push((Act::InputDerivatives(inputs, rates), true));
            acts.push(subject.advance(subject.time(0)));
            acts.extend(subject.reads());
            let run = self.obey(acts)?;
            let what = "setting derivatives of inputs, which canInterpolateInputs promises";
            self.ran(fmi::INPUT_DERIVATIVES, what, &run, report);
        }
        let promised = subject.interface.number("maxOutputDerivativeOrder");
        // A promise of thousands is tried as far as anyone asks.
        let orders = 1..=i32::try_from(promised.min(5)).unwrap_or(0);
        if outputs.is_empty() || orders.is_empty() {
            return Ok(());
        }
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.extend(subject.steps(0..2, 1.0));
        acts.extend(orders.clone().map(|order| (Act::OutputDerivatives(outputs.clone(), order), true)));
        let run = self.obey(acts)?;
        let what = format!("reading derivatives of outputs up to order {promised}, which is promised");
        if self.ran(fmi::OUTPUT_DERIVATIVES, &what, &run, report) {
            let last = run.answers.outcomes.iter().rev().take(orders.count());
            if last.flat_map(Outcome::values).any(|value| !value.is_finite()) {
                let message = "a derivative of an output is no finite number";
                report.findings.push(Finding::error(fmi::OUTPUT_DERIVATIVES, message).at(&subject.library));
            }
        }
        Ok(())
    }

    /// Nominal values of states, by which importers scale their tolerance.
    pub(super) fn nominals(&self, report: &mut Report) -> Result<(), String> {
        let states = self.subject.description.derivatives.len();
        if states == 0 {
            return Ok(());
        }
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.initialize());
        acts.push((Act::Nominals(states), true));
        let run = self.obey(acts)?;
        if self.ran(fmi::NOMINALS, "reading nominal values of states", &run, report)
            && let Some(value) =
                run.answers.outcomes.last().and_then(|it| it.values().find(|it| it.is_nan() || *it <= 0.0))
        {
            let message = format!("fmi2GetNominalsOfContinuousStates gives {value}, which must be positive");
            report.findings.push(Finding::error(fmi::NOMINALS, message).at(&self.subject.library));
        }
        Ok(())
    }

    pub(super) fn guid(&self, report: &mut Report) -> Result<(), String> {
        let (act, _) = self.subject.instantiate(self.unpacked.plain, "{00000000-no-such-guid}", false);
        let run = self.obey(vec![(act, false)])?;
        if run.ending != Ending::Answered {
            self.ran(fmi::GUID_CHECKED, "an instantiation with a wrong GUID", &run, report);
        } else if run.answers.outcomes.first().is_some_and(Outcome::is_fine) {
            let message = "fmi2Instantiate accepts a wrong GUID";
            let help = "it should log an error and return null: with it, a library and a description that do not belong \
                together run, with values mixed up";
            report
                .findings
                .push(Finding::warning(fmi::GUID_CHECKED, message).at(&self.subject.library).help(help));
        } else {
            report.done.push("a wrong GUID is refused".into());
        }
        Ok(())
    }

    pub(super) fn unknown_reference(&self, report: &mut Report) -> Result<(), String> {
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
            self.ran(fmi::REFERENCE_UNKNOWN, what, &run, report);
        } else if run.answers.outcomes.last().is_some_and(Outcome::is_fine) {
            let message = format!(
                "fmi2GetReal returns fmi2OK for the value reference {unknown}, which there is none of"
            );
            let help = "it should return fmi2Error, so that a mistake in a master is found";
            report
                .findings
                .push(Finding::warning(fmi::REFERENCE_UNKNOWN, message).at(&self.subject.library).help(help));
        }
        Ok(())
    }

    pub(super) fn parameters(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let of = |variability: &'static str| {
            let wanted = move |it: &Variable| it.causality == "parameter" && it.variability == variability;
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
            self.ran(fmi::TUNABLE, "setting tunable parameters between steps", &run, report);
        }
        let (references, values) = of("fixed");
        if !references.is_empty() {
            let mut acts = begin();
            acts.push((Act::SetReals(references, values), false));
            let run = self.obey(acts)?;
            if run.ending == Ending::Answered && run.answers.outcomes.last().is_some_and(Outcome::is_fine) {
                let message = "fixed parameters can be set between steps, without a word";
                report.findings.push(
                    Finding::note(fmi::FIXED, message)
                        .at(&subject.library)
                        .help("a user believes that they take effect: refuse them, or declare them tunable"),
                );
            }
        }
        Ok(())
    }

    pub(super) fn derivatives(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if !subject.interface.can("providesDirectionalDerivative") {
            return Ok(());
        }
        let of = |role: &'static str| {
            let wanted = move |it: &Variable| it.causality == role && it.variability == "continuous";
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
        if self.ran(fmi::DIRECTIONAL, "asking for directional derivatives", &run, report) {
            let derivatives = run.answers.outcomes.iter().rev().take(inputs.len());
            if derivatives.flat_map(Outcome::values).any(|value| !value.is_finite()) {
                let message = "a directional derivative is no finite number";
                report.findings.push(Finding::error(fmi::DIRECTIONAL, message).at(&subject.library));
            }
            report.done.push(format!(
                "{}: directional derivatives to {}",
                self.what(),
                count(inputs.len(), "input")
            ));
        }
        Ok(())
    }
}
