//! Every FMU and every system in every master: the table in `tests/masters/README.md`.

use std::path::PathBuf;
use std::process::Command;

/// The matrix, in the masters that the tests' Python brings and in those that are named.
fn matrix(more: &[PathBuf]) -> String {
    let omsimulator = option("--omsimulator", strut::omsimulator());
    let pyfmi = option("--pyfmi", strut::pyfmi());
    let fmusim = option("--fmusim", strut::fmusim());
    strut::python(
        "tests/masters/matrix.py",
        [&[strut::fmus().into()], &omsimulator[..], &pyfmi, &fmusim, more].concat(),
    )
}

/// Model exchange, in the importers that the tests' Python brings and in PyFMI where it is named.
fn model_exchange(more: &[PathBuf]) -> String {
    let pyfmi = option("--pyfmi", strut::pyfmi());
    strut::python("tests/masters/model_exchange.py", [&[strut::fmus().into()], &pyfmi[..], more].concat())
}

/// An option with its value, if there is one.
fn option(name: &str, value: Option<PathBuf>) -> Vec<PathBuf> {
    value.map_or_else(Vec::new, |it| vec![name.into(), it])
}

/// Every FMU in FMPy, libcosimpy and ecos, and some of each kind in others, too.
#[test]
fn every_fmu_does_the_same_in_three_masters() {
    print!("{}", matrix(&["--short".into()]));
}

#[test]
fn casadis_jacobians_are_those_of_differences() {
    print!("{}", strut::python("tests/masters/casadi_jacobians.py", [strut::fmus()]));
    print!("{}", strut::python("tests/masters/casadi_jacobians.py", [strut::fmus().join("fmi3")]));
}

#[test]
fn pyfmi_reads_start_values_before_initialization_and_exact_derivatives() {
    if let Some(python) = strut::pyfmi() {
        let checks = strut::root().join("tests/masters/pyfmi_checks.py");
        let output = strut::run(Command::new(python).arg(checks).arg(strut::fmus()));
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
}

#[test]
fn some_of_each_kind_do_in_model_exchange_what_they_do_in_co_simulation() {
    print!("{}", model_exchange(&["--short".into()]));
}

#[test]
#[ignore = "takes minutes; writes tests/masters/model-exchange.md: `scripts/long-tests model-exchange`"]
fn every_fmu_in_model_exchange_does_what_it_does_in_co_simulation() {
    let page = strut::root().join("tests/masters/model-exchange.md");
    print!("{}", model_exchange(&["--page".into(), page]));
}

/// fmi-sim, installed from crates.io at first use.
fn fmi_sim() -> PathBuf {
    let folder = strut::target().join("fmi-sim");
    let mut install = strut::cargo_with_libclang();
    install.args(["install", "--quiet", "--version", "0.7.0", "--root"]).arg(&folder).arg("fmi-sim");
    install.env("CARGO_TARGET_DIR", folder.join("target"));
    strut::run(&mut install);
    folder.join("bin/fmi-sim").with_extension(std::env::consts::EXE_EXTENSION)
}

#[test]
#[ignore = "builds fmi-sim and the fmi crate for minutes; writes tests/masters/README.md: `scripts/long-tests masters`"]
fn every_fmu_and_system_does_the_same_in_every_master() {
    // Where some are named, there is no page, and nothing is built for the others.
    let named = std::env::var("STRUT_MASTERS").ok();
    let wanted = |master: &str| named.as_ref().is_none_or(|it| it.split(',').any(|one| one == master));
    let mut more = Vec::new();
    if wanted("cofmupy") {
        more.extend(["--cofmupy".into(), strut::cofmupy()]);
    }
    if wanted("fmi-sim") {
        more.extend(["--fmi-sim".into(), fmi_sim()]);
    }
    if wanted("fmi (crate)") {
        more.extend(["--fmi-crate".into(), strut::program_with_fmi("job")]);
    }
    match &named {
        Some(masters) => more.extend(["--masters".into(), masters.into()]),
        None => more.extend(["--page".into(), strut::root().join("tests/masters/README.md")]),
    }
    print!("{}", matrix(&more));
}
