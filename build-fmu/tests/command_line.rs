//! What the command line answers. Nothing is compiled here but in the last two tests.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// As by `cargo run` at the root of the workspace.
fn build_fmu(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_build-fmu"));
    command.args(arguments).current_dir(root()).env_remove("SOURCE_DATE_EPOCH").env_remove("STRUT_CROSS");
    command
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// Exit code, stdout and stderr.
fn answer(arguments: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = build_fmu(arguments).output().unwrap();
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
    let (code, stdout, stderr) = answer(&["list"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    for name in ["QuarterCar ", "TumQuarterVehicle ", "quanser-lqr "] {
        assert!(stdout.lines().any(|line| line.starts_with(name)), "{stdout}");
    }
    assert!(stdout.lines().all(|line| line.chars().count() <= 120), "{stdout}");
    let (_, one, _) = answer(&["list", "quanser-lqr"]);
    assert_eq!(one.lines().count(), 2);
}

#[test]
fn the_list_is_there_for_programs_too() {
    let (code, stdout, _) = answer(&["list", "--json", "TumRoad", "quanser-lqr"]);
    assert_eq!(code, 0);
    let list: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(list[0]["model"], "Road");
    assert_eq!((&list[0]["inputs"], &list[0]["outputs"]), (&0.into(), &2.into()));
    assert_eq!(list[1]["components"]["rig"], "QuanserQuarterCar");
    assert_eq!(list.as_array().unwrap().len(), 2);
}

#[test]
fn an_fmu_is_described_with_all_that_is_declared() {
    let (code, stdout, stderr) = answer(&["describe", "TumQuarterVehicle"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    for part in [
        "TumQuarterVehicle  rig",
        "The nonlinear model of the TUM rig",
        "TUM eq. 12, 14; asymmetry derived from Table 9",
        "strut.coulomb.force",
        "Table 10: friction spring/damper",
        "N·s/m",
        "QuanserQuarterCar",
        "tum-active",
    ] {
        assert!(stdout.contains(part), "{part:?} is missing in\n{stdout}");
    }
    // Not in a terminal: no colours, and a width that every reader has. Names are not broken.
    assert!(!stdout.contains('\u{1b}'));
    assert!(stdout.lines().all(|line| line.chars().count() <= 100), "{stdout}");
    let (_, json, _) = answer(&["describe", "TumQuarterVehicle", "--json"]);
    let facts: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(facts["parameter_set"]["values"]["sprung_mass"]["value"], 94.38);
    let variables = facts["variables"].as_array().unwrap();
    let mass = variables.iter().find(|variable| variable["name"] == "sprung_mass").unwrap();
    assert_eq!((&mass["start"], &mass["unit"]), (&94.38.into(), &"kg".into()));
    let rate = variables.iter().find(|variable| variable["name"] == "der(body.position)").unwrap();
    assert_eq!(rate["derivative_of"], "body.position");
}

#[test]
fn a_system_is_described_with_its_connections() {
    let (code, stdout, _) = answer(&["describe", "quanser-lqr"]);
    assert_eq!(code, 0);
    for part in ["QuanserLqrController", "→ rig.actuator.force", "controller.switch_on_time      5  s"] {
        assert!(stdout.contains(part), "{part:?} is missing in\n{stdout}");
    }
    let (_, json, _) = answer(&["describe", "quanser-lqr", "--json"]);
    let facts: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(facts["parameters"]["controller.switch_on_time"]["value"], 5.0);
}

#[test]
fn shells_complete_commands_and_names() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let (code, script, stderr) = answer(&["completions", shell]);
        assert_eq!((code, stderr.as_str()), (0, ""));
        // The other scripts know no values of arguments.
        let knows = ["bash", "zsh"].contains(&shell);
        let names: &[&str] = if knows { &["TumQuarterVehicle", "quanser-lqr"] } else { &[] };
        for word in ["describe", "check", "manifest-path"].iter().chain(names) {
            assert!(script.contains(word), "{word} is missing for {shell}");
        }
    }
}

/// What bash offers for the last of some words.
#[cfg(unix)]
fn offered(words: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (_, script, _) = answer(&["completions", "bash"]);
    let path = file(&folder, "completions", &script);
    let asks = format!(
        "source '{path}'; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); \
         $(complete -p build-fmu | sed 's/.*-F \\([^ ]*\\).*/\\1/') build-fmu \"${{COMP_WORDS[-1]}}\" \
         \"${{COMP_WORDS[-2]}}\"; echo \"${{COMPREPLY[*]}}\""
    );
    let output = Command::new("bash").args(["-c", &asks]).output().unwrap();
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

#[cfg(unix)]
#[test]
fn bash_completes() {
    assert_eq!(offered("build-fmu desc"), "describe");
    assert_eq!(offered("build-fmu describe TumQ"), "TumQuarterVehicle");
    assert_eq!(offered("build-fmu list quanser"), "quanser-lqr");
    assert_eq!(offered("build-fmu QuanserQ"), "QuanserQuarterCar");
    assert_eq!(offered("build-fmu check --str"), "--strict");
}

#[test]
fn an_unknown_name_brings_similar_ones() {
    fails(
        &["QuaterCar"],
        &["no FMU or system `QuaterCar`", "help: did you mean `QuarterCar`", "build-fmu list"],
    );
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

/// A system of FMUs of others, which nothing has to be compiled for.
fn system_of_others(folder: &tempfile::TempDir, name: &str, connection: &str) -> String {
    let xml = "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"M\" guid=\"1\"><CoSimulation modelIdentifier=\"M\"/>\
        <ModelVariables><ScalarVariable name=\"y\" valueReference=\"0\" causality=\"output\"><Real/></ScalarVariable>\
        <ScalarVariable name=\"u\" valueReference=\"1\" causality=\"input\"><Real start=\"0\"/></ScalarVariable>\
        </ModelVariables></fmiModelDescription>";
    let mut zip = zip::ZipWriter::new(std::fs::File::create(folder.path().join("M.fmu")).unwrap());
    for (name, contents) in [("modelDescription.xml", xml), ("binaries/linux64/M.so", "")] {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        std::io::Write::write_all(&mut zip, contents.as_bytes()).unwrap();
    }
    zip.finish().unwrap();
    let text = format!(
        "name = \"{name}\"\ntitle = \"t\"\nsource = \"s\"\ncomponents = {{ m = {{ fmu = \"M.fmu\" }} }}\n\
         connections = [\"{connection}\"]\n[experiment]\nstop = 1.0\nstep = 0.1\n"
    );
    file(folder, &format!("{name}.toml"), &text)
}

#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn a_bad_system_does_not_stop_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let good = system_of_others(&folder, "good", "m.y -> m.u");
    let bad = system_of_others(&folder, "bad", "m.x -> m.u");
    let broken = file(&folder, "broken.toml", "name = [");
    let out = folder.path().join("out");
    let systems = ["--system", &bad, "--system", &broken, "--system", &good, "--out", out.to_str().unwrap()];
    let (code, stdout, stderr) = answer(&systems);
    assert_eq!(code, 1, "{stderr}");
    assert!(stdout.contains("good.ssp") && out.join("good.ssp").is_file(), "{stdout}");
    assert!(!out.join("bad.ssp").exists());
    for part in ["broken.toml` is broken", "has no variable `x` in the system bad"] {
        assert!(stderr.contains(part), "{stderr}");
    }
    // With no other wish it is the only answer.
    fails(&systems[..4], &["broken.toml` is broken", "no variable `x`"]);
}

#[test]
fn systems_want_fmi_2_and_other_versions_are_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    fails(
        &["quanser-lqr", "--fmi", "3", "--out", out],
        &["the system quanser-lqr", "SSP 1.0", "add `--fmi 2`"],
    );
    assert!(!Path::new(out).exists());
    let (code, _, stderr) = answer(&["QuarterCar", "--fmi", "1"]);
    assert!(code == 2 && stderr.contains("[possible values: 2, 3]"), "{stderr}");
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
        fails(&["list", "--parameters", &path], &[expected]);
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
