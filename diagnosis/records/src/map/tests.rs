use super::*;

fn record(columns: &[(&str, &str, [f64; 4])]) -> Record {
    let channel = |(name, unit, values): &(&str, &str, [f64; 4])| Channel {
        name: (*name).into(),
        unit: (*unit).into(),
        values: values.to_vec(),
    };
    let time = vec![0.0, 0.5, 1.0, 1.5];
    Record {
        name: "run.csv".into(),
        time,
        channels: columns.iter().map(channel).collect(),
        ..Record::default()
    }
}

fn wanted(name: &str, unit: &str, aliases: &[&str]) -> Wanted {
    let aliases = aliases.iter().map(|&alias| alias.into()).collect();
    Wanted { name: name.into(), unit: unit.into(), aliases }
}

#[test]
fn a_model_without_units_counts_in_those_of_the_si() {
    let record = crate::parse("run.csv", b"t [s],z [mm]\n0,0\n1,1\n2,2\n", &Reading::default()).unwrap();
    let mapped = Map::default().apply(record, &[wanted("z", "", &[])]).unwrap();
    assert_eq!(mapped.record.channels[0].values, [0.0, 1e-3, 2e-3]);
}

const RAMP: [f64; 4] = [0.0, 1.0, 2.0, 3.0];

fn error(map: &str, record: Record, wanted: &[Wanted]) -> String {
    Map::parse(map).and_then(|map| map.apply(record, wanted)).unwrap_err().to_string()
}

#[test]
fn a_column_may_be_named_with_its_unit_as_in_the_header() {
    let file = record(&[("Weg FL", "mm", RAMP), ("Kraft", "", RAMP)]);
    let signals = [wanted("deflection", "m", &[]), wanted("force", "N", &[])];
    for column in ["Weg FL [mm]", "Weg FL (mm)", "Weg FL"] {
        let map = format!("[signals]\n\"deflection\" = \"{column}\"\n\"force\" = \"Kraft\"\n");
        let mapped = Map::parse(&map).and_then(|map| map.apply(file.clone(), &signals)).unwrap();
        assert_eq!(mapped.record.channels[0].values, [0.0, 0.001, 0.002, 0.003]);
    }
    // Another unit is another column.
    let error = error("[signals]\n\"deflection\" = \"Weg FL [m]\"\n", file, &signals);
    assert!(error.contains("did you mean `Weg FL`?"), "{error}");
}

#[test]
fn names_and_aliases_without_a_map() {
    let file = record(&[("Body.Acceleration", "g", RAMP), ("travel", "mm", RAMP), ("spare", "", RAMP)]);
    let signals = [
        wanted("body_acceleration", "m/s2", &[]),
        wanted("deflection", "m", &["-compression", "-travel"]),
        wanted("force", "N", &[]),
    ];
    let mapped = Map::default().apply(file, &signals).unwrap();
    assert_eq!(mapped.unused.iter().map(Channel::title).collect::<Vec<_>>(), ["spare"]);
    assert_eq!(mapped.missing, ["force"]);
    let [acceleration, deflection] = &mapped.record.channels[..] else { panic!() };
    assert_eq!((acceleration.name.as_str(), acceleration.unit.as_str()), ("body_acceleration", "m/s2"));
    assert_eq!(acceleration.values[1], 9.80665);
    assert_eq!(deflection.values, [0.0, -0.001, -0.002, -0.003]);
}

#[test]
fn scale_offset_unit_and_delay() {
    let map = "[signals]\nx = { column = \"Weg\", unit = \"mm\", scale = -1.0, offset = 0.5, delay = 0.25 }\n\
               u = \"U\"\n";
    let file = record(&[("Weg", "V", [0.0, 1000.0, 2000.0, 3000.0]), ("U", "", RAMP)]);
    let mapped =
        Map::parse(map).unwrap().apply(file, &[wanted("x", "m", &[]), wanted("u", "V", &[])]).unwrap();
    let x = &mapped.record.channels[0].values;
    assert_eq!(x[..3], [0.0, -1.0, -2.0]);
    assert!(x[3].is_nan());
    assert_eq!(mapped.record.channels[1].values, RAMP);
}

#[test]
fn the_column_of_time() {
    let map = Map::parse("time = { column = \"Stamp\", unit = \"ms\" }").unwrap();
    let record = crate::parse("run.csv", b"Stamp,x\n0,1\n5,2\n", &map.reading).unwrap();
    assert_eq!(record.time, [0.0, 0.005]);
    let map = Map::parse("time = \"x\"").unwrap();
    let record = crate::parse("run.csv", b"Stamp,x\n0,1\n5,2\n", &map.reading).unwrap();
    assert_eq!(record.time, [1.0, 2.0]);
    assert!(Map::parse("time = { columns = \"x\" }").unwrap_err().to_string().contains("columns"));
}

#[test]
fn a_map_may_use_an_alias() {
    let map = Map::parse("[signals]\nstroke = { column = \"x\", scale = 2.0, offset = 1.0 }").unwrap();
    let mapped = map.apply(record(&[("x", "mm", RAMP)]), &[wanted("position", "m", &["-stroke"])]).unwrap();
    assert_eq!(mapped.record.channels[0].values[..2], [-1.0, -1.002]);
}

#[test]
fn of_two_columns_of_a_name_the_unit_decides() {
    let file = || record(&[("Force", "V", RAMP), ("Force", "kN", RAMP)]);
    let signals = [wanted("force", "N", &[])];
    for map in ["", "[signals]\nforce = \"Force\"", "[signals]\nforce = \"Force (kN)\""] {
        let mapped = Map::parse(map).unwrap().apply(file(), &signals).unwrap();
        assert_eq!(mapped.record.channels[0].values, RAMP.map(|it| 1e3 * it), "{map}");
    }
    let both = || record(&[("Force", "N", RAMP), ("Force", "kN", RAMP)]);
    let message = error("", both(), &signals);
    assert!(message.contains("`\"force\" = \"Force [N]\"`"), "{message}");
    let mapped = Map::parse("[signals]\nforce = \"Force [N]\"").unwrap().apply(both(), &signals);
    assert_eq!(mapped.unwrap().record.channels[0].values, RAMP);
}

#[test]
fn errors_say_what_to_do() {
    let file = || record(&[("deflection", "mm", RAMP), ("force", "V", RAMP)]);
    let signals = [wanted("strut_force", "N", &["force"]), wanted("x", "m", &[])];
    let message = error("", file(), &signals);
    assert!(message.starts_with("run.csv, force: `V` does not measure the same as `N`"), "{message}");
    let message = error("[signals]\nx = \"deflexion\"", file(), &signals[1..]);
    assert!(message.contains("did you mean `deflection`?"), "{message}");
    let message = error("[signals]\nstrut_forse = \"force\"", file(), &signals);
    assert!(message.contains("did you mean `strut_force`?"), "{message}");
    let message = error("", file(), &[wanted("y", "m", &[])]);
    assert!(message.contains("none of the model's signals"), "{message}");
    let message = error("[signals]\nx = { column = \"deflection\", units = \"mm\" }", file(), &signals);
    assert!(message.contains("units"), "{message}");
    let message = error("[signals]\nx = { column = \"deflection\", scale = 0.0 }", file(), &signals);
    assert!(message.contains("scale must not be 0"), "{message}");
    assert!(error("signal = 3", file(), &signals).contains("signal"));
    let message =
        error("[signals]\nx = { column = \"deflection\", unit = \"furlong\" }", file(), &signals[1..]);
    assert!(message.contains("`furlong` is not a unit known here"), "{message}");
}

#[test]
fn a_signal_may_be_computed_from_columns() {
    let file = || record(&[("pA", "bar", RAMP), ("pB", "", RAMP), ("T", "degC", RAMP)]);
    let signals = [wanted("force", "N", &["-pull"])];
    let map =
        "[signals]\nforce = { formula = \"(pA - pB) * 10 cm2\", units = { pB = \"MPa\" }, scale = 2.0 }";
    let mapped = Map::parse(map).unwrap().apply(file(), &signals).unwrap();
    for (found, ramp) in mapped.record.channels[0].values.iter().zip(RAMP) {
        assert!((found - 2.0 * (1e5 - 1e6) * ramp * 1e-3).abs() < 1e-9, "{found}");
    }
    assert_eq!(mapped.unused.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["T"]);
    let short = Map::parse("[signals]\npull = \"pA * 1 mm2\"").unwrap().apply(file(), &signals).unwrap();
    assert!((short.record.channels[0].values[1] + 0.1).abs() < 1e-12);
    for (map, says) in [
        ("force = \"(pA - pB) * 10 cm2\"", "kg/(m·s2) and 1 are not added"),
        ("force = \"pA * 2\"", "the result is in kg/(m·s2), and N is wanted"),
        ("force = \"pA * pC\"", "column `pC`, and the file has none of that name"),
        ("force = \"pA * \"", "no formula at `*`"),
        ("force = \"pX\"", "there is no such column"),
        ("force = { formula = \"pA * 1 m2\", unit = \"kN\" }", "has a unit of its own"),
        (
            "force = { formula = \"pA * 1 m2\", units = { pa = \"bar\" } }",
            "`pa`, which is none of its columns",
        ),
        ("force = { column = \"pB\", units = { pB = \"N\" } }", "as `unit`"),
    ] {
        let message = error(&format!("[signals]\n{map}"), file(), &signals);
        assert!(message.contains(says), "{map}: {message}");
    }
}

#[test]
fn an_offset_at_rest_is_what_a_sensor_shows_while_nothing_moves() {
    let time: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
    let moving =
        |offset: f64| time.iter().map(|t| offset + (3.0 * (t - 5.0).max(0.0)).sin()).collect::<Vec<_>>();
    let channel =
        |name: &str, offset| Channel { name: name.into(), unit: String::new(), values: moving(offset) };
    let record = Record {
        name: "run.csv".into(),
        time: time.clone(),
        channels: vec![channel("F", 7.0), channel("x", 0.0)],
        ..Record::default()
    };
    let map =
        Map::parse("[signals]\nforce = { column = \"F\", scale = -2.0, offset = \"at rest\" }").unwrap();
    let mapped = map.apply(record.clone(), &[wanted("force", "N", &[])]).unwrap();
    let found = &mapped.record.channels[0].values;
    assert!(
        found[..500].iter().all(|it| it.abs() < 1e-9) && (found[1000] + 2.0 * moving(0.0)[1000]).abs() < 1e-9
    );
    let late = Record { time: time[..1400].to_vec(), ..record };
    let channels =
        late.channels.iter().map(|it| Channel { values: it.values[600..].to_vec(), ..it.clone() }).collect();
    let message =
        map.apply(Record { channels, ..late }, &[wanted("force", "N", &[])]).unwrap_err().to_string();
    assert!(message.contains("does not start with a second and 200 samples of rest"), "{message}");
    let other =
        Map::parse("[signals]\nforce = { column = \"F\", offset = \"rest\" }").unwrap_err().to_string();
    assert!(other.contains("force"), "{other}");
}

#[test]
fn a_unit_at_the_end_of_a_name_counts_where_it_fits() {
    let file = "Time_ms,AccelZ_g,body_acceleration_g,path_m\n0,1,2,3\n5,1,2,3\n";
    let record = crate::parse("run.csv", file.as_bytes(), &Reading::default()).unwrap();
    assert_eq!((record.time[1], record.seconds_assumed), (0.005, false));
    let map = Map::parse("[signals]\n\"wheel.acceleration\" = \"AccelZ_g\"").unwrap();
    let wanted = [
        wanted("wheel.acceleration", "m/s2", &[]),
        wanted("body.acceleration", "m/s2", &[]),
        wanted("path_m", "N", &[]),
    ];
    let mapped = map.apply(record, &wanted).unwrap();
    let first: Vec<f64> = mapped.record.channels.iter().map(|it| it.values[0]).collect();
    assert_eq!(first, [9.80665, 19.6133, 3.0]);
    assert_eq!(mapped.taken.iter().map(|it| it.assumed).collect::<Vec<_>>(), [false, false, true]);
}

#[test]
fn a_column_of_text_is_refused_where_it_is_wanted() {
    let file = "t,F,remark\n0,1,a\n1,x,b\n2,2,c\n";
    let record = crate::parse("run.csv", file.as_bytes(), &Reading::default()).unwrap_err().to_string();
    assert!(record.contains("no signal beside it"), "{record}");
    let file = "t,F,G,remark\n0,1,1,a\n1,x,2,b\n2,2,3,c\n";
    let record = crate::parse("run.csv", file.as_bytes(), &Reading::default()).unwrap();
    let message = Map::default().apply(record.clone(), &[wanted("f", "N", &[])]).unwrap_err().to_string();
    assert_eq!(
        message,
        "run.csv, F: this is `f`, but `x` in line 3 is not a number: leave missing samples empty"
    );
    let map = Map::parse("[signals]\nforce = \"F\"").unwrap();
    let message = map.apply(record, &[wanted("force", "N", &[])]).unwrap_err().to_string();
    assert!(message.contains("the map takes `force` from it, but `x` in line 3"), "{message}");
}

#[test]
fn what_a_map_says_of_the_files() {
    let map = Map::parse("rate = 100.0\nskip_rows = 3\nsheet = \"Run 3\"").unwrap();
    let reading = Reading { rate: Some(100.0), skip_rows: Some(3), sheet: Some("Run 3".into()), time: None };
    assert_eq!(map.reading, reading);
    assert_eq!(map.reading.or(Some(10.0), None).rate, Some(10.0));
}
