//! Which folder of an FMU belongs to which Rust target.

use crate::failure::{Failure, Result};

/// A target to build for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Platform {
    /// As given: `x86_64-unknown-linux-gnu.2.17`.
    pub given: String,
    /// As `rustc` knows it: `x86_64-unknown-linux-gnu`.
    pub triple: String,
    /// The oldest glibc to run with, if it is given: `2.17`. `cargo zigbuild` takes care of it.
    pub glibc: Option<String>,
    /// Folder below `binaries/`.
    pub folder: String,
    /// The folder where masters look for it that know one processor only; free if there is no library
    /// for that processor.
    pub known_as: Option<String>,
    /// Ending of a shared library, with the dot.
    pub ending: &'static str,
}

impl Platform {
    /// The platform of a target triple.
    ///
    /// # Errors
    /// If the triple has no operating system that loads shared libraries.
    pub fn of(given: &str) -> Result<Self> {
        let (triple, glibc) = match given.split_once("-gnu.") {
            Some((front, version)) if version.chars().all(|c| c.is_ascii_digit() || c == '.') => {
                (format!("{front}-gnu"), Some(version.to_owned()))
            }
            _ => (given.to_owned(), None),
        };
        let (arch, rest) = triple.split_once('-').unwrap_or((&triple, ""));
        let (system, ending) = match rest {
            rest if rest.contains("linux") => ("linux", ".so"),
            rest if rest.contains("windows") => ("windows", ".dll"),
            rest if rest.contains("apple-darwin") => ("darwin", ".dylib"),
            _ => {
                return Err(Failure::new(format!("`{given}` is no target that FMUs are made for"))
                    .help("targets are named like x86_64-unknown-linux-gnu or x86_64-pc-windows-msvc"));
            }
        };
        // FMI 2.0.5, section 2.3, names Intel's platforms; the others are FMI 3.0's tuples.
        let short = if system == "windows" { "win" } else { system };
        let (folder, known_as) = match arch {
            "x86_64" => (format!("{short}64"), None),
            "i586" | "i686" => (format!("{short}32"), None),
            // FMPy 0.3.32, OMSimulator, fmusim and the `fmi` crate look here for every library of 64 bits.
            "aarch64" => (format!("{arch}-{system}"), Some(format!("{short}64"))),
            _ => (format!("{arch}-{system}"), None),
        };
        Ok(Self { given: given.to_owned(), triple, glibc, folder, known_as, ending })
    }
}

impl Platform {
    /// The platform tuple of FMI 3.0 (section 2.5.1.4.1).
    pub fn tuple(&self) -> String {
        let arch = match self.triple.split('-').next().unwrap_or_default() {
            "i586" | "i686" => "x86",
            other => other,
        };
        let system = match self.ending {
            ".dll" => "windows",
            ".dylib" => "darwin",
            _ => "linux",
        };
        format!("{arch}-{system}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_those_of_the_standard() {
        for (triple, folder, ending) in [
            ("x86_64-unknown-linux-gnu", "linux64", ".so"),
            ("x86_64-unknown-linux-gnu.2.17", "linux64", ".so"),
            ("x86_64-unknown-linux-musl", "linux64", ".so"),
            ("i686-pc-windows-msvc", "win32", ".dll"),
            ("x86_64-pc-windows-gnu", "win64", ".dll"),
            ("x86_64-apple-darwin", "darwin64", ".dylib"),
            ("aarch64-apple-darwin", "aarch64-darwin", ".dylib"),
            ("aarch64-unknown-linux-gnu", "aarch64-linux", ".so"),
        ] {
            let platform = Platform::of(triple).unwrap();
            assert_eq!((platform.folder.as_str(), platform.ending), (folder, ending), "{triple}");
        }
    }

    #[test]
    fn tuples_are_those_of_the_standard() {
        for (triple, tuple) in [
            ("x86_64-unknown-linux-gnu.2.17", "x86_64-linux"),
            ("i686-pc-windows-msvc", "x86-windows"),
            ("x86_64-pc-windows-gnu", "x86_64-windows"),
            ("aarch64-apple-darwin", "aarch64-darwin"),
            ("aarch64-unknown-linux-gnu", "aarch64-linux"),
        ] {
            assert_eq!(Platform::of(triple).unwrap().tuple(), tuple);
        }
    }

    #[test]
    fn a_glibc_version_is_not_part_of_the_triple() {
        let platform = Platform::of("x86_64-unknown-linux-gnu.2.17").unwrap();
        assert_eq!(
            (platform.triple.as_str(), platform.glibc.as_deref()),
            ("x86_64-unknown-linux-gnu", Some("2.17"))
        );
        assert_eq!(Platform::of("x86_64-unknown-linux-gnu").unwrap().glibc, None);
    }

    #[test]
    fn other_targets_are_refused() {
        assert!(
            Platform::of("wasm32-unknown-unknown").unwrap_err().to_string().contains("no target that FMUs")
        );
    }
}
