//! Trajectories against those of independent solvers (`tests/reference` of the repository).
//!
//! A case says itself what it is: which model, its parameters and settings, its inputs and how near it is to
//! be followed. Nothing here knows any model but by name.

use crate::common::{Case, Named, cases};
use strut_model::{Value, VariableKind};

/// The model as the case has it, initialised.
fn set_up(case: &Case) -> Named {
    let mut model = Named::new(case.text("fmu"));
    for (name, value) in case.json["settings"].as_object().into_iter().flatten() {
        let value = match (&model.variable(name).kind, value) {
            (VariableKind::Choice { enumeration, .. }, value) => {
                let index = enumeration.items.iter().position(|(item, _)| value == item);
                index.map(|index| Value::Integer(index as i32 + 1))
            }
            (VariableKind::Boolean { .. }, value) => value.as_bool().map(Value::Boolean),
            (VariableKind::Integer { .. }, value) => value.as_i64().map(|value| Value::Integer(value as i32)),
            (_, value) => value.as_str().map(|text| Value::Text(text.into())),
        };
        model.choose(name, value.unwrap_or_else(|| panic!("{}: no such value of {name}", case.name)));
    }
    for (name, value) in ["parameters", "changed", "start"].iter().flat_map(|key| case.numbers(key)) {
        model.start(&name, value);
    }
    model.initialize();
    model
}

/// The largest error of each column, relative to its scale.
fn errors(case: &Case) -> Vec<(String, f64)> {
    let mut model = set_up(case);
    let mut errors: Vec<(String, f64)> =
        case.columns[1..].iter().map(|column| (column.clone(), 0.0)).collect();
    let mut compare = |model: &mut Named, row: &[f64]| {
        for ((column, worst), expected) in errors.iter_mut().zip(&row[1..]) {
            let error = (model.get(column) - expected).abs() / case.scale(column);
            *worst = if error <= *worst { *worst } else { error };
        }
    };
    match case.json["step"].as_f64() {
        Some(step) => {
            let mut rows = case.rows.iter().peekable();
            for k in 0..=(case.number("stop") / step).round() as usize {
                let t = k as f64 * step;
                if k == 0 {
                    case.inputs(t).into_iter().for_each(|(name, value)| model.set(name, value));
                } else {
                    model.instance.step(t - step, step).unwrap();
                }
                if let Some(row) = rows.next_if(|row| (row[0] - t).abs() < 0.5 * step) {
                    compare(&mut model, row);
                }
                case.inputs(t).into_iter().for_each(|(name, value)| model.set(name, value));
            }
            assert_eq!(rows.next(), None, "{}: rows were left out", case.name);
        }
        // Functions of time: from row to row.
        None => {
            for row in &case.rows {
                let now = model.instance.time();
                if row[0] > now {
                    model.instance.step(now, row[0] - now).unwrap();
                }
                compare(&mut model, row);
            }
        }
    }
    errors
}

#[test]
fn models_follow_the_reference_solutions() {
    let mut failures = Vec::new();
    for case in ["single", "times"].iter().flat_map(|kind| cases(kind)) {
        let errors = errors(&case);
        let (column, worst) = errors.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        println!("{:40} {worst:.1e} ({column})", case.name);
        let bound = case.number("error");
        let far = errors.iter().filter(|(_, error)| error.is_nan() || *error >= bound);
        failures.extend(far.map(|(column, error)| format!("{}: {column} is off by {error:.1e}", case.name)));
    }
    assert!(failures.is_empty(), "relative to each signal's scale\n{}", failures.join("\n"));
}
