//! Records that others have measured on real hardware: place, group and size by hand, and a regression as the floor.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{diagnose, folder, named, report};

/// Records of real rigs, which others have measured; they are no part of the project.
fn real(folder: &str) -> Option<PathBuf> {
    let folder = strut::root().join("../shared/data").join(folder);
    if !folder.is_dir() {
        strut::tell(&format!("skipped: the records of {} are not here", folder.display()));
        return None;
    }
    Some(folder)
}

/// Diagnoses a force element from records of one and judges it by others; the report, and Φ of the force.
fn diagnose_element(name: &str, records: &Path, train: &str, test: &[&str]) -> (Value, f64) {
    let out = folder(name);
    let mut command = diagnose();
    command.args(["--rig", "element-dyno", "--no-fmu", "--train"]).arg(records.join(train));
    for record in test {
        command.arg("--test").arg(records.join(record));
    }
    let output = strut::run(command.arg("--out").arg(&out));
    print!("{}", String::from_utf8_lossy(&output.stdout));
    let report = report(&out);
    let signal = &report["signals"][0];
    assert_eq!(signal["name"], "force");
    let phi = signal["fit_after"].as_f64().expect("a number");
    let test: Vec<PathBuf> = test.iter().map(|it| records.join(it)).collect();
    let by_hand = regression(&records.join(train), &test);
    assert!(phi >= by_hand, "Φ = {phi}, and a regression has {by_hand}");
    (report, phi)
}

/// Fit of the force on the validation records by a regression on constant, position, velocity, its sign and acceleration.
fn regression(train: &Path, test: &[PathBuf]) -> f64 {
    let said = strut::python(
        "tests/diagnosis/regression.py",
        std::iter::once(train).chain(test.iter().map(PathBuf::as_path)),
    );
    said.trim().parse().expect("a number")
}

/// By hand 86 % were reached on another record of the same letter, with a dry yield force and hysteresis.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn the_magnetorheological_damper_is_explained() {
    let Some(records) = real("mr-damper") else { return };
    for (name, train, test) in [("mr-a", "A.2.csv", "A.1.csv"), ("mr-b", "B.1.csv", "B.3.csv")] {
        let (report, phi) = diagnose_element(name, &records, train, &[test]);
        assert!(phi >= 0.86, "{test}: Φ = {phi}");
        let named = named(&report);
        assert!(named.iter().any(|id| ["32f", "03"].contains(id)), "{train}: {named:?} has no yield force");
    }
}

/// By hand 80 % and 79 % were reached on the two validation records, with presliding friction. The damper has a backlash, as its
/// makers say, and pulls harder in one direction.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn the_friction_damper_is_explained() {
    let Some(records) = real("friction-damper") else { return };
    let test = ["1Hz30lbtension0.5amplitude.csv", "0.25Hz30lbtension1.5amplitude.csv"];
    let (report, phi) = diagnose_element("friction", &records, "0.5Hz30lbtension1amplitude.csv", &test);
    assert!(phi >= 0.80, "Φ = {phi}");
    let named = named(&report);
    assert!(named.contains(&"03b"), "{named:?} lacks the backlash");
}

/// Diagnoses a drive from records of one and judges it by others.
fn diagnose_drive(name: &str, records: &Path, pair: [&str; 2], more: &[&str]) -> Value {
    diagnose_rig("linear-drive", name, records, pair, more)
}

fn diagnose_rig(rig: &str, name: &str, records: &Path, [train, test]: [&str; 2], more: &[&str]) -> Value {
    let out = folder(name);
    let mut command = diagnose();
    command.args(["--rig", rig, "--no-fmu", "--train"]).arg(records.join(train));
    command.arg("--test").arg(records.join(test)).args(more);
    let output = strut::run(command.arg("--out").arg(&out));
    print!("{}", String::from_utf8_lossy(&output.stdout));
    report(&out)
}

/// Value and interval of a nominal parameter.
fn nominal(report: &Value, name: &str) -> [f64; 3] {
    let all = report["nominal_parameters"].as_array().expect("a list");
    let found = all.iter().find(|it| it["name"] == name).expect(name);
    ["after", "low", "high"].map(|field| found[field].as_f64().expect("a number"))
}

/// Text of all that is to be said about the data.
fn notes(report: &Value) -> String {
    let all = report["data_problems"].as_array().expect("a list").iter();
    all.filter_map(|it| it["text"].as_str()).collect::<Vec<_>>().join("\n")
}

/// By hand: an offset of 252 N and a friction of 145 N; fit 0.58 of a linear law, 0.72 with presliding friction.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn a_load_cell_that_was_not_zeroed_hides_no_friction() {
    let Some(records) = real("real/mr-damper-sweep") else { return };
    let (report, phi) = diagnose_element("sweep", &records, "tr.csv", &["te.csv"]);
    assert!(phi >= 0.72, "Φ = {phi}");
    assert_eq!(named(&report), ["01"]);
    let force = &report["effects"][0]["parameters"][0];
    let [low, high] = ["low", "high"].map(|field| force[field].as_f64().expect("a number"));
    assert!(low < 145.0 && 145.0 < high && low > 0.0, "{force}");
    let [_, low, high] = nominal(&report, "strut.preload");
    assert!(low < 252.0 && 252.0 < high && low > 200.0, "{low} … {high}");
}

/// By hand, with a voltage u behind a short lag: (1285 + 428 u) v + (235 + 354 u) tanh(v/v_0), fit 0.76; 0.60 without the voltage. A
/// law with the yield force alone takes over what the damping does.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn the_voltage_of_a_coil_sets_the_yield_force() {
    let Some(records) = real("real/mr-damper-random") else { return };
    let (report, phi) = diagnose_element("voltage", &records, "a.csv", &["b.csv"]);
    assert!(phi >= 0.76, "Φ = {phi}");
    // What yields without a voltage builds up after each reversal, with or without a backlash of micrometres.
    let found = named(&report);
    assert!(found == ["32nt", "03"] || found == ["32nt", "03b"], "{found:?}");
    let effects = report["effects"].as_array().expect("a list");
    let parameters: Vec<&Value> =
        effects.iter().flat_map(|it| it["parameters"].as_array().expect("a list")).collect();
    let of = |name: &str| parameters.iter().find(|it| it["name"] == name).expect(name);
    let value = |name: &str, field: &str| of(name)[field].as_f64().expect("a number");
    let force = value("control.yield_force", "value");
    assert!((force / 354.0 - 1.0).abs() < 0.25, "{force} N");
    assert!(value("hysteresis.presliding.force", "low") > 0.0);
    assert!(value("control.lag", "low") > 0.0 && value("control.lag", "high") < 0.02);
}

/// The same where nobody says that the column is a voltage: no signal of the rig is.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests records`"]
fn a_force_that_follows_another_column_is_told() {
    let Some(records) = real("real/mr-damper-random") else { return };
    let unnamed = folder("random-records");
    fs::create_dir_all(&unnamed).expect("a folder");
    for record in ["a.csv", "b.csv"] {
        let text = fs::read_to_string(records.join(record)).expect("a record");
        fs::write(unnamed.join(record), text.replacen("voltage [V]", "dial [1]", 1)).expect("a record");
    }
    let (report, _) = diagnose_element("random", &unnamed, "a.csv", &["b.csv"]);
    // Friction before it slides answers the noise of the motion, which a smooth law by hand does not.
    let phi = report["signals"][0]["fit_without_input_noise"].as_f64().expect("a number");
    assert!(phi >= 0.60, "Φ = {phi}");
    let unmodelled = report["unmodelled"].as_array().expect("a list");
    let voltage = unmodelled.iter().find(|it| it["depends_on"][0] == "column dial").expect("the voltage");
    assert_eq!(voltage["place"], "strut");
    assert!(voltage["validation_share"].as_f64().expect("a number") > 0.5, "{voltage}");
}

/// By hand: 25.1 kg and 44 N s/m. One stroke of half a second is both estimation and validation record.
#[test]
fn one_stroke_tells_a_mass_and_is_no_second_witness() {
    let Some(records) = real("real/rack-and-pinion") else { return };
    let report = diagnose_drive("rack", &records, ["stroke.csv", "stroke.csv"], &[]);
    assert!((nominal(&report, "moving_mass")[0] - 25.1).abs() < 0.5);
    assert!((nominal(&report, "guide.damping")[0] - 44.0).abs() < 15.0);
    assert!(named(&report).is_empty());
    let notes = notes(&report);
    assert!(notes.contains("same data") && notes.contains("0.54 s long"), "{notes}");
}

/// Made with 142122 N/m and 22.6 N s/m. The motion is given, and the spring is a nominal parameter of the balance.
#[test]
fn a_spring_to_the_ground_is_found_at_sixty_hertz() {
    let Some(records) = real("real/spring-60-hz") else { return };
    let more = ["--known", "moving_mass=1.0±0.05", "--effects", "08,15"];
    let report = diagnose_drive("spring", &records, ["tr.csv", "te.csv"], &more);
    assert!(named(&report).is_empty(), "{:?}", named(&report));
    let stiffness = nominal(&report, "ground_spring.stiffness")[0];
    assert!((stiffness / 142_122.0 - 1.0).abs() < 0.02, "{stiffness}");
    assert!((nominal(&report, "guide.damping")[0] / 22.6 - 1.0).abs() < 0.1);
}

/// The interval of the first parameter of an effect with a name.
fn sized(report: &Value, id: &str) -> [f64; 2] {
    let effects = report["effects"].as_array().expect("a list");
    let effect = effects.iter().find(|it| it["id"] == id).expect(id);
    ["low", "high"].map(|field| effect["parameters"][0][field].as_f64().expect("a number"))
}

/// By hand: friction of 450 to 540 N, 48 kN s/m, and a mass that cannot be determined. The records have eight strokes at few speeds.
#[test]
fn a_cylinder_has_friction_beside_its_damping() {
    let Some(records) = real("real/hydraulic-actuator") else { return };
    let report = diagnose_drive("cylinder", &records, ["f1_4.csv", "f1_3.csv"], &[]);
    assert_eq!(named(&report), ["16"]);
    let [low, high] = sized(&report, "16");
    assert!(0.0 < low && low < 480.0 && 480.0 < high && high < 1000.0, "{low} … {high}");
    let [_, low, high] = nominal(&report, "guide.damping");
    assert!(low < 48e3 && 48e3 < high, "{low} … {high}");
    let all = report["nominal_parameters"].as_array().expect("a list");
    let mass = all.iter().find(|it| it["name"] == "moving_mass").expect("a mass");
    assert_eq!(mass["mismatch"], false, "{mass}");
}

/// By hand: friction of 0.12 to 0.14 N m with an inertia of 4e-4 kg m². The joint sticks and slips, and its velocity was
/// measured more finely than its position. The file states no units.
#[test]
fn a_joint_that_sticks_and_slips_has_friction() {
    let Some(records) = real("real/robot-joint") else { return };
    let below = tempfile::tempdir().expect("a folder");
    let map = below.path().join("joint.toml");
    let units = "[signals]\nposition = { column = \"position\", unit = \"rad\" }\nvelocity = { column = \"velocity\", unit = \
                 \"rad/s\" }\n\"motor.torque\" = { column = \"force\", unit = \"N.m\" }\n";
    fs::write(&map, units).expect("written");
    let more = ["--map", map.to_str().expect("a plain path")];
    let report = diagnose_rig("rotary-drive", "joint", &records, ["j5a.csv", "j5b.csv"], &more);
    assert_eq!(named(&report), ["16"]);
    let [low, high] = sized(&report, "16");
    assert!(0.0 < low && low < 0.13 && 0.13 < high && high < 0.3, "{low} … {high}");
    let [_, low, high] = nominal(&report, "inertia");
    assert!(low < 4e-4 && 4e-4 < high, "{low} … {high}");
    assert!(notes(&report).contains("drives the model together with motion.position"), "{}", notes(&report));
}
