//! What ships: the same bytes wherever it is built, made of no more than is listed.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A copy of the project in another folder, built into another one, gives the same bytes.
#[test]
#[ignore = "compiles all of a package anew: `scripts/long-tests packages`"]
fn a_package_does_not_depend_on_where_it_was_built() {
    const NAME: &str = "QuarterCar";
    let ours = fs::read(strut::fmus().join(NAME).with_extension("fmu")).expect("it is built");
    assert_same(NAME, &ours, &built_elsewhere("built-elsewhere", NAME, &[]));
}

/// Nor does one for Windows, whose linker writes more about itself than Linux' does.
#[test]
#[ignore = "compiles all of a package anew: `scripts/long-tests packages`"]
fn a_package_for_windows_does_not_depend_on_where_it_was_built() {
    const NAME: &str = "LinearMotor";
    const TARGET: [&str; 2] = ["--target", "x86_64-pc-windows-gnu"];
    let missing = strut::missing_for(TARGET[1], "x86_64-w64-mingw32-gcc");
    if !missing.is_empty() {
        return strut::skip(&format!("the bytes of win64: for want of {}", missing.join(" and ")));
    }
    let out = strut::target().join("tested-windows");
    strut::run(strut::build_fmu().arg("--out").arg(&out).args(TARGET).arg(NAME));
    let ours = fs::read(out.join(NAME).with_extension("fmu")).expect("it is built");
    assert_same(NAME, &ours, &built_elsewhere("built-elsewhere-for-windows", NAME, &TARGET));
}

fn assert_same(name: &str, ours: &[u8], theirs: &[u8]) {
    assert!(ours == theirs, "{name}.fmu is other bytes when it is built from a copy in another folder");
}

/// An FMU, built from a copy of the project in a folder of this name below the target folder.
fn built_elsewhere(folder: &str, name: &str, options: &[&str]) -> Vec<u8> {
    let elsewhere = strut::target().join(folder);
    // What was built there before would not be built again.
    if elsewhere.exists() {
        fs::remove_dir_all(&elsewhere).expect("the target folder is ours");
    }
    let (copy, out) = (elsewhere.join("a copy"), elsewhere.join("fmus"));
    let listed = strut::run(Command::new("git").args(["ls-files", "-z"]).current_dir(strut::root()));
    for file in String::from_utf8_lossy(&listed.stdout).split_terminator('\0') {
        let (from, to) = (strut::root().join(file), copy.join(file));
        if from.is_file() {
            fs::create_dir_all(to.parent().expect("a file is in a folder")).expect("it can be made");
            fs::copy(&from, &to).expect("it can be copied");
        }
    }
    let mut packager = strut::build_fmu();
    packager.arg("--out").arg(&out).args(options).arg(name).current_dir(&copy);
    packager.env("CARGO_MANIFEST_DIR", &copy).env("CARGO_TARGET_DIR", elsewhere.join("target"));
    packager.env("CARGO", env!("CARGO"));
    strut::run(&mut packager);
    let built = fs::read(out.join(name).with_extension("fmu")).expect("it is built");
    fs::remove_dir_all(&elsewhere).expect("the target folder is ours");
    built
}

/// Crates that are compiled into any of the FMUs' libraries, as cargo sees them.
fn shipped() -> BTreeSet<String> {
    let shims = fs::read_dir(strut::root().join("fmu-src/fmus")).expect("they are there");
    let mut tree = strut::cargo();
    tree.args(["tree", "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"]);
    for shim in shims.map(|entry| entry.expect("it can be read").file_name()) {
        tree.arg("--package").arg(format!("fmu-{}", shim.to_string_lossy()));
    }
    let listed = strut::run(&mut tree);
    let text = String::from_utf8_lossy(&listed.stdout);
    let names = text.lines().filter_map(|line| line.split(' ').next());
    names
        .filter(|name| !name.is_empty() && !name.starts_with("fmu-") && !name.starts_with("strut-"))
        .map(str::to_owned)
        .collect()
}

/// Whoever ships an FMU answers for what is in it: the list in the documents is complete, and short.
#[test]
fn the_crates_in_an_fmu_are_those_that_are_listed() {
    let page =
        fs::read_to_string(Path::new(strut::root()).join("tests/hardening/README.md")).expect("a page");
    let start = page.find("## What ships inside an FMU").expect("the page has this section");
    let rows = page[start..].lines().filter_map(|line| line.strip_prefix("| `"));
    let listed: BTreeSet<String> = rows.filter_map(|row| row.split('`').next()).map(str::to_owned).collect();
    assert_eq!(shipped(), listed, "tests/hardening/README.md lists what ships");
}
