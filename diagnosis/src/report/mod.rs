//! What was found, for people and programs: `report.html`, `report.json` and a summary for the terminal.

mod evidence;
mod json;
mod page;
mod plot;
mod terminal;
mod words;

pub use json::json;
pub use page::html;
pub use terminal::terminal;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::findings::Findings;

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The folder is not there and cannot be made.
    #[error("cannot make the folder `{}` for the report: {cause}; choose another with --out", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write `{}`: {cause}; make room or grant write access there, or choose another folder with --out", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        cause: io::Error,
    },
}

/// Writes `report.html` and `report.json` into a folder, which is made if need be. Each file is either
/// complete or as it was before.
///
/// # Errors
/// If the folder cannot be made or a file cannot be written.
pub fn write(findings: &Findings, folder: &Path) -> Result<(), ReportError> {
    std::fs::create_dir_all(folder)
        .map_err(|cause| ReportError::Folder { folder: folder.to_owned(), cause })?;
    for (name, text) in [("report.json", json(findings)), ("report.html", html(findings))] {
        let path = folder.join(name);
        replace(&path, folder, &text).map_err(|cause| ReportError::File { path, cause })?;
    }
    Ok(())
}

/// A file in the same folder is written first and takes the name when it is complete.
fn replace(path: &Path, folder: &Path, text: &str) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    // A temporary file is its owner's alone; a report is for whoever may read the folder.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.prefix(".report").tempfile_in(folder)?;
    file.write_all(text.as_bytes())?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|failure| failure.error)?;
    Ok(())
}
