//! Rules for the ends of instances and of saved states.

use super::Bench;
use super::subject::{HALF, plain, read};
use crate::finding::{Finding, Level, Report};
use crate::probe::Act;
use crate::rules::fmi;

impl Bench<'_> {
    /// What was reached can be read after the end.
    pub(super) fn terminated(&self, report: &mut Report) -> Result<(), String> {
        let (subject, rule) = (&self.subject, fmi::TERMINATED);
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.extend(subject.steps(0..2, 1.0));
        acts.push(plain("Terminate"));
        acts.extend(subject.reads());
        acts.push((Act::Free, true));
        let run = self.obey(acts)?;
        if !self.ran(rule, "reading values after fmi2Terminate", &run, report) {
            soften(report);
            return Ok(());
        }
        let (rows, width) = (read(&run), subject.width());
        if rows[width..2 * width] != rows[2 * width..] {
            let message = "after fmi2Terminate, outputs are others than at the end of the last step";
            let help = "importers read the final values there";
            report.findings.push(Finding::warning(rule, message).at(&subject.library).help(help));
        }
        Ok(())
    }

    /// A null pointer is freed.
    pub(super) fn nothing(&self, report: &mut Report) -> Result<(), String> {
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend([(Act::FreeNothing, true), (Act::Free, true)]);
        let run = self.obey(acts)?;
        if !self.ran(fmi::FREE_NULL, "freeing no instance", &run, report) {
            soften(report);
        }
        Ok(())
    }

    /// A state is saved over another one, restored, and freed.
    pub(super) fn again(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if !subject.interface.can("canGetAndSetFMUstate") {
            return Ok(());
        }
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        acts.push((Act::Save(0), true));
        acts.extend(subject.steps(0..HALF, 1.0));
        acts.push((Act::Save(0), true));
        acts.extend(subject.steps(HALF..HALF + 2, 1.0));
        acts.push((Act::Restore(0), true));
        acts.extend(subject.reads());
        acts.extend([(Act::FreeState(0), true), plain("Terminate"), (Act::Free, true)]);
        let run = self.obey(acts)?;
        if !self.ran(fmi::STATE_AGAIN, "a run with a state that is saved over another", &run, report) {
            soften(report);
            return Ok(());
        }
        let (rows, width) = (read(&run), subject.width());
        if rows[width * (HALF - 1)..width * HALF] != rows[width * (HALF + 2)..] {
            let message = "a state that is saved over another one is not restored: the first one is";
            let help = "write into the state that fmi2GetFMUstate is given; importers save at each step";
            report.findings.push(Finding::warning(fmi::STATE_AGAIN, message).at(&subject.library).help(help));
        }
        let outcomes = run.acts.iter().zip(&run.answers.outcomes);
        let freed = outcomes.filter(|((act, _), _)| matches!(act, Act::FreeState(_)));
        if freed.into_iter().any(|(_, outcome)| outcome.integers != [1]) {
            let message = "fmi2FreeFMUstate leaves the pointer as it is";
            let help = "set it to null: who frees a state again would free what is no longer there";
            report.findings.push(Finding::warning(fmi::STATE_FREED, message).at(&subject.library).help(help));
        }
        Ok(())
    }
}

/// Makes the last finding a warning: few importers go this way.
fn soften(report: &mut Report) {
    if let Some(finding) = report.findings.last_mut() {
        finding.level = Level::Warning;
    }
}
