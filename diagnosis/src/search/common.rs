//! Causes behind what every rig has a little of. Where nothing can be named, or several names would do, the small and common
//! effects that show are fitted along: they may hide a cause, or blur what tells it from others.

use std::slice::from_ref;

use crate::estimation::hypothesis::World;
use crate::estimation::lsq::Stop;

use super::weighing::is_in_time;
use super::{ALONG, Accepted, Found, Tried, has_no_name};

/// Share of what is left that one of them takes away at least: what takes less hides nothing.
const HIDES: f64 = 0.05;

impl World<'_> {
    /// Looks again beside what is common, for causes and for those that hide in the base parameters. What was found stays as it
    /// was where that neither shows more causes nor leaves fewer names for them.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges.
    pub fn beside_the_common(
        &self,
        found: &mut Found,
        rooted: &mut Vec<Accepted>,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<(), String> {
        let mut beside = found.clone();
        while beside.common.len() < ALONG && !is_settled(found, rooted) {
            let Some(Tried { term, fitted: Ok(fitted), evidence, .. }) = common(&beside).cloned() else {
                break;
            };
            beside.extended = self.fitted(&fitted.terms, from_ref(&fitted.point), Stop::NOISY)?;
            beside.common.push(Accepted { term, evidence, rivals: Vec::new() });
            self.forward(&mut beside, progress)?;
            self.revised(&mut beside, progress)?;
            let hidden = self.rooted(&mut beside)?;
            let (now, before) = (tally(&beside, &hidden), tally(found, rooted));
            if now.causes > before.causes || now.causes == before.causes && now.rivals < before.rivals {
                (*found, *rooted) = (beside.clone(), hidden);
            }
        }
        Ok(())
    }
}

/// How much was found: causes, and other names that would do for them.
struct Tally {
    causes: usize,
    rivals: usize,
}

fn tally(found: &Found, rooted: &[Accepted]) -> Tally {
    let all = || found.accepted.iter().chain(rooted);
    Tally { causes: all().count(), rivals: all().map(|it| it.rivals.len()).sum() }
}

/// Whether there are causes, and no doubt about their names.
fn is_settled(found: &Found, rooted: &[Accepted]) -> bool {
    let Tally { causes, rivals } = tally(found, rooted);
    causes > 0 && rivals == 0
}

/// The best of what is common, is there beyond doubt on top of what was found, and is too small to be named.
fn common(found: &Found) -> Option<&Tried> {
    let there = |it: &&Tried| {
        let Ok(fitted) = &it.fitted else { return false };
        let on_top = fitted.terms.split_last().is_some_and(|(_, below)| below == found.extended.terms);
        let small = is_in_time(it.term, fitted) != Some(false);
        let hides = it.evidence.doubt().is_none() && it.evidence.taken > HIDES;
        it.evidence.usual && small && !has_no_name(it.term) && hides && on_top
    };
    found.tried.iter().filter(there).max_by(|a, b| a.score.total_cmp(&b.score))
}
