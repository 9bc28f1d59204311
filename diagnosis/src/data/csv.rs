//! Records from CSV: one header row `name [unit]`, then one row for each sample.
//!
//! The separator is `,`, `;` or a tab, found from the header. With `;` or tabs the numbers may have a decimal
//! comma. Lines that start with `#` are comments. An empty cell, `NaN` or `NA` is a missing sample.
//! Units may also stand in round brackets, or in a row of their own below the names. A column of dates and times of
//! day is one of seconds.

use super::table::Table;
use super::timestamp::Timestamps;
use super::{Channel, DataError, Record};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use std::borrow::Cow;
use std::io;

/// Columns of a CSV file's contents.
pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Table, DataError> {
    let text = decode(file, bytes)?;
    let separator = separator(&text);
    let mut reader = ReaderBuilder::new()
        .delimiter(separator)
        .comment(Some(b'#'))
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut row = StringRecord::new();
    let mut next = |row: &mut StringRecord| {
        reader.read_record(row).map_err(|e| DataError::file(file, format!("not a table: {e}")))
    };
    if !next(&mut row)? {
        return Err(DataError::file(file, "is empty: the first row names the columns, `time [s],…`"));
    }
    let mut columns = header(file, &row)?;
    let mut line = row.position().map_or(1, csv::Position::line);
    let mut stamps: Vec<Option<Timestamps>> = Vec::new();
    while next(&mut row)? {
        line = row.position().map_or(line, csv::Position::line);
        if stamps.is_empty() {
            if take_units(&row, &mut columns) {
                continue;
            }
            stamps = row.iter().map(|cell| Timestamps::from(cell.trim())).collect();
            stamps.resize_with(columns.len(), || None);
            for (column, _) in columns.iter_mut().zip(&stamps).filter(|(_, stamps)| stamps.is_some()) {
                column.unit = "s".into();
            }
        }
        add_row(file, line, separator, &row, &stamps, &mut columns)?;
    }
    if columns[0].values.is_empty() {
        return Err(DataError::file(file, "has a header, but no samples"));
    }
    Ok(Table { name: file.to_owned(), columns, master: None })
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
        let text = "is neither CSV nor a format known here: export it as CSV, ASAM MDF 4 or MATLAB -v7";
        return Err(DataError::file(file, text));
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
    })
}

/// The separator of the header row: what stands in it outside of quotes and brackets.
fn separator(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or("");
    let (mut quoted, mut depth, mut count) = (false, 0_i32, [0_usize; 3]);
    for c in header.chars() {
        match c {
            '"' => quoted = !quoted,
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            ';' if !quoted && depth <= 0 => count[0] += 1,
            '\t' if !quoted && depth <= 0 => count[1] += 1,
            ',' if !quoted && depth <= 0 => count[2] += 1,
            _ => {}
        }
    }
    match count {
        [semicolons, ..] if semicolons > 0 => b';',
        [_, tabs, _] if tabs > 0 => b'\t',
        _ => b',',
    }
}

fn header(file: &str, row: &StringRecord) -> Result<Vec<Channel>, DataError> {
    let line = row.position().map_or(1, csv::Position::line);
    let mut cells: Vec<&str> = row.iter().map(str::trim).collect();
    // A separator at the end of each line is no column.
    if cells.len() > 1 && cells.last() == Some(&"") {
        cells.pop();
    }
    let error = |column: usize, text: String| DataError::Cell { file: file.into(), line, column, text };
    if cells.iter().all(|cell| number(cell, b';').is_some()) {
        return Err(error(1, "the first row has to name the columns: `time [s]`, `force [N]`, …".into()));
    }
    if let [only] = cells[..] {
        let text =
            format!("only one column, `{only}`: columns are separated by a comma, a semicolon or a tab");
        return Err(error(1, text));
    }
    let mut columns: Vec<Channel> = Vec::with_capacity(cells.len());
    for (i, cell) in cells.iter().enumerate() {
        let (name, unit) = title(cell);
        if name.is_empty() {
            return Err(error(i + 1, "the column has no name: write one, such as `force [N]`".into()));
        }
        if columns.iter().any(|column| column.name == name && column.unit == unit) {
            return Err(error(i + 1, format!("a second column `{cell}`: rename one of them")));
        }
        columns.push(Channel { name: name.into(), unit: unit.into(), values: Vec::new() });
    }
    Ok(columns)
}

/// Name and unit of `name [unit]` or `name (unit)`.
pub(super) fn title(cell: &str) -> (&str, &str) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, unit)) = cell.strip_suffix(close).and_then(|rest| rest.split_once(open)) {
            return (name.trim(), unit.trim());
        }
    }
    (cell, "")
}

/// Takes a row of units below the names, if that is what the row is.
fn take_units(row: &StringRecord, columns: &mut [Channel]) -> bool {
    let no_unit_yet = columns.iter().all(|column| column.unit.is_empty());
    let words = row.iter().filter(|cell| !cell.trim().is_empty());
    let is_units = no_unit_yet && words.clone().count() > 0 && {
        let mut words = words;
        words.all(|cell| number(cell.trim(), b';').is_none())
    };
    if is_units {
        for (column, cell) in columns.iter_mut().zip(row) {
            let unit = cell.trim().trim_start_matches(['[', '(']).trim_end_matches([']', ')']);
            column.unit = unit.trim().into();
        }
    }
    is_units
}

fn add_row(
    file: &str,
    line: u64,
    separator: u8,
    row: &StringRecord,
    stamps: &[Option<Timestamps>],
    columns: &mut [Channel],
) -> Result<(), DataError> {
    let error = |column: usize, text: String| DataError::Cell { file: file.into(), line, column, text };
    let surplus = row.len() == columns.len() + 1 && row[columns.len()].trim().is_empty();
    if row.len() != columns.len() && !surplus {
        let text = format!(
            "the row has {} cells, the header {}: complete the row, or delete it if recording stopped here",
            row.len(),
            columns.len()
        );
        return Err(error(row.len().min(columns.len()), text));
    }
    for (i, ((column, stamps), cell)) in columns.iter_mut().zip(stamps).zip(row).enumerate() {
        let cell = cell.trim();
        let value = match stamps {
            Some(stamps) => stamps.seconds(cell),
            None => number(cell, separator),
        };
        let value = value.ok_or_else(|| {
            let (wanted, remedy) = match stamps {
                Some(_) => ("a time as in the first row", "write all in one way"),
                None => ("a number", "leave missing samples empty"),
            };
            let text = format!("`{cell}` in `{}` is not {wanted}: {remedy}", column.name);
            error(i + 1, text)
        })?;
        column.values.push(value);
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
