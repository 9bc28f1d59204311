//! The FMU of another maker: hidden effects are found beside it, and its failures become messages.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use strut_blind::{cases, files, generate};
use strut_diagnosis::plant::{
    Attachment, Between, Drive, Follower, Foreign, Plant, Role, Seed, Seen, models,
};
use strut_diagnosis::rig::Rig;
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/foreign/model");

/// Where a platform's library is in an FMU; none where no C compiler makes it as here.
const LIBRARY: Option<&str> = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    Some("binaries/linux64/quarter.so")
} else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
    Some("binaries/aarch64-linux/quarter.so")
} else {
    None
};

/// A folder with the FMU, compiled with these definitions, and its rig file after a change.
fn rig(definitions: &[&str], change: impl Fn(String) -> String) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let library = folder.path().join("quarter.so");
    let compiled = Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", "-o"])
        .arg(&library)
        .args(definitions)
        .arg(format!("{MODEL}/quarter.c"))
        .arg("-lm")
        .status()
        .expect("a C compiler, cc");
    assert!(compiled.success());
    let mut archive = ZipWriter::new(File::create(folder.path().join("quarter.fmu")).unwrap());
    let description = fs::read(format!("{MODEL}/modelDescription.xml")).unwrap();
    let name = LIBRARY.unwrap_or("binaries/unknown/quarter.so");
    for (name, contents) in [("modelDescription.xml", description), (name, fs::read(&library).unwrap())] {
        archive.start_file(name, SimpleFileOptions::default()).unwrap();
        archive.write_all(&contents).unwrap();
    }
    archive.finish().unwrap();
    let path = folder.path().join("rig.toml");
    fs::write(&path, change(fs::read_to_string(format!("{MODEL}/rig.toml")).unwrap())).unwrap();
    (folder, path)
}

/// Records of a case of the blind benchmark, whose equations are its own.
fn records(name: &str, below: &Path) -> (PathBuf, PathBuf) {
    let case = cases::compact().into_iter().find(|case| case.name == name).expect("a case of that name");
    let data = files::write(&generate(&case).unwrap(), below).unwrap().join("data");
    (data.join("train-multisine.csv"), data.join("test-sweep.csv"))
}

fn diagnosed(rig: &Path, (train, test): (&Path, &Path), out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_diagnose"));
    command.arg("--rig").arg(rig).arg("--train").arg(train).arg("--test").arg(test);
    command.arg("--out").arg(out).output().unwrap()
}

fn found(name: &str) -> String {
    found_with(name, |text| text)
}

fn found_with(name: &str, change: impl Fn(String) -> String) -> String {
    let (folder, rig) = rig(&[], change);
    let (train, test) = records(name, folder.path());
    let output = diagnosed(&rig, (&train, &test), &folder.path().join("report"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("report/report.html").is_file());
    // A tool that runs an SSP could not run it: that is no failure.
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("note: no augmented.ssp: the FMU is for model exchange only"), "{told}");
    assert!(!folder.path().join("report/augmented.ssp").exists());
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn friction_that_another_program_has_hidden_is_found_beside_the_fmu() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let told = found("single-01");
    assert!(told.contains("The model lacks Coulomb friction in the strut."), "{told}");
    let value =
        told.split("strut.coulomb.force = ").nth(1).and_then(|it| it.split_once(' ')).expect("its size").0;
    let value: f64 = value.parse().unwrap();
    // The generator's truth, with the small effects that it adds to every case.
    assert!((value / 51.823 - 1.0).abs() < 0.05, "{value}");
}

/// The library's guide and tyre on top of what the FMU has there.
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
fn a_guide_and_a_tyre_of_the_library_act_beside_the_fmu() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let told = found_with("single-16", with_guide_and_tyre);
    assert!(told.contains("The model lacks guide friction."), "{told}");
}

#[test]
fn nothing_is_found_beside_the_fmu_where_nothing_is_hidden() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let told = found("none");
    assert!(told.contains("NO EFFECT"), "{told}");
}

#[test]
fn an_fmu_that_cannot_be_used_by_several_threads_is_used_by_one() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    if std::thread::available_parallelism().is_ok_and(|it| it.get() < 2) {
        return println!("skipped: there is only one processor");
    }
    let (folder, rig) = rig(&["-DALONE"], |text| text);
    let (train, test) = records("none", folder.path());
    let output = diagnosed(&rig, (&train, &test), &folder.path().join("report"));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && told.contains("once more with one thread"), "{told}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("NO EFFECT"));
}

#[test]
fn what_a_rig_file_and_its_fmu_lack_is_told_at_once() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let refused = |change: fn(String) -> String| {
        let (_folder, path) = rig(&[], change);
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
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    for (definition, expected) in
        [("-DCRASH_AFTER=20000", "crashed the process"), ("-DNOT_A_NUMBER", "diverges")]
    {
        let (folder, rig) = rig(&[definition], |text| text);
        let (train, test) = records("none", folder.path());
        let out = folder.path().join("report");
        let output = diagnosed(&rig, (&train, &test), &out);
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.contains(expected), "{definition}: {told}");
        assert!(!out.exists(), "{definition}");
    }
}

/// The FMU's parameters.
const NAMES: [&str; 6] = ["m_s", "m_u", "k_s", "d_s", "k_t", "d_t"];

/// The library's model, where its parameters are that the FMU has in this order, and all its values with the FMU's own.
fn library_s(fmu: &Plant) -> (Plant, [usize; 6], Vec<f64>) {
    let ours = models::named("QuarterCar").unwrap();
    let same = [
        "sprung_mass",
        "unsprung_mass",
        "strut.stiffness",
        "strut.damping",
        "tire.stiffness",
        "tire.damping",
    ];
    let own = same.map(|name| ours.parameter(name).unwrap());
    let mut values: Vec<f64> = ours.parameters.iter().map(|it| it.start).collect();
    own.iter().zip(&fmu.parameters).for_each(|(index, it)| values[*index] = it.start);
    (ours, own, values)
}

/// Each with an effect, all at once.
#[test]
fn elements_beside_the_fmu_do_what_they_do_in_a_model_of_the_library() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let (folder, _) = rig(&[], |text| text);
    let places = [
        (Role::Strut, "z_rel", "v_rel", "F_act"),
        (Role::Guide, "z_s", "v_s", "F_s"),
        (Role::WheelGuide, "z_u", "v_u", "F_u"),
        (Role::Tire, "z_t", "v_t", "F_u"),
    ];
    let beside = places.map(|(role, deflection, velocity, input)| Attachment {
        role,
        deflection: deflection.into(),
        rest: 0.0,
        velocity: velocity.into(),
        acts_on: vec![(input.into(), -1.0)],
        replaces: None,
    });
    let theirs = Foreign {
        fmu: folder.path().join("quarter.fmu"),
        parameters: NAMES.map(str::to_owned).to_vec(),
        locals: ["z_s", "v_s", "z_u", "v_u"].map(str::to_owned).to_vec(),
        beside: beside.to_vec(),
    };
    let theirs = theirs.plant().unwrap();
    let (ours, _, values) = library_s(&theirs);
    let effects = [
        ("strut.orifice.coefficient", 300.0),
        ("strut.spring.quadratic", 2e4),
        ("guide.coulomb.force", 20.0),
        ("guide.coulomb.velocity", 0.05),
        ("guide.preload", 5.0),
        ("wheel_guide.damping", 60.0),
        ("tire.quadratic", 4e6),
    ];
    let outputs = |plant: &Plant, mut values: Vec<f64>, names: [&str; 5]| {
        effects.iter().for_each(|(name, value)| values[plant.parameter(name).expect(name)] = *value);
        let (of_road, of_outputs) = names.split_at(2);
        let mut inputs = vec![vec![0.0; 1000]; plant.inputs.len()];
        let time = || (0..1000).map(|k| 1e-3 * f64::from(k));
        inputs[plant.input(of_road[0]).unwrap()] = time().map(|t| 0.01 * (9.0 * t).sin()).collect();
        inputs[plant.input(of_road[1]).unwrap()] = time().map(|t| 0.09 * (9.0 * t).cos()).collect();
        let drive = Drive { start: 0.0, step: 1e-3, inputs, finer: 1, between: Between::Lines };
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        let all = plant.prepare(&plant.choices).unwrap().outputs(&values, &start, &drive);
        of_outputs.iter().map(|name| all[plant.output(name).unwrap()].clone()).collect::<Vec<_>>()
    };
    let own = theirs.parameters.iter().map(|it| it.start).collect();
    let found = outputs(&theirs, own, ["z_r", "v_r", "z_rel", "a_s", "a_u"]);
    let signals = ["suspension.deflection", "body.acceleration", "wheel.acceleration"];
    let [deflection, body, wheel] = signals;
    let expected = outputs(&ours, values, ["road.position", "road.velocity", deflection, body, wheel]);
    for ((found, expected), name) in found.iter().zip(&expected).zip(signals) {
        near(found, expected, 1e-5, name);
    }
}

/// One signal is the other up to a share of its largest value.
fn near(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    let largest = b.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let error = a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(error < tolerance * largest, "{what}: {error} of {largest}");
}

/// The same equations in Rust, with exact derivatives.
#[test]
fn an_fmu_predicts_as_the_same_model_of_the_library_does() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let (folder, _) = rig(&[], |text| text);
    let parameters = NAMES.map(str::to_owned).to_vec();
    let fmu = Foreign {
        fmu: folder.path().join("quarter.fmu"),
        parameters,
        locals: Vec::new(),
        beside: Vec::new(),
    }
    .plant()
    .unwrap();
    let (ours, own, values) = library_s(&fmu);
    let theirs: Vec<f64> = fmu.parameters.iter().map(|it| it.start).collect();
    let signal = |f: fn(f64) -> f64| (0..2000).map(|k| f(f64::from(k) * 1e-3)).collect::<Vec<f64>>();
    let road = signal(|t| 0.01 * (9.0 * t).sin() + 2e-3 * (50.0 * t).sin());
    let rate = signal(|t| 0.09 * (9.0 * t).cos() + 0.1 * (50.0 * t).cos());
    let force = signal(|t| 30.0 * (20.0 * t).sin());
    let drive = |plant: &Plant, names: [&str; 3]| {
        let mut inputs = vec![vec![0.0; 2000]; plant.inputs.len()];
        for (name, signal) in names.into_iter().zip([&road, &rate, &force]) {
            inputs[plant.input(name).unwrap()].clone_from(signal);
        }
        Drive { start: 0.0, step: 1e-3, inputs, finer: 1, between: Between::Lines }
    };
    let outputs = [("z_rel", "suspension.deflection"), ("a_s", "body.acceleration"), ("F_t", "wheel.force")];
    let linearised = |plant: &Plant, drive: &Drive, values: &[f64], seeds: &[Seed], wanted: &[usize]| {
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        plant.prepare(&plant.choices).unwrap().linearised(values, &start, drive, seeds, wanted)
    };
    let seeds = |all: &[usize]| {
        let parameters = all.iter().map(|index| Seed::Parameter(*index));
        parameters.chain([Seed::State(0), Seed::State(3)]).collect::<Vec<_>>()
    };
    let wanted = outputs.map(|(name, _)| fmu.output(name).unwrap());
    let found = linearised(
        &fmu,
        &drive(&fmu, ["z_r", "v_r", "F_act"]),
        &theirs,
        &seeds(&[0, 1, 2, 3, 4, 5]),
        &wanted,
    );
    let wanted = outputs.map(|(_, name)| ours.output(name).unwrap());
    let drive = drive(&ours, ["road.position", "road.velocity", "actuator.force"]);
    let exact = linearised(&ours, &drive, &values, &seeds(&own), &wanted);
    for (output, (name, _)) in outputs.iter().enumerate() {
        near(&found.outputs[output], &exact.outputs[output], 1e-12, name);
        for (seed, (found, exact)) in found.slopes.iter().zip(&exact.slopes).enumerate() {
            near(&found[output], &exact[output], 1e-5, &format!("{name}, seed {seed}"));
        }
    }
}

/// Keeps what becomes of the states from sample to sample.
#[derive(Default)]
struct Slopes(Vec<Vec<f64>>);

impl Follower for Slopes {
    fn state(&mut self, _: usize, _: &mut [f64]) {}

    fn seen(&mut self, _: usize, _: Seen<'_>, _: &mut [f64]) {}

    fn advanced(&mut self, _: usize, _: &[f64], slopes: &[f64]) {
        self.0.push(slopes.to_vec());
    }
}

/// The FMU with a strut of the library on top of its own.
fn with_strut(folder: &TempDir) -> Plant {
    let strut = Attachment {
        role: Role::Strut,
        deflection: "z_rel".into(),
        rest: 0.0,
        velocity: "v_rel".into(),
        acts_on: vec![("F_act".into(), -1.0)],
        replaces: None,
    };
    let fmu = folder.path().join("quarter.fmu");
    Foreign { fmu, parameters: Vec::new(), locals: Vec::new(), beside: vec![strut] }.plant().unwrap()
}

/// A sine of 10 mm, sampled every millisecond; `turned` is its angle per sample in rad.
fn on_a_road(plant: &Plant, samples: u32, turned: f64) -> Drive {
    let mut inputs = vec![vec![0.0; samples as usize]; plant.inputs.len()];
    inputs[plant.input("z_r").unwrap()] =
        (0..samples).map(|k| 0.01 * (turned * f64::from(k)).sin()).collect();
    Drive { start: 0.0, step: 1e-3, inputs, finer: 1, between: Between::Lines }
}

/// It builds up over a tenth and a hundredth of a millimetre, and at rest nothing of it is fast.
#[test]
fn friction_before_it_slides_is_integrated_beside_the_fmu_however_stiff_it_is() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let (folder, _) = rig(&[], |text| text);
    let plant = with_strut(&folder);
    let dynamics = plant.prepare(&plant.choices).unwrap();
    let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
    let drive = on_a_road(&plant, 2000, 0.02);
    let deflection = plant.output("z_rel").unwrap();
    let with = |stiffness: f64| {
        let mut values: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        values[plant.parameter("hysteresis.presliding.force").unwrap()] = 50.0;
        values[plant.parameter("hysteresis.presliding.stiffness").unwrap()] = stiffness;
        dynamics.outputs(&values, &start, &drive).swap_remove(deflection)
    };
    let (soft, stiff) = (with(5e5), with(5e6));
    let largest = soft.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let apart = soft.iter().zip(&stiff).fold(0.0_f64, |most, (soft, stiff)| {
        if stiff.is_finite() { most.max((soft - stiff).abs()) } else { f64::INFINITY }
    });
    assert!(apart < 0.05 * largest, "{apart} of {largest}");
}

/// No output sees the memory of effects that are off, however often a change of it is made.
#[test]
fn the_memory_of_effects_that_are_off_keeps_its_derivatives() {
    if LIBRARY.is_none() {
        return println!("skipped: FMI 2.0 has no name for this platform that this test knows");
    }
    let (folder, _) = rig(&[], |text| text);
    let plant = with_strut(&folder);
    let dynamics = plant.prepare(&plant.choices).unwrap();
    let values: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
    let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
    let drive = on_a_road(&plant, 20, 0.1);
    let seeds: Vec<Seed> = (0..start.len()).map(Seed::State).collect();
    for _ in 0..40 {
        dynamics.linearised(&values, &start, &drive, &seeds, &[0]);
    }
    let mut slopes = Slopes::default();
    dynamics.followed(&values, &start, &drive, (&seeds, &[0]), &mut slopes);
    let memory: Vec<usize> =
        (0..start.len()).filter(|index| plant.states[*index].name.contains('.')).collect();
    assert!(memory.len() >= 3, "{memory:?}");
    for (sample, slopes) in slopes.0.iter().enumerate() {
        for index in &memory {
            let name = &plant.states[*index].name;
            assert_eq!(slopes[index * start.len() + index], 1.0, "{name} after sample {sample}");
        }
    }
}
