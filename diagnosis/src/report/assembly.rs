//! Findings from a diagnosis: verdict, words, tables and pictures.

mod account;
mod deciding;
mod disagreements;
mod pictures;
mod summary;
mod unfinished;
mod unmodelled;

use strut_model::Declaration;

use unmodelled::missing;

use crate::catalogue::naming::{self, name};
use crate::confirm::{Accepted, Tried, has_no_name};
use crate::data::check::DataProblem;
use crate::dataset::recorded::{Dataset, noise_floor};
use crate::dataset::witness::same_excitation;
use crate::decision::choice::Score;
use crate::decision::evidence::Evidence;
use crate::decision::mismatch::{MISMATCH, Moved, common_factors, mismatched};
use crate::decision::verdict::{Facts, verdict};
use crate::diagnosis::{Diagnosis, phi, root_mean_square};
use crate::estimation::coordinates::SURE;
use crate::estimation::fit::Residuals;
use crate::estimation::hypothesis::{Fitted, Term};
use crate::estimation::intervals::Interval;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::report::findings::{
    Answer, Candidate, Effect, EffectParameter, FORMAT, Findings, FittedValue, NominalParameter, Signal,
    SignalDistortion, Start,
};
use crate::report::words::{located, small_rest};
use crate::signal::distortion::{AFTER, Correction, Fault};

/// Fit of the best signal on validation data below which a model that drifts has lost what was measured: its errors are of what happened long before.
const LOST: f64 = 0.95;

impl Diagnosis<'_> {
    /// Whether no signal on validation data is met closely over the stretches that it is compared over. Of a model that drifts,
    /// shorter ones tell more then.
    pub fn is_lost(&self) -> bool {
        self.best() < LOST
    }

    /// Whether it tells of anything that it is missing, with or without a name.
    pub fn finds_something(&self) -> bool {
        let findings = self.findings(Vec::new(), 0.0);
        !findings.effects.is_empty() || !findings.unmodelled.is_empty()
    }

    /// Φ of the signal on validation data that is met best.
    fn best(&self) -> f64 {
        self.left().iter().map(unmodelled::Left::phi).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Everything that is told.
    pub fn findings(&self, data_problems: Vec<DataProblem>, seconds: f64) -> Findings {
        let baseline = &self.baseline;
        let (signals, initial_states, distortions) = self.signals();
        let nominal_parameters = self.nominal_parameters(&signals);
        let named: Vec<&Accepted> = self.found.accepted.iter().filter(|it| !has_no_name(it.term)).collect();
        let effects: Vec<Effect> = named.iter().map(|it| self.effect(it)).collect();
        let unmodelled = self.unmodelled();
        // The account is of the validation records; a curve in the model is among its effects.
        let described = unmodelled.iter().find(|it| it.curve.is_none());
        let account = self.account(described.map_or(0.0, |it| it.share.min(it.validation_share)));
        let open = account.iter().any(|it| it.open);
        let verdict = verdict(Facts {
            best_fit: self.best(),
            effects: effects.len(),
            ambiguous: effects.iter().any(|effect| !effect.ambiguous_with.is_empty()),
            sensors: !effects.is_empty() && named.iter().all(|it| name(it.term, &baseline.rig.plant).sensor),
            unmodelled: unmodelled.iter().map(|it| it.share.min(it.validation_share)).fold(0.0, f64::max),
            unmodelled_first: self.found.accepted.first().is_none_or(|it| has_no_name(it.term)),
            mismatch: nominal_parameters.iter().any(|it| it.mismatch),
            open,
            out_of_time: self.is_unfinished(),
        });
        let experiment = effects.iter().find_map(|effect| effect.experiment.clone());
        let mut findings = Findings {
            format: FORMAT,
            rig: baseline.rig.name.clone(),
            train: baseline.train.iter().map(|record| record.name.clone()).collect(),
            test: baseline.test.iter().map(|record| record.name.clone()).collect(),
            verdict,
            summary: String::new(),
            unfinished: self.unfinished(),
            disagreements: self.disagreements(),
            effects,
            nominal_parameters,
            pictures: self.pictures(),
            signals,
            initial_states,
            distortions,
            account,
            unmodelled,
            missing: self.found.missing.as_ref().map(missing),
            experiment,
            deciding_experiment: None,
            data_problems,
            records: Vec::new(),
            candidates: self.candidates(),
            seconds,
            provenance: None,
        };
        // What follows nothing is worth a word where a signal misses more than its noise.
        let is_told = open || small_rest(&findings).is_some();
        findings.unmodelled.retain(|it| is_told || it.validation_share > 0.0);
        findings.summary = summary::of(&findings);
        findings
    }

    /// The nominal parameters before and after. Some differ only if the model with them predicts the validation records better than
    /// the starting model does.
    fn nominal_parameters(&self, signals: &[Signal]) -> Vec<NominalParameter> {
        let rig = self.baseline.rig;
        let left: f64 = signals.iter().map(|it| (it.rms_after / it.rms_before).powi(2)).sum();
        let left = left / signals.len() as f64;
        let mut list: Vec<NominalParameter> = self
            .reversed
            .iter()
            .map(|handle| NominalParameter {
                name: format!("{}.sign", naming::handle(*handle, &rig.plant).0.trim_end_matches(".gain")),
                unit: "1".into(),
                before: 1.0,
                after: -1.0,
                low: -1.0,
                high: -1.0,
                mismatch: true,
                ..NominalParameter::default()
            })
            .collect();
        let base = rig.base();
        let nominal = self.intervals.iter().filter_map(|it| match it.handle {
            Unknown::Parameter(index) if base.contains(&index) => Some((index, it)),
            _ => None,
        });
        let ratio = |(index, it): (usize, &Interval)| {
            let is_free = self.baseline.is_scaled(it.handle) && !self.baseline.is_yardstick(it.handle);
            is_free.then(|| (it.value / rig.parameters[index], it.half_of_data / rig.parameters[index]))
        };
        let ratios: Vec<Option<(f64, f64)>> = nominal.clone().map(ratio).collect();
        // Of values that the records tell only together, their common factor is the parameter set's matter.
        let moved = |((index, it), common): ((usize, &Interval), f64)| {
            let before = rig.parameters[index];
            let change = (it.value - before).abs().min((it.value - common * before).abs());
            let record = self.baseline.train.first().filter(|_| before == 0.0);
            let size =
                record.map_or(before.abs(), |it| it.magnitude(&rig.plant, rig.plant.parameters[index].unit));
            Moved { change, size, half: it.half_of_data, half_of_noise: it.half_of_noise }
        };
        let moved: Vec<Moved> = nominal.clone().zip(common_factors(&ratios)).map(moved).collect();
        let is_named = !self.found.accepted.is_empty() || !list.is_empty();
        for ((index, interval), mismatch) in nominal.zip(mismatched(&moved, left, is_named)) {
            let (before, after, declared) =
                (rig.parameters[index], interval.value, &rig.plant.parameters[index]);
            let is_yardstick = self.baseline.is_yardstick(interval.handle);
            let known = self.baseline.known.iter().find(|(known, _, _)| *known == index);
            let given = known.filter(|_| !is_yardstick);
            let contradicted = given.is_some_and(|(_, value, deviation)| {
                (after - value).abs() > (1.0 - MISMATCH) * SURE * deviation
            });
            let twins = interval.twins.iter().filter(|_| mismatch);
            let twins = twins.map(|term| name(*term, &rig.plant));
            list.push(NominalParameter {
                name: declared.name.clone(),
                unit: declared.unit.symbol.into(),
                before,
                after,
                low: interval.low(),
                high: interval.high(),
                of_ratio: interval.of_ratio().filter(|_| !is_yardstick),
                mismatch,
                from_parameter_set: given.is_none() && interval.from_parameter_set,
                is_yardstick,
                contradicted,
                equivalent_effects: twins.map(|it| located(&it.name, &it.element)).collect(),
            });
        }
        list
    }

    /// The point of the validation records as they were measured, and the errors there.
    fn measured(&self, terms: &[Term], point: &Estimate) -> Option<(Estimate, Residuals)> {
        self.baseline.as_measured(self.measured, (terms, point), &self.found.extended)
    }

    /// What signals pass beside the model that is told.
    fn distortions(&self, point: &Estimate) -> Vec<SignalDistortion> {
        let plant = &self.baseline.rig.plant;
        let of = |input: bool| {
            move |(declared, correction): (&Declaration, &Correction)| {
                let amounts = Fault::NAMED.map(|fault| (fault.name(), correction.get(fault)));
                let response = correction.response();
                let points =
                    || response.0.iter().zip(AFTER).map(|(more, after)| Answer { after, value: 1.0 + more });
                let response = if response.is_neutral() { Vec::new() } else { points().collect() };
                let signal = declared.name.clone();
                let told = SignalDistortion { signal, input, amounts: amounts.into(), response };
                (!correction.is_neutral()).then_some(told)
            }
        };
        let inputs = plant.inputs.iter().zip(&point.inputs).filter_map(of(true));
        inputs.chain(plant.outputs.iter().zip(&point.outputs).filter_map(of(false))).collect()
    }

    /// The errors of the starting, the fitted and the extended model, where the last one starts, and what signals pass
    /// beside it.
    fn signals(&self) -> (Vec<Signal>, Vec<Start>, Vec<SignalDistortion>) {
        let baseline = &self.baseline;
        let extended = &self.found.extended;
        let terms = extended.terms.clone();
        let all = (
            self.measured(&[], &self.before),
            self.measured(&[], &self.found.base.point),
            self.measured(&terms, &extended.point),
        );
        let (Some((_, before)), Some((_, fitted)), Some((point, after))) = all else {
            return (Vec::new(), Vec::new(), Vec::new());
        };
        let rows = self.measured.first().map_or(0, |record| record.measured.len());
        let left = self.left();
        let of = |row: usize| {
            let declared = &baseline.rig.plant.outputs[self.measured[0].measured[row].output];
            let all = |residuals: &Residuals| -> Vec<f64> {
                residuals.iter().flat_map(|record| record[row].iter().copied()).collect()
            };
            let measured: Vec<f64> =
                self.measured.iter().flat_map(|it| it.measured[row].values.iter().copied()).collect();
            let (before, fitted, after) = (all(&before), all(&fitted), all(&after));
            Signal {
                name: declared.name.clone(),
                unit: declared.unit.symbol.into(),
                fit_before: phi(&before, &measured),
                fit_fitted: phi(&fitted, &measured),
                fit_after: phi(&after, &measured),
                fit_without_input_noise: left[row].phi(),
                rms_before: root_mean_square(&before),
                rms_fitted: root_mean_square(&fitted),
                rms_after: root_mean_square(&after),
                noise_floor: noise_floor(self.measured, row).hypot(baseline.transmitted[row]),
                repeatability: repeatability(self.measured, row),
            }
        };
        let names = || baseline.rig.plant.states.iter().map(|state| state.name.clone());
        let sections =
            self.measured.iter().flat_map(|record| record.sections.iter().map(move |it| (record, it)));
        let starts = sections.zip(&point.starts).map(|((record, section), states)| Start {
            record: record.name.clone(),
            time: section.start as f64 * record.step,
            end: section.end as f64 * record.step,
            states: names().zip(states.iter().copied()).collect(),
        });
        ((0..rows).map(of).collect(), starts.collect(), self.distortions(&point))
    }

    fn effect(&self, accepted: &Accepted) -> Effect {
        let plant = &self.baseline.rig.plant;
        let words = name(accepted.term, plant);
        let own = self.baseline.own_coordinates(accepted.term);
        let end = &self.found.extended.point;
        let thresholds = self.baseline.thresholds(accepted.term).into_iter();
        let unreached = thresholds.filter(|it| end.get(it.handle) == it.bounds.1).map(|it| it.handle);
        let unreached: Vec<Unknown> = unreached.collect();
        let parameters = self.intervals.iter().filter(|it| own.iter().any(|own| own.handle == it.handle));
        let parameters = parameters.map(|it| {
            let (point, ends) = (&self.found.extended.point, [it.value, it.low(), it.high()]);
            let held = match it.handle {
                Unknown::Input(input, fault) => point.holds(plant, input, fault),
                _ => None,
            };
            let shown = |end: f64| match held {
                Some(held) => held.with(point.parameters[held.parameter], end),
                None => naming::arisen(it.handle, plant, end),
            };
            let handle = held.map_or(it.handle, |held| Unknown::Parameter(held.parameter));
            let ascending = |[low, high]: [f64; 2]| [low.min(high), low.max(high)];
            let ((name, unit), [value, low, high]) = (naming::handle(handle, plant), ends.map(shown));
            let [low, high] = ascending([low, high]);
            let reached = !unreached.contains(&it.handle);
            let of_ratio = it.of_ratio().map(|ends| ascending(ends.map(shown)));
            let limit = it.limit().map(shown);
            EffectParameter { name, value, unit, low, high, of_ratio, limit, reached }
        });
        let rivals: Vec<naming::Name> = accepted.rivals.iter().map(|term| name(*term, plant)).collect();
        Effect {
            id: words.id,
            element: words.element,
            name: words.name,
            equation: words.equation,
            parameters: parameters.collect(),
            evidence: accepted.evidence,
            experiment: rivals.first().map(|rival| match words.experiment == rival.experiment {
                true => words.experiment.clone(),
                false => format!("{}; or {}", words.experiment, rival.experiment),
            }),
            ambiguous_with: rivals.iter().map(naming::Name::short).collect(),
        }
    }

    /// The own parameters of a candidate in its fit.
    fn values(&self, term: Term, fitted: &Fitted) -> Vec<FittedValue> {
        let own = self.baseline.own_coordinates(term).into_iter();
        own.map(|it| {
            let (name, unit) = naming::handle(it.handle, &self.baseline.rig.plant);
            let value = naming::arisen(it.handle, &self.baseline.rig.plant, fitted.point.get(it.handle));
            FittedValue { name, value, unit }
        })
        .collect()
    }

    /// Whether something that was accepted takes less of the error away than a candidate did.
    fn explains_less_than(&self, tried: &Tried) -> bool {
        let reduction = |it: &Evidence| it.residual_reduction;
        self.found.accepted.iter().any(|it| reduction(&it.evidence) < reduction(&tried.evidence))
    }

    fn candidates(&self) -> Vec<Candidate> {
        let plant = &self.baseline.rig.plant;
        let late = || "not confirmed: the time limit was reached".to_owned();
        let of = |(term, score): &(Term, Score)| {
            let words = name(*term, plant);
            let tried = self.found.tried.iter().rev().find(|tried| tried.term == *term);
            let outcome = match tried {
                _ if self.found.accepted.iter().any(|it| it.term == *term) => "accepted".into(),
                None if self.is_unfinished() && self.found.tried.is_empty() => late(),
                None => "not fitted: it explains too little of the missing signal, or features without a name explain more".into(),
                Some(tried) => match (&tried.fitted, tried.evidence.refusal()) {
                    (Err(error), _) => error.clone(),
                    (Ok(_), Some(refusal)) => refusal,
                    (Ok(_), None) if self.is_unfinished() && self.found.accepted.is_empty() => late(),
                    (Ok(_), None) if self.found.retracted.contains(term) => {
                        "taken back: its interval holds zero, or a signal fits worse with it".into()
                    }
                    (Ok(_), None) if !self.baseline.is_sized(tried, &self.found.base) => {
                        "its size may be zero, or is at a bound of the search".into()
                    }
                    (Ok(_), None) if self.explains_less_than(tried) => {
                        "explains hardly more than a simpler effect".into()
                    }
                    (Ok(_), None) => "another effect explains it better".into(),
                },
            };
            Candidate {
                id: words.id,
                element: words.element,
                name: words.name,
                share: score.share,
                validation_share: score.validated,
                fitted: tried.is_some_and(|tried| tried.fitted.is_ok()),
                values: tried
                    .and_then(|it| it.fitted.as_ref().ok())
                    .map_or(Vec::new(), |it| self.values(*term, it)),
                evidence: tried.map(|tried| tried.evidence),
                outcome,
            }
        };
        self.found.compared.iter().map(of).collect()
    }
}

/// Root mean square of the difference of the first two records with the same excitation, over √2: no model can do
/// better than a repetition does.
fn repeatability(records: &[Dataset], row: usize) -> Option<f64> {
    let pairs = records
        .iter()
        .enumerate()
        .flat_map(|(index, one)| records[..index].iter().map(move |two| (one, two)));
    let (one, two) = pairs.into_iter().find(|(one, two)| same_excitation(one, two))?;
    let values = one.measured[row].values.iter().zip(&two.measured[row].values);
    let differences: Vec<f64> = values.map(|(one, two)| one - two).collect();
    Some(root_mean_square(&differences) / 2.0_f64.sqrt())
}
