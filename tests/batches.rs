//! Sweeps and batches of diagnoses on a Dask cluster of this machine. What is checked stands in
//! `masters/beyond_one_machine.py`.

use std::ffi::OsStr;
use std::fs;
use std::path::PathBuf;

const RIG: &str = "tum-linear-measured-quarter-car";

/// An empty folder of a test.
fn folder(name: &str) -> PathBuf {
    let folder = strut::target().join("tested-batches").join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("the target folder is ours");
    }
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

#[test]
fn a_sweep_loses_nothing_when_a_worker_dies() {
    let (out, program) = (folder("sweep"), strut::program("sweep"));
    let arguments: [&OsStr; 4] = ["sweep".as_ref(), strut::fmus().as_ref(), program.as_ref(), out.as_ref()];
    print!("{}", strut::python("tests/masters/beyond_one_machine.py", arguments));
}

#[test]
fn a_batch_of_diagnoses_tells_of_every_record() {
    let (out, records) = (folder("diagnoses"), folder("records"));
    let diagnose = strut::program("diagnose");
    let mut simulate = std::process::Command::new(&diagnose);
    simulate
        .args(["simulate", "--duration", "10", "--hide", "strut.coulomb.force=60", "--out"])
        .arg(records.join("friction"));
    strut::run(&mut simulate);
    // A record that cannot be read is a row, too.
    fs::create_dir(records.join("broken")).expect("the target folder can be written");
    for name in ["train.csv", "test.csv"] {
        fs::write(records.join("broken").join(name), "this is no record\n").expect("it can be written");
    }
    let arguments: [&OsStr; 5] =
        ["diagnoses".as_ref(), diagnose.as_ref(), records.as_ref(), out.as_ref(), RIG.as_ref()];
    print!("{}", strut::python("tests/masters/beyond_one_machine.py", arguments));
}
