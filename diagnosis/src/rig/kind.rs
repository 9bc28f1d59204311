//! What the diagnosis has to know of a model, as a file says it.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Serialize};
use strut_model::unit;

use crate::catalogue::Element;
use crate::plant::Plant;

/// What the diagnosis has to know of a model: the content of a rig file.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// The model: one of the library by its name, or a file `….fmu`.
    pub model: String,
    /// Values that differ from the model's own, in base units of the SI, or a setting's item.
    #[serde(default)]
    pub values: BTreeMap<String, Given>,
    /// Parameters that are never quite those of a data sheet.
    #[serde(default)]
    pub nominal: Vec<String>,
    /// Where its elements' forces and motions are found.
    #[serde(default)]
    pub elements: Vec<ElementSignals>,
    /// Other names of its signals in records; `-name` is the negative.
    #[serde(default)]
    pub names: BTreeMap<String, Vec<String>>,
    /// Inputs that are the rate of change of another one: rate, input. `road.velocity` is that of `road.position` unsaid.
    #[serde(default)]
    pub rates: BTreeMap<String, String>,
    /// Outputs that show a state of another name: output, state.
    #[serde(default)]
    pub shows: BTreeMap<String, String>,
    /// Outputs that follow from the inputs alone and show nothing.
    #[serde(default)]
    pub follows_inputs: Vec<String>,
    /// Whether its motion is imposed, so that nothing that the model lacks moves it: its laws can see more of the motion than is compared.
    pub imposed: Option<bool>,
    /// A signal that is of opposite sign where records have a column.
    pub opposed: Option<Opposed>,
    /// What the force that the model misses is made of.
    #[serde(default)]
    pub missing: Vec<Missing>,
    /// The model that stands for it where nobody measured its input.
    pub undriven: Option<Undriven>,
    /// Longest segment that is simulated in one go, in seconds: it bounds the memory, and how far a plant that
    /// integrates its input may drift.
    /// A minute unless it is given; the whole record where motion is imposed.
    pub segment: Option<f64>,
    /// Ways in which it can be driven; empty if there is one only.
    #[serde(default)]
    pub drives: Vec<DrivenBy>,
    /// What drives a virtual rig.
    #[serde(default)]
    pub excitation: Vec<Excitation>,
}

/// A value that a rig file gives.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "write a number, a text, or { value = 94.4, deviation = 0.5 }",
    deny_unknown_fields
)]
pub enum Given {
    /// A parameter or a start value.
    Number(f64),
    /// Whether something is on.
    Flag(bool),
    /// An item of a setting.
    Item(String),
    /// A parameter that was measured independently.
    Measured {
        /// The value.
        value: f64,
        /// Its standard deviation.
        deviation: f64,
    },
}

/// A signal that is recorded with the sense of a column, opposite to the model's, if the column is there.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Opposed {
    /// The column.
    pub column: String,
    /// The signal.
    pub signal: String,
}

/// A model that stands for a plant where a record lacks what drove it, since it is driven by what was measured instead.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Undriven {
    /// The input that no column has.
    pub input: String,
    /// The model of the library; parameters of the same names have the plant's values.
    pub model: String,
}

/// A way in which a plant can be driven.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct DrivenBy {
    /// The setting that chooses it.
    pub setting: String,
    /// The item of that setting.
    pub item: String,
    /// The input that acts then.
    pub input: String,
    /// Further nominal parameters that matter then.
    #[serde(default)]
    pub nominal: Vec<String>,
    /// Columns that are this input where none has its name.
    #[serde(default)]
    pub columns: Vec<String>,
    /// Outputs that follow from the inputs alone then.
    #[serde(default)]
    pub follows_inputs: Vec<String>,
    /// Whether the input has no mean, as the acceleration of what stays in its place: a measured mean is the sensor's.
    #[serde(default)]
    pub without_mean: bool,
    /// What it takes for the inverse: the motion drives the model, and the force is compared.
    pub inverse: Option<Inverse>,
    /// Longest segment then, in seconds, if it is not the model's.
    pub segment: Option<f64>,
}

/// The inverse of a drive.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Inverse {
    /// The output that is compared: a force, or the acceleration that it makes.
    pub force: String,
    /// The input that is measured.
    pub position: String,
    /// The output whose column has the position's rate, where a sensor of its own measures that.
    pub rate: Option<String>,
    /// The input that is its highest derivative.
    pub derivative: String,
    /// Signals of which each says more where it is measured; most have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instead: Vec<String>,
}

/// A signal that drives a virtual rig.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// The input.
    pub input: String,
    /// Amplitude of all its sines together, in the input's unit.
    pub amplitude: f64,
    /// Lowest and highest frequency in Hz.
    pub band: (f64, f64),
}

/// Where an element's force and motion are found among a plant's outputs.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ElementSignals {
    /// The element.
    pub element: Element,
    /// Output with its deflection, or position.
    pub deflection: String,
    /// What that output is where the spring carries nothing, in m.
    #[serde(default)]
    pub rest: f64,
    /// Output with its velocity; none: the derivative of the deflection.
    pub velocity: Option<String>,
    /// Where its force is found.
    pub force: ForceOf,
    /// Inputs of a foreign model that take the force of such an element of the library, positive where it pulls the ends
    /// together; `-name` takes the negative.
    #[serde(default)]
    pub acts_on: Vec<String>,
    /// Parameters of a foreign model that the library's strut stands for.
    pub replaces: Option<Replaced>,
}

/// Parameters that are zero while a strut of the library does what they did.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Replaced {
    /// Spring rate.
    pub stiffness: String,
    /// Damping rate.
    pub damping: String,
}

/// Where an element's force is found.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "write output, input, stiffness and damping, mass and acceleration, or moment_of and lever",
    deny_unknown_fields
)]
pub enum ForceOf {
    /// In an output.
    Output {
        /// The output.
        output: String,
    },
    /// In an input.
    Input {
        /// The input.
        input: String,
    },
    /// A stiffness times the deflection and a damping rate times the velocity.
    SpringAndDamper {
        /// The parameter of the stiffness.
        stiffness: String,
        /// The parameter of the damping rate.
        damping: String,
    },
    /// Mass times acceleration, of the mass that it guides.
    Inertia {
        /// The parameter of the mass.
        mass: String,
        /// The output of its acceleration.
        acceleration: String,
    },
    /// An output times a parameter, the lever with which it turns something.
    Moment {
        /// The output.
        moment_of: String,
        /// The parameter.
        lever: String,
    },
}

/// A force that the model misses, as it shows in an output.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Missing {
    /// What it is.
    pub quantity: String,
    /// The output whose error shows it.
    pub output: String,
    /// The parameter that makes it a force.
    pub times: Option<String>,
    /// Whether it counts in the other sense.
    #[serde(default)]
    pub negative: bool,
    /// The elements over whose motions it is shown.
    pub over: Vec<Element>,
}

impl ElementSignals {
    /// Its deflection from where the spring carries nothing, from the output's signal.
    pub fn deflected(&self, output: &[f64]) -> Vec<f64> {
        output.iter().map(|it| it - self.rest).collect()
    }

    /// Whether it turns in a plant: its deflection is an angle.
    pub fn turns(&self, plant: &Plant) -> bool {
        let mut declared = plant.inputs.iter().chain(&plant.outputs);
        declared.any(|it| it.name == self.deflection && it.unit == unit::RAD)
    }
}

impl ForceOf {
    /// The signal that is the force, if there is one.
    pub fn signal(&self) -> Option<&str> {
        match self {
            Self::Output { output: name } | Self::Input { input: name } => Some(name),
            Self::SpringAndDamper { .. } | Self::Inertia { .. } | Self::Moment { .. } => None,
        }
    }
}

impl Kind {
    /// Reads a rig file.
    ///
    /// # Errors
    /// Where the text is no rig file, and what was expected there.
    pub fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())
    }

    /// As a rig file, without what is empty.
    pub fn text(&self) -> String {
        let mut table = toml::Table::try_from(self).expect("a rig file is a table");
        table.retain(|_, value| match value {
            toml::Value::Array(list) => !list.is_empty(),
            toml::Value::Table(table) => !table.is_empty(),
            _ => true,
        });
        toml::to_string_pretty(&table).expect("a table has a text")
    }

    /// Those of the models of this library.
    pub fn published() -> &'static [Arc<Self>] {
        static KINDS: LazyLock<Vec<Arc<Kind>>> = LazyLock::new(|| {
            let parsed = |text: &&str| Kind::parse(text).expect("a rig file of the library").into();
            FILES.iter().map(parsed).collect()
        });
        &KINDS
    }

    /// The rig file of a model of the library, as it is written.
    pub fn published_text(model: &str) -> Option<&'static str> {
        let place = Self::published().iter().position(|it| it.model == model)?;
        FILES.get(place).copied()
    }

    /// A signal's own name and the others that it has in records.
    pub fn called<'a>(&'a self, signal: &'a str) -> impl Iterator<Item = &'a str> {
        std::iter::once(signal).chain(self.aliases(signal))
    }

    /// The other names of a signal in records.
    pub fn aliases(&self, signal: &str) -> impl Iterator<Item = &str> {
        self.names.get(signal).into_iter().flatten().map(String::as_str)
    }
}

const FILES: [&str; 11] = [
    include_str!("../../rigs/quarter-car.toml"),
    include_str!("../../rigs/full-car.toml"),
    include_str!("../../rigs/sprung-mass.toml"),
    include_str!("../../rigs/element-dyno.toml"),
    include_str!("../../rigs/servo-suspension.toml"),
    include_str!("../../rigs/pump-hydraulic-actuator.toml"),
    include_str!("../../rigs/sas-rig.toml"),
    include_str!("../../rigs/excitation-motor.toml"),
    include_str!("../../rigs/linear-drive.toml"),
    include_str!("../../rigs/rotary-drive.toml"),
    include_str!("../../rigs/pneumatic-cylinder.toml"),
];
