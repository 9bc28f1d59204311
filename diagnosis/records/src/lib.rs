//! Measured records: reading, mapping to the model's names and units, checking, even sampling.
//!
//! A record goes through [`read`] (CSV, spreadsheets, MDF4, MATLAB, HDF5, Parquet), [`map::Map::apply`] (the model's
//! names, SI units), [`check::check`] (what is wrong with it) and [`uniform::uniform`] (evenly spaced times).
//!
//! ```
//! use strut_records::{Reading, parse};
//!
//! let record = parse("lap.csv", b"time [s],force [N]\n0,1\n0.001,2\n", &Reading::default())?;
//! assert_eq!((record.channels[0].name.as_str(), record.channels[0].unit.as_str()), ("force", "N"));
//! # Ok::<(), strut_records::DataError>(())
//! ```

mod bytes;
pub mod check;
pub mod csv;
pub mod error;
mod formula;
mod hdf5;
mod interpolate;
pub mod map;
mod matlab;
mod mdf4;
mod noise;
mod parquet;
mod quantity;
pub mod reading;
pub mod repair;
mod spreadsheet;
pub mod table;
mod timestamp;
pub mod uniform;
pub mod units;
mod vectors;

use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

pub use error::DataError;
pub use reading::{Reading, TimeColumn};

/// A measurement: channels over common times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// The file's name without its folder.
    pub name: String,
    /// Times of the samples in seconds, as the file has them.
    pub time: Vec<f64>,
    /// The channels, in the file's order.
    pub channels: Vec<Channel>,
    /// Contents of the file that are not used, with the reason.
    pub unread: Vec<Unread>,
    /// What else there is to say about how the file was read.
    pub notes: Vec<String>,
    /// Whether neither the file nor the map says the unit of the time.
    pub seconds_assumed: bool,
}

/// Something in a file that is not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unread {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Why it cannot be used, and where.
    pub why: String,
}

/// Entries that a message lists before it counts the rest.
const LISTED: usize = 12;

impl Unread {
    /// The first of them for an error message; empty without any.
    pub(crate) fn list(all: &[Self]) -> String {
        let list = |it: &[Self]| {
            it.iter().map(|it| format!("{}: {}", it.name, it.why)).collect::<Vec<_>>().join("; ")
        };
        match all.len() {
            0 => String::new(),
            1..=LISTED => format!(" (left out: {})", list(all)),
            more => format!(" (left out: {}; and {} more)", list(&all[..LISTED]), more - LISTED),
        }
    }

    /// Whether somebody means it by a name, as [`Channel::is_called`].
    pub(crate) fn is_called(&self, name: &str) -> bool {
        is_called((&self.name, &self.unit), name)
    }
}

/// One measured signal.
#[derive(Clone, Debug, Default, PartialEq)]
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
    pub fn title(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }

    /// Whether somebody means it by a name: its own, or as a header has it, with the unit in brackets.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        is_called((&self.name, &self.unit), name)
    }
}

/// Whether a name is a column's, or as a header has it.
fn is_called(column: (&str, &str), name: &str) -> bool {
    name == column.0 || csv::title(name.trim()) == column
}

/// Where a record comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A file: see [`read`].
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

    /// The record, with what is known of the file beside it.
    ///
    /// # Errors
    /// As [`read`].
    pub fn read(&self, reading: &Reading) -> Result<Record, DataError> {
        match self {
            Self::File(path) => read(path, reading),
            Self::Columns { name, columns } => {
                let table =
                    table::Table { name: name.clone(), columns: columns.clone(), ..table::Table::default() };
                table.into_record(reading)
            }
        }
    }
}

/// Reads a record, with what is known of the file beside it: CSV, Excel or OpenDocument, ASAM MDF 4, MATLAB, HDF5 or
/// Parquet, told apart by the first bytes.
///
/// # Errors
/// The file cannot be read, is damaged, or has no column of time: the message says what to do. A column that is named as
/// the time does not exist, or its unit is not one of time.
pub fn read(path: &Path, reading: &Reading) -> Result<Record, DataError> {
    let shown = path.display().to_string();
    let bytes = fs::read(path).map_err(|source| DataError::Io { file: shown.clone(), source })?;
    let name = path.file_name().map_or(shown, |name| name.to_string_lossy().into_owned());
    parse(&name, &bytes, reading)
}

/// Reads a record from a file's contents; `name` is the file's.
///
/// # Errors
/// As [`read`].
pub fn parse(name: &str, bytes: &[u8], reading: &Reading) -> Result<Record, DataError> {
    // A damaged file may make a reader of others panic.
    let damaged = |_| DataError::file(name, "is damaged: its reader gave up; export it again, or as CSV");
    catch_unwind(|| table(name, bytes, reading)).map_err(damaged)??.into_record(reading)
}

/// The columns of a file, whatever its format.
fn table(name: &str, bytes: &[u8], reading: &Reading) -> Result<table::Table, DataError> {
    if bytes.starts_with(mdf4::MAGIC) || bytes.starts_with(mdf4::UNFINISHED) {
        mdf4::parse(name, bytes)
    } else if matlab::is_matlab(bytes) {
        matlab::parse(name, bytes)
    } else if matlab::version4::is_matlab_4(bytes) {
        matlab::version4::parse(name, bytes)
    } else if hdf5::is_hdf5(bytes) {
        hdf5::parse(name, bytes)
    } else if parquet::is_parquet(bytes) {
        parquet::parse(name, bytes)
    } else if spreadsheet::is_spreadsheet(bytes) {
        spreadsheet::parse(name, bytes, reading)
    } else {
        csv::parse(name, bytes, reading)
    }
}
