//! Every FMU, through FMPy: one test, one claim. What is checked stands in `masters/fmpy_checks.py` and, for FMI 3.0,
//! `masters/fmi3_checks.py`.

fn check(script: &str, name: &str) {
    let output = strut::python(script, [name.as_ref(), strut::fmus().as_os_str()]);
    print!("{output}");
    let fmus = strut::fmus().read_dir().expect("the folder exists");
    let fmus = fmus
        .filter(|entry| entry.as_ref().is_ok_and(|entry| entry.path().extension() == Some("fmu".as_ref())));
    // Ecos prints lines of its own.
    let checked = output.lines().filter(|line| line.starts_with(&format!("{name}: ")));
    assert_eq!(checked.count(), fmus.count(), "every FMU is to be checked");
}

macro_rules! checks {
    ($script:literal: $($name:ident)*) => {$(
        #[test]
        fn $name() {
            check($script, stringify!($name));
        }
    )*};
}

checks! {
    "tests/masters/fmpy_checks.py":
    validate starts rewind reset variable_step input_derivatives output_derivatives directional model_exchange threads
    bad_input no_resources
}

mod fmi3 {
    use super::check;

    checks! {
        "tests/masters/fmi3_checks.py":
        validate same_bits same_bits_in_model_exchange event_mode derivatives ecos fmutool
    }
}

#[test]
fn references() {
    print!("{}", strut::python("tests/masters/fmpy_references.py", [strut::fmus()]));
}

/// The references that the FMUs are measured against are what their script makes.
#[test]
fn references_can_be_made_again() {
    print!("{}", strut::python("tests/reference/make_references.py", ["--check"]));
}
