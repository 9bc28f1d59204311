//! Which FMUs and systems there are and which of them are wanted.

use std::path::Path;

use strut_model::ParameterSet;

use crate::Project;
use crate::cli::{Arguments, COMMANDS};
use crate::failure::{Failure, Result, similar};
use crate::fmu::{Fmu, Set};
use crate::system::System;

/// All FMUs and systems, and the wanted ones among them.
#[derive(Debug)]
pub struct Plan {
    /// Every FMU that there is.
    pub fmus: Vec<Fmu>,
    /// Positions of the FMUs that are written to the output folder.
    pub wanted: Vec<usize>,
    /// The systems that are.
    pub systems: Vec<System>,
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
            .map(|entry| Fmu { name: entry.about.name.into(), entry: *entry, set: None })
            .collect();
        for (name, text) in project.parameter_sets {
            fmus.push(with_set(project, name, text, files)?);
        }
        let given_fmus = fmus.len();
        for path in &arguments.parameters {
            let folder = path.parent().unwrap_or(Path::new(""));
            let fmu = with_set(project, &path.display().to_string(), &read(path)?, folder)?;
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
            systems.push(System::parse(name, text)?);
        }
        let given_systems = systems.len();
        for path in &arguments.systems {
            systems.push(System::parse(&path.display().to_string(), &read(path)?)?);
        }
        check_names(&fmus, &systems)?;
        // A file on the command line is a wish, like a name.
        let user_fmus = fmus.len() - arguments.parameters.len()..fmus.len();
        let everything =
            arguments.names.is_empty() && arguments.parameters.is_empty() && arguments.systems.is_empty();
        for name in &arguments.names {
            if !fmus.iter().any(|fmu| fmu.name == *name) && !systems.iter().any(|system| system.name == *name)
            {
                return Err(unknown(name, &fmus, &systems));
            }
        }
        let named = |name: &String| everything || arguments.names.contains(name);
        let wanted =
            (0..fmus.len()).filter(|index| named(&fmus[*index].name) || user_fmus.contains(index)).collect();
        let mut index = 0;
        systems.retain(|system| {
            index += 1;
            named(&system.name) || index > given_systems
        });
        Ok(Self { fmus, wanted, systems })
    }

    /// What to say of a name that there is nothing of.
    pub fn unknown(&self, name: &str) -> Failure {
        unknown(name, &self.fmus, &self.systems)
    }

    /// Positions of the FMUs that a system is made of.
    ///
    /// # Errors
    /// If there is no FMU of a name.
    pub fn components(&self, system: &System) -> Result<Vec<usize>> {
        let position = |(component, fmu): (&String, &String)| {
            self.fmus.iter().position(|other| other.name == *fmu).ok_or_else(|| {
                let failure = Failure::new(format!(
                    "component `{component}` of the system {} is made of `{fmu}`, which is no FMU",
                    system.name
                ));
                similar(fmu, self.fmus.iter().map(|fmu| fmu.name.as_str()))
                    .into_iter()
                    .fold(failure, Failure::help)
            })
        };
        system.components.iter().map(position).collect()
    }
}

/// What to say of a name that there is nothing of.
fn unknown(name: &str, fmus: &[Fmu], systems: &[System]) -> Failure {
    let names = fmus.iter().map(|fmu| fmu.name.as_str());
    let names = names.chain(systems.iter().map(|system| system.name.as_str()));
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
    let identifier = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !identifier {
        return Err(Failure::new(format!("the parameter set `{file}` names its FMU `{name}`"))
            .help("the name must be an identifier of the language C: letters, digits and `_`"));
    }
    Ok(Fmu { name, entry: *entry, set: Some(Set { parsed, text: text.into(), folder: folder.into() }) })
}

/// Two files of one name would overwrite each other.
fn check_names(fmus: &[Fmu], systems: &[System]) -> Result<()> {
    let mut names: Vec<String> = fmus.iter().map(|fmu| fmu.name.clone()).collect();
    names.extend(systems.iter().map(|system| system.name.clone()));
    names.sort();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(pair) => Err(Failure::new(format!("there are two FMUs or systems of the name `{}`", pair[0]))
            .help("rename one: `fmu` in a parameter set, `name` in a system")),
    }
}
