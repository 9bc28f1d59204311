//! Cargo builds the libraries.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{BufReader, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use cargo_metadata::camino::Utf8Path;
use cargo_metadata::{CrateType, Message, Metadata, MetadataCommand};

use crate::failure::{Failure, Result, similar};
use crate::toolchain::Toolchain;

/// How a library that ships is compiled, in whatever workspace it stands: as the release profile of
/// Strut's own workspace has it, and so that it is the same bytes wherever and whenever that is done. The
/// linker for Windows writes the names of its temporary files among the symbols, and the time.
const SHIPPED: [&str; 7] = [
    "--release",
    "--config",
    "profile.release.codegen-units=1",
    "--config",
    "profile.release.strip='symbols'",
    "--config",
    "target.'cfg(all(windows, target_env = \"gnu\"))'.rustflags=['-Clink-arg=-Wl,--no-insert-timestamp']",
];

/// The program that runs us, or the one in the path.
pub fn program() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// What cargo knows about a manifest.
///
/// # Errors
/// If there is none or it is broken: in cargo's words.
pub fn metadata(manifest: Option<&Path>) -> Result<Metadata> {
    let mut command = MetadataCommand::new();
    if let Some(manifest) = manifest {
        command.manifest_path(manifest);
    }
    command.no_deps().exec().map_err(|error| match error {
        cargo_metadata::Error::CargoMetadata { stderr } if stderr.contains("could not find `Cargo.toml`") => {
            Failure::new("there is neither a folder of prebuilt libraries nor a workspace that builds them")
                .help("run it in a checkout of Strut, name the folder by --libraries, or your own crate by --manifest-path")
        }
        cargo_metadata::Error::CargoMetadata { stderr } => {
            Failure::new(format!("cargo does not understand the manifest\n{}", stderr.trim()))
        }
        cargo_metadata::Error::Io(error) if error.kind() == ErrorKind::NotFound => {
            Failure::new("there is no cargo, which builds the libraries of FMUs")
                .help("install Rust (rustup.rs), or give a folder of prebuilt libraries by --libraries")
        }
        other => Failure::new(format!("cannot ask cargo for the packages: {other}")),
    })
}

/// The manifest of the workspace: where `cargo run` found us, else above the working folder.
pub fn workspace_manifest() -> Option<PathBuf> {
    std::env::var_os("CARGO_MANIFEST_DIR")
        .map(|folder| PathBuf::from(folder).join("Cargo.toml"))
        .filter(|it| it.exists())
}

/// The libraries of packages, by package name.
pub type Libraries = BTreeMap<String, PathBuf>;

/// Builds the shared libraries of packages by a toolchain, in one go, in a target folder.
///
/// # Errors
/// If a package is missing or the build fails.
pub fn build(
    metadata: &Metadata,
    packages: &[String],
    toolchain: &Toolchain,
    target: &Utf8Path,
) -> Result<Libraries> {
    for package in packages {
        if !metadata.packages.iter().any(|other| other.name.as_str() == package) {
            let names = metadata.packages.iter().map(|package| package.name.as_str());
            let failure = Failure::new(format!(
                "there is no package `{package}` in `{}`",
                metadata.workspace_root
            ))
            .help("every model is built by a package of its own, `fmu-` and the model's name in kebab-case");
            return Err(match similar(package, names.filter(|name| name.starts_with("fmu-"))) {
                Some(help) => failure.help(help),
                None => failure,
            });
        }
    }
    let mut command = Command::new(program());
    command.arg(toolchain.subcommand());
    command.args(SHIPPED).args(["--lib", "--message-format=json-render-diagnostics", "--manifest-path"]);
    command.arg(metadata.workspace_root.join("Cargo.toml")).arg("--target-dir").arg(target);
    for package in packages {
        command.args(["--package", package]);
    }
    toolchain.configure(&mut command);
    let failed = |error: std::io::Error| Failure::new(format!("cannot run cargo: {error}"));
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(failed)?;
    let output = child.stdout.take().expect("the output was asked for");
    let mut libraries = Libraries::new();
    for message in Message::parse_stream(BufReader::new(output)) {
        if let Message::CompilerArtifact(artifact) = message.map_err(failed)?
            && artifact.target.crate_types.contains(&CrateType::CDyLib)
            && let Some(package) = metadata.packages.iter().find(|package| package.id == artifact.package_id)
            && let Some(file) = artifact
                .filenames
                .iter()
                .find(|file| matches!(file.extension(), Some("so" | "dll" | "dylib")))
        {
            libraries.insert(package.name.to_string(), file.clone().into());
        }
    }
    if !child.wait().map_err(failed)?.success() {
        return Err(Failure::new("the libraries cannot be built; cargo says why above"));
    }
    match packages.iter().find(|package| !libraries.contains_key(*package)) {
        None => Ok(libraries),
        Some(package) => Err(Failure::new(format!("package `{package}` makes no shared library"))
            .help("its Cargo.toml needs `[lib]` with `crate-type = [\"cdylib\"]` (add \"rlib\" for a model of your own)")),
    }
}

/// `QuarterCar` is built by the package `fmu-quarter-car`.
pub fn package_of(model: &str) -> String {
    let mut name = String::from("fmu");
    for c in model.chars() {
        if c.is_ascii_uppercase() {
            name.push('-');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_named_after_their_model() {
        assert_eq!(package_of("QuarterCar"), "fmu-quarter-car");
        assert_eq!(package_of("ForceTwoDofLpv"), "fmu-force-two-dof-lpv");
    }
}
