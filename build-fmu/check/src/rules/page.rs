//! The page of all rules, which the documentation has.

use std::collections::BTreeSet;
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
    let titles = ["Functional Mock-up Interface", "System Structure and Parameterization", "Practice"];
    for (table, title) in TABLES.iter().zip(titles) {
        let _ = write!(text, "\n## {title}\n\n{}", body(table));
    }
    text
}

fn body(table: &Table) -> String {
    let mut text = String::from("| section | rule | state |\n|---|---|---|\n");
    let all = table.uncheckable.iter().chain(table.open).map(|it| it.section);
    let sections: BTreeSet<Vec<u32>> =
        table.checked.iter().map(|rule| rule.section).chain(all).map(numbers).collect();
    for section in sections {
        for Rule { name, section: of, sentence } in table.checked {
            if numbers(of) == section {
                let _ = writeln!(text, "| {} | {} | `{name}` |", short(of), cell(sentence));
            }
        }
        for (state, list) in [("not checkable", table.uncheckable), ("open", table.open)] {
            for Unchecked { section: of, sentence, why } in list {
                if numbers(of) == section {
                    let _ = writeln!(text, "| {} | {} | {state}: {} |", short(of), cell(sentence), cell(why));
                }
            }
        }
    }
    text
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
