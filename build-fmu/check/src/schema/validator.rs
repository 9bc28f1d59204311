//! Compares a document with its schema.

use std::collections::HashMap;

use roxmltree::Node;

use super::{Content, Element, Particle};
use crate::finding::{Finding, count};
use crate::lines::Lines;
use crate::rules::Rule;

/// What the schema's sentences are in a standard.
#[derive(Debug)]
pub struct Rules {
    /// An element is known at its place.
    pub element: &'static Rule,
    /// Elements stand in order.
    pub order: &'static Rule,
    /// Elements are there.
    pub missing: &'static Rule,
    /// An attribute is known.
    pub attribute: &'static Rule,
    /// An attribute is there.
    pub required: &'static Rule,
    /// A value is one of its type.
    pub value: &'static Rule,
    /// There is no text.
    pub text: &'static Rule,
    /// Numbers are numbers, if the standard says so.
    pub finite: Option<&'static Rule>,
}

/// The faults of an element and all within it; the same fault at many places is one finding.
pub fn validate(node: Node, schema: &Element, rules: &Rules, file: &str, lines: &Lines) -> Vec<Finding> {
    let mut validator = Validator { rules, file, lines, found: HashMap::new(), findings: Vec::new() };
    validator.element(node, schema);
    let Validator { found, mut findings, .. } = validator;
    for (index, more) in found.into_values().filter(|(_, more)| *more > 0) {
        let places = count(more, "other place");
        findings[index].message.push_str(&format!(" (and in {places})"));
    }
    findings
}

struct Validator<'a> {
    rules: &'a Rules,
    file: &'a str,
    lines: &'a Lines,
    /// By what is said: which finding, and how often again.
    found: HashMap<String, (usize, usize)>,
    findings: Vec<Finding>,
}

impl Validator<'_> {
    fn report(&mut self, rule: &'static Rule, node: Node, message: String, help: Option<String>) {
        if let Some((_, more)) = self.found.get_mut(&message) {
            *more += 1;
            return;
        }
        self.found.insert(message.clone(), (self.findings.len(), 0));
        let finding = Finding::error(rule, message).at(format!("{}:{}", self.file, self.lines.line(node)));
        self.findings.push(help.into_iter().fold(finding, Finding::help));
    }

    fn element(&mut self, node: Node, schema: &Element) {
        self.attributes(node, schema);
        match &schema.content {
            Content::Foreign { one } => {
                let mut inner = node.children().filter(Node::is_element);
                if let (true, Some(second)) = (*one, inner.nth(1)) {
                    let message = format!("<{}> has more than one element in it", schema.name);
                    let help = "wrap them in one".to_owned();
                    self.report(self.rules.order, second, message, Some(help));
                }
            }
            Content::Sequence(groups) => self.children(node, schema, groups),
        }
    }

    fn attributes(&mut self, node: Node, schema: &Element) {
        let name = schema.name;
        let known = || schema.attributes.iter().copied().flatten();
        for attribute in node.attributes() {
            // Where the schema is to be found stands in attributes of XML Schema itself.
            if attribute.namespace() == Some("http://www.w3.org/2001/XMLSchema-instance") {
                continue;
            }
            let (given, text) = (attribute.name(), attribute.value());
            let declared = known().find(|it| it.name == given && attribute.namespace().is_none());
            let Some(declared) = declared else {
                let close = known()
                    .map(|it| (strsim::jaro_winkler(it.name, given), it.name))
                    .filter(|(like, _)| *like > 0.85)
                    .max_by(|a, b| a.0.total_cmp(&b.0));
                let help = close.map(|(_, close)| format!("is `{close}` meant?"));
                self.report(
                    self.rules.attribute,
                    node,
                    format!("<{name}> has the attribute `{given}`, which the schema does not know there"),
                    help,
                );
                continue;
            };
            if let Some(expected) = declared.of.wrong(text) {
                let message = format!("`{text}` is no value for the attribute `{given}` of <{name}>");
                self.report(self.rules.value, node, message, Some(format!("it is {expected}")));
            } else if let Some(finite) = self.rules.finite.filter(|_| declared.of.is_special(text)) {
                let message =
                    format!("the attribute `{given}` of <{name}> is {text}, which the standard forbids");
                let help = "leave the attribute out: without it nothing is bounded".to_owned();
                self.report(finite, node, message, Some(help));
            }
        }
        for attribute in known().filter(|it| it.required && node.attribute(it.name).is_none()) {
            let message = format!("<{name}> lacks the attribute `{}`", attribute.name);
            self.report(self.rules.required, node, message, None);
        }
    }

    fn children(&mut self, node: Node, schema: &Element, groups: &[&[Particle]]) {
        let name = schema.name;
        let particles: Vec<&Particle> = groups.iter().copied().flatten().collect();
        let (mut place, mut number) = (0, 0);
        for child in node.children() {
            if child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()) {
                let text: String = child.text().unwrap_or_default().trim().chars().take(20).collect();
                self.report(self.rules.text, node, format!("<{name}> has the text `{text}` in it"), None);
            }
            if !child.is_element() {
                continue;
            }
            let given = child.tag_name();
            let of = |particle: &Particle| -> Option<&'static Element> {
                let named = |it: &&&Element| it.name == given.name() && it.namespace == given.namespace();
                particle.elements.iter().find(named).copied()
            };
            let ahead = particles[place..].iter().position(|it| of(it).is_some());
            let Some(skipped) = ahead else {
                self.unknown(child, schema, &particles);
                continue;
            };
            if skipped > 0 {
                self.lacking(node, schema, &particles[place..place + skipped], number);
                (place, number) = (place + skipped, 0);
            }
            number += 1;
            if number > particles[place].most {
                let message = format!("<{name}> has more than one <{}>", given.name());
                self.report(self.rules.order, child, message, None);
            }
            if let Some(inner) = of(particles[place]) {
                self.element(child, inner);
            }
        }
        self.lacking(node, schema, &particles[place.min(particles.len())..], number);
    }

    /// What should have come until now: of the first place there are some already.
    fn lacking(&mut self, node: Node, schema: &Element, particles: &[&Particle], number: usize) {
        for (index, particle) in particles.iter().enumerate() {
            let there = if index == 0 { number } else { 0 };
            if there < particle.least {
                let names: Vec<String> =
                    particle.elements.iter().map(|it| format!("<{}>", it.name)).collect();
                let message = format!("<{}> lacks {}", schema.name, names.join(" or "));
                self.report(self.rules.missing, node, message, None);
            }
        }
    }

    fn unknown(&mut self, child: Node, schema: &Element, particles: &[&Particle]) {
        let (given, name) = (child.tag_name(), schema.name);
        let mut all = particles.iter().flat_map(|it| it.elements);
        let known = all.find(|it| it.name == given.name());
        match known {
            Some(known) if known.namespace != given.namespace() => {
                let message = format!("<{}> in <{name}> is of another namespace", given.name());
                let help = format!("it is {}", known.namespace.unwrap_or("none"));
                self.report(self.rules.element, child, message, Some(help));
                self.element(child, known);
            }
            Some(known) => {
                let order: Vec<&str> =
                    particles.iter().flat_map(|it| it.elements).map(|it| it.name).collect();
                let message = format!("<{}> stands too late in <{name}>", given.name());
                let help = format!("the order is {}", order.join(", "));
                self.report(self.rules.order, child, message, Some(help));
                self.element(child, known);
            }
            None => {
                let message =
                    format!("<{name}> has <{}> in it, which the schema does not know there", given.name());
                self.report(self.rules.element, child, message, None);
            }
        }
    }
}
