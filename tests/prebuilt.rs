//! FMUs of prebuilt libraries, without cargo.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The packager as on a machine without Rust.
fn without_cargo(arguments: &[&str], libraries: &Path, out: &Path) -> Output {
    let mut command = Command::new(strut::program("build-fmu"));
    command.args(arguments).arg("--libraries").arg(libraries).arg("--out").arg(out);
    for variable in ["CARGO", "CARGO_MANIFEST_DIR", "RUSTC"] {
        command.env_remove(variable);
    }
    command.env("PATH", "").current_dir(std::env::temp_dir()).output().expect("it can be started")
}

#[test]
fn an_fmu_of_a_prebuilt_library_is_the_one_that_cargo_builds() {
    let folder = tempfile::tempdir().expect("a folder");
    let [libraries, out] = ["libraries", "fmus"].map(|name| folder.path().join(name));
    strut::run(strut::build_fmu().arg("libraries").arg("--out").arg(&libraries));
    let names = ["TumQuarterVehicle", "RecordedRoad", "quanser-lqr"];
    let done = without_cargo(&names, &libraries, &out);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    for file in ["TumQuarterVehicle.fmu", "RecordedRoad.fmu", "quanser-lqr.ssp"] {
        let bytes = |folder: &Path| fs::read(folder.join(file)).expect("it is there");
        assert!(bytes(&out) == bytes(strut::fmus()), "{file}");
    }
    // What belongs to other sources has another name, and is not taken.
    for library in libraries.join("linux64").read_dir().into_iter().flatten() {
        let path = library.expect("a library").path();
        fs::rename(&path, path.with_extension("so.old")).expect("the folder is ours");
    }
    let other = folder.path().join("other");
    let done = without_cargo(&names[..1], &libraries, &other);
    let told = String::from_utf8_lossy(&done.stderr);
    for part in ["error: there is no cargo", "help: install Rust", "has no library", "fmu-quarter-car"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(!done.status.success() && !other.exists());
}
