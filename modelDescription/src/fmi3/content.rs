//! From declarations to elements.

use std::collections::{BTreeMap, BTreeSet};

use strut_model::{Initial, Interface, Numbering, Table, Variable, VariableKind, unit};

use super::schema::{
    self, Capabilities, Choice, CoSimulation, Dependent, Dimension, Document, Element, EnumerationItem,
    EnumerationType, Float64, Indicator, ModelExchange, Start, Text, TextStart, Type,
};
use crate::{
    Header,
    content::{about, choice, common, enumerations, experiment, log_categories, number, real, units},
    schema::{Common, List, Real},
};

/// The whole document.
pub fn document(interface: &Interface, header: &Header<'_>) -> Document {
    let capabilities = || Capabilities {
        identifier: header.name.into(),
        state: true,
        serializes: true,
        directional: true,
        adjoint: true,
    };
    let numbering = interface.numbering();
    Document {
        fmi_version: "3.0",
        model_name: header.name.into(),
        token: interface.guid(),
        about: about(interface, header),
        model_exchange: ModelExchange { common: capabilities() },
        co_simulation: CoSimulation {
            common: capabilities(),
            variable_step: true,
            output_derivatives: 1,
            returns_early: interface.sampled,
            event_mode: true,
        },
        // Time has a unit, too.
        units: units(&interface.variables, &[unit::S.into()]),
        types: enumerations(&interface.variables)
            .into_iter()
            .map(|(enumeration, items)| {
                Type::EnumerationType(EnumerationType {
                    name: enumeration.name,
                    description: enumeration.doc,
                    items: items.into_iter().map(EnumerationItem::Item).collect(),
                })
            })
            .collect(),
        log_categories: log_categories(),
        experiment: experiment(interface.about.experiment),
        variables: variables(interface, &numbering),
        structure: structure(interface, &numbering),
    }
}

/// Time, the declared variables, and the event indicators, which are variables in FMI 3.0. Those have no unit that a name
/// could be found for: each is a condition of some equation.
fn variables(interface: &Interface, numbering: &Numbering) -> List<schema::Variable> {
    let time = Common {
        name: "time".into(),
        reference: numbering.time as usize,
        description: "Time".into(),
        causality: "independent",
        variability: "continuous",
        initial: None,
    };
    let indicator = |index: usize| Common {
        name: format!("event_indicator[{}]", index + 1),
        reference: numbering.indicators as usize + index,
        description: format!(
            "Event indicator {}: the model has a kink or jump where it changes sign",
            index + 1
        ),
        causality: "local",
        variability: "continuous",
        initial: Some(Initial::Calculated.name()),
    };
    let tables: BTreeMap<usize, &Table> = interface.tables.iter().map(|table| (table.first, table)).collect();
    let plain = |common, unit: &str| {
        let real = Real { unit: unit.into(), ..Real::default() };
        schema::Variable::Float64(Float64 { common, real, dimension: None })
    };
    let declared = interface.variables.iter().enumerate().filter_map(|(position, variable)| {
        let part = numbering.lengths.get(position) == Some(&0);
        (!part).then(|| {
            let table = tables.get(&position).copied();
            declared(position, variable, table.map(|table| (table, &interface.variables[..])))
        })
    });
    [plain(time, unit::S.symbol)]
        .into_iter()
        .chain(declared)
        .chain((0..interface.event_indicators).map(|index| plain(indicator(index), "")))
        .collect()
}

/// A variable, or the array whose first element it is. The position in the list is the value reference.
fn declared(position: usize, variable: &Variable, array: Option<(&Table, &[Variable])>) -> schema::Variable {
    let mut common = common(variable, position);
    if let Some((table, _)) = array {
        (common.name, common.description) = (table.name.clone(), table.doc.clone());
    }
    match &variable.kind {
        VariableKind::Real { start, derivative_of, .. } => {
            let start = match array {
                None => start.map(number),
                Some((table, all)) => starts(&all[table.first..table.first + table.len]),
            };
            let real = Real { start, derivative: *derivative_of, ..real(&variable.kind) };
            let dimension = array.map(|(table, _)| Dimension { start: table.len });
            schema::Variable::Float64(Float64 { common, real, dimension })
        }
        VariableKind::Integer { start } => schema::Variable::Int32(Start { common, start: *start }),
        VariableKind::Boolean { start } => schema::Variable::Boolean(Start { common, start: *start }),
        VariableKind::Text { start } => {
            schema::Variable::String(Text { common, start: TextStart { value: start.clone() } })
        }
        VariableKind::Choice { enumeration, start } => {
            schema::Variable::Enumeration(Choice { common, choice: choice(enumeration, *start) })
        }
    }
}

/// The start values of an array's elements, if they have any.
fn starts(elements: &[Variable]) -> Option<String> {
    let start = |variable: &Variable| match variable.kind {
        VariableKind::Real { start, .. } => start.map(number),
        _ => None,
    };
    let starts: Option<Vec<String>> = elements.iter().map(start).collect();
    starts.map(|starts| starts.join(" "))
}

fn structure(interface: &Interface, numbering: &Numbering) -> List<Element> {
    let (structure, timely) = (&interface.structure, &interface.timely);
    // An element stands for its array.
    let mut references: Vec<usize> = (0..interface.variables.len()).collect();
    for table in &interface.tables {
        references[table.first..table.first + table.len].fill(table.first);
    }
    let list = |unknowns: &[(usize, Vec<usize>)], timely: &[usize]| -> Vec<Dependent> {
        let mut sets: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (unknown, dependencies) in unknowns {
            let set = sets.entry(references[*unknown]).or_default();
            set.extend(dependencies.iter().map(|known| references[*known]));
            if timely.contains(unknown) {
                set.insert(numbering.time as usize);
            }
        }
        let text = |set: BTreeSet<usize>| -> Vec<String> { set.iter().map(usize::to_string).collect() };
        sets.into_iter()
            .map(|(reference, set)| Dependent { reference, dependencies: text(set).join(" ") })
            .collect()
    };
    let outputs = list(&structure.outputs, &timely.running).into_iter().map(Element::Output);
    let derivatives = list(&structure.derivatives, &timely.running);
    let initial = list(&structure.initial_unknowns, &timely.initial);
    let first = numbering.indicators as usize;
    let indicators = (first..first + interface.event_indicators).map(|reference| Indicator { reference });
    outputs
        .chain(derivatives.into_iter().map(Element::ContinuousStateDerivative))
        .chain(initial.into_iter().map(Element::InitialUnknown))
        .chain(indicators.map(Element::EventIndicator))
        .collect()
}
