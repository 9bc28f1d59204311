//! The systems in masters that others have written, against the monolithic references.

use std::path::Path;

fn connected(master: &str, system: &str) {
    let arguments = [Path::new(master), Path::new(system), strut::fmus()];
    print!("{}", strut::python("tests/masters/connected.py", arguments));
}

macro_rules! connected {
    ($($name:ident: $master:literal $system:literal;)*) => {$(
        #[test]
        fn $name() {
            connected($master, $system);
        }
    )*};
}

connected! {
    quanser_lqr_in_fmpy: "fmpy" "quanser-lqr";
    quanser_lqr_in_libcosimpy: "libcosimpy" "quanser-lqr";
    quanser_lqr_in_ecos: "ecos" "quanser-lqr";
    tum_active_in_fmpy: "fmpy" "tum-active";
    tum_active_in_libcosimpy: "libcosimpy" "tum-active";
    tum_active_in_ecos: "ecos" "tum-active";
    ajala_two_dof_in_fmpy: "fmpy" "ajala-two-dof";
    ajala_two_dof_in_libcosimpy: "libcosimpy" "ajala-two-dof";
    ajala_two_dof_in_ecos: "ecos" "ajala-two-dof";
    konieczny_open_loop_in_fmpy: "fmpy" "konieczny-open-loop";
    konieczny_open_loop_in_libcosimpy: "libcosimpy" "konieczny-open-loop";
    konieczny_open_loop_in_ecos: "ecos" "konieczny-open-loop";
    sas_in_libcosimpy: "libcosimpy" "sas";
    sas_in_ecos: "ecos" "sas";
}

/// Those that have no reference as a whole.
fn others(master: &str) {
    let arguments = [Path::new(master), strut::fmus()];
    print!("{}", strut::python("tests/masters/connected_all.py", arguments));
}

#[test]
fn all_others_in_fmpy() {
    others("fmpy");
}

#[test]
fn all_others_in_libcosimpy() {
    others("libcosimpy");
}

#[test]
fn all_others_in_ecos() {
    others("ecos");
}

#[test]
fn parameter_sets_of_a_system_take_effect() {
    print!("{}", strut::python("tests/masters/connected_parameters.py", [strut::fmus()]));
}

#[test]
fn factors_of_connections_are_honoured_as_the_examples_tell() {
    print!("{}", strut::python("tests/masters/connected_gains.py", [strut::fmus()]));
}

#[test]
#[ignore = "takes a minute: `scripts/long-tests examples`"]
fn the_coupling_error_falls_with_the_step() {
    print!("{}", strut::python("tests/masters/connected_convergence.py", [strut::fmus()]));
}

#[test]
fn the_semi_active_rig_shows_what_its_source_found() {
    print!("{}", strut::python("tests/masters/connected_semi_active.py", [strut::fmus()]));
}

#[test]
fn apart_an_actuator_that_knows_its_load_does_as_in_one() {
    print!("{}", strut::python("tests/masters/connected_apart.py", [strut::fmus()]));
}
