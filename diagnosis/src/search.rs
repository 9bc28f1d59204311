//! The search for causes: forward, with gates, on data that was not learnt from.

mod bic;
mod choice;
mod common;
mod nested;
mod punctual;
mod resettled;
mod revise;
mod rooted;
mod weighing;

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::estimation::fit::{Handle, Point};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::lsq::Stop;
use crate::report::findings::Evidence;
use crate::screening::Screened;
use crate::signal::distortion::Fault;

/// Causes that are fitted in a round, and in one beside what is common: most have been tried without.
const FITTED: usize = 7;
const FITTED_BESIDE: usize = 4;
/// Share of the best cause's screened gain below which none is fitted.
const BEHIND: f64 = 0.15;
/// Share of what may matter that a cause which screens badly has to gain, and any fit that is compared has to promise.
const HINT: f64 = 0.2;
/// Tables that are fitted where names do not suffice.
const TABLES: usize = 2;
/// Sensors' responses that are fitted beside them.
const RESPONSES: usize = 1;
/// Causes at most.
const MOST: usize = 4;
/// Small and common effects that are fitted along at most.
const ALONG: usize = 3;
/// Share of the largest cause's rise of Φ below which a further one is not told from the small effects that every real
/// rig has.
const BESIDE: f64 = 0.35;

/// What decides whether a cause is named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Criterion {
    /// All gates, on training and held-out data
    #[default]
    Gates,
    /// The Bayesian information criterion on the training data alone, to compare with
    Bic,
}

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

/// What the search has found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The model with fitted parameters and nothing added.
    pub base: Fitted,
    /// The model with all accepted terms.
    pub extended: Fitted,
    /// The accepted terms.
    pub accepted: Vec<Accepted>,
    /// What every rig has a little of and was fitted along, so that the accepted terms show.
    pub common: Vec<Accepted>,
    /// What screening said in the first round.
    pub screened: Vec<Screened>,
    /// All that was fitted, the last word on each term.
    pub tried: Vec<Tried>,
}

impl Found {
    /// The starting model, with nothing added.
    fn nothing(base: Fitted, screened: Vec<Screened>) -> Self {
        let extended = base.clone();
        Self { base, extended, accepted: vec![], common: vec![], screened, tried: vec![] }
    }
}

impl World<'_> {
    fn tried(&self, base: &Fitted, null: &Fitted, screened: &Screened) -> Tried {
        let mut terms = null.terms.clone();
        terms.push(screened.term);
        let mut starts = screened.starts.clone();
        starts.extend(self.with_the_sheet(null, screened));
        self.weighed(base, null, screened.term, self.fitted(&terms, &starts, comparing(base, null)))
    }

    /// A fit of a term on top of the null's, with what it shows.
    fn weighed(&self, base: &Fitted, null: &Fitted, term: Term, fitted: Result<Fitted, String>) -> Tried {
        let fitted = fitted.and_then(|it| match self.driven_off(null, &it).filter(|_| !has_no_name(term)) {
            Some(parameter) => Err(format!("drives {parameter} to its end")),
            None => Ok(it),
        });
        let (evidence, score) = match &fitted {
            Ok(fitted) => (self.evidence(term, base, null, fitted), self.score(null, fitted)),
            Err(_) => (Evidence::default(), f64::NEG_INFINITY),
        };
        Tried { term, fitted, evidence, score }
    }

    /// Another start, with the data sheet's parameters and signals in time, where those of the fit without the term have
    /// strayed: they have done the missing cause's work as well as they could, and the way back from there is long.
    fn with_the_sheet(&self, null: &Fitted, screened: &Screened) -> Option<Point> {
        let sheet = null.coordinates.iter().filter_map(|it| match (it.handle, it.prior) {
            (Handle::Parameter(_), Some((mean, deviation))) => Some((it.handle, mean, deviation)),
            // As late as no measurement makes it.
            (Handle::Output(..), Some((mean, deviation))) => {
                Some((it.handle, mean, rooted::LATE * deviation))
            }
            _ => None,
        });
        let strayed =
            |(handle, mean, deviation): (Handle, f64, f64)| (null.point.get(handle) - mean).abs() > deviation;
        if !sheet.clone().any(strayed) {
            return None;
        }
        let own = self.own_coordinates(screened.term);
        let mut point = screened.starts.first()?.clone();
        for (handle, mean, _) in sheet.filter(|(handle, ..)| !own.iter().any(|it| it.handle == *handle)) {
            point.set(handle, mean);
        }
        Some(point)
    }

    /// Those of the screened terms with a name that are worth a fit: what screens far below the best, or below what
    /// matters at all, is left out.
    fn promising<'b>(&self, base: &Fitted, screened: &'b [Screened]) -> Vec<&'b Screened> {
        let named: Vec<&Screened> = screened.iter().filter(|it| !has_no_name(it.term)).collect();
        let best = named.first().map_or(0.0, |it| it.gain);
        let least = worth(base).max(BEHIND * best);
        let mut chosen: Vec<&Screened> =
            named.iter().copied().filter(|it| it.gain > least).take(FITTED).collect();
        // What has no derivative where it is absent may screen badly: it is tried all the same.
        let hidden =
            named.iter().copied().filter(|it| has_threshold(it.term) && it.gain > HINT * worth(base));
        // And the limit cases of the others, which are preferred where they explain nearly as much.
        let limits = named
            .iter()
            .copied()
            .filter(|it| chosen.iter().any(|other| contains_by_name(other.term, it.term)));
        let further: Vec<&Screened> = hidden.chain(limits).collect();
        for it in further {
            if !chosen.iter().any(|other| other.term == it.term) {
                chosen.push(it);
            }
        }
        chosen
    }

    /// The tables that are worth a fit beside a gain.
    fn curves<'b>(&self, base: &Fitted, screened: &'b [Screened], gain: f64) -> Vec<&'b Screened> {
        let least = worth(base).max(gain);
        let worthy = |response: bool| {
            let kind = move |it: &&Screened| {
                has_no_name(it.term) && matches!(it.term, Term::Response(_)) == response && it.gain > least
            };
            screened.iter().filter(kind)
        };
        worthy(false).take(TABLES).chain(worthy(true).take(RESPONSES)).collect()
    }

    /// Every term compared to what the extended model misses; the starting model's errors have been compared.
    fn beyond(&self, found: &Found) -> Result<Vec<Screened>, String> {
        if found.extended.terms.is_empty() {
            Ok(found.screened.clone())
        } else {
            self.screened(&found.extended)
        }
    }

    fn try_all(&self, base: &Fitted, null: &Fitted, screened: &[&Screened]) -> Vec<Tried> {
        let mut tried: Vec<Tried> = screened.par_iter().map(|it| self.tried(base, null, it)).collect();
        self.beside_their_limits(base, null, screened, &mut tried);
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        tried
    }

    /// Looks for causes beyond a fit, beside which all of them were screened.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges.
    pub fn search(
        &self,
        base: Fitted,
        screened: Vec<Screened>,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<Found, String> {
        let mut found = Found::nothing(base, screened);
        if self.criterion == Criterion::Bic {
            return self.search_by_bic(found, progress);
        }
        self.forward(&mut found, progress)?;
        self.revised(&mut found, progress)?;
        Ok(found)
    }

    /// Adds causes to what was found, one after the other.
    fn forward(&self, found: &mut Found, progress: &(dyn Fn(&str) + Sync)) -> Result<(), String> {
        while found.accepted.len() < MOST
            && found.common.len() <= ALONG
            && self.another(found, progress)?
            && !found.accepted.last().is_some_and(|it| has_no_name(it.term))
        {}
        // Where nothing is beside it, what does far better than anything rare is the cause, however common.
        if found.accepted.is_empty() {
            let (common, far_better) = found.common.drain(..).partition(|it| it.evidence.usual);
            (found.common, found.accepted) = (common, far_better);
        }
        Ok(())
    }

    /// Adds the cause that explains most of what the model still misses, if any passes. Tells whether one did.
    fn another(&self, found: &mut Found, progress: &(dyn Fn(&str) + Sync)) -> Result<bool, String> {
        progress("comparing every cause to what is missing");
        let screened = self.beyond(found)?;
        let mut promising = self.promising(&found.base, &screened);
        if !found.common.is_empty() {
            promising.truncate(FITTED_BESIDE);
        }
        progress(&format!("fitting {} causes", promising.len()));
        let mut tried = self.try_all(&found.base, &found.extended, &promising);
        if let Some(better) = self.resettled(&found.extended, &tried) {
            if found.extended.terms.is_empty() {
                found.base = better.clone();
            }
            found.extended = better;
            tried = self.weighed_again(&found.base, &found.extended, tried);
        }
        let largest =
            found.accepted.iter().chain(&found.common).map(|it| it.evidence.phi_gain).fold(0.0, f64::max);
        let passes = |it: &Tried| {
            let evidence = &it.evidence;
            // A richer law of what was found takes its place.
            let refines = found.accepted.iter().any(|other| contains_by_name(it.term, other.term));
            evidence.refusal().is_none() && (refines || matters_beside(it.term, evidence, largest))
        };
        if !tried.iter().any(passes) {
            let mut curves = self.curves(&found.base, &screened, 0.0);
            curves
                .retain(|it| !found.tried.iter().any(|before| before.term == it.term && is_far_off(before)));
            tried.extend(self.try_all(&found.base, &found.extended, &curves));
        }
        let own = |it: &&Tried| !self.is_done_by_a_fault(&found.base, it, &tried);
        let passing: Vec<&Tried> = tried.iter().filter(|it| passes(it)).filter(own).collect();
        let common = self.far_better(&found.base, &tried, &passing);
        let far_better = !common.is_empty();
        let passing: Vec<&Tried> = if far_better { common.iter().collect() } else { passing };
        let chosen = self.chosen(&found.base, &passing).cloned();
        let beside = |it: &Tried, chosen: &Tried| {
            let common = Evidence { usual: false, ..it.evidence };
            let better = it.score > chosen.score && common.passes_beside_another();
            passes(it) || it.evidence.passes_beside_another() || better
        };
        let next = match &chosen {
            Some(chosen @ Tried { fitted: Ok(fitted), .. }) => {
                let beside: Vec<&Tried> = tried.iter().filter(|it| beside(it, chosen)).collect();
                // The others were fitted well enough to be compared; this one is to be built on.
                let close = self.fitted(&fitted.terms, std::slice::from_ref(&fitted.point), Stop::NOISY)?;
                let rivals = self.rivals(&found.base, chosen, &close, &beside);
                Some((Accepted { term: chosen.term, evidence: chosen.evidence, rivals }, close))
            }
            _ => None,
        };
        merge(&mut found.tried, tried);
        let Some((accepted, close)) = next else { return Ok(false) };
        found.extended = close;
        // What is left beside a cause is little, and what is common may be most of it.
        let small = accepted.evidence.usual
            && accepted.evidence.phi_gain <= Evidence::REQUIRED_OF_USUAL.phi_gain
            && !found.accepted.is_empty();
        if small || far_better {
            found.common.push(accepted);
        } else {
            found.accepted.push(accepted);
        }
        Ok(true)
    }

    /// Second thoughts about what was found.
    fn revised(&self, found: &mut Found, progress: &(dyn Fn(&str) + Sync)) -> Result<(), String> {
        self.limit(found)?;
        self.retest(found)?;
        if found.accepted.len() + found.common.len() > 1 {
            progress("trying rivals in the place of each cause");
            self.swap(found)?;
        }
        progress("drawing curves in the place of names");
        self.unname(found);
        Ok(())
    }
}

/// Whether a curve gained so little that it will not be told beside what is common, either.
fn is_far_off(curve: &Tried) -> bool {
    curve.evidence.phi_gain < 0.5 * Evidence::REQUIRED_OF_USUAL.phi_gain
}

/// Whether a cause is told from the small effects that every real rig has, where another one raises Φ by so much. What has
/// no name has to raise it by as much as what has one.
fn matters_beside(term: Term, evidence: &Evidence, largest: f64) -> bool {
    if has_no_name(term) {
        return evidence.phi_gain > largest;
    }
    evidence.phi_gain > BESIDE * largest || (evidence.takes_the_bulk() && !evidence.usual)
}

/// Whether a term is a curve that the catalogue has no name for.
pub(crate) fn has_no_name(term: Term) -> bool {
    matches!(term, Term::Table(_) | Term::Response(_))
}

/// Whether a term can do all that another one can: by what it changes, or as the catalogue says.
fn contains(larger: Term, smaller: Term, more: &BTreeSet<Handle>, fewer: &BTreeSet<Handle>) -> bool {
    contains_by_name(larger, smaller) || fewer.is_subset(more)
}

/// Whether the catalogue says that a term has another one as a limit.
fn contains_by_name(larger: Term, smaller: Term) -> bool {
    match (larger, smaller) {
        (Term::Cause(larger), Term::Cause(smaller)) => {
            larger.element == smaller.element && larger.contains.contains(&smaller.id)
        }
        (Term::Response(output), Term::Fault(Handle::Output(of, fault))) => {
            output == of && matches!(fault, Fault::Gain | Fault::Lag | Fault::Delay)
        }
        _ => false,
    }
}

/// What a fit has changed.
fn parts(fitted: &Fitted) -> BTreeSet<Handle> {
    fitted.coordinates.iter().map(|it| it.handle).collect()
}

/// Keeps the last word on each term, without its errors: of an hour they are large, and they have been compared.
fn merge(all: &mut Vec<Tried>, new: Vec<Tried>) {
    all.retain(|old| !new.iter().any(|it| it.term == old.term));
    all.extend(new.into_iter().map(|mut it| {
        if let Ok(fitted) = &mut it.fitted {
            (fitted.train, fitted.test) = (Vec::new(), Vec::new());
        }
        it
    }));
}

/// The least fall of the sum of squares that may matter.
pub(crate) fn worth(base: &Fitted) -> f64 {
    12.0_f64.max(0.005 * 2.0 * base.cost)
}

/// Well enough to compare a cause to a fit without it, as long as the cause promises anything.
fn comparing(base: &Fitted, null: &Fitted) -> Stop {
    Stop { below: null.cost - 0.5 * HINT * worth(base), ..Stop::ROUGH }
}

/// Numbers of the causes that begin to act beyond a threshold, or only near a standstill.
const THRESHOLDS: &[&str] = &["02", "05", "09", "12", "20", "26", "26s"];

/// Whether nothing shows of a term while it is absent, and of what it does only now and then.
fn has_threshold(term: Term) -> bool {
    match term {
        Term::Cause(cause) => THRESHOLDS.contains(&cause.id),
        Term::Fault(handle) => matches!(handle, Handle::Input(_, Fault::Limit)),
        Term::Table(_) | Term::Response(_) => false,
    }
}
