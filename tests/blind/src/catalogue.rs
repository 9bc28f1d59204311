//! What can be hidden, by its number in the catalogue of the diagnosis; `U…` is in no catalogue.

use serde::{Deserialize, Serialize};

use crate::random::Random;

/// Where an effect sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Between body and wheel, or the clamped element.
    Strut,
    /// Between body and ground.
    Guide,
    /// Between wheel and ground.
    WheelGuide,
    /// Between wheel and road.
    Tire,
    /// From the commanded force to the acting one.
    Actuator,
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
    /// The rms of the sensor's signal without the effect.
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
    /// As in the FMU; for a sensor what follows the signal's name.
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
    /// Number in the catalogue, or `U…`.
    pub id: &'static str,
    /// What it is.
    pub name: &'static str,
    /// Where it sits.
    pub place: Place,
    /// Over which variable an unnamed effect acts; empty if it has a number.
    pub variable: &'static str,
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
    Entry { id, name, place, variable: "", parameters }
}

const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
const ZERO: Role = Role::From(0.0);
const SHAPE: Role = Role::Shape;

/// Everything that can be hidden.
pub static ENTRIES: &[Entry] = &[
    entry(
        "01",
        "friction of the strut",
        Place::Strut,
        &[drawn("strut.coulomb.force", "N", (35.0, 80.0), ZERO, (0.0, 400.0))],
    ),
    entry(
        "02",
        "breakaway friction of the strut",
        Place::Strut,
        &[
            drawn("strut.coulomb.force", "N", (25.0, 50.0), ZERO, (0.0, 300.0)),
            drawn("strut.stribeck.force", "N", (20.0, 50.0), ZERO, (0.0, 300.0)),
            drawn("strut.stribeck.velocity", "m/s", (0.01, 0.04), SHAPE, ANY),
        ],
    ),
    entry(
        "03",
        "presliding friction of the strut",
        Place::Strut,
        &[
            drawn("strut.presliding.force", "N", (40.0, 80.0), ZERO, (0.0, 400.0)),
            drawn("strut.presliding.stiffness", "N/m", (2.5e4, 1.5e5), SHAPE, ANY),
        ],
    ),
    entry(
        "04",
        "asymmetry of the damper",
        Place::Strut,
        &[drawn("strut.asymmetry.ratio", "1", (0.25, 0.5), Role::Signed, (-0.8, 0.8))],
    ),
    entry(
        "05",
        "knee of the damper",
        Place::Strut,
        &[
            drawn("strut.knee.ratio", "1", (0.25, 0.55), Role::From(1.0), (0.1, 3.0)),
            drawn("strut.knee.velocity", "m/s", (0.05, 0.12), SHAPE, ANY),
        ],
    ),
    entry(
        "06",
        "orifice of the damper",
        Place::Strut,
        &[drawn("strut.orifice.coefficient", "N.s2/m2", (500.0, 1500.0), ZERO, (0.0, 5000.0))],
    ),
    entry(
        "07",
        "Maxwell branch of the strut",
        Place::Strut,
        &[
            drawn("strut.maxwell.stiffness", "N/m", (1.5e4, 5e4), ZERO, (0.0, 3e5)),
            drawn("strut.maxwell.time", "s", (0.006, 0.04), SHAPE, ANY),
        ],
    ),
    entry(
        "08",
        "curved spring",
        Place::Strut,
        &[
            drawn("strut.spring.quadratic", "N/m2", (2e5, 5e5), Role::Signed, (-1e6, 1e6)),
            drawn("strut.spring.cubic", "N/m3", (1e7, 5e7), ZERO, (0.0, 1e8)),
        ],
    ),
    entry(
        "09",
        "stops of the strut",
        Place::Strut,
        &[
            drawn("strut.stop.stiffness", "N/m", (3e4, 1.2e5), ZERO, (0.0, 1e6)),
            of(Scale::Deflection, drawn("strut.stop.clearance", "m", (0.45, 0.6), SHAPE, ANY)),
        ],
    ),
    entry(
        "10",
        "fade of the damper",
        Place::Strut,
        &[
            drawn("strut.fade.ratio", "1", (0.25, 0.5), ZERO, (0.0, 0.6)),
            drawn("strut.fade.time", "s", (4.0, 12.0), SHAPE, ANY),
        ],
    ),
    entry(
        "12",
        "play of the damper's bush",
        Place::Strut,
        &[
            drawn("strut.mount.gap", "m", (3e-4, 1e-3), ZERO, (0.0, 4e-3)),
            drawn("strut.mount.compliance", "m/N", (1e-6, 4e-6), SHAPE, ANY),
        ],
    ),
    entry(
        "13",
        "soft mount of the damper",
        Place::Strut,
        &[drawn("strut.mount.compliance", "m/N", (8e-6, 2.5e-5), ZERO, (0.0, 1e-4))],
    ),
    entry(
        "14",
        "linkage",
        Place::Strut,
        &[drawn("strut.linkage.slope", "1/m", (3.0, 5.0), Role::Signed, (-12.0, 12.0))],
    ),
    entry(
        "15",
        "viscous friction of the body's guide",
        Place::Guide,
        &[drawn("guide.damping", "N.s/m", (60.0, 150.0), ZERO, (0.0, 400.0))],
    ),
    entry(
        "16",
        "friction of the body's guide",
        Place::Guide,
        &[drawn("guide.coulomb.force", "N", (20.0, 60.0), ZERO, (0.0, 150.0))],
    ),
    entry(
        "17",
        "friction of the wheel's guide",
        Place::WheelGuide,
        &[drawn("wheel_guide.coulomb.force", "N", (30.0, 90.0), ZERO, (0.0, 300.0))],
    ),
    entry(
        "19",
        "progressive tyre",
        Place::Tire,
        &[
            // Beyond 4.9e6 the parabola would never lift off.
            drawn("tire.quadratic", "N/m2", (2.5e6, 4.5e6), ZERO, (0.0, 4.8e6)),
        ],
    ),
    entry("20", "lift-off of the tyre", Place::Tire, &[]),
    entry(
        "21",
        "damping of the tyre",
        Place::Tire,
        &[drawn("tire.damping.added", "N.s/m", (100.0, 300.0), ZERO, (0.0, 500.0))],
    ),
    entry(
        "23",
        "delay of the actuator",
        Place::Actuator,
        &[drawn("actuator.delay", "s", (0.004, 0.012), ZERO, (0.0, 0.015))],
    ),
    entry(
        "24",
        "lag of the actuator",
        Place::Actuator,
        &[drawn("actuator.lag", "s", (0.004, 0.015), ZERO, (0.0, 0.02))],
    ),
    entry(
        "25",
        "force constant of the actuator",
        Place::Actuator,
        &[drawn("actuator.gain", "1", (0.08, 0.15), Role::AroundOne, (0.7, 1.3))],
    ),
    entry(
        "32",
        "yield force of a magnetorheological damper",
        Place::Strut,
        &[
            drawn("strut.yield.force", "N", (40.0, 90.0), ZERO, (0.0, 400.0)),
            drawn("strut.yield.velocity", "m/s", (0.01, 0.03), SHAPE, ANY),
            drawn("strut.yield.slope", "1/m", (20.0, 60.0), SHAPE, ANY),
        ],
    ),
    entry(
        "33",
        "offset of a sensor",
        Place::Sensor,
        &[
            of(Scale::Signal, drawn("offset", "", (0.3, 1.0), Role::Signed, (-5.0, 5.0))),
            of(Scale::Signal, drawn("drift", "/s", (0.0, 0.02), Role::Signed, (-0.2, 0.2))),
        ],
    ),
    entry(
        "34",
        "gain of a sensor",
        Place::Sensor,
        &[drawn("gain", "1", (0.08, 0.25), Role::AroundOne, (0.6, 1.4))],
    ),
    entry("35", "lag of a sensor", Place::Sensor, &[drawn("lag", "s", (0.003, 0.012), ZERO, (0.0, 0.05))]),
    entry(
        "36",
        "time skew of a sensor",
        Place::Sensor,
        &[drawn("skew", "s", (0.003, 0.010), Role::Signed, (-0.02, 0.02))],
    ),
    entry(
        "37",
        "quantisation of a sensor",
        Place::Sensor,
        &[of(Scale::Signal, drawn("quantum", "", (0.1, 0.3), ZERO, (0.0, 1.0)))],
    ),
    entry(
        "38",
        "saturation of a sensor",
        Place::Sensor,
        &[of(Scale::Signal, drawn("range", "", (1.0, 1.5), Role::Inverse, (0.5, 3.0)))],
    ),
    entry(
        "38d",
        "dropouts of a sensor",
        Place::Sensor,
        &[drawn("dropout", "1", (0.003, 0.01), ZERO, (0.0, 0.02))],
    ),
    entry(
        "42",
        "gain and lag of the road's sensor",
        Place::Sensor,
        &[
            drawn("gain", "1", (0.08, 0.2), Role::AroundOne, (0.6, 1.4)),
            drawn("lag", "s", (0.002, 0.008), ZERO, (0.0, 0.02)),
        ],
    ),
    Entry {
        variable: "suspension.deflection",
        ..entry(
            "U1",
            "hump of force over the deflection",
            Place::Strut,
            &[
                drawn("height", "N", (40.0, 90.0), Role::Signed, (-400.0, 400.0)),
                of(Scale::Deflection, drawn("centre", "m", (-0.25, 0.25), SHAPE, ANY)),
                of(Scale::Deflection, drawn("width", "m", (0.12, 0.25), SHAPE, ANY)),
            ],
        )
    },
    Entry {
        variable: "suspension.deflection",
        ..entry(
            "U2",
            "damping that changes over the deflection",
            Place::Strut,
            &[
                drawn("height", "1", (0.6, 1.2), ZERO, (0.0, 4.0)),
                of(Scale::Deflection, drawn("centre", "m", (-0.25, 0.25), SHAPE, ANY)),
                of(Scale::Deflection, drawn("width", "m", (0.15, 0.3), SHAPE, ANY)),
            ],
        )
    },
    Entry {
        variable: "suspension.velocity",
        ..entry(
            "U3",
            "friction that grows with the distance from the middle",
            Place::Strut,
            &[drawn("slope", "N/m", (6e3, 1.6e4), ZERO, (0.0, 1e5))],
        )
    },
    Entry {
        variable: "wheel.velocity",
        ..entry(
            "U4",
            "friction of the wheel's guide that comes and goes over its travel",
            Place::WheelGuide,
            &[
                drawn("force", "N", (60.0, 140.0), ZERO, (0.0, 600.0)),
                of(Scale::Travel, drawn("period", "m", (0.3, 0.6), SHAPE, ANY)),
            ],
        )
    },
];

impl Entry {
    /// The effect with a number.
    ///
    /// # Errors
    /// If there is none.
    pub fn find(id: &str) -> Result<&'static Self, String> {
        ENTRIES.iter().find(|entry| entry.id == id).ok_or_else(|| {
            let known: Vec<&str> = ENTRIES.iter().map(|entry| entry.id).collect();
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
        for entry in ENTRIES {
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
    fn numbers_are_unique() {
        for (k, entry) in ENTRIES.iter().enumerate() {
            assert!(ENTRIES[k + 1..].iter().all(|other| other.id != entry.id), "{}", entry.id);
        }
        assert!(Entry::find("99").is_err());
    }
}
