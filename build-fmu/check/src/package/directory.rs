//! The central directory of a zip archive, read as it is: what unpackers pass over, the standards forbid.

use std::io::{Read, Seek, SeekFrom};

/// One entry.
#[derive(Clone, Debug, Default)]
pub struct Entry {
    /// Name, byte for byte.
    pub name: Vec<u8>,
    /// Version of the format that is needed to extract it, times ten.
    pub needed: u16,
    /// General purpose flags.
    pub flags: u16,
    /// Number of the way of compression.
    pub method: u16,
    /// Permissions and type of a file of Unix; 0 if it was made elsewhere.
    pub mode: u16,
}

impl Entry {
    /// Whether its contents are encrypted.
    pub fn is_encrypted(&self) -> bool {
        self.flags & 1 != 0
    }

    /// Whether its sizes stand after its data.
    pub fn has_descriptor(&self) -> bool {
        self.flags & (1 << 3) != 0
    }

    /// Whether its name is said to be in UTF-8.
    pub fn is_utf8(&self) -> bool {
        self.flags & (1 << 11) != 0
    }

    /// Whether it is a link.
    pub fn is_link(&self) -> bool {
        self.mode & 0o170_000 == 0o120_000
    }

    /// Its name, as far as it can be shown.
    pub fn shown(&self) -> String {
        String::from_utf8_lossy(&self.name).into_owned()
    }
}

/// Reads the entries; none where there is no directory at its place.
pub fn entries(file: &mut (impl Read + Seek)) -> std::io::Result<Vec<Entry>> {
    let length = file.seek(SeekFrom::End(0))?;
    // The last record, before a comment of up to 64 kB.
    let tail = length.min(22 + 0xffff);
    file.seek(SeekFrom::Start(length - tail))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let Some(end) = bytes.windows(4).rposition(|four| four == b"PK\x05\x06") else { return Ok(Vec::new()) };
    let record = &bytes[end..];
    if record.len() < 22 {
        return Ok(Vec::new());
    }
    let (size, start) = (word(record, 12), word(record, 16));
    // A program that unpacks itself has something before the archive, which no offset counts.
    let directory = (length - tail + end as u64).saturating_sub(u64::from(size));
    let start = if u64::from(start) <= directory { directory } else { u64::from(start) };
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(u64::from(size)).read_to_end(&mut bytes)?;
    let mut entries = Vec::new();
    let mut rest = bytes.as_slice();
    while rest.len() >= 46 && rest.starts_with(b"PK\x01\x02") {
        let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(half(rest, at)));
        let Some(bytes) = rest.get(46..46 + name) else { break };
        let unix = rest[5] == 3;
        entries.push(Entry {
            name: bytes.to_vec(),
            needed: u16::from(rest[6]),
            flags: half(rest, 8),
            method: half(rest, 10),
            mode: if unix { half(rest, 40) } else { 0 },
        });
        rest = rest.get(46 + name + extra + comment..).unwrap_or_default();
    }
    Ok(entries)
}

fn half(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}
