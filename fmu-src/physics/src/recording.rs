//! Files with a signal over time.

use std::fmt::Display;
use std::path::Path;

/// What the first line of a file says.
#[derive(Clone, Copy, Debug)]
pub struct Header {
    /// What the file is, for messages.
    pub what: &'static str,
    /// Both columns as they are written, for messages.
    pub columns: &'static str,
    /// Whether the second column may have this name; the first one is `time [s]`.
    pub is_second: fn(&str) -> bool,
}

/// Reads times and values from a file of the FMU's resources, or from one with an absolute path.
///
/// # Errors
/// A sentence with file and line.
pub fn read(file: &str, resources: Option<&Path>, header: Header) -> Result<Vec<[f64; 2]>, String> {
    let what = header.what;
    let path = match resources {
        Some(folder) => folder.join(file),
        None if Path::new(file).is_absolute() => file.into(),
        None => {
            return Err(format!(
                "the {what} {file:?} cannot be found: the FMU was given no resource folder; name an absolute path"
            ));
        }
    };
    let cannot = |reason: &dyn Display| {
        format!(
            "the {what} {} cannot be read: {reason}; put it into the FMU's resources or name another `file`",
            path.display()
        )
    };
    // A device or a pipe may never end.
    if !std::fs::metadata(&path).map_err(|error| cannot(&error))?.is_file() {
        return Err(cannot(&"it is no file"));
    }
    let text = std::fs::read_to_string(&path).map_err(|error| cannot(&error))?;
    parse(&text, header).map_err(|error| format!("{}: {error}", path.display()))
}

/// Reads times and values from the text of a file: at least two rows, times increasing.
///
/// # Errors
/// A sentence with the line.
pub fn parse(text: &str, header: Header) -> Result<Vec<[f64; 2]>, String> {
    let Header { what, columns, is_second } = header;
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let first = lines.next().map_or("", |(_, line)| line.trim_start_matches('\u{feff}'));
    let fits = first
        .split_once(',')
        .is_some_and(|(time, second)| time.trim() == "time [s]" && is_second(second.trim()));
    if !fits {
        return Err(format!("line 1: expected the header `{columns}`, found `{first}`"));
    }
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let [time, value] = fields[..] else {
            return Err(format!("line {number}: expected two numbers, found {} fields", fields.len()));
        };
        let read = |field: &str| match field.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!("line {number}: `{field}` is not a finite number")),
        };
        let (time, value) = (read(time)?, read(value)?);
        if let Some([last, _]) = rows.last()
            && time <= *last
        {
            return Err(format!(
                "line {number}: time {time} s does not come after {last} s; times must increase"
            ));
        }
        rows.push([time, value]);
    }
    if rows.len() < 2 {
        return Err(format!("{} rows of numbers: a {what} needs at least two", rows.len()));
    }
    Ok(rows)
}
