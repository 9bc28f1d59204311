use crate::{Reading, Record, parse};
use proptest::prelude::*;

const PLAIN: &[u8] = include_bytes!("../../../tests/data/plain.mf4");
const DEFLATE: &[u8] = include_bytes!("../../../tests/data/deflate.mf4");
const TRANSPOSED: &[u8] = include_bytes!("../../../tests/data/transposed.mf4");
const TWO_RATES: &[u8] = include_bytes!("../../../tests/data/two-rates.mf4");
const TABLE: &[u8] = include_bytes!("../../../tests/data/table-conversion.mf4");

fn read(bytes: &[u8]) -> Record {
    parse("run.mf4", bytes, &Reading::default()).unwrap()
}

fn error(bytes: &[u8]) -> String {
    parse("run.mf4", bytes, &Reading::default()).unwrap_err().to_string()
}

/// What make_fixtures.py has written.
fn force(i: usize) -> f64 {
    100.0 * (std::f64::consts::TAU * 0.01 * i as f64).sin()
}

fn count(i: usize) -> f64 {
    (i * 37 % 200) as f64 - 100.0
}

#[test]
fn what_asammdf_writes() {
    for bytes in [PLAIN, DEFLATE, TRANSPOSED] {
        let record = read(bytes);
        let titles: Vec<_> = record.channels.iter().map(|c| (c.name.as_str(), c.unit.as_str())).collect();
        let wanted = [
            ("force", "N"),
            ("single", "kN"),
            ("counts", "mm"),
            ("big", "V"),
            ("byte", ""),
            ("gaps", "N"),
            ("ratio", "A"),
        ];
        assert_eq!(titles, wanted);
        assert_eq!(record.time.len(), 50);
        let value = |channel: usize, i: usize| record.channels[channel].values[i];
        for i in 0..50 {
            assert!((record.time[i] - 0.01 * i as f64).abs() < 1e-12);
            assert!((value(0, i) - force(i)).abs() < 1e-12);
            assert!((value(1, i) - force(i)).abs() < 1e-5);
            assert_eq!(value(2, i), 0.5 * count(i) + 3.0);
            assert_eq!(value(3, i), count(i));
            assert_eq!(value(4, i), count(i).abs());
            assert_eq!(value(6, i), 0.25 * count(i) - 1.0);
            assert!(if i == 7 { value(5, i).is_nan() } else { (value(5, i) - force(i)).abs() < 1e-12 });
        }
    }
}

#[test]
fn slow_groups_come_onto_the_times_of_the_fastest() {
    let record = read(TWO_RATES);
    assert_eq!(record.time.len(), 50);
    let names: Vec<_> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["force", "ramp", "force#2"]);
    assert!((record.channels[1].values[25] - 2.5).abs() < 1e-12);
    assert!((record.channels[2].values[25] + 2.5).abs() < 1e-12);
}

#[test]
fn what_is_not_read_says_why() {
    let message = error(TABLE);
    assert!(message.contains("has no numeric channel with a master channel of time"), "{message}");
    assert!(message.contains("gear: conversions of type"), "{message}");
    let unfinished = [b"UnFinMF 4.10    ".as_slice(), &PLAIN[16..]].concat();
    assert!(error(&unfinished).contains("did not close it"));
    let old = [b"MDF     3.30    ".as_slice(), &PLAIN[16..]].concat();
    assert!(error(&old).contains("is MDF 3.30: convert it"));
    assert!(error(&PLAIN[..PLAIN.len() - 100]).contains("cut off"));
}

/// Appends a block and returns its place.
fn block(file: &mut Vec<u8>, kind: &str, links: &[usize], data: &[u8]) -> usize {
    file.resize(file.len().next_multiple_of(8), 0);
    let at = file.len();
    file.extend(kind.as_bytes());
    file.extend([0; 4]);
    file.extend((24 + 8 * links.len() + data.len()).to_le_bytes());
    file.extend(links.len().to_le_bytes());
    file.extend(links.iter().flat_map(|link| link.to_le_bytes()));
    file.extend(data);
    at
}

/// A `CN` block: type, sync type, data type, first bit, first byte, number of bits.
fn channel(file: &mut Vec<u8>, next: usize, name: &str, place: [u8; 6]) -> usize {
    let name = block(file, "##TX", &[], name.as_bytes());
    let [kind, sync, data, bit, byte, bits] = place;
    let mut fields = vec![kind, sync, data, bit, byte, 0, 0, 0, bits, 0, 0, 0];
    fields.resize(72, 0);
    block(file, "##CN", &[next, 0, name, 0, 0, 0, 0, 0], &fields)
}

fn channel_group(
    file: &mut Vec<u8>,
    next: usize,
    channels: usize,
    id: u64,
    cycles: u64,
    bytes: u32,
) -> usize {
    let mut fields = [id.to_le_bytes(), cycles.to_le_bytes(), [0; 8]].concat();
    fields.extend(bytes.to_le_bytes());
    fields.extend([0; 4]);
    block(file, "##CG", &[next, channels, 0, 0, 0, 0], &fields)
}

/// Two groups whose records alternate, in a list of blocks that cuts a record in two; 12-bit values.
fn unsorted() -> Vec<u8> {
    let mut file = b"MDF     4.10    ".to_vec();
    file.resize(64, 0);
    block(&mut file, "##HD", &[0; 6], &[0; 32]);
    let note = channel(&mut file, 0, "note", [0, 0, 6, 0, 8, 8]);
    let low = channel(&mut file, note, "low", [0, 0, 2, 0, 8, 12]);
    let high = channel(&mut file, low, "high", [0, 0, 0, 4, 9, 12]);
    let channels = channel(&mut file, high, "t", [2, 1, 4, 0, 0, 64]);
    let other_value = channel(&mut file, 0, "other", [0, 0, 5, 0, 8, 32]);
    let other_channels = channel(&mut file, other_value, "t", [2, 1, 4, 0, 0, 64]);
    let second = channel_group(&mut file, 0, other_channels, 9, 2, 12);
    let groups = channel_group(&mut file, second, channels, 4, 4, 11);
    let mut data = Vec::new();
    for i in 0..4_i32 {
        data.push(4);
        data.extend(f64::from(i).to_le_bytes());
        let packed = (i - 2) & 0xFFF | (100 + i) << 12;
        data.extend(&packed.to_le_bytes()[..3]);
        if i % 2 == 0 {
            data.push(9);
            data.extend(f64::from(i).to_le_bytes());
            data.extend((0.5 * i as f32).to_be_bytes());
        }
    }
    let parts = [&data[..30], &data[30..]].map(|part| block(&mut file, "##DT", &[], part));
    let list = block(&mut file, "##DL", &[0, parts[0], parts[1]], &[0; 16]);
    let head = block(&mut file, "##HL", &[list], &[0; 8]);
    let data_group = block(&mut file, "##DG", &[0, groups, head, 0], &[1, 0, 0, 0, 0, 0, 0, 0]);
    file[64 + 24..64 + 32].copy_from_slice(&data_group.to_le_bytes());
    file
}

#[test]
fn unsorted_records_in_a_list_of_blocks() {
    let record = read(&unsorted());
    assert_eq!(record.time, [0.0, 1.0, 2.0, 3.0]);
    let names: Vec<_> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["high", "low", "other"]);
    assert_eq!(record.channels[0].values, [100.0, 101.0, 102.0, 103.0]);
    assert_eq!(record.channels[1].values, [-2.0, -1.0, 0.0, 1.0]);
    assert_eq!(record.channels[2].values[..3], [0.0, 0.5, 1.0]);
    let unread: Vec<_> = record.unread.iter().map(|it| (it.name.as_str(), it.why.as_str())).collect();
    assert_eq!(unread, [("note", "text")]);
    // The slow group ends before the fast one.
    assert!(record.channels[2].values[3].is_nan());
}

#[test]
fn every_cut_is_refused_without_panic() {
    for bytes in [PLAIN, DEFLATE, TRANSPOSED, TWO_RATES, &unsorted()] {
        for length in 0..bytes.len() {
            let _ = parse("run.mf4", &bytes[..length], &Reading::default());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn damage_is_no_panic(
        which in 0_usize..5, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)
    ) {
        let unsorted = unsorted();
        let mut bytes = [PLAIN, DEFLATE, TRANSPOSED, TWO_RATES, &unsorted][which].to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(record) = parse("run.mf4", &bytes, &Reading::default()) {
            prop_assert!(record.channels.iter().all(|c| c.values.len() == record.time.len()));
        }
    }
}
