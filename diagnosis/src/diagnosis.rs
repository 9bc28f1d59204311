//! From records to findings: nominal fit, search, intervals.

pub mod component;
mod found;
mod kept;
mod nominal;
mod search;

use crate::dataset::recorded::Dataset;
use crate::dataset::split::Split;
use crate::estimation::deadline::{Deadline, Stage};
use crate::estimation::hypothesis::{Baseline, Term};
use crate::estimation::intervals::Interval;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::plant::Drive;
use crate::rig::Rig;
use crate::screening::rms;

use component::Component;

pub use found::Found;

/// A diagnosis that has come to its end.
pub struct Diagnosis<'a> {
    /// What it was about.
    pub baseline: Baseline<'a>,
    /// The validation records as they were measured.
    pub measured: &'a [Dataset],
    /// The starting model as it was given.
    pub before: Estimate,
    /// What was found.
    pub found: Found,
    /// How sure each coordinate of the extended model is.
    pub intervals: Vec<Interval>,
    /// Signals that had to be turned over before anything fitted.
    pub reversed: Vec<Unknown>,
}

/// What is known, and what is looked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Indices of parameters that were measured otherwise, with value and standard deviation.
    pub known: Vec<(usize, f64, f64)>,
    /// Numbers of the effects that are looked at; none: all.
    pub only: Vec<String>,
    /// A component of the method that is left out, for an ablation.
    pub without: Option<Component>,
    /// Until when it may be looked further.
    pub deadline: Deadline,
}

/// Diagnoses a rig from records; errors are told on the validation records as they were measured.
///
/// # Errors
/// If the model refuses its parameters or diverges on the records.
pub fn diagnose<'a>(
    rig: &'a Rig,
    records: &'a Split,
    options: Options,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis<'a>, String> {
    let mut baseline = Baseline::new(rig, records, options);
    progress("fitting the nominal parameters");
    let (before, base, reversed) = nominal::fit(&mut baseline)?;
    // What no search follows need not be prepared.
    let base = if baseline.deadline.is_over(Stage::Search) { base } else { baseline.look_at(base)? };
    let mut found = Found::nothing(base);
    let judged = baseline.uses(Component::Confirmation);
    let (weighed, extended, intervals) = loop {
        // After a retraction, other effects get their turn.
        baseline.identify(&mut found, progress)?;
        if let Some(closer) = baseline.closer(&found)? {
            found = Found::nothing(baseline.look_at(closer)?);
            continue;
        }
        if judged && let Some(harmful) = baseline.harmful(&found, &records.measured) {
            baseline.retract(&mut found, harmful);
            continue;
        }
        progress("comparing what each excitation says");
        let (weighed, extended) = baseline.weighed_by_what_is_left(&found, records)?;
        let intervals = weighed.intervals(&extended)?;
        match baseline.doubtful(&found, &intervals).filter(|_| judged) {
            Some(doubtful) => baseline.explained_away(&mut found, doubtful),
            None => break (weighed, extended, intervals),
        }
    };
    // Rivals are compared with the weights of the search, which all fits have.
    baseline.tell_apart(&mut found);
    // The report compares on the records of the search, which all stages have.
    let baseline = Baseline { train: &records.train, test: &records.test, ..weighed };
    found.settle_on(extended);
    Ok(Diagnosis { baseline, measured: &records.measured, before, found, intervals, reversed })
}

/// All outputs of the plant on records, from the starts that the point has for them; not a number between sections.
pub(crate) fn simulated(
    baseline: &Baseline<'_>,
    terms: &[Term],
    point: &Estimate,
    records: &[Dataset],
) -> Vec<Vec<Vec<f64>>> {
    let Ok(dynamics) = baseline.dynamics(terms) else { return Vec::new() };
    let mut starts = point.starts.iter();
    records
        .iter()
        .map(|record| {
            let mut whole = vec![vec![f64::NAN; record.len()]; baseline.rig.plant.outputs.len()];
            for section in &record.sections {
                let drive: Drive = record.drive(section, &point.inputs);
                let Some(start) = starts.next() else { continue };
                let part = dynamics.outputs(&point.parameters, start, &drive);
                for (whole, part) in whole.iter_mut().zip(part) {
                    whole[section.clone()].copy_from_slice(&part);
                }
            }
            whole
        })
        .collect()
}

/// How closely signals are met: `1 − rms(e)/rms(z)`, TUM eq. 16; z about its mean.
pub fn phi(residuals: &[f64], measured: &[f64]) -> f64 {
    1.0 - root_mean_square(residuals) / rms(measured).max(f64::MIN_POSITIVE)
}

/// Root of the mean of the known squares.
pub fn root_mean_square(values: &[f64]) -> f64 {
    let known = values.iter().filter(|value| value.is_finite());
    let (sum, n) = known.fold((0.0, 0), |(sum, n), value| (sum + value * value, n + 1));
    (sum / f64::from(n.max(1))).sqrt()
}
