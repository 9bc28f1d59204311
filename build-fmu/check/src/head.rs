//! Rules for the head of the description: identity, interfaces, units, types, the default experiment.

use std::collections::HashSet;

use crate::declared;
use crate::description::{Description, Kind};
use crate::finding::{Finding, names};
use crate::rules::{fmi, practice};

/// What is wrong before the variables.
pub fn findings(description: &Description) -> Vec<Finding> {
    let mut findings = identity(description);
    findings.extend(interfaces(description));
    findings.extend(experiment(description));
    findings.extend(declared::findings(&description.declared));
    findings.extend(types(description));
    findings
}

fn identity(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    // That it is there at all is for the schema.
    if description.guid.as_ref().is_some_and(|guid| guid.trim().is_empty()) {
        findings.push(
            Finding::error(fmi::GUID, "the guid is empty")
                .help("without it an importer cannot reject a library of another description"),
        );
    }
    if let Some(date) = &description.date
        && date.contains('T')
        && !(date.len() == "2026-11-26T08:00:00Z".len() && date.ends_with('Z'))
    {
        let message = format!("generationDateAndTime is {date}");
        findings.push(
            Finding::note(fmi::DATE, message)
                .help("FMI wants it in UTC, without fractions: 2026-11-26T08:00:00Z"),
        );
    }
    findings
}

fn interfaces(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    if description.interfaces.is_empty() {
        let message = "there is neither <CoSimulation> nor <ModelExchange>, so that no tool can run this";
        findings.push(Finding::error(fmi::INTERFACES, message));
    }
    for (kind, name) in [(Kind::CoSimulation, "CoSimulation"), (Kind::ModelExchange, "ModelExchange")] {
        if let Some(second) = description.interfaces.iter().filter(|it| it.kind == kind).nth(1) {
            let message = format!("there is more than one <{name}>");
            findings.push(Finding::error(fmi::INTERFACES_TWICE, message).line(second.line));
        }
    }
    for interface in &description.interfaces {
        let name = &interface.identifier;
        let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if name.is_empty() || !plain || name.starts_with(|c: char| c.is_ascii_digit()) {
            let message = format!("the modelIdentifier `{name}` is no identifier of C");
            findings.push(Finding::error(fmi::IDENTIFIER, message).line(interface.line).help(
                "use letters, digits and `_`: it is the library's file name and part of its functions' names",
            ));
        }
        if interface.can("canSerializeFMUstate") && !interface.can("canGetAndSetFMUstate") {
            let message = "states can be serialized, but not saved: canGetAndSetFMUstate is not true";
            findings.push(Finding::error(fmi::SERIALIZES, message).line(interface.line));
        }
    }
    findings
}

fn experiment(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let experiment = description.experiment;
    if let (start, Some(stop)) = (experiment.start.unwrap_or(0.0), experiment.stop)
        && stop <= start
    {
        let message =
            format!("the default experiment stops at {stop} s, which is not after its start at {start} s");
        findings.push(Finding::warning(practice::EXPERIMENT, message).line(experiment.line));
    }
    for (name, value) in [("stepSize", experiment.step), ("tolerance", experiment.tolerance)] {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            let message = format!("the default experiment's {name} is {value}, but must be positive");
            findings.push(Finding::warning(practice::EXPERIMENT, message).line(experiment.line));
        }
    }
    findings
}

fn types(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let units: HashSet<&str> = description.units.iter().map(|unit| unit.symbol.as_str()).collect();
    for (name, ty) in &description.types {
        if let Some(unit) = ty.unit.as_ref().filter(|unit| !units.contains(unit.as_str())) {
            let message =
                format!("the unit `{unit}` of the type `{name}` is not declared in <UnitDefinitions>");
            findings.push(Finding::error(fmi::UNIT_DECLARED, message).line(ty.line));
        }
        if let (Some(shown), None) = (&ty.display_unit, &ty.unit) {
            let message = format!("the type `{name}` has the displayUnit `{shown}`, but no unit");
            findings.push(Finding::error(fmi::DISPLAY_UNIT, message).line(ty.line));
        }
        if let [Some(min), Some(max)] = ty.bounds
            && min > max
        {
            let message = format!("the type `{name}` has a min of {min} above its max of {max}");
            findings.push(Finding::error(fmi::BOUNDS, message).line(ty.line));
        }
    }
    let both: Vec<&str> = description
        .types
        .keys()
        .map(String::as_str)
        .filter(|name| description.named(name).is_some())
        .collect();
    if !both.is_empty() {
        let message = format!("types have the names of variables: {}", names(&both));
        let help = "tools whose types and variables share names cannot import both";
        findings.push(Finding::error(fmi::TYPE_NAME, message).help(help));
    }
    findings
}
