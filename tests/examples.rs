//! The examples do what they say, from Python, from Rust and for a model of one's own.

use std::ffi::OsStr;
use std::fs;

/// Runs a Python example; returns the numbers that it prints, and checks that it draws.
fn python_example(name: &str) -> Vec<f64> {
    let out = strut::target().join("tested-pictures");
    let script = format!("examples/{name}.py");
    let arguments = ["--fmus".as_ref(), strut::fmus().as_os_str(), "--out".as_ref(), out.as_os_str()];
    let text = strut::python(&script, arguments);
    let picture = fs::metadata(out.join(name).with_extension("png")).expect("it draws a picture");
    assert!(picture.len() > 10_000, "the picture is empty");
    numbers(&text)
}

/// The numbers of a text that have a decimal point.
fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().filter(|word| word.contains('.')).filter_map(|word| word.parse().ok()).collect()
}

/// Each of `some` is among `all`.
fn assert_contains(all: &[f64], some: &[f64]) {
    assert!(!some.is_empty(), "no numbers are printed");
    for number in some {
        assert!(all.contains(number), "{number} of {some:?} is not among {all:?}");
    }
}

#[test]
fn the_systems_from_python_and_from_rust_are_the_same() {
    let python = [python_example("quanser_lqr"), python_example("tum_active")].concat();
    let (native, headers) = strut::libclang();
    let mut master = strut::cargo();
    master.args(["run", "--quiet", "--release", "--package", "rust-master", "--"]);
    master.arg(strut::fmus()).arg(strut::target().join("tested-pictures"));
    master.env("LIBCLANG_PATH", native).env("BINDGEN_EXTRA_CLANG_ARGS", include(&headers));
    let rust = numbers(&String::from_utf8_lossy(&strut::run(&mut master).stdout));
    assert_contains(&python, &rust);
}

fn include(folder: &std::path::Path) -> std::ffi::OsString {
    [OsStr::new("-I"), folder.as_os_str()].into_iter().collect()
}

#[test]
fn a_model_of_ones_own_becomes_an_fmu_by_one_command() {
    let source = fs::read_to_string(strut::root().join("examples/own-model/src/lib.rs")).expect("it exists");
    assert!(source.lines().count() <= 40, "README says that 40 lines are enough");
    let out = strut::target().join("tested-own-model");
    let manifest = strut::root().join("examples/own-model/Cargo.toml");
    strut::run(strut::build_fmu().arg("--manifest-path").arg(manifest).arg("--out").arg(&out));
    for check in ["validate", "starts", "rewind", "directional", "model_exchange"] {
        let output = strut::python("tests/masters/fmpy_checks.py", [check.as_ref(), out.as_os_str()]);
        assert_eq!(output.trim(), format!("{check}: AirSpring"));
    }
}
