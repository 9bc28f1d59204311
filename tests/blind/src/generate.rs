//! From a case to its data.

mod excitations;
mod sizing;
mod spring;

use crate::car::{Motion, RATE};
use crate::case::{Case, Generated, Oracle, Plant, Present, Table, Truth, Value};
use crate::catalogue::Entry;
use crate::excitation::Profile;
use crate::random::Random;
use crate::rig::{Rig, signals, start, true_base, true_signal};
use crate::sensors::{Sensor, rms, swing};
use excitations::{Excitation, excitations};
use sizing::Sizing;
use spring::Measured;

/// Makes a case's data.
///
/// # Errors
/// If an effect does not exist or cannot be in the plant; if the case's numbers make no sense.
pub fn generate(case: &Case) -> Result<Generated, String> {
    check(case)?;
    let start = start(case.plant);
    let base = true_base(&start, case.nominal_off, &mut Random::new(case.seed, "base"));
    let mut plain = Rig::new(case.plant, &base);
    plain.seed = case.seed;
    let (train, test) = excitations(case, &plain);
    let (mut rig, mut oracle) = (plain.clone(), plain.clone());
    let sizing = Sizing::new(case, &plain, &base, &train);
    if case.clutter > 0 {
        let level = f64::from(case.clutter);
        rig.clutter_plant(level, &mut Random::new(case.seed, "clutter"));
        rig.clutter_sensors(level, &mut Random::new(case.seed, "clutter of sensors"));
    }
    let (cluttered, sound) = (rig.car.strut.clone(), rig.sensors.clone());
    let mut effects = vec![];
    for number in 0..case.effects.len() {
        let (present, values) = sizing.present(number)?;
        for rig in [&mut rig, &mut oracle] {
            rig.put_in(Entry::find(&present.id)?, &values, &present.signal)?;
        }
        effects.push(present);
    }
    let run = |all: &[Excitation]| -> Vec<Motion> {
        all.iter().map(|it| rig.run(&it.road, &it.command, case.reach(), it.name)).collect()
    };
    let motions = run(&train);
    let added = |x: f64| cluttered.spring(x) - plain.car.strut.spring(x);
    let measured = Measured::new(case, &rig, &motions, added);
    measured.add_to(&mut oracle.car.strut);
    let (noise, tests) = (noise(case, &motions), run(&test));
    for value in &noise {
        if let Some(sensor) = rig.sensors.get_mut(&value.name) {
            sensor.noise = value.value;
        }
    }
    let tables = |all: &[Excitation], motions: &[Motion], purpose: &str| -> Vec<Table> {
        let each = all.iter().zip(motions);
        each.map(|(it, motion)| table(case, &rig, motion, &name(purpose, it))).collect()
    };
    let (train, exact) = (tables(&train, &motions, "train"), test);
    let test = tables(&exact, &tests, "test");
    // Who knows of a fault of an input's sensor takes it back.
    let mut known = rig.clone();
    for (sensor, sound) in known.sensors.values_mut().zip(sound.into_values()) {
        *sensor = Sensor { noise: sensor.noise, ..sound };
    }
    let each = || exact.iter().zip(&tests);
    let recorded: Vec<Excitation> = each().map(|(it, motion)| recorded(case, &known, it, motion)).collect();
    let exact: Vec<Excitation> = each().map(|(it, motion)| commanded(&rig, it, motion)).collect();
    // It is told what was commanded, and commands nothing itself.
    oracle.car.regulator = None;
    oracle.sas.drag = None;
    oracle.pneumatic.control = None;
    let foreseen = |by: &[Excitation]| by.iter().map(|it| foreseen(case, &oracle, it)).collect::<Vec<_>>();
    // A loop has the motor say what the position does: who would foresee both has no error to compare with.
    let oracle = if case.plant == Plant::LinearDrive {
        Oracle::default()
    } else {
        Oracle { recorded: left(&test, &foreseen(&recorded)), exact: left(&test, &foreseen(&exact)) }
    };
    let mut base = changed(base, &effects);
    measured.tell(base.iter_mut().chain(effects.iter_mut().flat_map(|it| &mut it.parameters)));
    Ok(Generated { train, test, start, truth: Truth { case: case.clone(), effects, base, noise, oracle } })
}

/// The nominal parameters with what the effects make of them that are nothing but another value of one.
fn changed(mut base: Vec<Value>, effects: &[Present]) -> Vec<Value> {
    for parameter in effects.iter().flat_map(|effect| &effect.parameters) {
        let added = parameter.name.strip_suffix(".added");
        let name = added.unwrap_or(&parameter.name);
        // What the published rig does not have is the effect's own.
        for value in base.iter_mut().filter(|value| value.table() == name && value.value != 0.0) {
            value.value = match added {
                Some(_) => value.value + parameter.value,
                // All points of a characteristic are as many times as large.
                None if value.name != name => value.value * parameter.value,
                None => parameter.value,
            };
        }
    }
    base
}

/// An excitation with all that was commanded, of what the rig did, too.
fn commanded(rig: &Rig, excitation: &Excitation, motion: &Motion) -> Excitation {
    let mut all = excitation.clone();
    if rig.car.regulator.is_some() || rig.is_braked() || rig.is_looped() {
        all.command = Profile::through(&motion.command, RATE);
    }
    all
}

/// An excitation as its sensors recorded it.
fn recorded(case: &Case, rig: &Rig, excitation: &Excitation, motion: &Motion) -> Excitation {
    let columns = rig.measured(case, motion, &name("test", excitation));
    let through = |number: usize| {
        let (name, _, shown) = &columns[number];
        let rest = true_signal(case.plant, motion, name)[0];
        Profile::through(&shown.iter().map(|x| x - rest).collect::<Vec<_>>(), case.rate)
    };
    let command = match case.plant {
        _ if case.plant.is_commanded() => through(1),
        // Its voltage is all that drives it.
        Plant::PneumaticCylinder => through(0),
        _ => Profile::still(),
    };
    Excitation { name: excitation.name, road: through(0), command }
}

/// A record's name.
fn name(purpose: &str, excitation: &Excitation) -> String {
    format!("{purpose}-{}", excitation.name)
}

/// What a rig shows.
fn foreseen(case: &Case, rig: &Rig, excitation: &Excitation) -> Columns {
    let motion = rig.run(&excitation.road, &excitation.command, case.reach(), excitation.name);
    rig.measured(case, &motion, "oracle")
}

/// Root mean square of what was not foreseen of each column, over all records.
fn left(records: &[Table], foreseen: &[Columns]) -> Vec<Value> {
    let columns = foreseen.first().map_or(&[][..], |it| it.as_slice()).iter().enumerate();
    let of = |number: usize, name: &str| -> Vec<f64> {
        let both = records
            .iter()
            .zip(foreseen)
            .filter_map(|(table, all)| Some((table.column(name)?, &all[number].2)));
        both.flat_map(|(seen, foreseen)| seen.iter().zip(foreseen).map(|(a, b)| a - b)).collect()
    };
    columns
        .map(|(number, (name, unit, _))| Value {
            name: name.clone(),
            unit: unit.clone(),
            value: rms(&of(number, name)),
        })
        .collect()
}

fn check(case: &Case) -> Result<(), String> {
    let divides = case.rate > 0.0 && (RATE / case.rate).fract() == 0.0;
    if !divides || !(40.0..=2000.0).contains(&case.rate) {
        return Err(format!("rate = {} Hz: take one from 40 to 2000 that divides 20000", case.rate));
    }
    if !(case.duration >= 4.0 && case.duration <= 3600.0) {
        return Err(format!("duration = {} s: take 4 to 3600", case.duration));
    }
    if case.clutter > 2 || !(0.0..=0.3).contains(&case.nominal_off) {
        return Err(format!(
            "clutter = {}, nominal_off = {}: take 0, 1 or 2, and 0 to 0.3",
            case.clutter, case.nominal_off
        ));
    }
    Ok(())
}

fn table(case: &Case, rig: &Rig, motion: &Motion, name: &str) -> Table {
    let measured = rig.measured(case, motion, name);
    let count = measured[0].2.len();
    let time = (0..count).map(|k| k as f64 / case.rate).collect();
    let mut columns = vec![("time".to_owned(), "s".to_owned(), time)];
    columns.extend(measured);
    if case.road_velocity && !motion.road_velocity.is_empty() {
        let of = if case.plant.is_car() { "road" } else { "motion" };
        let every = (RATE / case.rate).round() as usize;
        let velocity = motion.road_velocity.iter().step_by(every).take(count).copied().collect();
        columns.push((format!("{of}.velocity"), "m/s".to_owned(), velocity));
    }
    Table { name: name.into(), columns }
}

/// A sensor has the same noise in all records: so many dB below its signal in those to learn from.
fn noise(case: &Case, train: &[Motion]) -> Vec<Value> {
    let Some(noise_db) = case.noise_db else { return vec![] };
    let of = |(name, unit): (&str, &str)| {
        let power: f64 =
            train.iter().map(|motion| swing(&true_signal(case.plant, motion, name)).powi(2)).sum();
        let value = (power / train.len() as f64).sqrt() * 10_f64.powf(-noise_db / 20.0);
        Value { name: name.into(), unit: unit.into(), value }
    };
    signals(case.plant, case.sensors).into_iter().map(of).collect()
}

/// Columns: name, unit, values.
type Columns = Vec<(String, String, Vec<f64>)>;

#[cfg(test)]
mod tests;
