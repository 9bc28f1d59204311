//! Mutations that no one has thought of one by one: each element and attribute of a description, spoilt in each way that its
//! schema forbids.

use std::collections::HashSet;
use std::ops::Range;

use roxmltree::{Document, Node};

/// A mutation: what was done, the rule that finds it, and the text.
pub type Mutation = (String, &'static str, String);

/// The rules of a schema, in this order: element, order, missing, attribute, required, value, text.
pub type Rules = [&'static str; 7];

/// Attributes that a schema requires, and those whose values are of no text; by element.
pub struct Facts {
    /// Attributes that must be there.
    pub required: &'static [(&'static str, &'static str)],
    /// Attributes whose values are numbers, literals or lists of them.
    pub typed: &'static [&'static str],
    /// Elements that stand in their parent once at most.
    pub single: &'static [&'static str],
    /// Elements that their parent cannot do without.
    pub needed: &'static [&'static str],
    /// Elements that may have anything in them.
    pub open: &'static [&'static str],
    /// Elements whose elements come in any order.
    pub free: &'static [&'static str],
}

/// All of a text; of elements that stand at one place, the first is taken.
pub fn all(text: &str, rules: &Rules, facts: &Facts) -> Vec<Mutation> {
    let document = Document::parse(text).unwrap();
    let mut seen = HashSet::new();
    let mut mutations = Vec::new();
    for node in document.root_element().descendants().filter(Node::is_element) {
        let path = path(node);
        if seen.insert(path.clone()) && !node.ancestors().skip(1).any(|it| is(it, facts.open)) {
            mutations.extend(of(text, node, &path, rules, facts));
        }
    }
    mutations
}

fn of(text: &str, node: Node, path: &str, rules: &Rules, facts: &Facts) -> Vec<Mutation> {
    let [element, order, missing, attribute, required, value, stray] = *rules;
    let mut mutations = Vec::new();
    let mut add = |what: &str, rule: &'static str, range: Range<usize>, new: &str| {
        let spoilt = format!("{}{new}{}", &text[..range.start], &text[range.end..]);
        mutations.push((format!("{path}: {what}"), rule, spoilt));
    };
    let name = node.tag_name().name();
    let range = node.range();
    let start = range.start + 1 + text[range.start + 1..].find([' ', '>', '/', '\n']).unwrap();
    add("an attribute more", attribute, start..start, " colour=\"red\"");
    for given in node.attributes() {
        let (range, inner) = (given.range(), given.range_value());
        let shown = given.name();
        if facts.required.contains(&(name, shown)) {
            add(&format!("no {shown}"), required, range.clone(), "");
        }
        if facts.typed.contains(&shown) {
            add(&format!("{shown} of another type"), value, inner, "?");
        }
        if shown != "description" {
            add(&format!("{shown} with another name"), attribute, range, &format!("{shown}Of=\"1\""));
        }
    }
    let whole = &text[range.clone()];
    if !is(node, facts.open) {
        // Within the element, where it has an end of its own.
        let end = whole.ends_with(&format!("{name}>")).then(|| range.start + whole.rfind("</").unwrap());
        let prefix = text[range.start + 1..start].strip_suffix(name).unwrap();
        let tag = &text[range.start + 1..start];
        let put = |what: &str| match end {
            Some(end) => (end..end, what.to_owned()),
            None => (range.end - 2..range.end, format!(">{what}</{tag}>")),
        };
        let (at, new) = put(&format!("<{prefix}Surprise/>"));
        add("an element more", element, at, &new);
        let (at, new) = put("stray");
        add("a text within", stray, at, &new);
    }
    if is(node, facts.single) {
        add("twice", order, range.end..range.end, whole);
    }
    if is(node, facts.needed) {
        add("left out", missing, range.clone(), "");
    }
    let last = node.parent_element().and_then(|it| it.last_element_child());
    let is_ordered = node.parent_element().is_some_and(|parent| !is(parent, facts.free));
    if let Some(last) = last.filter(|last| is_ordered && *last != node && last.tag_name() != node.tag_name())
    {
        let spoilt = format!(
            "{}{}{whole}{}",
            &text[..range.start],
            &text[range.end..last.range().end],
            &text[last.range().end..]
        );
        mutations.push((format!("{path}: behind the last"), order, spoilt));
    }
    mutations
}

fn is(node: Node, names: &[&str]) -> bool {
    names.contains(&node.tag_name().name())
}

fn path(node: Node) -> String {
    let mut names: Vec<&str> =
        node.ancestors().filter(Node::is_element).map(|it| it.tag_name().name()).collect();
    names.reverse();
    names.join("/")
}
