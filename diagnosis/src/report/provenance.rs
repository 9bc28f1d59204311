//! Where a report comes from: version, command, date, and a hash of each record.

use std::fmt::Write;
use std::time::{SystemTime, UNIX_EPOCH};

use chrono::DateTime;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::data::Origin;

/// Where a report comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Date and time (UTC, ISO 8601) at which the diagnosis began, or that of `SOURCE_DATE_EPOCH`, so that a report can be
    /// made again byte for byte.
    pub date: String,
    /// The command line; empty if it was no program that asked.
    pub command: String,
    /// The records, estimation data first.
    pub records: Vec<RecordOrigin>,
}

/// A record's file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordOrigin {
    /// Its path as given, or the name of a table.
    pub path: String,
    /// SHA-256 of its bytes (of a table: of its titles and values) in hexadecimal; empty if it cannot be read.
    pub sha256: String,
}

impl Provenance {
    /// That of a diagnosis of these records that begins now.
    pub fn of<'a>(records: impl Iterator<Item = &'a Origin>) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        let agreed = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.parse().ok());
        let time = DateTime::from_timestamp(agreed.unwrap_or(now as i64), 0).unwrap_or_default();
        Self {
            version: build_fmu::VERSION.into(),
            date: time.format("%Y-%m-%dT%H:%M:%SZ").to_string(),
            command: String::new(),
            records: records.map(record).collect(),
        }
    }
}

fn record(origin: &Origin) -> RecordOrigin {
    let mut hash = Sha256::new();
    let (path, complete) = match origin {
        Origin::File(path) => {
            let bytes = std::fs::read(path);
            hash.update(bytes.as_deref().unwrap_or_default());
            (path.display().to_string(), bytes.is_ok())
        }
        Origin::Columns { name, columns } => {
            for column in columns {
                hash.update(column.title().as_bytes());
                column.values.iter().for_each(|value| hash.update(value.to_le_bytes()));
            }
            (name.clone(), true)
        }
    };
    let mut sha256 = String::new();
    if complete {
        hash.finalize().iter().for_each(|byte| {
            let _ = write!(sha256, "{byte:02x}");
        });
    }
    RecordOrigin { path, sha256 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Channel;

    /// The hash is that of `sha256sum`; a table's follows its values.
    #[test]
    fn records_are_told_by_their_hashes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "abc").unwrap();
        let file = record(&Origin::File(path.clone()));
        assert_eq!(file.path, path.display().to_string());
        assert_eq!(file.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert_eq!(record(&Origin::File("nowhere.csv".into())).sha256, "");
        let table = |value| {
            let columns = vec![Channel { name: "time".into(), unit: "s".into(), values: vec![0.0, value] }];
            record(&Origin::Columns { name: "train".into(), columns })
        };
        assert_eq!(table(1.0), table(1.0));
        assert_ne!(table(1.0), table(2.0));
    }
}
