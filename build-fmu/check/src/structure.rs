//! Rules for the model structure: what is listed, in which order, and what depends on what.

use std::collections::BTreeSet;

use crate::description::{Description, Kind, Unknown, Variable};
use crate::finding::{Finding, names};

/// What is wrong with it.
pub fn findings(description: &Description) -> Vec<Finding> {
    let lists = [
        ("Outputs", &description.outputs),
        ("Derivatives", &description.derivatives),
        ("InitialUnknowns", &description.initial_unknowns),
    ];
    let mut findings = Vec::new();
    for (name, list) in lists {
        findings.extend(entries(description, name, list));
    }
    let outputs = |variable: &Variable| variable.causality == "output";
    findings.extend(same_set(description, "Outputs", &description.outputs, &outputs, "causality=\"output\""));
    findings.extend(derivatives(description));
    findings.extend(initial_unknowns(description));
    findings.extend(dependencies(description));
    findings
}

/// Each entry is of a variable, and of one only once.
fn entries(description: &Description, list: &str, unknowns: &[Unknown]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut seen = BTreeSet::new();
    let last = description.variables.len();
    for unknown in unknowns {
        let error = |message: String| Finding::error("structure.entry", message).line(unknown.line);
        let index = unknown.index;
        let Some(variable) = description.variable(index) else {
            let help = format!("indices count the variables, from 1 to {last}; they are no value references");
            findings
                .push(error(format!("{list} lists the variable {index}, which there is none of")).help(help));
            continue;
        };
        let name = &variable.name;
        if !seen.insert(index) {
            findings.push(error(format!("{list} lists `{name}` twice")));
        }
        if let Some(wrong) = unknown.dependencies.iter().flatten().find(|index| !(1..=last).contains(*index))
        {
            let message = format!("`{name}` in {list} depends on variable {wrong}, which there is none of");
            findings.push(error(message).help(format!("indices count the variables, from 1 to {last}")));
        }
        let number = unknown.dependencies.as_ref().map(Vec::len);
        if unknown.kinds.is_some_and(|kinds| Some(kinds) != number) {
            findings.push(
                error(format!("`{name}` in {list} has not as many dependenciesKind as dependencies"))
                    .help("give one kind for each dependency, or leave dependenciesKind out"),
            );
        }
    }
    findings
}

/// A list has exactly those variables that it must.
fn same_set(
    description: &Description,
    list: &str,
    unknowns: &[Unknown],
    wanted: &dyn Fn(&Variable) -> bool,
    which: &str,
) -> Vec<Finding> {
    let listed: BTreeSet<usize> = unknowns.iter().map(|unknown| unknown.index).collect();
    let mut findings = Vec::new();
    let rule = if list == "Outputs" { "structure.outputs" } else { "structure.initial" };
    let variables = || (1..).zip(&description.variables);
    let missing: Vec<(usize, &str)> = variables()
        .filter(|(index, variable)| wanted(variable) && !listed.contains(index))
        .map(|(index, variable)| (index, variable.name.as_str()))
        .collect();
    if !missing.is_empty() {
        let only: Vec<&str> = missing.iter().map(|(_, name)| *name).collect();
        let (first, line) = (missing[0].0, description.variables[missing[0].0 - 1].line);
        findings.push(
            Finding::error(rule, format!("ModelStructure/{list} lacks {}", names(&only))).line(line).help(
                format!("it lists every variable with {which}; add <Unknown index=\"{first}\"/> and so on"),
            ),
        );
    }
    let superfluous: Vec<&str> = variables()
        .filter(|(index, variable)| !wanted(variable) && listed.contains(index))
        .map(|(_, variable)| variable.name.as_str())
        .collect();
    if !superfluous.is_empty() {
        let message =
            format!("ModelStructure/{list} lists {}, which do not belong there", names(&superfluous));
        findings.push(
            Finding::error(rule, message).help(format!("it lists the variables with {which} and no others")),
        );
    }
    findings
}

fn derivatives(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let listed: BTreeSet<usize> = description.derivatives.iter().map(|unknown| unknown.index).collect();
    for unknown in &description.derivatives {
        if let Some(variable) = description.variable(unknown.index).filter(|it| it.derivative.is_none()) {
            let message =
                format!("Derivatives lists `{}`, which is no derivative of a variable", variable.name);
            findings.push(
                Finding::error("structure.derivatives", message)
                    .line(unknown.line)
                    .help("give the variable the attribute derivative=\"index of the state\""),
            );
        }
    }
    // A state may go by several names (aliases), and its derivative too: one of each is enough.
    let state = |variable: &Variable| description.variable(variable.derivative?)?.reference;
    let listed_states: BTreeSet<u32> =
        listed.iter().filter_map(|index| state(description.variable(*index)?)).collect();
    let missing: Vec<&str> = (1..)
        .zip(&description.variables)
        .filter(|(index, variable)| variable.derivative.is_some() && !listed.contains(index))
        .filter(|(_, variable)| !state(variable).is_some_and(|state| listed_states.contains(&state)))
        .map(|(_, variable)| variable.name.as_str())
        .collect();
    if !missing.is_empty() && description.interface(Kind::ModelExchange).is_some() {
        let message = format!("ModelStructure/Derivatives lacks {}", names(&missing));
        findings.push(
            Finding::warning("structure.derivatives", message)
                .help("importers take the number and order of the states from this list; leave out only what is no state"),
        );
    }
    findings
}

/// FMI 2.0.4, section 2.2.8: outputs and states with their derivatives that are calculated, calculated
/// parameters; by index.
fn initial_unknowns(description: &Description) -> Vec<Finding> {
    let mut states = BTreeSet::new();
    for unknown in &description.derivatives {
        states.insert(unknown.index);
        states.extend(description.variable(unknown.index).and_then(|variable| variable.derivative));
    }
    let lines: BTreeSet<u32> = states
        .iter()
        .filter_map(|index| description.variable(*index))
        .map(|variable| variable.line)
        .collect();
    let wanted = |variable: &Variable| {
        let calculated = matches!(variable.effective_initial(), Some("calculated" | "approx"));
        let role = variable.causality == "output" || lines.contains(&variable.line);
        variable.causality == "calculatedParameter" || (role && calculated)
    };
    let which = "causality=\"calculatedParameter\", and the outputs, states and derivatives that are calculated or approx";
    let list = &description.initial_unknowns;
    let mut findings = same_set(description, "InitialUnknowns", list, &wanted, which);
    if let Some(pair) = list.windows(2).find(|pair| pair[0].index > pair[1].index) {
        let (first, second) = (pair[0].index, pair[1].index);
        let message =
            format!("ModelStructure/InitialUnknowns is not in order: {first} stands before {second}");
        findings.push(
            Finding::error("structure.order", message).line(pair[1].line).help("sort the list by the index"),
        );
    }
    findings
}

fn dependencies(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let inputs = description.variables.iter().any(|variable| variable.causality == "input");
    let silent: Vec<&str> = description
        .outputs
        .iter()
        .filter(|unknown| unknown.dependencies.is_none())
        .filter_map(|unknown| Some(description.variable(unknown.index)?.name.as_str()))
        .collect();
    if inputs && !silent.is_empty() {
        let message = format!("what it depends on is not told for {}", names(&silent));
        findings.push(
            Finding::warning("structure.dependencies", message)
                .line(description.outputs[0].line)
                .help("tools then take each output to depend on every input, and find algebraic loops that are none")
                .help("give `dependencies`; an empty list says that an output depends on no input"),
        );
    }
    findings
}
