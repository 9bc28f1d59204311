//! Where the libraries of the models come from: a folder of prebuilt ones, or else cargo.

use std::cell::OnceCell;
use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::Metadata;
use strut_model::Entry;

use crate::archive::Folder;
use crate::cargo::{self, Libraries};
use crate::cli::{Arguments, LibrariesArguments};
use crate::failure::{Failure, Result};
use crate::needs::Needs;
use crate::platform::Platform;
use crate::prebuilt::{self, Prebuilt, RESOURCES};
use crate::toolchain::{self, Toolchain};
use crate::{Project, Source};

/// Where models, their files and their libraries are. Cargo is asked only when it is needed.
#[derive(Debug)]
pub struct Origin<'a> {
    project: &'a Project<'a>,
    manifest: Option<PathBuf>,
    prebuilt: Option<Prebuilt>,
    metadata: OnceCell<Metadata>,
}

impl<'a> Origin<'a> {
    /// That of a command line.
    ///
    /// # Errors
    /// If the folder of libraries that it names is missing.
    pub fn new(project: &'a Project<'a>, arguments: &Arguments) -> Result<Self> {
        let (manifest, prebuilt) = match project.source {
            Source::Package { manifest, .. } => (Some(PathBuf::from(manifest)), None),
            Source::Workspace { .. } => (
                arguments.manifest_path.clone().or_else(cargo::workspace_manifest),
                Prebuilt::find(arguments.libraries.as_deref())?,
            ),
        };
        Ok(Self { project, manifest, prebuilt, metadata: OnceCell::new() })
    }

    /// What cargo knows.
    fn metadata(&self) -> Result<&Metadata> {
        if let Some(metadata) = self.metadata.get() {
            return Ok(metadata);
        }
        let metadata = cargo::metadata(self.manifest.as_deref())?;
        let is_ours = metadata.packages.iter().any(|it| it.name.as_str() == env!("CARGO_PKG_NAME"));
        if matches!(self.project.source, Source::Workspace { .. }) && !is_ours {
            let here = &metadata.workspace_root;
            return Err(Failure::new(format!("`{here}` is no checkout of Strut"))
                .help("for the model of this crate: --manifest-path Cargo.toml")
                .help("for Strut's models: name a folder of prebuilt libraries by --libraries"));
        }
        Ok(self.metadata.get_or_init(|| metadata))
    }

    /// The folder of the files that parameter sets bring.
    ///
    /// # Errors
    /// If there is neither a folder of libraries nor cargo.
    pub fn files(&self) -> Result<PathBuf> {
        if let Some(prebuilt) = &self.prebuilt
            && prebuilt.resources().is_dir()
        {
            return Ok(prebuilt.resources());
        }
        let root = self.metadata()?.workspace_root.as_std_path();
        Ok(match self.project.source {
            Source::Workspace { files } => root.join(files),
            Source::Package { .. } => root.into(),
        })
    }

    /// The package that builds the library of a model.
    pub fn package(&self, entry: &Entry) -> String {
        match self.project.source {
            Source::Workspace { .. } => cargo::package_of(entry.about.name),
            Source::Package { name, .. } => name.to_owned(),
        }
    }

    /// Finds the libraries of models for each platform, and what can build those that are not there: a target that is
    /// not installed is found out before the first is built.
    ///
    /// # Errors
    /// If a library is not there and nothing can build it.
    pub fn find(
        &self,
        models: &[Entry],
        platforms: &[Platform],
        arguments: &Arguments,
    ) -> Result<Vec<Found>> {
        platforms
            .iter()
            .map(|platform| {
                let mut found = Found {
                    platform: platform.clone(),
                    libraries: Libraries::new(),
                    missing: Vec::new(),
                    toolchain: Toolchain::HOST,
                };
                for entry in models {
                    let package = self.package(entry);
                    match self.prebuilt(entry, platform)? {
                        Some(path) => {
                            found.libraries.insert(package, path);
                        }
                        None => found.missing.push(package),
                    }
                }
                found.missing.sort();
                found.missing.dedup();
                if !found.missing.is_empty() {
                    found.toolchain = self.toolchain(platform, arguments).map_err(|failure| {
                        failure.help_if(self.prebuilt.as_ref().map(|it| not_there(it, &found)))
                    })?;
                }
                Ok(found)
            })
            .collect()
    }

    /// The prebuilt library of a model, if it is there and runs where it is asked to.
    fn prebuilt(&self, entry: &Entry, platform: &Platform) -> Result<Option<PathBuf>> {
        let Some(prebuilt) = &self.prebuilt else { return Ok(None) };
        let path = prebuilt.library(entry, platform)?;
        let fits = |path: &PathBuf| {
            let one = Libraries::from([(String::new(), path.clone())]);
            platform.glibc.is_none() || Needs::of(platform, &one).is_ok()
        };
        Ok(path.filter(fits))
    }

    fn toolchain(&self, platform: &Platform, arguments: &Arguments) -> Result<Toolchain> {
        self.metadata()?;
        if arguments.targets.is_empty() {
            return Ok(Toolchain::HOST);
        }
        Toolchain::of(platform, arguments.cross.as_deref())
    }

    /// Builds missing libraries, and returns all of a platform.
    ///
    /// # Errors
    /// If cargo fails.
    pub fn build(&self, found: Found) -> Result<(Platform, Libraries)> {
        let Found { platform, mut libraries, missing, toolchain } = found;
        // Told of no package, cargo would build the workspace.
        if !missing.is_empty() {
            let metadata = self.metadata()?;
            let target = match self.project.source {
                Source::Workspace { .. } => metadata.target_directory.clone(),
                // The packager links the crate's Rust library. A shared library that is built beside it takes its place, as
                // cargo gives both one name, and the next packager is not compiled.
                Source::Package { .. } => metadata.target_directory.join("build-fmu/libraries"),
            };
            libraries.extend(cargo::build(metadata, &missing, &toolchain, &target)?);
        }
        Ok((platform, libraries))
    }
}

/// The libraries for a platform.
#[derive(Debug)]
pub struct Found {
    /// The platform.
    platform: Platform,
    /// Those that are there, by package.
    libraries: Libraries,
    /// The packages that cargo has to build.
    missing: Vec<String>,
    /// What builds them.
    toolchain: Toolchain,
}

fn not_there(prebuilt: &Prebuilt, found: &Found) -> String {
    format!(
        "`{}` has no library for {} of {}",
        prebuilt.folder().display(),
        found.platform.given,
        found.missing.join(", ")
    )
}

/// The platforms that are asked for.
///
/// # Errors
/// If a target is none that FMUs are made for, or two are the same in an FMU.
pub fn platforms(targets: &[String]) -> Result<Vec<Platform>> {
    if targets.is_empty() {
        return Ok(vec![toolchain::host()?]);
    }
    let mut platforms: Vec<Platform> = Vec::new();
    for target in targets {
        let platform = Platform::of(target)?;
        if let Some(other) = platforms.iter().find(|other| other.folder == platform.folder) {
            return Err(Failure::new(format!(
                "`{}` and `{}` are both `{}` in an FMU",
                other.given, platform.given, platform.folder
            ))
            .help("give one of them"));
        }
        platforms.push(platform);
    }
    Ok(platforms)
}

/// Builds the library of every model into a folder that takes the place of cargo, and returns the lines to print.
///
/// # Errors
/// If cargo fails or the folder cannot be written.
pub fn store(project: &Project, arguments: &LibrariesArguments) -> Result<String> {
    let build = Arguments {
        targets: arguments.targets.clone(),
        cross: arguments.cross.clone(),
        libraries: arguments.libraries.clone(),
        ..Arguments::default()
    };
    let origin = Origin::new(project, &build)?;
    let platforms = platforms(&build.targets)?;
    let found = origin.find(project.catalogue, &platforms, &build)?;
    let files = origin.files()?;
    let mut lines = String::new();
    for found in found {
        let (platform, libraries) = origin.build(found)?;
        let path = arguments.out.join(&platform.folder);
        let folder = Folder::open(&path)?;
        for entry in project.catalogue {
            folder.write(&prebuilt::file(entry, &platform)?, &read(&libraries[&origin.package(entry)])?)?;
        }
        let needs = Needs::of(&platform, &libraries)?;
        lines += &format!("{}: {} libraries, which need {needs}\n", path.display(), project.catalogue.len());
    }
    // Last: a folder that is not complete is not taken for one of libraries.
    let path = arguments.out.join(RESOURCES);
    let folder = Folder::open(&path)?;
    for file in project.resources() {
        folder.write(&file, &read(&files.join(&file))?)?;
    }
    Ok(lines)
}

/// The contents of a file.
///
/// # Errors
/// If it cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).map_err(|error| Failure::new(format!("cannot read `{}`: {error}", path.display())))
}
