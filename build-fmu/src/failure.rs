//! What goes wrong, and what to do about it.

use std::fmt::{self, Display, Formatter};

use crate::style;

/// A failure with hints; printed as `error: ...` and `help: ...`, with `{:#}` in a terminal's colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    message: String,
    help: Vec<String>,
    /// What else goes wrong.
    others: Vec<Failure>,
}

/// A result that fails with hints.
pub type Result<T> = std::result::Result<T, Failure>;

impl Failure {
    /// A failure in one sentence, without a full stop.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), help: Vec::new(), others: Vec::new() }
    }

    /// Several as one; none if there are none.
    pub fn together(failures: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut failures = failures.into_iter();
        let mut first = failures.next()?;
        first.others.extend(failures);
        Some(first)
    }

    /// Adds what the user can do.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// Adds help where there is some.
    #[must_use]
    pub fn help_if(self, help: Option<String>) -> Self {
        help.into_iter().fold(self, Self::help)
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (error, help) = if f.alternate() { (style::ERROR, style::HELP) } else { Default::default() };
        write!(f, "{error}error:{error:#} {}", self.message)?;
        self.help.iter().try_for_each(|line| write!(f, "\n{help}help:{help:#} {line}"))?;
        let several =
            |other: &Self| if f.alternate() { write!(f, "\n{other:#}") } else { write!(f, "\n{other}") };
        self.others.iter().try_for_each(several)
    }
}

/// `help: did you mean ...?` for a name that does not exist, or the list of those that do if it is short.
pub fn similar<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let names: Vec<&str> = names.into_iter().collect();
    let likeness = |other: &str| {
        let (name, other) = (name.to_lowercase(), other.to_lowercase());
        let contained = name.len() > 2 && (other.contains(&name) || name.contains(&other));
        strsim::jaro_winkler(&name, &other).max(if contained { 0.9 } else { 0.0 })
    };
    let mut close: Vec<(f64, &str)> =
        names.iter().map(|other| (likeness(other), *other)).filter(|(score, _)| *score > 0.8).collect();
    close.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    let quoted = |names: Vec<&str>| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>();
    if !close.is_empty() {
        let list = quoted(close.into_iter().take(3).map(|(_, name)| name).collect());
        return Some(format!("did you mean {}?", list.join(" or ")));
    }
    (!names.is_empty() && names.len() <= 12).then(|| format!("there are {}", quoted(names).join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_names_come_first() {
        let names = ["QuarterCar", "QuanserQuarterCar", "Road"];
        assert_eq!(
            similar("QuaterCar", names).as_deref(),
            Some("did you mean `QuarterCar` or `QuanserQuarterCar`?")
        );
        assert_eq!(
            similar("xyz", names).as_deref(),
            Some("there are `QuarterCar`, `QuanserQuarterCar`, `Road`")
        );
        assert_eq!(similar("xyz", []), None);
    }

    #[test]
    fn several_failures_follow_each_other() {
        let all = ["one", "two"].map(|text| Failure::new(text).help("mend it"));
        let told = Failure::together(all).unwrap().to_string();
        assert_eq!(told, "error: one\nhelp: mend it\nerror: two\nhelp: mend it");
        assert_eq!(Failure::together([]), None);
    }

    #[test]
    fn help_follows_the_error() {
        let failure = Failure::new("there is no FMU `a`").help("run `build-fmu list`");
        assert_eq!(failure.to_string(), "error: there is no FMU `a`\nhelp: run `build-fmu list`");
    }
}
