//! Records from ASAM MDF 4 (`.mf4`): ASAM MDF V4.1.1, block and field names as there.
//!
//! Read are sorted and unsorted records, plain, listed and compressed data, integer and floating channels of either
//! byte order, linear conversions and invalidation bits (missing samples). Text channels, arrays and channels with
//! other conversions are listed as not read; if nothing is left, the message says so. Groups with other times are
//! interpolated linearly onto the times of the fastest one; the second channel of a name `x` becomes `x#2`.

mod channel;
mod records;

use super::bytes::Bytes;
use super::interpolate::linear;
use super::table::Table;
use super::{Channel, DataError, Unread};
use channel::Reader;
use std::collections::BTreeMap;

/// Start of a file; the version follows.
pub(crate) const MAGIC: &[u8] = b"MDF     ";
/// Start of a file that the recorder did not close.
pub(crate) const UNFINISHED: &[u8] = b"UnFinMF ";
/// Blocks of one kind that a file may chain: more means that the chain is a loop.
const LONGEST_CHAIN: usize = 100_000;

/// A block: its links and its data.
struct Block<'a> {
    bytes: Bytes<'a>,
    links: Vec<u64>,
    data: &'a [u8],
}

impl<'a> Block<'a> {
    /// Reads the block at a place, which has to be of this kind.
    fn read(bytes: Bytes<'a>, at: u64, kind: &str) -> Result<Self, DataError> {
        let block = Self::any(bytes, at)?;
        if block.0 != kind.as_bytes() {
            let found = String::from_utf8_lossy(block.0).into_owned();
            return Err(bytes.error(format!("is damaged: `{found}` where `{kind}` belongs (byte {at})")));
        }
        Ok(block.1)
    }

    /// Reads the block at a place, and its kind.
    fn any(bytes: Bytes<'a>, at: u64) -> Result<(&'a [u8], Self), DataError> {
        let kind = bytes.get(at, 4)?;
        let (length, links) = (bytes.u64(at.saturating_add(8))?, bytes.u64(at.saturating_add(16))?);
        let head =
            links.checked_mul(8).and_then(|links| links.checked_add(24)).filter(|&head| head <= length);
        let head =
            head.ok_or_else(|| bytes.error(format!("is damaged: a block of impossible size at byte {at}")))?;
        let whole = Bytes { all: bytes.get(at, length)?, ..bytes };
        let links = (0..links).map(|i| whole.u64(24 + 8 * i)).collect::<Result<_, _>>()?;
        Ok((kind, Self { bytes, links, data: whole.get(head, length - head)? }))
    }

    /// A link; 0 if there is none.
    fn link(&self, number: usize) -> u64 {
        self.links.get(number).copied().unwrap_or(0)
    }

    /// A little-endian number of the data.
    fn number(&self, at: u64, size: u64) -> Result<u64, DataError> {
        let data = Bytes { all: self.data, ..self.bytes };
        Ok(data.get(at, size)?.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    fn float(&self, at: u64) -> Result<f64, DataError> {
        self.number(at, 8).map(f64::from_bits)
    }

    /// The blocks of one kind that link 0 chains, from a place on.
    fn chain(bytes: Bytes<'a>, mut at: u64, kind: &str) -> Result<Vec<Self>, DataError> {
        let mut blocks = Vec::new();
        while at != 0 {
            let block = Self::read(bytes, at, kind)?;
            at = block.link(0);
            blocks.push(block);
            if blocks.len() > LONGEST_CHAIN {
                return Err(bytes.error(format!("is damaged: the `{kind}` blocks form a loop")));
            }
        }
        Ok(blocks)
    }
}

/// The text of a `TX` block, or the `<TX>` element of an `MD` block.
fn text(bytes: Bytes, at: u64) -> Result<String, DataError> {
    if at == 0 {
        return Ok(String::new());
    }
    let (kind, block) = Block::any(bytes, at)?;
    let end = block.data.iter().position(|&byte| byte == 0).unwrap_or(block.data.len());
    let text = String::from_utf8_lossy(&block.data[..end]).into_owned();
    if kind == b"##MD" {
        let element = text.split_once("<TX>").and_then(|(_, rest)| rest.split_once("</TX>"));
        return Ok(element.map(|(text, _)| text.to_owned()).unwrap_or_default());
    }
    Ok(text)
}

/// Channels that share their times.
struct Group {
    time: Vec<f64>,
    channels: Vec<Channel>,
}

impl Group {
    /// Its channels as not read.
    fn left_out(self, why: &'static str) -> impl Iterator<Item = Unread> {
        let unread = move |it: Channel| Unread { name: it.name, unit: it.unit, why: why.into() };
        self.channels.into_iter().map(unread)
    }
}

/// Columns of an MDF file.
pub(crate) fn parse(file: &str, all: &[u8]) -> Result<Table, DataError> {
    let bytes = Bytes { file, all };
    if all.starts_with(UNFINISHED) {
        return Err(
            bytes.error("the recorder did not close it: open and save it with the recorder's software")
        );
    }
    let version = String::from_utf8_lossy(bytes.get(8, 8)?).trim_end_matches(['\0', ' ']).to_owned();
    if !version.starts_with('4') {
        return Err(bytes.error(format!("is MDF {version}: convert it to MDF 4, or export CSV")));
    }
    let header = Block::read(bytes, 64, "##HD")?;
    let mut groups = Vec::new();
    let mut unread = Vec::new();
    for group in Block::chain(bytes, header.link(0), "##DG")? {
        read_data_group(bytes, &group, &mut groups, &mut unread)?;
    }
    let (groups, empty): (Vec<Group>, Vec<Group>) = groups.into_iter().partition(|it| !it.time.is_empty());
    unread.extend(empty.into_iter().flat_map(|it| it.left_out("there are no samples")));
    let groups = groups.into_iter().filter(|it| !it.channels.is_empty()).collect();
    let mut columns = join(groups).ok_or_else(|| {
        bytes.error(format!("has no numeric channel with a master channel of time{}", Unread::list(&unread)))
    })?;
    number_doubles(&mut columns);
    Ok(Table { name: file.to_owned(), columns, master: Some(0), unread, ..Table::default() })
}

/// Names are free in MDF: the second channel `x` becomes `x#2`.
fn number_doubles(columns: &mut [Channel]) {
    let mut counts = BTreeMap::new();
    for column in columns {
        let count = counts.entry(column.name.clone()).or_insert(0_usize);
        *count += 1;
        if *count > 1 {
            column.name += &format!("#{count}");
        }
    }
}

/// Reads all channel groups of a data group.
fn read_data_group(
    bytes: Bytes,
    data_group: &Block,
    groups: &mut Vec<Group>,
    unread: &mut Vec<Unread>,
) -> Result<(), DataError> {
    let id_size = data_group.number(0, 1)?;
    let channel_groups = Block::chain(bytes, data_group.link(1), "##CG")?;
    let layouts = channel_groups.iter().map(records::Layout::read).collect::<Result<Vec<_>, _>>()?;
    let data = records::data(bytes, data_group.link(2))?;
    let split = records::split(bytes, &data, id_size, &layouts)?;
    for ((channel_group, layout), records) in channel_groups.iter().zip(&layouts).zip(split) {
        let (mut time, mut channels) = (None, Vec::new());
        for block in Block::chain(bytes, channel_group.link(1), "##CN")? {
            let name = text(bytes, block.link(2))?;
            match Reader::read(bytes, &block, layout)? {
                Ok(reader) => {
                    let values =
                        records.chunks_exact(layout.size()).map(|record| reader.value(record)).collect();
                    if reader.is_time {
                        time = Some(values);
                    } else {
                        channels.push(Channel { name, unit: reader.unit, values });
                    }
                }
                Err(why) => unread.push(Unread { name, unit: String::new(), why }),
            }
        }
        match time {
            Some(time) => groups.push(Group { time, channels }),
            None => {
                let without_time = Group { time: Vec::new(), channels };
                unread.extend(without_time.left_out("no master channel of time"));
            }
        }
    }
    Ok(())
}

/// Time and channels of all groups at the times of the one with the most samples; none without groups.
fn join(mut groups: Vec<Group>) -> Option<Vec<Channel>> {
    let fastest = (0..groups.len()).rev().max_by_key(|&i| groups[i].time.len())?;
    let time = groups[fastest].time.clone();
    for group in &mut groups {
        if group.time != time {
            for channel in &mut group.channels {
                channel.values = time.iter().map(|&t| linear(&group.time, &channel.values, t)).collect();
            }
        }
    }
    let master = Channel { name: "time".into(), unit: "s".into(), values: time };
    Some(std::iter::once(master).chain(groups.into_iter().flat_map(|group| group.channels)).collect())
}

#[cfg(test)]
mod tests;
