//! Vectors of a file of many (MATLAB, HDF5): those that belong together are the columns of a table.

use super::table::{self, Table};
use super::{Channel, DataError};
use std::collections::BTreeMap;

/// A vector, with the names of the structs or groups that it is in before its own.
pub(super) struct Vector {
    pub path: Vec<String>,
    pub unit: String,
    pub values: Vec<f64>,
}

/// The vectors as long as the time; without one, those of the length that most have. A vector goes by its own name, unless
/// another has it too.
///
/// # Errors
/// The file has no vectors, or two of one name.
pub(super) fn table(file: &str, mut vectors: Vec<Vector>) -> Result<Table, DataError> {
    let length = vectors
        .iter()
        .find(|v| table::is_time(v.path.last().map_or("", |name| name)))
        .map(|v| v.values.len());
    let length = length.or_else(|| {
        let mut counts = BTreeMap::new();
        vectors.iter().for_each(|v| *counts.entry(v.values.len()).or_insert(0) += 1);
        counts.into_iter().max_by_key(|&(length, count)| (count, length)).map(|(length, _)| length)
    });
    vectors.retain(|vector| Some(vector.values.len()) == length);
    if vectors.is_empty() {
        let text = "has no real numeric vectors: save time and signals as vectors, in MATLAB `save('run.mat', 't', 'x')`; \
                    tables, timetables and cell arrays are not read";
        return Err(DataError::file(file, text));
    }
    let names: Vec<String> = vectors
        .iter()
        .map(|vector| {
            let own = vector.path.last();
            let shared = vectors.iter().filter(|other| other.path.last() == own).count() > 1;
            if shared { vector.path.join(".") } else { own.cloned().unwrap_or_default() }
        })
        .collect();
    if let Some(i) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
        return Err(DataError::signal(file, &names[i], "two vectors have this name: rename one"));
    }
    let channel = |(name, vector): (String, Vector)| {
        let (title, unit) = super::csv::title(&name);
        let unit = if vector.unit.is_empty() { unit } else { &vector.unit };
        Channel { name: title.into(), unit: unit.into(), values: vector.values }
    };
    let columns = names.into_iter().zip(vectors).map(channel).collect();
    Ok(Table { name: file.to_owned(), columns, ..Table::default() })
}
