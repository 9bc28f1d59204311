//! Vectors of a file of many (MATLAB, HDF5): those that belong together are the columns of a table.

use super::table::{self, Table};
use super::{Channel, DataError};
use std::collections::BTreeMap;

/// Columns up to which a matrix holds signals: an image does not.
pub(super) const WIDEST: usize = 64;

/// A vector, with the names of the structs or groups that it is in before its own.
pub(super) struct Vector {
    pub path: Vec<String>,
    pub unit: String,
    pub values: Vec<f64>,
}

/// The columns of a matrix, or its rows if it is wider than high, as `To File` of Simulink saves them; of a vector its only one. They
/// are called `x column 2`. `values` has column after column, as MATLAB does.
pub(super) fn of_matrix(
    path: &[String],
    unit: &str,
    [rows, columns]: [usize; 2],
    values: Vec<f64>,
) -> Vec<Vector> {
    if rows == 1 || columns == 1 {
        return vec![Vector { path: path.to_vec(), unit: unit.to_owned(), values }];
    }
    let (kind, count) = if columns <= rows { ("column", columns) } else { ("row", rows) };
    let numbers = |index: usize| -> Vec<f64> {
        match kind {
            "column" => values.iter().skip(index * rows).take(rows).copied().collect(),
            _ => values.iter().skip(index).step_by(rows).copied().collect(),
        }
    };
    let of = |index: usize| {
        let mut path = path.to_vec();
        if let Some(own) = path.last_mut() {
            *own = format!("{own} {kind} {}", index + 1);
        }
        Vector { path, unit: unit.to_owned(), values: numbers(index) }
    };
    if count <= WIDEST { (0..count).map(of).collect() } else { Vec::new() }
}

/// The vectors as long as the time. Without a time, all of the length in which there are most samples: a matrix of gains has few. A
/// vector goes by its own name, unless another has it too.
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
        vectors.iter().for_each(|v| *counts.entry(v.values.len()).or_insert(0) += v.values.len());
        counts.into_iter().max_by_key(|&(length, samples)| (samples, length)).map(|(length, _)| length)
    });
    vectors.retain(|vector| Some(vector.values.len()) == length);
    if vectors.is_empty() {
        let text = "has no real numeric vectors or matrices: save time and signals as vectors, in MATLAB `save('run.mat', 't', \
                    'x')`; tables, timetables and cell arrays are not read";
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

#[cfg(test)]
mod tests {
    use super::*;

    fn named(sizes: [usize; 2], values: &[f64]) -> Vec<(String, Vec<f64>)> {
        let path = ["run".to_owned(), "x".to_owned()];
        let all = of_matrix(&path, "mm", sizes, values.to_vec());
        all.into_iter().map(|it| (it.path.join("."), it.values)).collect()
    }

    #[test]
    fn a_matrix_is_split_along_its_shorter_side() {
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let [first, second] = &named([3, 2], &values)[..] else { panic!("two columns") };
        assert_eq!(first, &("run.x column 1".to_owned(), vec![1.0, 2.0, 3.0]));
        assert_eq!(second, &("run.x column 2".to_owned(), vec![4.0, 5.0, 6.0]));
        let [first, second] = &named([2, 3], &values)[..] else { panic!("two rows") };
        assert_eq!(first, &("run.x row 1".to_owned(), vec![1.0, 3.0, 5.0]));
        assert_eq!(second, &("run.x row 2".to_owned(), vec![2.0, 4.0, 6.0]));
        assert_eq!(named([6, 1], &values), [("run.x".to_owned(), values.to_vec())]);
        assert_eq!(named([1, 6], &values), named([6, 1], &values));
    }

    #[test]
    fn a_matrix_of_gains_does_not_outvote_two_signals() {
        let vector = |name: &str, count: usize| Vector {
            path: vec![name.to_owned()],
            unit: String::new(),
            values: vec![1.0; count],
        };
        let gains = of_matrix(&["k".to_owned()], "", [4, 4], vec![0.0; 16]);
        let all = [vector("force", 500), vector("position", 500)].into_iter().chain(gains).collect();
        let names: Vec<String> =
            table("run.mat", all).unwrap().columns.into_iter().map(|it| it.name).collect();
        assert_eq!(names, ["force", "position"]);
    }

    #[test]
    fn an_image_holds_no_signals() {
        assert!(named([100, 80], &[0.0; 8000]).is_empty());
    }
}
