//! Mutations of an archive: its directory, byte by byte, and its files.

/// An archive whose entry of a name has another record in the directory.
pub fn patched(mut bytes: Vec<u8>, name: &str, patch: impl Fn(&mut [u8])) -> Vec<u8> {
    let records: Vec<usize> =
        (0..bytes.len() - 46).filter(|at| bytes[*at..].starts_with(b"PK\x01\x02")).collect();
    let of = |at: &&usize| bytes[**at + 46..].starts_with(name.as_bytes());
    let at = *records.iter().find(of).unwrap_or_else(|| panic!("no {name}"));
    patch(&mut bytes[at..at + 46 + name.len()]);
    bytes
}

/// Version needed to extract.
pub const VERSION: usize = 6;
/// General purpose flags.
pub const FLAGS: usize = 8;
/// Way of compression.
pub const METHOD: usize = 10;
/// Type and permissions of a file of Unix.
pub const MODE: usize = 40;
/// The system that has made the entry.
pub const SYSTEM: usize = 5;
/// The name.
pub const NAME: usize = 46;

use zip::CompressionMethod::{Deflated, Stored};

use super::Case;
use crate::subject::{Parts, parts};

/// The small FMU with files more.
fn with(files: &[(&str, zip::CompressionMethod)]) -> Parts {
    let mut parts = parts("");
    parts.files.extend(files.iter().map(|(name, method)| ((*name).into(), b"x".to_vec(), *method)));
    parts
}

pub fn all() -> Vec<Case> {
    const DATA: &str = "resources/data.txt";
    let file = |name: &str| with(&[(name, Deflated)]).bytes();
    let data = |patch: &dyn Fn(&mut [u8])| patched(parts("").bytes(), DATA, patch);
    let mut cases: Vec<Case> = [
        ("backslash", "archive.path", file("resources\\more.txt")),
        ("climbs", "archive.path.outside", file("../more.txt")),
        ("absolute", "archive.path.outside", file("/tmp/more.txt")),
        ("compressed", "archive.compression", data(&|entry| entry[METHOD] = 12)),
        ("encrypted", "archive.encryption", data(&|entry| entry[FLAGS] |= 1)),
        ("newer", "archive.version", data(&|entry| entry[VERSION] = 45)),
        (
            "descriptor",
            "archive.descriptor",
            patched(with(&[("resources/stored", Stored)]).bytes(), "resources/stored", |entry| {
                entry[FLAGS] |= 8;
            }),
        ),
        (
            "link",
            "archive.link",
            data(&|entry| {
                entry[SYSTEM] = 3;
                entry[MODE..MODE + 2].copy_from_slice(&0o120_777_u16.to_le_bytes());
            }),
        ),
        (
            "twice",
            "archive.twice",
            patched(file("resources/datx.txt"), "resources/datx.txt", |entry| {
                entry[NAME..NAME + DATA.len()].copy_from_slice(DATA.as_bytes());
            }),
        ),
        ("case", "archive.twice", file("resources/DATA.txt")),
        (
            "letters",
            "archive.names",
            patched(file("resources/Räder.txt"), "resources/R", |entry| entry[FLAGS + 1] &= !8),
        ),
        ("extra", "archive.extra", file("extra/more.txt")),
        ("empty", "binary.platform", Parts { library: None, ..parts("") }.bytes()),
        ("no-library", "binary.format", Parts { library: Some(b"nothing".to_vec()), ..parts("") }.bytes()),
    ]
    .into_iter()
    .map(|(what, rule, bytes)| Case::fmu(what, rule, bytes))
    .collect();
    let mut other = parts("");
    other.files.push(("binaries/win64/Faulty.dll".into(), other.library.clone().unwrap(), Deflated));
    cases.push(Case::fmu("elsewhere", "binary.format.platform", other.bytes()));
    cases.push(Case { ending: "zip", ..Case::fmu("ending", "archive.ending", parts("").bytes()) });
    cases
}
