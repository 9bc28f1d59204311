//! Causes that hide among what is fitted first: an effect that the rig has already, in quite another size, and a signal
//! that is later than any measurement makes it.

use crate::catalogue;
use crate::findings::Evidence;
use crate::fit::Handle;
use crate::hypothesis::{Fitted, Term, World};
use crate::lsq::Stop;

use super::{APART, Accepted, Found, is_table, matters_beside};

/// Relative change of an effect's size beyond which it is another one.
const RESIZED: f64 = 0.5;
/// Standard deviations of a channel's timing beyond which it is a fault that matters if the errors show it, and beyond which
/// it matters however little they do.
const LATE: f64 = 5.0;
const TOO_LATE: f64 = 7.0;

/// What may have been fitted away: the cause, and the values without it of all that it is fitted by.
struct Suspect {
    term: Term,
    before: Vec<(Handle, f64)>,
    /// Whether it matters however little of it the errors show.
    grave: bool,
}

impl World<'_> {
    /// The causes that hide in the base parameters of what was found, with what speaks for the difference and the rivals
    /// that explain it as well. A rival that explains it better is added to what was found.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn rooted(&self, found: &mut Found) -> Result<Vec<Accepted>, String> {
        let mut rooted = Vec::new();
        for Suspect { term, before, grave } in self.suspects(found) {
            let mut start = found.extended.point.clone();
            before.iter().for_each(|(handle, value)| start.set(*handle, *value));
            let held = before.iter().map(|(handle, _)| *handle).collect();
            let without = World { held, ..self.clone() };
            // Without a fit to compare to there is nothing to be told.
            let Ok(held) = without.fitted(&found.extended.terms, &[start], Stop::NOISY) else { continue };
            // More than the usual amount is what made it suspect.
            let passes = |it: Term, evidence: Evidence| {
                let timing = matches!(it, Term::Fault(_));
                let evidence = Evidence { usual: evidence.usual && it != term && !timing, ..evidence };
                let refusal = if grave && timing { evidence.doubt() } else { evidence.refusal() };
                refusal.is_none() && !is_table(it)
            };
            let evidence = self.evidence(term, &held, &held, &found.extended);
            if !passes(term, evidence) {
                continue;
            }
            let screened = without.screened(&held)?;
            let mut promising = without.promising(&held, &screened);
            promising.retain(|it| it.term != term);
            let mut tried = without.try_all(&held, &held, &promising);
            tried.retain(|it| it.fitted.is_ok() && passes(it.term, it.evidence));
            let fits: Vec<(Term, Evidence, Fitted)> =
                tried.into_iter().filter_map(|it| Some((it.term, it.evidence, it.fitted.ok()?))).collect();
            let behind = |it: &Fitted| self.apart(&found.extended, it);
            let ahead = fits.iter().filter(|(_, _, it)| behind(it) < -APART);
            let ahead = ahead.min_by(|(_, _, a), (_, _, b)| behind(a).total_cmp(&behind(b))).cloned();
            let best = ahead.as_ref().map_or(&found.extended, |(_, _, it)| it);
            let own = ahead.as_ref().map_or(term, |(it, _, _)| *it);
            let alike = |it: &&(Term, Evidence, Fitted)| it.0 != own && self.as_good(&held, best, &it.2);
            let rivals = fits.iter().filter(alike).map(|(it, _, _)| *it).collect();
            match ahead {
                Some((term, evidence, fitted)) => {
                    found.extended = fitted;
                    found.accepted.push(Accepted {
                        term,
                        evidence: Evidence { usual: false, ..evidence },
                        rivals,
                    });
                }
                None => {
                    rooted.push(Accepted { term, evidence: Evidence { usual: false, ..evidence }, rivals });
                }
            }
        }
        Ok(rooted)
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
        let late = (0..rig.plant.outputs.len()).filter_map(|output| {
            let own = |it: &Handle| matches!(it, Handle::Output(of, _) if *of == output);
            let fitted = found.extended.coordinates.iter().map(|it| it.handle).filter(own);
            let timing: Vec<Handle> = fitted.filter(|it| self.usual(*it).is_some()).collect();
            // A delay and a lag that oppose one another leave a signal as late as their sum.
            let late: f64 = timing.iter().map(|it| point.get(*it)).sum();
            let most = timing.iter().max_by(|a, b| point.get(**a).abs().total_cmp(&point.get(**b).abs()))?;
            let before = timing.iter().map(|it| (*it, 0.0)).collect();
            let late = late.abs() / self.usual(*most)?;
            (late > LATE).then_some(Suspect { term: Term::Fault(*most), before, grave: late > TOO_LATE })
        });
        resized.chain(late).filter(|it| !found.extended.terms.contains(&it.term)).collect()
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
