//! The FMU of a rig file's model: a file, or made from a crate.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// In a process that was started for an FMU: the FMU that has been made of a crate, so that it is not made again.
pub const MADE: &str = "STRUT_FMU_OF_CRATE";

/// Whether a file is an FMU, by its ending.
pub fn is_fmu(path: &Path) -> bool {
    path.extension().and_then(OsStr::to_str).is_some_and(|it| it.eq_ignore_ascii_case("fmu"))
}

/// Whether a file is the manifest of a crate.
pub fn is_manifest(path: &Path) -> bool {
    path.file_name().is_some_and(|it| it == "Cargo.toml")
}

/// The FMU of a model's file. Of a crate, it is made at the first time.
///
/// # Errors
/// If the crate is none with a model, or cargo cannot compile it: what to do.
pub fn fmu_of(model: &Path) -> Result<PathBuf, String> {
    static ALL: Mutex<BTreeMap<PathBuf, PathBuf>> = Mutex::new(BTreeMap::new());
    if !is_manifest(model) {
        return Ok(model.to_owned());
    }
    if let Some(made) = std::env::var_os(MADE) {
        return Ok(made.into());
    }
    let mut all = ALL.lock().map_err(|error| error.to_string())?;
    if let Some(made) = all.get(model) {
        return Ok(made.clone());
    }
    let made = build_fmu::make_own(model)?;
    all.insert(model.to_owned(), made.clone());
    Ok(made)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_is_known_by_its_manifest_and_an_fmu_by_its_ending() {
        assert!(is_manifest(Path::new("my-rig/Cargo.toml")) && !is_manifest(Path::new("rig.toml")));
        assert!(is_fmu(Path::new("a/B.FMU")) && !is_fmu(Path::new("Cargo.toml")));
        assert_eq!(fmu_of(Path::new("a/B.fmu")).unwrap(), Path::new("a/B.fmu"));
        let error = fmu_of(Path::new("nowhere/Cargo.toml")).unwrap_err();
        assert!(error.contains("there is no manifest `nowhere/Cargo.toml`"), "{error}");
    }
}
