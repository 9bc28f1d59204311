//! A first rig file of a model, to be completed by whoever knows the rig.

mod fmu;
mod guess;
mod library;
mod names;
mod text;

use std::path::{Component, Path, PathBuf};

use super::Rig;
use super::own::{fmu_of, is_fmu, is_manifest};
use super::stand_in;
use crate::plant::Role;

use guess::{Declared, Force, Guess, Strut};

/// Difference of its outputs, relative to their size, up to which a model is the same with a strut of the library in the
/// place of its own.
pub const SAME: f64 = 0.02;

/// A first rig file.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The rig's name.
    pub name: String,
    /// The file's text.
    pub text: String,
}

impl Draft {
    /// Drafts a rig file of a model: an FMU's file, a crate's manifest, or a rig or a model of the library by its name. The file is for a
    /// folder, which its path to the FMU is relative to.
    ///
    /// # Errors
    /// If there is no such model, or the FMU cannot be read or run on this machine: what to do.
    pub fn of(model: &str, folder: &Path) -> Result<Self, String> {
        let path = Path::new(model);
        if is_fmu(path) || is_manifest(path) {
            return Self::of_fmu(path, folder);
        }
        let rig = Rig::published(model).map_err(|error| {
            format!(
                "{error}; of an FMU, name the file with its ending, model.fmu; of a crate, its Cargo.toml"
            )
        })?;
        library::draft(&rig)
    }

    fn of_fmu(path: &Path, folder: &Path) -> Result<Self, String> {
        let fmu = fmu_of(path)?;
        let name = super::kebab(&fmu.file_stem().unwrap_or_default().to_string_lossy());
        let declared = fmu::declared(&fmu)?;
        let model = relative(path, folder)?;
        let guess = declared.guess();
        let mut notes = Vec::new();
        for strut in simpler(&declared, &guess) {
            let text = text::text(&model, &declared, &guess, strut.as_ref(), &notes);
            match confirmed(&text, &name, folder) {
                Ok(()) => return Ok(Self { name, text }),
                Err(reason) => notes.push(reason),
            }
        }
        Err(format!("`{}`: no rig file of it can be read: {}", path.display(), notes.join("; ")))
    }
}

/// What was guessed, and what remains of it where a part does not hold.
fn simpler(declared: &Declared, guess: &Guess) -> Vec<Option<Strut>> {
    let Some(strut) = guess.strut else { return vec![None] };
    let on_top = Strut { replaces: false, ..strut };
    let alone = Strut { acts_on: None, ..on_top };
    let mut all = vec![Some(strut), Some(on_top), Some(alone), None];
    // A name of the library's strut cannot mean the FMU's own spring or damper.
    let is_meant = |strut: &Strut| match strut.force {
        Force::Rates(spring, damper) => {
            strut.replaces
                || [spring, damper].iter().all(|it| !Role::Strut.has(&declared.parameters[*it].name))
        }
        Force::Output(_) => true,
    };
    all.retain(|it| it.as_ref().is_none_or(is_meant));
    all.dedup();
    all
}

/// Refuses a text that cannot be read, or with which the model no longer computes what it does on its own: why.
fn confirmed(text: &str, name: &str, folder: &Path) -> Result<(), String> {
    let rig = Rig::parse(text, name.to_owned(), folder)?;
    match stand_in::difference(&rig)? {
        Some(difference) if difference.is_nan() || difference > SAME => {
            let replaced = rig.kind.elements.iter().find_map(|it| it.replaces.as_ref());
            let replaced =
                replaced.map_or_else(String::new, |it| format!("{} and {}", it.stiffness, it.damping));
            Err(format!(
                "A strut of the library in place of {replaced} changes the model's outputs by {:.0} %: they are not the \
                 spring and the damper of this deflection, or not linear.",
                100.0 * difference
            ))
        }
        _ => Ok(()),
    }
}

/// The way to a file from a folder, with `/` between its parts; the whole path where there is none.
///
/// # Errors
/// If one of them is not there, or the way is no text.
fn relative(file: &Path, folder: &Path) -> Result<String, String> {
    let whole = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().map_err(|error| format!("`{}`: {error}", path.display()))
    };
    let (file, folder) = (whole(file)?, whole(folder)?);
    let way = way(&file, &folder);
    let parts: Option<Vec<&str>> = way
        .components()
        .map(|part| match part {
            Component::ParentDir => Some(".."),
            part => part.as_os_str().to_str(),
        })
        .collect();
    let parts = parts.ok_or_else(|| format!("`{}`: the path is no text in UTF-8", file.display()))?;
    // An absolute path has its root among its parts.
    Ok(if way.is_absolute() { way.to_string_lossy().into_owned() } else { parts.join("/") })
}

/// The way between absolute paths; the file's own where they have nothing in common.
fn way(file: &Path, folder: &Path) -> PathBuf {
    let common = file.components().zip(folder.components()).take_while(|(one, other)| one == other).count();
    if common == 0 {
        return file.to_owned();
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_to_a_file_goes_up_and_down() {
        let way =
            |file: &str, folder: &str| way(Path::new(file), Path::new(folder)).to_string_lossy().into_owned();
        assert_eq!(way("/a/b/model.fmu", "/a/b"), "model.fmu");
        assert_eq!(way("/a/fmus/model.fmu", "/a/rigs/mine"), "../../fmus/model.fmu");
        assert_eq!(way("/a/b/fmus/model.fmu", "/a/b"), "fmus/model.fmu");
    }

    /// Every rig of the library, drafted and read again, has the same values.
    #[test]
    fn a_draft_of_a_library_s_rig_is_that_rig() {
        for name in Rig::names() {
            let rig = Rig::published(&name).unwrap();
            let draft = Draft::of(&name, Path::new(".")).unwrap();
            assert_eq!(draft.name, name);
            let again = Rig::parse(&draft.text, name.clone(), Path::new("."));
            let again = again.unwrap_or_else(|error| panic!("{name}: {error}\n{}", draft.text));
            assert_eq!(again.parameters, rig.parameters, "{name}");
            assert_eq!((again.choices, again.start), (rig.choices, rig.start), "{name}");
            assert_eq!(again.stated, rig.stated, "{name}");
        }
    }

    #[test]
    fn a_model_that_is_not_there_is_refused_with_what_to_do() {
        let of = |model: &str| Draft::of(model, Path::new(".")).unwrap_err();
        assert!(of("quarter-kar").contains("did you mean `quarter-car`"), "{}", of("quarter-kar"));
        assert!(of("quarter-kar").contains("model.fmu"));
        assert!(of("absent.fmu").starts_with("`absent.fmu`: "), "{}", of("absent.fmu"));
    }
}
