//! What a shared library is, exports and needs of the machine that loads it, read from its file: nothing is loaded.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use object::read::ImportFlags;
use object::{Architecture, BinaryFormat, Object};

/// A version of glibc, by its first two numbers: functions are added with these only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Glibc {
    /// 2 of 2.17.
    pub major: u32,
    /// 17 of 2.17.
    pub minor: u32,
}

impl Display for Glibc {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// `2.17`, or `2.2.5`.
impl FromStr for Glibc {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<u32>> = text.split('.').map(|part| part.parse().ok()).collect();
        match numbers.as_deref() {
            Some([major, minor, ..]) => Ok(Self { major: *major, minor: *minor }),
            _ => Err(format!("`{text}` is no version of glibc; one is written like 2.17")),
        }
    }
}

/// A shared library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    /// Folder of `binaries/` that it belongs into; none for machines that FMI has no name for.
    pub platform: Option<&'static str>,
    /// Names of the exported functions, sorted.
    pub exports: Vec<String>,
    /// Shared libraries that it needs.
    pub needs: Vec<String>,
    /// The oldest glibc that has every function that is called; none where there is no glibc.
    pub glibc: Option<Glibc>,
}

impl Binary {
    /// Reads a library.
    ///
    /// # Errors
    /// If it is no library of Linux, Windows or macOS, or damaged.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let damaged = |error: object::Error| format!("it is no shared library: {error}");
        let file = object::File::parse(bytes).map_err(damaged)?;
        let platform = match (file.format(), file.architecture()) {
            (BinaryFormat::Elf, Architecture::X86_64) => Some("linux64"),
            (BinaryFormat::Elf, Architecture::I386) => Some("linux32"),
            (BinaryFormat::Elf, Architecture::Aarch64) => Some("aarch64-linux"),
            (BinaryFormat::Pe, Architecture::X86_64) => Some("win64"),
            (BinaryFormat::Pe, Architecture::I386) => Some("win32"),
            (BinaryFormat::Pe, Architecture::Aarch64) => Some("aarch64-windows"),
            (BinaryFormat::MachO, Architecture::X86_64) => Some("darwin64"),
            (BinaryFormat::MachO, Architecture::Aarch64) => Some("aarch64-darwin"),
            _ => None,
        };
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let mut exports = Vec::new();
        for export in file.exports().map_err(damaged)? {
            exports.extend(export.map_err(damaged)?.name().name().map(text));
        }
        if file.format() == BinaryFormat::MachO {
            exports.iter_mut().for_each(|name| *name = name.trim_start_matches('_').to_owned());
        }
        exports.sort();
        exports.dedup();
        let mut needs = Vec::new();
        for library in file.import_libraries().map_err(damaged)? {
            needs.push(text(library.map_err(damaged)?.name()));
        }
        let mut glibc = None;
        for import in file.imports().map_err(damaged)? {
            if let ImportFlags::Elf { version: Some(version), .. } = import.map_err(damaged)?.flags() {
                glibc = glibc.max(glibc_of(version));
            }
        }
        needs.sort();
        needs.dedup();
        Ok(Self { platform, exports, needs, glibc })
    }

    /// Those of some functions that it does not export.
    pub fn lacks<'a>(&self, functions: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
        let lacks = |name: &&str| !self.exports.iter().any(|export| export == name);
        functions.into_iter().filter(lacks).collect()
    }

    /// The libraries that not every machine with this system has.
    pub fn unusual(&self) -> Vec<&str> {
        self.needs.iter().map(String::as_str).filter(|name| !is_system_library(name)).collect()
    }
}

/// Part of glibc, of Windows since 7 or of macOS: there is no machine without.
fn is_system_library(name: &str) -> bool {
    let lower = name.to_lowercase();
    let linux = ["libc.so", "libm.so", "libpthread.so", "libdl.so", "librt.so", "ld-linux", "linux-vdso"];
    let windows = [
        "kernel32",
        "user32",
        "ntdll",
        "msvcrt",
        "advapi32",
        "ws2_32",
        "shell32",
        "ole32",
        "bcrypt",
        "userenv",
        "gdi32",
        "shlwapi",
        "psapi",
        "synchronization",
        "api-ms-win-",
        "ucrtbase",
    ];
    linux.iter().chain(&windows).any(|known| lower.starts_with(known)) || lower.contains("libsystem")
}

/// The version in a symbol's: `GLIBC_2.17`; others are not glibc's.
fn glibc_of(version: &[u8]) -> Option<Glibc> {
    str::from_utf8(version).ok()?.strip_prefix("GLIBC_")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_count_part_by_part() {
        let version = |major, minor| Some(Glibc { major, minor });
        assert_eq!(glibc_of(b"GLIBC_2.2.5"), version(2, 2));
        assert_eq!(glibc_of(b"GLIBC_2.33"), version(2, 33));
        assert!(glibc_of(b"GLIBC_2.4") < glibc_of(b"GLIBC_2.17"));
        assert_eq!((glibc_of(b"GLIBC_PRIVATE"), glibc_of(b"GCC_3.0")), (None, None));
        assert!("two".parse::<Glibc>().unwrap_err().contains("like 2.17"));
    }

    #[test]
    fn the_running_program_is_no_puzzle() {
        let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let binary = Binary::parse(&program).unwrap();
        if cfg!(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu")) {
            assert_eq!(binary.platform, Some("linux64"));
            assert!(binary.needs.iter().any(|name| name.starts_with("libc.so")), "{binary:?}");
            assert!(binary.glibc >= "2.2.5".parse().ok(), "{binary:?}");
        }
        assert!(Binary::parse(b"no library").unwrap_err().contains("no shared library"));
    }

    #[test]
    fn system_libraries_are_everywhere() {
        for name in ["libm.so.6", "ld-linux-x86-64.so.2", "KERNEL32.dll", "api-ms-win-crt-math-l1-1-0.dll"] {
            assert!(is_system_library(name), "{name}");
        }
        for name in ["libpython3.10.so.1.0", "libgcc_s.so.1", "VCRUNTIME140.dll", "libgfortran.so.5"] {
            assert!(!is_system_library(name), "{name}");
        }
    }
}
