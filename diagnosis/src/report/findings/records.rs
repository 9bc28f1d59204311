//! What was read of the records, and what is wrong with them.

use serde::Serialize;

/// How a record was read.
#[derive(Clone, Debug, Serialize)]
pub struct RecordRead {
    /// The file.
    pub record: String,
    /// Number of samples.
    pub samples: usize,
    /// From the first sample to the last, in seconds.
    pub seconds: f64,
    /// Samples per second, on average.
    pub rate: f64,
    /// Where the model's signals come from.
    pub columns: Vec<ColumnRead>,
    /// Columns that no signal comes from.
    pub unused: Vec<String>,
    /// Columns that were left out, with the reason.
    pub left_out: Vec<String>,
    /// What else there is to say about how it was read.
    pub notes: Vec<String>,
}

/// Where a signal of the model comes from.
#[derive(Clone, Debug, Serialize)]
pub struct ColumnRead {
    /// The model's name.
    pub signal: String,
    /// The file's column, or the formula of columns.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Whether the unit is assumed, because neither the file nor the map says one.
    pub unit_assumed: bool,
}
