//! Records from spreadsheets: Excel's `.xlsx`, `.xlsb` and `.xls`, OpenDocument's `.ods`. A sheet is read as a table of text
//! with the same rows, so that names, units, dates and what stands above them go by the rules of [`super::csv`].

use super::reading::Reading;
use super::table::Table;
use super::{DataError, csv};
use ::csv::WriterBuilder;
use calamine::{Data, ExcelDateTime, Range, Reader, open_workbook_auto_from_rs};
use chrono::{Duration, NaiveDate, NaiveDateTime};
use std::io::Cursor;

/// Seconds of a day.
const DAY: f64 = 86_400.0;

/// Whether a file's contents may be a spreadsheet: a ZIP archive, or Microsoft's compound file.
pub(crate) fn is_spreadsheet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1")
}

/// Columns of a sheet: the one that is named, or the first with a table.
pub(crate) fn parse(file: &str, bytes: &[u8], reading: &Reading) -> Result<Table, DataError> {
    let wrong = |error: calamine::Error| {
        DataError::file(file, format!("cannot be read as a spreadsheet: {error}; export it as CSV"))
    };
    let mut book = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(wrong)?;
    let names = book.sheet_names();
    if let Some(wanted) = reading.sheet.as_ref().filter(|wanted| !names.contains(wanted)) {
        let text = format!("has no sheet `{wanted}`: there are {}", names.join(", "));
        return Err(DataError::file(file, text));
    }
    let (mut first, mut unnamed) = (None, None);
    for name in names.iter().filter(|name| reading.sheet.as_ref().is_none_or(|wanted| *name == wanted)) {
        let sheet = book.worksheet_range(name).map_err(wrong)?;
        match csv::parse(file, text(&sheet).as_bytes(), reading) {
            Ok(mut table) => {
                let others: Vec<&str> = names.iter().filter(|it| *it != name).map(String::as_str).collect();
                if !others.is_empty() && reading.sheet.is_none() {
                    let others = others.join(", ");
                    table.notes.push(format!(
                        "the sheet {name} was read, and not {others}: name another one in the map, `sheet = \"…\"`"
                    ));
                }
                // Bare numbers may be constants beside the sheet of signals.
                if table.columns.iter().all(|it| it.name.starts_with("column ")) {
                    unnamed = unnamed.or(Some(table));
                } else {
                    return Ok(table);
                }
            }
            Err(error) => first = first.or(Some(error)),
        }
    }
    unnamed.ok_or_else(|| first.unwrap_or_else(|| DataError::file(file, "has no sheet")))
}

/// A sheet as comma-separated values, line by line.
fn text(sheet: &Range<Data>) -> String {
    let mut writer = WriterBuilder::new().flexible(true).from_writer(Vec::new());
    let above = sheet.start().map_or(0, |(row, _)| row as usize);
    let blank = "\n".repeat(above);
    for row in sheet.rows() {
        let cells: Vec<String> = row.iter().map(cell).collect();
        // Written to memory: nothing can fail.
        let _ = writer.write_record(&cells);
    }
    let rows = writer.into_inner().unwrap_or_default();
    blank + &String::from_utf8_lossy(&rows)
}

fn cell(data: &Data) -> String {
    match data {
        Data::Empty | Data::Error(_) => String::new(),
        Data::Int(it) => it.to_string(),
        Data::Float(it) => it.to_string(),
        Data::Bool(it) => u8::from(*it).to_string(),
        Data::String(it) | Data::DateTimeIso(it) | Data::DurationIso(it) => it.replace(['\r', '\n'], " "),
        Data::DateTime(it) => instant(*it).unwrap_or_default(),
    }
}

/// A date with its time of day, to the microsecond; of a duration its seconds.
fn instant(at: ExcelDateTime) -> Option<String> {
    let seconds = DAY * at.as_f64();
    if at.is_duration() {
        return Some(seconds.to_string());
    }
    let zero: NaiveDateTime = NaiveDate::from_ymd_opt(1899, 12, 30)?.and_hms_opt(0, 0, 0)?;
    let at = zero.checked_add_signed(Duration::microseconds((1e6 * seconds).round() as i64))?;
    Some(at.format("%Y-%m-%d %H:%M:%S%.6f").to_string())
}

#[cfg(test)]
mod tests;
