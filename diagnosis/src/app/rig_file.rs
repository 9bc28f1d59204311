//! Rig files: a first one of a model, and what one allows to find.

use std::path::{Path, PathBuf};

use crate::report::capability::{Foreign, capability};
use crate::report::{augment, file};
use crate::rig::{Draft, Rig, difference};

/// Writes a first rig file of a model; what to do next, as text.
///
/// # Errors
/// If the file is there already or cannot be written, or the model cannot be read: what to do.
pub fn create(model: &str, out: Option<&Path>) -> Result<String, String> {
    if let Some(path) = out {
        // The program takes a word for a file by its ending.
        if path.extension().is_none_or(|it| it != "toml") {
            return Err(format!("--out {}: the name of a rig file has to end with .toml", path.display()));
        }
        free(path)?;
    }
    let folder = out.and_then(Path::parent).filter(|it| !it.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(format!("--out: there is no folder `{}`; make it first", folder.display()));
    }
    let draft = Draft::of(model, folder)?;
    let path = out.map_or_else(|| PathBuf::from(format!("{}.toml", draft.name)), Path::to_owned);
    free(&path)?;
    file::create(&path, &draft.text).map_err(|error| {
        format!("cannot write `{}`: {error}; choose another file with --out", path.display())
    })?;
    let path = path.display();
    let guesses = draft.text.lines().filter(|it| it.contains("# GUESS")).count();
    let guesses = match guesses {
        0 => String::new(),
        _ => "; check the entries marked GUESS".to_owned(),
    };
    Ok(format!("{path}{guesses}\n`diagnose check {path}` says what can be identified with it.\n"))
}

/// Refuses a name that is taken.
fn free(path: &Path) -> Result<(), String> {
    match path.symlink_metadata() {
        Ok(_) => Err(format!("`{}` is there already: choose another file with --out", path.display())),
        Err(_) => Ok(()),
    }
}

/// What can be identified with a rig file, as text.
///
/// # Errors
/// If the file or its model cannot be read, or the file names what the model does not have: all of it.
pub fn check(path: &Path) -> Result<String, String> {
    let rig = Rig::read(path)?;
    let failed = |error: String| format!("`{}`: {error}", path.display());
    let foreign = Foreign {
        unnamed: rig.unnamed_parameters().map_err(failed)?,
        difference: difference(&rig).map_err(failed)?,
        augmented: augment::possible(&rig),
    };
    capability(&rig, &foreign).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_file_is_written_once_and_can_be_checked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.toml");
        create("tum-quarter-vehicle", Some(&path)).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let refused = create("quarter-car", Some(&path)).unwrap_err();
        assert!(refused.contains("is there already"), "{refused}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        assert!(check(&path).unwrap().contains("strut"));
    }

    #[test]
    fn what_cannot_become_a_rig_file_is_refused_first() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |name: &str| create("quarter-car", Some(&folder.path().join(name))).unwrap_err();
        assert!(refused("mine.txt").contains("end with .toml"));
        assert!(refused("absent/mine.toml").contains("no folder"));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
