use crate::{Reading, Record, parse};
use proptest::prelude::*;

const EXCEL: &[u8] = include_bytes!("../../../tests/data/book.xlsx");
const OPEN: &[u8] = include_bytes!("../../../tests/data/sheet.ods");

fn read(bytes: &[u8], sheet: Option<&str>) -> Record {
    let reading = Reading { sheet: sheet.map(str::to_owned), ..Reading::default() };
    parse("run.xlsx", bytes, &reading).unwrap()
}

fn verify(record: &Record) {
    assert_eq!(record.time.len(), 50);
    for k in 0..50 {
        let force = 100.0 * (std::f64::consts::TAU * 0.01 * k as f64).sin();
        assert!((record.time[k] - 0.01 * k as f64).abs() < 3e-6, "{} {k}", record.time[k]);
        assert!((record.channels[0].values[k] - force).abs() < 1e-9);
    }
}

#[test]
fn the_first_sheet_with_a_table_below_what_a_logger_writes() {
    let record = read(EXCEL, None);
    verify(&record);
    assert_eq!(
        record.channels.iter().map(crate::Channel::title).collect::<Vec<_>>(),
        ["Force [lbf]", "Counts [mm]"]
    );
    assert_eq!(record.unread[0].why, "`start` in line 5 is not a number");
    assert!(
        record.notes[0].starts_with("the sheet Data was read, and not Info, Dates"),
        "{:?}",
        record.notes
    );
}

#[test]
fn dates_are_times_and_a_sheet_may_be_named() {
    verify(&read(EXCEL, Some("Dates")));
    let reading = Reading { sheet: Some("data".into()), ..Reading::default() };
    let message = parse("run.xlsx", EXCEL, &reading).unwrap_err().to_string();
    assert_eq!(message, "run.xlsx: has no sheet `data`: there are Info, Data, Dates");
}

#[test]
fn what_libre_office_writes() {
    verify(&read(OPEN, None));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn damaged_files_are_refused_without_panic(at in 4..EXCEL.len(), byte in any::<u8>()) {
        let mut bytes = EXCEL.to_vec();
        bytes[at] = byte;
        let _ = parse("run.xlsx", &bytes, &Reading::default());
    }
}
