//! From declarations to elements.

use strut_model::{
    Enumeration, Initial, Interface, LOG_CATEGORIES, Variable, VariableKind,
    unit::{Base, OwnedUnit},
};

use crate::{
    Header,
    schema::{
        About, BaseUnit, Capabilities, Category, Choice, CoSimulation, Common, Document, Experiment, Item,
        Kind, List, ModelExchange, ModelStructure, Real, ScalarVariable, SimpleType, Start, Unit, Unknown,
    },
};

/// What the FMUs of Strut can, in both interfaces.
const CAPABILITIES: Capabilities =
    Capabilities { only_once: false, own_memory: true, state: true, serializes: true, directional: true };

/// The whole document.
pub fn document(interface: &Interface, header: &Header<'_>) -> Document {
    Document {
        fmi_version: "2.0",
        model_name: header.name.into(),
        guid: interface.guid(),
        about: about(interface, header),
        event_indicators: interface.event_indicators,
        model_exchange: ModelExchange {
            identifier: header.name.into(),
            completed_step_not_needed: true,
            common: CAPABILITIES,
        },
        co_simulation: CoSimulation {
            identifier: header.name.into(),
            variable_step: true,
            interpolates_inputs: true,
            output_derivatives: 1,
            common: CAPABILITIES,
        },
        units: units(&interface.variables, &[]),
        types: types(&interface.variables),
        log_categories: log_categories(),
        experiment: experiment(interface.about.experiment),
        variables: interface.variables.iter().map(variable).collect(),
        structure: structure(interface),
    }
}

/// What either version says of an FMU as a whole.
pub fn about(interface: &Interface, header: &Header<'_>) -> About {
    About {
        description: if header.description.is_empty() { interface.about.summary } else { header.description }
            .into(),
        author: header.author.into(),
        version: header.version.into(),
        copyright: header.copyright.into(),
        license: header.license.into(),
        generation_tool: header.generation_tool.into(),
        generated: header.generated.map(str::to_owned),
        naming: "structured",
    }
}

/// The categories of log messages.
pub fn log_categories() -> List<Category> {
    LOG_CATEGORIES.iter().map(|&(name, description)| Category { name, description }).collect()
}

/// The experiment that tools propose.
pub fn experiment(experiment: strut_model::Experiment) -> Experiment {
    Experiment {
        start: number(0.0),
        stop: number(experiment.stop),
        tolerance: number(experiment.tolerance),
        step: number(experiment.step),
    }
}

/// The shortest text that reads back as the same number.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// The units that are used, and others, sorted by name. `1` is declared like any other: a variable without a unit
/// would be one whose unit nobody knows, and a unit that is used but not declared is refused by some
/// importers.
pub fn units(variables: &[Variable], others: &[OwnedUnit]) -> List<Unit> {
    let mut used: Vec<&OwnedUnit> = variables
        .iter()
        .filter_map(|variable| match &variable.kind {
            VariableKind::Real { unit, .. } if !unit.symbol.is_empty() => Some(unit),
            _ => None,
        })
        .chain(others)
        .collect();
    used.sort_by(|a, b| a.symbol.cmp(&b.symbol));
    used.dedup_by(|a, b| a.symbol == b.symbol);
    used.into_iter()
        .map(|OwnedUnit { symbol, base, factor, offset }| {
            let other = |value: f64, default: f64| (value != default).then(|| number(value));
            let (factor, offset) = (other(*factor, 1.0), other(*offset, 0.0));
            let base = base.map(|Base { kg, m, s, a, k, mol, cd, rad }| BaseUnit {
                kg,
                m,
                s,
                a,
                k,
                mol,
                cd,
                rad,
                factor,
                offset,
            });
            Unit { name: symbol.to_string(), base }
        })
        .collect()
}

/// The enumerations that are used, in order of appearance, with their items.
pub fn enumerations(variables: &[Variable]) -> Vec<(Enumeration, Vec<Item>)> {
    let mut used: Vec<Enumeration> = Vec::new();
    for variable in variables {
        if let VariableKind::Choice { enumeration, .. } = variable.kind
            && !used.iter().any(|other| other.name == enumeration.name)
        {
            used.push(enumeration);
        }
    }
    used.into_iter()
        .map(|enumeration| {
            let items = (1..).zip(enumeration.items);
            let item = |(value, &(name, description))| Item { name, value, description };
            (enumeration, items.map(item).collect())
        })
        .collect()
}

fn types(variables: &[Variable]) -> List<SimpleType> {
    enumerations(variables)
        .into_iter()
        .map(|(Enumeration { name, doc, .. }, items)| SimpleType {
            name,
            description: doc,
            items: List { items },
        })
        .collect()
}

fn variable(variable: &Variable) -> ScalarVariable {
    let Common { name, reference, description, causality, variability, initial } =
        common(variable, variable.reference as usize);
    ScalarVariable {
        name,
        reference,
        description,
        causality,
        variability,
        initial,
        kind: kind(&variable.kind),
    }
}

/// What variables of every type say, with a reference.
pub fn common(variable: &Variable, reference: usize) -> Common {
    Common {
        name: variable.name.clone(),
        reference,
        description: variable.doc.clone(),
        causality: variable.causality.name(),
        variability: variable.variability.name(),
        initial: variable.initial.map(Initial::name),
    }
}

fn kind(kind: &VariableKind) -> Kind {
    match kind {
        VariableKind::Real { .. } => Kind::Real(real(kind)),
        VariableKind::Integer { start } => Kind::Integer(Start { start: *start }),
        VariableKind::Boolean { start } => Kind::Boolean(Start { start: *start }),
        VariableKind::Text { start } => Kind::String(Start { start: start.clone() }),
        VariableKind::Choice { enumeration, start } => Kind::Enumeration(choice(enumeration, *start)),
    }
}

/// What is said of a real variable, its derivative counted from one; nothing of another.
pub fn real(kind: &VariableKind) -> Real {
    let VariableKind::Real { unit, start, min, max, nominal, derivative_of } = kind else {
        return Real::default();
    };
    Real {
        unit: unit.symbol.to_string(),
        min: min.map(number),
        max: max.map(number),
        nominal: nominal.map(number),
        start: start.map(number),
        derivative: derivative_of.map(|position| position + 1),
    }
}

/// A choice among an enumeration's items.
pub fn choice(enumeration: &Enumeration, start: i32) -> Choice {
    Choice { declared_type: enumeration.name, min: 1, max: enumeration.items.len(), start }
}

fn structure(interface: &Interface) -> ModelStructure {
    let structure = &interface.structure;
    let list = |unknowns: &[(usize, Vec<usize>)]| -> List<Unknown> {
        let mut list: Vec<_> = unknowns.iter().map(unknown).collect();
        list.sort_by_key(|unknown| unknown.index);
        List { items: list }
    };
    ModelStructure {
        outputs: list(&structure.outputs),
        derivatives: list(&structure.derivatives),
        initial_unknowns: list(&structure.initial_unknowns),
    }
}

/// Positions count from zero, indices from one.
fn unknown((position, dependencies): &(usize, Vec<usize>)) -> Unknown {
    let mut indices: Vec<usize> = dependencies.iter().map(|position| position + 1).collect();
    indices.sort_unstable();
    let dependencies: Vec<String> = indices.into_iter().map(|index| index.to_string()).collect();
    Unknown { index: position + 1, dependencies: dependencies.join(" ") }
}
