//! What has to hold, sentence by sentence: the one list that findings, the page and the tests refer to.
//!
//! A rule that is checked is a constant. Findings are made of it, so that nothing is found that is not listed here; and one that no
//! finding is made of is an unused constant, of which the compiler warns.

pub mod fmi;
mod page;
pub mod practice;
pub mod related;
pub mod ssp;

use serde::Serialize;

pub use page::page;

/// A rule that is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Rule {
    /// Its name in findings, from the general to the special: `structure.outputs.missing`.
    #[serde(rename = "rule")]
    pub name: &'static str,
    /// The standard and its section: `FMI 2.0.5, 2.2.8`. Empty for what no standard demands.
    pub section: &'static str,
    /// What has to hold.
    #[serde(skip)]
    pub sentence: &'static str,
}

/// A rule that is not checked.
#[derive(Clone, Copy, Debug)]
pub struct Unchecked {
    /// The standard and its section.
    pub section: &'static str,
    /// What has to hold.
    pub sentence: &'static str,
    /// Why it is not checked.
    pub why: &'static str,
}

/// The rules of a standard.
#[derive(Debug)]
pub struct Table {
    /// Those that findings are made of.
    pub checked: &'static [Rule],
    /// Those that no look from outside can settle.
    pub uncheckable: &'static [Unchecked],
    /// Those that could be checked, and are not yet.
    pub open: &'static [Unchecked],
}

/// All rules.
pub const TABLES: [&Table; 4] = [&fmi::TABLE, &ssp::TABLE, &related::TABLE, &practice::TABLE];

/// Declares the rules of a standard: `NAME "name" "section" "sentence"`, and `"section" "sentence" "why it is not checked"`.
macro_rules! rules {
    ($standard:literal;
     checked { $($id:ident $name:literal $section:literal $sentence:literal)* }
     uncheckable { $($of:literal $what:literal $why:literal)* }
     open { $($open_of:literal $open_what:literal $open_why:literal)* }) => {
        $(#[doc = $sentence]
        pub const $id: &Rule = &Rule { name: $name, section: concat!($standard, $section), sentence: $sentence };)*
        /// All of them.
        pub static TABLE: Table = Table {
            checked: &[$(Rule { name: $name, section: concat!($standard, $section), sentence: $sentence }),*],
            uncheckable: &[$($crate::rules::Unchecked { section: concat!($standard, $of), sentence: $what, why: $why }),*],
            open: &[$($crate::rules::Unchecked { section: concat!($standard, $open_of), sentence: $open_what, why: $open_why }),*],
        };
    };
}
use rules;

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn each_rule_has_a_name_of_its_own() {
        let mut names = HashSet::new();
        for rule in TABLES.iter().flat_map(|table| table.checked) {
            assert!(names.insert(rule.name), "{}", rule.name);
            assert!(rule.sentence.ends_with('.'), "{}", rule.sentence);
        }
    }
}
