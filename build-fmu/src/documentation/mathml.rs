//! Equations in plain text, set as MathML.
//!
//! The notation: blanks multiply, `_` and `^` lower and raise, primes are time derivatives, and Greek letters have
//! their names. A fraction has no blanks at its `/`, and its denominator ends at the next blank: `V_c/2pi omega`. A
//! comma without a blank belongs to a subscript: `F_act,i`. A name before `(` without a blank is a function. `<x>` is
//! zero for negative x. `[a, b; c, d]` is a matrix. Other words are prose. Unknown signs stay unchanged.
//!
//! Browsers do not break lines within `<math>`. So prose is text, and a long statement is one `<math>` for each term.

mod node;
mod parser;
mod symbol;

use maud::{Markup, PreEscaped, html};

use node::{Form, Node, line};
use parser::Parser;

const GREEK: &str = "alpha α beta β gamma γ delta δ eps ε epsilon ε zeta ζ eta η theta θ kappa κ lambda λ mu μ nu ν xi ξ \
                     pi π rho ρ sigma σ tau τ phi φ chi χ psi ψ omega ω Delta Δ Phi Φ Psi Ψ Omega Ω Sigma Σ";

/// A text with equations. Each `<math>` has its plain text as `alttext`.
pub fn set(text: &str) -> Markup {
    let allowed = |sign: char| match sign {
        '\t' | '\n' | '\r' => ' ',
        '\u{FFFE}' | '\u{FFFF}' => '\u{FFFD}',
        sign if sign.is_control() => '\u{FFFD}',
        sign => sign,
    };
    let text: String = text.chars().map(allowed).collect();
    let mut parser = Parser { text: &text, at: 0, script: false };
    let mut out = String::new();
    while !parser.rest().is_empty() {
        let start = parser.at;
        parser.prose();
        out += &html! { (&text[start..parser.at]) }.0;
        let start = parser.at;
        let mut nodes = parser.row(0, None);
        if parser.at == start
            && let Some(sign) = parser.next()
        {
            nodes.push(Node::sign(&sign.to_string(), Form::Prefix));
        }
        let source = &text[start..parser.at];
        if source.chars().all(|sign| sign.is_ascii_digit() || sign == '.') {
            out += source;
        } else {
            let math = html! { math alttext=(source) displaystyle="true" { (line(&nodes, true)) } };
            // No line begins with a comma.
            let sign = parser.take_while(|sign| matches!(sign, ',' | ';' | ':'));
            out += &html! { @if sign.is_empty() { (math) } @else { span.whole { (math) (sign) } } }.0;
        }
    }
    PreEscaped(out)
}

/// The letter of a name.
fn greek(name: &str) -> Option<&'static str> {
    let mut names = GREEK.split(' ');
    names.by_ref().step_by(2).find(|it| *it == name)?;
    names.next()
}

/// The length of the word of prose at the beginning; 0 for a symbol, a function or a factor.
fn word(rest: &str) -> usize {
    let inner =
        |text: &str| text.starts_with(['\'', '-', '.', '_']) && text[1..].starts_with(char::is_alphabetic);
    let letters = |text: &str| text.find(|sign: char| !sign.is_alphabetic()).unwrap_or(text.len());
    let open = usize::from(rest.starts_with('('));
    let first = &rest[open..open + letters(&rest[open..])];
    let mut end = open + first.len();
    let follows = rest[end..].strip_prefix(' ').unwrap_or_default();
    if first == "a" && follows.len() > 1 && letters(follows) > 1 && word(follows) > 0 {
        return end;
    }
    let length = first.chars().count();
    let capital = length == 2 && first.starts_with(char::is_uppercase);
    let symbol = length < 2 || capital || greek(first).is_some();
    if symbol || ["sum", "ln"].contains(&first) || length == 2 && rest[end..].starts_with('_') {
        return 0;
    }
    while inner(&rest[end..]) {
        end += 1 + letters(&rest[end + 1..]);
    }
    if open == 1 {
        return if rest[end..].starts_with(')') { end + 1 } else { 0 };
    }
    if rest[end..].is_empty() || rest[end..].starts_with([' ', ',', ';', ':']) { end } else { 0 }
}

/// The text of a well-formed page or part of it, with equations as they were written.
#[cfg(test)]
pub fn plain(xml: &str) -> String {
    let document = roxmltree::Document::parse(xml).unwrap_or_else(|error| panic!("{error}: {xml}"));
    let inside = |node: &roxmltree::Node| {
        node.parent().is_some_and(|it| it.ancestors().any(|it| it.has_tag_name("math")))
    };
    let parts = document.descendants().filter(|node| !inside(node));
    parts.filter_map(|node| if node.is_text() { node.text() } else { node.attribute("alttext") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Signs, identifiers and numbers as they are set, without the elements around them.
    fn read(text: &str) -> String {
        let set = format!("<p>{}</p>", set(text).0);
        let document =
            roxmltree::Document::parse(&set).unwrap_or_else(|error| panic!("{text}: {error}: {set}"));
        let texts = document.descendants().filter(roxmltree::Node::is_text).filter_map(|node| node.text());
        texts.collect::<String>().replace(['\u{2061}', '\u{2062}'], "")
    }

    /// The only equation of a text, without attributes and invisible signs.
    fn elements(text: &str) -> String {
        let wrapped = ["<mrow>", "</mrow>", "<span class=\"whole\">", "</span>"];
        let set = wrapped.into_iter().fold(set(text).0, |set, tag| set.replace(tag, ""));
        let parts = set.split('<').filter(|part| !part.is_empty());
        let plain = parts.map(|part| {
            part.split_once('>').map_or_else(
                || part.to_owned(),
                |(tag, rest)| format!("<{}>{rest}", tag.split(' ').next().unwrap()),
            )
        });
        plain.collect::<String>().replace("<mo>\u{2062}</mo>", "").replace("<mo>\u{2061}</mo>", "")
    }

    fn is_set(text: &str, expected: &str) {
        assert_eq!(elements(text), format!("<math>{expected}</math>"), "{text}");
    }

    #[test]
    fn subscripts_powers_and_primes_stand_at_their_symbol() {
        is_set("F_tire", "<msub><mi>F</mi><mi>tire</mi></msub>");
        is_set("C_SH,H", "<msub><mi>C</mi><mi>SH</mi><mo>,</mo><mi>H</mi></msub>");
        is_set("v1", "<msub><mi>v</mi><mn>1</mn></msub>");
        is_set("a_(k-1)", "<msub><mi>a</mi><mi>k</mi><mo>−</mo><mn>1</mn></msub>");
        is_set("A_0^2", "<msubsup><mi>A</mi><mn>0</mn><mn>2</mn></msubsup>");
        is_set("R^-1", "<msup><mi>R</mi><mo>−</mo><mn>1</mn></msup>");
        is_set("a_0''", "<msub><mi>a</mi><mo>″</mo><mn>0</mn></msub>");
        is_set("(P)'", "<mo>(</mo><mi>P</mi><mo>)</mo><mo>′</mo>");
        is_set("p^(1/kappa)", "<msup><mi>p</mi><mn>1</mn><mo>/</mo><mi>κ</mi></msup>");
        is_set("|u|^n", "<msup><mo>|</mo><mi>u</mi><mo>|</mo><mi>n</mi></msup>");
    }

    #[test]
    fn a_fraction_takes_the_symbols_before_and_ends_at_a_blank() {
        is_set("V_c/2pi P", "<mfrac><msub><mi>V</mi><mi>c</mi></msub><mn>2</mn><mi>π</mi></mfrac><mi>P</mi>");
        is_set("2 b/p", "<mfrac><mn>2</mn><mi>b</mi><mi>p</mi></mfrac>");
        is_set("h (1 - c)/2", "<mi>h</mi><mfrac><mn>1</mn><mo>−</mo><mi>c</mi><mn>2</mn></mfrac>");
        is_set("|1 - F/K|", "<mo>|</mo><mn>1</mn><mo>−</mo><mfrac><mi>F</mi><mi>K</mi></mfrac><mo>|</mo>");
        is_set("sqrt(P/rho)", "<msqrt><mfrac><mi>P</mi><mi>ρ</mi></mfrac></msqrt>");
        is_set("1/s", "<mfrac><mn>1</mn><mi>s</mi></mfrac>");
    }

    #[test]
    fn functions_brackets_and_numbers_are_told_from_factors() {
        is_set("tanh(x)", "<mi>tanh</mi><mo>(</mo><mi>x</mi><mo>)</mo>");
        is_set("<x - 1>", "<mo>⟨</mo><mi>x</mi><mo>−</mo><mn>1</mn><mo>⟩</mo>");
        is_set("a <= -b", "<mi>a</mi><mo>≤</mo><mo>−</mo><mi>b</mi>");
        is_set("4e13 u", "<mn>4</mn><mo>×</mo><msup><mn>10</mn><mn>13</mn></msup><mi>u</mi>");
        is_set("max( , 0)", "<mi>max</mi><mo>(</mo><mi>·</mi><mo>,</mo><mn>0</mn><mo>)</mo>");
        is_set("sum F_i", "<mo>∑</mo><msub><mi>F</mi><mi>i</mi></msub>");
        let row = |a, b| format!("<mtr><mtd><mi>{a}</mi></mtd><mtd><mi>{b}</mi></mtd></mtr>");
        is_set(
            "[a, b; c, d]",
            &format!("<mo>[</mo><mtable>{}{}</mtable><mo>]</mo>", row("a", "b"), row("c", "d")),
        );
    }

    #[test]
    fn words_are_text_and_long_statements_break_before_their_terms() {
        assert_eq!(
            elements("T = 0.5 ms, dz a dead zone"),
            "<math><mi>T</mi><mo>=</mo><mn>0.5</mn><mspace></mspace><mtext>ms</mtext></math>, dz a dead zone"
        );
        assert_eq!(elements("lift-off: the damper's 2.5"), "lift-off: the damper's 2.5");
        assert_eq!(set("a = b + c").0.matches("<math").count(), 1);
        assert_eq!(set("F = k_t c + q c^2 + d_t c' + F_t tanh(c'/v_0) + F_0t").0.matches("<math").count(), 3);
        assert_eq!(read("not (closed, a_ ^ \" '"), "not (closed,a_^\"'");
    }

    #[test]
    fn the_plain_texts_make_up_the_text() {
        for text in texts() {
            assert_eq!(plain(&format!("<p>{}</p>", set(text).0)), text);
            assert!(
                !read(text).contains(['_', '^', '*']) || text.contains("_re") || text.contains("e_t"),
                "{text}"
            );
        }
    }

    fn texts() -> impl Iterator<Item = &'static str> {
        strut_physics::CATALOGUE.iter().flat_map(|entry| entry.about.equations.iter().map(|it| it.text))
    }

    proptest! {
        #[test]
        fn any_text_is_well_formed(text in ".*") {
            read(&text);
        }

        #[test]
        fn any_signs_are_well_formed(text in r"([ax_^'/|<>()\[\],;:.+ -]|pi|sqrt|ln |sum |2|word){0,60}") {
            prop_assert_eq!(plain(&format!("<p>{}</p>", set(&text).0)), text.clone());
        }
    }

    #[test]
    fn deep_parentheses_are_signs() {
        for sign in ["(", "x_(", "x^(", "|x<", "ln ", "sqrt(", "a ", "a/", "'^"] {
            read(&sign.repeat(3000));
        }
    }
}
