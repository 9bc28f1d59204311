//! Numbers, symbols and functions, with what is raised and lowered.

use maud::{Markup, PreEscaped, html};

use super::greek;
use super::node::{Form, Kind, Node, line};
use super::parser::Parser;

/// Deeper parentheses are signs like any other.
const DEEPEST: usize = 40;

impl Parser<'_> {
    /// A number, a symbol, a function or parentheses, with what is raised and lowered; `None` for a sign.
    pub fn operand(&mut self, depth: usize) -> Option<Node> {
        if depth > DEEPEST {
            return None;
        }
        let sign = self.peek()?;
        let node = match sign {
            '0'..='9' => self.number(),
            '(' => self.group(depth, ')'),
            '[' => self.group(depth, ']'),
            '|' => self.group(depth, '|'),
            '<' if self.take("< >") => {
                Node::operand(html! { mrow { mo { "⟨" } mi { "·" } mo { "⟩" } } }, Kind::Compound)
            }
            '<' if !self.rest()[1..].starts_with([' ', '=']) => self.group(depth, '>'),
            '.' if self.rest().starts_with("..") => {
                self.take_while(|sign| sign == '.');
                Node::operand(html! { mi { "…" } }, Kind::Compound)
            }
            sign if sign.is_alphabetic() => return Some(self.named(depth)),
            _ => return None,
        };
        Some(self.raised(node, None, depth))
    }

    fn number(&mut self) -> Node {
        let start = self.at;
        let digits = |parser: &mut Self| parser.take_while(|sign| sign.is_ascii_digit());
        digits(self);
        if self.rest().starts_with('.') && self.rest()[1..].starts_with(|it: char| it.is_ascii_digit()) {
            self.at += 1;
            digits(self);
        }
        let value = &self.text[start..self.at];
        let ends = |rest: &str| rest.is_empty() || rest.starts_with([',', ';', ')']);
        let unit = ["ms", "V", "s", "N/A"].into_iter().find(|unit| {
            let rest = self.rest().strip_prefix(' ').and_then(|rest| rest.strip_prefix(*unit));
            rest.is_some_and(|rest| ends(rest) || *unit == "N/A")
        });
        if let Some(unit) = unit {
            self.at += 1 + unit.len();
            let markup = html! { mn { (value) } mspace width="0.2em" {} mtext { (unit) } };
            return Node::operand(html! { mrow { (markup) } }, Kind::Compound);
        }
        if self.rest().starts_with('e') && self.rest()[1..].starts_with(|it: char| it.is_ascii_digit()) {
            self.at += 1;
            let power = digits(self);
            let markup = html! { mrow { mn { (value) } mo { "×" } msup { mn { "10" } mn { (power) } } } };
            return Node::operand(markup, Kind::Simple);
        }
        Node::operand(html! { mn { (value) } }, Kind::Simple)
    }

    fn named(&mut self, depth: usize) -> Node {
        let letters = self.take_while(char::is_alphabetic);
        let greek = greek(letters);
        let short = greek.is_some() || letters.chars().count() <= 2;
        if letters == "sum" && (self.take(" of ") || self.rest().starts_with(' ')) {
            return Node::operand(html! { mo { "∑" } }, Kind::Compound);
        }
        if letters == "sqrt" && self.rest().starts_with('(') {
            let root = html! { msqrt { (PreEscaped(self.group(depth, ')').bare())) } };
            return self.raised(Node::operand(root, Kind::Compound), None, depth);
        }
        if letters == "ln" && self.take(" ") {
            let argument = self.operand(depth + 1);
            let argument: Vec<Node> = argument.into_iter().collect();
            let markup = html! { mrow { mi { "ln" } mspace width="0.2em" {} (line(&argument, false)) } };
            return Node::operand(markup, Kind::Compound);
        }
        let start = self.at - letters.len();
        let more = |sign: char| sign.is_alphanumeric() || sign == '_';
        let joins = |rest: &str| rest.starts_with('.') && rest[1..].starts_with(char::is_alphabetic);
        while joins(self.rest()) || !short && self.rest().starts_with('_') {
            self.at += 1;
            self.take_while(more);
        }
        let name = &self.text[start..self.at];
        if name != letters || !short && !self.rest().starts_with(['(', '\'']) {
            let node = Node::word(name);
            return self.raised(node, None, depth);
        }
        let base = Node::operand(html! { mi { (greek.unwrap_or(letters)) } }, Kind::Simple);
        let lower = self.lower(letters.chars().count() == 1, depth);
        let node = self.raised(base, lower, depth);
        if !self.rest().starts_with('(') {
            return node;
        }
        let argument = self.group(depth, ')');
        let call = html! { mrow { (line(&[node], false)) mo { "\u{2061}" } (line(&[argument], false)) } };
        self.raised(Node::operand(call, Kind::Compound), None, depth)
    }

    /// A subscript; digits may follow a letter as they are.
    fn lower(&mut self, letter: bool, depth: usize) -> Option<Markup> {
        let start = self.at;
        if self.take("_") {
            if self.peek() == Some('(') {
                return Some(PreEscaped(self.in_script(|parser| parser.group(depth, ')')).bare()));
            }
        } else if !letter || !self.rest().starts_with(|sign: char| sign.is_ascii_digit()) {
            return None;
        }
        let mut parts = Vec::new();
        loop {
            parts.push(self.take_while(|sign| sign.is_alphanumeric() || sign == '_'));
            let rest = self.rest();
            if !(rest.starts_with(',') && rest[1..].starts_with(char::is_alphanumeric)) {
                break;
            }
            self.at += 1;
        }
        if parts[0].is_empty() {
            self.at = start;
            return None;
        }
        let part = |part: &str| match part.parse::<u64>() {
            Ok(_) => html! { mn { (part) } },
            Err(_) => html! { mi { (greek(part).unwrap_or(part).replace('_', "\u{A0}")) } },
        };
        let more = parts[1..].iter().map(|it| html! { mo rspace="0.1em" { "," } (part(it)) }.0);
        Some(html! { mrow { (part(parts[0])) (PreEscaped(more.collect::<String>())) } })
    }

    /// With primes, a power and a subscript.
    fn raised(&mut self, node: Node, lower: Option<Markup>, depth: usize) -> Node {
        let primes = self.take_while(|sign| sign == '\'').len();
        let start = self.at;
        let power = if self.take("^") { self.in_script(|parser| parser.power(depth)) } else { None };
        if power.is_none() {
            self.at = start;
        }
        if primes == 0 && power.is_none() && lower.is_none() {
            return node;
        }
        let simple = matches!(node, Node::Operand { kind: Kind::Simple, .. });
        let base = line(&[node], false);
        // A prime is high enough without being raised.
        let prime = ["", "′", "″", "‴"].get(primes).map_or_else(|| "′".repeat(primes), |it| (*it).to_owned());
        let base = html! {
            @if primes == 0 { (base) } @else { mrow { (base) mo class="prime" lspace="0" rspace="0" { (prime) } } }
        };
        let markup = match (lower, power) {
            (Some(lower), Some(power)) => html! { msubsup { (base) (lower) (power) } },
            (Some(lower), None) => html! { msub { (base) (lower) } },
            (None, Some(power)) => html! { msup { (base) (power) } },
            (None, None) => base,
        };
        Node::operand(markup, if simple { Kind::Simple } else { Kind::Compound })
    }

    fn power(&mut self, depth: usize) -> Option<Markup> {
        let minus = self.take("-");
        let node = match self.peek()? {
            '(' => return (!minus).then(|| PreEscaped(self.group(depth, ')').bare())),
            '0'..='9' => self.number(),
            sign if sign.is_alphabetic() => {
                let letters = self.take_while(char::is_alphabetic);
                Node::operand(html! { mi { (greek(letters).unwrap_or(letters)) } }, Kind::Simple)
            }
            _ => return None,
        };
        let minus = minus.then(|| Node::sign("−", Form::Prefix));
        Some(line(&minus.into_iter().chain([node]).collect::<Vec<_>>(), false))
    }

    fn in_script<T>(&mut self, parse: impl FnOnce(&mut Self) -> T) -> T {
        let outside = std::mem::replace(&mut self.script, true);
        let parsed = parse(self);
        self.script = outside;
        parsed
    }
}
