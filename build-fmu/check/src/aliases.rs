//! Rules for aliases: variables of one reference, which are one value under several names.

use std::collections::BTreeMap;

use crate::description::{Description, Variable};
use crate::finding::{Finding, names};
use crate::rules::{Rule, fmi};

/// What is wrong with variables that share a reference.
pub fn findings(description: &Description) -> Vec<Finding> {
    let mut sets: BTreeMap<(&str, u32), Vec<&Variable>> = BTreeMap::new();
    for variable in &description.variables {
        if let Some(reference) = variable.reference {
            // An enumeration is read and written as an integer.
            let kind = if variable.kind == "Enumeration" { "Integer" } else { &variable.kind };
            sets.entry((kind, reference)).or_default().push(variable);
        }
    }
    let shared = sets.into_iter().filter(|(_, set)| set.len() > 1);
    shared.filter_map(|((_, reference), set)| finding(reference, &set)).collect()
}

/// The first fault of a set. Its consequences are not reported.
fn finding(reference: u32, set: &[&Variable]) -> Option<Finding> {
    let all: Vec<&str> = set.iter().map(|variable| variable.name.as_str()).collect();
    let wrong = |rule: &'static Rule, what: &str| {
        let message = format!("{} share the reference {reference}, but {what}", names(&all));
        Some(Finding::error(rule, message).line(set[1].line))
    };
    let is = |causality: &str| set.iter().filter(|it| it.causality == causality).count();
    let constants = set.iter().filter(|it| it.variability == "constant").count();
    let settable = is("parameter") + is("input");
    if constants > 0 && constants < set.len() {
        return wrong(fmi::ALIAS_CONSTANT, "only some of them are constant");
    }
    if constants > 0 {
        let value = |variable: &Variable| variable.start.as_deref().map(|text| text.trim().to_owned());
        let number = |variable: &Variable| value(variable)?.parse::<f64>().ok();
        let differs = |it: &&&Variable| value(it) != value(set[0]) && number(it) != number(set[0]);
        if set.iter().find(differs).is_some() {
            return wrong(fmi::ALIAS_CONSTANT, "are constants of different values");
        }
    }
    if set.iter().any(|variable| variable.unit != set[0].unit) {
        return wrong(fmi::ALIAS_UNIT, "not the unit");
    }
    let help = "give each its own reference, or let one be the alias of the other, without a start value";
    if settable > 1 || (settable > 0 && is("independent") > 0) {
        let finding = wrong(fmi::ALIAS_REFERENCE, "more than one of them is set from outside");
        return finding.map(|finding| finding.help(help));
    }
    if constants == 0 && set.iter().filter(|variable| variable.start.is_some()).count() > 1 {
        let finding = wrong(fmi::ALIAS_START, "more than one of them has a start value");
        return finding.map(|finding| finding.help(help));
    }
    None
}
