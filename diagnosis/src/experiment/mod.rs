//! The deciding experiment: where rivals explain the records as well as the chosen effect, the excitation that separates them
//! best within limits of stroke, force, rate, frequency and time.
//!
//! Every excitation is simulated with the chosen model and each rival. The distance of two predictions counts in the errors
//! that the records have left, beyond what a wrong model can follow with its own parameters ([`separation`]).

mod bounds;
mod contest;
mod excitation;
pub mod separation;
mod shape;
mod table;

use rayon::prelude::*;

use crate::catalogue::naming::name;
use crate::confirm::has_no_name;
use crate::diagnosis::Diagnosis;
use crate::estimation::fit::Point;
use crate::estimation::hypothesis::{Fitted, Term};
use crate::estimation::lsq::Stop;
use crate::report::findings::{
    DecidingExperiment, Distinction, Drive, ExperimentLimit, Setting, SourceFmu, Value,
};

pub use bounds::{Bounds, InputBounds, Limits};
pub use contest::{Contest, Rival, Trial};
pub use excitation::{Excitation, Wave, excitations};
pub use separation::Separation;
pub use shape::Shape;
pub use table::TABLE;

use separation::rank;

/// Excitations whose separations are computed with fitted rivals.
const FINALISTS: usize = 3;

impl<'a> Diagnosis<'a> {
    /// The chosen model and each of its rivals, fitted to the estimation records; none without rivals.
    ///
    /// # Errors
    /// If a rival's model refuses its settings or diverges.
    pub fn contest(&self, limits: Limits) -> Result<Option<Contest<'_>>, String> {
        let chosen = &self.found.extended;
        let ambiguous = self.found.accepted.iter().filter(|it| !has_no_name(it.term));
        let mut models = Vec::new();
        for (accepted, rival) in ambiguous.flat_map(|it| it.rivals.iter().map(move |rival| (it.term, *rival)))
        {
            if models.is_empty() {
                models.push(self.rival(accepted, chosen.clone())?);
            }
            let fitted = self.in_place_of(accepted, rival)?;
            models.push(self.rival(rival, fitted)?);
        }
        let bounds = self.world.bounds(limits, chosen);
        Ok(Contest::new(&self.world, models, bounds))
    }

    fn rival(&self, term: Term, fitted: Fitted) -> Result<Rival, String> {
        let dynamics = self.world.dynamics(&fitted.terms)?;
        Ok(Rival { term, fitted, dynamics })
    }

    /// The extended model with a rival in the place of an effect.
    fn in_place_of(&self, effect: Term, rival: Term) -> Result<Fitted, String> {
        let (world, found) = (&self.world, &self.found);
        let terms: Vec<Term> =
            found.extended.terms.iter().map(|term| if *term == effect { rival } else { *term }).collect();
        let tried = found.tried.iter().rev().filter(|it| it.term == rival);
        let tried = tried.filter_map(|it| it.fitted.as_ref().ok()).next();
        let start = match tried {
            Some(tried) if tried.terms == terms => tried.point.clone(),
            _ => {
                let mut point = Point { ..found.extended.point.clone() };
                for own in world.own_coordinates(effect) {
                    point.set(own.handle, found.base.point.get(own.handle));
                }
                let of = tried.map_or(&found.base.point, |it| &it.point);
                for own in world.own_coordinates(rival) {
                    point.set(own.handle, of.get(own.handle));
                }
                point
            }
        };
        world.fitted(&terms, &[start], Stop::NOISY)
    }

    /// The experiment that separates the chosen effects from their rivals best within the limits; none without rivals.
    ///
    /// # Errors
    /// If a rival's model refuses its settings or diverges.
    pub fn deciding_experiment(&self, limits: Limits) -> Result<Option<DecidingExperiment>, String> {
        let Some(contest) = self.contest(limits)? else { return Ok(None) };
        let all = excitations(&contest.bounds);
        let trials: Vec<Trial> = all.par_iter().filter_map(|it| contest.tried(it)).collect();
        let best = contest.best(&trials);
        Ok(Some(self.told(&contest, trials.len(), best.as_ref())))
    }

    fn told(&self, contest: &Contest<'_>, compared: usize, best: Option<&Trial>) -> DecidingExperiment {
        let rig = self.world.rig;
        let of_rival = |(number, (rival, present)): (usize, (&Rival, Separation))| {
            let expected = best.map_or(Separation::default(), |it| it.separations[number]);
            Distinction {
                effect: self.effect_of(rival.term),
                rival: name(rival.term, &rig.plant).short(),
                distance: expected.distance,
                probability: expected.probability(),
                excess: expected.excess,
                decides: expected.decides(),
                recorded: present.distance,
            }
        };
        let pairs = contest.rivals().iter().zip(contest.present()).enumerate().map(of_rival);
        let pairs: Vec<Distinction> = pairs.collect();
        let decides = pairs.iter().any(|it| it.decides);
        let duration = contest.bounds.duration;
        let shown = best.filter(|_| decides);
        let step = self.measured.first().map_or(1e-3, |it| it.step);
        DecidingExperiment {
            decides,
            compared,
            duration,
            drives: shown.map_or(Vec::new(), |it| {
                it.excitation.waves.iter().map(|it| self.drive(it, duration)).collect()
            }),
            limits: self.limits(contest, shown),
            pairs,
            files: shown.map_or(Vec::new(), |it| table::files(rig, &it.excitation, step, duration)),
        }
    }

    /// Number and place of the effect that has a rival.
    fn effect_of(&self, rival: Term) -> String {
        let accepted = self.found.accepted.iter().find(|it| it.rivals.contains(&rival));
        accepted.map_or(String::new(), |it| name(it.term, &self.world.rig.plant).short())
    }

    fn drive(&self, wave: &Wave, duration: f64) -> Drive {
        let declared = &self.world.rig.plant.inputs[wave.input];
        let unit = declared.unit.symbol;
        let (frequency, to) = wave.shape.frequencies();
        let source = wave.shape.source((wave.amplitude, declared.start), unit, duration);
        let source = source.map(|it| SourceFmu {
            fmu: it.fmu.into(),
            settings: it
                .settings
                .into_iter()
                .map(|(name, choice)| Setting { name: name.into(), choice })
                .collect(),
            parameters: it
                .parameters
                .into_iter()
                .map(|(name, value, unit)| Value { name: name.into(), value, unit })
                .collect(),
            adapter: it.adapter,
        });
        Drive {
            input: declared.name.clone(),
            unit: unit.into(),
            shape: wave.shape.name().into(),
            amplitude: wave.amplitude,
            frequency,
            last_frequency: to,
            source,
        }
    }

    /// Every limit, and how much of it the experiment takes.
    fn limits(&self, contest: &Contest<'_>, best: Option<&Trial>) -> Vec<ExperimentLimit> {
        let plant = &self.world.rig.plant;
        let outputs =
            contest.bounds.outputs.iter().enumerate().map(|(number, (output, limit))| ExperimentLimit {
                signal: plant.outputs[*output].name.clone(),
                unit: plant.outputs[*output].unit.symbol.into(),
                limit: *limit,
                reached: best.map(|it| it.reached[number]),
            });
        let inputs = contest.bounds.inputs.iter().flat_map(|bound| {
            let declared = &plant.inputs[bound.input];
            let signal = best.map(|it| {
                let step = self.world.train.first().map_or(1e-3, |it| it.step);
                let count = (contest.bounds.duration / step) as usize;
                let signal = it.excitation.signal(self.world.rig, bound.input, step, count);
                let largest = signal.iter().fold(0.0_f64, |most, it| most.max((it - declared.start).abs()));
                let rate = signal.windows(2).map(|it| (it[1] - it[0]).abs() / step).fold(0.0, f64::max);
                (largest, rate)
            });
            let unit = declared.unit.symbol;
            [
                ExperimentLimit {
                    signal: declared.name.clone(),
                    unit: unit.into(),
                    limit: bound.amplitude,
                    reached: signal.map(|it| it.0),
                },
                ExperimentLimit {
                    signal: format!("rate of {}", declared.name),
                    unit: format!("{unit}/s"),
                    limit: bound.rate,
                    reached: signal.map(|it| it.1),
                },
            ]
        });
        outputs.chain(inputs).collect()
    }
}

impl Contest<'_> {
    /// The best of the trials, the first ones with their rivals fitted.
    pub fn best(&self, trials: &[Trial]) -> Option<Trial> {
        let order = |a: &Trial, b: &Trial| {
            let [a, b] = [a, b].map(|it| rank(&it.separations));
            b.0.cmp(&a.0).then(b.1.total_cmp(&a.1))
        };
        let mut ranked: Vec<&Trial> = trials.iter().collect();
        ranked.sort_by(|a, b| order(a, b));
        let finalists: Vec<&Trial> = ranked.into_iter().take(FINALISTS).collect();
        let mut fitted: Vec<Trial> = finalists.par_iter().filter_map(|it| self.fitted(it)).collect();
        fitted.sort_by(order);
        fitted.into_iter().next()
    }
}
