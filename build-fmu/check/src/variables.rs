//! Rules for the head of the description and for each variable.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::description::{Declared, Description, Variable};
use crate::finding::{Finding, names};
use crate::names::is_structured;

/// Legal combinations of causality, variability and initial (FMI 2.0.4, section 2.2.7, the two tables).
const LEGAL: &[(&str, &[&str], &[&str])] = &[
    ("parameter", &["fixed", "tunable"], &["exact"]),
    ("calculatedParameter", &["fixed", "tunable"], &["calculated", "approx"]),
    ("input", &["discrete", "continuous"], &[]),
    ("output", &["constant"], &["exact"]),
    ("output", &["discrete", "continuous"], &["calculated", "exact", "approx"]),
    ("local", &["constant"], &["exact"]),
    ("local", &["fixed", "tunable"], &["calculated", "approx"]),
    ("local", &["discrete", "continuous"], &["calculated", "exact", "approx"]),
    ("independent", &["continuous"], &[]),
];

/// What is wrong outside of the model structure.
pub fn findings(description: &Description) -> Vec<Finding> {
    let mut findings = head(description);
    findings.extend(declarations(description));
    findings.extend(unique_names(description));
    let units: HashSet<&str> = description.units.iter().map(|unit| unit.symbol.as_str()).collect();
    for variable in &description.variables {
        findings.extend(roles(variable));
        findings.extend(start(variable));
        findings.extend(type_and_unit(variable, description, &units));
        if let Some(index) = variable.derivative {
            findings.extend(derivative(variable, description.variable(index), index));
        }
    }
    findings.extend(references(description));
    findings.extend(together(description));
    findings
}

fn head(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    if description.guid.as_deref().unwrap_or_default().trim().is_empty() {
        findings.push(
            Finding::error("description.guid", "the guid is missing or empty").help(
                "without it nothing tells a library and a description apart that do not belong together",
            ),
        );
    }
    if description.interfaces.is_empty() {
        let message = "there is neither <CoSimulation> nor <ModelExchange>, so that no tool can run this";
        findings.push(Finding::error("description.interfaces", message));
    }
    for interface in &description.interfaces {
        let name = &interface.identifier;
        let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if name.is_empty() || !plain || name.starts_with(|c: char| c.is_ascii_digit()) {
            findings.push(
                Finding::error("description.identifier", format!("the modelIdentifier `{name}` is no identifier of C"))
                    .line(interface.line)
                    .help("use letters, digits and `_`: it is the library's file name and part of its functions' names"),
            );
        }
    }
    let experiment = description.experiment;
    if let (start, Some(stop)) = (experiment.start.unwrap_or(0.0), experiment.stop)
        && stop <= start
    {
        let message =
            format!("the default experiment stops at {stop} s, which is not after its start at {start} s");
        findings.push(Finding::warning("description.experiment", message).line(experiment.line));
    }
    for (name, value) in [("stepSize", experiment.step), ("tolerance", experiment.tolerance)] {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            let message = format!("the default experiment's {name} is {value}, but must be positive");
            findings.push(Finding::error("description.experiment", message).line(experiment.line));
        }
    }
    findings
}

/// What is declared by a name is declared once, and a factor is one that can be divided by.
fn declarations(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut seen: HashMap<(&str, &str, &str), u32> = HashMap::new();
    for Declared { what, within, name, factor, line } in &description.declared {
        let within_it = if within.is_empty() { String::new() } else { format!(" of `{within}`") };
        if let Some(first) = seen.insert((what, within, name), *line) {
            let message = format!("the {what} `{name}`{within_it} is declared twice; first in line {first}");
            findings.push(Finding::error("description.twice", message).line(*line));
        }
        let number = factor.as_ref().map(|text| text.trim().parse::<f64>());
        if let (Some(Ok(number)), Some(text)) = (number, factor)
            && !(number.is_finite() && number != 0.0)
        {
            let message = format!(
                "the {what} `{name}`{within_it} has the factor {text}, by which nothing can be converted"
            );
            findings.push(Finding::error("variables.unit", message).line(*line));
        }
    }
    findings
}

fn unique_names(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut seen: HashMap<&str, u32> = HashMap::new();
    let mut lower: HashMap<String, &str> = HashMap::new();
    for variable in &description.variables {
        let name = variable.name.as_str();
        if let Some(first) = seen.insert(name, variable.line) {
            let message =
                format!("there are two variables of the name `{name}`; the other is in line {first}");
            findings.push(Finding::error("variables.name", message).line(variable.line));
        } else if let Some(other) = lower.insert(name.to_lowercase(), name) {
            let message = format!("`{name}` and `{other}` differ only in upper and lower case");
            let help = "legal, but tools that map names to files, tables or code without case mix them up";
            findings.push(Finding::warning("variables.name", message).line(variable.line).help(help));
        }
        if name.is_empty() {
            findings.push(Finding::error("variables.name", "a variable has no name").line(variable.line));
        } else if description.structured && !is_structured(name) {
            let message = format!("`{name}` is no structured name, which this description says it has");
            findings.push(Finding::error("variables.name", message).line(variable.line).help(
                "write names like body.position[2] or der(body.position), quote other characters with '…', or declare \
                 variableNamingConvention=\"flat\"",
            ));
        }
    }
    findings
}

fn roles(variable: &Variable) -> Vec<Finding> {
    let Variable { name, causality, variability, line, .. } = variable;
    let mut findings = Vec::new();
    let mut error = |message: String, help: &str| {
        findings.push(Finding::error("variables.causality", message).line(*line).help(help));
    };
    let rows: Vec<_> = LEGAL.iter().filter(|(legal, ..)| legal == causality).collect();
    if rows.is_empty() {
        let known = "it is one of parameter, calculatedParameter, input, output, local, independent";
        error(format!("`{name}` has the causality \"{causality}\", which FMI 2.0 does not know"), known);
        return findings;
    }
    let Some((_, _, initials)) = rows.iter().find(|(_, legal, _)| legal.contains(&variability.as_str()))
    else {
        let legal: Vec<&str> = rows.iter().flat_map(|(_, legal, _)| *legal).copied().collect();
        let defaulted = "variability is \"continuous\" where it is not given";
        let help = format!("with this causality it is {}; {defaulted}", legal.join(" or "));
        error(format!("`{name}` is {}, but its variability is \"{variability}\"", article(causality)), &help);
        return findings;
    };
    if variable.kind != "Real" && !variable.kind.is_empty() && variability == "continuous" {
        let message = format!("`{name}` is of type {} and cannot be continuous", variable.kind);
        error(message, "give it variability=\"discrete\"");
    }
    match variable.initial.as_deref() {
        Some(initial) if initials.is_empty() => {
            let message = format!("`{name}` is {} and cannot have initial=\"{initial}\"", article(causality));
            error(message, "leave `initial` out: the value is given from outside");
        }
        Some(initial) if !initials.contains(&initial) => {
            let message = format!(
                "`{name}` is {}, {variability}, and cannot have initial=\"{initial}\"",
                article(causality)
            );
            error(message, &format!("the standard's table allows {} here", initials.join(" or ")));
        }
        _ => {}
    }
    findings
}

fn article(causality: &str) -> String {
    match causality {
        "local" | "independent" => causality.into(),
        "input" | "output" => format!("an {causality}"),
        other => format!("a {other}"),
    }
}

fn start(variable: &Variable) -> Vec<Finding> {
    let Variable { name, line, .. } = variable;
    let mut findings = Vec::new();
    let exact = matches!(variable.effective_initial(), Some("exact" | "approx"));
    let wanted = exact || variable.causality == "input";
    match &variable.start {
        None if wanted => {
            let why = match variable.causality.as_str() {
                "input" => "it is an input".to_owned(),
                _ => format!("initial is \"{}\"", variable.effective_initial().unwrap_or_default()),
            };
            let message = format!("`{name}` has no start value, which it must have since {why}");
            findings.push(Finding::error("variables.start", message).line(*line));
        }
        Some(_) if variable.effective_initial() == Some("calculated") => {
            let message = format!("`{name}` has a start value although it is calculated");
            findings.push(
                Finding::error("variables.start", message)
                    .line(*line)
                    .help("leave `start` out, or give initial=\"exact\" or \"approx\""),
            );
        }
        Some(_) if variable.causality == "independent" => {
            let message = format!("`{name}` is independent and cannot have a start value");
            findings.push(Finding::error("variables.start", message).line(*line));
        }
        _ => {}
    }
    let text = variable.start.as_deref().map(str::trim);
    let readable = text.is_none_or(|text| is_value(&variable.kind, text));
    if !readable {
        let value = text.unwrap_or_default();
        let message =
            format!("`{name}` starts at `{value}`, which is no value of the type {}", variable.kind);
        findings.push(Finding::error("variables.start", message).line(*line));
    }
    let (min, max) = (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
    if min > max {
        let message = format!("`{name}` has a min of {min} above its max of {max}");
        findings.push(Finding::error("variables.bounds", message).line(*line));
    } else if let Some(value) = text.and_then(|text| text.parse::<f64>().ok())
        && !(min..=max).contains(&value)
    {
        let message = format!("`{name}` starts at {value}, outside of its bounds from {min} to {max}");
        findings.push(Finding::error("variables.bounds", message).line(*line));
    }
    if variable.nominal == Some(0.0) {
        let message = format!("`{name}` has the nominal value 0, by which solvers divide");
        findings.push(Finding::error("variables.nominal", message).line(*line));
    }
    findings
}

/// Whether a text is a value of a type.
pub fn is_value(kind: &str, text: &str) -> bool {
    match kind {
        "Real" => text.trim().parse::<f64>().is_ok_and(f64::is_finite),
        "Integer" | "Enumeration" => text.trim().parse::<i32>().is_ok(),
        "Boolean" => matches!(text.trim(), "true" | "false" | "0" | "1"),
        _ => true,
    }
}

fn type_and_unit(variable: &Variable, description: &Description, units: &HashSet<&str>) -> Vec<Finding> {
    let Variable { name, line, .. } = variable;
    let mut findings = Vec::new();
    if variable.kind.is_empty() {
        let message = format!("`{name}` has no type: Real, Integer, Boolean, String or Enumeration");
        findings.push(Finding::error("variables.type", message).line(*line));
    }
    if variable.reference.is_none() {
        let message = format!("`{name}` has no valueReference, a number from 0 to 4294967295");
        findings.push(Finding::error("variables.reference", message).line(*line));
    }
    if let Some(ty) = &variable.declared_type {
        match description.types.get(ty) {
            None => {
                let message =
                    format!("`{name}` is of the type `{ty}`, which <TypeDefinitions> does not have");
                let close = description.types.keys().max_by(|a, b| {
                    let like = |other: &str| strsim::jaro_winkler(ty, other);
                    like(a).total_cmp(&like(b))
                });
                let finding = Finding::error("variables.type", message).line(*line);
                findings.push(match close {
                    Some(close) => finding.help(format!("is `{close}` meant?")),
                    None => finding,
                });
            }
            Some((kind, _)) if *kind != variable.kind => {
                let message = format!("`{name}` is {}, but its type `{ty}` is {kind}", variable.kind);
                findings.push(Finding::error("variables.type", message).line(*line));
            }
            Some(_) => {}
        }
    } else if variable.kind == "Enumeration" {
        let message =
            format!("`{name}` is an Enumeration without `declaredType`, so that its items have no names");
        findings.push(Finding::error("variables.type", message).line(*line));
    }
    if let Some(unit) = &variable.unit
        && !units.contains(unit.as_str())
    {
        let message = format!("the unit `{unit}` of `{name}` is not declared in <UnitDefinitions>");
        findings.push(
            Finding::error("variables.unit", message)
                .line(*line)
                .help("declare it with its <BaseUnit>, or a tool cannot convert it"),
        );
    }
    findings
}

fn derivative(variable: &Variable, state: Option<&Variable>, index: usize) -> Option<Finding> {
    let name = &variable.name;
    let finding = |message: String| Some(Finding::error("variables.derivative", message).line(variable.line));
    match state {
        None => finding(format!("`{name}` is the derivative of variable {index}, which there is none of")),
        Some(state) if std::ptr::eq(state, variable) => {
            finding(format!("`{name}` is the derivative of itself"))
        }
        Some(_) if variable.kind != "Real" || variable.variability != "continuous" => {
            finding(format!("`{name}` is a derivative, but no continuous Real"))
        }
        Some(state) if state.kind != "Real" || state.variability != "continuous" => finding(format!(
            "`{name}` is the derivative of `{}`, which is no continuous Real and cannot be a state",
            state.name
        )),
        Some(_) => None,
    }
}

/// Variables of one reference are aliases: one value under several names.
fn references(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut sets: BTreeMap<(&str, u32), Vec<&Variable>> = BTreeMap::new();
    for variable in &description.variables {
        if let Some(reference) = variable.reference {
            // An enumeration is read and written as an integer.
            let kind = if variable.kind == "Enumeration" { "Integer" } else { &variable.kind };
            sets.entry((kind, reference)).or_default().push(variable);
        }
    }
    for ((_, reference), set) in sets.into_iter().filter(|(_, set)| set.len() > 1) {
        let list: Vec<&str> = set.iter().map(|variable| variable.name.as_str()).collect();
        let line = set[1].line;
        let of = |wanted: &[&str]| set.iter().filter(|it| wanted.contains(&it.causality.as_str())).count();
        if set.iter().any(|variable| variable.unit != set[0].unit) {
            let message = format!("{} share the reference {reference}, but not the unit", names(&list));
            findings.push(Finding::error("variables.reference", message).line(line));
        }
        let constant = set.iter().all(|variable| variable.variability == "constant");
        let starts = set.iter().filter(|variable| variable.start.is_some()).count();
        if of(&["parameter", "input"]) > 1 || (starts > 1 && !constant) {
            let message = format!(
                "{} share the reference {reference}, but more than one of them is set from outside or has a start \
                 value",
                names(&list)
            );
            findings.push(Finding::error("variables.reference", message).line(line).help(
                "give each its own reference, or let one be the alias of the other, without a start value",
            ));
        }
    }
    findings
}

/// What concerns many variables is said once.
fn together(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let visible =
        |variable: &&Variable| matches!(variable.causality.as_str(), "input" | "output" | "parameter");
    let reals: Vec<&Variable> =
        description.variables.iter().filter(visible).filter(|variable| variable.kind == "Real").collect();
    let listed = |of: &dyn Fn(&Variable) -> bool| -> Vec<&str> {
        reals.iter().filter(|variable| of(variable)).map(|variable| variable.name.as_str()).collect()
    };
    let without = listed(&|variable| variable.unit.is_none());
    if !without.is_empty() {
        let message = format!("no unit is given for {}", names(&without));
        findings.push(Finding::note("variables.unit.missing", message).help(
            "with units, tools find a metre that is connected to a millimetre; write \"1\" for a pure number",
        ));
    }
    let pure = listed(&|variable| variable.unit.as_deref() == Some("1"));
    if pure.len() > 1 && pure.len() == reals.len() {
        let message = format!("every real variable has the unit \"1\": {}", names(&pure));
        findings.push(
            Finding::note("variables.unit.missing", message)
                .help("\"1\" says that a number has no unit; if it has one, give it"),
        );
    }
    let silent: Vec<&str> = description
        .variables
        .iter()
        .filter(visible)
        .filter(|variable| variable.description.as_deref().is_none_or(|text| text.trim().is_empty()))
        .map(|variable| variable.name.as_str())
        .collect();
    if !silent.is_empty() {
        let message = format!("no description is given for {}", names(&silent));
        findings.push(Finding::note("variables.description", message));
    }
    let times: Vec<&str> = description
        .variables
        .iter()
        .filter(|variable| variable.causality == "independent")
        .map(|variable| variable.name.as_str())
        .collect();
    if times.len() > 1 {
        let message = format!("there is more than one independent variable: {}", names(&times));
        findings.push(Finding::error("variables.causality", message));
    }
    findings
}
