//! Records from MATLAB's MAT-files of version 5 to 7: MathWorks, MAT-File Format, R2023b. Those of version 4 have a module of their own, and
//! those of version 7.3 are HDF5.
//!
//! Real numeric vectors (n×1 or 1×n) and the columns of matrices, by their names, and those in the fields of structs. What else is
//! there is listed as not read, but for single values. There are no units: SI is assumed unless the map says otherwise.

pub(crate) mod version4;

use super::DataError;
use super::bytes::Bytes;
use super::table::Table;
use super::vectors::{self, Contents};

/// Types of data elements, `mi…`.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Classes of arrays, `mx…_CLASS`: numeric ones are from double to uint64.
const CELLS: u8 = 1;
const STRUCT: u8 = 2;
const TEXT: u8 = 4;
const SPARSE: u8 = 5;
/// Tables, timetables, strings: theirs is a layout without sizes.
const OPAQUE: u8 = 17;
const NUMERIC: std::ops::RangeInclusive<u8> = 6..=15;
/// Flag of arrays with an imaginary part.
const COMPLEX: u8 = 0x08;
/// Structs in structs that are followed.
const DEEPEST: usize = 4;
const HEADER: u64 = 128;

/// Whether a file's contents are a MAT-file of version 5 to 7.
pub(crate) fn is_matlab(bytes: &[u8]) -> bool {
    let has_mark = matches!(bytes.get(126..128), Some(b"IM" | b"MI")) && bytes.starts_with(b"MATLAB");
    has_mark && !super::hdf5::is_hdf5(bytes)
}

/// Columns of a MAT-file.
pub(crate) fn parse(file: &str, all: &[u8]) -> Result<Table, DataError> {
    let bytes = Bytes { file, all };
    let big_endian = bytes.get(126, 2)? == b"MI";
    let mut elements = Elements { bytes, at: HEADER, big_endian };
    let mut contents = Contents::default();
    while let Some((kind, data)) = elements.next()? {
        let unpacked;
        let (kind, data) = if kind == COMPRESSED {
            unpacked = bytes.inflate(data)?;
            let mut inner = Elements { bytes: Bytes { file, all: &unpacked }, at: 0, big_endian };
            match inner.next()? {
                Some(element) => element,
                None => continue,
            }
        } else {
            (kind, data)
        };
        if kind == MATRIX {
            let inner = Elements { bytes: Bytes { file, all: data }, at: 0, big_endian };
            matrix(inner, &mut Vec::new(), None, &mut contents)?;
        }
    }
    contents.into_table(file)
}

/// Reads an array element and adds what it has; a field's name comes from its struct.
fn matrix(
    mut parts: Elements,
    path: &mut Vec<String>,
    field: Option<&str>,
    contents: &mut Contents,
) -> Result<(), DataError> {
    let bytes = parts.bytes;
    let damaged = || bytes.error("is damaged: an array without its parts");
    // Empty fields are arrays without any parts.
    let Some((_, flags)) = parts.next()? else { return Ok(()) };
    let [low, high, ..] = *flags else { return Err(damaged()) };
    let (class, flags) = match (parts.big_endian, flags) {
        (true, &[_, _, flags, class, ..]) => (class, flags),
        _ => (low, high),
    };
    let sizes: Vec<f64> = match class {
        OPAQUE => Vec::new(),
        _ => {
            let (kind, data) = parts.next()?.ok_or_else(damaged)?;
            numbers(kind, data, parts.big_endian).ok_or_else(damaged)?
        }
    };
    let (_, own_name) = parts.next()?.ok_or_else(damaged)?;
    let name = field.map_or_else(|| String::from_utf8_lossy(own_name).into_owned(), str::to_owned);
    // What objects share stands in the file without a name.
    if name.is_empty() {
        return Ok(());
    }
    path.push(name);
    let count: f64 = sizes.iter().product();
    match (class, &sizes[..]) {
        (STRUCT, _) if path.len() > DEEPEST => contents.leave_out(path, "a struct in too many others"),
        (STRUCT, _) if count == 1.0 => fields(&mut parts, path, contents)?,
        (STRUCT, _) => contents.leave_out(path, format!("an array of {count} structs")),
        (CELLS, _) => contents.leave_out(path, "a cell array: save its vectors by themselves"),
        (TEXT, _) => contents.leave_out(path, "text"),
        (SPARSE, _) => contents.leave_out(path, "a sparse matrix"),
        // A scalar is no signal.
        (class, _) if NUMERIC.contains(&class) && count <= 1.0 => (),
        (class, _) if NUMERIC.contains(&class) && flags & COMPLEX != 0 => {
            contents.leave_out(path, "complex numbers");
        }
        (class, &[rows, columns]) if NUMERIC.contains(&class) => {
            let (kind, data) = parts.next()?.ok_or_else(damaged)?;
            let values = numbers(kind, data, parts.big_endian).ok_or_else(damaged)?;
            if values.len() as f64 != count {
                return Err(damaged());
            }
            contents.add(path, "", [rows as usize, columns as usize], values);
        }
        (class, sizes) if NUMERIC.contains(&class) => {
            contents.leave_out(path, format!("an array of {} dimensions", sizes.len()));
        }
        _ => contents.leave_out(path, vectors::OBJECT),
    }
    path.pop();
    Ok(())
}

fn fields(parts: &mut Elements, path: &mut Vec<String>, contents: &mut Contents) -> Result<(), DataError> {
    let bytes = parts.bytes;
    let damaged = || bytes.error("is damaged: a struct without its fields");
    let (kind, data) = parts.next()?.ok_or_else(damaged)?;
    let width = numbers(kind, data, parts.big_endian).and_then(|w| w.first().copied()).unwrap_or(0.0);
    let (_, names) = parts.next()?.ok_or_else(damaged)?;
    if width < 1.0 {
        return Err(damaged());
    }
    for name in names.chunks(width as usize) {
        let end = name.iter().position(|&byte| byte == 0).unwrap_or(name.len());
        let name = String::from_utf8_lossy(&name[..end]).into_owned();
        let (kind, data) = parts.next()?.ok_or_else(damaged)?;
        if kind == MATRIX {
            let inner = Elements { bytes: Bytes { all: data, ..bytes }, at: 0, big_endian: parts.big_endian };
            matrix(inner, path, Some(&name), contents)?;
        }
    }
    Ok(())
}

/// Data elements one after another.
#[derive(Clone, Copy)]
struct Elements<'a> {
    bytes: Bytes<'a>,
    at: u64,
    big_endian: bool,
}

impl<'a> Elements<'a> {
    /// Type and data of the next element; none at the end.
    fn next(&mut self) -> Result<Option<(u32, &'a [u8])>, DataError> {
        if self.at >= self.bytes.all.len() as u64 {
            return Ok(None);
        }
        let word = |at: u64| {
            let bytes = self.bytes.get(at, 4)?.first_chunk().copied().unwrap_or_default();
            Ok(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
        };
        let first = word(self.at)?;
        // Up to four bytes are packed beside the type.
        if first >> 16 != 0 {
            let data = self.bytes.get(self.at + 4, u64::from(first >> 16))?;
            self.at += 8;
            return Ok(Some((first & 0xFFFF, data)));
        }
        let length = u64::from(word(self.at + 4)?);
        let data = self.bytes.get(self.at + 8, length)?;
        self.at += 8 + if first == COMPRESSED { length } else { length.next_multiple_of(8) };
        Ok(Some((first, data)))
    }
}

/// The numbers of a data element; none if it does not hold numbers.
fn numbers(kind: u32, data: &[u8], big_endian: bool) -> Option<Vec<f64>> {
    let size = match kind {
        1 | 2 => 1,
        3 | 4 => 2,
        5..=7 => 4,
        9 | 12 | 13 => 8,
        _ => return None,
    };
    let join = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
    let number = |bytes: &[u8]| {
        let raw = if big_endian { bytes.iter().fold(0, join) } else { bytes.iter().rev().fold(0, join) };
        let unused = 64 - 8 * size;
        match kind {
            7 => f64::from(f32::from_bits(raw as u32)),
            9 => f64::from_bits(raw),
            1 | 3 | 5 | 12 => ((raw << unused).cast_signed() >> unused) as f64,
            _ => raw as f64,
        }
    };
    Some(data.chunks_exact(size).map(number).collect())
}

#[cfg(test)]
mod tests;
