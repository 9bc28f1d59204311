//! The page of all rules, which the documentation has.

use std::fmt::Write;

use super::{Rule, TABLES, Table, Unchecked};

const HEAD: &str = "\
# Rules of `build-fmu check`

What the check knows of the standards, section by section. `build-fmu check --rules` prints this page from the declarations that
findings are made of. Do not edit it.

- **Checked**: the name is the `rule` of a finding. A faulty FMU or system for each one stands in the tests.
- **Not checkable**: nothing outside of the FMU can tell whether it holds.
- **Open**: it could be checked, and is not yet.

";

/// The page.
pub fn page() -> String {
    let mut text = HEAD.to_owned();
    let sum = |count: &dyn Fn(&Table) -> usize| TABLES.iter().map(|table| count(table)).sum::<usize>();
    let _ = writeln!(
        text,
        "{} rules are checked, {} are not checkable, {} are open.",
        sum(&|table| table.checked.len()),
        sum(&|table| table.uncheckable.len()),
        sum(&|table| table.open.len()),
    );
    let titles = [
        "Functional Mock-up Interface",
        "System Structure and Parameterization",
        "Related files (draft)",
        "Practice",
    ];
    for (table, title) in TABLES.iter().zip(titles) {
        let _ = write!(text, "\n## {title}\n\n{}", body(table));
    }
    text
}

/// A table of rules, in the order of their sections where they have any.
fn body(table: &Table) -> String {
    // Each row with what it is sorted by.
    let mut rows: Vec<(Vec<u32>, String)> = Vec::new();
    let mut add = |section: &str, sentence: &str, state: &str| {
        let place = if section.is_empty() { String::new() } else { format!(" {} |", short(section)) };
        rows.push((numbers(section), format!("|{place} {} | {state} |\n", cell(sentence))));
    };
    for Rule { name, section, sentence } in table.checked {
        add(section, sentence, &format!("`{name}`"));
    }
    for (state, list) in [("not checkable", table.uncheckable), ("open", table.open)] {
        for Unchecked { section, sentence, why } in list {
            add(section, sentence, &format!("{state}: {}", cell(why)));
        }
    }
    // What stands at one section stays in its order.
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    let sections = table.checked.iter().any(|rule| !rule.section.is_empty());
    let head = if sections {
        "| section | rule | state |\n|---|---|---|\n"
    } else {
        "| rule | state |\n|---|---|\n"
    };
    rows.into_iter().fold(head.to_owned(), |text, (_, row)| text + &row)
}

/// The numbers of a section, to sort by.
fn numbers(section: &str) -> Vec<u32> {
    short(section).split('.').filter_map(|part| part.parse().ok()).collect()
}

/// The section without its standard.
fn short(section: &str) -> &str {
    section.rsplit(' ').next().unwrap_or_default()
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "\\<")
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_page_in_docs_is_that_of_the_rules() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/check-rules.md");
        let stored = std::fs::read_to_string(file).unwrap_or_default();
        assert!(
            stored == super::page(),
            "docs/check-rules.md is not what the rules say; run `cargo run -- check --rules > docs/check-rules.md`"
        );
    }
}
