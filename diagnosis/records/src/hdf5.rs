//! Records from HDF5, MATLAB's MAT-files of version 7.3 among them.
//!
//! Numeric datasets of one dimension (n, n×1 or 1×n) and the columns of matrices, by their names, and those in groups, which are
//! MATLAB's structs. An attribute `unit` or `units` is the unit. Text, and what MATLAB keeps under `#refs#`, are left out.

use super::DataError;
use super::table::Table;
use super::vectors::{self, Vector};
use hdf5_reader::group::Group;
use hdf5_reader::messages::datatype::Datatype;
use hdf5_reader::{Dataset, Hdf5File};

/// Groups in groups that are followed.
const DEEPEST: usize = 8;
/// Attributes that hold a unit.
const UNITS: [&str; 2] = ["unit", "units"];
/// Classes of MATLAB's arrays that hold numbers.
const NUMERIC: [&str; 11] =
    ["double", "single", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "logical"];

/// Whether a file's contents are HDF5. MATLAB writes a header of its own before it.
pub(crate) fn is_hdf5(bytes: &[u8]) -> bool {
    [0, 512].iter().any(|&at| bytes.get(at..at + 8) == Some(b"\x89HDF\r\n\x1a\n"))
}

/// Columns of an HDF5 file.
pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Table, DataError> {
    let damaged = |error: hdf5_reader::error::Error| {
        DataError::file(file, format!("cannot be read as HDF5: {error}; copy or record it again"))
    };
    let root = Hdf5File::from_bytes(bytes).and_then(|it| it.root_group()).map_err(damaged)?;
    let mut vectors = Vec::new();
    walk(&root, &mut Vec::new(), &mut vectors).map_err(damaged)?;
    vectors::table(file, vectors)
}

/// Adds the vectors of a group and of those in it.
fn walk(
    group: &Group,
    path: &mut Vec<String>,
    vectors: &mut Vec<Vector>,
) -> Result<(), hdf5_reader::error::Error> {
    let (groups, datasets) = group.members()?;
    for dataset in datasets {
        if let Some(values) = numbers(&dataset)? {
            let own = dataset.name().rsplit('/').next().unwrap_or_default().to_owned();
            let path: Vec<String> = path.iter().cloned().chain([own]).collect();
            let unit = UNITS.iter().find_map(|name| text(&dataset, name)).unwrap_or_default();
            vectors.extend(columns(&dataset, &path, &unit, values));
        }
    }
    for inner in groups {
        let name = inner.name().rsplit('/').next().unwrap_or_default().to_owned();
        if path.len() < DEEPEST && !name.starts_with('#') {
            path.push(name);
            walk(&inner, path, vectors)?;
            path.pop();
        }
    }
    Ok(())
}

/// An attribute's text.
fn text(dataset: &Dataset, name: &str) -> Option<String> {
    dataset.attribute(name).ok()?.read_string().ok().map(|it| it.trim_matches(['\0', ' ']).to_owned())
}

/// The columns of a dataset. MATLAB stores a matrix transposed, so that its numbers stand column after column here, too.
fn columns(dataset: &Dataset, path: &[String], unit: &str, values: Vec<f64>) -> Vec<Vector> {
    let size = |place: usize| dataset.shape().get(place).map_or(1, |it| *it as usize);
    let (outer, inner) = (size(0), size(1));
    if dataset.attribute("MATLAB_class").is_ok() {
        return vectors::of_matrix(path, unit, [inner, outer], values);
    }
    let column_by_column = (0..inner).flat_map(|column| values.iter().skip(column).step_by(inner).copied());
    vectors::of_matrix(path, unit, [outer, inner], column_by_column.collect())
}

/// A dataset's numbers; none if it has more than two dimensions, is a scalar, or not of real numbers.
fn numbers(dataset: &Dataset) -> Result<Option<Vec<f64>>, hdf5_reader::error::Error> {
    let shape = dataset.shape();
    let is_narrow = shape.len() < 2 || shape.iter().min().is_some_and(|it| *it <= vectors::WIDEST as u64);
    let is_table = shape.len() <= 2 && is_narrow && shape.iter().any(|length| *length != 1);
    let class = text(dataset, "MATLAB_class");
    let is_empty = dataset.attribute("MATLAB_empty").is_ok();
    if !is_table || is_empty || class.is_some_and(|class| !NUMERIC.contains(&&*class)) {
        return Ok(None);
    }
    macro_rules! read {
        ($type:ty) => {
            dataset.read_array::<$type>()?.iter().map(|value| *value as f64).collect()
        };
    }
    Ok(Some(match dataset.dtype() {
        Datatype::FloatingPoint { size: 4, .. } => read!(f32),
        Datatype::FloatingPoint { size: 8, .. } => read!(f64),
        Datatype::FixedPoint { size: 1, signed: true, .. } => read!(i8),
        Datatype::FixedPoint { size: 2, signed: true, .. } => read!(i16),
        Datatype::FixedPoint { size: 4, signed: true, .. } => read!(i32),
        Datatype::FixedPoint { size: 8, signed: true, .. } => read!(i64),
        Datatype::FixedPoint { size: 1, .. } => read!(u8),
        Datatype::FixedPoint { size: 2, .. } => read!(u16),
        Datatype::FixedPoint { size: 4, .. } => read!(u32),
        Datatype::FixedPoint { size: 8, .. } => read!(u64),
        _ => return Ok(None),
    }))
}

#[cfg(test)]
mod tests;
