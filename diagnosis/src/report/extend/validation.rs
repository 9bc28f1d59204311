//! The validation experiment that travels with the extended model: a part of a validation record, and the model's errors on it.

use std::ops::Range;

use strut_model::Value;
use strut_related::{
    Agreement, Between, Experiment, Experiments, Files, Given, ParameterSet, Related, Series, Stated, Table,
    media, rounded,
};

use crate::dataset::recorded::Dataset;
use crate::diagnosis::{Diagnosis, root_mean_square};
use crate::estimation::unknowns::Estimate;
use crate::plant::{self, Dynamics};

/// Most samples of the record: at 500 samples a second, 5 s, and less than a fifth of the FMU's size.
const MOST: usize = 2500;
/// Digits of the largest value that inputs keep: a velocity's is the derivative of a position.
const INPUT_DIGITS: i32 = 7;
/// Digits of the largest value that outputs keep: a hundredth of what a good sensor resolves.
const OUTPUT_DIGITS: i32 = 5;
/// How far an importer's errors may be from the stated ones: the diagnosis integrates with a fixed step, an FMU by error control.
const WITHIN: f64 = 1e-3;
/// The same as a share of the signal, for errors that are hardly more than rounding.
const ROUNDING: f64 = 1e-6;

/// A part of a validation record with the extended model's errors on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Validation {
    /// The record, and which part of it.
    part: String,
    /// Time between two samples in seconds.
    step: f64,
    /// States at the start.
    states: ParameterSet,
    /// Inputs as they enter the model.
    inputs: Series,
    /// Outputs as they were measured.
    measured: Series,
    /// Of each output.
    errors: Vec<Stated>,
}

/// A segment of a validation record, and the extended model on it.
pub struct Segment<'a> {
    /// The record.
    pub record: &'a Dataset,
    /// Its samples.
    pub range: Range<usize>,
    /// The model as an importer simulates it.
    pub point: Estimate,
    /// States at the start.
    pub start: Vec<f64>,
    /// The equations.
    pub dynamics: Box<dyn Dynamics>,
}

impl Diagnosis<'_> {
    /// The segment in which most happens at its beginning, since a record may begin at rest; none where the model diverges.
    pub(super) fn liveliest(&self) -> Option<Segment<'_>> {
        let extended = &self.found.extended;
        let terms = &extended.terms;
        let (point, _) = self.baseline.as_measured(self.measured, (terms, &extended.point), extended)?;
        let sections =
            self.measured.iter().flat_map(|record| record.sections.iter().map(move |it| (record, it)));
        let lively = |(record, range): (&Dataset, &Range<usize>)| liveliness(record, &beginning(range));
        let all = sections.zip(&point.starts);
        let ((record, range), start) = all.max_by(|(a, _), (b, _)| lively(*a).total_cmp(&lively(*b)))?;
        let (range, start) = (range.clone(), start.clone());
        Some(Segment { record, range, start, dynamics: self.baseline.dynamics(terms).ok()?, point })
    }

    /// The validation experiment; none where the model is driven along curves, or stands for one that the record cannot drive.
    pub(super) fn validation(&self, segment: &Segment<'_>) -> Option<Validation> {
        let Segment { record, range, point, start, dynamics } = segment;
        let part = beginning(range);
        if record.between != plant::Between::Lines || self.baseline.rig.of.is_some() {
            return None;
        }
        let (declared, time) = (&self.baseline.rig.plant, |index: usize| index as f64 * record.step);
        let mut drive = record.drive(&part, &point.inputs);
        // What is written down is what is simulated.
        drive.inputs.iter_mut().for_each(|values| *values = rounded(values, INPUT_DIGITS));
        let simulated = dynamics.outputs(&point.parameters, start, &drive);
        let (mut measured, mut errors) = (Vec::new(), Vec::new());
        for row in &record.measured {
            let output = &declared.outputs[row.output];
            let values = rounded(&row.values[part.clone()], OUTPUT_DIGITS);
            let known = values.iter().zip(&simulated[row.output]).filter(|(value, _)| value.is_finite());
            let (all, left): (Vec<f64>, Vec<f64>) =
                known.map(|(value, found)| (*value, value - found)).unzip();
            let rms = root_mean_square(&left);
            if all.is_empty() || !rms.is_finite() {
                continue;
            }
            let within = WITHIN * rms + ROUNDING * root_mean_square(&all);
            errors.push(Stated { name: output.name.clone(), unit: output.unit.symbol.into(), rms, within });
            measured.push((output.name.clone(), values));
        }
        if errors.is_empty() {
            return None;
        }
        let times: Vec<f64> = (0..part.len()).map(time).collect();
        let states = declared.states.iter().zip(start).map(|(state, value)| Given {
            name: state.name.clone(),
            value: Value::Real(*value),
            unit: state.unit.symbol.into(),
            source: "estimated from the record".into(),
            interval: None,
        });
        let names = declared.inputs.iter().map(|it| it.name.clone());
        Some(Validation {
            part: format!("{}, {} s to {} s", record.name, time(part.start), time(part.end - 1)),
            step: record.step,
            states: ParameterSet {
                name: "start".into(),
                description: "States at the beginning of the validation experiment".into(),
                values: states.collect(),
            },
            inputs: Series { time: times.clone(), signals: names.zip(drive.inputs).collect() },
            measured: Series { time: times, signals: measured },
            errors,
        })
    }
}

/// The beginning of a section: that is where the states are known.
fn beginning(section: &Range<usize>) -> Range<usize> {
    section.start..section.end.min(section.start + MOST)
}

/// How much of a record's signals a part of it has, sample by sample.
fn liveliness(record: &Dataset, part: &Range<usize>) -> f64 {
    let known = |values: &[f64]| values.iter().copied().filter(|it| it.is_finite()).collect::<Vec<f64>>();
    let share = |values: &[f64]| {
        let (here, all) = (root_mean_square(&known(&values[part.clone()])), root_mean_square(&known(values)));
        if all > 0.0 { here / all } else { 0.0 }
    };
    record.measured.iter().map(|row| share(&row.values)).filter(|it| it.is_finite()).sum()
}

impl Validation {
    /// Adds the experiment and its tables.
    pub(super) fn add(&self, files: &mut Files) {
        let steps = self.measured.time.len().saturating_sub(1);
        let origin = "the expected outputs are measured, and only the states at the start are fitted to them; the stated errors are the extended \
                      model's without distortions of sensors";
        let experiment = Experiment {
            name: "validation".into(),
            description: format!(
                "Part of a validation record: {}. Inputs to {INPUT_DIGITS} digits, outputs to {OUTPUT_DIGITS}",
                self.part
            ),
            start: Some(0.0),
            stop: Some(steps as f64 * self.step),
            step: Some(self.step),
            parameters: Some("validation-start.ssv".into()),
            stimuli: Some(Table::csv("validation-in.csv")),
            references: Some(Table::csv("validation-out.csv")),
            agreement: Some(Agreement {
                inputs: Between::Linear,
                origin: origin.into(),
                signals: self.errors.clone(),
            }),
            ..Experiment::default()
        };
        let experiments = Experiments {
            name: "Validation".into(),
            description: "The extended model on measured data".into(),
            all: vec![experiment],
        };
        let text = format!("Part of a validation record with the model's errors on it: {}", self.part);
        let file = Related::new(media::EXPERIMENTS, "validation.exp", "experiment/validation", text);
        files.add(file, experiments.document());
        files.attach("validation-start.ssv", self.states.document());
        files.attach("validation-in.csv", self.inputs.text().into());
        files.attach("validation-out.csv", self.measured.text().into());
    }
}
