//! What was found, for people and programs: `report.html`, `report.json` and a summary for the terminal; and, before there is
//! anything to be found, what a rig's records may hold.

pub mod assembly;
pub mod augment;
pub mod capability;
mod evidence;
pub mod extend;
pub mod file;
pub mod findings;
mod json;
mod page;
mod plot;
pub mod provenance;
mod sheet;
mod terminal;
pub(crate) mod words;

pub use json::json;
pub use page::html;
pub use sheet::{rigs, sheet};
pub use terminal::{read, shares, terminal};

use std::io;
use std::path::{Path, PathBuf};

use crate::experiment;
use crate::report::file::replace;
use crate::report::findings::Findings;

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

/// Writes `report.html`, `report.json` and the files of an experiment into a folder, which is made if need be, and removes what an
/// earlier run left there. Each file is
/// either complete or as it was before, and one that fails does not keep the others from being written.
///
/// # Errors
/// If the folder cannot be made, or every file that cannot be written.
pub fn write(findings: &Findings, folder: &Path) -> Result<(), Vec<ReportError>> {
    std::fs::create_dir_all(folder)
        .map_err(|cause| vec![ReportError::Folder { folder: folder.to_owned(), cause }])?;
    let mut failures = Vec::new();
    let mut note = |path: PathBuf, done: io::Result<()>| {
        failures.extend(done.err().map(|cause| ReportError::File { path, cause }));
    };
    let texts = [("report.json", json(findings)), ("report.html", html(findings))];
    let texts = texts.iter().map(|(name, text)| (*name, text));
    let files = findings.deciding_experiment.iter().flat_map(|it| &it.files);
    for (name, text) in texts.chain(files.map(|(name, text)| (&name[..], text))) {
        let path = folder.join(name);
        let done = replace(&path, text);
        note(path, done);
    }
    // An experiment or an extended model of an earlier run would pass for this one's.
    let written = |name: &str| {
        findings.deciding_experiment.iter().any(|it| it.files.iter().any(|(own, _)| own == name))
    };
    for name in experiment::FILES.into_iter().chain(extend::FILES).filter(|name| !written(name)) {
        let path = folder.join(name);
        if path.exists() {
            let done = std::fs::remove_file(&path);
            note(path, done);
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures) }
}
