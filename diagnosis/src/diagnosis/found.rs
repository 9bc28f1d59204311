//! What a diagnosis has found.

use crate::confirm::{Accepted, Confirmed, Tried};
use crate::decision::choice::Score;
use crate::decision::description::error_left;
use crate::estimation::hypothesis::{Fitted, Term};
use crate::explain::describe::Unmodelled;
use crate::explain::signal::MissingSignal;

/// What was found.
pub struct Found {
    /// The model with nominal parameters fitted and nothing added.
    pub base: Fitted,
    /// The model after each effect, in the order in which they were confirmed.
    pub stages: Vec<Fitted>,
    /// The model with all effects.
    pub extended: Fitted,
    /// The effects.
    pub accepted: Vec<Accepted>,
    /// Missing signals without a name.
    pub unmodelled: Vec<Unmodelled>,
    /// The missing signal before anything was explained.
    pub missing: Option<MissingSignal>,
    /// What was compared, first of all.
    pub compared: Vec<(Term, Score)>,
    /// All that was fitted, the last word on each term.
    pub tried: Vec<Tried>,
    /// What was confirmed and taken back.
    pub retracted: Vec<Term>,
}

impl Found {
    /// Before anything is found.
    pub(super) fn nothing(base: Fitted) -> Self {
        Self {
            extended: base.clone(),
            base,
            stages: Vec::new(),
            accepted: Vec::new(),
            unmodelled: Vec::new(),
            missing: None,
            compared: Vec::new(),
            tried: Vec::new(),
            retracted: Vec::new(),
        }
    }

    /// Share of the model's error that the descriptions leave which are not in it.
    pub(super) fn left_by_descriptions(&self) -> f64 {
        let in_model = |term: Term| self.extended.terms.contains(&term);
        let outside = self.unmodelled.iter().filter(|it| !it.curve.is_some_and(in_model));
        error_left(outside.map(|it| it.validated))
    }

    /// Takes another fit of the model with all effects.
    pub(super) fn settle_on(&mut self, extended: Fitted) {
        if let Some(last) = self.stages.last_mut() {
            *last = extended.clone();
        }
        self.extended = extended;
    }

    /// Takes a confirmed effect into the model, in the place of a law that is its limit.
    pub(super) fn extend(&mut self, Confirmed { accepted, fitted }: Confirmed) {
        let stays: Vec<bool> = self.accepted.iter().map(|it| fitted.terms.contains(&it.term)).collect();
        let (mut of_accepted, mut of_stages) = (stays.iter(), stays.iter());
        self.accepted.retain(|_| of_accepted.next() == Some(&true));
        self.stages.retain(|_| of_stages.next() == Some(&true));
        self.accepted.push(accepted);
        self.extended = fitted.clone();
        self.stages.push(fitted);
    }
}
