use crate::{Reading, Record, TimeColumn, parse};
use proptest::prelude::*;

const VECTORS: &[u8] = include_bytes!("../../../tests/data/vectors.mat");
const COMPRESSED: &[u8] = include_bytes!("../../../tests/data/compressed.mat");
const VERSION_4: &[u8] = include_bytes!("../../../tests/data/version4.mat");
const STRUCT: &[u8] = include_bytes!("../../../tests/data/struct.mat");

fn read(bytes: &[u8]) -> Record {
    parse("run.mat", bytes, &Reading::default()).unwrap()
}

/// What make_fixtures.py has written.
fn verify(record: &Record, names: &[&str]) {
    let found: Vec<_> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(found, names);
    assert_eq!(record.time.len(), 50);
    for i in 0..50 {
        let force = 100.0 * (std::f64::consts::TAU * 0.01 * i as f64).sin();
        assert!((record.time[i] - 0.01 * i as f64).abs() < 1e-12);
        assert!((record.channels[0].values[i] - force).abs() < 1e-12);
        assert_eq!(record.channels[1].values[i], (i * 37 % 200) as f64 - 100.0);
        if names.len() > 2 {
            assert!((record.channels[2].values[i] - force).abs() < 1e-5);
        }
    }
}

#[test]
fn what_scipy_writes() {
    verify(&read(VECTORS), &["force", "counts", "single"]);
    verify(&read(COMPRESSED), &["force", "counts", "single"]);
    verify(&read(STRUCT), &["force", "counts"]);
    verify(&read(VERSION_4), &["force", "counts", "single"]);
}

/// A real-time target of another byte order, with a complex matrix and a text between the signals.
#[test]
fn version_4_in_the_other_byte_order() {
    let matrix = |form: i32, name: &str, complex: i32, values: &[u8], columns: i32| {
        let header = [form, 1, columns, complex, name.len() as i32 + 1].map(i32::to_be_bytes).concat();
        [header, name.as_bytes().to_vec(), vec![0], values.to_vec()].concat()
    };
    let doubles = |values: [f64; 3]| values.map(f64::to_be_bytes).concat();
    let counts = [-300_i16, 7, 5].map(i16::to_be_bytes).concat();
    let file = [
        matrix(1000, "t", 0, &doubles([0.0, 1.0, 2.0]), 3),
        matrix(1000, "z", 1, &[doubles([1.0; 3]), doubles([2.0; 3])].concat(), 3),
        matrix(1051, "note", 0, b"rig", 3),
        matrix(1030, "x", 0, &counts, 3),
    ]
    .concat();
    let record = read(&file);
    assert_eq!(record.channels.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["x"]);
    assert_eq!(record.channels[0].values, [-300.0, 7.0, 5.0]);
    let left_out: Vec<&str> = record.unread.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(left_out, ["z", "note"]);
    let error = parse("run.mat", &file[..file.len() - 3], &Reading::default()).unwrap_err().to_string();
    assert!(error.contains("is cut off or damaged"), "{error}");
}

#[test]
fn the_map_names_the_time() {
    let time = TimeColumn { column: "force".into(), unit: Some("ms".into()) };
    let record = parse("run.mat", VECTORS, &Reading { time: Some(time), ..Reading::default() }).unwrap();
    assert!((record.time[25] - 0.1).abs() < 1e-12);
    assert_eq!(record.channels[0].name, "t");
}

/// An element with big-endian tag, padded.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_be_bytes(), (data.len() as u32).to_be_bytes()].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

#[test]
fn big_endian_and_compactly_stored_doubles() {
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend(b"\x01\x00MI");
    for (name, values) in [("t", [0_i16, 1, 2]), ("x", [-300, 7, 5])] {
        let matrix = [
            element(6, &[0, 0, 0, 6, 0, 0, 0, 0]),
            element(5, &[0, 0, 0, 3, 0, 0, 0, 1]),
            [&[0, 1, 0, 1], name.as_bytes(), &[0, 0, 0]].concat(),
            element(3, &values.map(i16::to_be_bytes).concat()),
        ];
        file.extend(element(14, &matrix.concat()));
    }
    let record = read(&file);
    assert_eq!(record.time, [0.0, 1.0, 2.0]);
    assert_eq!(record.channels[0].values, [-300.0, 7.0, 5.0]);
    assert!(record.unread.is_empty());
}

/// An array of a class, big-endian; without sizes where there are none, as in MATLAB's objects.
fn array(class: u8, sizes: &[u32], name: &str, data: &[u8]) -> Vec<u8> {
    let sizes: Vec<u8> = sizes.iter().flat_map(|it| it.to_be_bytes()).collect();
    let sizes = if sizes.is_empty() { Vec::new() } else { element(5, &sizes) };
    let flags = element(6, &[0, 0, 0, class, 0, 0, 0, 0]);
    element(14, &[flags, sizes, element(1, name.as_bytes()), data.to_vec()].concat())
}

#[test]
fn what_is_no_signal_is_listed() {
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend(b"\x01\x00MI");
    let doubles =
        |count: usize| element(9, &(0..count).flat_map(|k| (k as f64).to_be_bytes()).collect::<Vec<_>>());
    let of_objects = [element(1, b"MCOS"), element(1, b"table")].concat();
    for bytes in [
        array(6, &[3, 1], "t", &doubles(3)),
        array(6, &[3, 1], "x", &doubles(3)),
        array(6, &[1, 1], "mass", &doubles(1)),
        array(6, &[1, 2], "limits", &doubles(2)),
        array(6, &[2, 2, 2], "cube", &doubles(8)),
        array(4, &[1, 2], "note", &element(16, b"hi")),
        array(1, &[1, 2], "runs", &[]),
        array(2, &[1, 2], "tests", &[]),
        array(17, &[], "log", &of_objects),
        array(13, &[1, 3], "", &element(2, &[1, 2, 3])),
    ] {
        file.extend(bytes);
    }
    let record = read(&file);
    assert_eq!(record.channels.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["x"]);
    let unread: Vec<String> = record.unread.iter().map(|it| format!("{}: {}", it.name, it.why)).collect();
    let wanted = [
        "cube: an array of 3 dimensions",
        "note: text",
        "runs: a cell array: save its vectors by themselves",
        "tests: an array of 2 structs",
        "log: an object, such as a table or timetable: save its columns as vectors",
        "limits: 2 values where the others have 3",
    ];
    assert_eq!(unread, wanted);
}

#[test]
fn every_cut_is_refused_without_panic() {
    for bytes in [VECTORS, COMPRESSED, STRUCT] {
        for length in 0..bytes.len() {
            let _ = parse("run.mat", &bytes[..length], &Reading::default());
        }
    }
    let message = parse("run.mat", &VECTORS[..128], &Reading::default()).unwrap_err().to_string();
    assert!(message.contains("has no real numeric vectors"), "{message}");
    let message = parse("run.mat", &VECTORS[..300], &Reading::default()).unwrap_err().to_string();
    assert!(message.contains("is cut off or damaged"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn damage_is_no_panic(
        which in 0_usize..4, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)
    ) {
        let mut bytes = [VECTORS, COMPRESSED, STRUCT, VERSION_4][which].to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(record) = parse("run.mat", &bytes, &Reading::default()) {
            prop_assert!(record.channels.iter().all(|c| c.values.len() == record.time.len()));
        }
    }

    /// Damage inside of compressed data is found by its checksum: here the plain contents are damaged.
    #[test]
    fn damaged_structs_are_no_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)
    ) {
        let mut plain = Vec::new();
        std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(&STRUCT[136..]), &mut plain).unwrap();
        for (at, byte) in changes {
            let at = at.index(plain.len());
            plain[at] = byte;
        }
        let _ = parse("run.mat", &[&STRUCT[..128], &plain].concat(), &Reading::default());
    }
}
