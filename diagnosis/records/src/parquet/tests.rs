use crate::{Reading, parse};
use proptest::prelude::*;

const PANDAS: &[u8] = include_bytes!("../../../tests/data/pandas.parquet");
const POLARS: &[u8] = include_bytes!("../../../tests/data/polars.parquet");

fn force(k: usize) -> f64 {
    100.0 * (std::f64::consts::TAU * 0.01 * k as f64).sin()
}

#[test]
fn what_pandas_writes() {
    let record = parse("run.parquet", PANDAS, &Reading::default()).unwrap();
    assert_eq!(
        record.channels.iter().map(crate::Channel::title).collect::<Vec<_>>(),
        ["force [N]", "counts"]
    );
    assert_eq!(record.unread[0].why, "row 1 holds no number");
    for k in 0..50 {
        assert_eq!(record.channels[1].values[k], (k * 37 % 200) as f64 - 100.0);
        assert!((record.time[k] - 0.01 * k as f64).abs() < 1e-12);
        assert!((record.channels[0].values[k] - force(k)).abs() < 1e-12);
    }
}

#[test]
fn what_polars_writes_with_instants_and_a_gap() {
    let record = parse("run.parquet", POLARS, &Reading::default()).unwrap();
    assert!(record.channels[0].values[7].is_nan());
    for k in (0..50).filter(|k| *k != 7) {
        assert!((record.time[k] - 0.01 * k as f64).abs() < 1e-6);
        assert!((record.channels[0].values[k] - force(k)).abs() < 1e-5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn damaged_files_are_refused_without_panic(at in 4..PANDAS.len() - 4, byte in any::<u8>()) {
        let mut bytes = PANDAS.to_vec();
        bytes[at] = byte;
        let _ = parse("run.parquet", &bytes, &Reading::default());
    }
}
