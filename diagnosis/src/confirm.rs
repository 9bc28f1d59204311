//! Whether an effect is true: the law enters the model, output error closes in, and another excitation judges.

mod choice;
mod clock;
mod nested;
mod weighing;

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::catalogue::{self, Onset, Part, RESPONSE, naming};
use crate::decision::criteria::CRITERIA;
use crate::decision::evidence::Evidence;
use crate::decision::rules::{Amount, is_determined};
use crate::diagnosis::component::Component;
use crate::estimation::deadline::Stage;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::lsq::Stop;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::explain::selection::Proposal;
use crate::signal::distortion::Fault;

/// Share of what may matter that any fit that is compared has to promise.
const HINT: f64 = 0.2;

/// A candidate that was fitted on top of others.
#[derive(Clone, Debug)]
pub struct Tried {
    /// The term.
    pub term: Term,
    /// With it, or why there is no such fit.
    pub fitted: Result<Fitted, String>,
    /// What it shows.
    pub evidence: Evidence,
    /// Its rank: the larger the better.
    pub score: f64,
}

/// A term that was accepted.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// The term.
    pub term: Term,
    /// What it showed when it was added.
    pub evidence: Evidence,
    /// Terms that explain the data as well.
    pub rivals: Vec<Term>,
}

/// An effect that the data confirm, and the model with it.
pub struct Confirmed {
    /// The effect.
    pub accepted: Accepted,
    /// The model with it.
    pub fitted: Fitted,
}

impl Baseline<'_> {
    fn tried(&self, base: &Fitted, null: &Fitted, proposal: &Proposal) -> Tried {
        let terms = self.terms_with(&null.terms, proposal.term);
        // From where the fit without the effect is, from where the smoother is, and from where a simulation wants it.
        let own = self.own_coordinates(proposal.term);
        let with = |start: &Estimate, parameters: &[f64]| {
            let mut point = Estimate { parameters: parameters.to_vec(), ..null.point.clone() };
            own.iter().for_each(|it| point.set(it.handle, start.get(it.handle)));
            point
        };
        let start = &self.by_clock(null, proposal.term).unwrap_or_else(|| proposal.start.clone());
        let mut starts = vec![with(start, &null.point.parameters)];
        if null.terms.is_empty() {
            starts.push(with(start, &start.parameters));
            let of_term = self.shapes.iter().filter(|(term, _)| *term == proposal.term);
            starts.extend(of_term.map(|(_, start)| with(start, &start.parameters)));
        }
        // No fit begins after the time limit.
        let fitted = match self.deadline.is_over(Stage::Search) {
            true => Err("not fitted: the time limit was reached".into()),
            false => self.fitted(&terms, &starts, comparing(base, null)),
        };
        self.weighed(base, null, proposal.term, fitted)
    }

    /// Some terms and another one, in the place of those that it has as limits of its own parameters: two laws of the same
    /// parameters are not beside each other.
    fn terms_with(&self, terms: &[Term], term: Term) -> Vec<Term> {
        let handles = |term: Term| -> BTreeSet<Unknown> {
            self.own_coordinates(term).into_iter().map(|it| it.handle).collect()
        };
        let own = handles(term);
        let is_limit = |it: &Term| contains_by_name(term, *it) && handles(*it).is_subset(&own);
        terms.iter().copied().filter(|it| !is_limit(it)).chain([term]).collect()
    }

    /// A fit of a term on top of the null's, with what it shows.
    fn weighed(&self, base: &Fitted, null: &Fitted, term: Term, fitted: Result<Fitted, String>) -> Tried {
        let fitted = fitted.and_then(|it| match self.driven_off(null, &it).filter(|_| !has_no_name(term)) {
            Some(parameter) => Err(format!("drives {parameter} to its bound")),
            None if self.is_another_law(term, &it) => Err("ends where its law is another one".into()),
            None if self.is_in_time(term, &it) => Err("no later than the timing of any measurement".into()),
            None => Ok(it),
        });
        let (evidence, score) = match &fitted {
            Ok(fitted) => (self.evidence(term, base, null, fitted), self.score(null, fitted)),
            Err(_) => (Evidence::default(), f64::NEG_INFINITY),
        };
        Tried { term, fitted, evidence, score }
    }

    /// How large a term is in a fit, and how sure by the scatter of its blocks.
    fn amounts(&self, term: Term, fitted: &Fitted, base: &Fitted) -> Vec<Amount> {
        let covariance = fitted.linear.robust_covariance(&fitted.trace.scores);
        let half = |index: usize| CRITERIA.certain * covariance[(index, index)].max(0.0).sqrt();
        let of = |handle: Unknown| {
            let index = fitted.coordinates.iter().position(|it| it.handle == handle)?;
            let value = self.amount(handle, fitted.point.get(handle), base);
            Some(Amount { value, bounds: self.within(handle, fitted), half: half(index) })
        };
        self.sizes(term).into_iter().filter_map(of).collect()
    }

    /// Bounds at which a fit's coordinate tells nothing. The end of a parameter's meaning is a possible value: a sharp limit has a ratio
    /// of one.
    pub(crate) fn within(&self, handle: Unknown, fitted: &Fitted) -> (f64, f64) {
        let own = fitted.coordinates.iter().find(|it| it.handle == handle);
        let (low, high) = own.map_or((f64::NEG_INFINITY, f64::INFINITY), |it| it.bounds);
        let end = match handle {
            Unknown::Parameter(parameter) => self.rig.plant.parameters[parameter].max,
            Unknown::Input(..) | Unknown::Output(..) => None,
        };
        (low, if end.is_some_and(|end| end <= high) { f64::INFINITY } else { high })
    }

    /// How much of an effect a value is: beyond the model without it. Every fit has the usual timing of a channel, which is not the
    /// model's: a delay or lag counts from zero.
    pub fn amount(&self, handle: Unknown, value: f64, base: &Fitted) -> f64 {
        if self.usual(handle).is_some() { value } else { value - base.point.get(handle) }
    }

    /// What of a term says how much of it there is; of a curve and of a limit nothing does.
    pub fn sizes(&self, term: Term) -> Vec<Unknown> {
        let own = self.own_coordinates(term);
        match term {
            Term::Effect(effect) => {
                let adds = |part: &Part| part.addend;
                let parts =
                    effect.parts.iter().enumerate().filter(|(number, part)| *number == 0 || adds(part));
                let index = |(_, part): (usize, &Part)| self.rig.plant.parameter(part.parameter);
                parts.filter_map(index).map(Unknown::Parameter).collect()
            }
            Term::Fault(Unknown::Input(_, Fault::Limit)) | Term::Table(_) | Term::Response(_) => Vec::new(),
            Term::Fault(_) => own.into_iter().map(|it| it.handle).collect(),
        }
    }

    /// Fits what is proposed, the best first. A richer law waits for those that it has as limits, and is not fitted where it could add
    /// nothing that matters to the best one.
    pub fn try_all(&self, base: &Fitted, null: &Fitted, proposals: &[Proposal]) -> Vec<Tried> {
        let fit = |some: &[&Proposal]| -> Vec<Tried> {
            some.par_iter().map(|it| self.tried(base, null, it)).collect()
        };
        let has_a_limit =
            |it: &&Proposal| proposals.iter().any(|limit| contains_by_name(it.term, limit.term));
        let (mut richer, mut fitted): (Vec<&Proposal>, Vec<&Proposal>) =
            proposals.iter().partition(has_a_limit);
        let mut tried = fit(&fitted);
        if let Some(sufficient) = self.sufficient(base, &tried) {
            richer.retain(|it| !contains_by_name(it.term, sufficient));
        }
        tried.extend(fit(&richer));
        fitted.extend(richer);
        self.beside_their_limits(base, null, &fitted, &mut tried);
        self.limits_of_the_best(base, null, &mut tried);
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        tried
    }

    /// The best of those that were tried, if the data confirm it and no effect could matter beside it.
    fn sufficient(&self, base: &Fitted, tried: &[Tried]) -> Option<Term> {
        let best = tried.iter().max_by(|a, b| a.score.total_cmp(&b.score))?;
        let fitted = best.fitted.as_ref().ok()?;
        let passes = best.evidence.refusal().is_none() && self.is_sized(best, base);
        (passes && !self.may_matter(base, fitted, 1.0)).then_some(best.term)
    }

    /// Fits the best of those that were tried, and what it has as limits, at several elements at once, if the rig has several.
    pub fn together(&self, base: &Fitted, null: &Fitted, tried: &[Tried]) -> Vec<Tried> {
        let Some(best) = tried.first() else { return Vec::new() };
        let of_best = |it: &&Tried| it.term == best.term || contains_by_name(best.term, it.term);
        let again = tried.iter().filter(of_best).flat_map(|it| {
            let (Term::Effect(effect), Ok(fitted)) = (it.term, &it.fitted) else { return Vec::new() };
            let own = self.own_coordinates(it.term);
            let joints = catalogue::joints_of(&self.rig.plant, effect).into_iter().map(Term::Effect);
            let with = |joint: Term| {
                let mut start = null.point.clone();
                for (to, from) in self.own_coordinates(joint).iter().zip(&own) {
                    start.set(to.handle, fitted.point.get(from.handle));
                }
                (joint, start)
            };
            joints.map(with).collect()
        });
        let again: Vec<(Term, Estimate)> = again.collect();
        let fit = |(joint, start): &(Term, Estimate)| {
            let fitted = self.fitted(
                &self.terms_with(&null.terms, *joint),
                std::slice::from_ref(start),
                comparing(base, null),
            );
            self.weighed(base, null, *joint, fitted)
        };
        again.par_iter().map(fit).collect()
    }

    /// Whether an effect is what another one does at several elements, at one of them.
    fn is_one_of(&self, one: Term, several: Term) -> bool {
        let Term::Effect(effect) = one else { return false };
        catalogue::joints_of(&self.rig.plant, effect).into_iter().any(|it| Term::Effect(it) == several)
    }

    /// Whether the records tell how large a term is: its amount is not zero, and at no end of where it is looked for.
    pub fn is_sized(&self, tried: &Tried, base: &Fitted) -> bool {
        tried.fitted.as_ref().is_ok_and(|fitted| self.is_sized_in(tried.term, fitted, base))
    }

    /// The same in a fit.
    pub(crate) fn is_sized_in(&self, term: Term, fitted: &Fitted, base: &Fitted) -> bool {
        is_determined(&self.amounts(term, fitted, base))
    }

    /// The effect among those that were tried which the data confirm, if any.
    ///
    /// # Errors
    /// If the model diverges in the close fit.
    pub fn confirmed(&self, base: &Fitted, tried: &[Tried]) -> Result<Option<Confirmed>, String> {
        let sure = self.uses(Component::Confirmation);
        let passes = |it: &&Tried| {
            it.evidence.refusal().is_none() && self.is_sized(it, base) || !sure && it.fitted.is_ok()
        };
        let mut passing: Vec<&Tried> = tried.iter().filter(passes).collect();
        loop {
            let Some(chosen) = self.chosen(base, &passing).cloned() else { return Ok(None) };
            let Ok(fitted) = &chosen.fitted else { return Ok(None) };
            let close = self.fitted(&fitted.terms, std::slice::from_ref(&fitted.point), Stop::NOISY)?;
            // The close fit may move to a bound that the rough one did not reach.
            if sure && self.is_another_law(chosen.term, &close) {
                passing.retain(|it| it.term != chosen.term);
                continue;
            }
            let beside: Vec<&Tried> =
                tried.iter().filter(|it| passes(it) || it.evidence.passes_beside_another()).collect();
            let rivals = self.rivals(base, &chosen, &close, &beside);
            let accepted = Accepted { term: chosen.term, evidence: chosen.evidence, rivals };
            return Ok(Some(Confirmed { accepted, fitted: close }));
        }
    }
}

/// Whether a term is a curve that the catalogue has no name for.
pub(crate) fn has_no_name(term: Term) -> bool {
    matches!(term, Term::Table(_) | Term::Response(_))
}

/// Whether a term can do all that another one can: by what it changes, or as the catalogue says.
fn contains(larger: Term, smaller: Term, more: &BTreeSet<Unknown>, fewer: &BTreeSet<Unknown>) -> bool {
    contains_by_name(larger, smaller) || fewer.is_subset(more)
}

/// Whether the catalogue says that a term has another one as a limit.
pub(crate) fn contains_by_name(larger: Term, smaller: Term) -> bool {
    match (larger, smaller) {
        (Term::Effect(larger), Term::Effect(smaller)) => {
            larger.element == smaller.element && larger.contains.contains(&smaller.id)
        }
        (Term::Response(output), Term::Fault(Unknown::Output(of, fault))) => {
            output == of && RESPONSE.contains.contains(&fault)
        }
        _ => false,
    }
}

/// What a fit has changed.
fn parts(fitted: &Fitted) -> BTreeSet<Unknown> {
    fitted.coordinates.iter().map(|it| it.handle).collect()
}

/// The least fall of the sum of squares that may matter.
pub(crate) fn worth(base: &Fitted) -> f64 {
    12.0_f64.max(0.005 * 2.0 * base.cost)
}

/// Well enough to compare an effect to a fit without it, as long as the effect promises anything.
fn comparing(base: &Fitted, null: &Fitted) -> Stop {
    Stop { below: null.cost - 0.5 * HINT * worth(base), ..Stop::ROUGH }
}

/// Whether nothing shows of a term while it is absent, and of what it does only now and then.
fn has_threshold(term: Term) -> bool {
    naming::onset(term) != Onset::Always
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Element;
    use crate::dataset::split::Split;
    use crate::diagnosis::Options;
    use crate::rig::Rig;

    #[test]
    fn a_law_takes_the_place_of_its_limits_only() {
        let rig = Rig::published("quarter-car").unwrap();
        let records = Split::of_nothing();
        let baseline = Baseline::new(&rig, &records, Options::default());
        let effects: Vec<_> = catalogue::effects(&rig.plant).collect();
        let of_strut = |id: &str| effects.iter().find(|it| it.id == id && it.element == Element::STRUT);
        let term = |id: &str| Term::Effect(of_strut(id).expect(id));
        let [dahl, loose, spring, coulomb] = ["03", "03b", "08", "01"].map(term);
        assert_eq!(baseline.terms_with(&[dahl, spring], loose), [spring, loose]);
        // It has no parameter of Coulomb's friction, which is a limit of it by name.
        assert_eq!(baseline.terms_with(&[coulomb, spring], loose), [coulomb, spring, loose]);
        assert_eq!(baseline.terms_with(&[loose], dahl), [loose, dahl]);
    }
}
