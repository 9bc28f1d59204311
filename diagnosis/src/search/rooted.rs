//! Causes that hide among what is fitted first: an effect that the rig has already, in quite another size, and a signal
//! that is later than any measurement makes it.

use crate::catalogue;
use crate::estimation::fit::{Handle, Point};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::lsq::Stop;
use crate::report::findings::Evidence;

use super::{Accepted, Found, Tried, contains_by_name, has_no_name, matters_beside};

/// Relative change of an effect's size beyond which it is another one.
const RESIZED: f64 = 0.5;
/// Standard deviations of a channel's timing beyond which it is a fault that matters if the errors show it, and beyond which
/// it matters however little they do.
pub(super) const LATE: f64 = 5.0;
const TOO_LATE: f64 = 7.0;

/// What may have been fitted away: the cause, and the values without it of all that it is fitted by.
struct Suspect {
    term: Term,
    before: Vec<(Handle, f64)>,
    /// Whether it matters however little of it the errors show.
    grave: bool,
}

impl Suspect {
    /// What speaks for a term in its place, or for itself: more than the usual amount is what made it suspect.
    fn weighed(&self, it: Term, evidence: Evidence) -> Evidence {
        let timing = matches!(it, Term::Fault(_));
        let usual = evidence.usual && it != self.term && !timing;
        Evidence { usual, grave: self.grave && timing, ..evidence }
    }
}

/// What explains as much as a suspect does.
struct Rival {
    term: Term,
    evidence: Evidence,
    fitted: Fitted,
}

/// How late a signal is.
struct Timing {
    /// What makes it late.
    handles: Vec<Handle>,
    /// In standard deviations of what any measurement does.
    late: f64,
}

impl World<'_> {
    /// The causes that hide in the base parameters of what was found, with what speaks for the difference and the rivals
    /// that explain it as well. A rival that explains it better is added to what was found.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn rooted(&self, found: &mut Found) -> Result<Vec<Accepted>, String> {
        let mut rooted = Vec::new();
        for suspect in self.suspects(found) {
            let there = |it: &Term| *it == suspect.term || contains_by_name(*it, suspect.term);
            if found.extended.terms.iter().any(there) {
                continue;
            }
            let mut start = found.extended.point.clone();
            suspect.before.iter().for_each(|(handle, value)| start.set(*handle, *value));
            let held = suspect.before.iter().map(|(handle, _)| *handle).collect();
            let without = World { held, ..self.clone() };
            // Without a fit to compare to there is nothing to be told.
            let Ok(held) = without.fitted(&found.extended.terms, &[start], Stop::NOISY) else { continue };
            let evidence = self.evidence(suspect.term, &held, &held, &found.extended);
            let evidence = suspect.weighed(suspect.term, evidence);
            if evidence.refusal().is_some() {
                continue;
            }
            let mut fits = without.instead(&suspect, &held)?;
            fits.retain(|rival| !self.shows_beside(&suspect, &held, rival, &found.extended.point));
            let behind = |it: &Fitted| self.apart(&found.extended, it);
            let (curves, names): (Vec<&Rival>, Vec<&Rival>) =
                fits.iter().partition(|it| has_no_name(it.term));
            let ahead = names.iter().filter(|it| !self.as_good(&held, &it.fitted, &found.extended));
            let ahead = ahead.min_by(|a, b| behind(&a.fitted).total_cmp(&behind(&b.fitted)));
            let named = ahead.map_or(&found.extended, |it| &it.fitted);
            let better = |it: &&&Rival| self.is_clearly_better(&held, (it.term, &it.fitted), named);
            let ahead = curves.iter().find(better).or(ahead);
            let best = ahead.map_or(&found.extended, |it| &it.fitted);
            let (term, evidence) = ahead.map_or((suspect.term, evidence), |it| (it.term, it.evidence));
            let rivals = names.iter().filter(|it| it.term != term && self.as_good(&held, best, &it.fitted));
            let rivals = rivals.map(|it| it.term).collect();
            let told = Accepted { term, evidence, rivals };
            match ahead {
                Some(Rival { fitted, .. }) => {
                    // It was fitted well enough to be compared; now it is to be told.
                    let start = std::slice::from_ref(&fitted.point);
                    found.extended = self.fitted(&fitted.terms, start, Stop::NOISY)?;
                    // What was found before may have done its work.
                    self.retest(found)?;
                    found.accepted.push(told);
                }
                None => rooted.push(told),
            }
        }
        Ok(rooted)
    }

    /// What may stand in the place of a suspect, fitted on top of what was fitted without it.
    fn instead(&self, suspect: &Suspect, held: &Fitted) -> Result<Vec<Rival>, String> {
        let screened = self.screened(held)?;
        let mut promising = self.promising(held, &screened);
        promising.retain(|it| it.term != suspect.term);
        // Of curves only those that are no more than the suspect itself in a shape that has no name.
        let shapeless = |it: Term| has_no_name(it) && contains_by_name(it, suspect.term);
        promising.extend(screened.iter().filter(|it| shapeless(it.term)));
        let rival = |it: Tried| {
            let evidence = suspect.weighed(it.term, it.evidence);
            let passes = evidence.refusal().is_none();
            passes.then_some(Rival { term: it.term, evidence, fitted: it.fitted.ok()? })
        };
        Ok(self.try_all(held, held, &promising).into_iter().filter_map(rival).collect())
    }

    /// Whether a suspect is still seen beside what may stand in its place: then that does something else, as a command that is a
    /// little late does where a sensor is very late.
    fn shows_beside(&self, suspect: &Suspect, held: &Fitted, rival: &Rival, found: &Point) -> bool {
        let mut start = rival.fitted.point.clone();
        suspect.before.iter().for_each(|(handle, _)| start.set(*handle, found.get(*handle)));
        let both = self.fitted(&rival.fitted.terms, &[start], Stop::NOISY);
        both.is_ok_and(|both| {
            let evidence = self.evidence(suspect.term, held, &rival.fitted, &both);
            suspect.weighed(suspect.term, evidence).refusal().is_none()
        })
    }

    fn suspects(&self, found: &Found) -> Vec<Suspect> {
        let (rig, point) = (self.rig, &found.extended.point);
        let base = rig.base();
        let resized = catalogue::causes(&rig.plant).filter_map(|cause| {
            let index = rig.plant.parameter(cause.parts.first()?.parameter).filter(|it| base.contains(it))?;
            let (before, after) = (rig.parameters[index], point.parameters[index]);
            let other = (after - before).abs() > RESIZED * before.abs();
            let before = vec![(Handle::Parameter(index), before)];
            other.then_some(Suspect { term: Term::Cause(cause), before, grave: false })
        });
        let late = self.timings(&found.extended).into_iter().filter_map(|Timing { handles, late }| {
            let most = handles.iter().max_by(|a, b| point.get(**a).abs().total_cmp(&point.get(**b).abs()))?;
            let before = handles.iter().map(|it| (*it, 0.0)).collect();
            (late > LATE).then_some(Suspect { term: Term::Fault(*most), before, grave: late > TOO_LATE })
        });
        resized.chain(late).collect()
    }

    /// The timing of each measured output, as far as it was not found to be a fault.
    fn timings(&self, fitted: &Fitted) -> Vec<Timing> {
        let of = |output: usize| {
            let own = |it: &Handle| matches!(it, Handle::Output(of, _) if *of == output);
            let handles = fitted.coordinates.iter().map(|it| it.handle).filter(own);
            let response = fitted.terms.contains(&Term::Response(output));
            let found = |it: &Handle| response || fitted.terms.contains(&Term::Fault(*it));
            let handles: Vec<Handle> = handles.filter(|it| self.usual(*it).is_some() && !found(it)).collect();
            // A delay and a lag that oppose one another leave a signal as late as their sum.
            let sum: f64 = handles.iter().map(|it| fitted.point.get(*it)).sum();
            let late = sum.abs() / self.usual(*handles.first()?)?;
            Some(Timing { handles, late })
        };
        (0..self.rig.plant.outputs.len()).filter_map(of).collect()
    }

    /// Number of signals that are later than any measurement makes them.
    pub(super) fn late(&self, fitted: &Fitted) -> usize {
        self.timings(fitted).iter().filter(|it| it.late > LATE).count()
    }

    /// Takes away what was found and is small beside the causes that hide in the base parameters. Tells whether anything
    /// was.
    ///
    /// # Errors
    /// If the model diverges without it.
    pub fn dwarfed(&self, found: &mut Found, rooted: &[Accepted]) -> Result<bool, String> {
        let largest = rooted.iter().map(|it| it.evidence.phi_gain).fold(0.0, f64::max);
        let before = found.accepted.len();
        while let Some(index) =
            found.accepted.iter().rposition(|it| !matters_beside(it.term, &it.evidence, largest))
        {
            found.extended = self.without(found, index)?;
            found.accepted.remove(index);
        }
        Ok(found.accepted.len() < before)
    }
}
