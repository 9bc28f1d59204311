//! The fuzzer finds nothing in our libraries, and what is wrong in broken ones.

mod common;

use std::process::Command;

use common::package;
use strut_fmi::fmi2::types::*;
use strut_hardening::api::{Api, load};
use strut_hardening::generate::episode;
use strut_hardening::package::Package;
use strut_hardening::player::Player;

/// A short run; README tells of the long one. After a crash the sequence that leads to it is looked for.
#[test]
fn calls_at_random_do_no_harm() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["QuarterCar", "QuanserLqrController", "RecordedRoad", "TumSensorChain", "SasRig"] {
        let fmu = strut::fmus().join(name).with_extension("fmu");
        let journal = folder.path().join(name);
        let mut run = Command::new(env!("CARGO_BIN_EXE_fuzz"));
        run.arg("run").arg(&fmu).args(["--calls", "50000", "--threads", "2", "--journal"]).arg(&journal);
        let output = run.output().expect("it starts");
        let told = String::from_utf8_lossy(&output.stderr);
        if output.status.code().is_none() {
            let number = std::fs::read_to_string(&journal).expect("it is written");
            let mut shrink = Command::new(env!("CARGO_BIN_EXE_fuzz"));
            let shrunk = shrink.arg("shrink").arg(&fmu).args(["--episode", number.trim()]).output();
            let shrunk = shrunk.expect("it starts").stderr;
            panic!("{name}: {}\n{}", output.status, String::from_utf8_lossy(&shrunk));
        }
        assert!(output.status.success(), "{told}");
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
}

/// Whether some episodes go wrong.
fn is_caught(api: Api, package: &Package) -> bool {
    (0..40).any(|number| Player::new(api, package).play(&episode(package, 1, number)).is_err())
}

unsafe extern "C" fn does_nothing(_: Component) -> Status {
    Status::Ok
}

unsafe extern "C" fn restores_nothing(_: Component, _: FmuState) -> Status {
    Status::Ok
}

unsafe extern "C" fn stands_still(_: Component, _: Real, _: Real, _: Boolean) -> Status {
    Status::Ok
}

unsafe extern "C" fn sets_nothing(_: Component, _: *const ValueReference, _: Size, _: *const Real) -> Status {
    Status::Ok
}

#[test]
fn a_library_that_does_not_do_what_it_says_is_caught() {
    let package = package("QuarterCar");
    let library = load(&package.library()).expect("it loads");
    let api = Api::of(&library).expect("it is complete");
    assert!(!is_caught(api, &package));
    type Harm = (&'static str, fn(&mut Api));
    let broken: [Harm; 6] = [
        ("reset", |api| api.reset = does_nothing),
        ("terminate", |api| api.terminate = does_nothing),
        ("cancel", |api| api.cancel_step = does_nothing),
        ("restore", |api| api.set_fmu_state = restores_nothing),
        ("step", |api| api.do_step = stands_still),
        ("set", |api| api.set_real = sets_nothing),
    ];
    for (name, harm) in broken {
        let mut harmed = api;
        harm(&mut harmed);
        assert!(is_caught(harmed, &package), "{name} is broken, and nobody minds");
    }
}
