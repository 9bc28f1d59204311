//! Records on their way from Python and back: columns are bytes of doubles, as numpy has them.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use strut_diagnosis::data::Origin;

/// Title and values of each column.
pub type Columns = Vec<(String, PyBackedBytes)>;

/// A record: a table with its name, or a file.
#[derive(FromPyObject)]
pub enum Given {
    /// Name and columns.
    Table(String, Columns),
    /// A path.
    File(PathBuf),
}

impl Given {
    /// Where the diagnosis reads it.
    ///
    /// # Errors
    /// If columns have no titles or several lengths.
    pub fn origin(self) -> PyResult<Origin> {
        match self {
            Self::File(path) => Ok(Origin::File(path)),
            Self::Table(name, columns) => {
                let columns = columns.into_iter().map(|(title, values)| (title, floats(&values)));
                Origin::of_columns(&name, columns.collect())
                    .map_err(|error| PyValueError::new_err(error.to_string()))
            }
        }
    }
}

/// The doubles that bytes are.
pub fn floats(bytes: &[u8]) -> Vec<f64> {
    let eight = bytes.chunks_exact(size_of::<f64>());
    eight.map(|eight| f64::from_ne_bytes(eight.try_into().expect("eight bytes"))).collect()
}

/// The bytes of doubles.
pub fn bytes(py: Python<'_>, values: &[f64]) -> Py<PyBytes> {
    let all: Vec<u8> = values.iter().flat_map(|value| value.to_ne_bytes()).collect();
    PyBytes::new(py, &all).unbind()
}
