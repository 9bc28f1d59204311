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

/// Texts that are spoilt at random, or are still good: names, values and places of the text itself, put elsewhere. What is in open
/// elements is left alone.
pub fn random(text: &str, open: &[&str], number: usize) -> Vec<String> {
    let document = Document::parse(text).unwrap();
    let elements = document.root_element().descendants().filter(Node::is_element).skip(1);
    let nodes: Vec<Node> = elements.filter(|node| !node.ancestors().skip(1).any(|it| is(it, open))).collect();
    let attributes: Vec<_> = nodes.iter().flat_map(Node::attributes).collect();
    // Numbers that are the same in each run (Numerical Recipes' generator).
    let mut state = 1_u64;
    let mut below = |count: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % count
    };
    let put = |range: Range<usize>, new: &str| format!("{}{new}{}", &text[..range.start], &text[range.end..]);
    let mut texts = Vec::new();
    while texts.len() < number {
        let (node, other) = (nodes[below(nodes.len())], nodes[below(nodes.len())]);
        let (attribute, another) =
            (&attributes[below(attributes.len())], &attributes[below(attributes.len())]);
        let whole = &text[node.range()];
        texts.push(match below(7) {
            0 => put(node.range(), ""),
            1 => put(node.range(), &format!("{whole}{whole}")),
            2 => put(node.range(), &text[other.range()]),
            3 => put(node.range(), &format!("{whole}{}", &text[other.range()])),
            4 => put(attribute.range(), ""),
            5 => put(attribute.range_value(), another.value()),
            // An attribute that is there already would be no XML.
            _ if node.attribute(another.name()).is_none() => {
                let start = node.range().start + 1;
                let end = start + text[start..].find([' ', '>', '/', '\n']).unwrap();
                put(end..end, &format!(" {}=\"{}\"", another.name(), another.value()))
            }
            _ => continue,
        });
    }
    texts.retain(|text| Document::parse(text).is_ok());
    texts
}
