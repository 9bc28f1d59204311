//! A car on four wheels with one cause at a corner, at both corners of an axle, or at all: own equations, integrated at 20 kHz.

mod page;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::car::RATE;
use crate::case::{Table, Value};
use crate::excitation::{Profile, road};
use crate::random::Random;
use crate::sensors::Sensor;

pub use page::{judged, page, worse};

/// The corners, as the model calls them.
const CORNERS: [&str; 4] = ["front_left", "front_right", "rear_left", "rear_right"];
/// Where they are: forwards and to the left of the centre of mass, in m.
const PLACES: [[f64; 2]; 4] = [[1.35, 0.78], [1.35, -0.78], [-1.35, 0.78], [-1.35, -0.78]];
/// Length of each record in s.
const DURATION: f64 = 30.0;
/// Samples a second of a record.
const SAMPLED: f64 = 1000.0;
/// Time in s by which the rear wheels meet what the front wheels have met: 2.7 m at 8 m/s.
const LATER: f64 = 0.3375;
/// Largest height of the road in m, in the estimation and in the validation record.
const HEIGHTS: [f64; 2] = [0.025, 0.03];
/// Noise, in shares of each signal's root mean square: 40 dB below it.
const NOISE: f64 = 0.01;
/// That of the roads: 60 dB. At 40 dB, the tyres make about as much force of it as the causes do.
const ROAD_NOISE: f64 = 0.001;
/// Share of some signal's root mean square that a cause changes at least. It is enlarged until it does.
const VISIBLE: f64 = 0.1;
/// How much of a record is looked at for that, in s.
const LOOK: f64 = 8.0;
/// Velocity in m/s within which friction turns over.
const STICKS: f64 = 1e-3;

/// A cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Coulomb friction of a strut.
    Friction,
    /// A strut's damper that is stronger in rebound.
    Asymmetry,
    /// A strut's spring that grows stiffer.
    CubicSpring,
    /// A tyre that grows stiffer.
    ProgressiveTire,
}

/// A cause and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hidden {
    /// The cause.
    pub law: Law,
    /// `rear_left`, `front`, `all`.
    pub place: String,
}

/// A car, its parts in the order of [`CORNERS`].
#[derive(Clone, Debug)]
struct Car {
    mass: f64,
    inertia: [f64; 2],
    wheel: f64,
    stiffness: [f64; 4],
    damping: [f64; 4],
    tire: [f64; 4],
    friction: [f64; 4],
    asymmetry: [f64; 4],
    cubic: [f64; 4],
    progressive: [f64; 4],
}

/// Heave, roll and pitch, then the wheels: positions; the same: velocities.
type State = [[f64; 7]; 2];

/// Measured signals, without the roads.
struct Shown {
    body: [f64; 3],
    wheels: [f64; 4],
    deflections: [f64; 4],
    forces: [f64; 4],
}

impl Law {
    const ALL: [Self; 4] = [Self::Friction, Self::Asymmetry, Self::CubicSpring, Self::ProgressiveTire];

    /// Number and element in the diagnosis's catalogue.
    fn named(self) -> (&'static str, &'static str) {
        match self {
            Self::Friction => ("01", "strut"),
            Self::Asymmetry => ("04", "strut"),
            Self::CubicSpring => ("08", "strut"),
            Self::ProgressiveTire => ("19", "tire"),
        }
    }
}

impl Hidden {
    /// Number and element as a report names them.
    pub fn named(&self) -> String {
        let (id, element) = self.law.named();
        format!("{id} {element}.{}", self.place)
    }

    fn is_at(&self, corner: usize) -> bool {
        let name = CORNERS[corner];
        self.place == "all" || self.place == name || name.split_once('_').is_some_and(|it| it.0 == self.place)
    }
}

impl Car {
    /// With the published values.
    fn published() -> Self {
        Self {
            mass: 1400.0,
            inertia: [500.0, 2300.0],
            wheel: 40.0,
            stiffness: [20e3; 4],
            damping: [1400.0; 4],
            tire: [200e3; 4],
            friction: [0.0; 4],
            asymmetry: [0.0; 4],
            cubic: [0.0; 4],
            progressive: [0.0; 4],
        }
    }

    /// One that is a few per cent off, with a cause.
    fn real(seed: u64, hidden: Option<&Hidden>) -> Self {
        let mut random = Random::new(seed, "car");
        let mut car = Self::published();
        let mut off = |value: &mut f64| *value *= 1.0 + 0.04 * random.normal();
        [&mut car.mass].into_iter().chain(&mut car.inertia).for_each(&mut off);
        let parts = car.stiffness.iter_mut().chain(&mut car.damping).chain(&mut car.tire);
        parts.for_each(off);
        let Some(hidden) = hidden else { return car };
        let tracks = tracks(seed, "train", HEIGHTS[0]);
        let shown = |car: &Self| car.run(&tracks, LOOK);
        let without = shown(&car);
        let mut size = 1.0;
        loop {
            let with = car.with(hidden, size);
            let both = shown(&with).into_iter().zip(&without);
            let changed = both.map(|(with, without)| {
                let apart: Vec<f64> = with.iter().zip(without).map(|(a, b)| a - b).collect();
                rms(&apart) / rms(without)
            });
            // Roads are not changed.
            if changed.fold(0.0, f64::max) >= VISIBLE {
                return with;
            }
            size *= 1.25;
        }
    }

    /// The same with a cause, `size` times a small one.
    fn with(&self, hidden: &Hidden, size: f64) -> Self {
        let mut car = self.clone();
        let (amounts, small) = car.amounts(hidden.law);
        (0..4).filter(|it| hidden.is_at(*it)).for_each(|it| amounts[it] = small * size);
        car
    }

    /// The amounts of a law at the corners, and a small one: N, a share, N/m³ or N/m².
    fn amounts(&mut self, law: Law) -> (&mut [f64; 4], f64) {
        match law {
            Law::Friction => (&mut self.friction, 10.0),
            Law::Asymmetry => (&mut self.asymmetry, 0.05),
            Law::CubicSpring => (&mut self.cubic, 5e6),
            Law::ProgressiveTire => (&mut self.progressive, 1e6),
        }
    }

    /// The largest amount of a law.
    fn amount(&self, law: Law) -> f64 {
        self.clone().amounts(law).0.iter().copied().fold(0.0, f64::max)
    }

    fn rates(&self, state: &State, roads: [f64; 4]) -> (State, Shown) {
        let [[heave, roll, pitch, ..], [rise, roll_rate, pitch_rate, ..]] = *state;
        let mut shown = Shown { body: [0.0; 3], wheels: [0.0; 4], deflections: [0.0; 4], forces: [0.0; 4] };
        for (corner, [x, y]) in PLACES.into_iter().enumerate() {
            let deflection = heave + y * roll - x * pitch - state[0][3 + corner];
            let velocity = rise + y * roll_rate - x * pitch_rate - state[1][3 + corner];
            let strut = deflection * (self.stiffness[corner] + self.cubic[corner] * deflection * deflection)
                + self.damping[corner] * (velocity + self.asymmetry[corner] * velocity.abs())
                + self.friction[corner] * (velocity / STICKS).tanh();
            let compression = roads[corner] - state[0][3 + corner];
            let tire = compression * (self.tire[corner] + self.progressive[corner] * compression);
            shown.body[0] -= strut / self.mass;
            shown.body[1] -= y * strut / self.inertia[0];
            shown.body[2] += x * strut / self.inertia[1];
            shown.wheels[corner] = (strut + tire) / self.wheel;
            (shown.deflections[corner], shown.forces[corner]) = (deflection, tire);
        }
        let mut accelerations = [0.0; 7];
        accelerations[..3].copy_from_slice(&shown.body);
        accelerations[3..].copy_from_slice(&shown.wheels);
        ([state[1], accelerations], shown)
    }

    /// One step of the classical Runge–Kutta method, and the measured signals at its beginning.
    fn stepped(&self, state: &State, roads: impl Fn(f64) -> [f64; 4]) -> (State, Shown) {
        let h = 1.0 / RATE;
        let along = |rates: &State, by: f64| -> State {
            std::array::from_fn(|k| std::array::from_fn(|i| state[k][i] + by * rates[k][i]))
        };
        let (first, shown) = self.rates(state, roads(0.0));
        let (second, _) = self.rates(&along(&first, 0.5 * h), roads(0.5 * h));
        let (third, _) = self.rates(&along(&second, 0.5 * h), roads(0.5 * h));
        let (last, _) = self.rates(&along(&third, h), roads(h));
        let mean = std::array::from_fn(|k| {
            std::array::from_fn(|i| (first[k][i] + 2.0 * (second[k][i] + third[k][i]) + last[k][i]) / 6.0)
        });
        (along(&mean, h), shown)
    }

    /// All signals on two tracks, at every step: roads, body, wheels, deflections, forces.
    fn run(&self, tracks: &[Profile; 2], duration: f64) -> Vec<Vec<f64>> {
        let roads = |time: f64| -> [f64; 4] {
            std::array::from_fn(|corner| tracks[corner % 2].at(time - LATER * (corner / 2) as f64).0)
        };
        let samples = (duration * RATE) as usize + 1;
        let mut signals: Vec<Vec<f64>> = std::iter::repeat_n(Vec::with_capacity(samples), 19).collect();
        let mut state: State = [[0.0; 7]; 2];
        for step in 0..samples {
            let time = step as f64 / RATE;
            let (next, shown) = self.stepped(&state, |after| roads(time + after));
            let parts = [&roads(time)[..], &shown.body, &shown.wheels, &shown.deflections, &shown.forces];
            signals.iter_mut().zip(parts.concat()).for_each(|(signal, value)| signal.push(value));
            state = next;
        }
        signals
    }

    /// A record on two tracks of this height in m.
    fn record(&self, seed: u64, purpose: &str, height: f64) -> Table {
        let signals = self.run(&tracks(seed, purpose, height), DURATION);
        let at = |name: fn(&str) -> String| CORNERS.map(name);
        let mut names: Vec<(String, &str)> =
            at(|it| format!("road.{it}.position")).into_iter().map(|it| (it, "m")).collect();
        names.push(("heave.acceleration".into(), "m/s2"));
        names.extend(["roll.acceleration", "pitch.acceleration"].map(|it| (it.to_owned(), "rad/s2")));
        names.extend(at(|it| format!("wheel.{it}.acceleration")).map(|it| (it, "m/s2")));
        names.extend(at(|it| format!("suspension.{it}.deflection")).map(|it| (it, "m")));
        names.extend(at(|it| format!("wheel.{it}.force")).map(|it| (it, "N")));
        let column = |((name, unit), signal): ((String, &str), Vec<f64>)| {
            let mut random = Random::new(seed, &format!("noise of {name} in {purpose}"));
            let share = if name.starts_with("road.") { ROAD_NOISE } else { NOISE };
            let sensor = Sensor { noise: share * rms(&signal), ..Sensor::default() };
            let mut shown = sensor.measure(&signal, SAMPLED, &mut random);
            shown.truncate((DURATION * SAMPLED) as usize + 1);
            (name, unit.to_owned(), shown)
        };
        let mut columns: Vec<_> = names.into_iter().zip(signals).map(column).collect();
        let time = (0..columns[0].2.len()).map(|k| k as f64 / SAMPLED).collect();
        columns.insert(0, ("time".into(), "s".into(), time));
        Table { name: purpose.into(), columns }
    }

    /// Its values as a parameter set has them.
    fn values(&self) -> Vec<Value> {
        let value = |name: String, unit: &str, value: f64| Value { name, unit: unit.into(), value };
        let mut all = vec![
            value("sprung_mass".into(), "kg", self.mass),
            value("roll_inertia".into(), "kg.m2", self.inertia[0]),
            value("pitch_inertia".into(), "kg.m2", self.inertia[1]),
        ];
        all.extend(["front", "rear"].map(|it| value(format!("unsprung_mass.{it}"), "kg", self.wheel)));
        for (corner, name) in CORNERS.into_iter().enumerate() {
            all.extend([
                value(format!("strut.{name}.stiffness"), "N/m", self.stiffness[corner]),
                value(format!("strut.{name}.damping"), "N.s/m", self.damping[corner]),
                value(format!("tire.{name}.stiffness"), "N/m", self.tire[corner]),
                value(format!("tire.{name}.damping"), "N.s/m", 0.0),
            ]);
        }
        all
    }
}

/// The left and the right track of a record, of this height in m.
fn tracks(seed: u64, purpose: &str, height: f64) -> [Profile; 2] {
    ["left", "right"]
        .map(|side| road(&mut Random::new(seed, &format!("{side} track in {purpose}")), DURATION, height))
}

/// Root mean square.
fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|it| it * it).sum::<f64>() / signal.len() as f64).sqrt()
}

/// The cars of the list, by their seeds: `seeds` with one cause at one corner, then one with a cause at an axle, one at all
/// corners, and one with none.
pub fn list(seeds: u64) -> Vec<(u64, Option<Hidden>)> {
    let single = (1..=seeds).map(|seed| {
        let corner = (Random::new(seed, "corner").unit() * 4.0) as usize;
        (seed, Some(Hidden { law: Law::ALL[seed as usize % 4], place: CORNERS[corner.min(3)].into() }))
    });
    let at = |law: Law, place: &str| Some(Hidden { law, place: place.into() });
    let several = [at(Law::CubicSpring, "front"), at(Law::Friction, "all"), None];
    single.chain((seeds + 1..).zip(several)).collect()
}

/// Writes a car's records and its published values to a folder.
fn write(car: &Car, seed: u64, folder: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{} cannot be written: {error}", folder.display());
    fs::create_dir_all(folder).map_err(failed)?;
    for (purpose, height) in ["train", "test"].into_iter().zip(HEIGHTS) {
        let table = car.record(seed, purpose, height);
        fs::write(folder.join(format!("{purpose}.csv")), table.csv()).map_err(failed)?;
    }
    let mut text = "fmu = \"BlindCar\"\nmodel = \"FullCar\"\ntitle = \"Published values of a car\"\nsource = \"start\"\n\n\
                    [values]\ntire.lift_off = { value = false, source = \"start\" }\n"
        .to_owned();
    for Value { name, unit, value } in Car::published().values() {
        let _ = writeln!(text, "{name} = {{ value = {value:?}, unit = \"{unit}\", source = \"start\" }}");
    }
    fs::write(folder.join("start.toml"), text).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_where_it_is_hidden() {
        let hidden = Hidden { law: Law::Friction, place: "rear".into() };
        assert_eq!(Car::published().with(&hidden, 2.0).friction, [0.0, 0.0, 20.0, 20.0]);
        assert_eq!(hidden.named(), "01 strut.rear");
        let all = Hidden { law: Law::ProgressiveTire, place: "all".into() };
        assert_eq!(Car::published().with(&all, 3.0).progressive, [3e6; 4]);
        let list = list(10);
        assert_eq!((list.len(), list[12].1.is_none()), (13, true));
        assert!(
            list[..10]
                .iter()
                .all(|(_, it)| it.as_ref().is_some_and(|it| CORNERS.contains(&it.place.as_str())))
        );
    }

    #[test]
    fn without_losses_energy_stays() {
        let car = Car { damping: [0.0; 4], cubic: [2e7; 4], progressive: [6e6; 4], ..Car::published() };
        let energy = |[x, v]: &State| {
            let of = |mass: f64, v: f64| 0.5 * mass * v * v;
            let moving = of(car.mass, v[0]) + of(car.inertia[0], v[1]) + of(car.inertia[1], v[2]);
            let corners = PLACES.into_iter().enumerate().map(|(i, [forwards, left])| {
                let deflection = x[0] + left * x[1] - forwards * x[2] - x[3 + i];
                let compression = -x[3 + i];
                of(car.wheel, v[3 + i])
                    + 0.5 * car.stiffness[i] * deflection.powi(2)
                    + 0.25 * car.cubic[i] * deflection.powi(4)
                    + 0.5 * car.tire[i] * compression.powi(2)
                    + car.progressive[i] * compression.powi(3) / 3.0
            });
            moving + corners.sum::<f64>()
        };
        let mut state: State =
            [[0.02, 0.01, -0.01, 0.002, 0.0, -0.003, 0.0], [0.1, 0.0, 0.05, 0.0, 0.2, 0.0, 0.0]];
        let before = energy(&state);
        for _ in 0..20_000 {
            state = car.stepped(&state, |_| [0.0; 4]).0;
        }
        assert!((energy(&state) / before - 1.0).abs() < 1e-6, "{}", energy(&state) / before);
    }
}
