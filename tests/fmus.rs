//! Every FMU, through FMPy: one test, one claim. What is checked stands in `masters/fmpy_checks.py`.

fn check(name: &str) {
    let output = strut::python("tests/masters/fmpy_checks.py", [name.as_ref(), strut::fmus().as_os_str()]);
    print!("{output}");
    let fmus = strut::fmus().read_dir().expect("the folder exists");
    let fmus = fmus
        .filter(|entry| entry.as_ref().is_ok_and(|entry| entry.path().extension() == Some("fmu".as_ref())));
    assert_eq!(output.lines().count(), fmus.count(), "every FMU is to be checked");
}

macro_rules! checks {
    ($($name:ident)*) => {$(
        #[test]
        fn $name() {
            check(stringify!($name));
        }
    )*};
}

checks! {
    validate starts rewind reset variable_step input_derivatives output_derivatives directional model_exchange threads
    bad_input no_resources
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
