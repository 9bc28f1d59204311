//! No file of the repository has a phrase of the list.

use std::fs;
use std::path::{Path, PathBuf};

use strut_words::{Scope, found};

/// Not looked at: history, the list itself, other people's data, and what git does not keep.
const LEFT_OUT: &[&str] = &["CHANGELOG.md", "tests/words", "diagnosis/tests/nist", "target", "fmus", ".git"];

/// Source files whose texts users read.
const SHOWN: &[&str] = &[
    "build-fmu/src/cli.rs",
    "command/src",
    "diagnosis/src/app/cli.rs",
    "diagnosis/src/report/capability",
    "diagnosis/src/report/page",
    "diagnosis/src/report/words",
    "diagnosis/src/rig/draft/text.rs",
    "python/strut",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the repository").to_owned()
}

fn files(folder: &Path, root: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the entry can be read").path();
        let name = path.strip_prefix(root).expect("it is below").to_string_lossy().replace('\\', "/");
        let out = LEFT_OUT.contains(&&*name) || name.ends_with("/target") || name.ends_with(".lock");
        if out || (path.is_dir() && path.join("pyvenv.cfg").exists()) {
            continue;
        }
        if path.is_dir() { files(&path, root, all) } else { all.push(path) }
    }
}

fn scopes(name: &str) -> &'static [Scope] {
    let kind = name.rsplit_once('.').map_or("", |(_, kind)| kind);
    match kind {
        "md" | "ipynb" => &[Scope::Everywhere, Scope::Guides, Scope::Code],
        "rs" | "py" | "pyi" if SHOWN.iter().any(|it| name.starts_with(it)) => {
            &[Scope::Everywhere, Scope::Guides, Scope::Code]
        }
        "rs" | "py" | "pyi" => &[Scope::Everywhere, Scope::Code],
        "toml" | "bib" => &[Scope::Everywhere],
        _ => &[],
    }
}

#[test]
fn no_file_has_a_phrase_of_the_list() {
    let root = root();
    let mut all = Vec::new();
    files(&root, &root, &mut all);
    assert!(all.len() > 500, "{} files below {}", all.len(), root.display());
    let (mut looked_at, mut wrong) = (0, Vec::new());
    for path in all {
        let name = path.strip_prefix(&root).expect("it is below").to_string_lossy().replace('\\', "/");
        let scopes = scopes(&name);
        let Some(text) = fs::read_to_string(&path).ok().filter(|_| !scopes.is_empty()) else { continue };
        looked_at += 1;
        wrong.extend(
            found(&text, scopes)
                .iter()
                .map(|it| format!("{name}:{}: `{}`; write: {}", it.line, it.phrase, it.instead)),
        );
    }
    assert!(looked_at > 400, "{looked_at} files with words");
    assert!(wrong.is_empty(), "{} phrases:\n{}", wrong.len(), wrong.join("\n"));
}
