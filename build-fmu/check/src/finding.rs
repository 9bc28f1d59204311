//! What is found, and how much of it.

use std::collections::HashSet;
use std::fmt::{self, Display, Formatter};
use std::rc::Rc;

use serde::Serialize;

use crate::behaviour::Response;
use crate::rules::Rule;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Against the standard, or it does not work.
    Error,
    /// Works here, but tools are known to stumble over it.
    Warning,
    /// Legal, but narrows where the FMU can be used or what can be known of it.
    Note,
}

impl Display for Level {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        })
    }
}

/// One thing that is found.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Finding {
    /// How bad it is.
    pub level: Level,
    /// The rule that is broken.
    #[serde(flatten)]
    pub rule: &'static Rule,
    /// What is wrong: a sentence without a full stop.
    pub message: String,
    /// File in the archive, and the line if it is a text.
    pub place: Option<String>,
    /// What to do.
    pub help: Vec<String>,
}

impl Finding {
    /// An error.
    pub fn error(rule: &'static Rule, message: impl Into<String>) -> Self {
        Self { level: Level::Error, rule, message: message.into(), place: None, help: Vec::new() }
    }

    /// A warning.
    pub fn warning(rule: &'static Rule, message: impl Into<String>) -> Self {
        Self { level: Level::Warning, ..Self::error(rule, message) }
    }

    /// A note.
    pub fn note(rule: &'static Rule, message: impl Into<String>) -> Self {
        Self { level: Level::Note, ..Self::error(rule, message) }
    }

    /// With the line of the model description.
    #[must_use]
    pub fn line(self, line: u32) -> Self {
        self.at(format!("modelDescription.xml:{line}"))
    }

    /// With the file in the archive.
    #[must_use]
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = Some(place.into());
        self
    }

    /// With what to do.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

/// Hears of each finding at once.
#[derive(Clone)]
pub struct Listener(Rc<dyn Fn(&Finding)>);

impl Listener {
    /// Whatever is to be done with a finding; one may be told more than once.
    pub fn new(hear: impl Fn(&Finding) + 'static) -> Self {
        Self(Rc::new(hear))
    }
}

impl fmt::Debug for Listener {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Listener")
    }
}

/// All that is known of an FMU after the check.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// What it is: version, interfaces, variables, platforms.
    pub about: Vec<String>,
    /// What was found.
    pub findings: Vec<Finding>,
    /// What was done and found to be in order, or how often.
    pub done: Vec<String>,
    /// What was not done, and why.
    pub skipped: Vec<String>,
    /// Which way outputs go when an input is raised.
    pub signs: Vec<Response>,
    /// Who hears of findings at once.
    #[serde(skip)]
    pub(crate) listener: Option<Listener>,
    /// How many findings it has been told of.
    #[serde(skip)]
    pub(crate) told: usize,
}

impl Report {
    /// An empty one.
    pub(crate) fn new(listener: Option<&Listener>) -> Self {
        Self { listener: listener.cloned(), ..Self::default() }
    }

    /// Tells the listener what is new: a check that is cut off has said what it has found.
    pub(crate) fn tell(&mut self) {
        if let Some(Listener(hear)) = &self.listener {
            self.findings[self.told..].iter().for_each(|finding| hear(finding));
            self.told = self.findings.len();
        }
    }

    /// The number of findings of a level.
    pub fn count(&self, level: Level) -> usize {
        self.findings.iter().filter(|finding| finding.level == level).count()
    }
}

/// The first names of many, as a list: `a`, `b`, `c` and 12 more.
pub fn names<S: AsRef<str>>(all: &[S]) -> String {
    const SHOWN: usize = 5;
    // One more than is shown may be named instead of counted.
    let shown = if all.len() > SHOWN + 1 { SHOWN } else { all.len() };
    let quoted: Vec<String> = all[..shown].iter().map(|name| format!("`{}`", name.as_ref())).collect();
    match (quoted.split_last(), all.len() - shown) {
        (None, _) => String::new(),
        (Some((last, [])), 0) => last.clone(),
        (Some((last, rest)), 0) => format!("{} and {last}", rest.join(", ")),
        (_, more) => format!("{} and {more} more", quoted.join(", ")),
    }
}

/// Whether each name has come before.
pub fn repeated<'a>(names: impl Iterator<Item = &'a str>) -> impl Iterator<Item = bool> {
    let mut seen = HashSet::new();
    names.map(move |name| !seen.insert(name))
}

/// `1 output`, `2 outputs`.
pub fn count(number: usize, of: &str) -> String {
    if number == 1 { format!("1 {of}") } else { format!("{number} {of}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_listed_or_counted() {
        assert_eq!(names(&["a"]), "`a`");
        assert_eq!(names(&["a", "b", "c"]), "`a`, `b` and `c`");
        assert_eq!(names(&["a", "b", "c", "d", "e", "f"]), "`a`, `b`, `c`, `d`, `e` and `f`");
        assert_eq!(names(&["a", "b", "c", "d", "e", "f", "g"]), "`a`, `b`, `c`, `d`, `e` and 2 more");
    }
}
