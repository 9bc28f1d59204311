//! What came out by the condition that the data were made under, and by the rig.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::{Outcome, Score};
use crate::case::Plant;

/// One row: how many cases there are, and how they came out.
#[derive(Default)]
struct Row {
    cases: usize,
    right: usize,
    false_names: usize,
}

impl Row {
    fn count(&mut self, score: &Score) {
        self.cases += 1;
        self.right += usize::from(matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo));
        let named = matches!(score.outcome, Outcome::WrongName | Outcome::TooMany | Outcome::FalseAlarm);
        self.false_names += usize::from(named);
    }
}

/// Both tables, as Markdown; the one over conditions only if several were tried.
pub fn breakdown(scores: &[Score]) -> String {
    let mut text = String::new();
    let single = || {
        let wanted = |score: &&Score| {
            score.plant == Plant::LinearQuarter && score.effects == 1 && !score.out_of_catalogue
        };
        scores.iter().filter(wanted)
    };
    let varied: BTreeSet<&str> =
        single().filter(|score| score.condition != "standard").map(|score| score.truth.as_str()).collect();
    let tried = single().filter(|score| varied.contains(score.truth.as_str()));
    if !varied.is_empty() {
        text += "## By condition\n\nSingle effects of the linear quarter car that were tried under more than one condition.\n\n";
        text += &table("condition", tried.map(|score| (score.condition.as_str(), score)));
        text.push('\n');
    }
    text +=
        "## By plant\n\nAll cases, those without an effect included: there, right is to name nothing.\n\n";
    text + &table("plant", scores.iter().map(|score| (score.plant.title(), score)))
}

fn table<'a>(over: &str, scores: impl Iterator<Item = (&'a str, &'a Score)>) -> String {
    let mut rows: BTreeMap<&str, Row> = BTreeMap::new();
    for (name, score) in scores {
        rows.entry(name).or_default().count(score);
    }
    let mut text = format!("| {over} | cases | correct, or one of two | false names |\n|---|---|---|---|\n");
    for (name, row) in rows {
        let percent = 100.0 * row.right as f64 / row.cases as f64;
        writeln!(text, "| {name} | {} | {} ({percent:.0} %) | {} |", row.cases, row.right, row.false_names)
            .expect("a string takes everything");
    }
    text
}
