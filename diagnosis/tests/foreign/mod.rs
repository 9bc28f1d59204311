//! The FMU of another maker: hidden effects are found beside it, and its failures become messages.

mod events;
mod predicts;

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use strut_blind::{cases, files, generate};
use strut_diagnosis::rig::Rig;
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const MODELS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/foreign");

/// Where a platform's libraries are in an FMU; none where no C compiler makes them as here.
const LIBRARIES: Option<&str> = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    Some("binaries/linux64")
} else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
    Some("binaries/aarch64-linux")
} else {
    None
};

/// A folder with an FMU, compiled with these definitions; none, and a word of it, where no test can have it.
fn packed(model: &str, definitions: &[&str]) -> Option<TempDir> {
    let Some(libraries) = LIBRARIES else {
        println!("skipped: FMI 2.0 has no name for this platform that this test knows");
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join(format!("{model}.so"));
    let compiled = Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", "-o"])
        .arg(&library)
        .args(definitions)
        .arg(format!("{MODELS}/{model}/{model}.c"))
        .arg("-lm")
        .status()
        .expect("a C compiler, cc");
    assert!(compiled.success());
    let file = File::create(folder.path().join(format!("{model}.fmu"))).unwrap();
    let mut archive = ZipWriter::new(file);
    let description = fs::read(format!("{MODELS}/{model}/modelDescription.xml")).unwrap();
    let library = (format!("{libraries}/{model}.so"), fs::read(&library).unwrap());
    for (name, contents) in [("modelDescription.xml".into(), description), library] {
        archive.start_file(name, SimpleFileOptions::default()).unwrap();
        archive.write_all(&contents).unwrap();
    }
    archive.finish().unwrap();
    Some(folder)
}

/// A folder with the quarter car, compiled with these definitions, and its rig file after a change; none where no test can have it.
fn rig(definitions: &[&str], change: impl Fn(String) -> String) -> Option<(TempDir, PathBuf)> {
    let folder = packed("quarter", definitions)?;
    let path = folder.path().join("rig.toml");
    fs::write(&path, change(fs::read_to_string(format!("{MODELS}/quarter/rig.toml")).unwrap())).unwrap();
    Some((folder, path))
}

/// The first samples of records of a case of the blind benchmark, whose equations are its own.
fn records(name: &str, below: &Path, samples: usize) -> (PathBuf, PathBuf) {
    let case = cases::compact().into_iter().find(|case| case.name == name).expect("a case of that name");
    let data = files::write(&generate(&case).unwrap(), below).unwrap().join("data");
    let records = (data.join("train-multisine.csv"), data.join("test-sweep.csv"));
    for record in [&records.0, &records.1] {
        let text = fs::read_to_string(record).unwrap();
        let short: Vec<&str> = text.lines().take(1 + samples).collect();
        fs::write(record, short.join("\n")).unwrap();
    }
    records
}

fn diagnosed(rig: &Path, (train, test): (&Path, &Path), out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_diagnose"));
    command.arg("--rig").arg(rig).arg("--train").arg(train).arg("--test").arg(test);
    command.arg("--out").arg(out).output().unwrap()
}

/// The terminal's text of a case, with the rig file after a change; none where no test can have the FMU.
fn found(name: &str, change: impl Fn(String) -> String) -> Option<String> {
    let (folder, rig) = rig(&[], change)?;
    let (train, test) = records(name, folder.path(), 3000);
    let output = diagnosed(&rig, (&train, &test), &folder.path().join("report"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("report/report.html").is_file());
    // A tool that runs an SSP could not run it: that is no failure.
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("note: no augmented.ssp: the FMU is for model exchange only"), "{told}");
    assert!(!folder.path().join("report/augmented.ssp").exists());
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn friction_that_another_program_has_hidden_is_found_beside_the_fmu() {
    let Some(told) = found("single-01", |text| text) else { return };
    assert!(told.contains("The model lacks Coulomb friction in the strut."), "{told}");
    let value =
        told.split("strut.coulomb.force = ").nth(1).and_then(|it| it.split_once(' ')).expect("its size").0;
    let value: f64 = value.parse().unwrap();
    // The generator's truth, with the small effects that it adds to every case.
    assert!((value / 51.823 - 1.0).abs() < 0.05, "{value}");
}

/// The library's guide and tyre, in addition to the FMU's own.
fn with_guide_and_tyre(text: String) -> String {
    text + r#"
[[elements]]
element = "guide"
deflection = "z_s"
velocity = "v_s"
force = { mass = "m_s", acceleration = "a_s" }
acts_on = ["-F_s"]

[[elements]]
element = "tire"
deflection = "z_t"
velocity = "v_t"
force = { output = "F_t" }
acts_on = ["-F_u"]
"#
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_guide_and_a_tyre_of_the_library_act_beside_the_fmu() {
    let Some(told) = found("single-16", with_guide_and_tyre) else { return };
    assert!(told.contains("The model lacks guide friction."), "{told}");
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn nothing_is_found_beside_the_fmu_where_nothing_is_hidden() {
    let Some(told) = found("none", |text| text) else { return };
    assert!(told.contains("NO EFFECT"), "{told}");
}

#[test]
fn an_fmu_that_cannot_be_used_by_several_threads_is_used_by_one() {
    if std::thread::available_parallelism().is_ok_and(|it| it.get() < 2) {
        return println!("skipped: there is only one processor");
    }
    let Some((folder, rig)) = rig(&["-DALONE"], |text| text) else { return };
    // An eighth of the records is enough to be run by several threads.
    let (train, test) = records("none", folder.path(), 2500);
    let output = diagnosed(&rig, (&train, &test), &folder.path().join("report"));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && told.contains("once more with one thread"), "{told}");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(
        told.contains("m_u differs from the starting model. The records show no further effect."),
        "{told}"
    );
}

#[test]
fn what_a_rig_file_and_its_fmu_lack_is_told_at_once() {
    let Some((_folder, path)) = rig(&[], |text| text) else { return };
    let text = fs::read_to_string(&path).unwrap();
    let refused = |change: fn(String) -> String| {
        fs::write(&path, change(text.clone())).unwrap();
        Rig::read(&path).unwrap_err()
    };
    let text = refused(|text| text.replace("\"m_s\"", "\"m_x\", \"m_y\""));
    assert!(text.contains("no real parameter m_x, m_y") && text.contains("m_s, m_u"), "{text}");
    let text = refused(|text| text.replace("-F_act", "-F_axt"));
    assert!(text.contains("the input `F_axt`"), "{text}");
    // The acceleration follows from the force at once.
    let text = refused(|text| text.replace("velocity = \"v_rel\"", "velocity = \"a_s\""));
    assert!(text.contains("algebraic loop"), "{text}");
    let text = refused(|text| with_guide_and_tyre(text).replace("\"tire\"", "\"guide\""));
    assert!(text.contains("elements, guide: only one of a kind"), "{text}");
    let text = refused(|text| with_guide_and_tyre(text).replace("\"tire\"", "\"valve\""));
    assert!(text.contains("acts_on is for one of strut, guide, wheel_guide, tire"), "{text}");
    let text = refused(|text| text.replace("F_t = [", "F_x = [").replace("z_r = [", "z_x = ["));
    assert!(text.contains("`F_x`") && text.contains("`z_x`"), "{text}");
    let text = refused(|text| text.replace("quarter.fmu", "other.fmu"));
    assert!(text.contains("other.fmu"), "{text}");
    let text = refused(|text| text.replace("v_r = \"z_r\"", "v_r = \"z_q\""));
    assert!(text.contains("no input `z_q`"), "{text}");
}

#[test]
fn an_fmu_that_crashes_or_computes_nothing_is_told_and_leaves_nothing_behind() {
    for (definition, expected) in
        [("-DCRASH_AFTER=20000", "crashed the process"), ("-DNOT_A_NUMBER", "diverges")]
    {
        let Some((folder, rig)) = rig(&[definition], |text| text) else { return };
        let (train, test) = records("none", folder.path(), 10_000);
        let out = folder.path().join("report");
        let output = diagnosed(&rig, (&train, &test), &out);
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.contains(expected), "{definition}: {told}");
        assert!(!out.exists(), "{definition}");
    }
}
