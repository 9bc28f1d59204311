//! From the command line to the files.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use unicode_width::UnicodeWidthStr;

use crate::archive::Folder;
use crate::cargo::{self, Libraries};
use crate::cli::Arguments;
use crate::failure::{Failure, Result};
use crate::fmu::{Fmu, Packed};
use crate::plan::{Component, Plan};
use crate::platform::Platform;
use crate::system::{self, Face, System};
use crate::{Project, Source, foreign, table};

/// Does what the arguments say.
///
/// # Errors
/// Whatever goes wrong first.
pub fn run(project: &Project, arguments: &Arguments) -> Result<ExitCode> {
    if let (Some(manifest), Source::Workspace { .. }) = (&arguments.manifest_path, project.source)
        && let Some(package) = foreign::package(manifest)?
    {
        return package.run();
    }
    print(&build(project, arguments)?);
    Ok(ExitCode::SUCCESS)
}

/// Builds what the arguments ask for from the project's own models; returns what is to be told.
///
/// # Errors
/// Whatever goes wrong first.
pub fn build(project: &Project, arguments: &Arguments) -> Result<String> {
    let manifest = match project.source {
        Source::Package { manifest, .. } => Some(PathBuf::from(manifest)),
        Source::Workspace { .. } => arguments.manifest_path.clone().or_else(cargo::workspace_manifest),
    };
    let metadata = cargo::metadata(manifest.as_deref())?;
    let files = match project.source {
        Source::Workspace { files } => metadata.workspace_root.as_std_path().join(files),
        Source::Package { .. } => metadata.workspace_root.as_std_path().into(),
    };
    let mut plan = Plan::new(project, arguments, &files)?;
    if arguments.list {
        return listing(&plan);
    }
    let platforms = platforms(&arguments.targets)?;
    // Mistakes in systems come to light before minutes of compiling.
    let mut needed = plan.wanted.clone();
    let assemblies = assemble(project, &mut plan)?;
    assemblies.iter().try_for_each(|assembly| assembly.runs_on(&platforms))?;
    needed.extend(assemblies.iter().flat_map(Assembly::ours));
    needed.sort_unstable();
    needed.dedup();
    let folder = Folder::open(&arguments.out)?;
    let package = |fmu: &Fmu| match project.source {
        Source::Workspace { .. } => cargo::package_of(fmu.entry.about.name),
        Source::Package { name, .. } => name.to_owned(),
    };
    let mut packages: Vec<String> = needed.iter().map(|index| package(&plan.fmus[*index])).collect();
    packages.sort();
    packages.dedup();
    let mut built: Vec<(Platform, Libraries)> = Vec::new();
    for (platform, asked) in platforms {
        let libraries = cargo::build(&metadata, &packages, asked.then_some(&platform))?;
        built.push((platform, libraries));
    }
    let progress = progress(needed.len() + assemblies.len());
    let mut packed: BTreeMap<usize, Packed> = BTreeMap::new();
    let mut rows = Vec::new();
    for index in needed {
        let fmu = &plan.fmus[index];
        progress.set_message(fmu.name.clone());
        let libraries = built
            .iter()
            .map(|(platform, libraries)| Ok((platform.clone(), library(&libraries[&package(fmu)])?)))
            .collect::<Result<Vec<_>>>()?;
        let result = fmu.pack(&libraries, project.license)?;
        if plan.wanted.contains(&index) {
            let file = format!("{}.fmu", fmu.name);
            folder.write(&file, &result.bytes)?;
            rows.push(row(fmu, &result, &arguments.out.join(file)));
        }
        packed.insert(index, result);
        progress.inc(1);
    }
    for assembly in &assemblies {
        let system = &assembly.system;
        progress.set_message(system.name.clone());
        let bytes = assembly.pack(&plan, &packed);
        let file = format!("{}.ssp", system.name);
        folder.write(&file, &bytes)?;
        let parts = format!("{} FMUs", assembly.components.len());
        let path = arguments.out.join(file).display().to_string();
        rows.push(vec![
            system.name.clone(),
            "system".into(),
            parts,
            system.source.clone(),
            table::size(bytes.len()),
            path,
        ]);
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(table::aligned(&["NAME", "KIND", "IN → OUT", "PARAMETERS", "SIZE", "PATH"], &[4], &rows))
}

/// The platforms to build for, and whether they were asked for by name.
fn platforms(targets: &[String]) -> Result<Vec<(Platform, bool)>> {
    if targets.is_empty() {
        return Ok(vec![(cargo::host()?, false)]);
    }
    let mut platforms: Vec<(Platform, bool)> = Vec::new();
    for target in targets {
        let platform = Platform::of(target)?;
        if let Some((other, _)) = platforms.iter().find(|(other, _)| other.folder == platform.folder) {
            return Err(Failure::new(format!(
                "`{}` and `{}` are both `{}` in an FMU",
                other.given, platform.given, platform.folder
            ))
            .help("give one of them"));
        }
        platforms.push((platform, true));
    }
    Ok(platforms)
}

/// A system with all that it is made of.
struct Assembly {
    system: System,
    /// Those of the file, then the adapters.
    components: Vec<Component>,
    /// Of those of the file.
    faces: Vec<Face>,
}

/// Finds what the systems are made of and checks that it fits.
fn assemble(project: &Project, plan: &mut Plan) -> Result<Vec<Assembly>> {
    let mut assemblies = Vec::new();
    for (system, folder) in plan.systems.clone() {
        let mut components = plan.components(&system, &folder)?;
        let face = |component: &Component| match component {
            Component::Ours(index) => Ok(Face::of(&plan.fmus[*index].interface()?)),
            Component::Theirs(theirs) => Ok(theirs.face.clone()),
        };
        let faces = components.iter().map(face).collect::<Result<Vec<_>>>()?;
        let adapters = system.check(&faces)?;
        components.extend(plan.add(project, &system, &adapters)?.into_iter().map(Component::Ours));
        plan.check_files(&system, &components)?;
        assemblies.push(Assembly { system, components, faces });
    }
    Ok(assemblies)
}

impl Assembly {
    fn ours(&self) -> impl Iterator<Item = usize> {
        self.components.iter().filter_map(|component| match component {
            Component::Ours(index) => Some(*index),
            Component::Theirs(_) => None,
        })
    }

    /// A system runs where each of its FMUs has a binary.
    fn runs_on(&self, platforms: &[(Platform, bool)]) -> Result<()> {
        let theirs = || {
            self.components.iter().filter_map(|component| match component {
                Component::Ours(_) => None,
                Component::Theirs(theirs) => Some(theirs),
            })
        };
        let everywhere = |folder: &String| theirs().all(|theirs| theirs.platforms.contains(folder));
        if platforms.iter().any(|(platform, _)| everywhere(&platform.folder)) {
            return Ok(());
        }
        let ours: Vec<&str> = platforms.iter().map(|(platform, _)| platform.folder.as_str()).collect();
        let failure = Failure::new(format!(
            "the system {} would run nowhere: ours are built for {}",
            self.system.name,
            ours.join(", ")
        ));
        let failure = theirs().fold(failure, |failure, theirs| {
            failure.help(format!("`{}` has binaries for {}", theirs.file, theirs.platforms.join(", ")))
        });
        Err(failure
            .help("build for a platform that all have with --target, or ask for an export for this one"))
    }

    fn pack(&self, plan: &Plan, packed: &BTreeMap<usize, Packed>) -> Vec<u8> {
        let part = |component| match component {
            &Component::Ours(index) => system::Packed {
                title: plan.fmus[index].title(),
                file: component.file(plan),
                bytes: &packed[&index].bytes,
            },
            Component::Theirs(theirs) => {
                system::Packed { title: &theirs.title, file: theirs.file.clone(), bytes: &theirs.bytes }
            }
        };
        let parts: Vec<system::Packed> = self.components.iter().map(part).collect();
        self.system.pack(&self.faces, &parts)
    }
}

fn library(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| Failure::new(format!("cannot read `{}`: {error}", path.display())))
}

/// A bar on stderr; none if nobody looks.
fn progress(steps: usize) -> ProgressBar {
    let target = if std::io::stderr().is_terminal() {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let style = ProgressStyle::with_template("{prefix:>12.cyan.bold} [{bar:27}] {pos}/{len}: {msg}")
        .expect("a valid template")
        .progress_chars("=> ");
    ProgressBar::with_draw_target(Some(steps as u64), target).with_style(style).with_prefix("Packing")
}

fn row(fmu: &Fmu, packed: &Packed, path: &Path) -> Vec<String> {
    let mut row = described(fmu, &packed.interface);
    row.extend([table::size(packed.bytes.len()), path.display().to_string()]);
    row
}

fn described(fmu: &Fmu, interface: &strut_model::Interface) -> Vec<String> {
    let (inputs, outputs) = Fmu::ports(interface);
    let set =
        fmu.set.as_ref().map_or("–".into(), |set| format!("{} ({})", set.parsed.source, set.parsed.model));
    vec![fmu.name.clone(), fmu.entry.about.kind.name().into(), format!("{inputs} → {outputs}"), set]
}

/// What there is: with its title, since that is what one chooses by.
fn listing(plan: &Plan) -> Result<String> {
    let mut rows = Vec::new();
    for fmu in plan.wanted.iter().map(|index| &plan.fmus[*index]) {
        let mut row = described(fmu, &fmu.interface()?);
        row[3] = fmu.title().to_owned();
        rows.push(row);
    }
    for (system, _) in &plan.systems {
        rows.push(vec![
            system.name.clone(),
            "system".into(),
            format!("{} FMUs", system.components.len()),
            system.title.clone(),
        ]);
    }
    // What the names leave of a line of 120 columns.
    let name = rows.iter().map(|row| row[0].width()).max().unwrap_or(0);
    rows.iter_mut().for_each(|row| row[3] = shortened(&row[3], 93 - name));
    Ok(table::aligned(&["NAME", "KIND", "IN → OUT", "WHAT IT IS"], &[], &rows))
}

/// A title that leaves the table readable; the documentation has all of it.
fn shortened(title: &str, most: usize) -> String {
    if title.chars().count() <= most {
        return title.to_owned();
    }
    // The dots and their space need two.
    let kept: String = title.chars().take(most - 2).collect();
    let words = kept.rsplit_once(' ').map_or(kept.as_str(), |(words, _)| words);
    format!("{} …", words.trim_end_matches([',', ';', ':']))
}

/// Who closes the pipe, as `head` does, has seen enough.
fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
