//! The time limit of a diagnosis.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Parts of the time limit, and how many of them the search may take: the others are for intervals and the report.
const PARTS: u32 = 20;
const SEARCH: u32 = 17;

/// What a diagnosis does, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// It fits the nominal parameters and tries the signals' signs.
    Nominal,
    /// It looks for effects.
    Search,
    /// It compares over shorter segments.
    Segments,
}

impl Stage {
    /// What is not known if it was not finished.
    pub fn unfinished(self) -> &'static str {
        match self {
            Self::Nominal => {
                "The nominal parameters may not be at their best. Signs of signals and effects were not looked at."
            }
            Self::Search => "The search for effects is not complete. There may be others.",
            Self::Segments => {
                "Shorter segments, over which a model that drifts shows more, were not compared."
            }
        }
    }
}

/// Until when a diagnosis may look further; clones share what happened.
#[derive(Clone, Debug, Default)]
pub struct Deadline {
    limit: Option<Duration>,
    at: Option<Instant>,
    /// Whether somebody has stopped it before.
    ended: Arc<AtomicBool>,
    stopped: Arc<OnceLock<Stage>>,
}

impl Deadline {
    /// A limit that starts now. Without one (the default) there is no end.
    pub fn after(limit: Duration) -> Self {
        Self { limit: Some(limit), at: Instant::now().checked_add(limit / PARTS * SEARCH), ..Self::default() }
    }

    /// The same limit, and an end as soon as somebody sets `ended`.
    #[must_use]
    pub fn or_when(self, ended: Arc<AtomicBool>) -> Self {
        Self { ended, ..self }
    }

    /// The same end for another diagnosis, of which nothing is known yet.
    #[must_use]
    pub fn again(&self) -> Self {
        Self { stopped: Arc::default(), ..self.clone() }
    }

    /// When it ends; none if it does not.
    pub fn instant(&self) -> Option<Instant> {
        self.at
    }

    /// Whether the time is up, for what several stages have in common.
    pub fn is_past(&self) -> bool {
        self.ended.load(Ordering::Relaxed) || self.at.is_some_and(|at| Instant::now() >= at)
    }

    /// Whether the time is up. The first stage that asks too late is remembered as the one that was not finished.
    pub fn is_over(&self, stage: Stage) -> bool {
        let over = self.is_past();
        if over {
            self.stopped.get_or_init(|| stage);
        }
        over
    }

    /// The stage that was not finished, and the limit; none if all was done.
    pub fn stopped(&self) -> Option<(Stage, Duration)> {
        Some((*self.stopped.get()?, self.limit?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_limit_there_is_no_end() {
        let none = Deadline::default();
        assert!(!none.is_over(Stage::Nominal) && none.stopped().is_none() && none.instant().is_none());
        let long = Deadline::after(Duration::MAX);
        assert!(!long.is_over(Stage::Search) && long.stopped().is_none());
        let left = Deadline::after(Duration::from_secs(1000)).instant().unwrap() - Instant::now();
        assert!(left > Duration::from_secs(800) && left <= Duration::from_secs(850), "{left:?}");
    }

    #[test]
    fn somebody_may_end_it() {
        let ended = Arc::new(AtomicBool::new(false));
        let limit = Deadline::after(Duration::from_secs(1000)).or_when(ended.clone());
        assert!(!limit.is_over(Stage::Nominal));
        ended.store(true, Ordering::Relaxed);
        assert!(limit.again().is_over(Stage::Search) && limit.is_over(Stage::Nominal));
    }

    #[test]
    fn the_first_stage_that_comes_too_late_is_told() {
        let none = Deadline::after(Duration::ZERO);
        let same = none.clone();
        assert!(none.is_past());
        assert_eq!(none.stopped(), None);
        assert!(same.is_over(Stage::Search) && none.is_over(Stage::Segments));
        assert_eq!(none.stopped(), Some((Stage::Search, Duration::ZERO)));
        assert_eq!(none.again().stopped(), None);
        assert!(none.again().is_over(Stage::Nominal));
    }
}
