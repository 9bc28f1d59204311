//! The archive: what is in it, and what it is unpacked to.

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use zip::{CompressionMethod, ZipArchive};

use crate::finding::{Finding, names};

/// The files of an FMU or an SSP.
pub struct Package {
    archive: ZipArchive<File>,
    names: Vec<String>,
    methods: Vec<CompressionMethod>,
}

impl Package {
    /// Opens an archive.
    ///
    /// # Errors
    /// If there is no such file or it is no zip archive.
    pub fn open(path: &Path) -> Result<Self, String> {
        Self::of(File::open(path).map_err(|error| format!("cannot open it: {error}"))?)
    }

    /// Opens an archive that lies in this one; none if it is missing.
    ///
    /// # Errors
    /// If it cannot be unpacked or is no zip archive.
    pub fn inner(&mut self, name: &str) -> Result<Option<Self>, String> {
        let Some(bytes) = self.read(name)? else { return Ok(None) };
        let unpacked = tempfile::tempfile().and_then(|mut file| file.write_all(&bytes).map(|()| file));
        Self::of(unpacked.map_err(|error| format!("`{name}` cannot be unpacked: {error}"))?).map(Some)
    }

    fn of(file: File) -> Result<Self, String> {
        let no_zip = |error| format!("it is no zip archive, as FMUs and SSPs are: {error}");
        let mut archive = ZipArchive::new(file).map_err(no_zip)?;
        let (mut names, mut methods) = (Vec::new(), Vec::new());
        for index in 0..archive.len() {
            // As it is stored: what is deflated, encrypted or otherwise is found out when it is read.
            let entry = archive.by_index_raw(index).map_err(no_zip)?;
            names.push(String::from_utf8_lossy(entry.name_raw()).into_owned());
            methods.push(entry.compression());
        }
        Ok(Self { archive, names, methods })
    }

    /// The files' names, folders left out.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str).filter(|name| !name.ends_with('/'))
    }

    /// A file's contents; none if it is missing.
    ///
    /// # Errors
    /// If the archive is damaged or compressed in a way that this program does not know.
    pub fn read(&mut self, name: &str) -> Result<Option<Vec<u8>>, String> {
        let Some(index) = self.names.iter().position(|other| other == name) else { return Ok(None) };
        let damaged = |error: &dyn std::fmt::Display| format!("`{name}` cannot be unpacked: {error}");
        let mut entry = self.archive.by_index(index).map_err(|error| damaged(&error))?;
        let mut contents = Vec::new();
        entry.read_to_end(&mut contents).map_err(|error| damaged(&error))?;
        Ok(Some(contents))
    }

    /// The contents of a text; none if it is missing.
    ///
    /// # Errors
    /// If it cannot be unpacked, or is not encoded in UTF-8.
    pub fn text(&mut self, name: &str) -> Result<Option<String>, String> {
        let Some(bytes) = self.read(name)? else { return Ok(None) };
        let text = String::from_utf8(bytes).map_err(|_| format!("{name} is not encoded in UTF-8"))?;
        // A mark of the byte order is no part of the text.
        Ok(Some(text.trim_start_matches('\u{feff}').to_owned()))
    }

    /// Unpacks all of it into a folder, which files cannot climb out of.
    ///
    /// # Errors
    /// If the archive is damaged or the disk full.
    pub fn unpack(&mut self, folder: &Path) -> Result<(), String> {
        self.archive.extract(folder).map_err(|error| format!("the archive cannot be unpacked: {error}"))
    }

    /// What is wrong with the archive itself.
    pub fn findings(&self) -> Vec<Finding> {
        let mut findings = Vec::new();
        let of = |wrong: &dyn Fn(&str) -> bool| -> Vec<&str> {
            self.names.iter().map(String::as_str).filter(|name| wrong(name)).collect()
        };
        let back = of(&|name| name.contains('\\'));
        if !back.is_empty() {
            let message = format!("paths in the archive are separated by backslashes: {}", names(&back));
            findings.push(
                Finding::error("archive.path", message)
                    .help("a zip archive has `/` in its paths, on Windows too"),
            );
        }
        let outside = of(&|name| {
            let absolute = name.starts_with('/') || name.chars().nth(1) == Some(':');
            absolute || name.split(['/', '\\']).any(|part| part == "..")
        });
        if !outside.is_empty() {
            let message = format!("paths lead out of the archive: {}", names(&outside));
            findings.push(
                Finding::error("archive.path", message)
                    .help("name files relative to the archive's root, without `..`"),
            );
        }
        let others: Vec<&str> = self
            .names
            .iter()
            .zip(&self.methods)
            .filter(|(_, method)| {
                !matches!(**method, CompressionMethod::Stored | CompressionMethod::Deflated)
            })
            .map(|(name, _)| name.as_str())
            .collect();
        if !others.is_empty() {
            let message = format!("files are compressed in another way than `deflate`: {}", names(&others));
            findings.push(
                Finding::error("archive.compression", message)
                    .help("FMI and SSP want `deflate`, the one that every tool can read"),
            );
        }
        findings
    }
}
