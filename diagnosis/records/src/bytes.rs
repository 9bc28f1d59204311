//! Reading of binary files that may be damaged: every access is checked.

use super::DataError;
use flate2::read::ZlibDecoder;
use std::io::Read;

/// Most that a compressed block may grow to.
const LARGEST: u64 = 1 << 32;

/// A file's contents with its name for messages.
#[derive(Clone, Copy)]
pub(crate) struct Bytes<'a> {
    pub file: &'a str,
    pub all: &'a [u8],
}

impl<'a> Bytes<'a> {
    /// The bytes from a place on.
    pub fn get(self, at: u64, length: u64) -> Result<&'a [u8], DataError> {
        let from = usize::try_from(at).ok();
        let end = at.checked_add(length).and_then(|end| usize::try_from(end).ok());
        from.zip(end).and_then(|(from, end)| self.all.get(from..end)).ok_or_else(|| {
            self.error(format!(
                "is cut off or damaged: {length} bytes at {at} are missing; copy or record it again"
            ))
        })
    }

    /// The little-endian number at a place.
    pub fn u64(self, at: u64) -> Result<u64, DataError> {
        Ok(self.get(at, 8)?.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    /// An error about this file.
    pub fn error(self, text: impl Into<String>) -> DataError {
        DataError::file(self.file, text)
    }

    /// Unpacks zlib data.
    pub fn inflate(self, packed: &[u8]) -> Result<Vec<u8>, DataError> {
        let mut unpacked = Vec::new();
        ZlibDecoder::new(packed)
            .take(LARGEST)
            .read_to_end(&mut unpacked)
            .map_err(|e| self.error(format!("is damaged: a compressed block cannot be unpacked ({e})")))?;
        Ok(unpacked)
    }
}
