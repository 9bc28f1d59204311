//! The search: place, law, confirmation, repeated until no error worth reporting remains.

mod worth;

use crate::catalogue::Prevalence;
use crate::catalogue::naming::prevalence;
use crate::confirm::{Confirmed, Tried, contains_by_name};
use crate::decision::choice::{Choice, Score, best_of, by_share, choose, likeliest, likely};
use crate::decision::criteria::CRITERIA;
use crate::decision::description::place_of_rest;
use crate::estimation::deadline::Stage;
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::unknowns::Estimate;
use crate::explain::describe::Unmodelled;
use crate::explain::selection::{Compared, MOST_FITTED};
use crate::explain::signal::{MissingSignal, swings_by_itself};
use crate::missing::innovations::Noise;
use crate::missing::locate::Location;
use crate::missing::motion::outputs;
use crate::missing::{Frame, Missing};
use crate::plant::Signals;

use super::Found;
use super::component::Component;
use super::nominal;

/// Effects at most.
const MOST: usize = 4;
/// How often other effects are fitted where the first ones are not confirmed.
const ATTEMPTS: usize = 4;
/// How often errors are made as large as the best explanation leaves, where no effect is confirmed.
const REFINEMENTS: usize = 3;
/// Unmodelled places at most.
const PLACES: usize = 2;

/// The result of one round of the search.
#[derive(Clone, Copy)]
enum Next {
    /// An effect with a name.
    Effect,
    /// Features without one.
    Curve(Score),
    /// Nothing that was recorded explains what is missing, if anything is.
    Nothing,
}

/// The missing signal in one round, and its comparison with all candidates.
struct Looked<'a> {
    missing: Missing<'a>,
    signals: Vec<Signals>,
    location: Location,
    compared: Compared,
}

impl Baseline<'_> {
    /// Typical magnitudes along the trajectory, and how many independent comparisons all effects amount to. Gives the nominal fit
    /// within the bounds that are known by then: a friction's velocity is bounded by shares of the typical one.
    pub(super) fn look_at(&mut self, mut base: Fitted) -> Result<Fitted, String> {
        let frame = self.frame(&[], &self.unbent(&base))?;
        let missing = self.missing(&frame)?;
        let signals = outputs(&missing.setting, &missing.windows, self.rig.plant.outputs.len());
        let typical = self.typical_along(&missing, &signals);
        self.typical = typical;
        if self.coordinates(&[]) != base.coordinates {
            base = nominal::weighted(self, base)?;
        }
        let tried = self.tried_out(&base)?;
        (self.looks, self.shapes) = (tried.looks(&base), self.best_shapes(&base, &tried));
        self.promised = self.promised(&base, &tried);
        Ok(base)
    }

    /// A fit with the parameters as they were before it: it has bent them to what it lacks.
    fn unbent(&self, fitted: &Fitted) -> Estimate {
        Estimate { parameters: self.sheet.clone(), ..fitted.point.clone() }
    }

    /// Repeats place, law and confirmation until no error worth reporting remains.
    pub(super) fn identify(&self, found: &mut Found, progress: &(dyn Fn(&str) + Sync)) -> Result<(), String> {
        let (mut errors, mut refinements, mut refused) = (None, 0, found.retracted.clone());
        let mut first = None;
        // What a first look sees is shown in any case.
        let is_wanted =
            |found: &Found| found.missing.is_none() || self.may_matter(&found.base, &found.extended, 1.0);
        while found.accepted.len() < MOST && is_wanted(found) && !self.deadline.is_over(Stage::Search) {
            progress("estimating the missing signal");
            let terms = found.extended.terms.clone();
            let at = match terms.is_empty() {
                true => self.unbent(&found.extended),
                false => found.extended.point.clone(),
            };
            let frame = self.frame(&terms, &at)?;
            let Some(looked) = self.looked(&frame, found, errors.as_ref())? else { break };
            let Looked { missing, signals, location, mut compared } = looked;
            if found.missing.is_none() {
                found.missing = Some(MissingSignal::of(self, &missing, &location, &signals));
            }
            // Errors within the sensors' accuracy in each sample may add up over a simulation.
            if self.is_worth_a_look(&found.extended) {
                compared.misses = compared.misses.max(1.0);
            }
            if found.compared.is_empty() {
                found.compared = compared.ranking();
            }
            let mut next = self.named(found, (&missing, &compared), &mut refused, progress)?;
            let over = self.deadline.is_over(Stage::Search);
            if !matches!(next, Next::Effect) && refinements < REFINEMENTS && is_wanted(found) && !over {
                // Sensors that disagree by more than their noise decide the comparison until larger errors are assumed.
                let background = &location.background;
                let larger = missing.refined(background, &compared.best().unwrap_or_default());
                if larger != *background {
                    (errors, refinements) = (Some(larger), refinements + 1);
                    first.get_or_insert_with(|| {
                        // Larger errors of one sensor hide its own fault; an open account says that it is there.
                        let open = self.is_open(&found.extended.test);
                        let rest = || self.remainder(found, &missing, &location, &compared);
                        (next, open.then(rest).flatten())
                    });
                    continue;
                }
            }
            // Free features have to explain the signal with the sensors' own accuracy and with the larger errors.
            let mut unrefined = None;
            if let Some((first, rest)) = first.take().filter(|_| !matches!(next, Next::Effect)) {
                unrefined = rest;
                next = match first {
                    Next::Curve(score) if compared.holds(score.candidate) => first,
                    _ => Next::Nothing,
                };
            }
            (errors, refinements) = (None, 0);
            let described = found.unmodelled.len();
            let goes_on = match next {
                Next::Effect => {
                    refused.clone_from(&found.retracted);
                    true
                }
                // An unfinished search claims nothing.
                _ if over => false,
                Next::Curve(score)
                    if !swings_by_itself((&missing, &location, &compared), score)
                        && self.unmodelled(found, (&missing, &compared), score)? =>
                {
                    true
                }
                _ => {
                    let rest = self.remainder(found, &missing, &location, &compared);
                    self.place_rest(found, described, rest.or(unrefined));
                    false
                }
            };
            if !goes_on {
                break;
            }
        }
        Ok(())
    }

    /// The missing signal, its place and all candidates, with at least these errors.
    fn looked<'b>(
        &self,
        frame: &'b Frame,
        found: &Found,
        errors: Option<&Noise>,
    ) -> Result<Option<Looked<'b>>, String> {
        let mut missing = self.missing_with(frame, errors.map(|it| &it.outputs[..]))?;
        let signals = outputs(&missing.setting, &missing.windows, self.rig.plant.outputs.len());
        for known in &found.unmodelled {
            known.explain(&mut missing, self, &signals);
        }
        let mut location = missing.located();
        if let Some(errors) = errors {
            location
                .background
                .ports
                .iter_mut()
                .zip(&errors.ports)
                .for_each(|(it, more)| *it = it.max(*more));
        }
        let candidates = self.candidates(&missing, &signals, &found.extended.terms);
        let compared = self.compared(&missing, candidates, &location.background);
        let compared = compared.map(|it| self.sharpened((&missing, &signals), it, &location.background));
        let compared = compared.map(|it| if self.uses(Component::Ports) { it } else { it.undecided() });
        let compared = compared.map(|it| if self.uses(Component::Features) { it } else { it.of_names() });
        Ok(compared.map(|compared| Looked { missing, signals, location, compared }))
    }

    /// Fits the effects that explain most of the missing signal, until one is confirmed.
    fn named(
        &self,
        found: &mut Found,
        (missing, compared): (&Missing<'_>, &Compared),
        refused: &mut Vec<Term>,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<Next, String> {
        let mut names = compared.named.clone();
        let mut features = compared.features.clone();
        let mut curve = None;
        let left = self.leaves_something(&found.extended.test);
        // A model without a described signal bends every fitted effect to it. Then only the comparison chooses effects.
        let lacks = found.unmodelled.iter().any(|it| it.curve.is_none());
        // Of the starting model alone it is known what its simulation asks for.
        let is_first = found.extended.terms.is_empty();
        let promised = |score: &Score| {
            let term = compared.term(score).filter(|_| is_first);
            let found = self.promised.iter().find(|(of, _)| Some(*of) == term);
            found.map_or(0.0, |(_, share)| *share)
        };
        for _ in 0..ATTEMPTS {
            let choice = choose(compared.misses, &names, &features);
            let is_last_resort = choice == Choice::Nothing;
            let (scores, least) = match choice {
                // Beside an effect that the model has only roughly, amounts by innovations may not hold on other data: fits decide.
                Choice::Nothing if left && !lacks => (likeliest(&names, promised), 0.0),
                Choice::Nothing => return Ok(Next::Nothing),
                Choice::Unmodelled(score) if lacks => return Ok(Next::Curve(score)),
                Choice::Unmodelled(score) => {
                    curve = Some(score);
                    // A fit shows what a simulation would: features may explain each sample's innovation, and little of that. And it is
                    // judged where it explains less: features may explain much of the estimation data, and little of others.
                    let simulated = self.reduction((missing, compared), score);
                    let shares = [score.share, score.validated, simulated];
                    let explained = shares.into_iter().fold(f64::INFINITY, f64::min);
                    (likely(&names, &score), CRITERIA.fitted * explained)
                }
                Choice::Named(scores) => (scores, 0.0),
            };
            // Where nothing is left to be told, a fit is not worth its time that promises nothing visible. Where something is, a share of
            // the innovations says little: a nominal parameter may have taken the effect's place. A rough shape promises less than
            // its fit holds.
            let share = |it: &Score| if left { 1.0 } else { it.share / CRITERIA.rough };
            let (base, null) = (&found.base, &found.extended);
            if scores.first().is_none_or(|it| !self.may_matter(base, null, share(it))) {
                return Ok(curve.map_or(Next::Nothing, Next::Curve));
            }
            let scores = compared.with_alike(scores);
            let most = if self.uses(Component::Ports) { MOST_FITTED } else { usize::MAX };
            let mut proposals = compared.proposals(&scores, most);
            // Nominal parameters may have hidden what every rig has: a fit tells, whatever the comparison says.
            if found.extended.terms.is_empty() {
                let mut expected = compared.proposals(&self.expected(compared), usize::MAX);
                expected.retain(|it| !proposals.iter().any(|other| other.term == it.term));
                proposals.extend(expected);
            }
            proposals.retain(|it| !refused.contains(&it.term));
            if !proposals.is_empty() {
                progress(&format!("fitting {} effects", proposals.len()));
                let mut tried = self.try_all(&found.base, &found.extended, &proposals);
                tried.extend(self.together(&found.base, &found.extended, &tried));
                tried.extend(self.generalised(found, compared, &tried, refused));
                tried.sort_by(|a, b| b.score.total_cmp(&a.score));
                if self.deadline.is_over(Stage::Search) {
                    found.tried.extend(tried);
                    return Ok(Next::Nothing);
                }
                let confirmed = self.confirmed(&found.base, &tried)?;
                // A confirmed effect that explains less than free features may explain more under larger errors.
                let refusal = |it: &&Tried| curve.is_none() || it.evidence.refusal().is_some();
                refused.extend(tried.iter().filter(refusal).map(|it| it.term));
                found.tried.extend(tried);
                if let Some(confirmed) = confirmed
                    && self.explained_there(confirmed.accepted.term, &found.extended, &confirmed.fitted)
                        >= least
                {
                    found.extend(confirmed);
                    return Ok(Next::Effect);
                }
            }
            if let Some(score) = curve {
                return Ok(Next::Curve(score));
            }
            if is_last_resort {
                return Ok(Next::Nothing);
            }
            // Where refused laws reduce a simulation's errors nearly as much as features do, nothing is unmodelled.
            let own = |it: &&Tried| scores.iter().any(|score| compared.is_of(score, it.term));
            let explained = found.tried.iter().filter(own).map(|it| it.evidence.residual_reduction);
            let explained = explained.fold(0.0, f64::max);
            if let Some(best) = best_of(&features)
                && explained >= CRITERIA.fitted * self.reduction((missing, compared), best)
            {
                features.clear();
            }
            names.retain(|it| !refused.iter().any(|term| compared.is_of(it, *term)));
        }
        Ok(Next::Nothing)
    }

    /// The best shapes of the effects that every rig has.
    fn expected(&self, compared: &Compared) -> Vec<Score> {
        let ranking = if self.uses(Component::Background) { compared.ranking() } else { Vec::new() };
        let is_expected = |term: Term| prevalence(term, &self.rig.plant) == Prevalence::Expected;
        ranking.into_iter().filter(|(term, _)| is_expected(*term)).map(|(_, score)| score).collect()
    }

    /// Fits the laws that have the best of those that were tried as a limit, where that leaves the account open.
    fn generalised(
        &self,
        found: &Found,
        compared: &Compared,
        tried: &[Tried],
        refused: &[Term],
    ) -> Vec<Tried> {
        let Some(best) = tried.iter().max_by(|a, b| a.score.total_cmp(&b.score)) else { return Vec::new() };
        if best.evidence.refusal().is_some()
            || best.fitted.as_ref().is_ok_and(|fitted| !self.is_open(&fitted.test))
        {
            return Vec::new();
        }
        let known = |term: Term| refused.contains(&term) || tried.iter().any(|it| it.term == term);
        let richer = |score: &&Score| {
            compared.term(score).is_some_and(|term| contains_by_name(term, best.term) && !known(term))
        };
        let scores: Vec<Score> = compared.named.iter().filter(richer).copied().collect();
        let proposals = compared.proposals(&by_share(scores), MOST_FITTED);
        self.richer(&found.base, &found.extended, best, &proposals)
    }

    /// Takes features without a name as explained, as a curve in the model if there is one. Whether to look further.
    fn unmodelled(
        &self,
        found: &mut Found,
        (missing, compared): (&Missing<'_>, &Compared),
        score: Score,
    ) -> Result<bool, String> {
        let reduction = self.reduction((missing, compared), score);
        let improvement = self.improvement(&found.extended, reduction) * found.left_by_descriptions();
        // Free features take the shape of what every rig has a little of, too.
        let background = if self.is_open(&found.extended.test) { 1.0 } else { CRITERIA.background };
        let is_small = improvement < background * CRITERIA.improvement;
        // An open account gets the best description that there is, however little of it a simulation shows.
        let alone = found.accepted.is_empty() && found.unmodelled.is_empty();
        if found.unmodelled.len() == PLACES || is_small && !(alone && self.is_open(&found.extended.test)) {
            return Ok(false);
        }
        let port = compared.feature(score.candidate).map(|(port, ..)| &missing.setting.ports[port]);
        let curve = compared.curve_for(score, port.and_then(|it| it.element));
        if let Some((term, own)) = curve.filter(|(term, _)| !found.retracted.contains(term))
            && let Some(confirmed) = self.drawn(found, compared, own)?
        {
            found.unmodelled.push(Unmodelled::curve(term, own, improvement, &self.rig.plant));
            found.extend(confirmed);
            return Ok(true);
        }
        // Without a curve in the model that the data confirm, its place and its variable are known all the same.
        let curve = curve.map(|(term, own)| Unmodelled::curve(term, own, improvement, &self.rig.plant));
        let unmodelled = Unmodelled::of(missing, compared, score, (improvement, &self.rig.plant));
        let goes_on = unmodelled.is_some();
        found.unmodelled.extend(unmodelled.or(curve));
        Ok(goes_on)
    }

    /// A curve without a name in the model, if the data confirm it.
    fn drawn(
        &self,
        found: &mut Found,
        compared: &Compared,
        score: Score,
    ) -> Result<Option<Confirmed>, String> {
        let tried = self.try_all(&found.base, &found.extended, &compared.proposals(&[score], 1));
        let confirmed = self.confirmed(&found.base, &tried)?;
        found.tried.extend(tried);
        Ok(confirmed)
    }

    /// Puts a rest without an explanation among the descriptions, in place of that of an earlier search. `described`: their number before
    /// the round.
    fn place_rest(&self, found: &mut Found, described: usize, rest: Option<Unmodelled>) {
        let all = &mut found.unmodelled;
        let known = all.len();
        if rest.is_some() {
            all.retain(|it| it.share > 0.0 || it.curve.is_some());
        }
        let described = described.saturating_sub(known - all.len());
        let place = place_of_rest(all.iter().map(|it| it.share)).unwrap_or(all.len());
        // Behind a curve that explains most, there has been no look at the rest.
        let looked_at = all.len() == described || place < all.len();
        if self.uses(Component::Ports) && described < PLACES && looked_at {
            all.splice(place..place, rest);
        }
    }

    /// A missing signal that no recorded signal explains.
    fn remainder(
        &self,
        found: &Found,
        missing: &Missing<'_>,
        location: &Location,
        compared: &Compared,
    ) -> Option<Unmodelled> {
        let best = location.ranked.first().filter(|_| compared.misses >= 1.0)?;
        let improvement = self.improvement(&found.extended, 2.0 * best.gain / compared.left);
        let improvement = improvement * found.left_by_descriptions();
        (improvement >= CRITERIA.improvement).then(|| Unmodelled::remainder(missing, location, best.port))
    }
}
