//! Columns that cannot be what they say are found before any fit, and no effect is taken for one.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use strut_blind::{cases, files, generate};
use strut_diagnosis::app::virtual_rig::{self, Experiment};
use strut_diagnosis::data::Origin;
use strut_diagnosis::data::check::DataProblem;
use strut_diagnosis::data::map::Map;
use strut_diagnosis::dataset::load::load;
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::dataset::witness;
use strut_diagnosis::diagnosis::Options;
use strut_diagnosis::plausibility::problems;
use strut_diagnosis::rig::Rig;
use strut_model::ParameterSet;

const CAR: &str = "tum-linear-measured-quarter-car";

/// A table by its columns' headers.
type Table = Vec<(String, Vec<String>)>;

fn table(text: &str) -> Table {
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let mut table: Table = lines.next().unwrap().into_iter().map(|title| (title, Vec::new())).collect();
    for row in lines {
        table.iter_mut().zip(row).for_each(|((_, column), cell)| column.push(cell));
    }
    table
}

fn text(table: &Table) -> String {
    let rows = table[0].1.len();
    let titles: Vec<&str> = table.iter().map(|(title, _)| title.as_str()).collect();
    let row = |row: usize| table.iter().map(|(_, column)| column[row].as_str()).collect::<Vec<_>>().join(",");
    std::iter::once(titles.join(",")).chain((0..rows).map(row)).collect::<Vec<_>>().join("\n") + "\n"
}

fn column<'a>(table: &'a mut Table, name: &str) -> &'a mut (String, Vec<String>) {
    table.iter_mut().find(|(title, _)| title.split(' ').next() == Some(name)).expect(name)
}

fn scale(table: &mut Table, name: &str, factor: f64) {
    for cell in &mut column(table, name).1 {
        *cell = format!("{:.7e}", cell.parse::<f64>().unwrap() * factor);
    }
}

/// Records of a virtual rig with something hidden in it, changed by somebody who exports them.
fn found(rig: &str, hidden: &[(&str, f64)], change: impl Fn(&mut Table)) -> Vec<DataProblem> {
    let mut rig = Rig::published(rig).unwrap();
    let hidden = hidden.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let experiment = Experiment { hidden, amplitude: 1.0, noise: 0.01, seed: 3, step: 2e-3, length: 8.0 };
    let mut table = table(&virtual_rig::record(&rig, &experiment, 1).unwrap());
    change(&mut table);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.csv");
    fs::write(&path, text(&table)).unwrap();
    let records = load(&mut rig, &[&Origin::File(path)], &Map::default()).unwrap().records;
    problems(&rig, &Split::new(&records, Vec::new()), &Options::default()).unwrap()
}

fn fatal(problems: &[DataProblem]) -> Vec<&str> {
    problems.iter().filter(|it| it.fatal).map(|it| it.signal.as_str()).collect()
}

#[test]
fn records_of_every_rig_are_plausible() {
    for name in Rig::names() {
        let problems = found(&name, &[], |_| {});
        assert!(problems.is_empty(), "{name}: {problems:?}");
    }
}

#[test]
fn no_effect_is_taken_for_a_wrong_column() {
    for hidden in [
        &[("strut.coulomb.force", 3000.0)][..],
        &[("strut.coulomb.force", 400.0), ("guide.coulomb.force", 300.0)],
        &[("strut.damping", 30.0), ("sprung_mass", 20.0)],
        &[("strut.damping", 20_000.0)],
        &[("strut.spring.cubic", 1e9)],
        &[("tire.stiffness", 20_000.0)],
    ] {
        let problems = found(CAR, hidden, |_| {});
        assert!(fatal(&problems).is_empty(), "{hidden:?}: {problems:?}");
    }
    // A sensor of half the gain, one that drifts away, one that shows noise only.
    type Fault = fn(&mut Table);
    let faults: [Fault; 3] = [
        |table| scale(table, "body.acceleration", 0.5),
        |table| {
            for (k, cell) in column(table, "suspension.deflection").1.iter_mut().enumerate() {
                *cell = format!("{:.7e}", cell.parse::<f64>().unwrap() + 1e-3 * k as f64);
            }
        },
        |table| {
            for (k, cell) in column(table, "wheel.force").1.iter_mut().enumerate() {
                *cell = format!("{}", 1e-4 * ((k * 7919 % 1009) as f64 - 504.0));
            }
        },
    ];
    for (number, fault) in faults.into_iter().enumerate() {
        let problems = found(CAR, &[], fault);
        assert!(fatal(&problems).is_empty(), "{number}: {problems:?}");
    }
}

/// Effects that another program has hidden, with noise and small effects that no model knows: none looks like a wrong column, and
/// each record is a witness of its own.
#[test]
#[ignore = "makes long records: `scripts/long-tests diagnosis`"]
fn nothing_in_the_blind_benchmark_is_taken_for_a_wrong_column() {
    let wanted = ["pair-01-08", "dyno-01", "servo-28", "drive-16", "unnamed-U10"];
    let cases: Vec<_> =
        cases::compact().into_iter().filter(|it| wanted.contains(&it.name.as_str())).collect();
    assert_eq!(cases.len(), wanted.len());
    for case in cases {
        let below = tempfile::tempdir().unwrap();
        let data = files::write(&generate(&case).unwrap(), below.path()).unwrap().join("data");
        let set = ParameterSet::parse(&fs::read_to_string(data.join("start.toml")).unwrap()).unwrap();
        let mut rig = Rig::of(&set).unwrap();
        let of = |kind: &str| {
            let mut paths: Vec<PathBuf> = fs::read_dir(&data).unwrap().map(|it| it.unwrap().path()).collect();
            paths.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with(kind));
            paths
        };
        let (train, test) = (of("train"), of("test"));
        let count = train.len();
        let origins: Vec<Origin> = train.into_iter().chain(test).map(Origin::File).collect();
        let origins: Vec<&Origin> = origins.iter().collect();
        let mut records = load(&mut rig, &origins, &Map::default()).unwrap().records;
        let test = records.split_off(count);
        assert_eq!(witness::notes(&records, &test, &rig.plant.inputs), [], "{}", case.name);
        let problems = problems(&rig, &Split::new(&records, test), &Options::default()).unwrap();
        assert!(problems.is_empty(), "{}: {problems:?}", case.name);
    }
}

/// Of a drive with a start value's mass nobody knows what its force does.
#[test]
fn a_drive_of_which_nothing_is_known_is_not_judged() {
    let problems = found("linear-drive", &[("moving_mass", 0.01)], |table| {
        // The rig is linear: with small forces it moves as little as such a mass may.
        for name in ["force", "position", "acceleration"] {
            scale(table, name, 1e-4);
        }
    });
    assert!(problems.is_empty(), "{problems:?}");
}

/// A position in millimetres beside a velocity in metres per second.
#[test]
fn columns_of_one_motion_are_compared_whatever_the_parameters() {
    let with_velocity = |factor: f64| {
        move |table: &mut Table| {
            let step = 2e-3;
            let position: Vec<f64> =
                column(table, "position").1.iter().map(|cell| cell.parse().unwrap()).collect();
            let rate = |k: usize| {
                (position[(k + 1).min(position.len() - 1)] - position[k.saturating_sub(1)]) / step / 2.0
            };
            let velocity = (0..position.len()).map(|k| format!("{:.7e}", rate(k))).collect();
            table.push(("velocity [m/s]".into(), velocity));
            scale(table, "position", factor);
        }
    };
    let problems = found("linear-drive", &[], with_velocity(1e3));
    assert_eq!(fatal(&problems), ["position"], "{problems:?}");
    assert!(problems[0].text.contains("e.g. \"position [mm]\""), "{}", problems[0].text);
    assert!(found("linear-drive", &[], with_velocity(1.0)).is_empty());
    // Without a velocity, too, nothing moves by hundreds of metres.
    let problems = found("element-dyno", &[], |table| scale(table, "motion.position", 1e3));
    assert_eq!(fatal(&problems), ["motion.position"], "{problems:?}");
}

#[test]
fn wrong_units_are_found_with_something_hidden_in_the_rig() {
    let hidden = [("strut.coulomb.force", 60.0), ("strut.asymmetry.ratio", 0.3)];
    let of = |change: &dyn Fn(&mut Table)| {
        let problems = found(CAR, &hidden, change);
        let told: BTreeMap<String, String> =
            problems.into_iter().filter(|it| it.fatal).map(|it| (it.signal, it.text)).collect();
        told
    };
    let told = of(&|table| scale(table, "suspension.deflection", 1e3));
    assert_eq!(told.keys().collect::<Vec<_>>(), ["suspension.deflection"]);
    assert!(told["suspension.deflection"].contains("e.g. \"suspension.deflection [mm]\""), "{told:?}");
    // The header says millimetres, the values are metres.
    let told = of(&|table| column(table, "suspension.deflection").0 = "suspension.deflection [mm]".into());
    assert!(told["suspension.deflection"].contains("are in m, not in mm, as the header says"), "{told:?}");
    let told = of(&|table| scale(table, "wheel.force", 1e-3));
    assert!(told["wheel.force"].contains("[kN]"), "{told:?}");
    let told = of(&|table| scale(table, "road.position", 1e3));
    assert_eq!(told.keys().collect::<Vec<_>>(), ["road.position"]);
    let lengths = ["road.position", "suspension.deflection", "tire.deflection", "wheel.position"];
    let told = of(&|table| lengths.iter().for_each(|name| scale(table, name, 1e3)));
    assert_eq!(told.keys().collect::<Vec<_>>(), lengths);
}

#[test]
fn a_force_in_kilonewtons_shows_in_the_fit() {
    let problems = found(CAR, &[], |table| scale(table, "actuator.force", 1e-3));
    assert_eq!(fatal(&problems), ["actuator.force"], "{problems:?}");
    assert!(problems[0].text.contains("[kN]"), "{}", problems[0].text);
}

#[test]
fn exchanged_accelerations_are_asked_for_and_a_wrong_sign_is_not() {
    let problems = found(CAR, &[("strut.coulomb.force", 60.0)], |table| {
        "wheel.acceleration [m/s2]".clone_into(&mut column(table, "body.acceleration").0);
        "body.acceleration [m/s2]"
            .clone_into(&mut table.iter_mut().rfind(|(it, _)| it.starts_with("wheel.acc")).unwrap().0);
    });
    assert_eq!(fatal(&problems), ["body.acceleration, wheel.acceleration"]);
    assert!(problems[0].text.starts_with("are these two swapped?"), "{}", problems[0].text);
    let problems = found(CAR, &[], |table| scale(table, "body.acceleration", -1.0));
    assert!(problems.is_empty(), "{problems:?}");
}
