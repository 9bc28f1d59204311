//! Vectors of a file of many (MATLAB, HDF5): those that belong together are the columns of a table.

use super::table::{self, Table};
use super::{Channel, DataError, Unread};
use std::collections::BTreeMap;

/// Columns up to which a matrix holds signals: an image does not.
const WIDEST: usize = 64;

/// Why an object of MATLAB's is not read.
pub(super) const OBJECT: &str = "an object, such as a table or timetable: save its columns as vectors";

/// A vector, with the names of the structs or groups that it is in before its own.
pub(super) struct Vector {
    pub path: Vec<String>,
    pub unit: String,
    pub values: Vec<f64>,
}

/// The contents of a file of many vectors: possible signals, and all else with the reason. Single numbers are left out without a word.
#[derive(Default)]
pub(super) struct Contents {
    vectors: Vec<Vector>,
    unread: Vec<Unread>,
}

impl Contents {
    /// Takes a matrix with its numbers column after column, as MATLAB has them.
    pub fn add(&mut self, path: &[String], unit: &str, [rows, columns]: [usize; 2], values: Vec<f64>) {
        match too_wide([rows, columns]) {
            Some(why) => self.leave_out(path, why),
            None => self.vectors.extend(of_matrix(path, unit, [rows, columns], values)),
        }
    }

    /// Says why something is not used.
    pub fn leave_out(&mut self, path: &[String], why: impl Into<String>) {
        self.unread.push(Unread { name: path.join("."), unit: String::new(), why: why.into() });
    }

    /// The vectors as long as the time. Without a time, all of the length in which there are most samples: a matrix of gains has few.
    ///
    /// # Errors
    /// The file has no vectors, or two of one name.
    pub fn into_table(self, file: &str) -> Result<Table, DataError> {
        let Self { vectors, mut unread } = self;
        let length = length(&vectors);
        let (vectors, others): (Vec<Vector>, Vec<Vector>) =
            vectors.into_iter().partition(|it| it.values.len() == length);
        let of_another = others.into_iter().map(|it| Unread {
            name: it.path.join("."),
            unit: it.unit,
            why: format!("{} values where the others have {length}", it.values.len()),
        });
        unread.extend(of_another);
        table(file, vectors, unread)
    }
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
    (0..count).map(of).collect()
}

/// Why a matrix of these sizes holds no signals, if it does not.
pub(super) fn too_wide([rows, columns]: [usize; 2]) -> Option<String> {
    (rows.min(columns) > WIDEST).then(|| format!("{rows} by {columns} values: more than {WIDEST} columns"))
}

/// Number of values of the time; without one, that in which there are most samples.
fn length(vectors: &[Vector]) -> usize {
    let is_time = |it: &&Vector| table::is_time(it.path.last().map_or("", |name| name));
    if let Some(time) = vectors.iter().find(is_time) {
        return time.values.len();
    }
    let mut counts = BTreeMap::new();
    vectors.iter().for_each(|it| *counts.entry(it.values.len()).or_insert(0) += it.values.len());
    let most = counts.into_iter().max_by_key(|&(length, samples)| (samples, length));
    most.map_or(0, |(length, _)| length)
}

/// A table of vectors of one length. A vector goes by its own name, unless another has it too.
fn table(file: &str, vectors: Vec<Vector>, unread: Vec<Unread>) -> Result<Table, DataError> {
    if vectors.is_empty() {
        let text = format!(
            "has no real numeric vectors or matrices: save time and signals as vectors, in MATLAB `save('run.mat', 't', 'x')`; \
             tables, timetables and cell arrays are not read{}",
            Unread::list(&unread)
        );
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
    Ok(Table { name: file.to_owned(), columns, unread, ..Table::default() })
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
        let mut contents =
            Contents { vectors: vec![vector("force", 500), vector("position", 500)], unread: Vec::new() };
        contents.add(&["k".to_owned()], "", [4, 4], vec![0.0; 16]);
        let table = contents.into_table("run.mat").unwrap();
        let names: Vec<String> = table.columns.into_iter().map(|it| it.name).collect();
        assert_eq!(names, ["force", "position"]);
        let gains: Vec<String> =
            table.unread.into_iter().map(|it| format!("{}: {}", it.name, it.why)).collect();
        assert_eq!(gains.len(), 4);
        assert_eq!(gains[0], "k column 1: 4 values where the others have 500");
    }

    #[test]
    fn an_image_holds_no_signals() {
        let mut contents = Contents::default();
        contents.add(&["image".to_owned()], "", [100, 80], vec![0.0; 8000]);
        assert!(contents.vectors.is_empty());
        assert_eq!(contents.unread[0].why, "100 by 80 values: more than 64 columns");
    }
}
