//! Records from CSV and other tables of text: a row that names the columns, `name [unit]`, then one row for each sample.
//!
//! The separator is `;`, a tab, `,` or blanks. But for `,` the numbers may have a decimal comma. Lines that start with `#`
//! are comments. An empty cell, `NaN` or `NA` is a missing sample. Units may also stand in round brackets, or in a row of
//! their own below the names. A column of dates and times of day is one of seconds. Lines that a logger writes above the
//! names are passed over ([`layout`]), and so are names that come again between the samples; columns of text are left out,
//! with the place of the first text. Columns without names are called by their numbers: `column 1`.

mod layout;

use super::reading::Reading;
use super::table::Table;
use super::timestamp::{self, Timestamps};
use super::{Channel, DataError, Record, Unread};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use layout::Layout;
use std::borrow::Cow;
use std::io;

/// Columns of a CSV file's contents.
pub(crate) fn parse(file: &str, bytes: &[u8], reading: &Reading) -> Result<Table, DataError> {
    let text = decode(file, bytes)?;
    let layout = Layout::find(file, &text, reading.skip_rows)?;
    let mut columns = header(file, &layout)?;
    // Some machines write their names again every second, with other lines of text around them.
    let (mut between, mut left_out): (Vec<StringRecord>, usize) = (Vec::new(), 0);
    for row in rows(&text, layout.separator) {
        let row = row.map_err(|e| DataError::file(file, format!("not a table: {e}")))?;
        let is_blank = row.iter().all(|cell| cell.trim().is_empty());
        if layout::line(&row) < layout.first || is_comment(&row) || is_blank {
            continue;
        }
        if !layout.is_sample(&row) {
            between.push(row);
            continue;
        }
        left_out += add_rows(file, &layout, &mut between, &mut columns)?;
        add_row(file, layout::line(&row), layout.separator, &row, &mut columns)?;
    }
    left_out += add_rows(file, &layout, &mut between, &mut columns)?;
    let mut table = Table { name: file.to_owned(), ..Table::default() };
    if left_out > 0 {
        table.notes.push(format!("the names of the columns come again: {left_out} lines are left out"));
    }
    for Column { name, unit, values, why, .. } in columns {
        match why {
            Some(why) => table.unread.push(Unread { name, unit, why }),
            None => table.columns.push(Channel { name, unit, values }),
        }
    }
    Ok(table)
}

/// Writes a record as CSV that [`super::read`] reads back unchanged: time in seconds first, then the channels.
///
/// # Errors
/// What the sink reports.
pub fn write(record: &Record, sink: impl io::Write) -> io::Result<()> {
    let mut writer = WriterBuilder::new().from_writer(sink);
    writer.write_field("time [s]")?;
    writer.write_record(record.channels.iter().map(Channel::title))?;
    for (i, time) in record.time.iter().enumerate() {
        writer.write_field(time.to_string())?;
        writer.write_record(record.channels.iter().map(|channel| channel.values[i].to_string()))?;
    }
    writer.flush()
}

/// UTF-8 with or without mark, or else Latin-1, which old measuring programs write.
fn decode<'a>(file: &str, bytes: &'a [u8]) -> Result<Cow<'a, str>, DataError> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(DataError::file(file, "is UTF-16: save it as UTF-8"));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.iter().take(4096).any(|&byte| byte == 0) {
        let text = "is of no format known here: export it as CSV, .xlsx, ASAM MDF 4, .mat, HDF5 or Parquet";
        return Err(DataError::file(file, text));
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
    };
    // The reader of rows counts a line that ends in two characters late.
    Ok(if text.contains('\r') { Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n")) } else { text })
}

/// All rows that are not empty, comments included.
fn rows(text: &str, separator: u8) -> impl Iterator<Item = Result<StringRecord, csv::Error>> {
    let mut builder = ReaderBuilder::new();
    builder.has_headers(false).flexible(true);
    let (separated, blank) = match separator {
        b' ' => (None, Some(text)),
        separator => (Some(builder.delimiter(separator).from_reader(text.as_bytes()).into_records()), None),
    };
    let separated = separated.into_iter().flatten().map(|row| {
        row.map(|mut row| {
            // The reader puts a row where the empty lines before it begin.
            if let Some(mut position) = row.position().cloned() {
                let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
                let empty = text.as_bytes().get(from..).unwrap_or(&[]).iter().take_while(|it| **it == b'\n');
                position.set_line(position.line() + empty.count() as u64);
                row.set_position(Some(position));
            }
            row
        })
    });
    let blank = blank.into_iter().flat_map(|text| (1..).zip(text.lines())).filter_map(|(line, text)| {
        let mut row: StringRecord = text.split_whitespace().collect::<Vec<_>>().into();
        let mut position = csv::Position::new();
        position.set_line(line);
        row.set_position(Some(position));
        (!row.is_empty()).then_some(Ok(row))
    });
    separated.chain(blank)
}

/// Whether a row is a comment.
fn is_comment(row: &StringRecord) -> bool {
    row.get(0).is_some_and(|cell| cell.trim_start().starts_with('#'))
}

/// A column while it is read.
struct Column {
    name: String,
    unit: String,
    values: Vec<f64>,
    /// From the first row on: the instants that it holds in place of numbers.
    stamps: Option<Timestamps>,
    /// Why it is left out.
    why: Option<String>,
}

fn header(file: &str, layout: &Layout) -> Result<Vec<Column>, DataError> {
    let line = layout.names.position().map_or(1, csv::Position::line);
    let mut cells: Vec<&str> = layout.names.iter().map(str::trim).collect();
    // A separator at the end of each line is no column.
    if cells.len() > 1 && cells.last() == Some(&"") {
        cells.pop();
    }
    let mut columns: Vec<Column> = Vec::with_capacity(cells.len());
    for (i, cell) in cells.iter().enumerate() {
        let (name, mut unit) = title(cell);
        if let Some(below) = layout.units.as_ref().and_then(|units| units.get(i)) {
            unit = self::unit(below);
        }
        let name = if name.is_empty() { format!("column {}", i + 1) } else { name.into() };
        if columns.iter().any(|column| column.name == name && column.unit == unit) {
            let text = format!("a second column `{cell}`: rename one of them");
            return Err(DataError::Cell { file: file.into(), line, column: i + 1, text });
        }
        columns.push(Column { name, unit: unit.into(), values: Vec::new(), stamps: None, why: None });
    }
    Ok(columns)
}

/// Name and unit of `name [unit]` or `name (unit)`. A number in brackets right behind a name is its index: `outputs[1] [rad/s]`.
pub(super) fn title(cell: &str) -> (&str, &str) {
    let of_square = cell.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
    let of_round = cell.strip_suffix(')').and_then(|rest| rest.split_once('('));
    let is_index = |(name, unit): &(&str, &str)| {
        let number = !unit.is_empty() && unit.bytes().all(|it| it.is_ascii_digit() || it == b',');
        of_square.is_some() && number && name.ends_with(|it: char| it.is_alphanumeric() || it == '_')
    };
    let found = of_square.or(of_round).filter(|it| !is_index(it));
    found.map_or((cell, ""), |(name, unit)| (name.trim(), unit.trim()))
}

/// A unit in a row of units, in brackets or without.
fn unit(cell: &str) -> &str {
    cell.trim().trim_start_matches(['[', '(']).trim_end_matches([']', ')']).trim()
}

/// Adds rows that hold no sample, unless the names come again among them. How many are left out.
fn add_rows(
    file: &str,
    layout: &Layout,
    rows: &mut Vec<StringRecord>,
    columns: &mut [Column],
) -> Result<usize, DataError> {
    let rows = std::mem::take(rows);
    if rows.iter().any(|row| layout.is_names(row)) {
        return Ok(rows.len());
    }
    for row in &rows {
        add_row(file, layout::line(row), layout.separator, row, columns)?;
    }
    Ok(0)
}

fn add_row(
    file: &str,
    line: u64,
    separator: u8,
    row: &StringRecord,
    columns: &mut [Column],
) -> Result<(), DataError> {
    let surplus = row.len() == columns.len() + 1 && row[columns.len()].trim().is_empty();
    // Of columns that hold no numbers the last ones may be missing.
    let is_empty = |column: &Column| column.why.is_some() || column.values.iter().all(|it| it.is_nan());
    let short = columns.get(row.len()..).is_some_and(|left| !columns.is_empty() && left.iter().all(is_empty));
    if row.len() != columns.len() && !surplus && !short {
        let text = format!(
            "the row has {} cells, the header {}: complete the row, or delete it if recording stopped here",
            row.len(),
            columns.len()
        );
        return Err(DataError::Cell { file: file.into(), line, column: row.len().min(columns.len()), text });
    }
    for (column, cell) in columns.iter_mut().zip(row.iter().map(str::trim).chain(std::iter::repeat(""))) {
        if column.why.is_some() {
            continue;
        }
        if column.values.is_empty() {
            column.stamps = Timestamps::from(cell);
            if column.stamps.is_some() {
                column.unit = "s".into();
            }
        }
        let (value, wanted) = match &column.stamps {
            Some(stamps) => (stamps.seconds(cell), "a time as in the first row: write all in one way"),
            None if column.values.is_empty() => (number(cell, separator), "a number"),
            None => (number(cell, separator), "a number: leave missing samples empty"),
        };
        match value {
            Some(value) => column.values.push(value),
            None => {
                let shown: String = cell.chars().take(timestamp::SHOWN).collect();
                column.why = Some(format!("`{shown}` in line {line} is not {wanted}"));
                column.values = Vec::new();
            }
        }
    }
    Ok(())
}

/// A cell's number; NaN for a missing sample.
fn number(cell: &str, separator: u8) -> Option<f64> {
    if cell.is_empty() || ["NA", "N/A", "null"].contains(&cell) {
        return Some(f64::NAN);
    }
    cell.parse().ok().or_else(|| {
        let decimal_comma = separator != b',' && cell.matches(',').count() == 1 && !cell.contains('.');
        decimal_comma.then(|| cell.replace(',', ".").parse().ok()).flatten()
    })
}

#[cfg(test)]
mod tests;
