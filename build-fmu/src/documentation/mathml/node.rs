//! What stands in a row.

use maud::{Markup, PreEscaped, html};

/// The invisible sign between factors.
pub const TIMES: &str = "\u{2062}";

/// How a sign stands between its neighbours.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    Prefix,
    Infix,
    /// An infix without blanks, as in a subscript.
    Tight,
}

/// A sign or what it stands between.
pub enum Node {
    Sign(String, Form),
    Operand { markup: String, kind: Kind },
}

/// What an operand is in a fraction or beside a word.
pub enum Kind {
    /// A number or a symbol.
    Simple,
    /// A word, for the next one to join.
    Word(String),
    /// In parentheses, and what they contain.
    Group(String),
    /// A function of an argument, a fraction and the like.
    Compound,
}

impl Node {
    pub fn sign(sign: &str, form: Form) -> Self {
        Self::Sign(sign.into(), form)
    }

    pub fn operand(markup: Markup, kind: Kind) -> Self {
        Self::Operand { markup: markup.0, kind }
    }

    pub fn word(text: &str) -> Self {
        Self::operand(html! { mtext { (text) } }, Kind::Word(text.into()))
    }

    /// As numerator or denominator.
    pub fn bare(self) -> String {
        match self {
            Self::Operand { kind: Kind::Group(content), .. } => content,
            node => line(&[node], false).0,
        }
    }
}

/// Nodes in a row; at the edges of a `<math>`, blanks of the text replace the space around signs.
pub fn line(nodes: &[Node], outermost: bool) -> Markup {
    let edge = |index: usize| outermost && index == 0;
    let content = html! {
        @for (index, node) in nodes.iter().enumerate() {
            @match node {
                Node::Operand { markup, .. } => { (PreEscaped(markup)) }
                Node::Sign(sign, _) if sign == TIMES => { mo lspace="0" rspace="0.17em" { (sign) } }
                Node::Sign(sign, Form::Prefix) => { mo form="prefix" { (sign) } }
                Node::Sign(sign, Form::Tight) => { mo form="infix" lspace="0" rspace="0" { (sign) } }
                Node::Sign(sign, Form::Infix) => {
                    mo form="infix" lspace=[edge(index).then_some("0")]
                        rspace=[edge(nodes.len() - 1 - index).then_some("0")] { (sign) }
                }
            }
        }
    };
    if nodes.len() == 1 {
        content
    } else {
        html! { mrow { (content) } }
    }
}

/// Adds a factor, or a word to a word.
pub fn join(nodes: &mut Vec<Node>, node: Node, blank: bool) {
    if let (Some(Node::Operand { kind: Kind::Word(first), .. }), Node::Operand { kind: Kind::Word(next), .. }) =
        (nodes.last(), &node)
        && blank
    {
        let both = Node::word(&format!("{first} {next}"));
        nodes.pop();
        return nodes.push(both);
    }
    if matches!(nodes.last(), Some(Node::Operand { .. })) {
        nodes.push(Node::sign(TIMES, Form::Tight));
    }
    nodes.push(node);
}
