//! The FMU's resources: where they are, and the parameter set in them.

use std::{
    ffi::c_void,
    io::ErrorKind,
    path::{Path, PathBuf},
};

use strut_model::{Interface, Model, Numbering, ParameterSet, VariableKind};

use super::log::Failure;

/// Name of the parameter set in the resources; without it the declared start values hold.
const PARAMETER_SET: &str = "parameters.toml";

/// What an instance is made from, each time that it is reset.
#[derive(Debug)]
pub struct Origin {
    /// Folder of the resources.
    pub resources: Option<PathBuf>,
    /// The parameter set in it.
    pub set: Option<ParameterSet>,
    /// The identifier of model and parameter set.
    pub guid: String,
    /// Number of event indicators.
    pub event_indicators: usize,
    /// The value references of FMI 3.0.
    pub numbering: Numbering,
    /// Whether a setting is an enumeration, by its reference.
    pub choices: Vec<bool>,
}

impl Origin {
    /// Reads the resources and checks that they belong to the description that the host has read. Without a folder it is
    /// looked for beside the library with this address.
    pub fn find<M: Model>(
        guid: &str,
        resources: Option<PathBuf>,
        library: *const c_void,
    ) -> Result<Self, Failure> {
        let resources = resources.or_else(|| beside_library(library));
        let set = resources.as_deref().map(read).transpose().map_err(Failure::error)?.flatten();
        let interface =
            Interface::of::<M>(set.as_ref(), resources.as_deref()).map_err(|error| match &resources {
                Some(folder) => {
                    Failure::error(format!("{} does not fit {}: {error}", folder.display(), M::ABOUT.name))
                }
                None => error.into(),
            })?;
        let is_choice = |kind: &VariableKind| matches!(kind, VariableKind::Choice { .. });
        let settings = interface.numbering().settings as usize;
        let origin = Self {
            resources,
            set,
            guid: interface.guid(),
            event_indicators: interface.event_indicators,
            numbering: interface.numbering(),
            choices: interface.variables[settings..]
                .iter()
                .map(|variable| is_choice(&variable.kind))
                .collect(),
        };
        if guid == origin.guid { Ok(origin) } else { Err(origin.stranger(guid, M::ABOUT.name)) }
    }

    /// Says that description, library and parameter set do not belong together.
    fn stranger(&self, guid: &str, model: &str) -> Failure {
        let start_values = match (&self.resources, &self.set) {
            (Some(folder), Some(_)) => {
                format!("the start values of {}", folder.join(PARAMETER_SET).display())
            }
            (Some(folder), None) => {
                format!("its declared start values, as there is no {PARAMETER_SET} in {}", folder.display())
            }
            (None, _) => "its declared start values, as no resource location was given".into(),
        };
        Failure::error(format!(
            "the GUID {guid:?} is not {:?}, that of {model} with {start_values}: modelDescription.xml, library and \
             {PARAMETER_SET} do not belong together; take all of them from one and the same FMU",
            self.guid
        ))
    }
}

/// The parameter set in a folder, if there is one.
fn read(folder: &Path) -> Result<Option<ParameterSet>, String> {
    let path = folder.join(PARAMETER_SET);
    match std::fs::read_to_string(&path) {
        Ok(text) => ParameterSet::parse(&text).map(Some).map_err(|error| {
            format!(
                "{} is no parameter set: {error}; unpack the FMU again or repair the file",
                path.display()
            )
        }),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
        Err(error) => Err(format!(
            "{} cannot be read: {error}; check the permissions of the unpacked FMU",
            path.display()
        )),
    }
}

/// The resources of the FMU that the library with this address was unpacked with: it is in
/// `binaries/<platform>`.
fn beside_library(address: *const c_void) -> Option<PathBuf> {
    let folder = library(address)?.parent()?.join("../../resources");
    folder.is_dir().then_some(folder)
}

/// The file of the library with this address, as the loader knows it.
#[cfg(unix)]
fn library(address: *const c_void) -> Option<PathBuf> {
    use std::{
        ffi::{CStr, OsStr},
        mem::MaybeUninit,
        os::unix::ffi::OsStrExt,
    };

    let mut info = MaybeUninit::<libc::Dl_info>::zeroed();
    // SAFETY: `dladdr` takes any address and writes to `info`, for which zeros are valid too.
    let info = unsafe {
        if libc::dladdr(address, info.as_mut_ptr()) == 0 {
            return None;
        }
        info.assume_init()
    };
    if info.dli_fname.is_null() {
        return None;
    }
    // SAFETY: the loader's name of the library ends with a zero and lives as long as the library.
    let name = unsafe { CStr::from_ptr(info.dli_fname) };
    Some(OsStr::from_bytes(name.to_bytes()).into())
}

/// The file of the library with this address, as the loader knows it.
#[cfg(windows)]
fn library(address: *const c_void) -> Option<PathBuf> {
    use std::{ffi::OsString, os::windows::ffi::OsStringExt, ptr};
    use windows_sys::Win32::System::LibraryLoader::{
        GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS, GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
        GetModuleFileNameW, GetModuleHandleExW,
    };

    const FLAGS: u32 = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    /// No path is longer.
    const LONGEST: u32 = 0x8000;

    let mut module = ptr::null_mut();
    let mut name = vec![0; LONGEST as usize];
    // SAFETY: with these flags any address may be asked for, and the module stays loaded: we are in it.
    // The name is written to a buffer of the length that is told.
    let length = unsafe {
        if GetModuleHandleExW(FLAGS, address.cast(), &mut module) == 0 {
            return None;
        }
        GetModuleFileNameW(module, name.as_mut_ptr(), LONGEST)
    };
    (length > 0).then(|| OsString::from_wide(&name[..length as usize]).into())
}

/// Elsewhere a library is not asked where it is.
#[cfg(not(any(unix, windows)))]
fn library(_: *const c_void) -> Option<PathBuf> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_set_may_be_absent_but_not_broken() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(read(folder.path()), Ok(None));
        assert_eq!(read(&folder.path().join("nowhere")), Ok(None));
        let path = folder.path().join(PARAMETER_SET);
        std::fs::write(&path, "fmu = [").unwrap();
        let error = read(folder.path()).unwrap_err();
        assert!(error.contains(path.to_str().unwrap()) && error.contains("TOML"), "{error}");
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir(&path).unwrap();
        assert!(read(folder.path()).unwrap_err().contains("cannot be read"));
    }
}
