//! What a shared library needs of the machine that loads it.
//!
//! A library that does not load is the fault of an FMU that users meet most, and it loads on the machine
//! that built it. So every library is asked once it is built.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::path::Path;

use object::read::{File, ImportFlags, Object};

use crate::cargo::Libraries;
use crate::failure::{Failure, Result};
use crate::platform::Platform;

/// What every machine of a platform has: the C library's parts, or what comes with Windows 10.
const GLIBC: [&str; 6] = ["libc.so", "libm.so", "libpthread.so", "libdl.so", "librt.so", "ld-linux"];
const WINDOWS: [&str; 11] = [
    "advapi32.dll",
    "api-ms-win-",
    "bcrypt.dll",
    "bcryptprimitives.dll",
    "kernel32.dll",
    "msvcrt.dll",
    "ntdll.dll",
    "shell32.dll",
    "ucrtbase.dll",
    "userenv.dll",
    "ws2_32.dll",
];
const MACOS: [&str; 1] = ["/usr/lib/libSystem"];

/// Parts of a version, of which the first counts most: glibc 2.17 is `[2, 17]`.
type Version = Vec<u32>;

/// What libraries need of the machine that loads them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The oldest glibc that has every function that is called; none where there is no glibc.
    glibc: Option<Version>,
    /// Shared libraries that not every machine of the platform has.
    libraries: BTreeSet<String>,
}

impl Needs {
    /// What the libraries of a platform need.
    ///
    /// # Errors
    /// If one cannot be read, or needs more than was asked for.
    pub fn of(platform: &Platform, libraries: &Libraries) -> Result<Self> {
        let mut needs = Self::default();
        for path in libraries.values() {
            let one = Self::of_library(path)?;
            one.check(platform, path)?;
            needs.glibc = needs.glibc.max(one.glibc);
            needs.libraries.extend(one.libraries);
        }
        Ok(needs)
    }

    fn of_library(path: &Path) -> Result<Self> {
        let failed = |error: &dyn Display| {
            Failure::new(format!("`{}` cannot be read as a shared library: {error}", path.display()))
        };
        let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
        Self::of_bytes(&bytes).map_err(|error| failed(&error))
    }

    fn of_bytes(bytes: &[u8]) -> object::Result<Self> {
        let file = File::parse(bytes)?;
        let mut needs = Self::default();
        for import in file.imports()? {
            if let ImportFlags::Elf { version: Some(version), .. } = import?.flags() {
                needs.glibc = needs.glibc.max(glibc(version));
            }
        }
        for library in file.import_libraries()? {
            let name = String::from_utf8_lossy(library?.name()).into_owned();
            let common =
                |known: &&str| name.get(..known.len()).is_some_and(|it| it.eq_ignore_ascii_case(known));
            if ![&GLIBC[..], &WINDOWS, &MACOS].concat().iter().any(common) {
                needs.libraries.insert(name);
            }
        }
        Ok(needs)
    }

    /// Who names a glibc wants libraries that load wherever that is.
    fn check(&self, platform: &Platform, path: &Path) -> Result<()> {
        let Some(asked) = &platform.glibc else { return Ok(()) };
        if self.glibc <= parse(asked) && self.libraries.is_empty() {
            return Ok(());
        }
        Err(Failure::new(format!("`{}` is for glibc {asked}, but needs {self}", path.display()))
            .help("ask for a newer glibc, or do without what it calls of others"))
    }
}

impl Display for Needs {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let version = |parts: &Version| parts.iter().map(u32::to_string).collect::<Vec<_>>().join(".");
        let glibc = self.glibc.iter().map(|parts| format!("glibc {} or newer", version(parts)));
        let all: Vec<String> = glibc.chain(self.libraries.iter().cloned()).collect();
        if all.is_empty() { write!(f, "nothing but the system") } else { write!(f, "{}", all.join(", ")) }
    }
}

/// The version in a symbol's version: `GLIBC_2.17`; others are not glibc's.
fn glibc(version: &[u8]) -> Option<Version> {
    parse(str::from_utf8(version).ok()?.strip_prefix("GLIBC_")?)
}

fn parse(version: &str) -> Option<Version> {
    version.split('.').map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(glibc: &str, libraries: &[&str]) -> Needs {
        let libraries = libraries.iter().map(|name| (*name).to_owned()).collect();
        Needs { glibc: parse(glibc), libraries }
    }

    #[test]
    fn versions_count_part_by_part() {
        assert!(glibc(b"GLIBC_2.4") < glibc(b"GLIBC_2.17"));
        assert!(glibc(b"GLIBC_2.2.5") < glibc(b"GLIBC_2.3"));
        assert_eq!((glibc(b"GLIBC_PRIVATE"), glibc(b"GCC_3.0")), (None, None));
    }

    #[test]
    fn what_is_asked_for_is_held() {
        let platform = Platform::of("x86_64-unknown-linux-gnu.2.17").unwrap();
        let path = Path::new("libfmu.so");
        assert_eq!(needs("2.14", &[]).check(&platform, path), Ok(()));
        assert_eq!(needs("2.17", &[]).check(&platform, path), Ok(()));
        let error = needs("2.33", &[]).check(&platform, path).unwrap_err().to_string();
        assert!(error.contains("for glibc 2.17, but needs glibc 2.33 or newer"), "{error}");
        let error = needs("2.2.5", &["libgcc_s.so.1"]).check(&platform, path).unwrap_err().to_string();
        assert!(error.contains("libgcc_s.so.1"), "{error}");
        let any = Platform::of("x86_64-unknown-linux-gnu").unwrap();
        assert_eq!(needs("2.33", &["libgcc_s.so.1"]).check(&any, path), Ok(()));
    }

    /// This very program is an object file, too.
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[test]
    fn a_program_of_this_machine_needs_glibc() {
        let own = Needs::of_library(&std::env::current_exe().unwrap()).unwrap();
        assert!(own.glibc >= parse("2.2.5"), "{own}");
        assert!(own.libraries.iter().all(|name| name == "libgcc_s.so.1"), "{own}");
        let error = Needs::of_library(Path::new(file!())).unwrap_err().to_string();
        assert!(error.contains("cannot be read"), "{error}");
    }
}
