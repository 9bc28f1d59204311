//! Rival models on an excitation: what each predicts, whether it stays within bounds, and how far apart they are.

use nalgebra::DVector;

use crate::dataset::recorded::{Dataset, Measured};
use crate::estimation::fit::Residuals;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::lsq::Stop;
use crate::estimation::unknowns::{Estimate, strain};
use crate::plant::{Dynamics, Signals};

use super::bounds::Bounds;
use super::excitation::Excitation;
use super::separation::{Separation, beyond, level, squares};

/// How often an excitation that leaves the bounds is made smaller.
const SMALLER: usize = 6;
/// Share of a bound that is aimed at then.
const AIM: f64 = 0.97;
/// Share of its size below which it is not worth to go on.
const SMALLEST: f64 = 0.01;

/// A model among rivals.
pub struct Rival {
    /// The effect that it has.
    pub term: Term,
    /// The chosen effect in whose place that is; the same one in the chosen model.
    pub in_place_of: Term,
    /// The model, fitted to the estimation records.
    pub fitted: Fitted,
    /// Its equations.
    pub dynamics: Box<dyn Dynamics>,
}

/// The chosen model and its rivals, with the errors that they leave.
pub struct Contest<'a> {
    baseline: &'a Baseline<'a>,
    /// The chosen model, then each rival.
    models: Vec<Rival>,
    /// What an experiment may do.
    pub bounds: Bounds,
    like: &'a Dataset,
    /// Level of each output's errors, by its index.
    levels: Vec<f64>,
    /// Share of the samples of each measured output that are independent.
    independent: Vec<f64>,
}

/// An excitation within the bounds, and how far it separates the chosen model from each rival.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The excitation.
    pub excitation: Excitation,
    /// Of each rival.
    pub separations: Vec<Separation>,
    /// Largest magnitude that any model predicts of each bounded output.
    pub reached: Vec<f64>,
}

impl<'a> Contest<'a> {
    /// A contest about the world's estimation records; the chosen model comes first.
    pub fn new(baseline: &'a Baseline<'a>, models: Vec<Rival>, bounds: Bounds) -> Option<Self> {
        let (like, chosen) = (baseline.train.first()?, models.first()?);
        let errors = baseline.errors(&chosen.fitted.train);
        let roots = errors.roots();
        let known = |row: usize| {
            let all = chosen.fitted.train.iter().flat_map(|record| &record[row]);
            all.filter(|it| it.is_finite()).count() as f64
        };
        let (mut levels, mut independent) = (baseline.sigma.clone(), Vec::new());
        for (row, count) in errors.effective_counts().into_iter().enumerate() {
            levels[like.measured[row].output] = level(roots[row], known(row), count);
            independent.push((count / known(row).max(1.0)).min(1.0));
        }
        Some(Self { baseline, models, bounds, like, levels, independent })
    }

    /// The chosen model, then each rival.
    pub fn models(&self) -> &[Rival] {
        &self.models
    }

    /// The rivals of the chosen model.
    pub fn rivals(&self) -> &[Rival] {
        &self.models[1..]
    }

    /// Time between two samples of the simulated experiments in seconds.
    pub fn step(&self) -> f64 {
        self.like.step
    }

    /// How far the predictions of the chosen model and each rival are apart on the estimation records, both as fitted to them.
    /// Where that is far and the records do not decide all the same, neither of them is quite right.
    pub fn present(&self) -> Vec<Separation> {
        let chosen = &self.models[0].fitted.train;
        let of = |rival: &Rival| {
            let differences: Residuals =
                rival.fitted.train.iter().zip(chosen).map(|(a, b)| minus(a, b)).collect();
            let squares = differences.iter().map(|record| self.squares(record)).sum();
            let counts = self.baseline.train.iter().map(Dataset::len).sum();
            Separation::of(squares, self.independent(counts))
        };
        self.rivals().iter().map(of).collect()
    }

    /// An excitation, as small as the bounds want it in every model, and how far it separates them, if parameters change little;
    /// none if no model can tell or next to nothing is left of it.
    pub fn tried(&self, excitation: &Excitation) -> Option<Trial> {
        let (excitation, outputs, reached) = self.within(excitation)?;
        let separations =
            self.compared(&excitation, &outputs, |(record, model)| self.followed(record, model))?;
        Some(Trial { excitation, separations, reached })
    }

    /// The same with the wrong model fitted to what the right one predicts: what changes of its parameters make of it is
    /// computed and not extrapolated.
    pub fn fitted(&self, trial: &Trial) -> Option<Trial> {
        let (excitation, outputs, reached) = self.within(&trial.excitation)?;
        let separations =
            self.compared(&excitation, &outputs, |(record, model)| self.refitted(record, model))?;
        Some(Trial { excitation, separations, reached })
    }

    /// Makes an excitation smaller until every model stays within the bounds.
    fn within(&self, excitation: &Excitation) -> Option<(Excitation, Vec<Signals>, Vec<f64>)> {
        let mut factor = 1.0;
        for _ in 0..=SMALLER {
            let smaller = excitation.scaled(factor);
            let record = self.record(&smaller);
            let outputs: Vec<Signals> = self.models.iter().map(|it| self.outputs(it, &record)).collect();
            let largest = |output: usize| {
                let values = outputs.iter().flat_map(|it| &it[output]);
                values
                    .fold(0.0_f64, |most, it| if it.is_finite() { most.max(it.abs()) } else { f64::INFINITY })
            };
            let reached: Vec<f64> = self.bounds.outputs.iter().map(|(output, _)| largest(*output)).collect();
            let excess =
                reached.iter().zip(&self.bounds.outputs).map(|(reached, (_, bound))| reached / bound);
            let excess = excess.fold(0.0, f64::max);
            if excess <= 1.0 {
                let measured =
                    self.models.iter().zip(&outputs).map(|(it, all)| self.measured(it, &record, all));
                let measured: Vec<Signals> = measured.collect();
                return measured
                    .iter()
                    .flatten()
                    .flatten()
                    .all(|it| it.is_finite())
                    .then_some((smaller, measured, reached));
            }
            // A model that diverges says nothing of how much is too much.
            factor *= if excess.is_finite() { AIM / excess } else { 0.5 };
            if factor < SMALLEST {
                return None;
            }
        }
        None
    }

    fn record(&self, excitation: &Excitation) -> Dataset {
        excitation.record(self.baseline.rig, self.like, self.bounds.duration)
    }

    /// All outputs of a model over an experiment, from rest.
    fn outputs(&self, model: &Rival, record: &Dataset) -> Signals {
        let (whole, point) = (0..record.len(), &model.fitted.point);
        let drive = record.drive(&whole, &point.inputs);
        model.dynamics.outputs(&point.parameters, &self.baseline.rig.start, &drive)
    }

    /// The measured ones as its sensors see them.
    fn measured(&self, model: &Rival, record: &Dataset, outputs: &Signals) -> Signals {
        let samples = record.samples(&(0..record.len()));
        let of = |it: &Measured| model.fitted.point.outputs[it.output].applied(&outputs[it.output], samples);
        record.measured.iter().map(of).collect()
    }

    /// The separation of the chosen model from each rival: whichever is right, the smaller of both.
    fn compared(
        &self,
        excitation: &Excitation,
        outputs: &[Signals],
        squares: impl Fn((&Dataset, &Rival)) -> Option<f64>,
    ) -> Option<Vec<Separation>> {
        let empty = self.record(excitation);
        let independent = self.independent(empty.len());
        let one_way = |right: usize, wrong: usize| {
            let filled = empty.measured.iter().zip(&outputs[right]);
            let measured = filled.map(|(it, values)| Measured { values: values.clone(), ..it.clone() });
            let record = Dataset { measured: measured.collect(), ..empty.clone() };
            Some(Separation::of(squares((&record, &self.models[wrong]))?, independent))
        };
        (1..self.models.len()).map(|rival| Some(one_way(0, rival)?.min(one_way(rival, 0)?))).collect()
    }

    /// Sum of squares that a model misses of an experiment beyond what small changes of its parameters and its states at the
    /// start can do.
    fn followed(&self, record: &Dataset, model: &Rival) -> Option<f64> {
        let records = std::slice::from_ref(record);
        let baseline = self.over(records);
        let fit = baseline.fit(&*model.dynamics, records, model.fitted.coordinates.clone());
        let mut point = self.start(&baseline, model);
        if record.sections.len() > 1 {
            point = fit.settled(point);
        }
        let missed = fit.residuals(&point).pop()?;
        if !missed.iter().flatten().all(|it| it.is_finite()) {
            return None;
        }
        let normal = fit.beside(
            &point,
            &|_, _, section| vec![missed.iter().map(|it| it[section.clone()].to_vec()).collect()],
            std::slice::from_ref(&(0..1)),
        );
        let own = fit.coordinates.len();
        let cross = DVector::from_fn(own, |index, _| normal.h[(index, own)]);
        let known = normal.h.iter().all(|it| it.is_finite());
        known.then(|| beyond(&normal.h.view((0, 0), (own, own)).into_owned(), &cross, normal.h[(own, own)]))
    }

    /// The same of the model fitted to the experiment.
    fn refitted(&self, record: &Dataset, model: &Rival) -> Option<f64> {
        let baseline = self.over(std::slice::from_ref(record));
        let fitted =
            baseline.fitted(&model.fitted.terms, &[self.start(&baseline, model)], Stop::ROUGH).ok()?;
        Some(2.0 * (fitted.cost - strain(&fitted.coordinates, &fitted.point)))
    }

    fn over<'b>(&'b self, records: &'b [Dataset]) -> Baseline<'b> {
        Baseline { train: records, test: &[], sigma: self.levels.clone(), ..self.baseline.clone() }
    }

    fn start(&self, baseline: &Baseline<'_>, model: &Rival) -> Estimate {
        Estimate { starts: baseline.starts(baseline.train), ..model.fitted.point.clone() }
    }

    /// Sum of squares of measured signals in their levels.
    fn squares(&self, signals: &Signals) -> f64 {
        let rows = signals.iter().zip(&self.like.measured);
        squares(rows.map(|(signal, it)| (&signal[..], self.levels[it.output])))
    }

    /// Number of independent samples of all measured outputs together.
    fn independent(&self, samples: usize) -> f64 {
        samples as f64 * self.independent.iter().sum::<f64>()
    }
}

fn minus(a: &Signals, b: &Signals) -> Signals {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect()
}
