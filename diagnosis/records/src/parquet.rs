//! Records from Apache Parquet, as pandas, polars and DuckDB write it: columns of numbers and of instants.

use super::table::Table;
use super::{Channel, DataError, Unread, csv};
use bytes::Bytes;
use parquet::basic::{LogicalType, TimeUnit};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

/// Whether a file's contents are Parquet.
pub(crate) fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1")
}

/// A column while it is read.
struct Column {
    title: String,
    values: Vec<f64>,
    /// Nanoseconds of a unit of integers that are instants.
    instant: Option<i64>,
    /// The first instant, in nanoseconds.
    start: Option<i64>,
    why: Option<String>,
}

/// Columns of a Parquet file.
pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Table, DataError> {
    let damaged = |error: ParquetError| {
        DataError::file(file, format!("cannot be read as Parquet: {error}; copy or write it again"))
    };
    let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(damaged)?;
    let schema = reader.metadata().file_metadata().schema();
    let mut columns: Vec<Column> = schema
        .get_fields()
        .iter()
        .map(|field| Column {
            title: field.name().to_owned(),
            values: Vec::new(),
            instant: nanoseconds(field.get_basic_info().logical_type_ref()),
            start: None,
            why: None,
        })
        .collect();
    for row in reader.get_row_iter(None).map_err(damaged)? {
        let row = row.map_err(damaged)?;
        for (column, (_, field)) in columns.iter_mut().zip(row.get_column_iter()) {
            column.add(field);
        }
    }
    let mut table = Table { name: file.to_owned(), ..Table::default() };
    for (index, Column { title, values, start, why, .. }) in columns.into_iter().enumerate() {
        let (name, unit) = csv::title(title.trim());
        // pandas keeps an index of its own under such a name.
        let name = match name {
            "" | "__index_level_0__" => format!("column {}", index + 1),
            name => name.to_owned(),
        };
        let unit = if start.is_some() { "s" } else { unit }.to_owned();
        match why {
            Some(why) => table.unread.push(Unread { name, unit, why }),
            None => table.columns.push(Channel { name, unit, values }),
        }
    }
    Ok(table)
}

/// Nanoseconds of a unit of instants or durations; none of other numbers.
fn nanoseconds(kind: Option<&LogicalType>) -> Option<i64> {
    match kind? {
        LogicalType::Timestamp(it) => Some(per_unit(&it.unit)),
        LogicalType::Time(it) => Some(per_unit(&it.unit)),
        _ => None,
    }
}

fn per_unit(unit: &TimeUnit) -> i64 {
    match unit {
        TimeUnit::MILLIS => 1_000_000,
        TimeUnit::MICROS => 1_000,
        TimeUnit::NANOS => 1,
    }
}

impl Column {
    fn add(&mut self, field: &Field) {
        if self.why.is_some() {
            return;
        }
        let value = match *field {
            Field::Null => Some(f64::NAN),
            Field::Bool(it) => Some(f64::from(u8::from(it))),
            Field::Byte(it) => Some(it.into()),
            Field::Short(it) => Some(it.into()),
            Field::Int(it) => Some(self.integer(it.into())),
            Field::Long(it) => Some(self.integer(it)),
            Field::UByte(it) => Some(it.into()),
            Field::UShort(it) => Some(it.into()),
            Field::UInt(it) => Some(it.into()),
            Field::ULong(it) => Some(it as f64),
            Field::Float(it) => Some(it.into()),
            Field::Double(it) => Some(it),
            Field::TimestampMillis(it) | Field::TimestampMicros(it) | Field::TimeMicros(it) => {
                Some(self.integer(it))
            }
            Field::TimeMillis(it) => Some(self.integer(it.into())),
            _ => None,
        };
        match value {
            Some(value) => self.values.push(value),
            None => {
                self.why = Some(format!("row {} holds no number", self.values.len() + 1));
                self.values = Vec::new();
            }
        }
    }

    /// An integer; an instant in seconds from the first: seconds from some distant day would lose their last digits.
    fn integer(&mut self, value: i64) -> f64 {
        let Some(unit) = self.instant else { return value as f64 };
        let start = *self.start.get_or_insert(value);
        1e-9 * unit as f64 * value.wrapping_sub(start) as f64
    }
}

#[cfg(test)]
mod tests;
