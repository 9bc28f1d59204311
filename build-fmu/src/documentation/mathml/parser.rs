//! The notation as nodes.

use maud::{PreEscaped, html};

use super::node::{Form, Kind, Node, TIMES, join, line};
use super::word;

/// A statement of more characters may be broken before its terms.
const SHORT: usize = 36;

/// A text, and how far it is read.
pub struct Parser<'a> {
    /// The text.
    pub text: &'a str,
    /// How far it is read.
    pub at: usize,
    /// Whether this is a subscript or a power.
    pub script: bool,
}

impl<'a> Parser<'a> {
    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn before(&self) -> Option<char> {
        self.text[..self.at].chars().next_back()
    }

    pub fn next(&mut self) -> Option<char> {
        let sign = self.peek()?;
        self.at += sign.len_utf8();
        Some(sign)
    }

    pub fn take(&mut self, text: &str) -> bool {
        let found = self.rest().starts_with(text);
        self.at += if found { text.len() } else { 0 };
        found
    }

    pub fn take_while(&mut self, of: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let taken = &rest[..rest.find(|sign| !of(sign)).unwrap_or(rest.len())];
        self.at += taken.len();
        taken
    }

    /// Blanks, punctuation between statements, and words.
    pub fn prose(&mut self) {
        while let Some(sign) = self.peek() {
            let after = matches!(self.before(), None | Some(' '));
            match sign {
                ' ' | ',' | ';' | ':' => self.at += 1,
                _ if after && word(self.rest()) > 0 => self.at += word(self.rest()),
                _ => break,
            }
        }
    }

    /// What stands in a row up to `close`, to a comma or a semicolon, and outside of parentheses up to prose.
    pub fn row(&mut self, depth: usize, close: Option<char>) -> Vec<Node> {
        let mut nodes: Vec<Node> = Vec::new();
        let rest = self.rest();
        let end = [", ", "; ", ": "].iter().filter_map(|it| rest.find(it)).min().unwrap_or(rest.len());
        let long = rest[..end].chars().count() > SHORT;
        loop {
            let start = self.at;
            let blank = !self.take_while(|sign| sign == ' ').is_empty();
            let Some(sign) = self.peek() else { break };
            let ends = match sign {
                ',' | ';' => true,
                '|' | '>' => close == Some(sign) && !blank,
                ')' | ']' => close == Some(sign),
                ':' => depth == 0,
                _ => depth == 0 && (blank || nodes.is_empty()) && word(self.rest()) > 0,
            };
            let term = || depth == 0 && long && !nodes.is_empty();
            let infix = ["+ ", "- ", "+- "].iter().any(|sign| self.rest().starts_with(sign));
            if ends || infix && blank && term() {
                // Blanks between statements belong to the text.
                self.at = if depth == 0 { start } else { self.at };
                break;
            }
            let operand = matches!(nodes.last(), Some(Node::Operand { .. }));
            if sign == '/' && operand && !blank && !self.script {
                self.at += 1;
                self.fraction(&mut nodes, depth);
            } else if let Some(node) = self.operand(depth) {
                join(&mut nodes, node, blank);
            } else {
                nodes.push(self.operator(blank));
            }
        }
        nodes
    }

    /// Sets what stands before and behind a `/` as a fraction.
    fn fraction(&mut self, nodes: &mut Vec<Node>, depth: usize) {
        let mut denominator = Vec::new();
        while denominator.is_empty() || self.peek() != Some('|') {
            let Some(node) = self.operand(depth) else { break };
            join(&mut denominator, node, false);
        }
        if denominator.is_empty() {
            return nodes.push(Node::sign("/", Form::Infix));
        }
        // Of a product of symbols, all of them; otherwise the last factor.
        let simple = |node: &Node| match node {
            Node::Operand { kind, .. } => matches!(kind, Kind::Simple),
            Node::Sign(sign, _) => sign == TIMES,
        };
        let mut first = nodes.len() - 1;
        while simple(&nodes[nodes.len() - 1]) && first > 0 && simple(&nodes[first - 1]) {
            first -= 1;
        }
        let bare = |mut nodes: Vec<Node>| match nodes.pop() {
            Some(node) if nodes.is_empty() => node.bare(),
            node => line(&nodes.into_iter().chain(node).collect::<Vec<_>>(), false).0,
        };
        let [above, below] = [nodes.split_off(first), denominator].map(|it| PreEscaped(bare(it)));
        nodes.push(Node::operand(html! { mfrac { (above) (below) } }, Kind::Compound));
    }

    fn operator(&mut self, blank: bool) -> Node {
        let before = self.before();
        for (text, sign) in [("<=", "≤"), (">=", "≥"), ("+-", "±")] {
            if self.take(text) {
                return Node::sign(sign, Form::Infix);
            }
        }
        let sign = match self.next() {
            Some('-') => "−".to_owned(),
            Some('*') => "·".to_owned(),
            sign => sign.into_iter().collect(),
        };
        let attached = self.peek().is_some_and(|sign| sign != ' ');
        let opens = blank || before.is_none_or(|sign| " ([|<^,/".contains(sign));
        let form = match sign.as_str() {
            "+" | "−" if attached && opens => Form::Prefix,
            "(" | ")" | "[" | "]" | "|" | "'" | "^" | "_" | "." => Form::Tight,
            _ if self.script => Form::Tight,
            _ => Form::Infix,
        };
        Node::sign(&sign, form)
    }

    /// Parentheses of any kind, with commas and semicolons between. The end of the text closes them, too.
    pub fn group(&mut self, depth: usize, close: char) -> Node {
        self.next();
        let mut rows: Vec<Vec<Vec<Node>>> = vec![vec![self.row(depth + 1, Some(close))]];
        let closed = loop {
            match self.next() {
                Some(',') => {}
                Some(';') => rows.push(Vec::new()),
                end => break end.is_some(),
            }
            let cell = self.row(depth + 1, Some(close));
            if let Some(row) = rows.last_mut() {
                row.push(cell);
            }
        };
        let content = html! {
            @if close == ']' && rows.len() > 1 {
                mtable { @for row in &rows { mtr { @for cell in row { mtd { (line(cell, false)) } } } } }
            } @else {
                @for (index, row) in rows.iter().enumerate() {
                    @if index > 0 { mo { ";" } }
                    @for (index, cell) in row.iter().enumerate() {
                        @if index > 0 { mo { "," } }
                        @if cell.is_empty() && row.len() > 1 { mi { "·" } } @else { (line(cell, false)) }
                    }
                }
            }
        };
        let (left, right) = match close {
            ')' => ("(", ")"),
            ']' => ("[", "]"),
            '>' => ("⟨", "⟩"),
            _ => ("|", "|"),
        };
        let markup = html! {
            mrow {
                mo form="prefix" stretchy="true" { (left) }
                (content)
                @if closed { mo form="postfix" stretchy="true" { (right) } }
            }
        };
        let bare = html! { mrow { (content) } }.0;
        Node::operand(markup, if close == ')' && closed { Kind::Group(bare) } else { Kind::Compound })
    }
}
