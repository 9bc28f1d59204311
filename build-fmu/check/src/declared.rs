//! What is declared by a name: units, types, their items, log categories, annotations.

use std::collections::HashMap;

use roxmltree::Node;

use crate::description::elements;
use crate::finding::Finding;
use crate::lines::Lines;
use crate::rules::{Rule, fmi, practice};

/// Something that is declared by a name, or a value, of which there may be one.
#[derive(Clone, Debug, PartialEq)]
pub struct Declared {
    /// What it is: `unit`, `type`.
    pub what: &'static str,
    /// That there is one of it.
    pub once: &'static Rule,
    /// In what: nothing, or the type or unit that it belongs to.
    pub within: String,
    /// Its name.
    pub name: String,
    /// Factor to another unit, if there is one.
    pub factor: Option<String>,
    /// Line of the element.
    pub line: u32,
}

/// Units with their display units, types with their items (by name and by value), log categories, tools of annotations.
pub fn declared(root: Node, lines: &Lines) -> Vec<Declared> {
    let mut all = Vec::new();
    let mut add = |(what, once): (&'static str, &'static Rule),
                   within: &str,
                   node: Node,
                   name: &str,
                   factor: Option<&str>| {
        all.push(Declared {
            what,
            once,
            within: within.into(),
            name: name.into(),
            factor: factor.map(str::to_owned),
            line: lines.line(node),
        });
    };
    let name = |node: Node| node.attribute("name").unwrap_or_default().to_owned();
    let list = |list: &'static str, item: &'static str| {
        let found = root.children().find(move |node| node.has_tag_name(list));
        found.into_iter().flat_map(move |node| elements(node, item))
    };
    for unit in list("UnitDefinitions", "Unit") {
        let base = unit.children().find(|node| node.has_tag_name("BaseUnit"));
        let factor = base.and_then(|base| base.attribute("factor"));
        add(("unit", fmi::UNIT_TWICE), "", unit, &name(unit), factor);
        for display in elements(unit, "DisplayUnit") {
            let what = ("display unit", fmi::DISPLAY_TWICE);
            add(what, &name(unit), display, &name(display), display.attribute("factor"));
        }
    }
    for ty in list("TypeDefinitions", "SimpleType") {
        add(("type", fmi::TYPE_TWICE), "", ty, &name(ty), None);
        for item in ty.children().filter(Node::is_element).flat_map(|kind| elements(kind, "Item")) {
            add(("item", practice::ITEM_NAME), &name(ty), item, &name(item), None);
            let value = item.attribute("value").unwrap_or_default().trim();
            add(("item's value", fmi::ITEM_VALUE), &name(ty), item, value, None);
        }
    }
    for category in list("LogCategories", "Category") {
        add(("log category", fmi::CATEGORY_TWICE), "", category, &name(category), None);
    }
    for tool in list("VendorAnnotations", "Tool") {
        add(("tool", fmi::TOOL_TWICE), "", tool, &name(tool), None);
    }
    all
}

/// What is declared by a name is declared once, and a factor is one that can be divided by.
pub fn findings(declared: &[Declared]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut seen: HashMap<(&str, &str, &str), u32> = HashMap::new();
    for Declared { what, once, within, name, factor, line } in declared {
        let within_it = if within.is_empty() { String::new() } else { format!(" of `{within}`") };
        if let Some(first) = seen.insert((what, within, name), *line) {
            let message = format!("the {what} `{name}`{within_it} is declared twice; first in line {first}");
            findings.push(Finding::error(once, message).line(*line));
        }
        if let Some(text) = factor
            && text.trim().parse::<f64>() == Ok(0.0)
        {
            let message = format!(
                "the {what} `{name}`{within_it} has the factor {text}, by which nothing can be converted"
            );
            findings.push(Finding::error(practice::FACTOR, message).line(*line));
        }
    }
    findings
}
