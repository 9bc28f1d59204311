//! What can be hidden, by its number in the catalogue of the diagnosis; `U…` is in no catalogue.

mod drive;
mod parts;
mod pneumatic;
mod pump;
mod sas;
mod sensor;
mod strut;
mod unnamed;

use serde::{Deserialize, Serialize};

use crate::random::Random;

/// Where an effect sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Between body and wheel, or the clamped element.
    Strut,
    /// Between body and ground, or between a drive's carriage and ground.
    Guide,
    /// Between wheel and ground.
    WheelGuide,
    /// Between wheel and road.
    Tire,
    /// A mass that swings on the body.
    Frame,
    /// From the command to the acting force.
    Actuator,
    /// Pump, motor, gas or valves of a pump actuator.
    Pump,
    /// Between two arms.
    Pivot,
    /// Valve or chambers of a pneumatic cylinder.
    Cylinder,
    /// In a sensor; the element of the effect is its signal.
    Sensor,
}

/// Of what a parameter's drawn value is a multiple.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// The parameter's unit.
    Unit,
    /// The largest deflection of the strut without the effect.
    Deflection,
    /// The largest travel of the wheel without the effect.
    Travel,
    /// The largest command.
    Command,
    /// The nominal parameter of the same name.
    Base,
    /// The rms of the sensor's signal about its rest without the effect.
    Signal,
}

/// How a parameter changes with the effect's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// Away from this neutral value.
    From(f64),
    /// As `From(0)`, of either sign.
    Signed,
    /// As `From(1)`, above or below.
    AroundOne,
    /// It says what shape the effect has, not its size.
    Shape,
    /// Smaller where the effect is larger.
    Inverse,
}

/// A parameter of an effect: what is drawn for it.
#[derive(Clone, Copy, Debug)]
pub struct Drawn {
    /// As in the FMU; for a sensor what follows the signal's name, unless it has a dot itself.
    pub name: &'static str,
    /// SI.
    pub unit: &'static str,
    /// Of what the value is a multiple.
    pub scale: Scale,
    /// Least and largest value at size 1; for [`Role::AroundOne`] the distance from one.
    pub between: (f64, f64),
    /// How it changes with the size.
    pub role: Role,
    /// What it may be after scaling.
    pub bounds: (f64, f64),
}

/// An effect that can be hidden.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Number in the catalogue, or `U…`; see [`number`].
    pub id: &'static str,
    /// What it is.
    pub name: &'static str,
    /// Where it sits.
    pub place: Place,
    /// Over which variable an unnamed effect acts; empty if it has a number.
    pub variable: &'static str,
    /// What an effect without a number depends on, in [`WORDS`]. Each one counts as right; the first describes it best.
    pub depends_on: &'static [&'static str],
    /// Its parameters.
    pub parameters: &'static [Drawn],
}

const fn drawn(
    name: &'static str,
    unit: &'static str,
    between: (f64, f64),
    role: Role,
    bounds: (f64, f64),
) -> Drawn {
    Drawn { name, unit, scale: Scale::Unit, between, role, bounds }
}

const fn of(scale: Scale, drawn: Drawn) -> Drawn {
    Drawn { scale, ..drawn }
}

const fn entry(id: &'static str, name: &'static str, place: Place, parameters: &'static [Drawn]) -> Entry {
    Entry { id, name, place, variable: "", depends_on: &[], parameters }
}

const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
const ZERO: Role = Role::From(0.0);
const SHAPE: Role = Role::Shape;

/// What an effect without a number can depend on. `memory` is a hidden state with a time constant or a frequency of its own,
/// `bursts` are present only now and then, `time` is periodic or drifts, `deflection` is any position.
pub const WORDS: [&str; 7] =
    ["acceleration", "memory", "bursts", "time", "deflection", "velocity", "command"];

/// How much faster than it should a sensor's clock may run, as a share.
pub const RATE_ERROR: f64 = 0.01;

/// Everything that can be hidden.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    let of_plants =
        [strut::ENTRIES, parts::ENTRIES, drive::ENTRIES, pump::ENTRIES, sas::ENTRIES, pneumatic::ENTRIES];
    of_plants.into_iter().chain([sensor::ENTRIES, unnamed::ENTRIES]).flatten()
}

/// Laws with a letter in the catalogue of the diagnosis, too, or that have no name there as they are other values of parameters or
/// show in the data alone: who calls one by its number means another one.
const LETTERED: [&str; 10] = ["03b", "08n", "12c", "26s", "28h", "32a", "32b", "32c", "40a", "41h"];

/// The number in the catalogue of the diagnosis: what shares one has a letter here.
pub fn number(id: &str) -> &str {
    if LETTERED.contains(&id) { id } else { id.trim_end_matches(|c: char| c.is_ascii_lowercase()) }
}

impl Entry {
    /// The effect with a number.
    ///
    /// # Errors
    /// If there is none.
    pub fn find(id: &str) -> Result<&'static Self, String> {
        entries().find(|entry| entry.id == id).ok_or_else(|| {
            let known: Vec<&str> = entries().map(|entry| entry.id).collect();
            format!("effect {id} cannot be hidden; these can: {}", known.join(", "))
        })
    }

    /// Draws values of its parameters, before [`Drawn::sized`].
    pub fn draw(&self, random: &mut Random) -> Vec<f64> {
        let draw = |drawn: &Drawn| {
            let (low, high) = drawn.between;
            let value = if low > 0.0 { random.log_between(low, high) } else { random.between(low, high) };
            match drawn.role {
                Role::Signed => value * random.sign(),
                Role::AroundOne => 1.0 + value * random.sign(),
                Role::From(_) | Role::Shape | Role::Inverse => value,
            }
        };
        self.parameters.iter().map(draw).collect()
    }
}

impl Drawn {
    /// A drawn value at a size.
    pub fn sized(&self, value: f64, size: f64) -> f64 {
        let grown = match self.role {
            Role::From(neutral) => neutral + size * (value - neutral),
            Role::Signed => size * value,
            Role::AroundOne => 1.0 + size * (value - 1.0),
            Role::Shape => value,
            Role::Inverse => value / size,
        };
        grown.clamp(self.bounds.0, self.bounds.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_no_size_an_effect_is_neutral() {
        let mut random = Random::new(3, "test");
        for entry in entries() {
            for (drawn, value) in entry.parameters.iter().zip(entry.draw(&mut random)) {
                let neutral = match drawn.role {
                    Role::From(neutral) => neutral,
                    Role::Signed => 0.0,
                    Role::AroundOne => 1.0,
                    Role::Shape => value,
                    Role::Inverse => drawn.bounds.1,
                };
                assert_eq!(drawn.sized(value, 0.0), neutral, "{} {}", entry.id, drawn.name);
                let (low, high) = drawn.bounds;
                assert!((low..=high).contains(&drawn.sized(value, 1.0)), "{} {}", entry.id, drawn.name);
            }
        }
    }

    #[test]
    fn what_has_no_number_depends_on_something() {
        for entry in entries() {
            assert_eq!(entry.id.starts_with('U'), !entry.depends_on.is_empty(), "{}", entry.id);
            assert!(entry.depends_on.iter().all(|word| WORDS.contains(word)), "{}", entry.id);
        }
    }

    #[test]
    fn numbers_are_unique() {
        for entry in entries() {
            assert_eq!(entries().filter(|other| other.id == entry.id).count(), 1, "{}", entry.id);
        }
        let numbers = ["38d", "02g", "01", "U1", "28h", "30p", "32c", "32h"].map(number);
        assert_eq!(numbers, ["38", "02", "01", "U1", "28h", "30", "32c", "32"]);
        assert!(Entry::find("99").is_err());
    }
}
