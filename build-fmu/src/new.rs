//! A crate for a model of one's own: it compiles, its test compares it with scipy, and a diagnosis of the records that its
//! script makes finds what is hidden in them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cargo;
use crate::cli::NewArguments;
use crate::failure::{Failure, Result};

/// Files of the crate; `@CRATE@`, `@LIB@`, `@MODEL@`, `@REPOSITORY@` and `@STRUT:folder@` are filled in.
const FILES: &[(&str, &str)] = &[
    ("Cargo.toml", include_str!("new/Cargo.toml.in")),
    ("README.md", include_str!("new/README.md.in")),
    (".gitignore", include_str!("new/gitignore")),
    ("src/lib.rs", include_str!("new/lib.rs.in")),
    ("tests/scipy.rs", include_str!("new/scipy.rs.in")),
    ("tests/reference.py", include_str!("new/reference.py")),
    ("tests/records.py", include_str!("new/records.py")),
    ("rig.toml", include_str!("new/rig.toml.in")),
    ("tests/reference.csv", include_str!("new/reference.csv")),
];

/// Names that cargo or the crate itself has for something else.
const TAKEN: &[&str] = &[
    "as",
    "async",
    "await",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "priv",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "struct",
    "super",
    "trait",
    "try",
    "type",
    "unsafe",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "core",
    "std",
    "alloc",
    "test",
    "strut-model",
    "strut-fmi",
    "about",
    "equation",
    "experiment",
    "instant",
    "kind",
    "model",
    "no-settings",
    "real",
    "stimulus",
    "variables",
    "path",
    "parameters",
    "input",
    "state",
    "output",
    "entry",
];

/// Where the crate has Strut from.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Origin {
    /// A checkout on this machine.
    Path(PathBuf),
    /// The public repository, at a commit if this program knows its own.
    Git { repository: &'static str, commit: Option<&'static str> },
}

impl Origin {
    /// # Errors
    /// If the folder that is given is no checkout of Strut.
    fn of(given: Option<&Path>) -> Result<Self> {
        let has_model = |folder: &Path| folder.join("fmu-src/model/Cargo.toml").is_file();
        if let Some(folder) = given {
            if !has_model(folder) {
                return Err(Failure::new(format!("`{}` is no checkout of Strut", folder.display()))
                    .help("give the folder that README.md, fmu-src and build-fmu lie in"));
            }
            let folder = folder.canonicalize();
            return folder.map(Self::Path).map_err(|error| Failure::new(error.to_string()));
        }
        // Where `cargo run` found us, or where this program was compiled.
        let run =
            cargo::workspace_manifest().and_then(|manifest| Some(manifest.parent()?.parent()?.to_owned()));
        let compiled = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_owned);
        if let Some(folder) = run.into_iter().chain(compiled).find(|folder| has_model(folder)) {
            return Ok(Self::Path(folder));
        }
        // `0.1.0 (1a2b3c4d5e6f)`, with a `+` behind the commit if files were changed after it.
        let commit = crate::VERSION.split_once(" (").and_then(|(_, rest)| rest.strip_suffix(')'));
        let commit = commit.filter(|it| it.chars().all(|c| c.is_ascii_hexdigit()));
        Ok(Self::Git { repository: env!("CARGO_PKG_REPOSITORY"), commit })
    }

    /// The dependency on the crate in a folder of Strut.
    fn dependency(&self, folder: &str) -> String {
        match self {
            Self::Path(root) => format!("path = {}", quoted(&root.join(folder).to_string_lossy())),
            Self::Git { repository, commit } => {
                let commit = commit.map(|commit| format!(", rev = {}", quoted(commit))).unwrap_or_default();
                format!("git = {}{commit}", quoted(repository))
            }
        }
    }

    fn said(&self) -> String {
        match self {
            Self::Path(root) => format!("the checkout {}", root.display()),
            Self::Git { repository, commit: Some(commit) } => format!("{repository} at {commit}"),
            Self::Git { repository, commit: None } => (*repository).to_owned(),
        }
    }
}

/// Makes the crate; what to do next.
///
/// # Errors
/// If the name is none for a crate, something of the name is there, or the files cannot be written.
pub fn make(arguments: &NewArguments) -> Result<String> {
    let name = arguments.name.to_string_lossy();
    let parts = Path::new(&arguments.name);
    let file = parts.file_name().map(|it| it.to_string_lossy().into_owned()).unwrap_or_default();
    let model = model(&file)?;
    if parts.exists() {
        return Err(Failure::new(format!("`{name}` exists")).help("choose another name, or remove it"));
    }
    let origin = Origin::of(arguments.path.as_deref())?;
    let files = FILES.iter().map(|(path, text)| (*path, filled(text, &file, &model, &origin)));
    for (path, text) in files {
        let path = parts.join(path);
        let failed =
            |error: std::io::Error| Failure::new(format!("cannot write `{}`: {error}", path.display()));
        fs::create_dir_all(path.parent().expect("a file lies in a folder")).map_err(failed)?;
        fs::write(&path, text).map_err(failed)?;
    }
    Ok(format!(
        "made {name}: the model {model}, with Strut from {origin}\n\
         It needs Rust {rust} (https://rustup.rs) and a C linker. Next:\n\n  \
         cd {name}\n  \
         cargo test                             # the equations against scipy\n  \
         strut fmu --manifest-path Cargo.toml   # fmus/{model}.fmu\n  \
         python3 tests/records.py               # two records with friction, by scipy\n  \
         strut diagnose --rig rig.toml --train train.csv --test test.csv\n",
        origin = origin.said(),
        rust = env!("CARGO_PKG_RUST_VERSION"),
    ))
}

/// The model's name for a crate's: `my-rig` is `MyRig`.
fn model(name: &str) -> Result<String> {
    let wrong = |why: &str| {
        Failure::new(format!("`{name}` is no name for a crate: {why}"))
            .help("letters, digits, `-` and `_`, a letter first: my-rig")
    };
    if !name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) {
        return Err(wrong("it has other characters than letters, digits, `-` and `_`"));
    }
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return Err(wrong("it does not begin with a letter"));
    }
    if TAKEN.contains(&name.to_lowercase().replace('_', "-").as_str()) {
        return Err(wrong("the word has a meaning of its own"));
    }
    let part = |part: &str| part[..1].to_uppercase() + &part[1..];
    Ok(name.split(['-', '_']).filter(|it| !it.is_empty()).map(part).collect())
}

fn filled(text: &str, name: &str, model: &str, origin: &Origin) -> String {
    let mut text = text
        .replace("@CRATE@", name)
        .replace("@LIB@", &name.replace('-', "_"))
        .replace("@MODEL@", model)
        .replace("@REPOSITORY@", env!("CARGO_PKG_REPOSITORY"));
    while let Some((before, rest)) = text.split_once("@STRUT:") {
        let (folder, after) = rest.split_once('@').expect("the mark ends");
        text = format!("{before}{}{after}", origin.dependency(folder));
    }
    text
}

/// As a TOML string.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(folder: &Path, name: &str) -> NewArguments {
        NewArguments { name: folder.join(name).into_os_string(), path: None }
    }

    #[test]
    fn a_crate_has_all_files_and_no_mark_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let told = make(&arguments(folder.path(), "my_half-car")).unwrap();
        assert!(told.contains("cargo test") && told.contains("fmus/MyHalfCar.fmu"), "{told}");
        for (path, _) in FILES {
            let text = fs::read_to_string(folder.path().join("my_half-car").join(path)).unwrap();
            assert!(
                !text.contains('@') || ["tests/reference.py", "tests/records.py"].contains(path),
                "{path}: {text}"
            );
        }
        let test = fs::read_to_string(folder.path().join("my_half-car/tests/scipy.rs")).unwrap();
        assert!(test.contains("use my_half_car::MyHalfCar;"), "{test}");
        let again = make(&arguments(folder.path(), "my_half-car")).unwrap_err().to_string();
        assert!(again.contains("exists"), "{again}");
    }

    #[test]
    fn names_that_rust_refuses_make_nothing() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["9rig", "my rig", "match", "Ünit", "strut_model"] {
            let error = make(&arguments(folder.path(), name)).unwrap_err().to_string();
            assert!(error.contains("is no name for a crate"), "{error}");
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn without_a_checkout_the_repository_is_named_with_the_commit() {
        let origin = Origin::Git { repository: "https://example.org/strut", commit: Some("1a2b") };
        let text = filled(FILES[0].1, "my-rig", "MyRig", &origin);
        let manifest = text.parse::<toml::Table>().unwrap();
        let model = &manifest["dependencies"]["strut-model"];
        assert_eq!(model["git"].as_str(), Some("https://example.org/strut"));
        assert_eq!(model["rev"].as_str(), Some("1a2b"));
        let checkout = tempfile::tempdir().unwrap();
        assert!(Origin::of(Some(checkout.path())).is_err());
    }
}
