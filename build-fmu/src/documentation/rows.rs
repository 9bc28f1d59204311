//! The rows of a table of variables, for the terminal, an FMU's page and the book. An array is one row.

use strut_model::{Causality, Given, Interface, ParameterSet, Value, Variability, Variable, VariableKind};

use super::tables::{number, printed};

/// The tables of an FMU's variables, in order.
pub const TABLES: [(&str, Causality); 5] = [
    ("Inputs", Causality::Input),
    ("Outputs", Causality::Output),
    ("Further states", Causality::Local),
    ("Parameters", Causality::Parameter),
    ("Calculated parameters", Causality::CalculatedParameter),
];

/// A variable, or an array of them, as one reads it.
pub struct Row {
    /// The name; `profile[1 … 21]` for an array.
    pub name: String,
    /// The start value; empty where there is none. All of an array's, if they differ.
    pub start: String,
    /// The unit; empty for settings.
    pub unit: String,
    /// The bounds; empty where there are none.
    pub range: String,
    /// What it is.
    pub doc: String,
    /// The items of an enumeration, with what they mean.
    pub items: Vec<(&'static str, &'static str)>,
}

/// The rows of a role. Rates of change of states are left out.
pub fn of(interface: &Interface, causality: Causality) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut position = 0;
    while let Some(variable) = interface.variables.get(position) {
        let table = interface.tables.iter().find(|table| table.first == position);
        let len = table.map_or(1, |table| table.len);
        if variable.causality == causality && !is_rate(variable) {
            let elements = &interface.variables[position..position + len];
            let (name, doc) = table.map_or_else(
                || (variable.name.clone(), &variable.doc),
                |table| (format!("{}[1 … {len}]", table.name), &table.doc),
            );
            rows.push(row(name, doc, elements));
        }
        position += len;
    }
    rows
}

fn row(name: String, doc: &str, elements: &[Variable]) -> Row {
    let first = &elements[0];
    let mut starts: Vec<String> = elements.iter().map(start).collect();
    if starts.iter().all(|start| *start == starts[0]) {
        starts.truncate(1);
    }
    let mut doc = doc.to_owned();
    // Most parameters are tunable: the others say so.
    if first.causality == Causality::Parameter && first.variability == Variability::Fixed {
        doc.push_str(" (fixed at initialisation)");
    }
    let (unit, items) = match &first.kind {
        VariableKind::Real { unit, .. } => (printed(&unit.symbol), Vec::new()),
        VariableKind::Choice { enumeration, .. } => (String::new(), enumeration.items.to_vec()),
        _ => (String::new(), Vec::new()),
    };
    Row { name, start: starts.join(", "), unit, range: range(first), doc, items }
}

/// Whether it is the rate of change of a state.
pub fn is_rate(variable: &Variable) -> bool {
    matches!(variable.kind, VariableKind::Real { derivative_of: Some(_), .. })
}

fn start(variable: &Variable) -> String {
    match &variable.kind {
        VariableKind::Real { start, .. } => start.map(number).unwrap_or_default(),
        VariableKind::Integer { start } => start.to_string(),
        VariableKind::Boolean { start } => start.to_string(),
        VariableKind::Text { start } => start.clone(),
        VariableKind::Choice { enumeration, start } => {
            let index = usize::try_from(start - 1).ok();
            let item = index.and_then(|index| enumeration.items.get(index));
            item.map(|(name, _)| (*name).to_owned()).unwrap_or_default()
        }
    }
}

fn range(variable: &Variable) -> String {
    match variable.kind {
        VariableKind::Real { min: Some(min), max: Some(max), .. } => {
            format!("{} … {}", number(min), number(max))
        }
        VariableKind::Real { min: Some(min), .. } => format!("≥ {}", number(min)),
        VariableKind::Real { max: Some(max), .. } => format!("≤ {}", number(max)),
        _ => String::new(),
    }
}

/// A value that a parameter set gives.
pub struct GivenRow<'a> {
    /// The name; `profile[1 … 21]` for an array whose values have one source.
    pub name: String,
    /// The value, or the values of the array.
    pub value: String,
    /// The unit.
    pub unit: String,
    /// Page, table or equation.
    pub source: &'a str,
    /// Whether it is chosen because the source does not give it.
    pub assumed: bool,
}

/// The values of a parameter set in the order of the model's variables, which groups what belongs together.
pub fn given<'a>(interface: &Interface, set: &'a ParameterSet) -> Vec<GivenRow<'a>> {
    let mut rows: Vec<GivenRow> = Vec::new();
    let mut position = 0;
    while position < interface.variables.len() {
        let table = interface.tables.iter().find(|table| table.first == position);
        let elements = &interface.variables[position..position + table.map_or(1, |table| table.len)];
        position += elements.len();
        let values: Vec<_> = elements.iter().filter_map(|it| Some((it, set.values.get(&it.name)?))).collect();
        let origin = |given: &'a Given| (&given.source, given.assumed, &given.unit);
        let alike = values.windows(2).all(|pair| origin(pair[0].1) == origin(pair[1].1));
        let mut add = |name: String, values: &[(&Variable, &'a Given)]| {
            let first = values[0].1;
            let value = values.iter().map(|(_, given)| value(&given.value)).collect::<Vec<_>>().join(", ");
            let unit = first.unit.as_deref().map(printed).unwrap_or_default();
            rows.push(GivenRow { name, value, unit, source: &first.source, assumed: first.assumed });
        };
        match table {
            Some(table) if alike && values.len() == table.len => {
                add(format!("{}[1 … {}]", table.name, table.len), &values);
            }
            _ => values.iter().for_each(|it| add(it.0.name.clone(), std::slice::from_ref(it))),
        }
    }
    rows
}

/// A value as one reads it.
pub fn value(value: &Value) -> String {
    match value {
        Value::Real(value) => number(*value),
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
        Value::Text(value) => value.clone(),
    }
}
