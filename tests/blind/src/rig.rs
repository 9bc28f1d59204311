//! A rig with its sensors: base parameters, clutter and effects put together.

use std::collections::BTreeMap;

use crate::car::{Actuator, Car, Motion};
use crate::case::{Case, Plant, Sensors, Value};
use crate::catalogue::Entry;
use crate::dyno;
use crate::excitation::Profile;
use crate::friction::{Contact, Limit};
use crate::random::Random;
use crate::sensors::Sensor;
use crate::strut::{Hump, Strut};

/// Between body and wheel.
const STRUT: [f64; 2] = [1.0, -1.0];
/// Between body and ground.
const GUIDE: [f64; 2] = [1.0, 0.0];
/// Between wheel and ground.
const WHEEL_GUIDE: [f64; 2] = [0.0, 1.0];

/// The published parameters: TUM Table 10; damping 2 ζ √(c m) with ζ = 0.397, asymmetry from Table 9.
const PUBLISHED: [(&str, &str, f64); 10] = [
    ("sprung_mass", "kg", 94.38),
    ("unsprung_mass", "kg", 23.92),
    ("strut.stiffness", "N/m", 8400.0),
    ("strut.damping", "N.s/m", 707.0),
    ("strut.asymmetry.ratio", "1", 0.312_211_221_122_112_2),
    ("strut.coulomb.force", "N", 115.0),
    ("guide.coulomb.force", "N", 20.0),
    ("tire.stiffness", "N/m", 152_140.0),
    ("tire.quadratic", "N/m2", 4_075_400.0),
    ("tire.damping", "N.s/m", 50.0),
];

/// What the linear rigs do not have.
const BEYOND_LINEAR: [&str; 4] =
    ["strut.asymmetry.ratio", "strut.coulomb.force", "guide.coulomb.force", "tire.quadratic"];

/// Parameters that the model of a plant starts with.
pub fn start(plant: Plant) -> Vec<Value> {
    let wanted = |name: &str| match plant {
        Plant::LinearQuarter | Plant::PublishedQuarter => true,
        Plant::StrutDyno => name.starts_with("strut."),
    };
    let value = |(name, unit, value): (&str, &str, f64)| {
        let off = plant != Plant::PublishedQuarter && BEYOND_LINEAR.contains(&name);
        Value { name: name.into(), unit: unit.into(), value: if off { 0.0 } else { value } }
    };
    PUBLISHED.into_iter().filter(|(name, ..)| wanted(name)).map(value).collect()
}

/// A rig with its sensors.
#[derive(Clone, Debug)]
pub struct Rig {
    plant: Plant,
    /// The moving parts; of a dyno only the strut and its contacts count.
    pub car: Car,
    /// Of each signal.
    pub sensors: BTreeMap<String, Sensor>,
}

/// Signals and their units, inputs first.
pub fn signals(plant: Plant, sensors: Sensors) -> Vec<(&'static str, &'static str)> {
    if plant == Plant::StrutDyno {
        return vec![("motion.position", "m"), ("force", "N")];
    }
    let mut all = vec![("road.position", "m"), ("actuator.force", "N"), ("body.acceleration", "m/s2")];
    if sensors != Sensors::Poor {
        all.push(("wheel.acceleration", "m/s2"));
    }
    all.push(("suspension.deflection", "m"));
    if sensors == Sensors::Full {
        all.push(("wheel.force", "N"));
    }
    all
}

/// A signal without its sensor.
pub fn true_signal(motion: &Motion, name: &str) -> Vec<f64> {
    match name {
        "road.position" | "motion.position" => motion.road.clone(),
        "actuator.force" => motion.command.clone(),
        "body.acceleration" => motion.body_acceleration.clone(),
        "wheel.acceleration" => motion.wheel_acceleration.clone(),
        "suspension.deflection" => motion.body.iter().zip(&motion.wheel).map(|(z, w)| z - w).collect(),
        // Of the rig's tyre, or of the dyno's end.
        _ => motion.tire_force.clone(),
    }
}

impl Rig {
    /// With given base parameters and perfect sensors.
    pub fn new(plant: Plant, base: &[Value]) -> Self {
        let of = |name: &str| base.iter().find(|v| v.name == name).map_or(0.0, |v| v.value);
        let mut car = Car {
            sprung_mass: of("sprung_mass"),
            unsprung_mass: of("unsprung_mass"),
            strut: Strut {
                stiffness: of("strut.stiffness"),
                damping: of("strut.damping"),
                asymmetry: of("strut.asymmetry.ratio"),
                ..Strut::default()
            },
            tire_stiffness: of("tire.stiffness"),
            tire_quadratic: of("tire.quadratic"),
            tire_damping: of("tire.damping"),
            actuator: Actuator::default(),
            ..Car::default()
        };
        for (along, name) in [(STRUT, "strut.coulomb.force"), (GUIDE, "guide.coulomb.force")] {
            if of(name) > 0.0 {
                car.contacts.push(Contact { along, limit: Limit::Coulomb(of(name)) });
            }
        }
        let sensors = signals(plant, Sensors::Full).into_iter();
        let sensors = sensors.map(|(name, _)| (name.to_owned(), Sensor::default())).collect();
        Self { plant, car, sensors }
    }

    /// Adds the small effects that no model knows, `level` times.
    pub fn clutter_plant(&mut self, level: f64, random: &mut Random) {
        let strut = &mut self.car.strut;
        strut.maxwell[1] = Some((level * random.between(1000.0, 2500.0), random.between(0.005, 0.015)));
        strut.cubic += level * random.between(1e6, 4e6);
        strut.cogging = Some((level * random.between(1.0, 4.0), random.between(0.01, 0.03), random.phase()));
    }

    /// Makes the sensors as slow and as late as such sensors are, `level` times.
    pub fn clutter_sensors(&mut self, level: f64, random: &mut Random) {
        for (name, sensor) in &mut self.sensors {
            sensor.skew += level * random.sign() * random.between(1e-4, 4e-4);
            if name.ends_with("acceleration") {
                sensor.bandwidth = level / (std::f64::consts::TAU * 200.0);
            }
        }
    }

    /// Puts an effect in.
    ///
    /// # Errors
    /// If the plant or its sensors cannot have it.
    pub fn put_in(&mut self, entry: &Entry, values: &[f64], signal: &str) -> Result<(), String> {
        let known: &[&str] = match self.plant {
            Plant::LinearQuarter => &[],
            Plant::PublishedQuarter => &["01", "02", "04", "16", "19"],
            Plant::StrutDyno => {
                &["13", "14", "15", "16", "17", "19", "20", "21", "23", "24", "25", "42", "U4"]
            }
        };
        if known.contains(&entry.id) {
            return Err(format!(
                "effect {} cannot be hidden in {:?}: hide it in another plant",
                entry.id, self.plant
            ));
        }
        let strut = &mut self.car.strut;
        let first = values.first().copied().unwrap_or_default();
        let hump = |values: &[f64]| Hump { height: values[0], centre: values[1], width: values[2] };
        let contact = |along, limit| Contact { along, limit };
        match entry.id {
            "01" => self.car.contacts.push(contact(STRUT, Limit::Coulomb(first))),
            "02" => {
                let limit =
                    Limit::Stribeck { at_rest: first + values[1], sliding: first, velocity: values[2] };
                self.car.contacts.push(contact(STRUT, limit));
            }
            "03" => strut.bristles = Some((first, values[1], 0.0)),
            "04" => strut.asymmetry = first,
            "05" => strut.knee = Some((values[1], first)),
            "06" => strut.orifice = first,
            "07" => strut.maxwell[0] = Some((first, values[1])),
            "08" => (strut.quadratic, strut.cubic) = (first, strut.cubic + values[1]),
            "09" => strut.stop = Some((values[1], first)),
            "10" => strut.fade = Some((first, values[1])),
            "12" => strut.bush = Some((first, 1.0 / values[1])),
            "13" => strut.bush = Some((0.0, 1.0 / first)),
            "14" => strut.linkage = first,
            "15" => self.car.guide_damping = first,
            "16" => self.car.contacts.push(contact(GUIDE, Limit::Coulomb(first))),
            "17" => self.car.contacts.push(contact(WHEEL_GUIDE, Limit::Coulomb(first))),
            "19" => self.car.tire_quadratic = first,
            // The tyre never pulls; whether it leaves the road is a matter of the excitation.
            "20" => {}
            "21" => self.car.tire_damping += first,
            "23" => self.car.actuator.delay = first,
            "24" => self.car.actuator.lag = first,
            "25" => self.car.actuator.gain = first,
            "32" => strut.yielding = Some((first, values[1], values[2])),
            "U1" => strut.hump = Some(hump(values)),
            "U2" => strut.thick_spot = Some(hump(values)),
            "U3" => self.car.contacts.push(contact(STRUT, Limit::Growing(first))),
            "U4" => {
                let limit = Limit::Periodic { force: first, period: values[1] };
                self.car.contacts.push(contact(WHEEL_GUIDE, limit));
            }
            _ => return self.put_in_sensor(entry, values, signal),
        }
        Ok(())
    }

    fn put_in_sensor(&mut self, entry: &Entry, values: &[f64], signal: &str) -> Result<(), String> {
        let known: Vec<String> = self.sensors.keys().cloned().collect();
        let sensor = self.sensors.get_mut(signal).ok_or_else(|| {
            format!(
                "effect {} sits in a sensor, `{signal}` is none; there are {}",
                entry.id,
                known.join(", ")
            )
        })?;
        for (drawn, value) in entry.parameters.iter().zip(values) {
            match drawn.name {
                "offset" => sensor.offset = *value,
                "drift" => sensor.drift = *value,
                "gain" => sensor.gain = *value,
                "lag" => sensor.lag = *value,
                "skew" => sensor.skew += value,
                "quantum" => sensor.quantum = *value,
                "range" => sensor.range = *value,
                _ => sensor.dropout = *value,
            }
        }
        Ok(())
    }

    /// What the parts do under an excitation.
    pub fn run(&self, road: &Profile, force: &Profile, duration: f64) -> Motion {
        match self.plant {
            Plant::LinearQuarter | Plant::PublishedQuarter => self.car.run(road, force, duration, [0.0; 4]),
            Plant::StrutDyno => {
                let limits: Vec<Limit> = self.car.contacts.iter().map(|contact| contact.limit).collect();
                dyno::run(&self.car.strut, &limits, road, duration)
            }
        }
    }

    /// What the sensors show of it: one column for each wanted signal, noise from the stream of `record`.
    pub fn measured(&self, case: &Case, motion: &Motion, record: &str) -> Vec<(String, String, Vec<f64>)> {
        let wanted = signals(case.plant, case.sensors).into_iter();
        let column = |(name, unit): (&str, &str)| {
            let mut noise = Random::new(case.seed, &format!("noise of {name} in {record}"));
            let shown = self.sensors[name].measure(&true_signal(motion, name), case.rate, &mut noise);
            (name.to_owned(), unit.to_owned(), shown)
        };
        wanted.map(column).collect()
    }
}

/// The true base parameters: those of `start`, off by a share of `off`, at most twice that.
pub fn true_base(start: &[Value], off: f64, random: &mut Random) -> Vec<Value> {
    let mut base = start.to_vec();
    for value in &mut base {
        value.value *= 1.0 + off * random.normal().clamp(-2.0, 2.0);
    }
    base
}

/// How much of the measured signals two runs disagree on: the largest rms of a difference over the rms.
pub fn difference(one: &[(String, String, Vec<f64>)], other: &[(String, String, Vec<f64>)]) -> f64 {
    use crate::sensors::rms;
    one.iter().zip(other).fold(0.0, |most: f64, (a, b)| {
        let apart: Vec<f64> = a.2.iter().zip(&b.2).map(|(x, y)| x - y).collect();
        let size = rms(&a.2);
        if size > 0.0 { most.max(rms(&apart) / size) } else { most }
    })
}
