//! What the time limit left undone.

use crate::catalogue::naming::name;
use crate::diagnosis::Diagnosis;
use crate::estimation::deadline::Stage;
use crate::estimation::hypothesis::Term;
use crate::report::words::located;

impl Diagnosis<'_> {
    /// Whether the search was ended before it was complete.
    pub(super) fn is_unfinished(&self) -> bool {
        self.baseline.deadline.stopped().is_some_and(|(stage, _)| stage < Stage::Segments)
    }

    /// What was left undone, with the likeliest candidate so far; none if all was done.
    pub(super) fn unfinished(&self) -> Option<String> {
        let (stage, limit) = self.baseline.deadline.stopped()?;
        let likeliest = self.likeliest().filter(|_| self.found.accepted.is_empty() && self.is_unfinished());
        let likeliest = likeliest.map(|term| {
            let words = name(term, &self.baseline.rig.plant);
            let located = located(&words.name, &words.element);
            format!(" The likeliest candidate so far is {located}. It is not confirmed.")
        });
        let likeliest = likeliest.unwrap_or_default();
        Some(format!(
            "The time limit of {} s was reached. {}{likeliest}",
            limit.as_secs(),
            stage.unfinished()
        ))
    }

    /// The best candidate whose fit passes, or the one that explains most of the missing signal.
    fn likeliest(&self) -> Option<Term> {
        let passes =
            self.found.tried.iter().filter(|it| it.fitted.is_ok() && it.evidence.refusal().is_none());
        let best = passes.max_by(|a, b| a.score.total_cmp(&b.score)).map(|it| it.term);
        best.or_else(|| self.found.compared.first().map(|(term, _)| *term))
    }
}
