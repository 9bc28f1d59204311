//! Which compiler and linker build for a platform.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::{Failure, Result, similar};
use crate::platform::Platform;

/// What `build-fmu/cross/toolchain` makes a standard library and a linker for.
const MADE: [&str; 2] = ["x86_64-pc-windows-gnu", "aarch64-unknown-linux-gnu"];

/// How cargo is told to build for a platform.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toolchain {
    /// As cargo is told; none for this machine.
    target: Option<String>,
    /// Whether zig links, which knows every version of glibc.
    zig: bool,
    /// The folder of a compiler that takes the place of the usual one.
    cross: Option<PathBuf>,
}

impl Toolchain {
    /// The usual compiler, for this machine.
    pub const HOST: Self = Self { target: None, zig: false, cross: None };

    /// What builds for a platform: the usual compiler if it has the target, else the one in the folder
    /// `cross`.
    ///
    /// # Errors
    /// If neither has the target, or zig is needed and missing: what to install.
    pub fn of(platform: &Platform, cross: Option<&Path>) -> Result<Self> {
        let Platform { given, triple, glibc, .. } = platform;
        // Who builds the standard library along with the rest needs none for the target.
        let built_along = std::env::var_os("CARGO_UNSTABLE_BUILD_STD").is_some();
        let cross =
            if built_along || is_installed(&usual(), triple)? { None } else { Some(other(triple, cross)?) };
        let runs = |program: &str| {
            Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
        };
        if glibc.is_some() && !runs("cargo-zigbuild") {
            return Err(Failure::new(format!("building for the glibc of `{given}` needs cargo-zigbuild"))
                .help("run `pip install ziglang cargo-zigbuild`, or build without the version"));
        }
        Ok(Self { target: Some(given.clone()), zig: glibc.is_some(), cross })
    }

    /// The command of cargo that builds.
    pub fn subcommand(&self) -> &'static str {
        if self.zig { "zigbuild" } else { "build" }
    }

    /// Adds target, compiler and linker to such a command.
    pub fn configure(&self, command: &mut Command) {
        if let Some(target) = &self.target {
            command.args(["--target", target]);
        }
        if let Some(cross) = &self.cross {
            command.env("RUSTC", compiler(cross));
            // What is said here counts more than zig's linker, which is set in the environment.
            if !self.zig {
                command.arg("--config").arg(cross.join("linkers.toml"));
            }
        }
    }
}

/// The folder of the other compiler, if it has the target.
fn other(triple: &str, cross: Option<&Path>) -> Result<PathBuf> {
    let targets = rustc(&usual(), &["--print", "target-list"])?;
    if !targets.lines().any(|target| target == triple) {
        let failure = Failure::new(format!("rustc knows no target `{triple}`"));
        let help = similar(triple, targets.lines());
        return Err(help.into_iter().fold(failure, Failure::help));
    }
    if let Some(given) = cross {
        // As an absolute path: cargo runs the compiler in other folders.
        let folder = given.canonicalize().ok().filter(|folder| compiler(folder).is_file());
        let folder = folder.ok_or_else(|| {
            Failure::new(format!("there is no toolchain in `{}`", given.display())).help(
                "make one by `build-fmu/cross/toolchain`; it tells the folder for --cross or STRUT_CROSS",
            )
        })?;
        if is_installed(&compiler(&folder), triple)? {
            return Ok(folder);
        }
    }
    Err(not_installed(triple))
}

fn not_installed(triple: &str) -> Failure {
    let failure = Failure::new(format!("the target `{triple}` is not installed"))
        .help(format!("run `rustup target add {triple}`"));
    if !MADE.contains(&triple) {
        return failure;
    }
    failure.help(
        "where rustup cannot, on Debian: run `build-fmu/cross/toolchain` and give its folder by --cross",
    )
}

fn compiler(cross: &Path) -> PathBuf {
    cross.join("bin/rustc")
}

/// Whether a compiler has the standard library of a target.
fn is_installed(compiler: &Path, triple: &str) -> Result<bool> {
    let sysroot = rustc(compiler, &["--print", "sysroot"])?;
    Ok(Path::new(sysroot.trim()).join("lib/rustlib").join(triple).join("lib").is_dir())
}

/// The compiler that cargo takes.
fn usual() -> PathBuf {
    std::env::var_os("RUSTC").map_or_else(|| "rustc".into(), PathBuf::from)
}

/// What a compiler prints.
fn rustc(compiler: &Path, arguments: &[&str]) -> Result<String> {
    match Command::new(compiler).args(arguments).output() {
        Ok(output) if output.status.success() => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        Ok(output) => {
            Err(Failure::new(format!("rustc fails: {}", String::from_utf8_lossy(&output.stderr).trim())))
        }
        Err(error) => Err(Failure::new(format!("cannot run `{}`: {error}", compiler.display()))),
    }
}

/// The target of this machine: the compiler's, and where there is none, that of this program.
///
/// # Errors
/// If FMUs are not made for it.
pub fn host() -> Result<Platform> {
    let version = rustc(&usual(), &["-vV"]).unwrap_or_default();
    match version.lines().find_map(|line| line.strip_prefix("host: ")) {
        Some(host) => Platform::of(host),
        None => Platform::of(&own()),
    }
}

/// The target of this program, as far as it names a platform.
fn own() -> String {
    let system = match std::env::consts::OS {
        "linux" => "unknown-linux-gnu",
        "windows" => "pc-windows-gnu",
        "macos" => "apple-darwin",
        other => other,
    };
    let arch = if cfg!(target_arch = "x86") { "i686" } else { std::env::consts::ARCH };
    format!("{arch}-{system}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With a compiler or without.
    #[test]
    fn this_program_runs_on_the_platform_of_its_compiler() {
        assert_eq!(Platform::of(&own()).unwrap().folder, host().unwrap().folder);
    }

    #[test]
    fn the_script_is_named_where_it_helps() {
        for triple in MADE {
            let error = not_installed(triple).to_string();
            assert!(
                error.contains(&format!("rustup target add {triple}")) && error.contains("cross/toolchain")
            );
        }
        assert!(!not_installed("x86_64-apple-darwin").to_string().contains("cross/toolchain"));
    }

    #[test]
    fn zig_links_where_a_glibc_is_given() {
        let toolchain = |zig| Toolchain { target: None, zig, cross: Some("/cross".into()) };
        let told = |zig| {
            let mut command = Command::new("cargo");
            toolchain(zig).configure(&mut command);
            format!("{command:?}")
        };
        assert_eq!((toolchain(true).subcommand(), toolchain(false).subcommand()), ("zigbuild", "build"));
        assert!(told(false).contains("linkers.toml") && told(false).contains("/cross/bin/rustc"));
        assert!(!told(true).contains("linkers.toml") && told(true).contains("/cross/bin/rustc"));
    }
}
