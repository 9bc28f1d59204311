//! Measured records: reading, mapping to the model's names and units, checking, even sampling.
//!
//! A record goes through [`read`] (CSV, MDF4, MATLAB), [`map::Map::apply`] (the model's names, SI units),
//! [`check::check`] (what is wrong with it) and [`uniform::uniform`] (evenly spaced times).

mod bytes;
pub mod check;
pub mod csv;
pub mod error;
mod formula;
mod interpolate;
pub mod map;
mod matlab;
mod mdf4;
mod noise;
mod quantity;
pub mod table;
mod timestamp;
pub mod uniform;
pub mod units;

use std::fs;
use std::path::{Path, PathBuf};

pub use error::DataError;
pub use table::TimeColumn;

/// A measurement: channels over common times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The file's name without its folder.
    pub name: String,
    /// Times of the samples in seconds, as the file has them.
    pub time: Vec<f64>,
    /// The channels, in the file's order.
    pub channels: Vec<Channel>,
}

/// One measured signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: the file's, or after mapping the model's.
    pub name: String,
    /// Its unit's symbol: the file's, or after mapping the model's.
    pub unit: String,
    /// One value for each time; NaN where the sample is missing.
    pub values: Vec<f64>,
}

impl Channel {
    /// Name and unit, as a header has them.
    pub(crate) fn title(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }

    /// Whether somebody means it by a name: its own, or as a header has it, with the unit in brackets.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        name == self.name || csv::title(name.trim()) == (self.name.as_str(), self.unit.as_str())
    }
}

/// Where a record comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A file: CSV, ASAM MDF 4 or MATLAB 5 to 7.
    File(PathBuf),
    /// A table in memory.
    Columns {
        /// Its name.
        name: String,
        /// All columns, the time among them.
        columns: Vec<Channel>,
    },
}

impl Origin {
    /// A table in memory of columns with titles such as `force [N]`.
    ///
    /// # Errors
    /// If there are no samples, the columns are of several lengths, or a title is empty or there twice.
    pub fn of_columns(name: &str, columns: Vec<(String, Vec<f64>)>) -> Result<Self, DataError> {
        let count = columns.first().map_or(0, |(_, values)| values.len());
        if count == 0 {
            return Err(DataError::file(name, "has no samples"));
        }
        let mut all: Vec<Channel> = Vec::with_capacity(columns.len());
        for (header, values) in columns {
            let (title, unit) = csv::title(header.trim());
            if title.is_empty() {
                return Err(DataError::file(name, "a column has no name: write one, such as `force [N]`"));
            }
            if all.iter().any(|column| column.name == title && column.unit == unit) {
                return Err(DataError::signal(name, title, "is there twice: rename one of the columns"));
            }
            if values.len() != count {
                let text = format!("has {} samples, the first column {count}", values.len());
                return Err(DataError::signal(name, title, text));
            }
            all.push(Channel { name: title.into(), unit: unit.into(), values });
        }
        Ok(Self::Columns { name: name.into(), columns: all })
    }

    /// The file's name without its folder, or the table's.
    pub fn name(&self) -> String {
        match self {
            Self::File(path) => {
                let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
                name.unwrap_or_else(|| path.display().to_string())
            }
            Self::Columns { name, .. } => name.clone(),
        }
    }

    /// The record, with the column that holds the time if it is not named so.
    ///
    /// # Errors
    /// As [`read_with`].
    pub fn read(&self, time: Option<&TimeColumn>) -> Result<Record, DataError> {
        match self {
            Self::File(path) => read_with(path, time),
            Self::Columns { name, columns } => {
                let table = table::Table { name: name.clone(), columns: columns.clone(), master: None };
                table.into_record(time)
            }
        }
    }
}

/// Reads a record: CSV, ASAM MDF 4 or MATLAB 5 to 7, told apart by the first bytes.
///
/// # Errors
/// The file cannot be read, is damaged, or has no column of time: the message says what to do.
pub fn read(path: &Path) -> Result<Record, DataError> {
    read_with(path, None)
}

/// Like [`read`], with the column that holds the time if the file does not name it so.
///
/// # Errors
/// As [`read`]; and the column does not exist, or its unit is not one of time.
pub fn read_with(path: &Path, time: Option<&TimeColumn>) -> Result<Record, DataError> {
    let shown = path.display().to_string();
    let bytes = fs::read(path).map_err(|source| DataError::Io { file: shown.clone(), source })?;
    let name = path.file_name().map_or(shown, |name| name.to_string_lossy().into_owned());
    parse(&name, &bytes, time)
}

/// Reads a record from a file's contents; `name` is the file's.
///
/// # Errors
/// As [`read_with`].
pub fn parse(name: &str, bytes: &[u8], time: Option<&TimeColumn>) -> Result<Record, DataError> {
    let table = if bytes.starts_with(mdf4::MAGIC) || bytes.starts_with(mdf4::UNFINISHED) {
        mdf4::parse(name, bytes)?
    } else if matlab::is_matlab(bytes) {
        matlab::parse(name, bytes)?
    } else {
        csv::parse(name, bytes)?
    };
    table.into_record(time)
}
