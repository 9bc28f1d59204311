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
pub mod ports;
pub mod trajectory;

use std::ops::Range;

use rayon::prelude::*;

use crate::dataset::recorded::Recorded;
use crate::estimation::fit::{Handle, Point};
use crate::estimation::hypothesis::{TIMING, Term, World};
use crate::plant::Dynamics;
use crate::signal::distortion::Correction;

use innovations::{Column, Noise};
use likelihood::Sums;
use ports::Port;
use trajectory::{Setting, Window};

/// Samples of all records together that are looked at: half a minute at the rate of conditioned records.
const SAMPLES: usize = 12_000;
/// Longest stretch that is filtered in one go, in seconds.
const LONGEST: f64 = 10.0;
/// Standard deviation of a nominal parameter over its value, before the data are seen.
const TOLERANCE: f64 = 0.3;
/// Least share of a nominal value that a parameter is believed to have, where it cannot be zero.
const LEAST: f64 = 0.3;
/// Share of each port's size that may be missing while the nominal parameters are looked at.
const LOOSE: f64 = 0.03;
/// How often the nominal parameters are corrected where all of them are stated.
const ROUNDS: usize = 2;
/// The same where one of them is not: a decade each, to the ends of what a model may have.
const ROUNDS_UNSTATED: usize = 12;
/// Shares of each port's size that are tried as what may be missing while parameters without a value are looked at.
const ANY: [f64; 4] = [LOOSE, 0.1, 0.3, 1.0];
/// Largest logarithm of the factor by which a round changes what must not be zero.
const FACTOR: f64 = 2.3;
/// Relative change of a parameter without a value below which the rounds end.
const SETTLED: f64 = 0.01;
/// The delay that a timing column stands for, in seconds.
const DELAY: f64 = 1e-3;

/// A rig's model about the trajectory of its records.
pub struct Missing<'a> {
    /// Estimation records, then validation records.
    pub records: &'a [Recorded],
    /// How many of them are estimation records.
    pub train: usize,
    /// What the smoother knows of the rig.
    pub setting: Setting<'a>,
    /// The predictions about the trajectory.
    pub windows: Vec<Window>,
    /// What was known of each nuisance before: precisions of nominal parameters, then of the channels' timing, then of what was
    /// explained.
    pub precisions: Vec<f64>,
}

/// What a smoother needs to outlive it.
pub struct Frame {
    /// Estimation records, then validation records, freed of what sensors are known to do.
    records: Vec<Recorded>,
    point: Point,
    /// Whether nominal parameters start from the data sheet, far off perhaps.
    fresh: bool,
    dynamics: Box<dyn Dynamics>,
    /// Laws that were found, each with the model that has it.
    laws: Vec<(Term, Box<dyn Dynamics>, Point)>,
    ports: Vec<Port>,
    parameters: Vec<usize>,
    nominal: Vec<f64>,
}

impl World<'_> {
    /// Equations, ports and nominal parameters of the rig with what was found so far.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn frame(&self, found: &[Term], at: &Point) -> Result<Frame, String> {
        let record = self.train.first().ok_or("there is no estimation record")?;
        let mut point = Point { starts: Vec::new(), ..at.clone() };
        let mut records = self.whole.to_vec();
        // Of the channels' timing only what was found is known; the rest is looked at anew.
        for (output, distortion) in point.outputs.iter_mut().enumerate() {
            let told = |term: &Term| match term {
                Term::Fault(Handle::Output(of, _)) | Term::Response(of) => *of == output,
                _ => false,
            };
            let before = std::mem::take(distortion);
            if found.iter().any(told) {
                for record in &mut records {
                    undistorted(record, output, &before);
                }
            }
        }
        // Laws act beside the model, along the trajectory: friction inside a prediction would stick where the rig does not.
        let mut laws = Vec::new();
        for term in found.iter().filter(|term| matches!(term, Term::Cause(_) | Term::Table(_))) {
            laws.push((
                *term,
                self.own_coordinates(*term).into_iter().map(|it| it.handle).collect::<Vec<_>>(),
            ));
        }
        let fitted = point.clone();
        for handle in laws.iter().flat_map(|(_, handles)| handles) {
            point.set(*handle, self.origin().get(*handle));
        }
        let with = |(term, handles): (Term, Vec<Handle>)| {
            let mut point = point.clone();
            handles.iter().for_each(|handle| point.set(*handle, fitted.get(*handle)));
            Ok((term, self.dynamics(&[term])?, point))
        };
        let laws = laws.into_iter().map(with).collect::<Result<Vec<_>, String>>()?;
        let states = self.rig.plant.states.iter();
        Ok(Frame {
            records,
            point,
            fresh: found.is_empty(),
            dynamics: self.dynamics(&[])?,
            laws,
            ports: Port::all(self.rig, record),
            parameters: self.rig.base(),
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
        let records = &frame.records[..];
        let mut point = frame.point.clone();
        let unstated = |index: &usize| self.is_unstated(*index);
        let open = frame.parameters.iter().any(unstated);
        let mut rounds = match (frame.fresh, open) {
            (false, _) => 0,
            (true, false) => ROUNDS,
            (true, true) => ROUNDS_UNSTATED,
        };
        let timing: Vec<Handle> = self
            .coordinates(&[])
            .into_iter()
            .filter(|it| matches!(it.handle, Handle::Output(..)))
            .map(|it| it.handle)
            .collect();
        let known = |index: &usize| {
            let told =
                self.known.iter().find(|(of, _, _)| of == index).map(|(_, _, deviation)| deviation.powi(-2));
            let value = self.rig.parameters[*index];
            let nothing = value == 0.0 || self.is_unstated(*index);
            told.unwrap_or(if nothing { 0.0 } else { (TOLERANCE * value).powi(-2) })
        };
        for (index, value, _) in &self.known {
            point.parameters[*index] = *value;
        }
        let mut precisions: Vec<f64> = frame.parameters.iter().map(known).collect();
        precisions.extend(timing.iter().map(|_| (DELAY / TIMING).powi(2)));
        let stretches = stretches(records);
        let mut round = 0;
        loop {
            let mut setting = self.setting(frame, &point, records);
            if let Some(errors) = errors {
                setting.noise = errors.to_vec();
            }
            let windows = self.windows(&setting, (records, &stretches), &timing, &point);
            if windows.is_empty() {
                return Err("the model diverges along the measured trajectory".into());
            }
            round += 1;
            if round > rounds {
                let train = self.train.len();
                let mut missing = Missing { records, train, setting, windows, precisions };
                // Where nothing needs to be missing, a trajectory that follows the sensors follows their noise.
                let location = missing.located();
                let likely = location.ranked.iter().filter(|it| it.gain > 0.0).take(1);
                missing.setting.free.clone_from(&location.background.ports);
                for it in likely.filter(|it| !frame.ports[it.port].is_sensor()) {
                    missing.setting.free[it.port] = it.deviation;
                }
                let windows = self.windows(&missing.setting, (records, &stretches), &timing, &point);
                if windows.len() == missing.windows.len() {
                    missing.windows = windows;
                }
                for (term, dynamics, point) in &frame.laws {
                    let of = |window: &Window| {
                        missing.setting.changed((records, window), (*term, &**dynamics), point)
                    };
                    let columns: Option<Vec<Column>> = missing.windows.iter().map(of).collect();
                    missing.explain(columns.into_iter());
                }
                return Ok(missing);
            }
            let columns: Vec<usize> = (1..=precisions.len()).collect();
            // A missing signal that is held to be smaller than it is bends what has no value.
            let tried = if open { &ANY[..] } else { &ANY[..1] }.iter().filter_map(|share| {
                let noise = Noise { ports: setting.shared(*share), outputs: setting.noise.clone() };
                let blocks = setting.innovations(&windows, &noise, &[]);
                let sums = Sums::of(blocks.iter().filter(|block| block.record < self.train.len()))?;
                Some((sums.log_likelihood(&precisions), sums.fitted(&columns, &precisions)?))
            });
            let Some((_, fitted)) = tried.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            let before = point.parameters.clone();
            for (index, step) in frame.parameters.iter().zip(fitted.values.iter()) {
                point.parameters[*index] = self.moved(*index, before[*index], *step);
            }
            if frame.dynamics.check(&point.parameters).is_err() {
                point.parameters.clone_from(&before);
            }
            let still = |index: &usize| {
                let (before, after) = (before[*index], point.parameters[*index]);
                !self.is_unstated(*index) || (after - before).abs() <= SETTLED * before.abs()
            };
            if open && round >= ROUNDS && frame.parameters.iter().all(still) {
                rounds = round;
            }
        }
    }

    /// Whether neither a data sheet nor the user gives a parameter's value: the model's own is of no meaning then.
    pub(crate) fn is_unstated(&self, index: usize) -> bool {
        !self.rig.stated[index] && !self.known.iter().any(|(known, _, _)| *known == index)
    }

    /// A nominal parameter after a step. What has no value and must not be zero may be off by decades: its logarithm moves.
    fn moved(&self, index: usize, before: f64, step: f64) -> f64 {
        let declared = &self.rig.plant.parameters[index];
        let least = declared.min.unwrap_or(f64::NEG_INFINITY);
        let most = declared.max.unwrap_or(f64::INFINITY);
        if self.is_unstated(index) {
            let moved = if least > 0.0 {
                before * (step / before).clamp(-FACTOR, FACTOR).exp()
            } else {
                before + step
            };
            return moved.clamp(least, most);
        }
        let known = self.known.iter().find(|(known, _, _)| *known == index).map(|(_, value, _)| *value);
        let nominal = known.unwrap_or(self.rig.parameters[index]);
        let least = if least.is_finite() { least.max(LEAST * nominal) } else { least };
        (before + step).clamp(least.min(before), most.max(before))
    }

    /// The nominal parameters by the balance of what the sensors show, with any signal missing beside them.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges along every stretch.
    pub(crate) fn balanced(&self, at: &Point) -> Result<Vec<f64>, String> {
        let frame = self.frame(&[], at)?;
        Ok(self.missing(&frame)?.setting.point.parameters)
    }

    fn setting<'b>(&self, frame: &'b Frame, point: &Point, records: &[Recorded]) -> Setting<'b> {
        Setting::new(
            &*frame.dynamics,
            (point, &self.rig.start),
            &frame.ports,
            &frame.parameters,
            &frame.nominal,
            records,
        )
    }

    fn windows(
        &self,
        setting: &Setting<'_>,
        (records, stretches): (&[Recorded], &[(usize, Range<usize>)]),
        timing: &[Handle],
        point: &Point,
    ) -> Vec<Window> {
        let of = |(record, samples): &(usize, Range<usize>)| {
            let sections = vec![samples.clone()];
            let part = Recorded { sections, ..records[*record].clone() };
            let start = self.starts(std::slice::from_ref(&part)).pop()?;
            let mut window = setting.window(records, *record, samples.clone(), &start)?;
            let columns: Option<Vec<Column>> = timing
                .iter()
                .map(|handle| {
                    let mut late = point.clone();
                    late.set(*handle, DELAY);
                    setting.changed((records, &window), (Term::Fault(*handle), setting.dynamics), &late)
                })
                .collect();
            window.timing = columns?;
            Some(window)
        };
        stretches.par_iter().filter_map(of).collect()
    }
}

impl Missing<'_> {
    /// Numbers of the columns that are fitted whatever is looked for.
    pub fn nuisances(&self) -> Vec<usize> {
        (1..=self.precisions.len()).collect()
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
fn undistorted(record: &mut Recorded, output: usize, distortion: &Correction) {
    let sections = record.sections.clone();
    let samples: Vec<_> = sections.iter().map(|section| record.samples(section)).collect();
    for measured in record.measured.iter_mut().filter(|it| it.output == output) {
        for (section, samples) in sections.iter().zip(&samples) {
            let plain = distortion.removed(&measured.values[section.clone()], *samples);
            measured.values[section.clone()].copy_from_slice(&plain);
        }
    }
}

/// Stretches of all records: none longer than [`LONGEST`], not more than [`SAMPLES`] together, spread over each record.
fn stretches(records: &[Recorded]) -> Vec<(usize, Range<usize>)> {
    let total: usize = records.iter().flat_map(|it| it.sections.iter().map(Range::len)).sum();
    let share = (SAMPLES as f64 / total.max(1) as f64).min(1.0);
    let mut all = Vec::new();
    for (number, record) in records.iter().enumerate() {
        let longest = ((LONGEST / record.step) as usize).max(2);
        for section in &record.sections {
            let pieces = section.len().div_ceil(longest).max(1);
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
