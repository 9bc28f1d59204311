//! The search for causes: forward, with gates, on data that was not learnt from.

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::comparison::{Errors, student};
use crate::findings::Evidence;
use crate::fit::{Handle, Residuals};
use crate::hypothesis::{Fitted, Term, World};
use crate::lsq::Stop;
use crate::recorded::Recorded;
use crate::screening::{Screened, rms};

/// Causes that are fitted in a round.
const FITTED: usize = 7;
/// Share of the best cause's screened gain below which none is fitted.
const BEHIND: f64 = 0.15;
/// Tables that are fitted where names do not suffice.
const TABLES: usize = 2;
/// Causes at most.
const MOST: usize = 4;
/// Share of the largest cause's rise of Φ below which a further one is not told from the small effects that every real
/// rig has.
const BESIDE: f64 = 0.35;
/// Errors that are larger by less than this factor are nearly the same.
const NEARLY: f64 = 1.02;
/// Blocks of time over which gains are compared, in seconds.
const BLOCK: f64 = 0.5;

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
    /// What screening said in the first round.
    pub screened: Vec<Screened>,
    /// All that was fitted, the last word on each term.
    pub tried: Vec<Tried>,
}

impl World<'_> {
    fn block(&self) -> usize {
        let step = self.train.first().map_or(1.0, |record| record.step);
        ((BLOCK / step).round() as usize).max(4)
    }

    fn errors<'b>(&'b self, residuals: &'b Residuals) -> Errors<'b> {
        Errors { residuals, floor: &self.floor }
    }

    /// Student's t of the gain over blocks, in units of what the better fit leaves.
    fn steadiness(&self, null: &Residuals, other: &Residuals) -> f64 {
        let (null, other) = (self.errors(null), self.errors(other));
        student(&null.gains(&other, self.block(), &other.mean_squares()))
    }

    /// What speaks for one fit over another, of which it is an extension; how much it explains is counted in the errors
    /// of the starting model.
    pub fn evidence(&self, base: &Fitted, null: &Fitted, fitted: &Fitted) -> Evidence {
        let more = fitted.coordinates.len().saturating_sub(null.coordinates.len());
        let counts = self.errors(&null.train).effective_counts();
        let (before, after) =
            (self.errors(&null.train).mean_squares(), self.errors(&fitted.train).mean_squares());
        let gain: f64 =
            counts.iter().zip(before.iter().zip(&after)).map(|(n, (b, a))| n * (b / a).ln()).sum();
        let total: f64 = counts.iter().sum();
        let squares = |it: &Fitted| self.errors(&it.test).mean_squares();
        let (unit, before, after) = (squares(base), squares(null), squares(fitted));
        let shares =
            unit.iter().zip(before.iter().zip(&after)).map(|(unit, (before, after))| (before - after) / unit);
        Evidence {
            delta_bic: gain - more as f64 * total.max(1.0).ln(),
            block_t: self.steadiness(&null.train, &fitted.train),
            held_out_t: self.steadiness(&null.test, &fitted.test),
            explained: shares.sum::<f64>() / unit.len().max(1) as f64,
            phi_gain: self.phi_gain(null, fitted),
        }
    }

    /// The largest rise of Φ among the signals: on the training or the held-out data, whichever is less.
    fn phi_gain(&self, null: &Fitted, fitted: &Fitted) -> f64 {
        let of = |records: &[Recorded], null: &Residuals, fitted: &Residuals| {
            let roots = |it: &Residuals| self.errors(it).mean_squares().into_iter().map(f64::sqrt);
            let rows = roots(null).zip(roots(fitted)).enumerate();
            let gains = rows.map(|(row, (before, after))| {
                let values = records.iter().flat_map(|record| record.measured[row].values.iter().copied());
                (before - after) / rms(&values.collect::<Vec<_>>()).max(f64::MIN_POSITIVE)
            });
            gains.fold(0.0, f64::max)
        };
        of(self.train, &null.train, &fitted.train).min(of(self.test, &null.test, &fitted.test))
    }

    /// Rank of a fit among those on top of the same: half its fall of the information criterion, over all data.
    fn score(&self, null: &Fitted, fitted: &Fitted) -> f64 {
        let part = |null: &Residuals, fitted: &Residuals| -> (f64, f64) {
            let counts = self.errors(null).effective_counts();
            let squares =
                self.errors(null).mean_squares().into_iter().zip(self.errors(fitted).mean_squares());
            (counts.iter().zip(squares).map(|(n, (b, a))| 0.5 * n * (b / a).ln()).sum(), counts.iter().sum())
        };
        let ((train, n), (test, m)) = (part(&null.train, &fitted.train), part(&null.test, &fitted.test));
        train + test - 0.5 * fitted.coordinates.len() as f64 * (n + m).max(1.0).ln()
    }

    /// Student's t of how much smaller one fit's errors are than another's, over all data.
    fn apart(&self, better: &Fitted, other: &Fitted) -> f64 {
        let unit = self.errors(&better.train).mean_squares();
        let gains = |other: &Residuals, better: &Residuals| {
            self.errors(other).gains(&self.errors(better), self.block(), &unit)
        };
        let mut all = gains(&other.train, &better.train);
        all.extend(gains(&other.test, &better.test));
        student(&all)
    }

    fn tried(&self, base: &Fitted, null: &Fitted, screened: &Screened) -> Tried {
        let mut terms = null.terms.clone();
        terms.push(screened.term);
        let fitted = self.fitted(&terms, &screened.starts, Stop::ROUGH);
        let (evidence, score) = match &fitted {
            Ok(fitted) => (self.evidence(base, null, fitted), self.score(null, fitted)),
            Err(_) => (Evidence::default(), f64::NEG_INFINITY),
        };
        Tried { term: screened.term, fitted, evidence, score }
    }

    /// Those of the screened terms with a name that are worth a fit: what screens far below the best, or below what
    /// matters at all, is left out.
    fn promising<'b>(&self, base: &Fitted, screened: &'b [Screened]) -> Vec<&'b Screened> {
        let named: Vec<&Screened> = screened.iter().filter(|it| !is_table(it.term)).collect();
        let best = named.first().map_or(0.0, |it| it.gain);
        let least = worth(base).max(BEHIND * best);
        let mut chosen: Vec<&Screened> =
            named.iter().copied().filter(|it| it.gain > least).take(FITTED).collect();
        // What has no derivative where it is absent may screen badly: it is tried all the same.
        let hidden = named.into_iter().filter(|it| {
            matches!(it.term, Term::Cause(cause) if HIDDEN.contains(&cause.id)) && it.gain > 0.2 * worth(base)
        });
        for it in hidden {
            if !chosen.iter().any(|other| other.term == it.term) {
                chosen.push(it);
            }
        }
        chosen
    }

    /// The tables that are worth a fit beside a gain.
    fn curves<'b>(&self, base: &Fitted, screened: &'b [Screened], gain: f64) -> Vec<&'b Screened> {
        let least = worth(base).max(gain);
        screened.iter().filter(|it| is_table(it.term) && it.gain > least).take(TABLES).collect()
    }

    fn try_all(&self, base: &Fitted, null: &Fitted, screened: &[&Screened]) -> Vec<Tried> {
        let mut tried: Vec<Tried> = screened.par_iter().map(|it| self.tried(base, null, it)).collect();
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        tried
    }

    /// Looks for causes.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges.
    pub fn search(&self, base: Fitted, progress: &(dyn Fn(&str) + Sync)) -> Result<Found, String> {
        let mut current = base.clone();
        let mut found = Found {
            extended: base.clone(),
            base,
            accepted: Vec::new(),
            screened: Vec::new(),
            tried: Vec::new(),
        };
        while found.accepted.len() < MOST {
            progress("comparing every cause to what is missing");
            let screened = self.screened(&current)?;
            let promising = self.promising(&found.base, &screened);
            progress(&format!("fitting {} causes", promising.len()));
            let mut tried = self.try_all(&found.base, &current, &promising);
            let largest = found.accepted.iter().map(|it| it.evidence.phi_gain).fold(0.0, f64::max);
            let passes =
                |it: &Tried| it.evidence.refusal().is_none() && it.evidence.phi_gain > BESIDE * largest;
            if !tried.iter().any(passes) {
                let curves = self.curves(&found.base, &screened, 0.0);
                tried.extend(self.try_all(&found.base, &current, &curves));
            }
            if found.screened.is_empty() {
                found.screened = screened;
            }
            let passing: Vec<&Tried> = tried.iter().filter(|it| passes(it)).collect();
            let chosen = self.chosen(&found.base, &passing).cloned();
            let rivals = chosen.as_ref().map_or_else(Vec::new, |chosen| self.rivals(chosen, &passing));
            merge(&mut found.tried, tried);
            let Some(chosen) = chosen else { break };
            let Ok(fitted) = chosen.fitted else { break };
            found.accepted.push(Accepted { term: chosen.term, evidence: chosen.evidence, rivals });
            // The others were fitted well enough to be compared; this one is to be built on.
            current = self.fitted(&fitted.terms, std::slice::from_ref(&fitted.point), Stop::NOISY)?;
            if is_table(chosen.term) {
                break;
            }
        }
        found.extended = current;
        self.retest(&mut found)?;
        if found.accepted.len() > 1 {
            progress("trying rivals in the place of each cause");
            self.swap(&mut found)?;
        }
        progress("drawing curves in the place of names");
        self.unname(&mut found);
        Ok(found)
    }

    /// The best of those with a name that pass; without any, the best table.
    fn chosen<'b>(&self, base: &Fitted, passing: &[&'b Tried]) -> Option<&'b Tried> {
        let named = passing.iter().find(|it| !is_table(it.term));
        named.map(|it| self.simplest(base, it, passing)).or_else(|| passing.first().copied())
    }

    /// Puts a table alone in the place of everything that was found, if it explains clearly more than one cause with a
    /// name, or as much as several of them: names that only together do what one curve does are not the cause.
    fn unname(&self, found: &mut Found) {
        let Some(first) = found.accepted.first().filter(|it| !is_table(it.term)) else { return };
        let named = found.screened.iter().find(|it| it.term == first.term);
        let curves = self.curves(&found.base, &found.screened, named.map_or(0.0, |it| it.gain));
        let tried = self.try_all(&found.base, &found.base, &curves);
        merge(&mut found.tried, tried.clone());
        let passing = tried.iter().filter(|it| it.evidence.refusal().is_none());
        let best = passing.filter_map(|it| Some((it, it.fitted.as_ref().ok()?))).next();
        let Some((table, fitted)) = best else { return };
        let named = found.accepted.iter().filter(|it| !is_table(it.term)).count();
        let factor = if named > 1 { 1.1 } else { 0.85 };
        let enough = self.left(&found.base, fitted) < factor * self.left(&found.base, &found.extended);
        if enough
            && named > 0
            && (named > 1 || self.apart(fitted, &found.extended) > 4.0)
            && !self.is_needed(found, fitted, first.term)
        {
            let accepted = Accepted { term: table.term, evidence: table.evidence, rivals: Vec::new() };
            found.extended = fitted.clone();
            found.accepted = vec![accepted];
        }
    }

    /// Whether a term that was found is needed beside a table, too: then they are about different things.
    fn is_needed(&self, found: &Found, table: &Fitted, term: Term) -> bool {
        let mut terms = table.terms.clone();
        terms.push(term);
        let mut start = table.point.clone();
        for coordinate in self.own_coordinates(term) {
            start.set(coordinate.handle, found.extended.point.get(coordinate.handle));
        }
        let both = self.fitted(&terms, &[start], Stop::ROUGH);
        both.is_ok_and(|both| self.evidence(&found.base, table, &both).refusal().is_none())
    }

    /// One with fewer parameters that is a part of the best and explains nearly as much.
    fn simplest<'b>(&self, base: &Fitted, best: &'b Tried, passing: &[&'b Tried]) -> &'b Tried {
        let mut chosen = best;
        for other in passing {
            if let (Ok(fitted), Ok(simpler)) = (&chosen.fitted, &other.fitted)
                && contains(chosen.term, other.term, &parts(fitted), &parts(simpler))
                && simpler.coordinates.len() < fitted.coordinates.len()
                && (self.apart(fitted, simpler) < 2.5
                    || self.left(base, simpler) < NEARLY * self.left(base, fitted))
            {
                chosen = other;
            }
        }
        chosen
    }

    /// Errors left, in those of the starting model: two where nothing is gained.
    fn left(&self, base: &Fitted, fitted: &Fitted) -> f64 {
        let of = |unit: &Residuals, residuals: &Residuals| {
            let (unit, squares) = (self.errors(unit).mean_squares(), self.errors(residuals).mean_squares());
            unit.iter().zip(&squares).map(|(unit, square)| square / unit).sum::<f64>()
                / unit.len().max(1) as f64
        };
        of(&base.train, &fitted.train) + of(&base.test, &fitted.test)
    }

    /// Those that explain the data as well as the chosen one, and are not the same with something more.
    fn rivals(&self, chosen: &Tried, passing: &[&Tried]) -> Vec<Term> {
        let Ok(best) = &chosen.fitted else { return Vec::new() };
        let own = parts(best);
        let rival = |other: &&&Tried| {
            let Ok(fitted) = &other.fitted else { return false };
            let more = contains(other.term, chosen.term, &parts(fitted), &own);
            other.term != chosen.term && !is_table(other.term) && !more && self.apart(best, fitted) < 2.5
        };
        passing.iter().filter(rival).map(|it| it.term).collect()
    }

    /// The found terms without one of them, fitted.
    fn without(&self, found: &Found, index: usize) -> Result<Fitted, String> {
        let mut terms = found.extended.terms.clone();
        terms.retain(|term| *term != found.accepted[index].term);
        let mut start = found.extended.point.clone();
        for coordinate in self.own_coordinates(found.accepted[index].term) {
            let shared = terms.iter().any(|term| {
                self.own_coordinates(*term).iter().any(|other| other.handle == coordinate.handle)
            });
            if !shared {
                start.set(coordinate.handle, found.base.point.get(coordinate.handle));
            }
        }
        self.fitted(&terms, &[start], Stop::NOISY)
    }

    /// Puts rivals in the place of each accepted term: one that does better takes it, one that does as well stays a
    /// rival. What was a rival while another cause was still missing may be none any more.
    fn swap(&self, found: &mut Found) -> Result<(), String> {
        for index in 0..found.accepted.len() {
            let accepted: Vec<Term> = found.accepted.iter().map(|it| it.term).collect();
            let rivals: Vec<Term> = found.accepted[index]
                .rivals
                .iter()
                .filter(|term| !accepted.contains(term))
                .copied()
                .collect();
            found.accepted[index].rivals.clear();
            if rivals.is_empty() {
                continue;
            }
            let without = self.without(found, index)?;
            let screened = self.screened(&without)?;
            let candidates = screened.iter().filter(|it| rivals.contains(&it.term));
            for tried in candidates.map(|it| self.tried(&found.base, &without, it)) {
                let Ok(fitted) = &tried.fitted else { continue };
                if tried.evidence.refusal().is_some() {
                    continue;
                }
                let behind = self.apart(&found.extended, fitted);
                let here = &mut found.accepted[index];
                if behind < -2.5 {
                    here.rivals.clear();
                    (here.term, here.evidence) = (tried.term, tried.evidence);
                    found.extended = fitted.clone();
                } else if behind < 2.5 {
                    here.rivals.push(tried.term);
                }
            }
        }
        Ok(())
    }

    /// Takes each accepted term away again, and drops it if nothing is lost.
    fn retest(&self, found: &mut Found) -> Result<(), String> {
        if found.accepted.len() < 2 {
            return Ok(());
        }
        let mut index = 0;
        while index < found.accepted.len() && found.accepted.len() > 1 {
            let without = self.without(found, index)?;
            let evidence = self.evidence(&found.base, &without, &found.extended);
            if evidence.refusal().is_some() {
                found.accepted.remove(index);
                found.extended = without;
            } else {
                found.accepted[index].evidence = evidence;
                index += 1;
            }
        }
        Ok(())
    }
}

fn is_table(term: Term) -> bool {
    matches!(term, Term::Table(_))
}

/// Whether a term can do all that another one can: by what it changes, or as the catalogue says.
fn contains(larger: Term, smaller: Term, more: &BTreeSet<Handle>, fewer: &BTreeSet<Handle>) -> bool {
    let by_name = match (larger, smaller) {
        (Term::Cause(larger), Term::Cause(smaller)) => {
            larger.element == smaller.element && larger.contains.contains(&smaller.id)
        }
        _ => false,
    };
    by_name || fewer.is_subset(more)
}

/// What a fit has changed.
fn parts(fitted: &Fitted) -> BTreeSet<Handle> {
    fitted.coordinates.iter().map(|it| it.handle).collect()
}

/// Keeps the last word on each term.
fn merge(all: &mut Vec<Tried>, new: Vec<Tried>) {
    all.retain(|old| !new.iter().any(|it| it.term == old.term));
    all.extend(new);
}

/// The least fall of the sum of squares that may matter.
fn worth(base: &Fitted) -> f64 {
    12.0_f64.max(0.005 * 2.0 * base.cost)
}

/// Terms that nothing shows of while they are absent: they begin to act beyond a threshold.
const HIDDEN: &[&str] = &["09", "12", "20"];
