//! The state machines of FMI 2.0.4: which calls each state allows (tables in sections 3.2.3 and 4.2.4). Those of FMI 3.0 are in
//! [`three`].
//!
//! Written down state by state, from the standard, as the other reading of what `strut_fmi::fmi2::state_table`
//! has function by function: a slip of either shows.

pub mod three;

/// A version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0
    Two,
    /// FMI 3.0
    Three,
}

/// What an instance is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// `fmi2ModelExchange`
    ModelExchange,
    /// `fmi2CoSimulation`
    CoSimulation,
}

/// A state of the state machines, without those that an instance passes while a function runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "these are the standard's names")]
pub enum State {
    Instantiated,
    InitializationMode,
    EventMode,
    ContinuousTimeMode,
    /// Step Mode of FMI 3.0
    StepComplete,
    StepFailed,
    Terminated,
}

/// Whether a call may be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It may.
    Legal,
    /// It may not.
    Illegal,
    /// Readers of the standard differ.
    Either,
}

const ALWAYS: &[&str] = &[
    "fmi2SetDebugLogging",
    "fmi2FreeInstance",
    "fmi2Reset",
    "fmi2GetFMUstate",
    "fmi2SetFMUstate",
    "fmi2FreeFMUstate",
    "fmi2SerializedFMUstateSize",
    "fmi2SerializeFMUstate",
    "fmi2DeSerializeFMUstate",
];
const GET: &[&str] =
    &["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString", "fmi2GetDirectionalDerivative"];
/// More than the tables have: start values may be read before initialisation.
const GET_STARTS: &[&str] = &["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean", "fmi2GetString"];
const SET: &[&str] = &["fmi2SetReal", "fmi2SetInteger", "fmi2SetBoolean", "fmi2SetString"];
const GET_CONTINUOUS: &[&str] = &["fmi2GetContinuousStates", "fmi2GetDerivatives", "fmi2GetEventIndicators"];
const NOMINALS: &[&str] = &["fmi2GetNominalsOfContinuousStates"];
const ASK: &[&str] = &[
    "fmi2GetRealOutputDerivatives",
    "fmi2GetStatus",
    "fmi2GetRealStatus",
    "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus",
    "fmi2GetStringStatus",
];
const INPUT_DERIVATIVES: &[&str] = &["fmi2SetRealInputDerivatives"];

/// Whether a function may be called.
pub fn verdict(version: Version, purpose: Purpose, state: State, function: &str) -> Verdict {
    if version == Version::Three {
        return three::verdict(purpose, state, function);
    }
    // The table lists it for Initialization Mode, Reference-FMUs refuses it there.
    let doubtful = [(Purpose::ModelExchange, State::InitializationMode, "fmi2GetDerivatives")];
    if doubtful.contains(&(purpose, state, function)) {
        Verdict::Either
    } else if allowed(purpose, state).iter().any(|group| group.contains(&function)) {
        Verdict::Legal
    } else {
        Verdict::Illegal
    }
}

/// The functions that a state allows, in groups.
fn allowed(purpose: Purpose, state: State) -> &'static [&'static [&'static str]] {
    use {Purpose as P, State as S};
    match (purpose, state) {
        (P::ModelExchange, S::Instantiated) => {
            &[ALWAYS, GET_STARTS, SET, NOMINALS, &["fmi2SetupExperiment", "fmi2EnterInitializationMode"]]
        }
        (P::CoSimulation, S::Instantiated) => &[
            ALWAYS,
            GET_STARTS,
            SET,
            INPUT_DERIVATIVES,
            &["fmi2SetupExperiment", "fmi2EnterInitializationMode"],
        ],
        (P::ModelExchange, S::InitializationMode) => {
            &[ALWAYS, GET, SET, GET_CONTINUOUS, &["fmi2ExitInitializationMode"]]
        }
        (P::CoSimulation, S::InitializationMode) => {
            &[ALWAYS, GET, SET, INPUT_DERIVATIVES, &["fmi2ExitInitializationMode"]]
        }
        (P::ModelExchange, S::EventMode) => &[
            ALWAYS,
            GET,
            SET,
            GET_CONTINUOUS,
            NOMINALS,
            &[
                "fmi2NewDiscreteStates",
                "fmi2EnterContinuousTimeMode",
                "fmi2EnterEventMode",
                "fmi2SetTime",
                "fmi2Terminate",
            ],
        ],
        (P::ModelExchange, S::ContinuousTimeMode) => &[
            ALWAYS,
            GET,
            &["fmi2SetReal"],
            GET_CONTINUOUS,
            NOMINALS,
            &[
                "fmi2CompletedIntegratorStep",
                "fmi2EnterEventMode",
                "fmi2SetTime",
                "fmi2SetContinuousStates",
                "fmi2Terminate",
            ],
        ],
        (P::ModelExchange, S::Terminated) => &[ALWAYS, GET, GET_CONTINUOUS, NOMINALS],
        (P::CoSimulation, S::StepComplete) => {
            &[ALWAYS, GET, SET, ASK, INPUT_DERIVATIVES, &["fmi2DoStep", "fmi2Terminate"]]
        }
        (P::CoSimulation, S::StepFailed) => &[ALWAYS, GET, ASK, &["fmi2Terminate"]],
        (P::CoSimulation, S::Terminated) => &[ALWAYS, GET, ASK],
        (P::ModelExchange, S::StepComplete | S::StepFailed)
        | (P::CoSimulation, S::EventMode | S::ContinuousTimeMode) => &[],
    }
}

/// The state that a function leads to if it returns that all is well, if it leads anywhere. `events` tells whether a host of
/// co-simulation handles events, in FMI 3.0.
pub fn successor(purpose: Purpose, events: bool, function: &str) -> Option<State> {
    let name = function.trim_start_matches("fmi2").trim_start_matches("fmi3");
    Some(match (name, purpose) {
        ("EnterInitializationMode", _) => State::InitializationMode,
        ("ExitInitializationMode", Purpose::ModelExchange) | ("EnterEventMode", _) => State::EventMode,
        ("ExitInitializationMode", Purpose::CoSimulation) if events => State::EventMode,
        ("ExitInitializationMode", Purpose::CoSimulation) | ("DoStep" | "EnterStepMode", _) => {
            State::StepComplete
        }
        ("EnterContinuousTimeMode", _) => State::ContinuousTimeMode,
        ("Terminate", _) => State::Terminated,
        ("Reset", _) => State::Instantiated,
        _ => return None,
    })
}
