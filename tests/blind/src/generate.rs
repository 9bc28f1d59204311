//! From a case to its data.

use crate::case::{Case, Generated, Plant, Present, Table, Truth, Value};
use crate::catalogue::{Entry, Scale};
use crate::excitation::{Profile, bumps, multisine, prbs, road, sweep, triangle};
use crate::random::Random;
use crate::rig::{Rig, difference, signals, start, true_base, true_signal};
use crate::sensors::rms;

/// Standard gravity, in m/s².
const GRAVITY: f64 = 9.806_65;

/// A record to be made.
struct Excitation {
    name: &'static str,
    road: Profile,
    force: Profile,
}

/// Makes a case's data.
///
/// # Errors
/// If an effect does not exist or cannot be in the plant; if the case's numbers make no sense.
pub fn generate(case: &Case) -> Result<Generated, String> {
    check(case)?;
    let start = start(case.plant);
    let base = true_base(&start, case.nominal_off, &mut Random::new(case.seed, "base"));
    let plain = Rig::new(case.plant, &base);
    let (train, test) = excitations(case, &plain);
    let (mut rig, mut oracle) = (plain.clone(), plain.clone());
    let sizing = Sizing::new(case, &plain, &train);
    if case.clutter > 0 {
        let level = f64::from(case.clutter);
        rig.clutter_plant(level, &mut Random::new(case.seed, "clutter"));
        rig.clutter_sensors(level, &mut Random::new(case.seed, "clutter of sensors"));
    }
    let mut effects = vec![];
    for number in 0..case.effects.len() {
        let (present, values) = sizing.present(number)?;
        for rig in [&mut rig, &mut oracle] {
            rig.put_in(Entry::find(&present.id)?, &values, &present.signal)?;
        }
        effects.push(present);
    }
    let noise = set_noise(case, &mut rig, &train);
    let tables = |all: &[Excitation], purpose: &str| {
        all.iter().map(|excitation| table(case, &rig, excitation, purpose)).collect()
    };
    let foreseen: Vec<Columns> = test.iter().map(|it| foreseen(case, &oracle, it)).collect();
    let (train, test): (Vec<Table>, Vec<Table>) = (tables(&train, "train"), tables(&test, "test"));
    let oracle = left(&test, &foreseen);
    Ok(Generated { train, test, start, truth: Truth { case: case.clone(), effects, base, noise, oracle } })
}

/// What a rig shows.
fn foreseen(case: &Case, rig: &Rig, excitation: &Excitation) -> Columns {
    let motion = rig.run(&excitation.road, &excitation.force, case.duration);
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
    let divides = case.rate > 0.0 && (crate::car::RATE / case.rate).fract() == 0.0;
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

fn excitations(case: &Case, plain: &Rig) -> (Vec<Excitation>, Vec<Excitation>) {
    let random = &mut Random::new(case.seed, "excitation");
    let time = case.duration;
    let mut all = match case.plant {
        Plant::StrutDyno => [
            ("multisine", multisine(random, time, 1.3, 0.015), Profile::still()),
            (
                "triangle",
                triangle(time, 4.0, 0.012).plus(&multisine(random, time, 1.3, 0.003)),
                Profile::still(),
            ),
            ("bumps", bumps(random, time, 0.015), Profile::still()),
            ("road", road(random, time, 0.015), Profile::still()),
            ("sweep", sweep(time, 1.0, 0.012), Profile::still()),
        ],
        Plant::LinearQuarter | Plant::PublishedQuarter => [
            ("multisine", multisine(random, time, 0.5, 0.010), Profile::still()),
            ("prbs", multisine(random, time, 0.5, 0.005), prbs(random, time, 0.025, 150.0)),
            ("bumps", bumps(random, time, 0.010), multisine(random, time, 0.3, 120.0)),
            ("road", road(random, time, 0.010), Profile::still()),
            ("sweep", Profile::still(), sweep(time, 0.0, 150.0)),
        ],
    }
    .map(|(name, road, force)| Excitation { name, road, force });
    if case.plant != Plant::StrutDyno {
        let lifting = case.effects.iter().any(|hidden| hidden.id == "20");
        for excitation in &mut all {
            limit_pull(case, plain, excitation, lifting);
        }
    }
    let mut train = Vec::from(all);
    let test = train.split_off(2);
    (train, test)
}

/// Scales the road such that the tyre keeps a fifth of its static load, or, if it shall leave the road, such that
/// the wheel flies well above it.
fn limit_pull(case: &Case, plain: &Rig, excitation: &mut Excitation, lifting: bool) {
    if excitation.road.is_still() {
        return;
    }
    let car = &plain.car;
    let load = (car.sprung_mass + car.unsprung_mass) * GRAVITY;
    // Several times, as the relation is not linear: a wheel in the air flies far.
    for _ in 0..8 {
        let motion = plain.run(&excitation.road, &excitation.force, case.duration);
        let pull = motion.road.iter().zip(&motion.wheel).fold(0.0_f64, |most, (z, w)| most.max(w - z));
        let share = pull * car.tire_stiffness / load;
        let factor = match () {
            () if lifting && !(1.2..2.5).contains(&share) => (1.6 / share).sqrt().clamp(0.7, 2.0),
            () if !lifting && share > 0.8 => 0.75 / share,
            () => break,
        };
        excitation.road = excitation.road.scaled(factor);
    }
}

fn table(case: &Case, rig: &Rig, excitation: &Excitation, purpose: &str) -> Table {
    let name = format!("{purpose}-{}", excitation.name);
    let motion = rig.run(&excitation.road, &excitation.force, case.duration);
    let measured = rig.measured(case, &motion, &name);
    let count = measured[0].2.len();
    let time = (0..count).map(|k| k as f64 / case.rate).collect();
    let mut columns = vec![("time".to_owned(), "s".to_owned(), time)];
    columns.extend(measured);
    if case.road_velocity {
        let of = if case.plant == Plant::StrutDyno { "motion" } else { "road" };
        let every = motion.road_velocity.len().saturating_sub(1) / (count - 1);
        let velocity = motion.road_velocity.iter().step_by(every).copied().collect();
        columns.push((format!("{of}.velocity"), "m/s".to_owned(), velocity));
    }
    Table { name, columns }
}

/// A sensor has the same noise in all records: so many dB below its signal in those to learn from.
fn set_noise(case: &Case, rig: &mut Rig, train: &[Excitation]) -> Vec<Value> {
    let Some(noise_db) = case.noise_db else { return vec![] };
    let motions: Vec<_> = train.iter().map(|e| rig.run(&e.road, &e.force, case.duration)).collect();
    let mut all = vec![];
    for (name, unit) in signals(case.plant, case.sensors) {
        let power: f64 = motions.iter().map(|motion| rms(&true_signal(motion, name)).powi(2)).sum();
        let noise = (power / motions.len() as f64).sqrt() * 10_f64.powf(-noise_db / 20.0);
        if let Some(sensor) = rig.sensors.get_mut(name) {
            sensor.noise = noise;
        }
        all.push(Value { name: name.into(), unit: unit.into(), value: noise });
    }
    all
}

/// Columns: name, unit, values.
type Columns = Vec<(String, String, Vec<f64>)>;

/// Finds how large the effects must be.
struct Sizing<'a> {
    case: &'a Case,
    plain: &'a Rig,
    train: &'a [Excitation],
    /// What is seen in each record without clutter and effects.
    seen: Vec<Columns>,
    /// Largest deflection and travel of the wheel.
    largest: (f64, f64),
    /// What the clutter of the plant changes.
    clutter: f64,
}

impl<'a> Sizing<'a> {
    fn new(case: &'a Case, plain: &'a Rig, train: &'a [Excitation]) -> Self {
        let mut sizing = Self { case, plain, train, seen: vec![], largest: (0.0, 0.0), clutter: 0.0 };
        let dyno = case.plant == Plant::StrutDyno;
        let deflection = if dyno { "motion.position" } else { "suspension.deflection" };
        let most = |signal: &[f64]| signal.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for excitation in train {
            let motion = plain.run(&excitation.road, &excitation.force, case.duration);
            let reached = (most(&true_signal(&motion, deflection)), most(&motion.wheel));
            sizing.largest = (sizing.largest.0.max(reached.0), sizing.largest.1.max(reached.1));
            sizing.seen.push(plain.measured(case, &motion, "sizing"));
        }
        if case.clutter > 0 && !case.effects.is_empty() {
            let mut cluttered = plain.clone();
            cluttered.clutter_plant(f64::from(case.clutter), &mut Random::new(case.seed, "clutter"));
            sizing.clutter = sizing.changed(&cluttered);
        }
        sizing
    }

    /// What another rig than the plain one changes, in the record that shows it best.
    fn changed(&self, rig: &Rig) -> f64 {
        self.train.iter().zip(&self.seen).fold(0.0, |most: f64, (excitation, seen)| {
            let motion = rig.run(&excitation.road, &excitation.force, self.case.duration);
            most.max(difference(seen, &rig.measured(self.case, &motion, "sizing")))
        })
    }

    /// The effect with this number in the case, its values and what it changes over what the clutter changes.
    fn present(&self, number: usize) -> Result<(Present, Vec<f64>), String> {
        let hidden = &self.case.effects[number];
        let entry = Entry::find(&hidden.id)?;
        let drawn = entry.draw(&mut Random::new(self.case.seed, &format!("effect {number}: {}", hidden.id)));
        let seen = self.seen[0].iter().find(|column| column.0 == hidden.signal);
        let signal = seen.map_or(0.0, |column| rms(&column.2));
        let sized = |size: f64| -> Vec<f64> {
            let value = |(parameter, value): (&crate::catalogue::Drawn, &f64)| {
                let scale = match parameter.scale {
                    Scale::Unit => 1.0,
                    Scale::Deflection => self.largest.0,
                    Scale::Travel => self.largest.1,
                    Scale::Signal => signal,
                };
                scale * parameter.sized(*value, size)
            };
            entry.parameters.iter().zip(&drawn).map(value).collect()
        };
        let mut size = hidden.size;
        let mut ratio = None;
        // Enlarged until it is seen enough; its bounds may end that before.
        for _ in 0..5 {
            let mut rig = self.plain.clone();
            rig.put_in(entry, &sized(size), &hidden.signal)?;
            if self.clutter == 0.0 {
                break;
            }
            let changed = self.changed(&rig);
            ratio = Some(changed / self.clutter);
            let missing = self.case.ratio * self.clutter / changed.max(1e-9);
            if missing <= 1.0 || entry.parameters.is_empty() {
                break;
            }
            size *= (1.1 * missing).clamp(1.1, 4.0);
        }
        let values = sized(size);
        let of_sensor = !hidden.signal.is_empty();
        let named = entry.parameters.iter().zip(&values).map(|(parameter, value)| {
            let unit = seen.map_or("", |column| column.1.as_str());
            let name = if of_sensor {
                format!("{}.{}", hidden.signal, parameter.name)
            } else {
                parameter.name.into()
            };
            let scaled = parameter.scale == Scale::Signal;
            let unit = if scaled { format!("{unit}{}", parameter.unit) } else { parameter.unit.into() };
            Value { name, unit, value: *value }
        });
        let present = Present {
            id: entry.id.into(),
            name: entry.name.into(),
            place: entry.place,
            signal: hidden.signal.clone(),
            variable: entry.variable.into(),
            parameters: named.collect(),
            ratio,
        };
        Ok((present, values))
    }
}

#[cfg(test)]
mod tests;
