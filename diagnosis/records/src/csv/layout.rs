//! Where the table is in a file of text: what separates its columns, which row names them, which has their units, and where
//! the numbers begin. Loggers write lines of their own above.

use super::super::{DataError, timestamp::Timestamps, units};
use super::{is_comment, number, rows, title, unit};
use csv::StringRecord;

/// Rows that are looked at.
const HEAD: usize = 200;
/// Rows of text above the numbers that may be names, units and descriptions.
const TITLES: usize = 3;
/// Rows of a table that have to agree about what is text and what are numbers.
const AGREEING: usize = 4;
/// What may separate columns; the space stands for any number of blanks.
const SEPARATORS: [u8; 4] = [b';', b'\t', b',', b' '];

/// Where the table is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    /// What separates the columns.
    pub separator: u8,
    /// The row that names the columns.
    pub names: StringRecord,
    /// The row of their units.
    pub units: Option<StringRecord>,
    /// Line of the first row of numbers.
    pub first: u64,
}

impl Layout {
    /// Looks for the table. `skip` is the number of lines above the row of names, where somebody gives it.
    ///
    /// # Errors
    /// The text has no table, or no row that names its columns: the message says what to do.
    pub fn find(file: &str, text: &str, skip: Option<usize>) -> Result<Self, DataError> {
        let heads = SEPARATORS.map(|separator| (separator, head(text, separator)));
        let tables = heads.iter().filter_map(|(separator, rows)| {
            let first = first_numbers(rows, *separator, skip)?;
            Some((*separator, rows, first))
        });
        // Of separators that are possible, the one that splits the first numbers into most columns; a blank only alone.
        let best = tables.max_by_key(|(separator, rows, first)| {
            (
                *separator != b' ',
                values(&rows[*first], *separator).count(),
                std::cmp::Reverse(*separator == b','),
            )
        });
        let Some((separator, rows, first)) = best else { return Err(no_table(file, &heads)) };
        let titles = match skip {
            Some(skip) => named(rows, first, skip).ok_or_else(|| {
                let text =
                    format!("no row names the columns below the {skip} lines that are skipped (skip_rows)");
                DataError::file(file, text)
            })?,
            None => titles(rows, first, separator),
        };
        let Some((names, below)) = names(titles) else {
            return unnamed(rows, first, separator).ok_or_else(|| no_names(file, rows, first));
        };
        let names = uncommented(names);
        let has_units = names.iter().any(|cell| !title(cell.trim()).1.is_empty());
        let units = below.iter().max_by_key(|row| known_units(row)).filter(|row| known_units(row) > 0);
        let first = line(&rows[first]);
        Ok(Self { separator, names, units: units.filter(|_| !has_units).cloned(), first })
    }
}

impl Layout {
    /// Whether a row has numbers where the table has them.
    pub fn is_sample(&self, row: &StringRecord) -> bool {
        row.len().abs_diff(self.names.len()) <= 1 && values(row, self.separator).next().is_some()
    }

    /// Whether a row names the columns again.
    pub fn is_names(&self, row: &StringRecord) -> bool {
        row.len() == self.names.len()
            && row.iter().zip(&self.names).all(|(one, other)| one.trim() == other.trim())
    }
}

/// The line that a row begins in.
pub(super) fn line(row: &StringRecord) -> u64 {
    row.position().map_or(1, csv::Position::line)
}

/// The first rows.
fn head(text: &str, separator: u8) -> Vec<StringRecord> {
    rows(text, separator).map_while(Result::ok).take(HEAD).collect()
}

/// A cell with a number or an instant in it.
fn is_value(cell: &str, separator: u8) -> bool {
    let cell = cell.trim();
    !cell.is_empty() && (number(cell, separator).is_some() || Timestamps::from(cell).is_some())
}

/// Columns with a value.
fn values(row: &StringRecord, separator: u8) -> impl Iterator<Item = usize> {
    row.iter().enumerate().filter(move |(_, cell)| is_value(cell, separator)).map(|(column, _)| column)
}

/// Columns with a text.
fn texts(row: &StringRecord, separator: u8) -> impl Iterator<Item = usize> {
    let is_text = move |cell: &str| !cell.trim().is_empty() && !is_value(cell, separator);
    row.iter().enumerate().filter(move |(_, cell)| is_text(cell)).map(|(column, _)| column)
}

/// The first row of the table's numbers: the rows below it are of the same kind, column by column.
fn first_numbers(rows: &[StringRecord], separator: u8, skip: Option<usize>) -> Option<usize> {
    let below_names = |row: &StringRecord| skip.is_none_or(|skip| line(row) > skip as u64 + 1);
    (0..rows.len()).find(|&first| {
        let row = &rows[first];
        let count = values(row, separator).count();
        let has_numbers = count > 1 || count == 1 && texts(row, separator).next().is_none();
        row.len() > 1
            && below_names(row)
            && !is_comment(row)
            && has_numbers
            && rows[first + 1..].iter().filter(|row| !is_comment(row)).take(AGREEING - 1).all(|next| {
                let is =
                    |row: &StringRecord, column| row.get(column).is_some_and(|it| is_value(it, separator));
                row.len().abs_diff(next.len()) <= 1
                    && !texts(row, separator).any(|column| is(next, column))
                    && values(row, separator).any(|column| is(next, column))
            })
    })
}

/// The rows of text directly above the numbers that are as wide as these, in the file's order. A comment counts if nothing
/// else is there.
fn titles(rows: &[StringRecord], first: usize, separator: u8) -> &[StringRecord] {
    let wide = |row: &StringRecord| row.len().abs_diff(rows[first].len()) <= 1;
    let count = |row: &StringRecord| (texts(row, separator).count(), values(row, separator).count());
    let is_title = |row: &StringRecord| wide(row) && count(row).0 > count(row).1;
    let mut start = first;
    while start > 0 && first - start < TITLES {
        let (row, below) = (&rows[start - 1], &rows[start]);
        let apart = start < first && line(row) + 1 != line(below);
        if !is_title(row) || apart || (is_comment(row) && start < first) {
            break;
        }
        start -= 1;
        if is_comment(row) {
            break;
        }
    }
    &rows[start..first]
}

/// A table without names, as many controllers write it, if nothing but comments is above its numbers.
fn unnamed(rows: &[StringRecord], first: usize, separator: u8) -> Option<Layout> {
    // A separator at the end of each line is no column; a value that is missing at the end of one line is.
    let last = |row: &StringRecord| (0..row.len()).rposition(|cell| !row[cell].trim().is_empty());
    let filled = rows[first..].iter().take(AGREEING).filter_map(last).max().map_or(0, |last| last + 1);
    let names = (1..=filled).map(|column| format!("column {column}")).collect::<Vec<_>>().into();
    let layout = Layout { separator, names, units: None, first: line(&rows[first]) };
    rows[..first].iter().all(is_comment).then_some(layout)
}

/// The row below lines that are skipped, and those between it and the numbers.
fn named(rows: &[StringRecord], first: usize, skip: usize) -> Option<&[StringRecord]> {
    let start = rows[..first].iter().position(|row| line(row) > skip as u64)?;
    Some(&rows[start..first])
}

/// Of rows of text, the one that names the columns, and those below it: the one with a name of time, else the one above a
/// row of units, else the last.
fn names(titles: &[StringRecord]) -> Option<(&StringRecord, &[StringRecord])> {
    let has_time =
        |row: &StringRecord| row.iter().any(|cell| super::super::table::is_time(title(cell.trim()).0));
    let above_units = |index: usize| titles.get(index + 1).is_some_and(|below| known_units(below) > 0);
    let last = titles.len().checked_sub(1)?;
    let index = titles.iter().position(has_time);
    let index = index.or_else(|| (0..last).find(|index| above_units(*index))).unwrap_or(last);
    Some((&titles[index], &titles[index + 1..]))
}

/// How many cells are units of measurement.
fn known_units(row: &StringRecord) -> usize {
    row.iter().map(unit).filter(|unit| !unit.is_empty() && units::si(unit).is_ok()).count()
}

/// A comment's cells without its mark.
fn uncommented(row: &StringRecord) -> StringRecord {
    let mut cells: Vec<&str> = row.iter().collect();
    if let Some(first) = cells.first_mut() {
        let plain = first.trim_start().trim_start_matches('#').trim_start();
        // A mark with a blank behind it is a cell of its own.
        if plain.is_empty() && *first != plain {
            cells.remove(0);
        } else {
            *first = plain;
        }
    }
    let mut plain = StringRecord::from(cells);
    plain.set_position(row.position().cloned());
    plain
}

/// That no rows of numbers are there.
fn no_table(file: &str, heads: &[(u8, Vec<StringRecord>)]) -> DataError {
    let rows = heads.iter().map(|(_, rows)| rows).max_by_key(|rows| rows.iter().map(StringRecord::len).max());
    let Some(first) = rows.and_then(|rows| rows.iter().find(|row| !is_comment(row))) else {
        return DataError::file(file, "is empty: the first row names the columns, `time [s],…`");
    };
    let count = rows.map_or(0, Vec::len);
    if count == 1 {
        return DataError::file(file, "has a header, but no samples");
    }
    let shown: Vec<&str> = first.iter().take(4).collect();
    DataError::Cell {
        file: file.into(),
        line: line(first),
        column: 1,
        text: format!(
            "no table of numbers in the first {count} rows (`{}` …): it needs a row that names the columns, and below it \
             rows of at least two numbers with a comma, a semicolon, a tab or blanks between them. If it begins further \
             below, give the lines above the names: `skip_rows = 12` in the map, or --skip-rows",
            shown.join(", ")
        ),
    }
}

/// That no row above the numbers names the columns.
fn no_names(file: &str, rows: &[StringRecord], first: usize) -> DataError {
    let above = rows[..first].last().map_or(0, StringRecord::len);
    let text = format!(
        "the numbers begin here, with {} cells in a row, and the row above has {above}: write a row that names the columns above \
         the numbers, or give the lines above the names: `skip_rows = 12` in the map, or --skip-rows",
        rows[first].len(),
    );
    DataError::Cell { file: file.into(), line: line(&rows[first]), column: 1, text }
}
