//! `report.json`: objects line by line, lists of numbers on one line.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::Formatter;

use crate::report::findings::Findings;

/// The findings as JSON, format version [`crate::report::findings::FORMAT`]; its fields are described in the crate's
/// README. A number that is not finite becomes `null`.
pub fn json(findings: &Findings) -> String {
    let mut text = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut text, Lines::default());
    findings.serialize(&mut serializer).expect("plain data into memory");
    text.push(b'\n');
    String::from_utf8(text).expect("JSON is UTF-8")
}

/// Puts what stands in an object on lines of its own, and objects in lists; numbers in lists share a line.
#[derive(Default)]
struct Lines {
    depth: usize,
    /// For each open list or object: whether its end stands on a line of its own.
    broken: Vec<bool>,
}

impl Lines {
    fn line(&mut self, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
        if let Some(broken) = self.broken.last_mut() {
            *broken = true;
        }
        write!(writer, "\n{:width$}", "", width = 2 * self.depth)
    }

    fn open(&mut self) {
        self.depth += 1;
        self.broken.push(false);
    }

    fn close(&mut self, writer: &mut (impl Write + ?Sized), bracket: &str) -> io::Result<()> {
        self.depth -= 1;
        if self.broken.pop() == Some(true) {
            write!(writer, "\n{:width$}", "", width = 2 * self.depth)?;
        }
        writer.write_all(bracket.as_bytes())
    }
}

impl Formatter for Lines {
    fn begin_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open();
        writer.write_all(b"[")
    }

    fn begin_array_value<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }

    fn end_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, "]")
    }

    fn begin_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open();
        writer.write_all(b"{")
    }

    fn begin_object_key<W: Write + ?Sized>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        self.line(writer)
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn end_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, "}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_numbers_stay_on_their_line() {
        let value = serde_json::json!({"a": [1, 2.5], "b": [{"c": []}, {}]});
        let mut text = Vec::new();
        value.serialize(&mut serde_json::Serializer::with_formatter(&mut text, Lines::default())).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert_eq!(text, "{\n  \"a\": [1, 2.5],\n  \"b\": [{\n      \"c\": []\n    }, {}]\n}");
    }
}
