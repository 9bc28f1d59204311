//! From the command line to the files.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use strut_model::Entry;

use crate::archive::Folder;
use crate::cli::{Arguments, Command, CommandLine};
use crate::failure::{Failure, Result};
use crate::fmu::{Fmu, Packed};
use crate::libraries::{self, Origin};
use crate::needs::Needs;
use crate::plan::{Component, Plan};
use crate::platform::Platform;
use crate::system::{self, Face, System};
use crate::version::{Version, without_systems};
use crate::{Project, Source, describe, foreign, list, table};
#[cfg(feature = "tools")]
use crate::{check, completions, new};

/// Does what the arguments say.
///
/// # Errors
/// Whatever goes wrong first.
pub fn run(project: &Project, line: &CommandLine) -> Result<ExitCode> {
    let manifest = match &line.command {
        None => &line.build.manifest_path,
        Some(Command::List(list)) => &list.models.manifest_path,
        Some(Command::Describe(describe)) => &describe.models.manifest_path,
        Some(Command::Libraries(_)) => &None,
        #[cfg(feature = "tools")]
        Some(Command::Check(arguments)) => return Ok(check::check(arguments)),
        #[cfg(feature = "tools")]
        Some(Command::Probe { folder }) => return Ok(strut_check::probe(folder)),
        #[cfg(feature = "tools")]
        Some(Command::Completions { .. } | Command::New(_)) => &None,
    };
    if let (Some(manifest), Source::Workspace { .. }) = (manifest, project.source)
        && let Some(package) = foreign::package(manifest)?
    {
        return package.run();
    }
    let text = match &line.command {
        None => {
            let told = build(project, &line.build)?;
            told.notes.iter().for_each(|note| eprintln!("note: {note}"));
            if let Some(failure) = told.failed {
                print(&told.table);
                return Err(failure);
            }
            told.table
        }
        Some(Command::List(arguments)) => {
            let plan = plan(project, &arguments.models.of(&arguments.names))?;
            list::text(&plan, arguments.json)?
        }
        Some(Command::Describe(arguments)) => {
            // All of them: what is described names the sets and systems that it is in.
            let plan = plan(project, &arguments.models.of(&[]))?;
            describe::text(&plan, &arguments.name, arguments.json)?
        }
        Some(Command::Libraries(arguments)) => libraries::store(project, arguments)?,
        #[cfg(feature = "tools")]
        Some(Command::Completions { shell }) => {
            let plan = plan(project, &Arguments::default())?;
            completions::script(*shell, &plan)
        }
        #[cfg(feature = "tools")]
        Some(Command::New(arguments)) => new::make(arguments)?,
        #[cfg(feature = "tools")]
        Some(Command::Check(_) | Command::Probe { .. }) => unreachable!("done above, without a project"),
    };
    print(&text);
    Ok(ExitCode::SUCCESS)
}

/// What the arguments ask for.
///
/// # Errors
/// If a file is broken, a name unknown, or neither libraries nor a workspace are there.
pub fn plan(project: &Project, arguments: &Arguments) -> Result<Plan> {
    Plan::new(project, arguments, &Origin::new(project, arguments)?.files()?)
}

/// What is to be told of a build.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// What was built, or could be.
    pub table: String,
    /// The names of the FMUs that were written.
    pub fmus: Vec<String>,
    /// What the libraries of each platform need of a machine.
    pub notes: Vec<String>,
    /// What is wrong with the systems that were not built.
    pub failed: Option<Failure>,
}

/// Builds what the arguments ask for from the project's own models.
///
/// # Errors
/// Whatever goes wrong first.
pub fn build(project: &Project, arguments: &Arguments) -> Result<Told> {
    let origin = Origin::new(project, arguments)?;
    let mut plan = Plan::new(project, arguments, &origin.files()?)?;
    let platforms = libraries::platforms(&arguments.targets)?;
    let versions = Version::wanted(&arguments.versions);
    let mut notes = Vec::new();
    if !versions.contains(&Version::Two) {
        notes.extend(without_systems(&mut plan, arguments)?);
    }
    // Mistakes in systems come to light before minutes of compiling.
    let mut needed = plan.wanted.clone();
    let (assemblies, failures) = assemble(project, &mut plan, &platforms);
    let mut failed = Failure::together(failures);
    if assemblies.is_empty()
        && needed.is_empty()
        && let Some(failure) = failed.take()
    {
        return Err(failure);
    }
    needed.extend(assemblies.iter().flat_map(Assembly::ours));
    needed.sort_unstable();
    needed.dedup();
    let models: Vec<Entry> = needed.iter().map(|index| plan.fmus[*index].entry).collect();
    let found = origin.find(&models, &platforms, arguments)?;
    let folder = Folder::open(&arguments.out)?;
    let paths: Vec<PathBuf> =
        versions.iter().map(|version| version.folder(&arguments.out, &versions)).collect();
    let opened = versions.iter().zip(&paths).map(|(version, path)| Ok((*version, path, Folder::open(path)?)));
    let places = opened.collect::<Result<Vec<_>>>()?;
    let built = found.into_iter().map(|found| origin.build(found)).collect::<Result<Vec<_>>>()?;
    for (platform, libraries) in built.iter().filter(|(_, libraries)| !libraries.is_empty()) {
        notes.push(format!("{} needs {}", platform.folder, Needs::of(platform, libraries)?));
    }
    let progress = progress(needed.len() + assemblies.len());
    let mut packed: BTreeMap<usize, Packed> = BTreeMap::new();
    let mut rows = Vec::new();
    for index in needed {
        let fmu = &plan.fmus[index];
        progress.set_message(fmu.name.clone());
        let libraries = built
            .iter()
            .map(|(platform, all)| {
                Ok((platform.clone(), libraries::read(&all[&origin.package(&fmu.entry)])?))
            })
            .collect::<Result<Vec<_>>>()?;
        let results = fmu.pack(&versions, &libraries, (project.license, project.literature))?;
        for (result, (version, path, folder)) in results.into_iter().zip(&places) {
            if plan.wanted.contains(&index) {
                let file = format!("{}.fmu", fmu.name);
                folder.write(&file, &result.bytes)?;
                rows.push(row(fmu, &result, &path.join(file)));
            }
            if *version == Version::Two {
                packed.insert(index, result);
            }
        }
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
    let table = table::aligned(&["NAME", "KIND", "IN → OUT", "PARAMETERS", "SIZE", "PATH"], &[4], &rows);
    let fmus = plan.wanted.iter().map(|index| plan.fmus[*index].name.clone()).collect();
    Ok(Told { table, fmus, notes, failed })
}

/// A system with all that it is made of.
struct Assembly {
    system: System,
    /// Those of the file, then the adapters.
    components: Vec<Component>,
    /// Of those of the file.
    faces: Vec<Face>,
}

/// Finds what the systems are made of and checks that it fits and runs somewhere; and what is wrong with the others.
fn assemble(project: &Project, plan: &mut Plan, platforms: &[Platform]) -> (Vec<Assembly>, Vec<Failure>) {
    let (mut assemblies, mut failures) = (Vec::new(), std::mem::take(&mut plan.broken));
    for (system, folder) in plan.systems.clone() {
        let assembly = Assembly::new(project, plan, system, &folder);
        match assembly.and_then(|assembly| assembly.runs_on(platforms).map(|()| assembly)) {
            Ok(assembly) => assemblies.push(assembly),
            Err(failure) => failures.push(failure),
        }
    }
    (assemblies, failures)
}

impl Assembly {
    fn new(project: &Project, plan: &mut Plan, system: System, folder: &Path) -> Result<Self> {
        let mut components = plan.components(project, &system, folder)?;
        let face = |component: &Component| match component {
            Component::Ours(index) => Ok(Face::of(&plan.fmus[*index].interface()?)),
            Component::Theirs(theirs) => Ok(theirs.face.clone()),
        };
        let faces = components.iter().map(face).collect::<Result<Vec<_>>>()?;
        let adapters = system.check(&faces)?;
        components.extend(plan.add(project, &system, &adapters)?.into_iter().map(Component::Ours));
        plan.check_files(&system, &components)?;
        Ok(Self { system, components, faces })
    }

    fn ours(&self) -> impl Iterator<Item = usize> {
        self.components.iter().filter_map(|component| match component {
            Component::Ours(index) => Some(*index),
            Component::Theirs(_) => None,
        })
    }

    /// A system runs where each of its FMUs has a binary.
    fn runs_on(&self, platforms: &[Platform]) -> Result<()> {
        let theirs = || {
            self.components.iter().filter_map(|component| match component {
                Component::Ours(_) => None,
                Component::Theirs(theirs) => Some(theirs),
            })
        };
        let everywhere = |folder: &String| theirs().all(|theirs| theirs.platforms.contains(folder));
        if platforms.iter().any(|platform| everywhere(&platform.folder)) {
            return Ok(());
        }
        let ours: Vec<&str> = platforms.iter().map(|platform| platform.folder.as_str()).collect();
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

/// Who closes the pipe, as `head` does, has seen enough.
fn print(text: &str) {
    let _ = anstream::stdout().write_all(text.as_bytes());
}
