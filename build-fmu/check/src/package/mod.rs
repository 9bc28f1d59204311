//! The archive: its entries, and the files unpacked from it.

mod directory;
mod rules;

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use zip::ZipArchive;

use directory::Entry;

/// The files of an FMU or an SSP.
pub struct Package {
    archive: ZipArchive<File>,
    entries: Vec<Entry>,
    names: Vec<String>,
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

    fn of(mut file: File) -> Result<Self, String> {
        let entries = directory::entries(&mut file).map_err(|error| format!("it cannot be read: {error}"))?;
        let no_zip = |error| format!("it is no zip archive, as FMUs and SSPs are: {error}");
        let mut archive = ZipArchive::new(file).map_err(no_zip)?;
        let mut names = Vec::new();
        for index in 0..archive.len() {
            // As stored: compression and encryption show when an entry is read.
            let entry = archive.by_index_raw(index).map_err(no_zip)?;
            // Backslashes are reported, and read as slashes.
            names.push(String::from_utf8_lossy(entry.name_raw()).replace('\\', "/"));
        }
        Ok(Self { archive, entries, names })
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

    /// Unpacks all of it into a folder, which files cannot climb out of.
    ///
    /// # Errors
    /// If the archive is damaged or the disk full.
    pub fn unpack(&mut self, folder: &Path) -> Result<(), String> {
        self.archive.extract(folder).map_err(|error| format!("the archive cannot be unpacked: {error}"))
    }
}
