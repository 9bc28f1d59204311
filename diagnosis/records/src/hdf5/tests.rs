use crate::{Reading, parse};
use proptest::prelude::*;

const MATLAB: &[u8] = include_bytes!("../../../tests/data/hdf5.mat");
const GROUPS: &[u8] = include_bytes!("../../../tests/data/groups.h5");

#[test]
fn what_hdf5storage_and_h5py_write() {
    let columns = ["matrix column 1", "matrix column 2", "matrix column 3"];
    let of_matlab = ["counts", "force"].to_vec();
    let of_groups = [&["counts [mm]", "force [kN]"][..], &columns].concat();
    for (bytes, titles) in [(MATLAB, of_matlab), (GROUPS, of_groups)] {
        let record = parse("run", bytes, &Reading::default()).unwrap();
        assert_eq!(record.channels.iter().map(crate::Channel::title).collect::<Vec<_>>(), titles);
        assert_eq!(record.time.len(), 50);
        for k in 0..50 {
            let force = 100.0 * (std::f64::consts::TAU * 0.01 * k as f64).sin();
            assert!((record.time[k] - 0.01 * k as f64).abs() < 1e-12);
            assert!((record.channels[1].values[k] - force).abs() < 1e-5);
            assert_eq!(record.channels[0].values[k], (k * 37 % 200) as f64 - 100.0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn damaged_files_are_refused_without_panic(at in 0..GROUPS.len(), byte in any::<u8>(), cut in 0..GROUPS.len()) {
        let mut bytes = GROUPS.to_vec();
        bytes[at] = byte;
        let _ = parse("run.h5", &bytes, &Reading::default());
        bytes.truncate(cut);
        let _ = parse("run.h5", &bytes, &Reading::default());
    }
}
