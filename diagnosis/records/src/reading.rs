//! How a file is read where it does not say so itself.

use serde::Deserialize;

/// What a user says about files as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The column of time, if it is not named so.
    pub time: Option<TimeColumn>,
    /// Samples per second, of files without a column of time.
    pub rate: Option<f64>,
    /// Lines above the row that names the columns, of text and spreadsheets; otherwise that row is looked for.
    pub skip_rows: Option<usize>,
    /// The sheet of a spreadsheet; otherwise the first with a table.
    pub sheet: Option<String>,
}

/// Which column holds the time, for files that do not say so.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeColumn {
    /// The column's name in the file.
    pub column: String,
    /// Its unit instead of the file's; seconds if neither says.
    pub unit: Option<String>,
}

impl Reading {
    /// With what the command line says in place of a map.
    #[must_use]
    pub fn or(self, rate: Option<f64>, skip_rows: Option<usize>) -> Self {
        Self { rate: rate.or(self.rate), skip_rows: skip_rows.or(self.skip_rows), ..self }
    }
}
