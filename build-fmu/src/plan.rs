//! Which FMUs and systems there are and which of them are wanted.

use std::path::{Path, PathBuf};

use strut_model::ParameterSet;

use crate::Project;
use crate::cli::{Arguments, COMMANDS};
use crate::custom;
use crate::failure::{Failure, Result, similar};
use crate::fmu::{Fmu, Set};
use crate::system::{Adapter, Part, System, Theirs};

/// All FMUs and systems, and the wanted ones among them.
#[derive(Debug)]
pub struct Plan {
    /// Every FMU that there is.
    pub fmus: Vec<Fmu>,
    /// Positions of the FMUs that are written to the output folder.
    pub wanted: Vec<usize>,
    /// The systems that are, with the folder that their FMUs of others are found from.
    pub systems: Vec<(System, PathBuf)>,
    /// Systems of the command line whose files cannot be read.
    pub broken: Vec<Failure>,
}

/// What a component of a system is made of.
#[derive(Debug)]
pub enum Component {
    /// The FMU of this position.
    Ours(usize),
    /// A file of others.
    Theirs(Theirs),
}

impl Plan {
    /// What the command line asks for. `files` is where the project's parameter sets have theirs.
    ///
    /// # Errors
    /// If a file is broken, or a name unknown or taken twice.
    pub fn new(project: &Project, arguments: &Arguments, files: &Path) -> Result<Self> {
        let mut fmus: Vec<Fmu> = project
            .catalogue
            .iter()
            .map(|entry| Fmu { name: entry.about.name.into(), entry: *entry, set: None, related: None })
            .collect();
        for (name, text) in project.parameter_sets {
            fmus.push(with_set(project, name, text, files)?);
        }
        for name in arguments.names.iter().filter(|_| !arguments.set.is_empty()) {
            let position = fmus.iter().position(|fmu| fmu.name == *name);
            let position = position.ok_or_else(|| unknown(name, &fmus, &[]))?;
            let custom =
                custom::with_values(&fmus[position], &arguments.set, arguments.name.as_deref(), files)?;
            check_identifier(&custom.name, "--name")?;
            if custom.name == *name {
                fmus[position] = custom;
            } else {
                fmus.push(custom);
            }
        }
        let names = arguments.name.as_ref().map_or(&*arguments.names, std::slice::from_ref);
        let given_fmus = fmus.len();
        for path in &arguments.parameters {
            let folder = path.parent().unwrap_or(Path::new(""));
            let mut fmu = with_set(project, &path.display().to_string(), &read(path)?, folder)?;
            fmu.related.clone_from(&arguments.related);
            // The user's set takes the place of a published one of the same name.
            match fmus.iter().position(|other| other.set.is_some() && other.name == fmu.name) {
                Some(index) if index < given_fmus => {
                    fmus.remove(index);
                    fmus.push(fmu);
                }
                _ => fmus.push(fmu),
            }
        }
        let mut systems = Vec::new();
        for (name, text) in project.systems {
            systems.push((System::parse(name, text)?, PathBuf::new()));
        }
        let (given_systems, mut broken) = (systems.len(), Vec::new());
        for path in &arguments.systems {
            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
            match read(path).and_then(|text| System::parse(&path.display().to_string(), &text)) {
                Ok(system) => systems.push((system, folder)),
                Err(failure) => broken.push(failure),
            }
        }
        check_names(&fmus, &systems)?;
        // A file on the command line is a wish, like a name.
        let user_fmus = fmus.len() - arguments.parameters.len()..fmus.len();
        let everything =
            arguments.names.is_empty() && arguments.parameters.is_empty() && arguments.systems.is_empty();
        for name in names {
            if !fmus.iter().any(|fmu| fmu.name == *name)
                && !systems.iter().any(|(system, _)| system.name == *name)
            {
                return Err(unknown(name, &fmus, &systems));
            }
        }
        let named = |name: &String| everything || names.contains(name);
        let wanted =
            (0..fmus.len()).filter(|index| named(&fmus[*index].name) || user_fmus.contains(index)).collect();
        let mut index = 0;
        systems.retain(|(system, _)| {
            index += 1;
            named(&system.name) || index > given_systems
        });
        Ok(Self { fmus, wanted, systems, broken })
    }

    /// What to say of a name that there is nothing of.
    pub fn unknown(&self, name: &str) -> Failure {
        unknown(name, &self.fmus, &self.systems)
    }

    /// What a system is made of. FMUs with a parameter set of the system's own are added.
    ///
    /// # Errors
    /// If there is no FMU of a name, or a file of others or a parameter set cannot be used.
    pub fn components(
        &mut self,
        project: &Project,
        system: &System,
        folder: &Path,
    ) -> Result<Vec<Component>> {
        let mut sets = Vec::new();
        for part in system.components.values() {
            if let Part::Set(set) = part {
                let path = folder.join(&set.parameters);
                let beside = path.parent().unwrap_or(Path::new(""));
                sets.push(with_set(project, &path.display().to_string(), &read(&path)?, beside)?);
            }
        }
        let first = self.fmus.len();
        self.fmus.extend(sets);
        let mut sets = first..self.fmus.len();
        let position = |component: &String, fmu: &String| {
            // Sets of systems have names of their own, which other systems do not know.
            self.fmus[..first].iter().position(|other| other.name == *fmu).ok_or_else(|| {
                let failure = Failure::new(format!(
                    "component `{component}` of the system {} is made of `{fmu}`, which is no FMU",
                    system.name
                ));
                let failure = similar(fmu, self.fmus.iter().map(|fmu| fmu.name.as_str()))
                    .into_iter()
                    .fold(failure, Failure::help);
                if fmu.ends_with(".fmu") {
                    failure.help(format!("one of others is written {component} = {{ fmu = \"{fmu}\" }}"))
                } else {
                    failure
                }
            })
        };
        let parts = system.components.iter();
        parts
            .map(|(component, part)| match part {
                Part::Ours(fmu) => position(component, fmu).map(Component::Ours),
                Part::Set(_) => Ok(Component::Ours(sets.next().expect("each was added"))),
                Part::Theirs(foreign) => Theirs::read(&folder.join(&foreign.fmu)).map(Component::Theirs),
            })
            .collect()
    }

    /// Adds the FMUs of a system's adapters; returns their positions.
    ///
    /// # Errors
    /// If this project has no model to make them of.
    pub fn add(&mut self, project: &Project, system: &System, adapters: &[Adapter]) -> Result<Vec<usize>> {
        let first = self.fmus.len();
        for adapter in adapters {
            if !project.catalogue.iter().any(|entry| entry.about.name == Adapter::MODEL) {
                return Err(Failure::new(format!(
                    "the system {} adapts a signal, and this project has no {}",
                    system.name,
                    Adapter::MODEL
                ))
                .help("build your model first, and the system among Strut's, with it as { fmu = \"...\" }"));
            }
            self.fmus.push(with_set(project, &adapter.name, &adapter.set, Path::new(""))?);
        }
        Ok((first..self.fmus.len()).collect())
    }

    /// In a system's archive the FMUs lie side by side.
    ///
    /// # Errors
    /// If two different ones have one name.
    pub fn check_files(&self, system: &System, components: &[Component]) -> Result<()> {
        for (index, one) in components.iter().enumerate() {
            let file = one.file(self);
            if components[..index].iter().any(|other| other.file(self) == file && !other.is(one)) {
                return Err(Failure::new(format!(
                    "the system {} is made of two different FMUs of the name `{file}`",
                    system.name
                ))
                .help("rename one of the files"));
            }
        }
        Ok(())
    }
}

impl Component {
    /// The name of its file.
    pub fn file(&self, plan: &Plan) -> String {
        match self {
            Self::Ours(index) => format!("{}.fmu", plan.fmus[*index].name),
            Self::Theirs(theirs) => theirs.file.clone(),
        }
    }

    fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Ours(one), Self::Ours(other)) => one == other,
            (Self::Theirs(one), Self::Theirs(other)) => one.bytes == other.bytes,
            _ => false,
        }
    }
}

/// What to say of a name that there is nothing of.
fn unknown(name: &str, fmus: &[Fmu], systems: &[(System, PathBuf)]) -> Failure {
    let names = fmus.iter().map(|fmu| fmu.name.as_str());
    let names = names.chain(systems.iter().map(|(system, _)| system.name.as_str()));
    let failure = Failure::new(format!("there is no FMU or system `{name}`"));
    let failure =
        similar(name, names.chain(COMMANDS.iter().copied())).into_iter().fold(failure, Failure::help);
    failure.help("`build-fmu list` tells what there is")
}

fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path)
        .map_err(|error| Failure::new(format!("cannot read `{}`: {error}", path.display())))
}

fn with_set(project: &Project, file: &str, text: &str, folder: &Path) -> Result<Fmu> {
    let parsed = ParameterSet::parse(text)
        .map_err(|error| Failure::new(format!("the parameter set `{file}` is broken: {error}")))?;
    let entry = project.catalogue.iter().find(|entry| entry.about.name == parsed.model).ok_or_else(|| {
        let failure = Failure::new(format!(
            "the parameter set `{file}` is for the model `{}`, which there is none of",
            parsed.model
        ));
        similar(&parsed.model, project.catalogue.iter().map(|entry| entry.about.name))
            .into_iter()
            .fold(failure, Failure::help)
    })?;
    let name = parsed.fmu.clone();
    check_identifier(&name, &format!("the parameter set `{file}`"))?;
    let set = Set { parsed, text: text.into(), folder: folder.into() };
    Ok(Fmu { name, entry: *entry, set: Some(set), related: None })
}

/// The name of a library's functions begins with the FMU's.
fn check_identifier(name: &str, who: &str) -> Result<()> {
    let identifier = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if identifier {
        return Ok(());
    }
    Err(Failure::new(format!("{who} names its FMU `{name}`"))
        .help("the name must be an identifier of the language C: letters, digits and `_`"))
}

/// Two files of one name would overwrite each other.
fn check_names(fmus: &[Fmu], systems: &[(System, PathBuf)]) -> Result<()> {
    let mut names: Vec<String> = fmus.iter().map(|fmu| fmu.name.clone()).collect();
    names.extend(systems.iter().map(|(system, _)| system.name.clone()));
    names.sort();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(pair) => Err(Failure::new(format!("there are two FMUs or systems of the name `{}`", pair[0]))
            .help("rename one: `fmu` in a parameter set, `name` in a system")),
    }
}
