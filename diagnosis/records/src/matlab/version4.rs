//! Records from MAT-files of version 4, as real-time targets and Simulink's `To File` still write them: MathWorks, MAT-File Format,
//! R2023b, appendix "Level 4 MAT-File Format".

use super::{DataError, numbers};
use crate::bytes::Bytes;
use crate::table::Table;
use crate::vectors::Contents;

const HEADER: u64 = 20;
/// Longest name of a variable, with the zero at its end.
const LONGEST_NAME: u64 = 64;
/// Kinds of matrices, the last digit of a type.
const FULL: u64 = 0;
const TEXT: u64 = 1;

/// A matrix's header.
struct Header {
    big_endian: bool,
    /// Type of its numbers, as in version 5.
    numbers: u32,
    kind: u64,
    sizes: [u64; 2],
    is_complex: bool,
    name_length: u64,
}

impl Header {
    /// The header at a place; none if there is none.
    fn at(bytes: Bytes<'_>, place: u64) -> Option<Self> {
        let words = bytes.get(place, HEADER).ok()?;
        // Of a type in the other order, the low digits are in the upper bytes.
        [false, true].into_iter().find_map(|big_endian| Self::read(words, big_endian))
    }

    fn read(words: &[u8], big_endian: bool) -> Option<Self> {
        let word = |bytes: &[u8]| -> Option<u64> {
            let bytes = bytes.first_chunk().copied()?;
            Some(u64::from(if big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }))
        };
        let words: Vec<u64> = words.chunks(4).map(word).collect::<Option<_>>()?;
        let &[form, rows, columns, complex, name_length] = &words[..] else { return None };
        let (order, reserved, precision, kind) = (form / 1000, form / 100 % 10, form / 10 % 10, form % 10);
        let numbers = match precision {
            0 => 9,
            1 => 7,
            2 => 5,
            3 => 3,
            4 => 4,
            5 => 2,
            _ => return None,
        };
        let is_one = order == u64::from(big_endian) && reserved == 0 && kind <= 2 && complex <= 1;
        (is_one && (2..=LONGEST_NAME).contains(&name_length)).then_some(Self {
            big_endian,
            numbers,
            kind,
            sizes: [rows, columns],
            is_complex: complex == 1,
            name_length,
        })
    }

    /// Length of one part of its numbers in bytes; none beyond any file.
    fn length(&self) -> Option<u64> {
        let size = match self.numbers {
            2 => 1,
            3 | 4 => 2,
            5 | 7 => 4,
            _ => 8,
        };
        self.sizes[0].checked_mul(self.sizes[1])?.checked_mul(size)
    }
}

/// Whether a file's contents are a MAT-file of version 4: its first matrix has a header and a name.
pub(crate) fn is_matlab_4(all: &[u8]) -> bool {
    let bytes = Bytes { file: "", all };
    let name = Header::at(bytes, 0).and_then(|it| bytes.get(HEADER, it.name_length).ok());
    name.and_then(<[u8]>::split_last).is_some_and(|(end, name)| {
        let is_letter = |it: &u8| it.is_ascii_alphanumeric() || *it == b'_';
        *end == 0 && name.first().is_some_and(u8::is_ascii_alphabetic) && name.iter().all(is_letter)
    })
}

/// Columns of a MAT-file of version 4.
pub(crate) fn parse(file: &str, all: &[u8]) -> Result<Table, DataError> {
    let bytes = Bytes { file, all };
    let damaged = || bytes.error("is damaged: a matrix without its header; copy or record it again");
    let (mut contents, mut at) = (Contents::default(), 0);
    while at < all.len() as u64 {
        let header = Header::at(bytes, at).ok_or_else(damaged)?;
        let name = bytes.get(at + HEADER, header.name_length)?;
        let path = [String::from_utf8_lossy(name).trim_end_matches('\0').to_owned()];
        let length = header.length().ok_or_else(damaged)?;
        at += HEADER + header.name_length;
        let data = bytes.get(at, length)?;
        at += length;
        if header.is_complex {
            bytes.get(at, length)?;
            at += length;
        }
        let [rows, columns] = header.sizes.map(|it| it as usize);
        match header.kind {
            // A scalar is no signal.
            FULL if rows * columns <= 1 => (),
            FULL if header.is_complex => contents.leave_out(&path, "complex numbers"),
            FULL => {
                let values = numbers(header.numbers, data, header.big_endian).ok_or_else(damaged)?;
                contents.add(&path, "", [rows, columns], values);
            }
            TEXT => contents.leave_out(&path, "text"),
            _ => contents.leave_out(&path, "a sparse matrix"),
        }
    }
    contents.into_table(file)
}
