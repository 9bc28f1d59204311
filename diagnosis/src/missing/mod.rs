//! What signal is missing in a model, and where: before any effect is named.
//!
//! Every place where something may be missing is a [port](ports). A smoother about the model's own linearisation estimates
//! the missing signal, port by port, from all records; the likelihoods say where something is missing (N. R. Kristensen,
//! H. Madsen, S. B. Jørgensen, A method for systematic improvement of stochastic grey-box models, Computers & Chemical
//! Engineering 28 (2004)).

pub mod filter;
pub mod innovations;
pub mod likelihood;
pub mod locate;
mod look;
pub mod motion;
mod nominal;
pub mod ports;
mod rough;
mod start;
pub mod trajectory;

use std::ops::Range;

use rayon::prelude::*;

use crate::catalogue;
use crate::dataset::recorded::Dataset;
use crate::estimation::coordinates::{TIMING, TOLERANCE};
use crate::estimation::hypothesis::{Baseline, Term};
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::plant::Dynamics;
use crate::signal::distortion::Correction;

use innovations::Column;
use nominal::About;
use ports::Port;
use trajectory::{Setting, Window};

/// Samples of all records together that are looked at: half a minute at the rate of conditioned records.
const SAMPLES: usize = 12_000;
/// Longest stretch that is filtered in one go, in seconds, and as many samples of a record that has fewer in that time: of what is slow,
/// friction remembers for long where it came from.
const LONGEST: (f64, usize) = (10.0, 4000);
/// Share of the velocity within which a parameter set lets friction turn over in which it may really do so.
const SHARP: f64 = 0.05;
/// The delay that a timing column stands for, in seconds.
const DELAY: f64 = 1e-3;

/// A rig's model about the trajectory of its records.
pub struct Missing<'a> {
    /// Estimation records, then validation records.
    pub records: &'a [Dataset],
    /// How many of them are estimation records.
    pub train: usize,
    /// What the smoother knows of the rig.
    pub setting: Setting<'a>,
    /// The predictions about the trajectory.
    pub windows: Vec<Window>,
    /// Laws that go along the trajectory.
    stated: &'a [Law],
    /// What was known of each nuisance before: precisions of nominal parameters, then of the channels' timing, then of what was
    /// explained.
    pub precisions: Vec<f64>,
}

/// What a smoother needs to outlive it.
pub struct Frame {
    /// Estimation records, then validation records, freed of what sensors are known to do.
    records: Vec<Dataset>,
    /// The same with errors of their inputs, where these are noisy.
    disturbed: Vec<Option<Dataset>>,
    point: Estimate,
    /// Whether those that nobody states may be off by decades.
    far: bool,
    dynamics: Box<dyn Dynamics>,
    /// Laws that go along the trajectory: those of the parameter set, and friction that was found.
    stated: Vec<Law>,
    /// Other laws that were found.
    found: Vec<Law>,
    ports: Vec<Port>,
    parameters: Vec<usize>,
    nominal: Vec<f64>,
}

/// A law that acts beside the model, along the trajectory: friction inside a prediction would stick where the rig does not.
struct Law {
    term: Term,
    /// The model that has it.
    dynamics: Box<dyn Dynamics>,
    /// Its values.
    values: Vec<(Unknown, f64)>,
}

impl Law {
    /// A point with friction that turns over as sharply as that of a body that really sticks.
    fn sharp(&self, point: &Estimate) -> Estimate {
        let mut point = point.clone();
        if let (Term::Effect(effect), [_, (handle, velocity)]) = (self.term, &self.values[..])
            && effect.is_friction()
        {
            point.set(*handle, SHARP * velocity);
        }
        point
    }

    /// A point with the law.
    fn at(&self, point: &Estimate) -> Estimate {
        let mut point = point.clone();
        self.values.iter().for_each(|(handle, value)| point.set(*handle, *value));
        point
    }
}

impl Baseline<'_> {
    /// Equations, ports and nominal parameters of the rig with what was found so far.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn frame(&self, found: &[Term], at: &Estimate) -> Result<Frame, String> {
        let record = self.train.first().ok_or("there is no estimation record")?;
        let mut point = Estimate { starts: Vec::new(), ..at.clone() };
        let mut records = self.whole.to_vec();
        // Of the channels' timing only what was found is known; the rest is looked at anew.
        for (output, distortion) in point.outputs.iter_mut().enumerate() {
            let told = |term: &Term| match term {
                Term::Fault(Unknown::Output(of, _)) | Term::Response(of) => *of == output,
                _ => false,
            };
            let before = std::mem::take(distortion);
            if found.iter().any(told) {
                for record in &mut records {
                    undistorted(record, output, &before);
                }
            }
        }
        let law = |term: Term, handles: Vec<Unknown>| {
            let values = handles.into_iter().map(|handle| (handle, at.get(handle))).collect();
            Ok::<_, String>(Law { term, dynamics: self.dynamics(&[term])?, values })
        };
        let (mut stated, mut laws) = (Vec::new(), Vec::new());
        let nominal: Vec<usize> =
            self.rig.nominal().filter_map(|name| self.rig.plant.parameter(name)).collect();
        for effect in catalogue::effects(&self.rig.plant) {
            let parts = effect.parts.iter().filter_map(|part| self.rig.plant.parameter(part.parameter));
            let parts: Vec<usize> = parts.collect();
            let there = |amount: &usize| {
                self.rig.parameters[*amount] != 0.0 && self.rig.stated[*amount] && !nominal.contains(amount)
            };
            if parts.first().is_some_and(there) {
                let handles = parts.iter().map(|it| Unknown::Parameter(*it)).collect();
                stated.push(law(Term::Effect(effect), handles)?);
                parts.iter().for_each(|it| point.parameters[*it] = self.rig.plant.parameters[*it].start);
            }
        }
        for term in found.iter().filter(|term| matches!(term, Term::Effect(_) | Term::Table(_))) {
            let handles: Vec<Unknown> = self.own_coordinates(*term).into_iter().map(|it| it.handle).collect();
            handles.iter().for_each(|handle| point.set(*handle, self.origin().get(*handle)));
            // Friction goes along as if a parameter set stated it: within the trajectory's accuracy it may have either sign.
            let is_friction = matches!(term, Term::Effect(effect) if effect.is_friction());
            if is_friction { &mut stated } else { &mut laws }.push(law(*term, handles)?);
        }
        let mut parameters = self.rig.base();
        for (handle, _) in stated.iter().chain(&laws).flat_map(|it: &Law| &it.values) {
            parameters.retain(|it| *handle != Unknown::Parameter(*it));
        }
        let states = self.rig.plant.states.iter();
        Ok(Frame {
            disturbed: records.iter().map(Dataset::disturbed).collect(),
            records,
            point,
            far: false,
            dynamics: self.dynamics(&[])?,
            parameters,
            stated,
            found: laws,
            ports: Port::all(self.rig, record),
            nominal: states.map(|it| it.nominal.unwrap_or(1.0)).collect(),
        })
    }

    /// The model about the trajectory that the sensors tell, its nominal parameters corrected as far as the missing signals allow.
    ///
    /// # Errors
    /// If the model diverges along every stretch.
    pub fn missing<'b>(&self, frame: &'b Frame) -> Result<Missing<'b>, String> {
        self.missing_with(frame, None)
    }

    /// The same with variances of the measured outputs' errors that are known by now.
    ///
    /// # Errors
    /// If the model diverges along every stretch.
    pub fn missing_with<'b>(&self, frame: &'b Frame, errors: Option<&[f64]>) -> Result<Missing<'b>, String> {
        let timing = self.coordinates(&[]).into_iter().map(|it| it.handle);
        let timing: Vec<Unknown> = timing.filter(|it| matches!(it, Unknown::Output(..))).collect();
        let stretches = stretches(&frame.records, SAMPLES, usize::MAX);
        let about = About { frame, errors, stretches: &stretches, timing: &timing };
        let mut precisions = self.precisions(&frame.parameters);
        precisions.extend(timing.iter().map(|_| (DELAY / TIMING).powi(2)));
        precisions.extend(frame.stated.iter().map(|_| TOLERANCE.powi(-2)));
        precisions.extend(frame.found.iter().map(|_| 0.0));
        let [before, point] = self.nominal_by_balance(&about, &precisions);
        // A last step too far is taken back.
        let whole = self.along(&about, &point).map(|along| (along, point));
        let ((setting, windows), point) = match whole {
            Ok(it) => it,
            Err(_) => (self.along(&about, &before)?, before),
        };
        let (records, train) = (&frame.records[..], self.train.len());
        let mut missing = Missing { records, train, stated: &frame.stated, setting, windows, precisions };
        // Where nothing needs to be missing, a trajectory that follows the sensors follows their noise.
        let location = missing.located();
        let likely = location.ranked.iter().filter(|it| it.gain > 0.0).take(1);
        missing.setting.free.clone_from(&location.background.ports);
        for it in likely.filter(|it| !frame.ports[it.port].is_sensor()) {
            missing.setting.free[it.port] = it.deviation;
        }
        let windows = self.windows(&missing.setting, &about, &point);
        if windows.len() == missing.windows.len() {
            missing.windows = windows;
        }
        Ok(missing)
    }

    /// The model about the trajectory at a point.
    fn along<'b>(
        &self,
        about: &About<'b, '_>,
        point: &Estimate,
    ) -> Result<(Setting<'b>, Vec<Window>), String> {
        let frame = about.frame;
        let mut setting = Setting::new(
            &*frame.dynamics,
            (point, &self.rig.start),
            &frame.ports,
            &frame.parameters,
            &frame.nominal,
            &frame.records,
        );
        if setting.active.is_empty() && setting.ports.iter().all(Port::is_sensor) {
            return Err(
                "the model does not run from its start, or no state of it shows in a measured output: a missing signal cannot \
                 be looked for without a state or an element. Measure another output"
                    .into(),
            );
        }
        if let Some(errors) = about.errors {
            setting.noise = errors.to_vec();
        }
        let windows = self.windows(&setting, about, point);
        if windows.is_empty() {
            return Err("the model diverges along the measured trajectory".into());
        }
        Ok((setting, windows))
    }

    fn windows(
        &self,
        setting: &Setting<'_>,
        About { frame, stretches, timing, .. }: &About<'_, '_>,
        point: &Estimate,
    ) -> Vec<Window> {
        let records = &frame.records[..];
        let of = |(record, samples): &(usize, Range<usize>)| {
            let sections = vec![samples.clone()];
            let part = Dataset { sections, ..records[*record].clone() };
            let start = self.starts(std::slice::from_ref(&part)).pop()?;
            let mut window = setting.window(records, *record, samples.clone(), &start)?;
            // Laws with their values; by how much more or less is a nuisance.
            let column =
                |law: &Law| setting.changed((records, &window), (law.term, &*law.dynamics), &law.at(point));
            let columns = |laws: &[Law]| laws.iter().map(column).collect::<Option<Vec<Column>>>();
            let (stated, found) = (columns(&frame.stated)?, columns(&frame.found)?);
            let lawful = frame.stated.iter().fold(point.clone(), |point, law| law.at(&point));
            if !stated.is_empty() {
                let record = &records[*record];
                let sharp = frame.stated.iter().fold(lawful.clone(), |point, law| law.sharp(&point));
                setting.take_along(record, &mut window, &stated, &lawful);
                setting.loosen(record, &mut window, (&lawful, &sharp));
            }
            if let Some(disturbed) = &frame.disturbed[*record] {
                setting.roughen(disturbed, &mut window, &lawful);
            }
            let late = |handle: &Unknown| {
                let mut late = lawful.clone();
                late.set(*handle, DELAY);
                setting.changed((records, &window), (Term::Fault(*handle), setting.dynamics), &late)
            };
            window.timing = timing.iter().map(late).collect::<Option<_>>()?;
            window.timing.extend(stated.into_iter().chain(found));
            Some(window)
        };
        stretches.par_iter().filter_map(of).collect()
    }
}

impl Missing<'_> {
    /// The point of the trajectory, with the laws of the parameter set.
    pub fn point(&self) -> Estimate {
        self.stated.iter().fold(self.setting.point.clone(), |point, law| law.at(&point))
    }

    /// What was known of each nuisance before, and nothing of a candidate's columns behind them.
    pub fn precisions_beside(&self, columns: usize) -> Vec<f64> {
        let candidate = std::iter::repeat_n(&0.0, columns);
        self.precisions.iter().chain(candidate).copied().collect()
    }

    /// Takes columns, one for each window, as explained: they are fitted along from here on.
    pub fn explain(&mut self, columns: impl Iterator<Item = Vec<Column>>) {
        for column in columns {
            self.windows.iter_mut().zip(column).for_each(|(window, column)| window.timing.push(column));
            self.precisions.push(0.0);
        }
    }
}

/// Takes away what a sensor did to an output.
fn undistorted(record: &mut Dataset, output: usize, distortion: &Correction) {
    let sections = record.sections.clone();
    let samples: Vec<_> = sections.iter().map(|section| record.samples(section)).collect();
    for measured in record.measured.iter_mut().filter(|it| it.output == output) {
        for (section, samples) in sections.iter().zip(&samples) {
            let plain = distortion.removed(&measured.values[section.clone()], *samples);
            measured.values[section.clone()].copy_from_slice(&plain);
        }
    }
}

/// Stretches of all records, spread over each record: none longer than [`LONGEST`] or than `most` samples, about `samples` together.
fn stretches(records: &[Dataset], samples: usize, most: usize) -> Vec<(usize, Range<usize>)> {
    let total: usize = records.iter().flat_map(|it| it.sections.iter().map(Range::len)).sum();
    let share = (samples as f64 / total.max(1) as f64).min(1.0);
    let mut all = Vec::new();
    for (number, record) in records.iter().enumerate() {
        let longest = ((LONGEST.0 / record.step) as usize).max(LONGEST.1);
        for section in &record.sections {
            let few = (section.len() as f64 * share) as usize;
            let pieces = section.len().div_ceil(longest).max(few.div_ceil(most)).max(1);
            let length = section.len() / pieces;
            for piece in 0..pieces {
                let start = section.start + piece * length;
                let taken = ((length as f64 * share) as usize).max(2).min(length);
                all.push((number, start..start + taken));
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn few_samples_are_from_all_over_a_record(length in 2000..60_000_usize, hertz in 5.0..1000.0_f64) {
            let record = Dataset { step: 1.0 / hertz, sections: std::iter::once(0..length).collect(), ..Dataset::default() };
            let few = stretches(std::slice::from_ref(&record), 1500, 500);
            let samples: usize = few.iter().map(|(_, it)| it.len()).sum();
            prop_assert!((1400..=1500).contains(&samples), "{samples}");
            prop_assert!(few.len() >= 3 && few.iter().all(|(_, it)| it.len() <= 500));
            let gaps = few.windows(2).map(|pair| pair[1].1.start - pair[0].1.start);
            prop_assert!(gaps.max() <= Some(length / 3) && few.iter().all(|(_, it)| it.end <= length));
        }
    }

    #[test]
    fn a_short_record_is_looked_at_in_one_go() {
        let record = Dataset { step: 2e-3, sections: vec![0..900, 1000..1200], ..Dataset::default() };
        assert_eq!(stretches(&[record], SAMPLES, usize::MAX), [(0, 0..900), (0, 1000..1200)]);
    }
}
