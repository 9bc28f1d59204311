//! Rules for whole runs: each has to come to the same as a plain one.

use std::collections::BTreeMap;

use super::Bench;
use super::subject::{HALF, STEPS, plain, read};
use crate::finding::{Finding, Report};
use crate::probe::{Act, Outcome, Run};
use crate::rules::{Rule, fmi};

/// Relative tolerance of who names none.
const TOLERANCE: f64 = 1e-4;
/// How many tolerances the steps of a run may add up to.
const STEPS_ADD_UP: f64 = 100.0;

impl Bench<'_> {
    /// In a folder whose name has spaces and umlauts.
    pub(super) fn resources(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let acts = self.whole(self.unpacked.odd, false);
        let run = self.probe.run(self.subject.orders(self.unpacked.odd, acts))?;
        let what = "a run in a folder whose name has spaces, percent signs and umlauts";
        let help = "fmuResourceLocation is an address: `%20` in it is a space in the path";
        if let Some(error) = &run.answers.unloadable {
            let message = format!("the library does not load from such a folder: {error}");
            report.findings.push(Finding::error(fmi::RESOURCES, message).at(&self.subject.library));
        } else if !self.ran(fmi::RESOURCES, what, &run, report) {
            report.findings.last_mut().into_iter().for_each(|finding| finding.help.push(help.into()));
        } else if read(&run) != read(reference) {
            let message = format!("{what} has other results");
            report.findings.push(Finding::error(fmi::RESOURCES, message).help(help));
        }
        Ok(())
    }

    pub(super) fn reset(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let mut acts = self.subject.fresh(self.unpacked.plain);
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.steps(0..HALF, -3.0));
        let before = self.subject.width() * HALF;
        acts.push(plain("Reset"));
        acts.extend(self.subject.initialize());
        acts.extend(self.subject.reads());
        acts.extend(self.subject.steps(0..STEPS, 1.0));
        let run = self.obey(acts)?;
        if !self.ran(fmi::RESET, "a run after fmi2Reset", &run, report) {
            return Ok(());
        }
        self.same(
            fmi::RESET,
            "after fmi2Reset",
            &read(&run)[before..],
            &read(reference),
            report,
            "a reset instance must be as a new one: states, inputs, parameters, time, memory of events",
        );
        Ok(())
    }

    pub(super) fn states(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
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
        acts.extend(subject.reads());
        acts.extend(subject.steps(HALF..STEPS, 1.0));
        if serializes {
            acts.push((Act::Serialize(0, 1), true));
            acts.push((Act::FreeState(0), true));
            acts.push((Act::Restore(1), true));
            acts.extend(subject.reads());
            acts.extend(subject.steps(HALF..STEPS, 1.0));
            acts.push((Act::FreeState(1), true));
        } else {
            acts.push((Act::FreeState(0), true));
        }
        acts.extend([plain("Terminate"), (Act::Free, true)]);
        let run = self.obey(acts)?;
        if !self.ran(fmi::STATE_LATER, "a run with a saved state", &run, report) {
            return Ok(());
        }
        report.findings.extend(self.memory(&run));
        let width = subject.width();
        // The reference has read its initial values too.
        let rows = read(reference);
        let wanted = &rows[width * HALF..];
        let found = read(&run);
        let half = wanted.len();
        let after = &found[width * STEPS..];
        self.restored("after fmi2SetFMUstate", &after[..half], wanted, report);
        if serializes {
            self.restored("after a state went through bytes", &after[half..2 * half], wanted, report);
        }
        Ok(())
    }

    /// What is read at the restored point must be what was read there. A solver that begins anew comes to slightly
    /// other values later on: its tolerance holds for each of its steps.
    fn restored(&self, when: &str, found: &[&Outcome], wanted: &[&Outcome], report: &mut Report) {
        let help =
            "a restored state must be complete: states, inputs, time, memory of events and of the solver";
        let width = self.subject.width();
        if found[..width] != wanted[..width] {
            let message =
                format!("{when}, the outputs at the restored point are others than those that were saved");
            report
                .findings
                .push(Finding::error(fmi::STATE_POINT, message).at(&self.subject.library).help(help));
            return;
        }
        self.same(fmi::STATE_LATER, when, found, wanted, report, help);
    }

    /// Compares a run with the plain one: it is the same bit for bit, or differs by what a solver that begins anew may add.
    fn same(
        &self,
        rule: &'static Rule,
        when: &str,
        found: &[&Outcome],
        wanted: &[&Outcome],
        report: &mut Report,
        help: &str,
    ) {
        let tolerance = self.subject.description.experiment.tolerance.unwrap_or(TOLERANCE);
        let differ = |apart: f64| {
            format!(
                "{when}, outputs differ from those of a plain run by up to {apart:.1e} of their largest value"
            )
        };
        let finding = match apart(found, wanted, self.subject.width()) {
            Some(0.0) => {
                report.done.push(format!("{}: the same results {when}, bit for bit", self.what()));
                return;
            }
            Some(apart) if apart <= tolerance => {
                let message = format!("{}, which is within the tolerance of {tolerance:.0e}", differ(apart));
                let help =
                    "the solver begins anew; keep what it remembers, and runs are repeated bit for bit";
                Finding::note(rule, message).help(help)
            }
            // Beside another instance, no solver begins anew.
            Some(apart) if apart <= STEPS_ADD_UP * tolerance && rule != fmi::INSTANCES => {
                let message = format!("{}, more than the tolerance of {tolerance:.0e}", differ(apart));
                Finding::warning(rule, message).help(help)
            }
            Some(apart) => {
                let message = format!(
                    "{}, more than the tolerance of {tolerance:.0e} in each of many steps",
                    differ(apart)
                );
                Finding::error(rule, message).help(help)
            }
            None => {
                Finding::error(rule, format!("{when}, outputs are others than in a plain run")).help(help)
            }
        };
        report.findings.push(finding.at(&self.subject.library));
    }
    pub(super) fn instances(&self, reference: &Run, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if subject.interface.can("canBeInstantiatedOnlyOncePerProcess") {
            report.findings.push(
                Finding::note(fmi::INSTANCES, "there can be only one instance in a process")
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
            // The other one gets other inputs, between those of the first and its step; it is not read.
            acts.push((Act::Use(0), true));
            acts.extend(subject.excite(index, 1.0));
            acts.push((Act::Use(1), true));
            acts.extend(subject.excite(index, -3.0));
            acts.push(subject.advance(subject.time(index)));
            acts.push((Act::Use(0), true));
            acts.push(subject.advance(subject.time(index)));
            acts.extend(subject.reads());
        }
        let run = self.obey(acts)?;
        if self.ran(fmi::INSTANCES, "a run of two instances side by side", &run, report) {
            let what = "beside a second instance";
            let help = "the instances share something: global or static variables";
            self.same(fmi::INSTANCES, what, &read(&run), &read(reference), report, help);
        }
        Ok(())
    }

    /// Masters add up their clocks: the last digits of the communication points differ.
    pub(super) fn clock(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        let mut acts = subject.fresh(self.unpacked.plain);
        acts.extend(subject.initialize());
        let mut time = subject.time(0);
        for index in 0..STEPS {
            acts.extend(subject.excite(index, 1.0));
            acts.push(subject.advance(time));
            time += subject.step;
        }
        let run = self.obey(acts)?;
        self.ran(fmi::CLOCK, "a run whose communication points are added up", &run, report);
        Ok(())
    }
}

/// How far the reals of two runs are apart, in shares of each one's largest value; none if anything else differs, or a number is
/// none in one of them.
fn apart(found: &[&Outcome], wanted: &[&Outcome], width: usize) -> Option<f64> {
    if found.len() != wanted.len() {
        return None;
    }
    // Largest difference and largest value of each signal: by its place in what is read once.
    let mut signals: BTreeMap<(usize, usize), [f64; 2]> = BTreeMap::new();
    for (index, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let others = |it: &Outcome| (it.status, it.integers.clone(), it.texts.clone(), it.reals.len());
        if others(found) != others(wanted) {
            return None;
        }
        for (place, (found, wanted)) in found.values().zip(wanted.values()).enumerate() {
            let difference = if found.to_bits() == wanted.to_bits() { 0.0 } else { (found - wanted).abs() };
            if difference.is_nan() {
                return None;
            }
            let [largest, size] = signals.entry((index % width, place)).or_insert([0.0, 0.0]);
            (*largest, *size) = (largest.max(difference), size.max(wanted.abs()));
        }
    }
    let share = |[difference, size]: &[f64; 2]| {
        if *difference == 0.0 { 0.0 } else { difference / size.max(f64::MIN_POSITIVE) }
    };
    Some(signals.values().map(share).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(values: &[f64]) -> Vec<Outcome> {
        let row = |value: &f64| Outcome {
            status: 0,
            reals: vec![value.to_bits()],
            integers: Vec::new(),
            texts: Vec::new(),
        };
        values.iter().map(row).collect()
    }

    #[test]
    fn differences_are_shares_of_a_signals_largest_value() {
        let share = |found: &[f64], wanted: &[f64]| {
            let (found, wanted) = (rows(found), rows(wanted));
            apart(&found.iter().collect::<Vec<_>>(), &wanted.iter().collect::<Vec<_>>(), 1)
        };
        assert_eq!(share(&[1.0, 2.0, 5.0], &[1.0, 2.0, 5.0]), Some(0.0));
        assert_eq!(share(&[1.0, 2.5, 5.0], &[1.0, 2.0, 5.0]), Some(0.1));
        assert_eq!(share(&[1.0, f64::NAN], &[1.0, f64::NAN]), Some(0.0));
        assert_eq!(share(&[1.0, f64::NAN], &[1.0, 2.0]), None);
        assert_eq!(share(&[1.0], &[1.0, 2.0]), None);
        assert!(share(&[0.0, 0.1], &[0.0, 0.0]).unwrap() > 1e10);
    }
}
