//! The same for programs.

use serde_json::{Map, Value as Json, json};
use strut_model::{Initial, Interface, Value, Variable, VariableKind};

use super::related;
use crate::fmu::Fmu;
use crate::plan::Plan;
use crate::system::System;

/// An FMU.
pub fn fmu(plan: &Plan, fmu: &Fmu, interface: &Interface) -> String {
    let about = fmu.entry.about;
    let experiment = about.experiment;
    let (sets, systems) = related(plan, &fmu.name, about.name);
    let set = fmu.set.as_ref().map(|set| {
        let values = set.parsed.values.iter().map(|(name, given)| {
            let facts = json!({
                "value": value(&given.value), "unit": given.unit, "source": given.source,
                "assumed": given.assumed,
            });
            (name.clone(), facts)
        });
        json!({
            "title": set.parsed.title, "source": set.parsed.source, "files": set.parsed.files,
            "values": values.collect::<Map<_, _>>(),
        })
    });
    let equations = about.equations.iter().map(|it| json!({"text": it.text, "source": it.source}));
    let facts = json!({
        "name": fmu.name, "kind": about.kind.name(), "title": fmu.title(),
        "model": about.name, "summary": about.summary, "guid": interface.guid(), "states": interface.states,
        "equations": equations.collect::<Vec<_>>(), "notes": about.notes,
        "experiment": {"stop": experiment.stop, "step": experiment.step, "tolerance": experiment.tolerance},
        "variables": interface.variables.iter().map(|it| variable(it, interface)).collect::<Vec<_>>(),
        "parameter_set": set, "other_parameter_sets": sets, "systems": systems,
    });
    format!("{facts:#}\n")
}

fn variable(variable: &Variable, interface: &Interface) -> Json {
    let mut facts = json!({
        "name": variable.name, "reference": variable.reference, "description": variable.doc,
        "causality": variable.causality.name(), "variability": variable.variability.name(),
        "initial": variable.initial.map(Initial::name),
    });
    let more = match &variable.kind {
        VariableKind::Real { unit, start, min, max, nominal, derivative_of } => json!({
            "type": "Real", "unit": unit.symbol, "start": start, "min": min, "max": max, "nominal": nominal,
            "derivative_of": derivative_of.map(|position| &interface.variables[position].name),
        }),
        VariableKind::Integer { start } => json!({"type": "Integer", "start": start}),
        VariableKind::Boolean { start } => json!({"type": "Boolean", "start": start}),
        VariableKind::Text { start } => json!({"type": "String", "start": start}),
        VariableKind::Choice { enumeration, start } => {
            let items = enumeration.items.iter().map(|(name, doc)| json!({"name": name, "description": doc}));
            json!({"type": "Enumeration", "start": start, "items": items.collect::<Vec<_>>()})
        }
    };
    if let (Json::Object(facts), Json::Object(more)) = (&mut facts, more) {
        facts.extend(more);
    }
    facts
}

fn value(value: &Value) -> Json {
    match value {
        Value::Real(value) => json!(value),
        Value::Integer(value) => json!(value),
        Value::Boolean(value) => json!(value),
        Value::Text(value) => json!(value),
    }
}

/// A system.
pub fn system(system: &System) -> String {
    let parameters = system.settings().0.into_iter().map(|setting| {
        let name = format!("{}.{}", setting.port.component, setting.port.variable);
        (name, json!({"value": value(&setting.value), "unit": setting.unit}))
    });
    let components = system.components.iter().map(|(name, part)| (name.clone(), json!(part.to_string())));
    let connections: Vec<String> = system.ends().map(|(from, to)| format!("{from} -> {to}")).collect();
    let facts = json!({
        "name": system.name, "kind": "system", "title": system.title, "source": system.source,
        "components": components.collect::<Map<_, _>>(), "connections": connections, "outputs": system.outputs,
        "experiment": {"stop": system.experiment.stop, "step": system.experiment.step},
        "parameters": parameters.collect::<Map<_, _>>(),
    });
    format!("{facts:#}\n")
}
