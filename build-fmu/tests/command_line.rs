//! What the command line answers. Nothing is compiled here but in the last test.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn build_fmu(arguments: &[&str]) -> Output {
    // As by `cargo run` at the root of the workspace.
    Command::new(env!("CARGO_BIN_EXE_build-fmu"))
        .args(arguments)
        .current_dir(root())
        .env_remove("SOURCE_DATE_EPOCH")
        .env_remove("STRUT_CROSS")
        .output()
        .unwrap()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Exit code, stdout and stderr.
fn answer(arguments: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = build_fmu(arguments);
    (status.code().unwrap(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

#[track_caller]
fn fails(arguments: &[&str], expected: &[&str]) {
    let (code, stdout, stderr) = answer(arguments);
    assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
    assert!(stderr.starts_with("error: "), "{stderr}");
    for part in expected {
        assert!(stderr.contains(part), "{part:?} is missing in\n{stderr}");
    }
}

fn file(folder: &tempfile::TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().into()
}

#[test]
fn help_has_examples_and_unknown_options_are_usage_errors() {
    let (code, stdout, _) = answer(&["--help"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("Examples:") && stdout.contains("--manifest-path my-model/Cargo.toml"));
    let (code, stdout, stderr) = answer(&["--outt", "x"]);
    assert_eq!((code, stdout.as_str()), (2, ""));
    assert!(stderr.contains("'--outt'") && stderr.contains("'--out'"), "{stderr}");
}

#[test]
fn the_list_names_fmus_and_systems_within_120_columns() {
    let (code, stdout, stderr) = answer(&["--list"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    for name in ["QuarterCar ", "TumQuarterVehicle ", "quanser-lqr "] {
        assert!(stdout.lines().any(|line| line.starts_with(name)), "{stdout}");
    }
    assert!(stdout.lines().all(|line| line.chars().count() <= 120), "{stdout}");
    let (_, one, _) = answer(&["--list", "quanser-lqr"]);
    assert_eq!(one.lines().count(), 2);
}

#[test]
fn an_unknown_name_brings_similar_ones() {
    fails(&["QuaterCar"], &["no FMU or system `QuaterCar`", "help: did you mean `QuarterCar`", "--list"]);
}

#[test]
fn targets_that_cannot_be_built_for_are_told_at_once() {
    let out = tempfile::tempdir().unwrap();
    let out = out.path().to_str().unwrap();
    let with = |targets: &[&str], expected: &[&str]| {
        let mut arguments = vec!["Road", "--out", out];
        targets.iter().for_each(|target| arguments.extend(["--target", target]));
        fails(&arguments, expected);
    };
    with(&["x86_64-unknown-linux-gun"], &["rustc knows no target", "`x86_64-unknown-linux-gnu`"]);
    with(&["wasm32-wasip1"], &["no target that FMUs are made for"]);
    with(&["x86_64-unknown-linux-gnu", "x86_64-unknown-linux-musl"], &["are both `linux64` in an FMU"]);
    with(&["i686-pc-windows-msvc"], &["is not installed", "rustup target add i686-pc-windows-msvc"]);
}

#[test]
fn a_toolchain_that_is_none_or_lacks_the_target_is_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let cross = folder.path().to_str().unwrap();
    let arguments = ["Road", "--out", cross, "--target", "i686-pc-windows-msvc", "--cross"];
    fails(
        &[&arguments[..], &["nowhere"]].concat(),
        &["no toolchain in `nowhere`", "build-fmu/cross/toolchain"],
    );
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        std::fs::create_dir(folder.path().join("bin")).unwrap();
        let compiler = file(&folder, "bin/rustc", "#!/bin/sh\necho /nowhere\n");
        std::fs::set_permissions(&compiler, std::fs::Permissions::from_mode(0o755)).unwrap();
        fails(&[&arguments[..], &[cross]].concat(), &["`i686-pc-windows-msvc` is not installed"]);
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_build() {
    let folder = tempfile::tempdir().unwrap();
    let taken = file(&folder, "taken", "");
    fails(&["Road", "--out", &taken], &["cannot make the folder", "--out"]);
}

#[test]
fn broken_parameter_sets_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let head = "fmu = \"Mine\"\ntitle = \"t\"\nsource = \"s\"\n";
    for (text, expected) in [
        (String::from("fmu ="), "is broken"),
        (format!("{head}model = \"QuartrCar\""), "did you mean `QuarterCar`"),
        (format!("{}model = \"Road\"", head.replace("Mine", "my road")), "identifier of the language C"),
        (
            format!("{}model = \"Road\"", head.replace("Mine", "Road")),
            "two FMUs or systems of the name `Road`",
        ),
        (format!("{head}model = \"Road\"\n[values]\nheigt = {{ value = 1.0 }}"), "no parameter `heigt`"),
    ] {
        let path = file(&folder, "mine.toml", &text);
        fails(&["--parameters", &path, "--list"], &[expected]);
    }
    fails(&["--parameters", "nowhere.toml"], &["cannot read `nowhere.toml`"]);
}

#[test]
fn a_system_of_unknown_fmus_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = "name = \"s\"\ntitle = \"t\"\nsource = \"s\"\ncomponents = { road = \"QuanserRaod\" }\nconnections = []\n\
                [experiment]\nstop = 1.0\nstep = 0.1\n";
    let path = file(&folder, "s.toml", text);
    fails(&["--system", &path], &["component `road` of the system s", "did you mean `QuanserRoad`"]);
}

#[test]
fn a_manifest_must_be_that_of_a_model() {
    fails(&["--manifest-path", "nowhere/Cargo.toml"], &["no manifest `nowhere/Cargo.toml`"]);
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("src")).unwrap();
    file(&folder, "src/lib.rs", "");
    let path = file(&folder, "Cargo.toml", "[package]\nname = \"mine\"\nedition = \"2024\"\n[workspace]\n");
    fails(&["--manifest-path", &path], &["`mine` is not both", "crate-type = [\"cdylib\", \"rlib\"]"]);
}

#[test]
fn the_same_sources_give_the_same_bytes() {
    let build = || {
        let out = tempfile::tempdir().unwrap();
        let (code, stdout, stderr) = answer(&["TumSkyhook", "--out", out.path().to_str().unwrap()]);
        assert_eq!(code, 0, "{stderr}");
        assert!(stdout.contains("TumSkyhook  controller  1 → 1"), "{stdout}");
        let files: Vec<_> = std::fs::read_dir(out.path()).unwrap().map(|file| file.unwrap().path()).collect();
        assert_eq!(files.len(), 1, "{files:?}");
        std::fs::read(&files[0]).unwrap()
    };
    assert!(build() == build());
}
