//! The fuzzer finds nothing in our libraries, and what is wrong in broken ones.

mod common;

use std::process::Command;

use common::{package, package_of_fmi_3};
use strut_fmi::fmi2::types::*;
use strut_hardening::api::{Api, Own, load};
use strut_hardening::generate::episode;
use strut_hardening::package::Package;
use strut_hardening::player::Player;

/// A short run; README tells of the long one. After a crash the sequence that leads to it is looked for.
#[test]
fn calls_at_random_do_no_harm() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["QuarterCar", "QuanserLqrController", "RecordedRoad", "TumSensorChain", "SasRig"];
    let three = ["QuarterCar", "QuanserLqrController", "RecordedRoad", "KogutMrRotaryBrake"];
    for name in names.map(str::to_owned).into_iter().chain(three.map(|name| format!("fmi3/{name}"))) {
        let fmu = strut::fmus().join(&name).with_extension("fmu");
        let journal = folder.path().join("journal");
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

unsafe extern "C" fn arrives_and_stands_still(
    _: Component,
    point: Real,
    size: Real,
    _: u8,
    event: *mut u8,
    end: *mut u8,
    early: *mut u8,
    reached: *mut Real,
) -> Status {
    // SAFETY: the player gives four places.
    unsafe {
        (*event, *end, *early, *reached) = (0, 0, 0, point + size);
    }
    Status::Ok
}

unsafe extern "C" fn sets_nothing_of_fmi_3(
    _: Component,
    _: *const ValueReference,
    _: Size,
    _: *const Real,
    _: Size,
) -> Status {
    Status::Ok
}

type Harm = (&'static str, fn(&mut Api));

/// Changes what only one version has.
fn harm(api: &mut Api, two: fn(&mut strut_hardening::api::Two), three: fn(&mut strut_hardening::api::Three)) {
    match &mut api.own {
        Own::Two(own) => two(own),
        Own::Three(own) => three(own),
    }
}

#[test]
fn a_library_that_does_not_do_what_it_says_is_caught() {
    let broken: [Harm; 6] = [
        ("reset", |api| api.common.reset = does_nothing),
        ("terminate", |api| api.common.terminate = does_nothing),
        ("restore", |api| api.common.set_fmu_state = restores_nothing),
        ("what is never legal", |api| {
            harm(
                api,
                |two| two.cancel_step = does_nothing,
                |three| three.evaluate_discrete_states = does_nothing,
            );
        }),
        ("step", |api| {
            harm(api, |two| two.do_step = stands_still, |three| three.do_step = arrives_and_stands_still);
        }),
        ("set", |api| {
            harm(api, |two| two.set_real = sets_nothing, |three| three.set_float64 = sets_nothing_of_fmi_3);
        }),
    ];
    for package in [package("QuarterCar"), package_of_fmi_3("QuarterCar")] {
        let library = load(&package.library()).expect("it loads");
        let api = Api::of(&library, package.version).expect("it is complete");
        assert!(!is_caught(api, &package));
        for (name, harm) in broken {
            let mut harmed = api;
            harm(&mut harmed);
            let version = package.version;
            assert!(is_caught(harmed, &package), "{name} is broken in {version:?}, and nobody minds");
        }
    }
}
