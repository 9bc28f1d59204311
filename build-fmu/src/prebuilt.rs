//! Libraries that are there already.
//!
//! An FMU with another parameter set is the same library with another description and other resources. A folder of
//! libraries takes the place of cargo:
//!
//! ```text
//! libraries/
//!   linux64/QuarterCar-1f0c5b7e9a3d4c21.so     one for each model, below the platform's folder in an FMU
//!   resources/profile.csv                      the files that published parameter sets bring
//! ```
//!
//! The number in a library's name is a hash of the model's declarations and of the sources that it was compiled from. A
//! library of another version has another name, and is not found.

use std::env;
use std::path::{Path, PathBuf};

use strut_model::Entry;
use uuid::Uuid;

use crate::failure::{Failure, Result};
use crate::platform::Platform;

/// The variable that names the folder.
pub const VARIABLE: &str = "STRUT_LIBRARIES";

/// The folder's name beside an installed program.
const BESIDE: &str = "libraries";

/// Below the folder: files of published parameter sets.
pub const RESOURCES: &str = "resources";

/// A folder of libraries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prebuilt(PathBuf);

impl Prebuilt {
    /// The folder that is given, or else named by the environment, or else `libraries` beside the program or its
    /// folder; none if there is none.
    ///
    /// # Errors
    /// If the folder that is given is none.
    pub fn find(given: Option<&Path>) -> Result<Option<Self>> {
        let named = given.map(Path::to_owned).or_else(|| env::var_os(VARIABLE).map(PathBuf::from));
        if let Some(folder) = named {
            if !folder.is_dir() {
                return Err(Failure::new(format!("there is no folder `{}` of libraries", folder.display()))
                    .help("make it by `build-fmu libraries --out DIR`"));
            }
            return Ok(Some(Self(folder)));
        }
        let program = env::current_exe().and_then(|program| program.canonicalize()).unwrap_or_default();
        let beside = program.ancestors().skip(1).take(2).map(|folder| folder.join(BESIDE));
        // What cargo builds lies in a folder of its own choice.
        Ok(beside.into_iter().find(|folder| folder.join(RESOURCES).is_dir()).map(Self))
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.0
    }

    /// Where the files of published parameter sets are.
    pub fn resources(&self) -> PathBuf {
        self.0.join(RESOURCES)
    }

    /// The library of a model for a platform, if it is there.
    ///
    /// # Errors
    /// If the model cannot be declared.
    pub fn library(&self, entry: &Entry, platform: &Platform) -> Result<Option<PathBuf>> {
        let path = self.0.join(&platform.folder).join(file(entry, platform)?);
        Ok(path.is_file().then_some(path))
    }
}

/// The name of a model's library.
///
/// # Errors
/// If the model cannot be declared.
pub fn file(entry: &Entry, platform: &Platform) -> Result<String> {
    let name = entry.about.name;
    let declared =
        entry.interface(None, None).map_err(|error| Failure::new(format!("{name}: {error}")))?.guid();
    let both = format!("{declared} {}", env!("STRUT_SOURCES"));
    let number = Uuid::new_v5(&Uuid::NAMESPACE_OID, both.as_bytes()).simple().to_string();
    Ok(format!("{name}-{}{}", &number[..16], platform.ending))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str) -> &'static Entry {
        strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == name).unwrap()
    }

    #[test]
    fn a_library_is_found_by_platform_and_number_and_by_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let [linux, windows] =
            ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu"].map(|it| Platform::of(it).unwrap());
        let car = entry("QuarterCar");
        let name = file(car, &linux).unwrap();
        assert!(name.starts_with("QuarterCar-") && name.ends_with(".so") && name.len() == 11 + 16 + 3);
        std::fs::create_dir(folder.path().join("linux64")).unwrap();
        std::fs::write(folder.path().join("linux64/QuarterCar-0000000000000000.so"), "").unwrap();
        let prebuilt = Prebuilt::find(Some(folder.path())).unwrap().unwrap();
        assert_eq!(prebuilt.library(car, &linux).unwrap(), None);
        std::fs::write(folder.path().join("linux64").join(&name), "").unwrap();
        assert!(prebuilt.library(car, &linux).unwrap().unwrap().ends_with(name));
        assert_eq!(prebuilt.library(car, &windows).unwrap(), None);
        assert_eq!(prebuilt.library(entry("FullCar"), &linux).unwrap(), None);
    }

    #[test]
    fn a_folder_that_is_missing_is_an_error() {
        let error = Prebuilt::find(Some(Path::new("nowhere"))).unwrap_err().to_string();
        assert!(error.contains("no folder `nowhere`") && error.contains("build-fmu libraries"), "{error}");
    }
}
