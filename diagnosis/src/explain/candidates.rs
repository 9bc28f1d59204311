//! Everything that may explain a missing signal: effects with a name, tried in some shapes, and groups of features.

use std::ops::Range;

use rayon::prelude::*;

use crate::catalogue::{Element, Typical};
use crate::estimation::hypothesis::{Baseline, Term};
use crate::missing::Missing;
use crate::missing::innovations::Column;
use crate::missing::motion::{Mover, column, place};
use crate::missing::ports::Entry;
use crate::missing::trajectory::Window;
use crate::plant::Signals;
use crate::screening::{Probe, typical};

use super::features::{Group, features};

/// What may explain a missing signal.
pub enum Kind {
    /// An effect with a name, in one shape.
    Named {
        /// The effect.
        term: Term,
        /// The shape.
        probe: Probe,
    },
    /// Features of a motion at a port.
    Feature {
        /// Number of the port.
        port: usize,
        /// The motion that they are of.
        mover: Mover,
        /// The features.
        group: Group,
    },
}

/// A candidate and its columns.
pub struct Candidate {
    /// What it is.
    pub kind: Kind,
    /// Which columns are its, among all candidates'.
    pub columns: Range<usize>,
    /// Largest magnitude of each feature over the size of a signal that may be missing at its port.
    pub peaks: Vec<f64>,
}

/// All candidates.
pub struct Candidates {
    /// What they are.
    pub list: Vec<Candidate>,
    /// Their columns in each window.
    pub columns: Vec<Vec<Column>>,
}

impl Candidates {
    /// The columns of a candidate, one list for each window.
    pub fn of(&self, candidate: usize) -> Vec<Vec<Column>> {
        let range = &self.list[candidate].columns;
        self.columns.iter().map(|all| all[range.clone()].to_vec()).collect()
    }

    /// None yet, in so many windows.
    pub fn of_windows(count: usize) -> Self {
        Self { list: Vec::new(), columns: vec![Vec::new(); count] }
    }

    /// Takes over a candidate of others.
    pub(super) fn take(&mut self, mut others: Self, candidate: usize) {
        let columns = others.of(candidate);
        let Candidate { kind, peaks, .. } = others.list.swap_remove(candidate);
        self.add(kind, columns, peaks);
    }

    pub(super) fn add(&mut self, kind: Kind, columns: Vec<Vec<Column>>, peaks: Vec<f64>) {
        let first = self.columns.first().map_or(0, Vec::len);
        let count = columns.first().map_or(0, Vec::len);
        for (all, own) in self.columns.iter_mut().zip(columns) {
            all.extend(own);
        }
        self.list.push(Candidate { kind, columns: first..first + count, peaks });
    }
}

impl Baseline<'_> {
    /// Typical magnitudes of each element along the trajectory.
    pub fn typical_along(&self, missing: &Missing<'_>, outputs: &[Signals]) -> Vec<(Element, Typical)> {
        let count = self.rig.plant.outputs.len();
        let nothing = |record: &crate::dataset::recorded::Dataset| vec![vec![f64::NAN; record.len()]; count];
        let mut whole: Vec<Signals> = missing.records.iter().map(nothing).collect();
        for (window, signals) in missing.windows.iter().zip(outputs) {
            for (whole, signal) in whole[window.record].iter_mut().zip(signals) {
                whole[window.samples.clone()].copy_from_slice(signal);
            }
        }
        let parameters = &missing.point().parameters;
        typical((self.rig, parameters), &missing.records[..missing.train], &whole[..missing.train])
    }

    /// All candidates but those that are explained already.
    pub fn candidates(&self, missing: &Missing<'_>, outputs: &[Signals], explained: &[Term]) -> Candidates {
        let mut all = Candidates::of_windows(missing.windows.len());
        self.laws(missing, explained, &mut all);
        self.features(missing, outputs, &mut all);
        all
    }

    fn laws(&self, missing: &Missing<'_>, explained: &[Term], all: &mut Candidates) {
        let (setting, windows) = (&missing.setting, &missing.windows);
        let (terms, at) = (self.terms(), missing.point());
        let shapes: Vec<(Term, Probe)> = terms
            .iter()
            .enumerate()
            .filter(|(_, term)| !explained.contains(term))
            .flat_map(|(index, term)| self.probes(index, *term, &at).into_iter().map(|probe| (*term, probe)))
            .collect();
        let columns = |(term, probe): &(Term, Probe)| -> Option<Vec<Vec<Column>>> {
            let dynamics = self.dynamics(&[*term]).ok()?;
            let of = |window: &Window| {
                let about = (missing.records, window);
                probe.points.iter().map(|point| setting.changed(about, (*term, &*dynamics), point)).collect()
            };
            windows.iter().map(of).collect()
        };
        let made: Vec<Option<Vec<Vec<Column>>>> = shapes.par_iter().map(columns).collect();
        for ((term, probe), columns) in shapes.into_iter().zip(made) {
            if let Some(columns) = columns {
                all.add(Kind::Named { term, probe }, columns, Vec::new());
            }
        }
    }

    fn features(&self, missing: &Missing<'_>, outputs: &[Signals], all: &mut Candidates) {
        let setting = &missing.setting;
        let commands: Vec<usize> = setting
            .ports
            .iter()
            .filter_map(|port| match port.entry {
                Entry::Input(input) => Some(input),
                Entry::Constant(_) | Entry::Sensor(_) => None,
            })
            .collect();
        let others = missing.records.first().map_or(0, |record| record.others.len());
        for (number, port) in setting.ports.iter().enumerate() {
            if setting.ties[number] != number {
                continue;
            }
            for (further, mover) in Mover::all(self.rig, port, &missing.records[0]).into_iter().enumerate() {
                let groups = if further > 0 { Group::CURVES.to_vec() } else { Group::all(&commands, others) };
                for group in groups {
                    self.feature(missing, outputs, (number, mover, group), all);
                }
            }
        }
    }

    /// Features of a group at a port as a further candidate, if its motion is known.
    pub(super) fn feature(
        &self,
        missing: &Missing<'_>,
        outputs: &[Signals],
        (number, mover, group): (usize, Mover, Group),
        all: &mut Candidates,
    ) {
        let (setting, windows) = (&missing.setting, &missing.windows);
        let port = &setting.ports[number];
        let Some(motions) = mover.motions(self.rig, (port, windows), outputs) else { return };
        let signals = features(group, &motions, (missing.records, windows));
        let place = place(setting, number);
        let columns = windows.iter().enumerate().map(|(index, window)| {
            signals.iter().map(|signal| column(port, place, window, &signal[index])).collect()
        });
        let size = setting.sizes[number].max(f64::MIN_POSITIVE);
        let peak = |signal: &Vec<Vec<f64>>| {
            signal.iter().flatten().fold(0.0_f64, |most, it| most.max(it.abs())) / size
        };
        let peaks = signals.iter().map(peak).collect();
        all.add(Kind::Feature { port: number, mover, group }, columns.collect(), peaks);
    }
}
