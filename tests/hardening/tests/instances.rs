//! Many instances in many threads, and libraries that come and go.

#![cfg(target_os = "linux")]

mod common;

use std::sync::Mutex;
use std::thread;

use common::{Slave, package};
use strut_hardening::api::{Api, load};

const STEP: f64 = 1e-3;
const STEPS: u32 = 20;

/// Bits of everything that an instance tells after its steps; each has inputs of its own.
fn trajectory(slave: &mut Slave, package: &strut_hardening::package::Package, number: usize) -> Vec<u64> {
    let mut bits = Vec::new();
    for step in 0..STEPS {
        let input = 1e-3 * number as f64 * f64::from(step % 7);
        bits = slave.step(package, f64::from(step) * STEP, STEP, input);
    }
    bits
}

/// 1 000 instances, which 16 threads take as they come, each for a few steps at a time.
#[test]
fn a_thousand_instances_in_sixteen_threads_go_where_they_go_alone() {
    const INSTANCES: usize = 1_000;
    for name in ["QuarterCar", "TumSensorChain"] {
        let package = package(name);
        let library = load(&package.library()).expect("it loads");
        let api = Api::of(&library, package.version).expect("it is complete");
        let mut slaves: Vec<Slave> = (0..INSTANCES).map(|_| Slave::new(api, &package)).collect();
        let expected: Vec<_> = {
            let mut alone: Vec<Slave> = (0..INSTANCES).map(|_| Slave::new(api, &package)).collect();
            alone.iter_mut().enumerate().map(|(n, slave)| trajectory(slave, &package, n)).collect()
        };
        let found = Mutex::new(vec![Vec::new(); INSTANCES]);
        let waiting = Mutex::new(slaves.drain(..).enumerate().collect::<Vec<_>>());
        thread::scope(|scope| {
            for _ in 0..16 {
                scope.spawn(|| {
                    while let Some((number, mut slave)) = { waiting.lock().expect("no panic").pop() } {
                        let bits = trajectory(&mut slave, &package, number);
                        found.lock().expect("no panic")[number] = bits;
                    }
                });
            }
        });
        assert!(found.into_inner().expect("no panic") == expected, "{name}: threads change the results");
        assert!(expected.iter().any(|bits| bits != &expected[0]), "the instances have different inputs");
    }
}

/// Resident memory of this process in bytes.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/statm").expect("Linux has it");
    let pages: u64 = status.split(' ').nth(1).and_then(|pages| pages.parse().ok()).expect("a number");
    pages * 4096
}

fn is_loaded(path: &std::path::Path) -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("Linux has it");
    maps.contains(path.to_str().expect("a text"))
}

/// A library that was closed is gone, and what it had taken with it. In a process of its own, for other
/// tests take memory, too.
#[test]
fn libraries_come_and_go() {
    if std::env::var_os(ALONE).is_none() {
        return alone("libraries_come_and_go");
    }
    let package = package("QuarterCar");
    let path = package.library();
    let load_and_step = || {
        let library = load(&path).expect("it loads");
        let api = Api::of(&library, package.version).expect("it is complete");
        let bits = Slave::new(api, &package).step(&package, 0.0, STEP, 0.01);
        assert!(is_loaded(&path));
        drop(library);
        bits
    };
    let first = load_and_step();
    assert!(!is_loaded(&path), "the library stays although it was closed");
    (0..100).for_each(|_| assert_eq!(load_and_step(), first));
    let before = resident();
    (0..900).for_each(|_| assert_eq!(load_and_step(), first));
    let grown = resident().saturating_sub(before);
    println!("grown by {grown} bytes in 900 loads, each with an instance");
    // One leaked block a load would be 16 bytes at least, which is four pages; the allocator itself goes up
    // and down by some.
    assert!(grown < 256 * 1024, "{grown} bytes more");
}

#[test]
fn instances_come_and_go() {
    if std::env::var_os(ALONE).is_none() {
        return alone("instances_come_and_go");
    }
    let package = package("QuanserLqrController");
    let library = load(&package.library()).expect("it loads");
    let api = Api::of(&library, package.version).expect("it is complete");
    let live = || drop(Slave::new(api, &package).step(&package, 0.0, STEP, 0.01));
    (0..500).for_each(|_| live());
    let before = resident();
    (0..5_000).for_each(|_| live());
    let grown = resident().saturating_sub(before);
    println!("grown by {grown} bytes in 5 000 instances");
    // 16 bytes an instance, the least that can be leaked, would be 80 kB.
    assert!(grown < 64 * 1024, "{grown} bytes more");
}

const ALONE: &str = "STRUT_TEST_ALONE";

/// Runs a test of this program in a process of its own.
fn alone(name: &str) {
    strut::fmus();
    let program = std::env::current_exe().expect("it runs");
    let mut command = std::process::Command::new(program);
    let output = strut::run(command.args([name, "--exact", "--nocapture"]).env(ALONE, "1"));
    print!("{}", String::from_utf8_lossy(&output.stdout));
}
