//! Lists the parameter sets and the systems: what lies in their folders is part of the catalogue.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
    let mut code = String::new();
    for (name, folder, doc) in [
        ("PARAMETER_SETS", "parameters", "File name and text of each published parameter set."),
        ("SYSTEMS", "systems", "File name and text of each composition of components to a system."),
    ] {
        println!("cargo::rerun-if-changed={folder}");
        let folder = Path::new(&root).join(folder);
        let mut files: Vec<_> =
            fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
        files.sort();
        writeln!(code, "#[doc = {doc:?}]\npub const {name}: &[(&str, &str)] = &[").expect("memory");
        for path in files {
            let file = path.file_name().expect("it is a file");
            writeln!(code, "    ({file:?}, include_str!({path:?})),").expect("memory");
        }
        code.push_str("];\n");
    }
    fs::write(Path::new(&env::var("OUT_DIR").expect("cargo sets it")).join("data.rs"), code)
}
