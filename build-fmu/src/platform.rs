//! Which folder of an FMU belongs to which Rust target.

use crate::failure::{Failure, Result};

/// A target to build for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Platform {
    /// As given: `x86_64-unknown-linux-gnu.2.17`.
    pub given: String,
    /// As `rustc` knows it: `x86_64-unknown-linux-gnu`.
    pub triple: String,
    /// Whether it carries a glibc version, which `cargo zigbuild` takes care of.
    pub glibc: bool,
    /// Folder below `binaries/`.
    pub folder: String,
    /// Ending of a shared library, with the dot.
    pub ending: &'static str,
}

impl Platform {
    /// The platform of a target triple.
    ///
    /// # Errors
    /// If the triple has no operating system that loads shared libraries.
    pub fn of(given: &str) -> Result<Self> {
        let triple = match given.split_once("-gnu.") {
            Some((front, version)) if version.chars().all(|c| c.is_ascii_digit() || c == '.') => {
                format!("{front}-gnu")
            }
            _ => given.to_owned(),
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
        // FMI 2.0, section 2.3, names only Intel's platforms; the others follow FMI 3.0's `arch-system`.
        let folder = match (arch, system) {
            ("x86_64", "windows") => "win64".into(),
            ("i586" | "i686", "windows") => "win32".into(),
            ("x86_64", _) => format!("{system}64"),
            ("i586" | "i686", _) => format!("{system}32"),
            _ => format!("{arch}-{system}"),
        };
        Ok(Self { glibc: triple != given, given: given.to_owned(), triple, folder, ending })
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
    fn a_glibc_version_is_not_part_of_the_triple() {
        let platform = Platform::of("x86_64-unknown-linux-gnu.2.17").unwrap();
        assert_eq!((platform.triple.as_str(), platform.glibc), ("x86_64-unknown-linux-gnu", true));
    }

    #[test]
    fn other_targets_are_refused() {
        assert!(
            Platform::of("wasm32-unknown-unknown").unwrap_err().to_string().contains("no target that FMUs")
        );
    }
}
