//! The state machines of FMI 3.0: which calls each state allows (sections 2.3, 3.2 and 4.2), without what needs clocks,
//! structural parameters or intermediate update.

use super::{Purpose, State, Verdict};

/// Section 2.3.1: in the super state FMU State Settable.
const ALWAYS: &[&str] = &[
    "fmi3SetDebugLogging",
    "fmi3FreeInstance",
    "fmi3Reset",
    "fmi3GetFMUState",
    "fmi3SetFMUState",
    "fmi3FreeFMUState",
    "fmi3SerializedFMUStateSize",
    "fmi3SerializeFMUState",
    "fmi3DeserializeFMUState",
];
const GET: &[&str] =
    &["fmi3GetFloat64", "fmi3GetInt32", "fmi3GetInt64", "fmi3GetBoolean", "fmi3GetString", "fmi3GetUInt16"];
const SET: &[&str] =
    &["fmi3SetFloat64", "fmi3SetFloat32", "fmi3SetInt32", "fmi3SetInt64", "fmi3SetBoolean", "fmi3SetString"];
/// Between events only what is continuous.
const SET_CONTINUOUS: &[&str] = &["fmi3SetFloat64", "fmi3SetFloat32"];
const PARTIAL: &[&str] = &["fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative"];
const CONTINUOUS: &[&str] = &[
    "fmi3GetContinuousStates",
    "fmi3GetContinuousStateDerivatives",
    "fmi3GetEventIndicators",
    "fmi3GetNominalsOfContinuousStates",
];
const NUMBER: &[&str] = &["fmi3GetNumberOfContinuousStates"];

/// Whether a function may be called.
pub fn verdict(purpose: Purpose, state: State, function: &str) -> Verdict {
    // The numbers of states and event indicators are fixed: they may be asked for more often than the standard lists.
    if allowed(purpose, state).iter().any(|group| group.contains(&function)) {
        Verdict::Legal
    } else if purpose == Purpose::ModelExchange && NUMBER.contains(&function) {
        Verdict::Either
    } else {
        Verdict::Illegal
    }
}

/// The functions that a state allows, in groups.
fn allowed(purpose: Purpose, state: State) -> &'static [&'static [&'static str]] {
    use {Purpose as P, State as S};
    match (purpose, state) {
        (P::ModelExchange, S::Instantiated) => &[ALWAYS, GET, SET, NUMBER, &["fmi3EnterInitializationMode"]],
        (P::CoSimulation, S::Instantiated) => &[ALWAYS, GET, SET, &["fmi3EnterInitializationMode"]],
        (P::ModelExchange, S::InitializationMode) => {
            &[ALWAYS, GET, SET, PARTIAL, CONTINUOUS, &["fmi3ExitInitializationMode"]]
        }
        (P::CoSimulation, S::InitializationMode) => {
            &[ALWAYS, GET, SET, PARTIAL, &["fmi3ExitInitializationMode"]]
        }
        (P::ModelExchange, S::EventMode) => &[
            ALWAYS,
            GET,
            SET,
            PARTIAL,
            CONTINUOUS,
            NUMBER,
            &["fmi3UpdateDiscreteStates", "fmi3EnterContinuousTimeMode", "fmi3Terminate"],
        ],
        (P::CoSimulation, S::EventMode) => {
            &[ALWAYS, GET, SET, PARTIAL, &["fmi3UpdateDiscreteStates", "fmi3EnterStepMode", "fmi3Terminate"]]
        }
        (P::ModelExchange, S::ContinuousTimeMode) => &[
            ALWAYS,
            GET,
            SET_CONTINUOUS,
            PARTIAL,
            CONTINUOUS,
            &[
                "fmi3CompletedIntegratorStep",
                "fmi3EnterEventMode",
                "fmi3SetTime",
                "fmi3SetContinuousStates",
                "fmi3Terminate",
            ],
        ],
        (P::CoSimulation, S::StepComplete) => &[
            ALWAYS,
            GET,
            SET,
            PARTIAL,
            &["fmi3GetOutputDerivatives", "fmi3DoStep", "fmi3EnterEventMode", "fmi3Terminate"],
        ],
        (P::ModelExchange, S::Terminated) => &[ALWAYS, GET, PARTIAL, CONTINUOUS],
        (P::CoSimulation, S::Terminated) => &[ALWAYS, GET, PARTIAL, &["fmi3GetOutputDerivatives"]],
        (P::ModelExchange, S::StepComplete | S::StepFailed)
        | (P::CoSimulation, S::ContinuousTimeMode | S::StepFailed) => &[],
    }
}
