//! Rules for each variable: its name, its role, its start value, its type and unit.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::description::{Description, Variable};
use crate::finding::{Finding, names};
use crate::names::{is_structured, place_in_array};
use crate::rules::{Rule, fmi, practice};
use crate::{aliases, derivatives};

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

/// What the schema knows of `variability`.
const VARIABILITIES: [&str; 5] = ["constant", "fixed", "tunable", "discrete", "continuous"];
/// And of `initial`.
const INITIALS: [&str; 3] = ["exact", "approx", "calculated"];

/// What is wrong with the variables.
pub fn findings(description: &Description) -> Vec<Finding> {
    let mut findings = unique_names(description);
    for variable in &description.variables {
        findings.extend(roles(variable));
        findings.extend(start(variable));
        findings.extend(declared_type(variable, description));
    }
    findings.extend(units(description));
    findings.extend(aliases::findings(description));
    findings.extend(derivatives::findings(description));
    findings.extend(arrays(description));
    findings.extend(together(description));
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
            findings.push(Finding::error(fmi::NAME_TWICE, message).line(variable.line));
        } else if let Some(other) = lower.insert(name.to_lowercase(), name) {
            let message = format!("`{name}` and `{other}` differ only in upper and lower case");
            let help = "legal, but tools that map names to files, tables or code without case mix them up";
            findings.push(Finding::warning(practice::NAME_CASE, message).line(variable.line).help(help));
        }
        if name.is_empty() {
            findings.push(Finding::error(fmi::NAME_EMPTY, "a variable has no name").line(variable.line));
        } else if description.structured && !is_structured(name) {
            let message = format!("`{name}` is no structured name, which this description says it has");
            findings.push(Finding::error(fmi::NAME_STRUCTURED, message).line(variable.line).help(
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
    let mut error = |rule: &'static Rule, message: String, help: &str| {
        findings.push(Finding::error(rule, message).line(*line).help(help));
    };
    let rows: Vec<_> = LEGAL.iter().filter(|(legal, ..)| legal == causality).collect();
    // What FMI does not know at all is for the schema.
    if rows.is_empty() || !VARIABILITIES.contains(&variability.as_str()) {
        return findings;
    }
    let Some((_, _, initials)) = rows.iter().find(|(_, legal, _)| legal.contains(&variability.as_str()))
    else {
        let legal: Vec<&str> = rows.iter().flat_map(|(_, legal, _)| *legal).copied().collect();
        let defaulted = "variability is \"continuous\" where it is not given";
        let help = format!("with this causality it is {}; {defaulted}", legal.join(" or "));
        let message = format!("`{name}` is {}, but its variability is \"{variability}\"", article(causality));
        error(fmi::VARIABILITY, message, &help);
        return findings;
    };
    if variable.kind != "Real" && !variable.kind.is_empty() && variability == "continuous" {
        let message = format!("`{name}` is of type {} and cannot be continuous", variable.kind);
        error(fmi::CONTINUOUS, message, "give it variability=\"discrete\"");
    }
    match variable.initial.as_deref() {
        Some(initial) if initials.is_empty() => {
            let message = format!("`{name}` is {} and cannot have initial=\"{initial}\"", article(causality));
            error(fmi::INITIAL, message, "leave `initial` out: the value is given from outside");
        }
        Some(initial) if !initials.contains(&initial) && INITIALS.contains(&initial) => {
            let message = format!(
                "`{name}` is {}, {variability}, and cannot have initial=\"{initial}\"",
                article(causality)
            );
            let help = format!("the standard's table allows {} here", initials.join(" or "));
            error(fmi::INITIAL, message, &help);
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
            findings.push(Finding::error(fmi::START_MISSING, message).line(*line));
        }
        Some(_) if variable.effective_initial() == Some("calculated") => {
            let message = format!("`{name}` has a start value although it is calculated");
            findings.push(
                Finding::error(fmi::START_SUPERFLUOUS, message)
                    .line(*line)
                    .help("leave `start` out, or give initial=\"exact\" or \"approx\""),
            );
        }
        Some(_) if variable.causality == "independent" => {
            let message = format!("`{name}` is independent and cannot have a start value");
            findings.push(Finding::error(fmi::START_SUPERFLUOUS, message).line(*line));
        }
        _ => {}
    }
    let text = variable.start.as_deref().map(str::trim);
    let (min, max) = (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
    if min > max {
        let message = format!("`{name}` has a min of {min} above its max of {max}");
        findings.push(Finding::error(fmi::BOUNDS, message).line(*line));
    } else if let Some(value) = text.and_then(|text| text.parse::<f64>().ok())
        && !(min..=max).contains(&value)
    {
        let message = format!("`{name}` starts at {value}, outside of its bounds from {min} to {max}");
        findings.push(Finding::error(fmi::BOUNDS_START, message).line(*line));
    }
    if variable.nominal == Some(0.0) {
        let message = format!("`{name}` has the nominal value 0, by which solvers divide");
        findings.push(Finding::warning(practice::NOMINAL, message).line(*line));
    }
    findings
}

fn declared_type(variable: &Variable, description: &Description) -> Vec<Finding> {
    let Variable { name, line, .. } = variable;
    let mut findings = Vec::new();
    if let Some(ty) = &variable.declared_type {
        match description.types.get(ty) {
            None => {
                let message =
                    format!("`{name}` is of the type `{ty}`, which <TypeDefinitions> does not have");
                let close = description.types.keys().max_by(|a, b| {
                    let like = |other: &str| strsim::jaro_winkler(ty, other);
                    like(a).total_cmp(&like(b))
                });
                let finding = Finding::error(fmi::TYPE_DECLARED, message).line(*line);
                findings.push(match close {
                    Some(close) => finding.help(format!("is `{close}` meant?")),
                    None => finding,
                });
            }
            Some(declared) if declared.kind != variable.kind => {
                let kind = &declared.kind;
                let message = format!("`{name}` is {}, but its type `{ty}` is {kind}", variable.kind);
                findings.push(Finding::error(fmi::TYPE_KIND, message).line(*line));
            }
            Some(declared) => {
                let start = variable.start.as_deref().and_then(|text| text.trim().parse::<i32>().ok());
                if let Some(start) =
                    start.filter(|it| variable.kind == "Enumeration" && !declared.items.contains(it))
                {
                    let message = format!("`{name}` starts at {start}, which is no item of its type `{ty}`");
                    findings.push(Finding::error(fmi::ENUMERATION_ITEM, message).line(*line));
                }
            }
        }
    }
    if let (Some(shown), None) = (&variable.display_unit, &variable.unit) {
        let message = format!("`{name}` has the displayUnit `{shown}`, but no unit");
        findings.push(Finding::error(fmi::DISPLAY_UNIT, message).line(*line));
    }
    findings
}

/// Each unit is declared. An undeclared one is one finding, with its variables.
fn units(description: &Description) -> Vec<Finding> {
    let declared: HashSet<&str> = description.units.iter().map(|unit| unit.symbol.as_str()).collect();
    let mut others: BTreeMap<&str, Vec<&Variable>> = BTreeMap::new();
    for variable in &description.variables {
        if let Some(unit) = variable.unit.as_deref().filter(|unit| !declared.contains(unit)) {
            others.entry(unit).or_default().push(variable);
        }
    }
    let finding = |(unit, variables): (&str, Vec<&Variable>)| {
        let all: Vec<&str> = variables.iter().map(|variable| variable.name.as_str()).collect();
        let message = format!("the unit `{unit}` of {} is not declared in <UnitDefinitions>", names(&all));
        Finding::error(fmi::UNIT_DECLARED, message)
            .line(variables[0].line)
            .help("declare it with its <BaseUnit>, or a tool cannot convert it")
    };
    others.into_iter().map(finding).collect()
}

/// The elements of an array stand one after another, those of the last index first.
fn arrays(description: &Description) -> Option<Finding> {
    // Where each array's last element stands, and its indices.
    let mut last: HashMap<String, (usize, Vec<u32>)> = HashMap::new();
    for (place, variable) in description.variables.iter().enumerate().filter(|_| description.structured) {
        let Some((array, indices)) = place_in_array(&variable.name) else { continue };
        let before = last.insert(array, (place, indices.clone()));
        let Some((before, previous)) = before.filter(|(_, previous)| *previous != indices) else { continue };
        if before + 1 != place || previous > indices {
            let message = format!("the elements of an array are not in order: `{}`", variable.name);
            let help = "they stand one after another, as [1,1], [1,2], [2,1]; or the names are \"flat\"";
            // One is enough: another order is the same throughout.
            return Some(Finding::warning(fmi::NAME_ARRAY, message).line(variable.line).help(help));
        }
    }
    None
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
        findings.push(Finding::note(practice::UNIT_MISSING, message).help(
            "with units, tools find a metre that is connected to a millimetre; write \"1\" for a pure number",
        ));
    }
    let pure = listed(&|variable| variable.unit.as_deref() == Some("1"));
    if pure.len() > 1 && pure.len() == reals.len() {
        let message = format!("every real variable has the unit \"1\": {}", names(&pure));
        findings.push(
            Finding::note(practice::UNIT_MISSING, message)
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
        findings.push(Finding::note(practice::DESCRIPTION, message));
    }
    let times: Vec<&str> = description
        .variables
        .iter()
        .filter(|variable| variable.causality == "independent")
        .map(|variable| variable.name.as_str())
        .collect();
    let other = |variable: &&Variable| variable.causality == "independent" && variable.kind != "Real";
    if let Some(time) = description.variables.iter().find(other) {
        let message = format!("the independent variable `{}` is no Real", time.name);
        findings.push(Finding::error(fmi::INDEPENDENT_ONE, message).line(time.line));
    }
    if times.len() > 1 {
        let message = format!("there is more than one independent variable: {}", names(&times));
        findings.push(Finding::error(fmi::INDEPENDENT_ONE, message));
    }
    findings
}
