//! What a shared library needs of the machine that loads it.
//!
//! A library that does not load is the fault of an FMU that users meet most, and it loads on the machine
//! that built it. So every library is asked once it is built.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::path::Path;

use strut_binary::{Binary, Glibc};

use crate::cargo::Libraries;
use crate::failure::{Failure, Result};
use crate::platform::Platform;

/// What libraries need of the machine that loads them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The oldest glibc that has every function that is called; none where there is no glibc.
    glibc: Option<Glibc>,
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
        let failed =
            |error: &dyn Display| Failure::new(format!("`{}` cannot be read: {error}", path.display()));
        let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
        let binary = Binary::parse(&bytes).map_err(|error| failed(&error))?;
        let libraries = binary.unusual().into_iter().map(str::to_owned).collect();
        Ok(Self { glibc: binary.glibc, libraries })
    }

    /// Who names a glibc wants libraries that load wherever that is.
    fn check(&self, platform: &Platform, path: &Path) -> Result<()> {
        let Some(asked) = &platform.glibc else { return Ok(()) };
        if self.glibc <= asked.parse().ok() && self.libraries.is_empty() {
            return Ok(());
        }
        Err(Failure::new(format!("`{}` is for glibc {asked}, but needs {self}", path.display()))
            .help("ask for a newer glibc, or do without what it calls of others"))
    }
}

impl Display for Needs {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let glibc = self.glibc.iter().map(|oldest| format!("glibc {oldest} or newer"));
        let all: Vec<String> = glibc.chain(self.libraries.iter().cloned()).collect();
        if all.is_empty() { write!(f, "nothing but the system") } else { write!(f, "{}", all.join(", ")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(glibc: &str, libraries: &[&str]) -> Needs {
        let libraries = libraries.iter().map(|name| (*name).to_owned()).collect();
        Needs { glibc: glibc.parse().ok(), libraries }
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
        assert!(own.glibc >= "2.2.5".parse().ok(), "{own}");
        assert!(own.libraries.iter().all(|name| name == "libgcc_s.so.1"), "{own}");
        let error = Needs::of_library(Path::new(file!())).unwrap_err().to_string();
        assert!(error.contains("cannot be read"), "{error}");
    }
}
