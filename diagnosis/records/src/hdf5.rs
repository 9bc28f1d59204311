//! Records from HDF5, MATLAB's MAT-files of version 7.3 among them.
//!
//! Numeric datasets of one dimension (n, n×1 or 1×n) and the columns of matrices, by their names, and those in groups, which are
//! MATLAB's structs. An attribute `unit` or `units` is the unit. What else is there is listed as not read, but for single values and
//! what MATLAB keeps for itself under `#refs#`.

use super::DataError;
use super::table::Table;
use super::vectors::{self, Contents};
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
    let mut contents = Contents::default();
    walk(&root, &mut Vec::new(), &mut contents).map_err(damaged)?;
    contents.into_table(file)
}

/// Adds what is in a group and in those in it.
fn walk(
    group: &Group,
    path: &mut Vec<String>,
    contents: &mut Contents,
) -> Result<(), hdf5_reader::error::Error> {
    let (groups, datasets) = group.members()?;
    for dataset in datasets {
        let own = dataset.name().rsplit('/').next().unwrap_or_default().to_owned();
        let path: Vec<String> = path.iter().cloned().chain([own]).collect();
        match numbers(&dataset)? {
            Numbers::Found(values) => {
                let unit = UNITS.iter().find_map(|name| text(&dataset, name)).unwrap_or_default();
                let (sizes, values) = by_columns(&dataset, values);
                contents.add(&path, &unit, sizes, values);
            }
            Numbers::Single => (),
            Numbers::Other(why) => contents.leave_out(&path, why),
        }
    }
    for inner in groups {
        let name = inner.name().rsplit('/').next().unwrap_or_default().to_owned();
        if path.len() < DEEPEST && !name.starts_with('#') {
            path.push(name);
            walk(&inner, path, contents)?;
            path.pop();
        } else if !name.starts_with('#') {
            let all: Vec<String> = path.iter().cloned().chain([name]).collect();
            contents.leave_out(&all, "a group in too many others");
        }
    }
    Ok(())
}

/// An attribute's text.
fn text(dataset: &Dataset, name: &str) -> Option<String> {
    dataset.attribute(name).ok()?.read_string().ok().map(|it| it.trim_matches(['\0', ' ']).to_owned())
}

/// Rows and columns of a dataset, and its numbers column after column. MATLAB stores a matrix transposed, so that they stand so.
fn by_columns(dataset: &Dataset, values: Vec<f64>) -> ([usize; 2], Vec<f64>) {
    let size = |place: usize| dataset.shape().get(place).map_or(1, |it| *it as usize);
    let (outer, inner) = (size(0), size(1));
    if dataset.attribute("MATLAB_class").is_ok() {
        return ([inner, outer], values);
    }
    let column_by_column = (0..inner).flat_map(|column| values.iter().skip(column).step_by(inner).copied());
    ([outer, inner], column_by_column.collect())
}

/// What a dataset has.
enum Numbers {
    /// Real numbers in one or two dimensions.
    Found(Vec<f64>),
    /// One value, or none.
    Single,
    /// Something else: why it is no signal.
    Other(String),
}

fn numbers(dataset: &Dataset) -> Result<Numbers, hdf5_reader::error::Error> {
    let shape = dataset.shape();
    let other = |why: &str| Ok(Numbers::Other(why.to_owned()));
    if dataset.attribute("MATLAB_empty").is_ok() {
        return Ok(Numbers::Single);
    }
    match text(dataset, "MATLAB_class") {
        Some(class) if class == "char" => return other("text"),
        Some(class) if class == "cell" => return other("a cell array: save its vectors by themselves"),
        Some(class) if !NUMERIC.contains(&&*class) => return other(vectors::OBJECT),
        _ => (),
    }
    if shape.iter().product::<u64>() <= 1 {
        return Ok(Numbers::Single);
    }
    let why = match *shape {
        [rows, columns] => vectors::too_wide([rows as usize, columns as usize]),
        [_] => None,
        _ => Some(format!("an array of {} dimensions", shape.len())),
    };
    if let Some(why) = why {
        return Ok(Numbers::Other(why));
    }
    macro_rules! read {
        ($type:ty) => {
            dataset.read_array::<$type>()?.iter().map(|value| *value as f64).collect()
        };
    }
    Ok(Numbers::Found(match dataset.dtype() {
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
        _ => return other("text or numbers of another kind"),
    }))
}

#[cfg(test)]
mod tests;
