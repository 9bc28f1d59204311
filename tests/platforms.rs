//! FMUs with several platforms in one file: what they need, what masters see in them, and that every library gives
//! the same bits. What is checked stands in `masters/platforms.py` and `platforms/host.c`.
//!
//! Windows is emulated by Wine, Linux on ARM by QEMU; `.ci/install` installs both and the compilers. Where something
//! is missing, that platform is left out, which is told; not so where `CI` is set.

use std::ffi::OsString;
use std::fs;

/// A platform that the machine of the tests is not.
struct Platform {
    folder: &'static str,
    target: &'static str,
    triple: &'static str,
    linker: &'static str,
    emulator: &'static str,
}

const EMULATED: [Platform; 2] = [
    Platform {
        folder: "win64",
        target: "x86_64-pc-windows-gnu",
        triple: "x86_64-pc-windows-gnu",
        linker: "x86_64-w64-mingw32-gcc",
        emulator: "wine",
    },
    Platform {
        folder: "aarch64-linux",
        target: "aarch64-unknown-linux-gnu.2.17",
        triple: "aarch64-unknown-linux-gnu",
        linker: "aarch64-linux-gnu-gcc",
        emulator: "qemu-aarch64-static",
    },
];

/// A rig with a parameter set in its resources, and an actuator without.
const FMUS: [&str; 2] = ["TumQuarterVehicle", "LinearMotor"];

impl Platform {
    /// What is missing here for building and running its libraries.
    fn missing(&self) -> Vec<String> {
        let mut missing = strut::missing_for(self.triple, self.linker);
        if !strut::runs(self.emulator) {
            missing.push(self.emulator.into());
        }
        missing
    }
}

#[test]
#[ignore = "compiles two packages three times: `scripts/long-tests platforms-of-two`"]
fn every_platform_in_one_file_gives_the_same_bits() {
    print!("{}", played(&FMUS, "tested-platforms"));
}

#[test]
#[ignore = "takes a quarter of an hour: every model is compiled three times, and every FMU is played six times: `scripts/long-tests platforms`"]
fn every_fmu_gives_the_same_bits_on_every_platform() {
    print!("{}", played(&[], "tested-every-platform"));
}

/// Builds some FMUs, or all, for every platform that can be run here, and plays every library: what was played.
fn played(names: &[&str], folder: &str) -> String {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        strut::skip("every platform: they are emulated on Linux on an Intel processor only");
        return String::new();
    }
    let mut folders = vec!["linux64"];
    let mut targets = vec!["x86_64-unknown-linux-gnu.2.17"];
    for platform in &EMULATED {
        let missing = platform.missing();
        if missing.is_empty() {
            folders.push(platform.folder);
            targets.push(platform.target);
        } else {
            strut::skip(&format!("{}: for want of {}", platform.folder, missing.join(" and ")));
        }
    }
    let work = strut::target().join(folder);
    let fmus = work.join("fmus");
    let _ = fs::remove_dir_all(&fmus);
    let mut build = strut::build_fmu();
    build.args(names).arg("--out").arg(&fmus).env("PATH", with_zig());
    for target in targets {
        build.args(["--target", target]);
    }
    let told = String::from_utf8_lossy(&strut::run(&mut build).stderr).into_owned();
    let needs = |folder: &str| {
        let line = told.lines().find_map(|line| line.strip_prefix(&format!("note: {folder} needs ")));
        line.unwrap_or_else(|| panic!("nothing is told of {folder}: {told}")).to_owned()
    };
    for folder in &folders {
        let needs = needs(folder);
        match needs.strip_prefix("glibc 2.").and_then(|rest| rest.strip_suffix(" or newer")) {
            Some(version) => assert!(version.parse::<u32>().is_ok_and(|it| it <= 17), "{folder}: {needs}"),
            None => assert_eq!(needs, "nothing but the system", "{folder}"),
        }
    }
    let packed = fs::read_dir(&fmus).expect("it was made").flatten();
    let packed = packed.filter(|file| file.path().extension().is_some_and(|ending| ending == "fmu")).count();
    assert!(packed >= names.len().max(1), "{told}");
    let mut arguments: Vec<OsString> = vec![fmus.into(), work.into()];
    arguments.extend(folders.iter().map(OsString::from));
    let output = strut::python("tests/masters/platforms.py", &arguments);
    assert_eq!(output.lines().count(), packed * folders.len(), "every library is to be run");
    output
}

/// The path with the environment's `cargo-zigbuild` in it.
fn with_zig() -> OsString {
    let own = strut::interpreter().parent().expect("it is in a folder").to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::join_paths(std::iter::once(own).chain(std::env::split_paths(&path)))
        .expect("no `:` in the folder's name")
}
