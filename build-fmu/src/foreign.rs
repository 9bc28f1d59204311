//! A model in a crate outside this workspace.
//!
//! Its declarations are known to a program that links it. Such a program is a manifest and five lines
//! of Rust: they are written below the crate's target folder and run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{CrateType, Metadata, MetadataCommand, Package as Described, Target};

use crate::cargo;
use crate::failure::{Failure, Result};

/// What a packager is made of, beside the model and what others have published.
const OWN: [&str; 5] =
    ["build-fmu", "strut-binary", "strut-check", "strut-model-description", "strut-related"];
/// How far it is optimised.
const QUICKLY: u8 = 0;

/// A crate with a model.
#[derive(Debug)]
pub struct Package {
    described: Described,
    metadata: Metadata,
}

/// The package of a manifest; none if it is a part of the workspace that we are from.
///
/// # Errors
/// If cargo does not understand the manifest or the crate is of another make.
pub fn package(manifest: &Path) -> Result<Option<Package>> {
    if !manifest.is_file() {
        return Err(Failure::new(format!("there is no manifest `{}`", manifest.display()))
            .help("give the path of the Cargo.toml of your model's crate"));
    }
    // Asked without dependencies first: that needs no network and tells most mistakes.
    let alone = cargo::metadata(Some(manifest))?;
    if alone.packages.iter().any(|package| package.name.as_str() == env!("CARGO_PKG_NAME")) {
        let own = manifest.canonicalize().ok();
        let root = alone.workspace_root.join("Cargo.toml");
        return match alone.packages.iter().find(|it| own.as_deref() == Some(it.manifest_path.as_std_path())) {
            Some(member) if member.manifest_path != root => Err(Failure::new(format!(
                "`{}` is a member of Strut's workspace, whose FMUs are built together",
                member.name
            ))
            .help("add an empty `[workspace]` to its Cargo.toml, and take it out of the members, to build it alone")),
            _ => Ok(None),
        };
    }
    let metadata = MetadataCommand::new()
        .manifest_path(manifest)
        .exec()
        .map_err(|error| Failure::new(format!("cannot ask cargo for the packages: {error}")))?;
    let described = metadata.root_package().cloned().ok_or_else(|| {
        Failure::new(format!("`{}` is a workspace without a package", manifest.display()))
            .help("give the Cargo.toml of your model's crate")
    })?;
    Ok(Some(Package { described, metadata }))
}

impl Package {
    /// Runs the packager with our own arguments, and returns its exit code.
    ///
    /// # Errors
    /// If the crate is no library or does not use Strut, or cargo does not run.
    pub fn run(&self) -> Result<ExitCode> {
        // `strut fmu …` is our `build-fmu …`.
        let mut ours = std::env::args_os().skip(1).peekable();
        ours.next_if(|word| word == "fmu");
        let mut command = self.packager()?;
        self.ended(command.args(ours))
    }

    /// Makes the FMU below the crate's target folder; its path.
    ///
    /// # Errors
    /// If the crate is no library or does not use Strut, or its FMU cannot be made.
    pub fn fmu(&self) -> Result<PathBuf> {
        let out = self.folder().join("fmus").into_std_path_buf();
        let failed = |error: std::io::Error| Failure::new(format!("`{}`: {error}", out.display()));
        let mut command = self.packager()?;
        // An earlier version of the model may have had another name.
        if out.exists() {
            fs::remove_dir_all(&out).map_err(failed)?;
        }
        let code = self.ended(command.arg("--out").arg(&out).stdout(Stdio::null()))?;
        let made = fs::read_dir(&out).ok().and_then(|mut files| Some(files.next()?.ok()?.path()));
        made.filter(|_| code == ExitCode::SUCCESS).ok_or_else(|| {
            Failure::new(format!("there is no FMU of `{}`; its packager says why above", self.described.name))
        })
    }

    /// Where the packager and what it makes are.
    fn folder(&self) -> Utf8PathBuf {
        self.metadata.target_directory.join("build-fmu").join(self.described.name.as_str())
    }

    /// Writes the packager; what runs it.
    fn packager(&self) -> Result<Command> {
        let folder = self.folder();
        let library = self.library()?;
        let write = |file: &str, text: &str| write_if_changed(&folder.join(file).into_std_path_buf(), text);
        write("Cargo.toml", &self.manifest()?)?;
        write("src/main.rs", &self.program(&library.name))?;
        let mut target = None;
        if let Some(root) = self.strut_root() {
            // What this program was made of is compiled already, in the versions of its lock file.
            let lock = root.join("Cargo.lock");
            if !folder.join("Cargo.lock").exists() && lock.exists() {
                let _ = fs::copy(lock, folder.join("Cargo.lock"));
            }
            target = cargo::metadata(Some(&root.join("Cargo.toml"))).ok().map(|strut| strut.target_directory);
        }
        let cargo = |subcommand: &str| {
            let mut command = Command::new(cargo::program());
            command.args([subcommand, "--quiet", "--manifest-path"]).arg(folder.join("Cargo.toml"));
            // As this program was compiled, so that its dependencies are found compiled.
            if !cfg!(debug_assertions) {
                command.arg("--release");
            }
            if let Some(target) = &target {
                command.arg("--target-dir").arg(target);
            }
            command
        };
        let failed = |error: std::io::Error| Failure::new(format!("cannot run cargo: {error}"));
        eprintln!("note: compiling a packager for `{}`", self.described.name);
        let built = cargo("build").stdout(Stdio::inherit()).output().map_err(failed)?;
        let said = String::from_utf8_lossy(&built.stderr);
        eprint!("{said}");
        if !built.status.success() {
            return Err(self.refused(&said));
        }
        let mut command = cargo("run");
        command.arg("--");
        Ok(command)
    }

    fn ended(&self, packager: &mut Command) -> Result<ExitCode> {
        let status = packager.status().map_err(|error| Failure::new(format!("cannot run cargo: {error}")))?;
        match status.code() {
            Some(code @ 0..=2) => Ok(ExitCode::from(code as u8)),
            _ => {
                Err(Failure::new(format!("the packager of `{}` ended early: {status}", self.described.name)))
            }
        }
    }

    /// What to do where cargo does not build the packager.
    fn refused(&self, said: &str) -> Failure {
        let name = &self.described.name;
        if !said.contains(&format!("could not compile `{name}`")) {
            return Failure::new(format!("the packager of `{name}` cannot be built; cargo says why above"))
                .help(
                    "its lib.rs must end with `strut_fmi::export_fmu!(YourModel);`, outside of any module",
                );
        }
        let failure = Failure::new(format!("`{name}` does not compile; cargo says why above"));
        // What the compiler advises would make a model without derivatives.
        if said.contains("PartialOrd") {
            failure.help("a value decides by `select`: `x.select(a, b)` is a where x > 0, and b elsewhere")
        } else {
            failure
        }
    }

    /// The library, which must be linkable from C and from Rust.
    fn library(&self) -> Result<&Target> {
        let name = &self.described.name;
        let has = |target: &Target, ty: CrateType| target.crate_types.contains(&ty);
        self.described
            .targets
            .iter()
            .find(|target| {
                has(target, CrateType::CDyLib)
                    && (has(target, CrateType::RLib) || has(target, CrateType::Lib))
            })
            .ok_or_else(|| {
                Failure::new(format!("`{name}` is not both a shared library and a Rust library"))
                    .help("write `crate-type = [\"cdylib\", \"rlib\"]` under `[lib]` in its Cargo.toml")
            })
    }

    fn strut_model(&self) -> Option<&Described> {
        self.metadata.packages.iter().find(|package| package.name.as_str() == "strut-model")
    }

    /// The root of the workspace that the crate takes strut-model from, if it is on this machine.
    fn strut_root(&self) -> Option<PathBuf> {
        let model = self.strut_model().filter(|model| model.source.is_none())?;
        Some(model.manifest_path.parent()?.parent()?.parent()?.into())
    }

    /// Depends on the crate and on this packager, from where the crate has strut-model: another
    /// copy's types would be other types.
    fn manifest(&self) -> Result<String> {
        let model = self.strut_model().ok_or_else(|| {
            Failure::new(format!("`{}` does not depend on strut-model", self.described.name))
                .help("a model implements `strut_model::Model`")
        })?;
        let packager = match (self.strut_root(), &model.source) {
            (Some(root), _) => format!("path = {}", quoted(&root.join("build-fmu").to_string_lossy())),
            (None, Some(source)) if source.repr.starts_with("git+") => git(&source.repr),
            _ => format!("version = \"={}\"", model.version),
        };
        let folder = self.described.manifest_path.parent().map_or("", |folder| folder.as_str());
        Ok(format!(
            "# Written by build-fmu.\n[package]\nname = \"packager-of-{name}\"\nedition = \"2024\"\npublish = false\n\n\
             {}\n[dependencies]\nbuild-fmu = {{ {packager}, default-features = false }}\nmodel = {{ package = {}, path = {} }}\n\n[workspace]\n",
            self.profiles(),
            quoted(&self.described.name),
            quoted(folder),
            name = self.described.name,
        ))
    }

    /// The profiles of Strut's workspace: what is compiled in others is compiled again. That holds for the packager's own
    /// crates in any case, and optimising them would take longer than they run.
    fn profiles(&self) -> String {
        let manifest = self.strut_root().and_then(|root| fs::read_to_string(root.join("Cargo.toml")).ok());
        let manifest = manifest.and_then(|text| text.parse::<toml::Table>().ok());
        let mut manifest = manifest.unwrap_or_default();
        manifest.retain(|key, _| key == "profile");
        let level = |profile, name| format!("[profile.{profile}.package.{name}]\nopt-level = {QUICKLY}\n");
        let own = OWN.iter().flat_map(|name| ["dev", "release"].map(|profile| level(profile, name)));
        manifest.to_string() + &own.collect::<String>()
    }

    fn program(&self, library: &str) -> String {
        let license = self.described.license.as_deref().unwrap_or_default();
        format!(
            "//! Knows the declarations of `{library}`. Written by build-fmu.\n\n\
             fn main() -> std::process::ExitCode {{\n    build_fmu::main(&build_fmu::Project {{\n        \
             catalogue: &[model::ENTRY],\n        parameter_sets: &[],\n        systems: &[],\n        \
             source: build_fmu::Source::Package {{ manifest: {:?}, name: {:?} }},\n        license: {license:?},\n        literature: \"\",\n    \
             }})\n}}\n",
            self.described.manifest_path.as_str(),
            self.described.name.as_str(),
        )
    }
}

/// `git+https://host/repo?branch=main#0123` as a dependency of the same source.
fn git(source: &str) -> String {
    let source = source.trim_start_matches("git+");
    let address = source.split('#').next().unwrap_or(source);
    match address.split_once('?') {
        None => format!("git = {}", quoted(address)),
        Some((url, query)) => {
            let (key, value) = query.split_once('=').unwrap_or(("branch", query));
            format!("git = {}, {key} = {}", quoted(url), quoted(value))
        }
    }
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// An unchanged file keeps its date, and cargo has nothing to do.
fn write_if_changed(path: &Path, text: &str) -> Result<()> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|error| Failure::new(format!("cannot write `{}`: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_git_source_stays_the_same_source() {
        assert_eq!(git("git+https://a.b/c?tag=v1#0a1b"), "git = \"https://a.b/c\", tag = \"v1\"");
        assert_eq!(git("git+https://a.b/c#0a1b"), "git = \"https://a.b/c\"");
    }
}
