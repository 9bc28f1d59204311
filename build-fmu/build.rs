//! A number for the equations and the C interface that this program knows: libraries made of other sources do not belong
//! to it (`src/prebuilt.rs`).

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let sources = Path::new("../fmu-src");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", sources.display());
    let mut files = Vec::new();
    collect(sources, &mut files);
    files.sort();
    // A published crate stands alone; the version identifies it.
    let mut text = env!("CARGO_PKG_VERSION").as_bytes().to_vec();
    for file in files {
        // With the same line ends wherever they were checked out.
        let bytes = fs::read(&file).expect("a source file can be read");
        text.extend(bytes.into_iter().filter(|byte| *byte != b'\r'));
    }
    let number = uuid::Uuid::new_v5(&uuid::Uuid::NAMESPACE_OID, &text).simple();
    println!("cargo::rustc-env=STRUT_SOURCES={number}");
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.map(|entry| entry.expect("a folder can be read").path()) {
        if entry.is_dir() {
            collect(&entry, files);
        } else if entry.extension().is_some_and(|ending| ending == "rs") {
            files.push(entry);
        }
    }
}
