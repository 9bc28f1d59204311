//! What a shared library is and needs, read from its file: nothing is loaded.

use object::read::elf::FileHeader;
use object::{Architecture, BinaryFormat, Endianness, Object, elf};

/// A shared library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binary {
    /// Folder of `binaries/` that it belongs into; none for machines that FMI has no name for.
    pub platform: Option<&'static str>,
    /// Names of the exported functions, sorted.
    pub exports: Vec<String>,
    /// Shared libraries that it needs.
    pub needs: Vec<String>,
    /// Newest version of glibc that a function of it needs, on Linux.
    pub glibc: Option<(u32, u32)>,
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
        let glibc = match file.format() {
            BinaryFormat::Elf if file.is_64() => {
                glibc::<elf::FileHeader64<Endianness>>(bytes).map_err(damaged)?
            }
            BinaryFormat::Elf => glibc::<elf::FileHeader32<Endianness>>(bytes).map_err(damaged)?,
            _ => None,
        };
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

/// The newest version of glibc among the versions that symbols are bound to.
fn glibc<E: FileHeader<Endian = Endianness>>(bytes: &[u8]) -> object::Result<Option<(u32, u32)>> {
    let header = E::parse(bytes)?;
    let endian = header.endian()?;
    let sections = header.sections(endian, bytes)?;
    let mut glibc = None;
    if let Some((mut list, strings)) = sections.gnu_verneed(endian, bytes)? {
        let strings = sections.strings(endian, bytes, strings)?;
        while let Some((_, mut versions)) = list.next()? {
            while let Some(version) = versions.next()? {
                let name = version.name(endian, strings)?;
                glibc = glibc.max(glibc_version(&String::from_utf8_lossy(name)));
            }
        }
    }
    Ok(glibc)
}

/// `GLIBC_2.17` is (2, 17).
fn glibc_version(name: &str) -> Option<(u32, u32)> {
    let (major, rest) = name.strip_prefix("GLIBC_")?.split_once('.')?;
    let minor = rest.split('.').next()?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_glibc_are_numbers() {
        assert_eq!(glibc_version("GLIBC_2.2.5"), Some((2, 2)));
        assert_eq!(glibc_version("GLIBC_2.33"), Some((2, 33)));
        assert_eq!(glibc_version("GCC_3.0"), None);
    }

    #[test]
    fn the_running_program_is_no_puzzle() {
        let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let binary = Binary::parse(&program).unwrap();
        if cfg!(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu")) {
            assert_eq!(binary.platform, Some("linux64"));
            assert!(binary.needs.iter().any(|name| name.starts_with("libc.so")), "{binary:?}");
            assert!(binary.glibc >= Some((2, 2)), "{binary:?}");
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
