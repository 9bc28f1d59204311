//! Lines of a text: where an element stands.

use roxmltree::Node;

/// Where the lines of a text begin. Counting them anew for each element would take the square of their number.
#[derive(Debug)]
pub struct Lines(Vec<usize>);

impl Lines {
    /// The lines of a text.
    pub fn of(text: &str) -> Self {
        Self(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(place, _)| place).collect())
    }

    /// The line where an element of the text begins, from 1.
    pub fn line(&self, node: Node) -> u32 {
        let before = self.0.partition_point(|end| *end < node.range().start);
        u32::try_from(before + 1).unwrap_or(u32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_is_in_the_line_where_it_begins() {
        let text = "<a>\n<b/>\n\n  <c\n x=\"1\"/></a>";
        let document = roxmltree::Document::parse(text).unwrap();
        let lines = Lines::of(text);
        let found: Vec<u32> =
            document.descendants().filter(Node::is_element).map(|it| lines.line(it)).collect();
        assert_eq!(found, [1, 2, 4]);
        let expected = document.descendants().filter(Node::is_element);
        let expected: Vec<u32> = expected.map(|it| document.text_pos_at(it.range().start).row).collect();
        assert_eq!(found, expected);
    }
}
