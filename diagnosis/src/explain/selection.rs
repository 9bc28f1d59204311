//! Which candidate explains what is missing: by the estimation records, and whether the validation records agree.

use std::ops::Range;

use nalgebra::DVector;

use crate::catalogue::{Element, Scale, Table, distortion};
use crate::confirm::has_no_name;
use crate::decision::choice::Score;
use crate::decision::criteria::CRITERIA;
use crate::estimation::hypothesis::{Baseline, Term};
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::missing::Missing;
use crate::missing::innovations::{Column, Columns, Noise, Stretch};
use crate::missing::motion::Mover;
use crate::screening::of_gain;

use super::candidates::{Candidates, Kind};
use super::features::Group;

/// Names that are fitted at most.
pub const MOST_FITTED: usize = 6;

/// Share of their power by which columns of a curve and nominal parameters differ that are compared as one: along a motion that is
/// estimated, none is known better. Else a curve and the parameter that it contains would each be as large as one likes, one against the
/// other.
const ALIKE: f64 = 1e-4;

/// A name to be fitted, and from where.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The effect.
    pub term: Term,
    /// The point from which it is to be fitted.
    pub start: Estimate,
    /// How well it explains what is missing.
    pub score: Score,
}

/// Candidates compared to what is missing.
pub struct Compared {
    /// All candidates.
    pub candidates: Candidates,
    /// Mean square of the innovations: above one, the sensors' accuracy is exceeded.
    pub misses: f64,
    /// Sum of squares that is left of the estimation records.
    pub left: f64,
    /// Those with a name.
    pub named: Vec<Score>,
    /// Groups of features.
    pub features: Vec<Score>,
    /// The missing signal's sum of squares in the estimation and the validation records.
    whole: [f64; 2],
    /// Amounts of each candidate's columns.
    amounts: Vec<Vec<f64>>,
    points: Vec<Option<Estimate>>,
}

impl Baseline<'_> {
    /// Compares all candidates to what is missing.
    pub fn compared(&self, missing: &Missing<'_>, candidates: Candidates, noise: &Noise) -> Option<Compared> {
        let ranges: Vec<Range<usize>> = candidates.list.iter().map(|it| it.columns.clone()).collect();
        let beside = Columns { windows: &candidates.columns, candidates: &ranges };
        let stretches = missing.setting.innovations(&missing.windows, noise, beside);
        let train = Stretch::total(&stretches, |record| record < missing.train)?;
        let test = Stretch::total(&stretches, |record| record >= missing.train);
        let known = train.known();
        let before = known.fitted(&missing.precisions)?;
        let misses = before.left / (known.count as f64).max(1.0);
        let held_out = test.as_ref().and_then(|sums| {
            let known = sums.known();
            Some((sums, known.fitted(&missing.precisions)?.left, known.count))
        });
        let (mut named, mut features) = (Vec::new(), Vec::new());
        let (mut all_amounts, mut points) = (Vec::new(), Vec::new());
        for (number, candidate) in candidates.list.iter().enumerate() {
            let precisions = missing.precisions_beside(candidate.columns.len());
            let all = train.with(number);
            let has_name = matches!(&candidate.kind, Kind::Named { term, .. } if !has_no_name(*term));
            let fitted =
                if has_name { all.fitted(&precisions) } else { all.fitted_apart(&precisions, ALIKE) };
            let amounts: Vec<f64> = fitted
                .as_ref()
                .map_or(Vec::new(), |it| it.values.iter().skip(missing.precisions.len()).copied().collect());
            all_amounts.push(amounts.clone());
            points.push(None);
            let Some(fitted) = fitted else { continue };
            let chance = (candidate.columns.len() as f64) * (known.count as f64).ln();
            let gain = before.left - fitted.left - chance;
            // The remaining error of other records with these amounts, nuisances being fitted there.
            let validated = held_out.map_or(0.0, |(sums, before, _)| {
                let left = sums.with(number).moved(&amounts).fitted(&missing.precisions);
                before - left.map_or(f64::INFINITY, |it| it.left)
            });
            // Reductions of the sums of squares; shares need all candidates.
            let mut score = Score { candidate: number, share: gain, validated };
            match &candidate.kind {
                Kind::Named { term, probe } => {
                    let amounts = DVector::from_vec(amounts);
                    let at = &missing.point();
                    let (within, point) = self.start(*term, probe, &amounts, at);
                    score.share *= if gain > 0.0 { of_gain(within) } else { 0.0 };
                    points[number] = Some(point);
                    if has_no_name(*term) { &mut features } else { &mut named }.push(score);
                }
                Kind::Feature { group, mover, .. } => {
                    let at = &missing.setting.point.parameters;
                    let mut steps = missing.setting.parameters.iter().zip(fitted.values.iter());
                    let drives_off = steps.any(|(index, step)| self.is_gone(*index, at[*index], *step));
                    if !drives_off && is_possible((*group, *mover), &amounts, &candidate.peaks) {
                        features.push(score);
                    }
                }
            }
        }
        // Less than one, as no sensor is believed beyond its accuracy.
        let quiet = missing.setting.floors.iter().zip(&noise.outputs).map(|(floor, error)| floor / error);
        let quiet = quiet.sum::<f64>() / noise.outputs.len().max(1) as f64;
        let held_out = held_out.map_or((0.0, 0), |(_, left, count)| (left, count));
        let data = [(before.left, known.count), held_out];
        let whole = in_shares(&mut [&mut named, &mut features], quiet, data);
        Some(Compared {
            candidates,
            misses,
            left: before.left,
            named,
            features,
            whole,
            amounts: all_amounts,
            points,
        })
    }
}

/// Turns the reductions of both sums of squares (estimation and validation records) into shares of the missing signal. The
/// missing signal is the sum of squares beyond measurement noise, and at least what the best candidate explains. Gives both.
fn in_shares(scores: &mut [&mut Vec<Score>; 2], quiet: f64, [train, test]: [(f64, usize); 2]) -> [f64; 2] {
    let largest = |of: &dyn Fn(&Score) -> f64| {
        scores.iter().flat_map(|all| all.iter()).map(of).fold(f64::MIN_POSITIVE, f64::max)
    };
    let excess = |(left, count): (f64, usize), most: f64| (left - quiet * count as f64).max(most);
    let train = excess(train, largest(&|it| it.share));
    let test = excess(test, largest(&|it| it.validated));
    for score in scores.iter_mut().flat_map(|all| all.iter_mut()) {
        score.share /= train;
        score.validated /= test;
    }
    [train, test]
}

/// Whether features may act: no body is lighter for what acts on it, and no force is far beyond what moves the rig. Where a
/// trajectory is followed closely, "the body has no mass, and the command does nothing" would explain it, too.
fn is_possible((group, mover): (Group, Mover), amounts: &[f64], peaks: &[f64]) -> bool {
    let light = match (group, mover) {
        (Group::Acceleration, Mover::Element) => amounts[0] < 0.0,
        // An oscillator's pull is its mass times what drives it, against the motion.
        (Group::Resonance(_), Mover::Element) => amounts[0] > 0.0,
        _ => false,
    };
    !light && amounts.iter().zip(peaks).all(|(amount, peak)| amount.abs() * peak < CRITERIA.largest)
}

impl Compared {
    /// Without the features: only effects with a name are compared.
    #[must_use]
    pub fn of_names(self) -> Self {
        Self { features: Vec::new(), ..self }
    }

    /// A score of this comparison, by what is missing in another one of the same signal.
    fn seen_by(&self, other: &Self, score: &Score) -> Score {
        let [train, test] = [0, 1].map(|it| self.whole[it] / other.whole[it]);
        Score { share: train * score.share, validated: test * score.validated, ..*score }
    }

    /// The share of what is missing in another comparison that a score of this one explains.
    pub(super) fn share_in(&self, other: &Self, score: &Score) -> f64 {
        self.seen_by(other, score).share
    }

    /// Takes features of another comparison of the same signal as a further candidate. The share that they explain: more than all
    /// that seemed to be missing is all that is missing.
    pub(super) fn take(&mut self, other: Self, score: Score) -> f64 {
        let own = other.seen_by(self, &score);
        let [train, test] = [own.share, own.validated].map(|it| it.max(1.0));
        for it in self.named.iter_mut().chain(&mut self.features) {
            (it.share, it.validated) = (it.share / train, it.validated / test);
        }
        self.whole = [self.whole[0] * train, self.whole[1] * test];
        let own = Score { candidate: self.candidates.list.len(), ..other.seen_by(self, &score) };
        self.amounts.push(other.amounts[score.candidate].clone());
        self.points.push(None);
        self.candidates.take(other.candidates, score.candidate);
        self.features.push(own);
        own.share
    }

    /// Without the comparison: any effect may be it.
    #[must_use]
    pub fn undecided(self) -> Self {
        let named = self.named.iter().map(|it| Score { share: 1.0, validated: 1.0, ..*it }).collect();
        Self { misses: self.misses.max(1.0), named, ..self.of_names() }
    }

    /// Names to be fitted, each once, from its best shapes.
    pub fn proposals(&self, scores: &[Score], most: usize) -> Vec<Proposal> {
        let mut all: Vec<Proposal> = Vec::new();
        for score in scores {
            let candidate = &self.candidates.list[score.candidate];
            let (Kind::Named { term, .. }, Some(point)) = (&candidate.kind, &self.points[score.candidate])
            else {
                continue;
            };
            if all.len() < most && !all.iter().any(|it| it.term == *term) {
                all.push(Proposal { term: *term, start: point.clone(), score: *score });
            }
        }
        all
    }

    /// Whether a candidate without a name explains a relevant share of both data.
    pub fn holds(&self, candidate: usize) -> bool {
        let own = self.features.iter().find(|it| it.candidate == candidate);
        own.is_some_and(|it| it.share >= CRITERIA.background_share && it.is_confirmed())
    }

    /// The columns of the best candidate, one list for each window.
    pub fn best(&self) -> Option<Vec<Vec<Column>>> {
        let all = self.named.iter().chain(&self.features);
        let best = all.max_by(|a, b| a.share.total_cmp(&b.share))?;
        Some(self.candidates.of(best.candidate))
    }

    /// The best shape of each effect with a name, the best effect first.
    pub fn ranking(&self) -> Vec<(Term, Score)> {
        let mut ranking: Vec<(Term, Score)> = Vec::new();
        for candidate in &self.candidates.list {
            let Kind::Named { term, .. } = candidate.kind else { continue };
            if let Some(score) = self.shape(term)
                && !ranking.iter().any(|(other, _)| *other == term)
            {
                ranking.push((term, score));
            }
        }
        ranking.sort_by(|a, b| b.1.share.total_cmp(&a.1.share));
        ranking
    }

    /// The best shape of a term.
    pub fn shape(&self, term: Term) -> Option<Score> {
        self.named
            .iter()
            .filter(|it| self.is_of(it, term))
            .max_by(|a, b| a.share.total_cmp(&b.share))
            .copied()
    }

    /// Scores, and behind the first those of distortions that look like it: of the same signal, or the same one at the other end of a
    /// model with one measured input or one measured output, as a delay before such a model is a delay behind it.
    pub fn with_alike(&self, mut scores: Vec<Score>) -> Vec<Score> {
        let Some(Term::Fault(best)) = scores.first().and_then(|it| self.term(it)) else { return scores };
        let alike = best.fault().map_or(&[][..], |it| distortion(it).alike).iter();
        let alike = alike.map(|it| best.with_fault(*it)).chain(self.at_the_other_end(best));
        let alike: Vec<Score> = alike.filter_map(|it| self.shape(Term::Fault(it))).collect();
        scores.splice(1..1, alike);
        scores
    }

    /// The same distortion at the only signal of the other end where it is looked for; none if there are none or several.
    fn at_the_other_end(&self, of: Unknown) -> Option<Unknown> {
        let mut others: Vec<Unknown> = Vec::new();
        for score in &self.named {
            if let Some(Term::Fault(it)) = self.term(score)
                && it.is_of_input() != of.is_of_input()
                && it.fault() == of.fault()
                && !others.contains(&it)
            {
                others.push(it);
            }
        }
        others.pop().filter(|_| others.is_empty())
    }

    /// The term of a score; none of features.
    pub fn term(&self, score: &Score) -> Option<Term> {
        match self.candidates.list[score.candidate].kind {
            Kind::Named { term, .. } => Some(term),
            Kind::Feature { .. } => None,
        }
    }

    /// Whether a score is that of a term, in any shape.
    pub fn is_of(&self, score: &Score, term: Term) -> bool {
        self.term(score) == Some(term)
    }

    /// Port and features.
    pub fn feature(&self, candidate: usize) -> Option<(usize, Mover, Group)> {
        match self.candidates.list[candidate].kind {
            Kind::Feature { port, mover, group } => Some((port, mover, group)),
            Kind::Named { .. } => None,
        }
    }

    /// A curve in the model that does nearly what free features do, at the same place over the same variable.
    pub fn curve_for(&self, score: Score, element: Option<Element>) -> Option<(Term, Score)> {
        let over = |table: &Table| match self.candidates.list[score.candidate].kind {
            Kind::Feature { group: Group::Deflection, .. } => {
                table.scale == Scale::DEFLECTION && table.law.point == Scale::FORCE
            }
            Kind::Feature { group: Group::Velocity, .. } => table.scale == Scale::VELOCITY,
            _ => false,
        };
        let near = |it: &&Score| it.share >= CRITERIA.rough * score.share;
        self.features.iter().filter(near).find_map(|it| match self.candidates.list[it.candidate].kind {
            Kind::Named { term: term @ Term::Table(table), .. }
                if Some(table.element) == element && over(table) =>
            {
                Some((term, *it))
            }
            Kind::Named { term, .. } if it.candidate == score.candidate => Some((term, *it)),
            _ => None,
        })
    }

    /// The column of a candidate that explains most, by what it reaches.
    pub fn largest(&self, candidate: usize) -> usize {
        let reached = self.amounts[candidate].iter().zip(&self.candidates.list[candidate].peaks);
        let reached = reached.map(|(amount, peak)| amount.abs() * peak);
        reached.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(column, _)| column)
    }

    /// Amounts of a candidate's columns.
    pub fn amounts(&self, candidate: usize) -> &[f64] {
        &self.amounts[candidate]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decision::choice::tests::score;

    #[test]
    fn a_candidate_explains_no_more_than_all_that_is_missing() {
        let (mut named, mut features) = (vec![score(0, 50.0, 20.0), score(1, 10.0, -5.0)], vec![]);
        // Left is what the noise makes, and yet a law explains fifty of it.
        let whole = in_shares(&mut [&mut named, &mut features], 0.25, [(100.0, 400), (300.0, 400)]);
        assert_eq!(whole, [50.0, 200.0]);
        assert_eq!(named, [score(0, 1.0, 0.1), score(1, 0.2, -0.025)]);
    }
}
