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

/// The tables, as Markdown: over conditions only if several were tried, over causes out of the catalogue if there are any.
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
    text += &out_of_catalogue(scores);
    text +=
        "## By plant\n\nAll cases, those without an effect included: there, right is to name nothing.\n\n";
    text + &table("plant", scores.iter().map(|score| (score.plant.title(), score)))
}

/// How often each cause was named, missed, placed and described rightly; nothing if there is none.
fn out_of_catalogue(scores: &[Score]) -> String {
    let mut rows: BTreeMap<&str, Vec<&Score>> = BTreeMap::new();
    for score in scores.iter().filter(|score| score.out_of_catalogue) {
        rows.entry(&score.truth).or_default().push(score);
    }
    if rows.is_empty() {
        return String::new();
    }
    let mut text = "## By cause out of the catalogue\n\n\
        | cause | cases | falsely named | reported as no effect | place right | variable right |\n\
        |---|---|---|---|---|---|\n"
        .to_owned();
    for (truth, all) in rows {
        let count = |is: &dyn Fn(&Score) -> bool| all.iter().filter(|score| is(score)).count();
        writeln!(
            text,
            "| {truth} | {} | {} | {} | {} | {} |",
            all.len(),
            count(&|score| score.outcome == Outcome::WrongName),
            count(&|score| score.outcome == Outcome::Missed),
            count(&Score::is_at_place),
            count(&Score::is_over_variable),
        )
        .expect("a string takes everything");
    }
    text + "\n"
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
