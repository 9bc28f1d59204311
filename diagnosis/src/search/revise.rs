//! Second thoughts about what a search has found: terms taken away, exchanged, or given up for a curve.

use std::collections::BTreeSet;

use crate::catalogue::Element;
use crate::estimation::fit::Handle;
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::lsq::Stop;
use crate::report::findings::Evidence;
use crate::signal::distortion::Fault;

use super::{Accepted, Found, Tried, contains_by_name, has_no_name, matters_beside, merge};

/// Share of a name's errors that a curve in its place leaves at most …
const CLEARLY: f64 = 0.85;
/// … and Student's t of the difference that it exceeds.
const CLEARLY_APART: f64 = 4.0;
/// Share of several names' errors that one curve in their place may leave.
const SEVERAL: f64 = 1.1;

impl World<'_> {
    /// The found terms without one of them, fitted.
    pub(super) fn without(&self, found: &Found, index: usize) -> Result<Fitted, String> {
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

    /// Puts a limit in the place of each accepted law that adds nothing of its own to it. Fits that only compare causes may
    /// have left the limit behind; here it starts where the law has come to.
    pub(super) fn limit(&self, found: &mut Found) -> Result<(), String> {
        let handles = |term: Term| -> BTreeSet<Handle> {
            self.own_coordinates(term).iter().map(|coordinate| coordinate.handle).collect()
        };
        for index in 0..found.accepted.len() {
            let here = found.accepted[index].term;
            let own = handles(here);
            let limits = found.tried.iter().map(|it| it.term).filter(|it| contains_by_name(here, *it));
            let limits = limits.filter(|it| handles(*it).is_subset(&own)).collect::<Vec<_>>();
            for limit in limits {
                let mut start = found.extended.point.clone();
                for more in own.difference(&handles(limit)) {
                    start.set(*more, found.base.point.get(*more));
                }
                let mut terms = found.extended.terms.clone();
                terms.iter_mut().filter(|term| **term == here).for_each(|term| *term = limit);
                let fitted = self.fitted(&terms, &[start], Stop::NOISY)?;
                let added = self.evidence(here, &found.base, &fitted, &found.extended);
                if (Evidence { usual: false, ..added }).refusal().is_none() {
                    continue;
                }
                let without = self.without(found, index)?;
                let evidence = self.evidence(limit, &found.base, &without, &fitted);
                if evidence.refusal().is_none() {
                    (found.accepted[index].term, found.accepted[index].evidence) = (limit, evidence);
                    found.extended = fitted;
                    break;
                }
            }
        }
        Ok(())
    }

    /// Puts rivals in the place of each accepted term: one that does better takes it, one that does as well stays a
    /// rival. What was a rival while another cause was still missing may be none any more.
    pub(super) fn swap(&self, found: &mut Found) -> Result<(), String> {
        for index in 0..found.accepted.len() {
            let mut rivals = std::mem::take(&mut found.accepted[index].rivals);
            rivals.retain(|term| !found.extended.terms.contains(term));
            if rivals.is_empty() {
                continue;
            }
            let without = self.without(found, index)?;
            let screened = self.screened(&without)?;
            let candidates = screened.iter().filter(|it| rivals.contains(&it.term));
            for tried in candidates.map(|it| self.tried(&found.base, &without, it)) {
                let Ok(fitted) = &self.closely(&found.base, tried.fitted, &found.extended) else { continue };
                if (Evidence { usual: false, ..tried.evidence }).refusal().is_some() {
                    continue;
                }
                let here = &mut found.accepted[index];
                let better = !self.as_good(&found.base, fitted, &found.extended);
                // What is common takes no place, however much better it does: it is one of the rivals then.
                if better && tried.evidence.refusal().is_none() {
                    here.rivals.clear();
                    (here.term, here.evidence) = (tried.term, tried.evidence);
                    found.extended = fitted.clone();
                } else if better || self.as_good(&found.base, &found.extended, fitted) {
                    here.rivals.push(tried.term);
                }
            }
        }
        Ok(())
    }

    /// Takes each accepted term away again, and drops it if nothing is lost. Beside a curve in the same element, more is asked of
    /// a name: what the curve's points lie too far apart for looks like one law or another.
    pub(super) fn retest(&self, found: &mut Found) -> Result<(), String> {
        let mut index = 0;
        while index < found.accepted.len() && found.extended.terms.len() > 1 {
            let without = self.without(found, index)?;
            let here = &found.accepted[index];
            let evidence = self.evidence(here.term, &found.base, &without, &found.extended);
            let evidence = Evidence { usual: here.evidence.usual, ..evidence };
            let curved = |it: &Accepted| has_no_name(it.term) && element(it.term) == element(here.term);
            let usual = evidence.usual || found.accepted.iter().any(curved);
            let others = found.accepted.iter().enumerate().filter(|(other, _)| *other != index);
            let others = others.map(|(_, it)| it).chain(&found.common);
            let largest = others.map(|it| it.evidence.phi_gain).fold(0.0, f64::max);
            if (Evidence { usual, ..evidence }).refusal().is_some()
                || !matters_beside(here.term, &evidence, largest)
            {
                found.accepted.remove(index);
                found.extended = without;
            } else {
                found.accepted[index].evidence = evidence;
                index += 1;
            }
        }
        Ok(())
    }

    /// Puts a table alone in the place of everything that was found, if it explains clearly more than one cause with a
    /// name, or as much as several of them: names that only together do what one curve does are not the cause. A constant
    /// does not count beside others: it has no shape, and every curve holds one.
    pub(super) fn unname(&self, found: &mut Found) {
        let shapes: Vec<Term> = {
            let named: Vec<Term> =
                found.accepted.iter().map(|it| it.term).filter(|it| !has_no_name(*it)).collect();
            let shaped: Vec<Term> = named.iter().copied().filter(|it| !is_constant(*it)).collect();
            if shaped.is_empty() { named } else { shaped }
        };
        let Some(first) = shapes.first().copied() else { return };
        let several = shapes.len() > 1;
        let screened = found.screened.iter().find(|it| it.term == first);
        let curves = self.curves(&found.base, &found.screened, screened.map_or(0.0, |it| it.gain));
        let tried = self.try_all(&found.base, &found.base, &curves);
        merge(&mut found.tried, tried.clone());
        let passing = tried.iter().filter(|it| it.evidence.refusal().is_none());
        let best = passing.filter_map(|it| Some((it, it.fitted.as_ref().ok()?))).next();
        let Some((table, fitted)) = best else { return };
        let left = |it: &Fitted| self.left(&found.base, it);
        let enough = if several {
            left(fitted) < SEVERAL * left(&found.extended)
        } else {
            self.is_clearly_better(&found.base, (table.term, fitted), &found.extended)
        };
        if enough && self.is_the_cause(found, (table.term, fitted), (first, several)) {
            let accepted = Accepted { term: table.term, evidence: table.evidence, rivals: Vec::new() };
            found.extended = fitted.clone();
            found.accepted = vec![accepted];
        }
    }

    /// Whether a curve explains clearly more than a name does: a sensor's response, of its own signal.
    pub(super) fn is_clearly_better(
        &self,
        base: &Fitted,
        (curve, fitted): (Term, &Fitted),
        named: &Fitted,
    ) -> bool {
        let left = match curve {
            Term::Response(output) => self.left_of(output, named, fitted) / 2.0,
            _ => self.left(base, fitted) / self.left(base, named),
        };
        left < CLEARLY && self.apart(fitted, named) > CLEARLY_APART
    }

    /// Whether a sensor's response without a name does little that one of its faults with a name does not: what a signal counts
    /// from may be far away, and a response that passes more of it is an offset.
    pub(super) fn is_done_by_a_fault(&self, base: &Fitted, response: &Tried, tried: &[Tried]) -> bool {
        let (Term::Response(output), Ok(fitted)) = (response.term, &response.fitted) else { return false };
        let of_sensor = |it: &&Tried| matches!(it.term, Term::Fault(Handle::Output(of, _)) if of == output);
        let mut faults = tried.iter().filter(of_sensor).filter_map(|it| it.fitted.as_ref().ok());
        faults.any(|fault| !self.is_clearly_better(base, (response.term, fitted), fault))
    }

    /// Whether a table is the cause itself. If what was found first is needed beside it, they are about different things; and
    /// where it adds nothing of its own to the one name that was found, what it explains more is of the small effects that
    /// every rig has.
    fn is_the_cause(
        &self,
        found: &Found,
        (table, fitted): (Term, &Fitted),
        (first, several): (Term, bool),
    ) -> bool {
        let mut terms = fitted.terms.clone();
        terms.push(first);
        let mut start = fitted.point.clone();
        for coordinate in self.own_coordinates(first) {
            start.set(coordinate.handle, found.extended.point.get(coordinate.handle));
        }
        let Ok(both) = self.fitted(&terms, &[start], Stop::ROUGH) else { return true };
        let counts = |term: Term, without: &Fitted| {
            self.evidence(term, &found.base, without, &both).refusal().is_none()
        };
        !counts(first, fitted) && (several || counts(table, &found.extended))
    }
}

/// Whether a term is a constant force, or a constant in a signal.
fn is_constant(term: Term) -> bool {
    match term {
        Term::Cause(cause) => cause.id == "33",
        Term::Fault(Handle::Input(_, fault) | Handle::Output(_, fault)) => fault == Fault::Offset,
        Term::Fault(Handle::Parameter(_)) | Term::Table(_) | Term::Response(_) => false,
    }
}

/// Where a term acts; none if it is a sensor.
fn element(term: Term) -> Option<Element> {
    match term {
        Term::Cause(cause) => Some(cause.element),
        Term::Table(table) => Some(table.element),
        Term::Fault(_) | Term::Response(_) => None,
    }
}
