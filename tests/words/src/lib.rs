//! The words of Strut: phrases and old names that no file has, and what to write instead.
//!
//! Words that stand for one thing in one place and for another elsewhere are not in the list: it holds only phrases that are
//! wrong wherever they stand.

mod list;

pub use list::{Entry, LIST};

/// Where a phrase is not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// In pages, help texts, comments and identifiers.
    Everywhere,
    /// In pages, help texts and the words of reports.
    Guides,
    /// In source files, with the same capital letters.
    Code,
    /// In the text that a diagnosis shows. [`Everywhere`](Self::Everywhere) and [`Guides`](Self::Guides) hold there, too.
    Report,
}

/// A phrase in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// The line, from 1.
    pub line: usize,
    /// The phrase as it stands in the list.
    pub phrase: &'static str,
    /// What to write instead.
    pub instead: &'static str,
}

/// The phrases of the list that a text has, for the scopes that it belongs to. Line breaks and the marks of comments
/// are spaces.
pub fn found(text: &str, scopes: &[Scope]) -> Vec<Found> {
    let (plain, lines) = flowing(text);
    let lower = plain.to_lowercase();
    // Few letters change their length; then the lines would be wrong.
    let lower = if lower.len() == plain.len() { lower } else { plain.to_ascii_lowercase() };
    let mut all = Vec::new();
    for entry in LIST.iter().filter(|entry| scopes.contains(&entry.scope)) {
        for phrase in entry.phrase.split('|') {
            let exact = entry.scope == Scope::Code;
            let (sought, among) =
                if exact { (phrase.to_owned(), &plain) } else { (phrase.to_lowercase(), &lower) };
            for (position, _) in among.match_indices(&sought) {
                if alone(among, position, sought.len()) {
                    let line = lines.partition_point(|start| *start <= position);
                    all.push(Found { line, phrase, instead: entry.instead });
                }
            }
        }
    }
    all.sort_by_key(|it| it.line);
    all
}

/// The text as one line, and where its lines begin in it.
fn flowing(text: &str) -> (String, Vec<usize>) {
    let (mut plain, mut starts) = (String::new(), Vec::new());
    for line in text.lines() {
        starts.push(plain.len());
        let line = line.trim();
        let comment = ["//!", "///", "//", "# ", "> "].iter().find_map(|mark| line.strip_prefix(mark));
        plain.push_str(comment.unwrap_or(line).trim());
        plain.push(' ');
    }
    (plain, starts)
}

/// Whether no word goes on at either end of a phrase.
fn alone(text: &str, position: usize, length: usize) -> bool {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let (before, rest) = text.split_at(position);
    let (phrase, after) = rest.split_at(length);
    let open = |inner: Option<char>, outer: Option<char>| inner.is_some_and(word) && outer.is_some_and(word);
    !open(phrase.chars().next(), before.chars().next_back())
        && !open(phrase.chars().next_back(), after.chars().next())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn phrases(text: &str, scopes: &[Scope]) -> Vec<(usize, &'static str)> {
        found(text, scopes).into_iter().map(|it| (it.line, it.phrase)).collect()
    }

    #[test]
    fn a_phrase_is_found_across_lines_and_comments() {
        let text = "fn a() {}\n/// The road is scaled such\n/// that the tyre stays. Besides, it rolls.\n";
        assert_eq!(phrases(text, &[Scope::Everywhere]), [(2, "such that"), (3, "besides")]);
    }

    #[test]
    fn a_part_of_a_word_is_no_phrase() {
        assert!(phrases("The display plays: causeway, unlearntness.", &[Scope::Everywhere]).is_empty());
        assert!(phrases("because of it", &[Scope::Report]).is_empty());
    }

    #[test]
    fn old_names_keep_their_capital_letters() {
        assert_eq!(phrases("fn f(now: Now<'_, Self, R>)", &[Scope::Code]), [(1, "Now<")]);
        assert!(phrases("if time_now<3 {}", &[Scope::Code]).is_empty());
    }

    #[test]
    fn each_phrase_stands_once() {
        let mut all: Vec<(&str, bool)> = LIST
            .iter()
            .flat_map(|it| it.phrase.split('|').map(|phrase| (phrase, it.scope == Scope::Report)))
            .collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(LIST.iter().all(|it| !it.instead.is_empty()));
    }
}
