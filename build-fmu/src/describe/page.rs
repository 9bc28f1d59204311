//! A page for a terminal: headings, paragraphs and tables in its width.

use std::fmt::Write;

use textwrap::{Options, WordSplitter};
use unicode_width::UnicodeWidthStr;

use crate::style::{ASIDE, HEADING, NAME};

/// A page that grows.
pub struct Page {
    text: String,
    width: usize,
}

/// What a table's last column is never narrower than.
const NARROWEST: usize = 24;

impl Page {
    /// An empty page, as wide as the terminal; 100 columns where there is none.
    pub fn new() -> Self {
        use std::io::IsTerminal;
        let width = if std::io::stdout().is_terminal() { textwrap::termwidth() } else { 100 };
        Self { text: String::new(), width: width.clamp(60, 140) }
    }

    /// The first lines: a name, what kind of thing it is, and a sentence.
    pub fn title(&mut self, name: &str, kind: &str, title: &str) {
        let _ = writeln!(self.text, "{NAME}{name}{NAME:#}  {ASIDE}{kind}{ASIDE:#}");
        self.paragraph("", title);
    }

    /// A heading, after an empty line.
    pub fn heading(&mut self, heading: &str) {
        let _ = writeln!(self.text, "\n{HEADING}{heading}{HEADING:#}");
    }

    /// A paragraph; further lines are indented as the first one's mark is wide.
    pub fn paragraph(&mut self, mark: &str, text: &str) {
        let indent = " ".repeat(mark.width());
        let options = whole_words(self.width).initial_indent(mark).subsequent_indent(&indent);
        self.text.push_str(&textwrap::fill(text, options));
        self.text.push('\n');
    }

    /// A line beside the matter, in a dimmed colour.
    pub fn aside(&mut self, mark: &str, text: &str) {
        let indent = " ".repeat(mark.width());
        let options = whole_words(self.width).initial_indent(mark).subsequent_indent(&indent);
        for line in textwrap::wrap(text, options) {
            let _ = writeln!(self.text, "{ASIDE}{line}{ASIDE:#}");
        }
    }

    /// A table with a head. Columns that are empty are left out; the second is aligned to the right if
    /// it holds numbers, the last is wrapped.
    pub fn table(&mut self, head: &[&str], numbers: Option<usize>, rows: &[Vec<String>]) {
        let last = head.len() - 1;
        let widths: Vec<usize> = (0..last)
            .map(|column| {
                let widest = rows.iter().map(|row| row[column].width()).max().unwrap_or(0);
                if widest == 0 { 0 } else { widest.max(head[column].width()) }
            })
            .collect();
        let margin = 2 + widths.iter().filter(|width| **width > 0).map(|width| width + 2).sum::<usize>();
        let room = self.width.saturating_sub(margin).max(NARROWEST);
        let heads: Vec<String> = head.iter().map(|cell| (*cell).to_owned()).collect();
        for (place, row) in std::iter::once(&heads).chain(rows).enumerate() {
            let mut line = String::from("  ");
            for (column, width) in widths.iter().enumerate().filter(|(_, width)| **width > 0) {
                let space = " ".repeat(width - row[column].width());
                let cell = &row[column];
                let _ = match numbers == Some(column) {
                    true => write!(line, "{space}{cell}  "),
                    false => write!(line, "{cell}{space}  "),
                };
            }
            let wrapped = textwrap::wrap(&row[last], whole_words(room));
            line.push_str(wrapped.first().map_or("", |first| first));
            if place == 0 {
                let _ = writeln!(self.text, "{ASIDE}{}{ASIDE:#}", line.trim_end());
            } else {
                let _ = writeln!(self.text, "{}", line.trim_end());
            }
            for rest in wrapped.iter().skip(1) {
                let _ = writeln!(self.text, "{}{rest}", " ".repeat(margin));
            }
        }
    }

    /// The page.
    pub fn finish(self) -> String {
        self.text
    }
}

/// Names and identifiers with hyphens stay in one piece, to be copied.
fn whole_words(width: usize) -> Options<'static> {
    Options::new(width).word_splitter(WordSplitter::NoHyphenation)
}
