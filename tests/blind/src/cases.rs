//! The lists of cases.

use std::ops::Range;

use crate::case::{Case, Hidden, Plant, Sensors};

/// Sensors that a fault can sit in.
const SIGNALS: [&str; 4] =
    ["body.acceleration", "wheel.acceleration", "suspension.deflection", "wheel.force"];

/// Effects of the quarter car's parts.
const PARTS: [&str; 21] = [
    "01", "02", "03", "04", "05", "06", "07", "08", "09", "10", "12", "13", "14", "15", "16", "17", "19",
    "21", "23", "24", "25",
];

/// Further effects of the quarter car's parts: frame, road and force as they act, friction behind backlash.
const FURTHER: [&str; 5] = ["18", "22", "26", "26s", "03b"];

/// Effects of a quarter car with a servo valve.
const WITH_VALVE: [&str; 6] = ["01", "26v", "28", "28h", "29", "30"];

/// Effects in no catalogue, of the quarter car's parts.
const UNNAMED: [&str; 12] = ["U1", "U2", "U3", "U4", "U7", "U8", "U9", "U10", "U11", "U12", "U14", "U15"];

/// The same in other quarter cars, and without a force cell.
const UNNAMED_ELSEWHERE: [(&str, Plant, Sensors, &str); 9] = [
    ("published", Plant::PublishedQuarter, Sensors::Full, "U7"),
    ("published", Plant::PublishedQuarter, Sensors::Full, "U9"),
    ("published", Plant::PublishedQuarter, Sensors::Full, "U12"),
    ("regulated", Plant::RegulatedQuarter, Sensors::Full, "U10"),
    ("regulated", Plant::RegulatedQuarter, Sensors::Full, "U14"),
    ("servo", Plant::ServoQuarter, Sensors::Full, "U7"),
    ("servo", Plant::ServoQuarter, Sensors::Full, "U14"),
    ("no-force-cell", Plant::LinearQuarter, Sensors::NoForceCell, "U9"),
    ("no-force-cell", Plant::LinearQuarter, Sensors::NoForceCell, "U11"),
];

/// An effect with a number beside one without.
const MIXED: [[&str; 2]; 2] = [["01", "U9"], ["04", "U14"]];

/// Effects in no catalogue, of a strut on a dyno.
const UNNAMED_ON_DYNO: [&str; 2] = ["U8", "U12"];

/// Effects in no catalogue, of sensors.
const UNNAMED_OF_SENSORS: [(&str, &str); 6] = [
    ("U5", "body.acceleration"),
    ("U5", "wheel.force"),
    ("U6", "body.acceleration"),
    ("U6", "suspension.deflection"),
    ("U13", "body.acceleration"),
    ("U13", "wheel.acceleration"),
];

/// Effects of a quarter car under a regulator.
const REGULATED: [&str; 6] = ["01", "07", "12", "16", "23", "25"];

/// Effects of a linear drive.
const OF_DRIVE: [&str; 4] = ["02g", "16", "27", "33g"];

/// Effects of a mass on a spring, in a catalogue and in none.
const OF_MASS: [&str; 3] = ["16m", "08n", "U9m"];

/// Effects of a pump actuator.
const OF_PUMP: [&str; 6] = ["30p", "32a", "32b", "32c", "23", "25"];

/// Effects of a semi-active rig. Not its brake's gain: no force is measured there, so that everything else could be as many times
/// heavier and stiffer, and nobody could tell.
const OF_SAS: [&str; 3] = ["01p", "19p", "23"];

/// Effects of a pneumatic cylinder.
const OF_PNEUMATIC: [&str; 5] = ["16", "28c", "30c", "15c", "29c"];

/// Effects of a strut on a dyno.
const ON_DYNO: [&str; 10] = ["01", "03", "03b", "04", "05", "06", "07", "08", "09", "32"];

/// Pairs that can be told apart, and pairs that are easily confused.
const PAIRS: [[&str; 2]; 8] = [
    ["01", "08"],
    ["04", "16"],
    ["06", "19"],
    ["01", "24"],
    ["01", "12"],
    ["01", "16"],
    ["05", "06"],
    ["07", "23"],
];

fn standard(name: impl AsRef<str>, effects: Vec<Hidden>, seed: u64) -> Case {
    Case::standard(name.as_ref(), effects, seed)
}

/// A few cases that a test can run each time: single effects, a pair, a cause without a name, sensors' faults, a dyno,
/// nothing at all, wrong parameters.
pub fn compact() -> Vec<Case> {
    let single = ["01", "04", "05", "06", "07", "08", "09", "12", "16", "17", "23", "25"];
    let mut all: Vec<Case> = (1..)
        .zip(single)
        .map(|(seed, id)| standard(format!("single-{id}"), vec![Hidden::new(id)], seed))
        .collect();
    all.push(standard("pair-01-08", vec![Hidden::new("01"), Hidden::new("08")], 21));
    all.push(standard("unnamed-U1", vec![Hidden::new("U1")], 22));
    all.push(standard("unnamed-U5", vec![Hidden::at("U5", "wheel.force")], 37));
    all.push(standard("sensor-34", vec![Hidden::at("34", "wheel.force")], 23));
    all.push(standard("sensor-33", vec![Hidden::at("33", "wheel.acceleration")], 27));
    all.push(standard("sensor-36", vec![Hidden::at("36", "body.acceleration")], 28));
    all.push(standard("sensor-40", vec![Hidden::at("40", "wheel.force")], 30));
    all.push(standard("single-26", vec![Hidden::new("26")], 31));
    all.push(Case { plant: Plant::StrutDyno, ..standard("dyno-01", vec![Hidden::new("01")], 29) });
    all.push(Case { plant: Plant::ServoQuarter, ..standard("servo-28", vec![Hidden::new("28")], 32) });
    // Laws that share a number with another one.
    all.push(standard("single-26s", vec![Hidden::new("26s")], 39));
    all.push(Case { plant: Plant::ServoQuarter, ..standard("servo-28h", vec![Hidden::new("28h")], 40) });
    all.push(standard("sensor-41h", vec![Hidden::at("41h", "wheel.force")], 41));
    all.push(Case { clutter: 0, ..standard("none", vec![], 24) });
    all.push(standard("none-cluttered", vec![], 25));
    all.push(Case { clutter: 0, nominal_off: 0.1, ..standard("mismatch", vec![], 26) });
    // What its loop holds in place, and a simulation does not.
    all.push(driven(standard("drive-02g", vec![Hidden::new("02g")], 33)));
    all.push(driven(standard("drive-16", vec![Hidden::new("16")], 34)));
    all.push(driven(standard("drive-27", vec![Hidden::new("27")], 35)));
    // Which one curve over the velocity imitates.
    all.push(driven(standard("drive-16-33g", vec![Hidden::new("16"), Hidden::new("33g")], 36)));
    // A bush with backlash imitates it, and is less common.
    all.push(standard("common-07", vec![Hidden::new("07")], 1007));
    // Behind a late command, and that and a curved spring, which are only clutter.
    all.push(standard("behind-18", vec![Hidden::new("18")], 1012));
    all.push(standard("behind-36", vec![Hidden::at("36", "suspension.deflection")], 1012));
    // A force cell's mass does its work until it is found.
    all.push(standard("behind-35", vec![Hidden::at("35", "wheel.force")], 1014));
    // A law that contains friction, which every drive's model has.
    all.push(driven(standard("resized-02g", vec![Hidden::new("02g")], 1014)));
    // Where the measured position is noisy, a late one fits better.
    all.push(Case { plant: Plant::StrutDyno, ..standard("noisy-01", vec![Hidden::new("01")], 1014) });
    // A hump so steep that the body has two places to rest: as a stop it would need a spring that is none.
    all.push(standard("driven-U1", vec![Hidden::new("U1")], 1017));
    // A sensor's response, which with every signal in time is imitated by causes that leave its own signal as wrong.
    all.push(standard("answering-U6", vec![Hidden::at("U6", "body.acceleration")], 1018));
    all.push(Case { plant: Plant::ServoQuarter, ..standard("servo-26v", vec![Hidden::new("26v")], 44) });
    all.push(Case { plant: Plant::PumpDyno, ..standard("pump-30p", vec![Hidden::new("30p")], 45) });
    // A law that contains presliding; and a loop that answers what the effect does.
    all.push(standard("single-03b", vec![Hidden::new("03b")], 42));
    all.push(Case {
        plant: Plant::RegulatedQuarter,
        ..standard("regulated-16", vec![Hidden::new("16")], 43)
    });
    // In no catalogue: an inertia, a hidden state, a time.
    for (seed, id) in [(46, "U7"), (47, "U9"), (48, "U10"), (49, "U11")] {
        all.push(standard(format!("unnamed-{id}"), vec![Hidden::new(id)], seed));
    }
    all.push(standard("unnamed-U13", vec![Hidden::at("U13", "body.acceleration")], 50));
    all.push(guided(standard("mass-none", vec![], 51)));
    all.push(guided(standard("mass-16m", vec![Hidden::new("16m")], 52)));
    all.push(guided(standard("mass-08n", vec![Hidden::new("08n")], 53)));
    // On a road that nobody measured.
    for (seed, id) in [(54, "01"), (55, "05"), (56, "08"), (57, "12"), (58, "U1")] {
        all.push(roadless(standard(format!("roadless-{id}"), vec![Hidden::new(id)], seed)));
    }
    all.push(roadless(standard("roadless-none", vec![], 59)));
    all
}

fn roadless(case: Case) -> Case {
    Case { sensors: Sensors::NoRoad, ..case }
}

/// The whole benchmark, each case with each of the seeds.
pub fn full(seeds: Range<u64>) -> Vec<Case> {
    seeds.flat_map(full_of).collect()
}

fn full_of(seed: u64) -> Vec<Case> {
    let mut all = vec![];
    for id in PARTS.into_iter().chain(FURTHER) {
        all.push(standard(format!("single-{id}-{seed}"), vec![Hidden::new(id)], seed));
        let published = ["01", "02", "04", "16", "19"].contains(&id);
        if !published {
            let case = standard(format!("published-{id}-{seed}"), vec![Hidden::new(id)], seed);
            all.push(Case { plant: Plant::PublishedQuarter, ..case });
        }
    }
    all.push(standard(format!("single-20-{seed}"), vec![Hidden::new("20")], seed));
    for id in ["33", "34", "35", "36", "37", "38", "38d", "40", "40a"] {
        for signal in SIGNALS {
            all.push(standard(format!("sensor-{id}-{signal}-{seed}"), vec![Hidden::at(id, signal)], seed));
        }
    }
    for id in ["41", "41h"] {
        let cell = vec![Hidden::at(id, "wheel.force")];
        all.push(standard(format!("sensor-{id}-wheel.force-{seed}"), cell, seed));
    }
    all.push(standard(format!("sensor-42-{seed}"), vec![Hidden::at("42", "road.position")], seed));
    for id in UNNAMED {
        all.push(standard(format!("unnamed-{id}-{seed}"), vec![Hidden::new(id)], seed));
    }
    for (id, signal) in UNNAMED_OF_SENSORS {
        all.push(standard(format!("unnamed-{id}-{signal}-{seed}"), vec![Hidden::at(id, signal)], seed));
    }
    for (name, plant, sensors, id) in UNNAMED_ELSEWHERE {
        let case = standard(format!("{name}-{id}-{seed}"), vec![Hidden::new(id)], seed);
        all.push(Case { plant, sensors, ..case });
    }
    for mixed in MIXED {
        let effects = mixed.map(Hidden::new).to_vec();
        all.push(standard(format!("mixed-{}-{}-{seed}", mixed[0], mixed[1]), effects, seed));
    }
    for pair in PAIRS {
        let effects = pair.map(Hidden::new).to_vec();
        all.push(standard(format!("pair-{}-{}-{seed}", pair[0], pair[1]), effects, seed));
    }
    let triple = ["01", "08", "19"].map(Hidden::new).to_vec();
    all.push(standard(format!("triple-01-08-19-{seed}"), triple, seed));
    // As many without an effect as it takes to see a false alarm in a hundred over the seeds.
    for part in 0..10 {
        for clutter in [0, 1] {
            let name = format!("none-{clutter}-{part}-{seed}");
            all.push(Case { clutter, ..standard(name, vec![], seed * 100 + part) });
        }
    }
    conditions(seed, &mut all);
    for id in ON_DYNO {
        let case = standard(format!("dyno-{id}-{seed}"), vec![Hidden::new(id)], seed);
        all.push(Case { plant: Plant::StrutDyno, ..case });
    }
    for id in UNNAMED_ON_DYNO {
        let case = standard(format!("dyno-{id}-{seed}"), vec![Hidden::new(id)], seed);
        all.push(Case { plant: Plant::StrutDyno, ..case });
    }
    let offset = standard(format!("dyno-33-{seed}"), vec![Hidden::at("33", "force")], seed);
    all.push(Case { plant: Plant::StrutDyno, ..offset });
    all.push(Case { plant: Plant::StrutDyno, ..standard(format!("dyno-none-{seed}"), vec![], seed) });
    other_rigs(seed, &mut all);
    all
}

/// Rigs beside TUM's.
fn other_rigs(seed: u64, all: &mut Vec<Case>) {
    for id in [&["none"][..], &WITH_VALVE].concat() {
        let case = standard(format!("servo-{id}-{seed}"), hidden(id), seed);
        all.push(Case { plant: Plant::ServoQuarter, ..case });
    }
    for id in [&["none"][..], &REGULATED].concat() {
        let case = standard(format!("regulated-{id}-{seed}"), hidden(id), seed);
        all.push(Case { plant: Plant::RegulatedQuarter, ..case });
    }
    let late = vec![Hidden::at("36", "suspension.deflection")];
    let case = standard(format!("regulated-36-{seed}"), late, seed);
    all.push(Case { plant: Plant::RegulatedQuarter, ..case });
    for id in [&["none"][..], &OF_DRIVE].concat() {
        all.push(driven(standard(format!("drive-{id}-{seed}"), hidden(id), seed)));
    }
    for id in [&["none"][..], &OF_MASS].concat() {
        all.push(guided(standard(format!("mass-{id}-{seed}"), hidden(id), seed)));
        let slow = Case { rate: 100.0, ..standard(format!("mass-rate-100-{id}-{seed}"), hidden(id), seed) };
        all.push(guided(slow));
    }
    let loose = vec![Hidden::at("U13", "acceleration")];
    all.push(guided(standard(format!("mass-U13-{seed}"), loose, seed)));
    // A damper without a spring to speak of makes force of the motion's noise, so that the scale must be as fine here.
    let yielding = Hidden::new("32h");
    let offset = Hidden::at("33", "force");
    for (name, effects) in [
        ("none", vec![]),
        ("01", vec![Hidden::new("01")]),
        ("32", vec![yielding.clone()]),
        ("33", vec![offset.clone()]),
        ("32-33", vec![yielding, offset]),
    ] {
        let case = standard(format!("mr-{name}-{seed}"), effects, seed);
        all.push(Case { plant: Plant::MrDyno, noise_db: Some(60.0), ..case });
    }
    for id in [&["none"][..], &OF_PNEUMATIC].concat() {
        let case = standard(format!("pneumatic-{id}-{seed}"), hidden(id), seed);
        // Its noise is 0.3 % of each signal.
        let (plant, noise_db) = (Plant::PneumaticCylinder, Some(50.0));
        all.push(Case { plant, noise_db, duration: 10.0, ..case });
    }
    // On the semi-active rig, the wheel arm follows the eccentric and all that is in its record.
    for (rig, plant, noise, of_parts, of_sensors) in [
        ("pump", Plant::PumpDyno, 40.0, &OF_PUMP[..], [("33", "force"), ("34", "force"), ("36", "force")]),
        (
            "sas",
            Plant::SasRig,
            60.0,
            &OF_SAS,
            [("33", "relative.angle"), ("34", "body_arm.acceleration"), ("36", "relative.angle")],
        ),
    ] {
        let parts = [&["none"][..], of_parts].concat().into_iter().map(|id| (id, hidden(id)));
        let sensors = of_sensors.iter().map(|(id, signal)| (*id, vec![Hidden::at(id, signal)]));
        for (id, effects) in parts.chain(sensors) {
            let case = standard(format!("{rig}-{id}-{seed}"), effects, seed);
            all.push(Case { plant, noise_db: Some(noise), ..case });
        }
    }
}

/// The same of a drive, whose scale tells positions more finely than an accelerometer accelerations.
fn driven(case: Case) -> Case {
    Case { plant: Plant::LinearDrive, noise_db: Some(60.0), ..case }
}

/// The same of a mass on a spring, whose position is measured as finely.
fn guided(case: Case) -> Case {
    Case { plant: Plant::GuidedMass, noise_db: Some(60.0), ..case }
}

/// The effect of that number, or nothing.
fn hidden(id: &str) -> Vec<Hidden> {
    if id == "none" { vec![] } else { vec![Hidden::new(id)] }
}

/// One condition at a time made worse, or better, for a few effects.
fn conditions(seed: u64, all: &mut Vec<Case>) {
    for id in ["01", "08", "12", "16"] {
        let mut with = |change: &str, make: &dyn Fn(Case) -> Case| {
            all.push(make(standard(format!("{change}-{id}-{seed}"), vec![Hidden::new(id)], seed)));
        };
        for noise in [70.0, 50.0, 30.0] {
            with(&format!("noise-{noise}"), &|case| Case { noise_db: Some(noise), ..case });
        }
        for rate in [100.0, 250.0] {
            with(&format!("rate-{rate}"), &|case| Case { rate, ..case });
        }
        for clutter in [0, 2] {
            with(&format!("clutter-{clutter}"), &|case| Case { clutter, ..case });
        }
        for nominal_off in [0.1, 0.2] {
            with(&format!("off-{nominal_off}"), &|case| Case { nominal_off, ..case });
        }
        with("no-force-cell", &|case| Case { sensors: Sensors::NoForceCell, ..case });
        with("no-road", &roadless);
        with("poor", &|case| Case { sensors: Sensors::Poor, ..case });
        for (name, size) in [("small", 0.1), ("third", 0.35)] {
            with(name, &|mut case| {
                case.effects[0].size = size;
                Case { ratio: 0.0, ..case }
            });
        }
        with("ratio-10", &|case| Case { ratio: 10.0, ..case });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::catalogue::{Entry, Place};
    use crate::random::Random;
    use crate::rig::{Rig, start};

    #[test]
    fn every_case_has_its_own_name() {
        for list in [compact(), full(1000..1003)] {
            let names: HashSet<&str> = list.iter().map(|case| case.name.as_str()).collect();
            assert_eq!(names.len(), list.len());
        }
    }

    #[test]
    fn every_effect_of_a_case_exists_and_fits_into_its_rig() {
        for case in compact().iter().chain(&full(1000..1001)) {
            for hidden in &case.effects {
                let entry = Entry::find(&hidden.id).unwrap();
                assert_eq!(entry.place == Place::Sensor, !hidden.signal.is_empty());
                let mut rig = Rig::new(case.plant, &start(case.plant));
                let values = entry.draw(&mut Random::new(case.seed, "test"));
                rig.put_in(entry, &values, &hidden.signal).unwrap();
            }
        }
    }

    /// The list that runs each time is not to change under whoever compares two versions with it.
    #[test]
    fn the_compact_list_is_what_it_was() {
        let names = compact().into_iter().map(|case| format!("{}/{}", case.name, case.seed));
        let expected = "\
            single-01/1 single-04/2 single-05/3 single-06/4 single-07/5 single-08/6 single-09/7 single-12/8 \
            single-16/9 single-17/10 single-23/11 single-25/12 pair-01-08/21 unnamed-U1/22 unnamed-U5/37 \
            sensor-34/23 sensor-33/27 sensor-36/28 sensor-40/30 single-26/31 dyno-01/29 servo-28/32 \
            single-26s/39 servo-28h/40 sensor-41h/41 none/24 none-cluttered/25 mismatch/26 drive-02g/33 \
            drive-16/34 drive-27/35 drive-16-33g/36 common-07/1007 behind-18/1012 behind-36/1012 \
            behind-35/1014 resized-02g/1014 noisy-01/1014 driven-U1/1017 answering-U6/1018 servo-26v/44 pump-30p/45 single-03b/42 regulated-16/43 \
            unnamed-U7/46 unnamed-U9/47 unnamed-U10/48 unnamed-U11/49 unnamed-U13/50 mass-none/51 mass-16m/52 mass-08n/53 \
            roadless-01/54 roadless-05/55 roadless-08/56 roadless-12/57 roadless-U1/58 roadless-none/59";
        assert_eq!(names.collect::<Vec<_>>().join(" "), expected);
    }
}
