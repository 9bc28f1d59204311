use crate::csv::{title, write};
use crate::{Channel, Reading, Record, TimeColumn, parse};
use proptest::prelude::*;

fn read(text: &str) -> Record {
    parse("run.csv", text.as_bytes(), &Reading::default()).unwrap()
}

fn error(text: &str) -> String {
    parse("run.csv", text.as_bytes(), &Reading::default()).unwrap_err().to_string()
}

#[test]
fn an_index_is_part_of_a_name_and_a_number_behind_a_blank_is_a_unit() {
    let titles =
        ["outputs[1] [rad/s]", "outputs[1]", "slip [1]", "z[1,2](mm)", "force (N/(m))", "x[m]"].map(title);
    let expected = [
        ("outputs[1]", "rad/s"),
        ("outputs[1]", ""),
        ("slip", "1"),
        ("z[1,2]", "mm"),
        ("force", "N/(m)"),
        ("x", "m"),
    ];
    assert_eq!(titles, expected);
}

#[test]
fn names_units_and_values() {
    let record = read("time [ms],deflection [mm],u (V),plain\n0,1,2,3\n1,-4,5e-1,6\n");
    assert_eq!(record.name, "run.csv");
    assert_eq!(record.time, [0.0, 0.001]);
    let titles: Vec<_> = record.channels.iter().map(|c| (c.name.as_str(), c.unit.as_str())).collect();
    assert_eq!(titles, [("deflection", "mm"), ("u", "V"), ("plain", "")]);
    assert_eq!(record.channels[1].values, [2.0, 0.5]);
}

#[test]
fn german_export_with_mark_comments_and_units_row() {
    let text =
        "\u{FEFF}# rig 3\r\nZeit;Kraft;Weg;\r\ns;N;mm;\r\n0,000;1,5;-2;\r\n# pause\r\n0,001;1,25e1;;\r\n";
    let record = read(text);
    assert_eq!(record.time, [0.0, 0.001]);
    assert_eq!(record.channels[0].unit, "N");
    assert_eq!(record.channels[0].values, [1.5, 12.5]);
    assert_eq!(record.channels[1].values[0], -2.0);
    assert!(record.channels[1].values[1].is_nan());
}

#[test]
fn tabs_and_missing_samples() {
    let record = read("a\tt\n1\t0\nnan\t0.5\nNaN\t1\nNA\t1.5\ninf\t2\n");
    assert_eq!(record.time, [0.0, 0.5, 1.0, 1.5, 2.0]);
    assert_eq!(record.channels[0].values[0], 1.0);
    assert!(record.channels[0].values[1..].iter().all(|v| v.is_nan()));
}

#[test]
fn timestamps_are_seconds_from_the_first() {
    let record =
        read("Timestamp,F (V),F (N)\n2025-11-14 19:45:00.370690,1,2\n2025-11-14 19:45:00.374023,3,4\n");
    assert_eq!(record.time[0], 0.0);
    assert!((record.time[1] - 0.003333).abs() < 1e-12);
    let titles: Vec<_> = record.channels.iter().map(|c| (c.name.as_str(), c.unit.as_str())).collect();
    assert_eq!(titles, [("F", "V"), ("F", "N")]);
    let record = read("Zeit;F\n;N\n19:45:00;1,5\n19:45:01;2\n");
    assert_eq!((record.time[1], record.channels[0].values[0]), (1.0, 1.5));
    let message = error("t,F\n19:45:00,1\n2,2\n");
    assert!(
        message.contains("t: this is the time, but `2` in line 3 is not a time as in the first row"),
        "{message}"
    );
    assert!(message.contains("11/14/2025 07:45:00 PM"), "{message}");
}

#[test]
fn latin_1_units() {
    let record = parse("run.csv", b"t [s],a [m/s\xB2]\n0,1\n", &Reading::default()).unwrap();
    assert_eq!(record.channels[0].unit, "m/s²");
}

#[test]
fn errors_say_where() {
    assert!(
        error("t,F\n0,1\n1\n").starts_with("run.csv, line 3, column 1: the row has 1 cells, the header 2")
    );
    assert!(error("t,F\n0,1,2\n").starts_with("run.csv, line 2, column 2: the row has 3 cells"));
    assert!(
        error("t|F\n0|1\n")
            .starts_with("run.csv, line 1, column 1: no table of numbers in the first 2 rows (`t|F` …)")
    );
    assert!(error("t,F,F\n0,1,2\n").starts_with("run.csv, line 1, column 3: a second column `F`"));
    assert!(error("").contains("is empty"));
    assert!(error("t,F\n").contains("no samples"));
    assert!(error("t [V],F\n0,1\n").contains("this is the time, but"));
    assert!(
        parse("run.csv", &[0xFF, 0xFE, 65, 0], &Reading::default())
            .unwrap_err()
            .to_string()
            .contains("UTF-16")
    );
}

#[test]
fn a_file_without_time_says_how_to_map_it() {
    let text = "index,F [N]\n0,1\n1,2\n";
    let message = error(text);
    assert!(message.contains("no column of time among index, F"), "{message}");
    assert!(message.contains("time = { column = \"…\", unit = \"s\" }"), "{message}");

    let named = |column: &str, unit: Option<&str>| {
        let time = TimeColumn { column: column.into(), unit: unit.map(str::to_owned) };
        parse("run.csv", text.as_bytes(), &Reading { time: Some(time), ..Reading::default() })
    };
    assert_eq!(named("index", Some("ms")).unwrap().time, [0.0, 0.001]);
    let message = named("indx", None).unwrap_err().to_string();
    assert!(message.contains("did you mean `index`?"), "{message}");
}

#[test]
fn a_rate_takes_the_place_of_a_column_of_time() {
    let with = |text: &str, rate| {
        parse("run.csv", text.as_bytes(), &Reading { rate: Some(rate), ..Reading::default() })
    };
    let record = with(",F [N]\n0,1\n1,2\n2,4\n", 100.0).unwrap();
    assert_eq!(record.time, [0.0, 0.01, 0.02]);
    let names: Vec<_> = record.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["column 1", "F"]);
    let record = with("Time,F [N]\n0,1\n3,2\n", 100.0).unwrap();
    assert_eq!((record.time[1], record.unread[0].name.as_str()), (0.01, "Time"));
    assert!(with("F,G\n1,2\n", -1.0).unwrap_err().to_string().contains("`rate` is -1"));
}

#[test]
fn what_a_logger_writes_above_the_names_is_passed_over() {
    let names = |record: &Record| {
        record.channels.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect::<Vec<_>>()
    };
    for end in ["\n", "\r\n"] {
        let lines = |lines: &[&str]| read(&lines.join(end));
        let record = lines(&[
            "Shock Dyno Export v6.3",
            "Test:,Run 12 front left",
            "Date:,2025-11-14",
            "Gas pressure (psi):,100",
            "",
            "Time,Displacement,Force",
            "sec,in,lbs",
            "0.0,0.6,-108",
            "0.1,0.5,-109",
            "0.2,0.4,-110",
            "",
        ]);
        assert_eq!(names(&record), ["Displacement [in]", "Force [lbs]"]);
        assert_eq!(record.time, [0.0, 0.1, 0.2]);
        let record = lines(&[
            "Axis1",
            "Number of sampling data,1024",
            "Sampling time interval(ms),0.667",
            "Time,Analog 1,Analog 2",
            "ms,Servo motor speed,Torque",
            "0.0,0.0,-1",
            "0.667,0.0,-1",
            "1.334,0.0,-1",
            "",
        ]);
        assert_eq!(names(&record), ["Analog 1 [Servo motor speed]", "Analog 2 [Torque]"]);
        assert!((record.time[1] - 0.000667).abs() < 1e-15);
        let record = lines(&[
            "Header Size:  7",
            "Sampling Rate:  1000",
            "Sample Number, Date/Time, CHANNEL0, Events",
            " 1,   06/29/2022 04:05:36.674 PM, -0.0209, DAQ Start",
            " 2,   06/29/2022 04:05:36.675 PM, -0.0221",
            " 3,   06/29/2022 04:05:36.676 PM, -0.0222",
            "",
        ]);
        assert_eq!(names(&record), ["Sample Number []", "CHANNEL0 []"]);
        assert!((record.time[2] - 0.002).abs() < 1e-12);
        assert_eq!(record.unread[0].why, "`DAQ Start` in line 4 is not a number");
    }
}

#[test]
fn names_that_are_not_found_are_where_the_map_says() {
    let text = "name,a,b,c\nrig 3,1,2,3\nt,x,y,z\n0,1,2,3\n1,2,3,4\n";
    let at =
        |skip| parse("run.csv", text.as_bytes(), &Reading { skip_rows: Some(skip), ..Reading::default() });
    let record = at(2).unwrap();
    assert_eq!((record.time.len(), record.channels[0].name.as_str()), (2, "x"));
    assert!(at(9).unwrap_err().to_string().contains("skip"), "{}", at(9).unwrap_err());
    let message = error("Run 3\n0,1,2\n1,2,3\n");
    assert!(
        message.starts_with("run.csv, line 2, column 1: the numbers begin here, with 3 cells"),
        "{message}"
    );
    assert!(message.contains("skip_rows = 12"), "{message}");
}

#[test]
fn numpy_writes_blanks_and_a_comment_for_the_names() {
    let record = read("# t F\n0.0 1.0e+00\n0.1 -2.0e+00\n0.2 3\n");
    assert_eq!((record.time[1], record.channels[0].values[1]), (0.1, -2.0));
    assert_eq!(record.channels[0].name, "F");
    let record = read("# time [s],F [N]\n0.0,1\n0.1,2\n");
    assert_eq!(record.channels[0].unit, "N");
}

#[test]
fn a_text_that_nobody_uses_is_left_out() {
    let record = read("Zeit [s];Kraft [N];Bemerkung\n0,0;1,5;Start\n0,1;2,5;\n0,2;3,5;\n");
    assert_eq!(record.channels.len(), 1);
    assert_eq!(record.unread[0].name, "Bemerkung");
    let record = read("t,F,G\n0,1,1\n1,1.2.3,2\n");
    assert_eq!(record.unread[0].why, "`1.2.3` in line 3 is not a number: leave missing samples empty");
    assert_eq!(record.channels[0].values, [1.0, 2.0]);
}

#[test]
fn a_first_column_with_a_unit_of_time_is_the_time() {
    assert_eq!(read("X [min],F\n0,1\n20,1\n").time[1], 1200.0);
}

proptest! {
    #[test]
    fn round_trip(
        rows in prop::collection::vec((any::<f64>(), any::<f64>(), prop::option::of(any::<f64>())), 1..40)
    ) {
        let finite = |v: f64| if v.is_finite() { v } else { 0.25 };
        let record = Record {
            name: "run.csv".into(),
            time: rows.iter().map(|r| finite(r.0)).collect(),
            channels: vec![
                Channel { name: "a.b".into(), unit: "m/s2".into(), values: rows.iter().map(|r| finite(r.1)).collect() },
                Channel {
                    name: "c, \"d\"".into(),
                    unit: String::new(),
                    values: rows.iter().map(|r| r.2.filter(|v| v.is_finite()).unwrap_or(f64::NAN)).collect(),
                },
            ],
            ..Record::default()
        };
        let mut bytes = Vec::new();
        write(&record, &mut bytes).unwrap();
        let back = parse("run.csv", &bytes, &Reading::default()).unwrap();
        // NaN differs from itself: their bits are compared through the text.
        prop_assert_eq!(format!("{back:?}"), format!("{record:?}"));
    }

    #[test]
    fn damaged_files_are_refused_without_panic(
        cut in 0_usize..60, at in 0_usize..60, byte in any::<u8>()
    ) {
        let mut bytes = b"time [s];F [N];\"x;y\" (mm)\n0;1,5;2\n0,1;;-3\n# end\n0,2;1;2\n".to_vec();
        let last = bytes.len() - 1;
        bytes[at.min(last)] = byte;
        bytes.truncate(cut);
        if let Ok(record) = parse("run.csv", &bytes, &Reading::default()) {
            prop_assert!(record.channels.iter().all(|c| c.values.len() == record.time.len()));
        }
    }

    #[test]
    fn noise_is_no_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = parse("run.csv", &bytes, &Reading::default());
    }
}

#[test]
fn columns_without_names_go_by_their_numbers() {
    let message = error("0,1\n1,2\n");
    assert!(message.contains("no column of time among column 1, column 2"), "{message}");
    let time = Some(TimeColumn { column: "column 1".into(), unit: Some("s".into()) });
    let reading = Reading { time, ..Reading::default() };
    let record = parse("log.txt", b"# a log of the rig\n0.0 1.5\n0.1 2.5\n0.2 3.5\n", &reading).unwrap();
    let [channel] = &record.channels[..] else { panic!("one channel") };
    assert_eq!((channel.name.as_str(), &channel.values[..]), ("column 2", &[1.5, 2.5, 3.5][..]));
    let record = parse("log.txt", b"0,,1.5\n0.1,2,2.5\n0.2,2,3.5\n", &reading).unwrap();
    assert_eq!(record.channels[1].values, [1.5, 2.5, 3.5]);
    // A value that is missing at the end of the first row is one of a column.
    let record = parse("log.txt", b"0,1,\n0.1,2,2.5\n0.2,2,3.5\n", &reading).unwrap();
    assert!(record.channels.len() == 2 && record.channels[1].values[0].is_nan());
    assert_eq!(record.channels[1].values[1..], [2.5, 3.5]);
    // One name above three columns is not a row of names.
    let message = error("force\n0,1,2\n1,2,3\n");
    assert!(message.contains("write a row that names the columns"), "{message}");
}

#[test]
fn names_that_come_again_are_no_samples() {
    let block = |first: f64| {
        let samples = [0.0, 0.25, 0.5, 0.75].map(|later| format!("2.5\t{}\n", first + later)).concat();
        format!("Data Acquisition\t\t\tTime:\t{first}\tSec\nStroke\tTime\nmm\tSec\n{samples}")
    };
    let record = read(&[0.0, 1.0, 2.0].map(block).concat());
    assert_eq!(record.time, (0..12).map(|k| 0.25 * f64::from(k)).collect::<Vec<f64>>());
    assert_eq!((record.channels[0].unit.as_str(), record.channels[0].values[11]), ("mm", 2.5));
    assert_eq!(record.notes, ["the names of the columns come again: 6 lines are left out"]);
}

#[test]
fn a_column_of_text_is_said_to_be_one() {
    let record = read("time [s],F,state\n0,1,UP\n1,2,DOWN\n");
    assert_eq!(record.unread[0].why, "`UP` in line 2 is not a number");
}
