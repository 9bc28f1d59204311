//! The data of a data group, put together and split into records.

use super::{Block, Bytes, DataError, LONGEST_CHAIN};
use std::borrow::Cow;

/// Flag of a channel group with values of variable length (`cg_flags` bit 0).
const VARIABLE_LENGTH: u64 = 1;

/// How long the records of a channel group are.
pub(super) struct Layout {
    /// Number in front of each record of an unsorted group.
    id: u64,
    /// Bytes of values.
    pub values: usize,
    /// Bytes of invalidation bits behind them.
    pub invalidation: usize,
    /// Samples.
    cycles: u64,
    variable: bool,
}

impl Layout {
    pub fn read(group: &Block) -> Result<Self, DataError> {
        Ok(Self {
            id: group.number(0, 8)?,
            cycles: group.number(8, 8)?,
            variable: group.number(16, 2)? & VARIABLE_LENGTH != 0,
            values: group.number(24, 4)? as usize,
            invalidation: group.number(28, 4)? as usize,
        })
    }

    /// Bytes of a record without its number; at least one, so that damaged files can be divided by it.
    pub fn size(&self) -> usize {
        (self.values + self.invalidation).max(1)
    }
}

/// The data behind a link: one block, or a list of blocks, each of them plain or compressed.
pub(super) fn data(bytes: Bytes, at: u64) -> Result<Cow<[u8]>, DataError> {
    if at == 0 {
        return Ok(Cow::Borrowed(&[]));
    }
    let (kind, block) = Block::any(bytes, at)?;
    match kind {
        b"##DT" => Ok(Cow::Borrowed(block.data)),
        b"##DZ" => unpack(bytes, &block).map(Cow::Owned),
        b"##HL" => listed(bytes, block.link(0)).map(Cow::Owned),
        b"##DL" => listed(bytes, at).map(Cow::Owned),
        _ => {
            let kind = String::from_utf8_lossy(kind);
            Err(bytes
                .error(format!("has data of the kind `{kind}`, which is not read here: save it as MDF 4.1")))
        }
    }
}

fn listed(bytes: Bytes, at: u64) -> Result<Vec<u8>, DataError> {
    let mut whole = Vec::new();
    let mut parts = 0;
    for list in Block::chain(bytes, at, "##DL")? {
        for &part in list.links.iter().skip(1).filter(|&&part| part != 0) {
            let (kind, block) = Block::any(bytes, part)?;
            match kind {
                b"##DT" => whole.extend_from_slice(block.data),
                b"##DZ" => whole.extend(unpack(bytes, &block)?),
                _ => return Err(bytes.error("is damaged: a list of data holds something else")),
            }
            // A damaged list may name one part over and over.
            parts += 1;
            if parts > LONGEST_CHAIN || whole.len() > 1 << 33 {
                return Err(bytes.error("is damaged, or has more data than can be read at once: split it"));
            }
        }
    }
    Ok(whole)
}

/// Unpacks a `DZ` block: zlib, or zlib over the transposed matrix of its records.
fn unpack(bytes: Bytes, block: &Block) -> Result<Vec<u8>, DataError> {
    let (method, columns) = (block.number(2, 1)?, block.number(4, 4)? as usize);
    let (unpacked_size, packed_size) = (block.number(8, 8)?, block.number(16, 8)?);
    let packed = Bytes { all: block.data, ..bytes }.get(24, packed_size)?;
    let unpacked = bytes.inflate(packed)?;
    if unpacked.len() as u64 != unpacked_size {
        return Err(bytes.error("is damaged: a compressed block has the wrong size"));
    }
    match method {
        0 => Ok(unpacked),
        1 if columns > 0 => {
            let rows = unpacked.len() / columns;
            let mut plain = vec![0; unpacked.len()];
            let (matrix, rest) = unpacked.split_at(rows * columns);
            for (i, &byte) in matrix.iter().enumerate() {
                plain[i % rows * columns + i / rows] = byte;
            }
            plain[rows * columns..].copy_from_slice(rest);
            Ok(plain)
        }
        _ => {
            Err(bytes.error("is compressed in a way that is not read here: save it as MDF 4.1 with deflate"))
        }
    }
}

/// The records of each channel group, one after another and without their numbers.
pub(super) fn split<'a>(
    bytes: Bytes,
    data: &'a [u8],
    id_size: u64,
    layouts: &[Layout],
) -> Result<Vec<Cow<'a, [u8]>>, DataError> {
    let damaged = || bytes.error("is damaged: its records do not fit together");
    if id_size == 0 {
        let [layout] = layouts else {
            return if layouts.is_empty() { Ok(Vec::new()) } else { Err(damaged()) };
        };
        let wanted = usize::try_from(layout.cycles).ok().and_then(|cycles| cycles.checked_mul(layout.size()));
        let missing = || {
            let found = data.len() / layout.size();
            bytes.error(format!(
                "is cut off: {found} of {} samples are there; copy or record it again",
                layout.cycles
            ))
        };
        let records = wanted.and_then(|wanted| data.get(..wanted)).ok_or_else(missing)?;
        return Ok(vec![Cow::Borrowed(records)]);
    }
    let mut sorted = vec![Vec::new(); layouts.len()];
    let mut rest = Bytes { all: data, ..bytes };
    while !rest.all.is_empty() {
        let id = rest.get(0, id_size)?.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte));
        let index = layouts.iter().position(|layout| layout.id == id).ok_or_else(damaged)?;
        let layout = &layouts[index];
        let (skip, length) = if layout.variable {
            let length =
                rest.get(id_size, 4)?.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte));
            (id_size + 4, length)
        } else {
            (id_size, (layout.values + layout.invalidation) as u64)
        };
        let record = rest.get(skip, length)?;
        if !layout.variable {
            sorted[index].extend_from_slice(record);
        }
        rest.all = rest.get(skip + length, rest.all.len() as u64 - skip - length)?;
    }
    Ok(sorted.into_iter().map(Cow::Owned).collect())
}
