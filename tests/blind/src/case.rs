//! What is asked of the generator, and what it gives.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use crate::catalogue::{Place, RATE_ERROR};

/// A rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Plant {
    /// The TUM quarter-vehicle rig with a linear strut, no friction and a linear tyre.
    LinearQuarter,
    /// The same under a state feedback, whose force is what is commanded.
    RegulatedQuarter,
    /// The linear one with what TUM's Table 10 knows already: asymmetric damper, friction of strut and guide,
    /// quadratic tyre.
    PublishedQuarter,
    /// Its strut alone: moved at one end, the force measured.
    StrutDyno,
    /// A quarter vehicle with a cylinder and a servo valve, driven by a voltage (Konieczny).
    ServoQuarter,
    /// A damper of those whose friction a coil changes, on a dyno as the strut.
    MrDyno,
    /// A carriage whose motor follows a position in closed loop; the motor's force is measured.
    LinearDrive,
    /// A mass on a guide and a spring to the ground, pushed by a force; position and acceleration are measured.
    GuidedMass,
    /// A pump actuator on a dyno: its piston is moved, its motor's torque commanded (Ajala).
    PumpDyno,
    /// Two arms on a pivot with a spring and a brake between them, on an eccentric (Kogut).
    SasRig,
    /// A mass on a guide that a pneumatic cylinder moves in closed loop; the voltage of its valve is recorded.
    PneumaticCylinder,
}

impl Plant {
    /// Whether it is a body and a wheel on a road.
    pub fn is_car(self) -> bool {
        matches!(
            self,
            Self::LinearQuarter | Self::RegulatedQuarter | Self::PublishedQuarter | Self::ServoQuarter
        )
    }

    /// Whether its record has a command beside what moves it.
    pub fn is_commanded(self) -> bool {
        self.is_car() || matches!(self, Self::PumpDyno | Self::SasRig)
    }

    /// As the page of results calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::LinearQuarter => "quarter car, linear",
            Self::RegulatedQuarter => "quarter car under state feedback",
            Self::PublishedQuarter => "quarter car, published",
            Self::StrutDyno => "strut on a dyno",
            Self::ServoQuarter => "quarter car with a servo valve",
            Self::MrDyno => "magnetorheological damper on a dyno",
            Self::LinearDrive => "linear drive in closed loop",
            Self::GuidedMass => "mass on a spring",
            Self::PumpDyno => "pump actuator on a dyno",
            Self::SasRig => "semi-active rig",
            Self::PneumaticCylinder => "pneumatic cylinder in closed loop",
        }
    }
}

/// An effect to hide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Number in [`crate::catalogue::ENTRIES`].
    pub id: String,
    /// The signal, for an effect of a sensor; otherwise empty.
    pub signal: String,
    /// 1 is a typical one; it is enlarged to meet the case's `ratio`.
    pub size: f64,
}

impl Hidden {
    /// Of typical size.
    pub fn new(id: &str) -> Self {
        Self { id: id.into(), signal: String::new(), size: 1.0 }
    }

    /// In the sensor of a signal.
    pub fn at(id: &str, signal: &str) -> Self {
        Self { id: id.into(), signal: signal.into(), size: 1.0 }
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sensors {
    /// Both accelerations, deflection, wheel force; road and commanded force.
    Full,
    /// All but the wheel force.
    NoForceCell,
    /// Acceleration of the body and deflection; road and commanded force.
    Poor,
    /// Both accelerations, deflection, and commanded force: a car on a road that nobody measured.
    NoRoad,
}

/// Data to make.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// What it is called.
    pub name: String,
    /// The rig.
    pub plant: Plant,
    /// What is hidden in it.
    pub effects: Vec<Hidden>,
    /// Signal over white noise, in dB of the rms; none is no noise.
    pub noise_db: Option<f64>,
    /// Samples a second.
    pub rate: f64,
    /// How strong the small effects are that no model knows: 0, 1 or 2.
    pub clutter: u32,
    /// By how much the true parameters differ from the published ones, as a share.
    pub nominal_off: f64,
    /// How much larger an effect is than the clutter, at least, in what it changes of the signals; 0 takes the
    /// effect as it is.
    pub ratio: f64,
    /// What is measured.
    pub sensors: Sensors,
    /// Length of each record, in s.
    pub duration: f64,
    /// Whether there is a column with the road's velocity, which no sensor measures.
    pub road_velocity: bool,
    /// Two cases with the same seed and the same wishes are the same.
    pub seed: u64,
}

impl Case {
    /// The linear rig under the conditions of the benchmark's targets: clutter 1, 40 dB, ratio 3, full sensors;
    /// 1000 Hz, published parameters 3 % off.
    pub fn standard(name: &str, effects: Vec<Hidden>, seed: u64) -> Self {
        Self {
            name: name.into(),
            plant: Plant::LinearQuarter,
            effects,
            noise_db: Some(40.0),
            rate: 1000.0,
            clutter: 1,
            nominal_off: 0.03,
            ratio: 3.0,
            sensors: Sensors::Full,
            duration: 20.0,
            road_velocity: false,
            seed,
        }
    }
}

impl Case {
    /// Samples in each record.
    pub fn samples(&self) -> usize {
        (self.duration * self.rate).round() as usize + 1
    }

    /// How long the rig must run, in s: a sensor whose clock is slow sees more than the record's duration.
    pub fn reach(&self) -> f64 {
        let slow = self.effects.iter().any(|hidden| hidden.id == "40");
        if slow { self.duration * (1.0 + 2.0 * RATE_ERROR) } else { self.duration }
    }

    /// In which it differs from [`Case::standard`], except for rig and effects: `30 dB, 100 Hz`, say.
    pub fn condition(&self) -> String {
        let mut parts = vec![];
        match self.noise_db {
            Some(40.0) => {}
            Some(noise) => parts.push(format!("noise {noise} dB below")),
            None => parts.push("no noise".into()),
        }
        if self.rate != 1000.0 {
            parts.push(format!("{} Hz", self.rate));
        }
        if self.clutter != 1 {
            parts.push(format!("clutter {}", self.clutter));
        }
        if self.nominal_off != 0.03 {
            parts.push(format!("parameters {:.0} % off", 100.0 * self.nominal_off));
        }
        match self.sensors {
            Sensors::Full => {}
            Sensors::NoForceCell => parts.push("no force cell".into()),
            Sensors::Poor => parts.push("body acceleration and deflection only".into()),
            Sensors::NoRoad => parts.push("no road, no force cell".into()),
        }
        if self.ratio > 0.0 && self.ratio != 3.0 {
            parts.push(format!("ratio to the clutter {}", self.ratio));
        }
        if self.ratio == 0.0 {
            let sizes = self.effects.iter().map(|hidden| hidden.size.to_string());
            parts.push(format!("size {}", sizes.collect::<Vec<_>>().join(" and ")));
        }
        if parts.is_empty() { "standard".into() } else { parts.join(", ") }
    }
}

/// What a rig's logger wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `train-multisine`, say.
    pub name: String,
    /// Names as in the FMU, units, values.
    pub columns: Vec<(String, String, Vec<f64>)>,
}

impl Table {
    /// The values of a column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.0 == name).map(|column| column.2.as_slice())
    }

    /// With a header `name [unit]`.
    pub fn csv(&self) -> String {
        let head: Vec<String> =
            self.columns.iter().map(|(name, unit, _)| format!("{name} [{unit}]")).collect();
        let mut text = head.join(",");
        text.push('\n');
        for row in 0..self.columns.first().map_or(0, |column| column.2.len()) {
            for (k, column) in self.columns.iter().enumerate() {
                let comma = if k == 0 { "" } else { "," };
                // Nine digits are finer than any noise here, and half as long as all of them.
                let value = (column.2[row] * 1e9).round() / 1e9;
                write!(text, "{comma}{value}").expect("a string takes everything");
            }
            text.push('\n');
        }
        text
    }
}

/// A value that a parameter has in truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// As in the FMU; of a sensor `signal.gain`, say.
    pub name: String,
    /// SI.
    pub unit: String,
    /// In `unit`.
    pub value: f64,
}

impl Value {
    /// Its name without its number among the points of a characteristic: of `valve.rebound.flow[3]` what comes before the bracket.
    pub fn table(&self) -> &str {
        characteristic(&self.name)
    }
}

/// The name of a characteristic, of one of its points.
pub fn characteristic(name: &str) -> &str {
    name.split('[').next().unwrap_or_default()
}

/// An effect that is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Present {
    /// Number in the catalogue, or `U…`.
    pub id: String,
    /// What it is.
    pub name: String,
    /// Where it sits.
    pub place: Place,
    /// The signal, for a sensor's effect; otherwise empty.
    pub signal: String,
    /// Over which variable it acts, if it has no number.
    pub variable: String,
    /// What it depends on, if it has no number. Each of these [words](crate::catalogue::WORDS) counts as right.
    #[serde(default)]
    pub depends_on: Vec<String>,
    /// Its parameters.
    pub parameters: Vec<Value>,
    /// What it changes of the signals over what the clutter changes; none without clutter.
    pub ratio: Option<f64>,
}

/// What is really there. Only the scorer may see it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// What was asked.
    pub case: Case,
    /// The hidden effects.
    pub effects: Vec<Present>,
    /// The true nominal parameters.
    pub base: Vec<Value>,
    /// Deviation of each column's noise.
    pub noise: Vec<Value>,
    /// The remaining error on the validation records of a model with the true parameters and effects, but without the clutter.
    pub oracle: Oracle,
}

/// Root mean square of what is left of each column; nothing where it is not asked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Oracle {
    /// By a model that is driven by the inputs as they were recorded, as any model is.
    pub recorded: Vec<Value>,
    /// By one that is driven by what really drove the rig: no model can do better.
    pub exact: Vec<Value>,
}

/// A case's data.
#[derive(Clone, Debug)]
pub struct Generated {
    /// To learn from.
    pub train: Vec<Table>,
    /// To judge with: other excitations.
    pub test: Vec<Table>,
    /// What the model starts with: the published parameters.
    pub start: Vec<Value>,
    /// Sealed.
    pub truth: Truth,
}
