//! Rules for the model structure: what is listed, in which order, and what depends on what.

use std::collections::{BTreeSet, HashMap, HashSet};

use crate::description::{Description, Kind, Unknown, Variable};
use crate::finding::{Finding, names};
use crate::rules::{Rule, fmi, practice};

/// What is wrong with it.
pub fn findings(description: &Description) -> Vec<Finding> {
    let lists = [
        ("Outputs", &description.outputs),
        ("Derivatives", &description.derivatives),
        ("InitialUnknowns", &description.initial_unknowns),
    ];
    let mut findings = Vec::new();
    let states: HashSet<usize> = description
        .derivatives
        .iter()
        .filter_map(|unknown| description.variable(unknown.index)?.derivative)
        .collect();
    for (name, list) in lists {
        findings.extend(entries(description, name, list));
        for unknown in list {
            findings.extend(of_unknown(description, name, unknown, &states));
        }
    }
    let outputs = |variable: &Variable| variable.causality == "output";
    let list = List { name: "Outputs", missing: fmi::OUTPUTS_MISSING, other: fmi::OUTPUTS_OTHER };
    findings.extend(same_set(
        description,
        &list,
        &description.outputs,
        [&outputs, &outputs],
        "causality=\"output\"",
    ));
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
        let error = |rule: &'static Rule, message: String| Finding::error(rule, message).line(unknown.line);
        let index = unknown.index;
        let Some(variable) = description.variable(index) else {
            let help = format!("indices count the variables, from 1 to {last}; they are no value references");
            let message = format!("{list} lists the variable {index}, which there is none of");
            findings.push(error(fmi::ENTRY_INDEX, message).help(help));
            continue;
        };
        let name = &variable.name;
        if !seen.insert(index) {
            findings.push(error(fmi::ENTRY_TWICE, format!("{list} lists `{name}` twice")));
        }
    }
    findings
}

/// What an unknown depends on, and how.
fn of_unknown(
    description: &Description,
    list: &str,
    unknown: &Unknown,
    states: &HashSet<usize>,
) -> Option<Finding> {
    let variable = description.variable(unknown.index)?;
    let (name, last) = (&variable.name, description.variables.len());
    let wrong = |rule: &'static Rule, message: String| Some(Finding::error(rule, message).line(unknown.line));
    // Importers pass over these; the Reference FMUs have some.
    let odd = |rule: &'static Rule, message: String| Some(Finding::warning(rule, message).line(unknown.line));
    let initially = list == "InitialUnknowns";
    if let Some(kinds) = &unknown.kinds {
        if Some(kinds.len()) != unknown.dependencies.as_ref().map(Vec::len) {
            let message = format!("`{name}` in {list} has not as many dependenciesKind as dependencies");
            let help = "give one kind for each dependency, or leave dependenciesKind out";
            return wrong(fmi::KINDS_NUMBER, message).map(|finding| finding.help(help));
        }
        if variable.kind != "Real" && kinds.iter().any(|kind| kind != "dependent") {
            let message =
                format!("`{name}` in {list} is {}, and has other kinds than dependent", variable.kind);
            return odd(fmi::KINDS_REAL, message);
        }
        let initial = ["dependent", "constant"];
        if let Some(kind) = kinds.iter().find(|kind| initially && !initial.contains(&kind.as_str())) {
            let message = format!("`{name}` in {list} has the dependenciesKind {kind}");
            let help = "at the initialisation there are only dependent and constant";
            return odd(fmi::KINDS_INITIAL, message).map(|finding| finding.help(help));
        }
    }
    let dependencies = unknown.dependencies.as_ref()?;
    if let Some(wrong_index) = dependencies.iter().find(|index| !(1..=last).contains(*index)) {
        let message = format!("`{name}` in {list} depends on variable {wrong_index}, which there is none of");
        let help = format!("indices count the variables, from 1 to {last}");
        return wrong(fmi::DEPENDENCIES_INDEX, message).map(|finding| finding.help(help));
    }
    if let Some(pair) = dependencies.windows(2).find(|pair| pair[0] >= pair[1]) {
        let message = format!("the dependencies of `{name}` in {list} have {} before {}", pair[0], pair[1]);
        let help = "they are ordered by index, and each stands there once";
        return wrong(fmi::DEPENDENCIES_ORDER, message).map(|finding| finding.help(help));
    }
    let known = |index: &&usize| {
        let Some(variable) = description.variable(**index) else { return true };
        // What FMI does not know at all is for the schema.
        let given =
            !matches!(variable.causality.as_str(), "parameter" | "calculatedParameter" | "output" | "local");
        let exact = initially && variable.effective_initial() == Some("exact");
        let state = !initially && (states.contains(*index) || is_tunable(variable));
        given || exact || state
    };
    let unknowns: Vec<&str> = dependencies
        .iter()
        .filter(|index| !known(index))
        .filter_map(|index| Some(description.variable(*index)?.name.as_str()))
        .collect();
    if unknowns.is_empty() {
        return None;
    }
    let message = format!("`{name}` in {list} depends on {}, which are no knowns", names(&unknowns));
    let help = if initially {
        "knowns are inputs, the independent variable, and exactly initialised variables"
    } else {
        "knowns are inputs, states, and the independent variable"
    };
    odd(fmi::DEPENDENCIES_KNOWN, message).map(|finding| finding.help(help))
}

/// The function that the standard gives for outputs and derivatives has tunable parameters in it, too.
fn is_tunable(variable: &Variable) -> bool {
    variable.causality == "parameter" && variable.variability == "tunable"
}

/// A list of the model structure, with the rules for missing and surplus entries.
struct List {
    name: &'static str,
    missing: &'static Rule,
    other: &'static Rule,
}

/// A list has all variables that it must have, and none that it may not.
fn same_set(
    description: &Description,
    List { name: list, missing: lacks, other }: &List,
    unknowns: &[Unknown],
    [wanted, allowed]: [&dyn Fn(&Variable) -> bool; 2],
    which: &str,
) -> Vec<Finding> {
    let listed: BTreeSet<usize> = unknowns.iter().map(|unknown| unknown.index).collect();
    let mut findings = Vec::new();
    let variables = || (1..).zip(&description.variables);
    let missing: Vec<(usize, &str)> = variables()
        .filter(|(index, variable)| wanted(variable) && !listed.contains(index))
        .map(|(index, variable)| (index, variable.name.as_str()))
        .collect();
    if !missing.is_empty() {
        let only: Vec<&str> = missing.iter().map(|(_, name)| *name).collect();
        let (first, line) = (missing[0].0, description.variables[missing[0].0 - 1].line);
        findings.push(
            Finding::error(lacks, format!("ModelStructure/{list} lacks {}", names(&only))).line(line).help(
                format!("it lists every variable with {which}; add <Unknown index=\"{first}\"/> and so on"),
            ),
        );
    }
    let superfluous: Vec<&str> = variables()
        .filter(|(index, variable)| !allowed(variable) && listed.contains(index))
        .map(|(_, variable)| variable.name.as_str())
        .collect();
    if !superfluous.is_empty() {
        let message =
            format!("ModelStructure/{list} lists {}, which do not belong there", names(&superfluous));
        findings.push(
            Finding::error(other, message).help(format!("it lists the variables with {which} and no others")),
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
                Finding::error(fmi::DERIVATIVES_ATTRIBUTE, message)
                    .line(unknown.line)
                    .help("give the variable the attribute derivative=\"index of the state\""),
            );
        }
    }
    findings.extend(states(description));
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
            Finding::warning(practice::DERIVATIVES_MISSING, message)
                .help("importers take the number and order of the states from this list; leave out only what is no state"),
        );
    }
    findings
}

/// Each state stands there once, and is one that can be a state.
fn states(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    // By what a state goes by: its reference.
    let mut seen: HashMap<u32, &str> = HashMap::new();
    let mut others = Vec::new();
    for unknown in &description.derivatives {
        let derivative = description.variable(unknown.index);
        let state = derivative.and_then(|it| description.variable(it.derivative?));
        let (Some(derivative), Some(state)) = (derivative, state) else { continue };
        let (name, of) = (&derivative.name, &state.name);
        if !matches!(state.causality.as_str(), "local" | "output") {
            others.push((of, state.line));
        }
        let Some(reference) = state.reference else { continue };
        if let Some(first) = seen.insert(reference, name).filter(|first| *first != name.as_str()) {
            let message = format!("`{first}` and `{name}` are both listed as the derivative of `{of}`");
            findings.push(Finding::error(fmi::DERIVATIVES_TWICE, message).line(unknown.line));
        }
    }
    if let Some((_, line)) = others.first() {
        let names = names(&others.iter().map(|(name, _)| *name).collect::<Vec<_>>());
        let message = format!("<Derivatives> makes states of what is neither local nor an output: {names}");
        let help = "a state is a local variable or an output";
        findings.push(Finding::error(fmi::DERIVATIVES_STATE, message).line(*line).help(help));
    }
    findings
}

/// FMI 2.0.5, section 2.2.8: outputs and states with their derivatives that are calculated, calculated
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
    let of = |variable: &Variable, states: bool| {
        let calculated = matches!(variable.effective_initial(), Some("calculated" | "approx"));
        let role = variable.causality == "output" || (states && lines.contains(&variable.line));
        variable.causality == "calculatedParameter" || (role && calculated)
    };
    // Without directional derivatives, co-simulation passes over <Derivatives>: its states may be listed, or not.
    let integrated = description.interfaces.iter().any(|interface| {
        interface.kind == Kind::ModelExchange || interface.can("providesDirectionalDerivative")
    });
    let wanted = |variable: &Variable| of(variable, integrated);
    let allowed = |variable: &Variable| of(variable, true);
    let which = "causality=\"calculatedParameter\", and the outputs, states and derivatives that are calculated or approx";
    let list = &description.initial_unknowns;
    let named = List { name: "InitialUnknowns", missing: fmi::INITIAL_MISSING, other: fmi::INITIAL_OTHER };
    let mut findings = same_set(description, &named, list, [&wanted, &allowed], which);
    if let Some(pair) = list.windows(2).find(|pair| pair[0].index > pair[1].index) {
        let (first, second) = (pair[0].index, pair[1].index);
        let message =
            format!("ModelStructure/InitialUnknowns is not in order: {first} stands before {second}");
        findings.push(
            Finding::error(fmi::INITIAL_ORDER, message).line(pair[1].line).help("sort the list by the index"),
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
            Finding::warning(practice::DEPENDENCIES, message)
                .line(description.outputs[0].line)
                .help("tools then take each output to depend on every input, and find algebraic loops that are none")
                .help("give `dependencies`; an empty list says that an output depends on no input"),
        );
    }
    findings
}
