//! Zip archives that are the same bytes for the same contents, written whole or not at all.

use std::io::{Cursor, Write};
use std::path::Path;

use tempfile::{Builder, NamedTempFile};
use zip::{CompressionMethod, DateTime, ZipWriter, write::SimpleFileOptions};

use crate::failure::{Failure, Result};

/// Files to be zipped, in this order.
#[derive(Debug, Default)]
pub struct Archive {
    files: Vec<(String, Vec<u8>, u32)>,
}

impl Archive {
    /// Adds a file.
    pub fn add(&mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) {
        self.files.push((name.into(), contents.into(), 0o644));
    }

    /// Adds a shared library: executable, as some systems want it.
    pub fn add_library(&mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) {
        self.files.push((name.into(), contents.into(), 0o755));
    }

    /// The archive. Every file bears the oldest date that a zip can say.
    pub fn bytes(&self) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, contents, mode) in &self.files {
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Deflated)
                .last_modified_time(DateTime::default())
                .unix_permissions(*mode);
            // Writing to memory fails for archives beyond 4 GiB only.
            zip.start_file(name.as_str(), options)
                .and_then(|()| Ok(zip.write_all(contents)?))
                .expect("a small archive");
        }
        zip.finish().expect("a small archive").into_inner()
    }
}

/// A folder to write to, known to be writable.
#[derive(Debug)]
pub struct Folder<'a> {
    path: &'a Path,
    /// Whether it was made here: it goes again if nothing comes into it.
    made: bool,
}

impl<'a> Folder<'a> {
    /// Makes the folder if it is missing and tries it out, so that a build of minutes does not end in
    /// a folder that cannot be written.
    ///
    /// # Errors
    /// If it cannot be made or written.
    pub fn open(path: &'a Path) -> Result<Self> {
        let made = !path.exists();
        std::fs::create_dir_all(path).map_err(|error| {
            Failure::new(format!("cannot make the folder `{}`: {error}", path.display()))
                .help("choose another with --out")
        })?;
        let folder = Self { path, made };
        folder.temporary()?;
        Ok(folder)
    }

    /// Writes a file under another name first, then gives it its own: readers see the old one or the
    /// new one, whole.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<()> {
        let path = self.path.join(name);
        let failed = |error: &dyn std::fmt::Display| {
            Failure::new(format!("cannot write `{}`: {error}", path.display()))
        };
        let mut file = self.temporary()?;
        file.write_all(contents).and_then(|()| file.as_file().sync_all()).map_err(|error| failed(&error))?;
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let _ = file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644));
        }
        file.persist(&path).map_err(|error| failed(&error.error))?;
        Ok(())
    }

    fn temporary(&self) -> Result<NamedTempFile> {
        Builder::new().prefix(".build-fmu-").tempfile_in(self.path).map_err(|error| {
            // The name of the temporary file, which the error carries, means nothing to the user.
            let reason = std::io::Error::from(error.kind());
            Failure::new(format!("cannot write to the folder `{}`: {reason}", self.path.display()))
                .help("choose another with --out")
        })
    }
}

impl Drop for Folder<'_> {
    fn drop(&mut self) {
        if self.made {
            // Only an empty folder can be removed so.
            let _ = std::fs::remove_dir(self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_files_give_the_same_bytes() {
        let make = || {
            let mut archive = Archive::default();
            archive.add("modelDescription.xml", "<a/>");
            archive.add_library("binaries/linux64/A.so", vec![1; 5000]);
            archive.bytes()
        };
        assert_eq!(make(), make());
        let mut zip = zip::ZipArchive::new(Cursor::new(make())).unwrap();
        assert_eq!(zip.by_index(0).unwrap().unix_mode().map(|mode| mode & 0o777), Some(0o644));
        let library = zip.by_index(1).unwrap();
        assert_eq!(library.unix_mode().map(|mode| mode & 0o777), Some(0o755));
        assert!(library.compressed_size() < 100);
        assert_eq!(library.last_modified().map(|time| time.year()), Some(1980));
    }

    #[test]
    fn nothing_is_left_when_a_folder_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let error = Folder::open(&file).unwrap_err().to_string();
        assert!(error.contains("cannot make the folder"), "{error}");
        let out = Folder::open(folder.path()).unwrap();
        out.write("a.fmu", b"one").unwrap();
        out.write("a.fmu", b"two").unwrap();
        assert_eq!(std::fs::read(folder.path().join("a.fmu")).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
