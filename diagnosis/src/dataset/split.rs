//! The records of a diagnosis, and the stretches over which models are compared to them.

use std::ops::Range;

use rayon::prelude::*;

use crate::data::check::DataProblem;
use crate::dataset::recorded::Dataset;
use crate::diagnosis::{Diagnosis, Options, diagnose};
use crate::rig::Rig;

/// Longest section in seconds of a plant that drifts, or whose phase is soon lost: over a part of it, a model that is far off
/// may still be told from another.
const DRIFTING: f64 = 10.0;
/// So many stretches are made of one.
const PARTS: usize = 3;

/// Estimation and validation data without the noise of the inputs, and validation data as they were measured.
pub struct Split {
    /// Estimation records, ready for the search.
    pub train: Vec<Dataset>,
    /// Validation records, ready for the search.
    pub test: Vec<Dataset>,
    /// Both as the reported model is fitted to them: with motion at twice their rate, where they were measured that finely.
    pub finer: [Vec<Dataset>; 2],
    /// Validation records as they were measured.
    pub measured: Vec<Dataset>,
    /// Both, estimation records first, without divisions.
    pub whole: Vec<Dataset>,
}

impl Split {
    /// Without a record, for what needs none.
    #[cfg(test)]
    pub fn of_nothing() -> Self {
        Self {
            train: Vec::new(),
            test: Vec::new(),
            finer: [Vec::new(), Vec::new()],
            measured: Vec::new(),
            whole: Vec::new(),
        }
    }

    /// Records as they were measured.
    pub fn new(train: &[Dataset], measured: Vec<Dataset>) -> Self {
        let both = |record: &Dataset| {
            let (own, joined) = (record.conditioned(), record.joined());
            let is_whole = joined.sections == record.sections;
            let whole = if is_whole { own.clone() } else { joined.conditioned() };
            (own, whole)
        };
        let all = train.par_iter().chain(&measured).map(both);
        let (mut own, whole): (Vec<Dataset>, Vec<Dataset>) = all.unzip();
        let test = own.split_off(train.len());
        let finer = |records: &[Dataset], conditioned: &[Dataset]| -> Vec<Dataset> {
            records.par_iter().zip(conditioned).map(|(record, own)| record.with_finer_motion(own)).collect()
        };
        let finer = [finer(train, &own), finer(&measured, &test)];
        Self { train: own, test, finer, measured, whole }
    }

    /// The same in shorter stretches, each with states of its own at the start; none if the rig's models keep to long ones.
    pub fn in_parts(&self, rig: &Rig) -> Option<Self> {
        let cut = |records: &[Dataset]| records.iter().map(in_parts).collect::<Vec<_>>();
        let drifts = rig.segment() <= DRIFTING;
        drifts.then(|| Self {
            train: cut(&self.train),
            test: cut(&self.test),
            finer: self.finer.each_ref().map(|it| cut(it)),
            measured: cut(&self.measured),
            whole: self.whole.clone(),
        })
    }

    /// What is the matter with the rig.
    ///
    /// # Errors
    /// If the model refuses its parameters or diverges on the records.
    pub fn diagnosed<'a>(
        &'a self,
        rig: &'a Rig,
        options: Options,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<Diagnosis<'a>, String> {
        diagnose(rig, self, options, progress)
    }

    /// That stretches had to be short.
    pub fn note(&self) -> DataProblem {
        let longest = self
            .measured
            .iter()
            .flat_map(|it| it.sections.iter().map(move |part| it.step * part.len() as f64));
        let longest = longest.fold(0.0, f64::max);
        DataProblem {
            record: "all".into(),
            signal: "time".into(),
            text: format!(
                "the model loses what was measured so soon that it is compared over stretches of {longest:.2} s: errors are \
                 those of so long a prediction"
            ),
            fatal: false,
        }
    }
}

/// A record with each of its sections in parts.
fn in_parts(record: &Dataset) -> Dataset {
    let parts = |section: &Range<usize>| {
        let (start, length) = (section.start, section.len());
        (0..PARTS).map(move |part| start + length * part / PARTS..start + length * (part + 1) / PARTS)
    };
    let sections = record.sections.iter().flat_map(parts).filter(|part| !part.is_empty()).collect();
    Dataset { sections, ..record.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_leave_nothing_out() {
        let record = Dataset { step: 1e-3, sections: vec![0..10, 20..23], ..Dataset::default() };
        let sections = in_parts(&record).sections;
        assert_eq!(sections, [0..3, 3..6, 6..10, 20..21, 21..22, 22..23]);
    }
}
