//! The words of the page and of the terminal: numbers, places, the verdict, what is still unexplained.

mod experiment;
mod numbers;
mod open;
mod places;
pub mod records;
mod small;
mod verdict;

use unicode_width::UnicodeWidthStr;

pub use experiment::{chance, experiment, pair, source};
pub use numbers::{digits, fit, interval, labelled, number, percent, quantity, trimmed, unit, value};
pub use open::{open_signal, open_signals, reservation, small_rest};
pub use places::{Part, effect_name, effect_rank, element, limit, located, of_ratio, part, place, sized};
pub use small::none_beyond;
pub use verdict::{LISTED, badge, headline};

/// The words for a threshold that the records do not reach.
pub const UNREACHED: &str = "not reached in the estimation records";

/// `a, b and c`.
pub fn list(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., end] => format!("{} {last} {end}", rest.join(", ")),
    }
}

/// Lines of three cells behind an indent, the first two in columns.
pub fn columns(indent: &str, rows: impl Iterator<Item = [String; 3]>) -> String {
    let rows: Vec<[String; 3]> = rows.collect();
    let width = |cell: usize| rows.iter().map(|row| row[cell].width()).max().unwrap_or(0);
    let (first, second) = (width(0), width(1));
    let pad = |cell: &str, to: usize| " ".repeat(to - cell.width());
    let line = |[name, middle, text]: &[String; 3]| {
        let line = format!("{indent}{name}{}  {middle}{}  {text}", pad(name, first), pad(middle, second));
        format!("{}\n", line.trim_end())
    };
    rows.iter().map(line).collect()
}

/// The text with a capital at its start.
pub fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or(String::new(), |first| first.to_uppercase().chain(rest).collect())
}

/// `3 records`, `1 record`.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_as_sentences() {
        let items = ["a".to_owned(), "b".to_owned(), "c".to_owned()];
        assert_eq!(list(&items, "or"), "a, b or c");
        assert_eq!((list(&items[..1], "or"), list(&[], "or")), ("a".into(), String::new()));
    }
}
