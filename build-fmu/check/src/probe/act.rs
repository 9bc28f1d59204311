//! Orders to a process that runs a library.

use serde::{Deserialize, Serialize};

use crate::description::{Kind, Version};

/// One thing to do. Instances and states have numbers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Act {
    /// Makes an instance.
    Instantiate { kind: Kind, guid: String, resources: String, logging: bool },
    /// `fmi2SetupExperiment`.
    SetUp { start: f64, stop: Option<f64>, tolerance: Option<f64> },
    /// A function without further arguments, by its name without the version.
    Plain(String),
    /// Frees the instance.
    Free,
    /// Goes on with the instance of a number.
    Use(usize),
    /// Reads reals.
    Reals(Vec<u32>),
    /// Reads integers (false) or Booleans (true).
    Integers(Vec<u32>, bool),
    /// Reads texts.
    Texts(Vec<u32>),
    /// Sets reals.
    SetReals(Vec<u32>, Vec<f64>),
    /// `fmi2DoStep`.
    Step(f64, f64),
    /// Frees a null pointer in place of an instance.
    FreeNothing,
    /// Saves the state under a number, over the one that it has.
    Save(usize),
    /// Restores it.
    Restore(usize),
    /// Frees it; the integer is 1 if its pointer is null then.
    FreeState(usize),
    /// Turns it into bytes and these into the state of another number.
    Serialize(usize, usize),
    /// Directional derivative of some unknowns towards a known.
    Directional(Vec<u32>, u32),
    /// `fmi2SetRealInputDerivatives`: the first derivatives of inputs.
    InputDerivatives(Vec<u32>, Vec<f64>),
    /// `fmi2GetRealOutputDerivatives` of an order.
    OutputDerivatives(Vec<u32>, i32),
    /// `fmi2GetNominalsOfContinuousStates` of that many states.
    Nominals(usize),
    /// Makes discrete states new until they stay.
    DiscreteStates,
    /// An explicit Euler step of that many states and event indicators, with events.
    Euler { states: usize, indicators: usize, time: f64, size: f64 },
}

impl Act {
    /// The function that it calls, for messages.
    pub fn function(&self, version: Version) -> String {
        match version {
            Version::Two => self.of_two(),
            Version::Three => {
                self.of_three().unwrap_or_else(|| format!("{self:?}, which no run of FMI 3.0 has"))
            }
        }
    }

    fn of_two(&self) -> String {
        match self {
            Self::Instantiate { .. } => "fmi2Instantiate",
            Self::SetUp { .. } => "fmi2SetupExperiment",
            Self::Plain(name) => return format!("fmi2{name}"),
            Self::Free => "fmi2FreeInstance",
            Self::FreeNothing => "fmi2FreeInstance with a null pointer",
            Self::Use(_) => "nothing",
            Self::Reals(_) => "fmi2GetReal",
            Self::Integers(_, false) => "fmi2GetInteger",
            Self::Integers(_, true) => "fmi2GetBoolean",
            Self::Texts(_) => "fmi2GetString",
            Self::SetReals(..) => "fmi2SetReal",
            Self::Step(..) => "fmi2DoStep",
            Self::Save(_) => "fmi2GetFMUstate",
            Self::Restore(_) => "fmi2SetFMUstate",
            Self::FreeState(_) => "fmi2FreeFMUstate",
            Self::Serialize(..) => "fmi2SerializeFMUstate and fmi2DeSerializeFMUstate",
            Self::Directional(..) => "fmi2GetDirectionalDerivative",
            Self::InputDerivatives(..) => "fmi2SetRealInputDerivatives",
            Self::OutputDerivatives(..) => "fmi2GetRealOutputDerivatives",
            Self::Nominals(_) => "fmi2GetNominalsOfContinuousStates",
            Self::DiscreteStates => "fmi2NewDiscreteStates",
            Self::Euler { .. } => "the functions of a step of model exchange",
        }
        .to_owned()
    }

    /// None for functions that only runs of FMI 2.0 call.
    fn of_three(&self) -> Option<String> {
        let name = match self {
            Self::Instantiate { .. } => "fmi3InstantiateCoSimulation",
            Self::SetUp { .. } => "nothing",
            Self::Plain(name) => return Some(format!("fmi3{name}")),
            Self::Free => "fmi3FreeInstance",
            Self::Reals(_) => "fmi3GetFloat64",
            Self::SetReals(..) => "fmi3SetFloat64",
            Self::Step(..) => "fmi3DoStep",
            _ => return None,
        };
        Some(name.to_owned())
    }
}
