//! Causes that hide among what is fitted first: an effect that the rig has already, in quite another size, and a signal
//! that is later than any measurement makes it.

use crate::catalogue;
use crate::correction::Fault;
use crate::findings::Evidence;
use crate::fit::Handle;
use crate::hypothesis::{TIMING, Term, World};
use crate::lsq::Stop;

use super::{Accepted, Found, is_table, matters_beside};

/// Relative change of an effect's size beyond which it is another one.
const RESIZED: f64 = 0.5;
/// Standard deviations of a channel's timing beyond which it is a fault. An accelerometer's own filter takes two, a
/// multiplexer one.
const LATE: f64 = 5.0;

/// What may have been fitted away: the cause, what it is fitted by, and the value without it.
struct Suspect {
    term: Term,
    handle: Handle,
    before: f64,
}

impl World<'_> {
    /// The causes that hide in the base parameters of what was found, with what speaks for the difference and the rivals
    /// that explain it as well.
    ///
    /// # Errors
    /// If the model refuses its settings.
    pub fn rooted(&self, found: &Found) -> Result<Vec<Accepted>, String> {
        let mut rooted = Vec::new();
        for Suspect { term, handle, before } in self.suspects(found) {
            let mut start = found.extended.point.clone();
            start.set(handle, before);
            let without = World { held: vec![handle], ..self.clone() };
            // Without a fit to compare to there is nothing to be told.
            let Ok(held) = without.fitted(&found.extended.terms, &[start], Stop::NOISY) else { continue };
            // More than the usual amount of it is what made it suspect.
            let evidence = Evidence { usual: false, ..self.evidence(term, &held, &held, &found.extended) };
            if evidence.refusal().is_some() {
                continue;
            }
            let screened = without.screened(&held)?;
            let promising: Vec<_> =
                without.promising(&held, &screened).into_iter().filter(|it| it.term != term).collect();
            let rivals = without.try_all(&held, &held, &promising).into_iter().filter(|it| {
                let fitted = it.fitted.as_ref();
                let alike = fitted.is_ok_and(|fitted| self.as_good(&held, &found.extended, fitted));
                alike && !is_table(it.term) && it.evidence.refusal().is_none()
            });
            rooted.push(Accepted { term, evidence, rivals: rivals.map(|it| it.term).collect() });
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
            other.then_some(Suspect { term: Term::Cause(cause), handle: Handle::Parameter(index), before })
        });
        let late = found.extended.coordinates.iter().filter_map(|coordinate| {
            let handle = coordinate.handle;
            let timing = matches!(handle, Handle::Output(_, Fault::Delay));
            let late = timing && point.get(handle).abs() > LATE * TIMING;
            late.then_some(Suspect { term: Term::Fault(handle), handle, before: 0.0 })
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
