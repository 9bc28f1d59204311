//! Which effects the residuals of a fit may contain: every term is tried out, and compared to what is missing.

mod looks;
mod probes;
mod typical;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::DVector;
use rayon::prelude::*;

use crate::catalogue::naming::name;
use crate::catalogue::{self, Signal};
use crate::dataset::recorded::Dataset;
use crate::estimation::fit::Normal;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::unknowns::{Estimate, FreeParameter, Unknown};
use crate::plant::{Dynamics, Signals};
use crate::signal::distortion::{AFTER, Correction, Fault};

pub use probes::Probe;
pub use typical::typical;

/// How many times as long as a sensor remembers a stretch has to be: what a signal was before is not known.
const MEMORIES: f64 = 4.0;

/// What every term would change beside a fit, in the signals predicted of the estimation data.
pub struct TriedOut {
    /// The terms.
    pub terms: Vec<Term>,
    /// Each term tried out, some in several shapes, with the range of its columns: one for each of its points. None that
    /// diverges.
    pub probes: Vec<(Probe, Range<usize>)>,
    /// The normal equations of the fit's coordinates and, behind them, of these columns.
    pub normal: Normal,
}

impl Baseline<'_> {
    /// Every term that the records allow to be judged.
    pub fn terms(&self) -> Vec<Term> {
        let plant = &self.rig.plant;
        let mut terms: Vec<Term> = Vec::new();
        // Where an effect is at several elements at once, it shows at each of them.
        for effect in catalogue::effects(plant).filter(|it| !catalogue::is_joint(plant, it.element)) {
            let amount = effect.parts.first().and_then(|part| plant.parameter(part.parameter));
            let there = match (amount, effect.setting.and_then(|name| plant.setting(name))) {
                (Some(index), _) => self.rig.parameters[index] != 0.0,
                (None, Some(setting)) => self.rig.choices[setting] == strut_model::Value::Boolean(true),
                (None, None) => true,
            };
            if !there && effect.driven.is_none_or(|inputs| self.moves(inputs)) {
                terms.push(Term::Effect(effect));
            }
        }
        let tables = catalogue::tables(plant).filter(|it| !catalogue::is_joint(plant, it.element));
        terms.extend(tables.map(Term::Table));
        let Some(record) = self.train.first() else { return terms };
        for measured in &record.measured {
            let name = &plant.outputs[measured.output].name;
            let faults = catalogue::distortions(Signal::Output, name);
            terms.extend(faults.map(|fault| Term::Fault(Unknown::Output(measured.output, fault))));
            if self.stretches() > MEMORIES * AFTER[AFTER.len() - 1] {
                terms.push(Term::Response(measured.output));
            }
        }
        for (input, source) in record.inputs.iter().enumerate() {
            if source.measured().is_some() && !self.twofold(record, input) {
                let name = &plant.inputs[input].name;
                let faults = catalogue::distortions(Signal::of_input(name), name);
                let centred = self.rig.without_mean() == Some(name);
                let own = faults.filter(|fault| !catalogue::is_replaced(plant, name, *fault));
                let own = own.filter(|fault| !(centred && *fault == Fault::Offset));
                terms.extend(own.map(|fault| Term::Fault(Unknown::Input(input, fault))));
            }
        }
        terms.retain(|term| self.only.is_empty() || self.only.contains(&name(*term, plant).id));
        terms
    }

    /// Mean duration of the stretches to learn from, in s.
    fn stretches(&self) -> f64 {
        let sections =
            || self.train.iter().flat_map(|it| it.sections.iter().map(|section| (it.step, section.len())));
        sections().map(|(step, length)| step * length as f64).sum::<f64>() / sections().count().max(1) as f64
    }

    /// Whether an input whose name begins so was measured, and moves within or between the estimation records.
    fn moves(&self, start: &str) -> bool {
        let inputs = &self.rig.plant.inputs;
        (0..inputs.len()).filter(|input| inputs[*input].name.starts_with(start)).any(|input| {
            let mut values = self.train.iter().filter_map(|record| record.inputs[input].measured()).flatten();
            values.next().is_some_and(|first| values.any(|value| value != first))
        })
    }

    /// Whether an input is measured as a position and as a velocity: one of them wrong would contradict the other.
    fn twofold(&self, record: &Dataset, input: usize) -> bool {
        let plant = &self.rig.plant;
        let name = &plant.inputs[input].name;
        let other = |from: &str, to: &str| Some(format!("{}{to}", name.strip_suffix(from)?));
        [other("position", "velocity"), other("velocity", "position")]
            .into_iter()
            .flatten()
            .any(|name| plant.input(&name).is_some_and(|index| record.inputs[index].measured().is_some()))
    }

    /// What every term would change beside a fit.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn tried_out(&self, fitted: &Fitted) -> Result<TriedOut, String> {
        let terms: Vec<Term> = self.terms().into_iter().filter(|term| !fitted.terms.contains(term)).collect();
        let at = &fitted.point;
        let tried = terms.iter().enumerate().flat_map(|(index, term)| self.probes(index, *term, at));
        let mut columns = 0;
        let mut probes: Vec<(Probe, Range<usize>)> = tried
            .map(|probe| {
                let first = columns;
                columns += probe.points.len();
                (probe, first..columns)
            })
            .collect();
        let with = |term: &Term| self.dynamics(&[fitted.terms.as_slice(), &[*term]].concat()).ok();
        let dynamics: Vec<Option<Box<dyn Dynamics>>> = terms.iter().map(with).collect();
        let own = self.dynamics(&fitted.terms)?;
        let fit = self.fit(&*own, self.train, fitted.coordinates.clone());
        let unseen = Estimate { outputs: vec![Correction::default(); at.outputs.len()], ..at.clone() };
        let diverging: Vec<AtomicBool> = probes.iter().map(|_| AtomicBool::new(false)).collect();
        let changes = |index: usize, record: &Dataset, section: &Range<usize>| -> Vec<Signals> {
            let start = &at.starts[index];
            let [before, unseen] = [at, &unseen].map(|it| fit.predicted(it, start, record, section));
            let changed = |term: usize, point: &Estimate| -> Option<Signals> {
                let signals = match terms[term] {
                    Term::Fault(Unknown::Output(output, _)) | Term::Response(output) => {
                        seen(&point.outputs[output], &unseen, &before, (record, section, output))
                    }
                    _ => {
                        let dynamics = dynamics[term].as_deref()?;
                        let fit = self.fit(dynamics, self.train, Vec::new());
                        let mut signals = fit.predicted(point, start, record, section);
                        for (after, before) in signals.iter_mut().flatten().zip(before.iter().flatten()) {
                            *after -= before;
                        }
                        signals
                    }
                };
                signals.iter().flatten().all(|it| it.is_finite()).then_some(signals)
            };
            let nothing = || vec![vec![0.0; section.len()]; record.measured.len()];
            let tried = probes.par_iter().zip(&diverging).flat_map_iter(|((probe, _), diverging)| {
                let changes: Option<Vec<Signals>> =
                    probe.points.iter().map(|point| changed(probe.term, point)).collect();
                diverging.fetch_or(changes.is_none(), Ordering::Relaxed);
                changes.unwrap_or_else(|| probe.points.iter().map(|_| nothing()).collect())
            });
            tried.collect()
        };
        let normal = fit.beside(at, &changes, &groups(&probes));
        let mut kept = diverging.into_iter().map(|it| !it.into_inner());
        probes.retain(|_| kept.next().unwrap_or_default());
        Ok(TriedOut { terms, probes, normal })
    }

    /// The share of a probe's best amounts that is within the term's bounds, and where a fit of the term starts: with as much. What
    /// would have to be negative is not there, and what would have to be too large is held back; of several amounts, all are
    /// within their bounds or none counts.
    pub(crate) fn start(
        &self,
        term: Term,
        probe: &Probe,
        amounts: &DVector<f64>,
        at: &Estimate,
    ) -> (f64, Estimate) {
        let Some(mut point) = probe.points.first().cloned() else { return (0.0, at.clone()) };
        let own = self.own_coordinates(term);
        let wanted = |handle: Unknown| -> f64 {
            let each = probe.points.iter().zip(amounts.iter());
            each.map(|(tried, amount)| amount * (tried.get(handle) - at.get(handle))).sum()
        };
        if let [tried] = probe.points.as_slice() {
            let Some(first) = own.first() else { return (1.0, point) };
            let (before, wanted) = (at.get(first.handle), wanted(first.handle));
            let (low, high) = first.bounds;
            let held = |amount: f64| (before + amount).clamp(low.min(before), high);
            let within = (held(wanted) - before) / wanted;
            let is_possible = held(wanted) != before;
            // What cannot be there is tried from a small amount all the same.
            let least = 0.1 * (tried.get(first.handle) - before);
            point.set(first.handle, held(if is_possible { wanted } else { least }));
            return (if is_possible { within.clamp(0.0, 1.0) } else { 0.0 }, point);
        }
        let mut within = 1.0;
        for FreeParameter { handle, bounds: (low, high), .. } in own {
            let (before, value) = (at.get(handle), at.get(handle) + wanted(handle));
            if !(low.min(before)..=high.max(before)).contains(&value) {
                within = 0.0;
            }
            point.set(handle, value.clamp(low, high));
        }
        (within, point)
    }
}

/// Share of the largest fall of a sum of squares that a share of the best amount brings: it is a parabola.
pub(crate) fn of_gain(share: f64) -> f64 {
    share * (2.0 - share)
}

/// What another correction of an output changes of a section's signals, which are the plant's and need not be simulated again.
fn seen(
    correction: &Correction,
    unseen: &Signals,
    before: &Signals,
    (record, section, output): (&Dataset, &Range<usize>, usize),
) -> Signals {
    let of = |(row, (unseen, before)): (usize, (&Vec<f64>, &Vec<f64>))| {
        if record.measured[row].output != output {
            return vec![0.0; section.len()];
        }
        let after = correction.applied(unseen, record.samples(section));
        after.iter().zip(before).map(|(after, before)| after - before).collect()
    };
    unseen.iter().zip(before).enumerate().map(of).collect()
}

/// The columns of each probe.
fn groups(probes: &[(Probe, Range<usize>)]) -> Vec<Range<usize>> {
    probes.iter().map(|(_, range)| range.clone()).collect()
}

/// Root mean square of what a model has to tell of a measured output: without the straight line through each section.
pub fn bent_rms(records: &[Dataset], row: usize) -> f64 {
    rms(&records.iter().flat_map(|record| record.bent(row)).collect::<Vec<_>>()).max(f64::MIN_POSITIVE)
}

/// Root mean square of the known values about their mean.
pub fn rms(values: &[f64]) -> f64 {
    let known: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let n = known.len().max(1) as f64;
    let mean = known.iter().sum::<f64>() / n;
    (known.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt()
}
