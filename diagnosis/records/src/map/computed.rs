//! Signals that a map computes from columns.

use super::{Record, Source, Wanted};
use crate::DataError;
use crate::formula::Formula;
use crate::quantity::Quantity;
use crate::table::did_you_mean;

/// The formula in place of a column's name; a name alone is a column that does not exist.
pub(super) fn read(record: &Record, name: &str, text: &str) -> Result<Formula, DataError> {
    let formula = Formula::parse(text);
    let problem = match formula {
        Ok(formula) if !matches!(formula, Formula::Column(_)) => return Ok(formula),
        Err(problem) if text.contains(['*', '+', '(', '{']) => {
            format!("the map takes `{name}` from it, but {problem}")
        }
        _ => {
            let hint = did_you_mean(text, record.channels.iter().map(|column| column.name.as_str()));
            format!("the map takes `{name}` from it, but there is no such column{hint}")
        }
    };
    Err(DataError::signal(&record.name, text, problem))
}

/// The column of a formula.
fn column(record: &Record, name: &str) -> Result<usize, String> {
    let of_the_name: Vec<usize> =
        (0..record.channels.len()).filter(|it| record.channels[*it].is_called(name)).collect();
    match of_the_name[..] {
        [index] => Ok(index),
        [] => {
            let hint = did_you_mean(name, record.channels.iter().map(|column| column.name.as_str()));
            Err(format!("it has the column `{name}`, and the file has none of that name{hint}"))
        }
        _ => Err(format!(
            "it has the column `{name}`, and the file has several: write it with its unit in braces"
        )),
    }
}

/// The columns of a formula, and its values in the model's unit, SI.
pub(super) fn values(
    record: &Record,
    formula: &Formula,
    source: &Source,
    wanted: &Wanted,
) -> Result<(Vec<usize>, Vec<f64>), DataError> {
    let problem =
        |text: String| DataError::signal(&record.name, &wanted.name, format!("its formula: {text}"));
    if source.unit.is_some() {
        return Err(problem(
            "its result has a unit of its own: leave out `unit`, or give `units` of its columns".into(),
        ));
    }
    let names = formula.columns();
    if let Some(other) = source.units.keys().find(|it| !names.contains(&it.as_str())) {
        let hint = did_you_mean(other, names.iter().copied());
        return Err(problem(format!("`units` has `{other}`, which is none of its columns{hint}")));
    }
    let columns = names.iter().map(|name| column(record, name)).collect::<Result<_, _>>().map_err(problem)?;
    let quantity = |name: &str| {
        let column = &record.channels[column(record, name)?];
        Quantity::new(&column.values, source.units.get(name).unwrap_or(&column.unit))
    };
    let found = formula.value(&quantity).map_err(problem)?;
    if !found.is_of(&wanted.unit).map_err(problem)? {
        let text = format!(
            "the result is in {}, and {} is wanted; a column without a unit is a number: give it in the map, \
             `units = {{ column = \"bar\" }}`",
            found.unit(),
            wanted.unit
        );
        return Err(problem(text));
    }
    let values = match found.values[..] {
        [one] => vec![one; record.time.len()],
        _ => found.values,
    };
    Ok((columns, values))
}
