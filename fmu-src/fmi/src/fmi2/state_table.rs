//! Which function may be called in which state: sections 3.2.3 and 4.2.4 of the standard.
//!
//! The standard's states `stepInProgress` and `stepCanceled` are never reached, because a step has ended
//! when `fmi2DoStep` returns; nor is `error`, because a call that is refused changes nothing.
//!
//! More than the tables allow is one thing: start values may be read in the state Instantiated. Importers do that, and
//! their users expect the values of the description there.

use crate::interface::state::{Function, Kind, Phase, State, StateSet, Version, bit, table};

/// FMI 2.0. A constant, so that its mark is one in the code of every call.
pub const FMI_2: Version = Version {
    mark: u64::from_le_bytes(*b"StrutFMI"),
    prefix: "fmi2",
    set_up: "fmi2SetupExperiment",
    get_state: "fmi2GetFMUstate",
    de_serialize: "fmi2DeSerializeFMUstate",
    state_size: "fmi2SerializedFMUstateSize",
    optional_warnings: false,
    after_discard: "restore a saved state and make a shorter step, or reset",
    never: "a step has always ended when fmi2DoStep returns, so that there is never one to cancel",
    explained,
};

fn explained(_: Kind, phase: Phase) -> &'static str {
    match phase {
        Phase::Instantiated => "instantiated (after fmi2Instantiate or fmi2Reset)",
        Phase::Initialization => "Initialization Mode (after fmi2EnterInitializationMode)",
        Phase::Event => "Event Mode (after fmi2ExitInitializationMode or fmi2EnterEventMode)",
        Phase::Continuous => "Continuous-Time Mode (after fmi2EnterContinuousTimeMode)",
        Phase::StepComplete => "step complete (after fmi2ExitInitializationMode or fmi2DoStep)",
        Phase::StepFailed => "step failed (after fmi2DoStep returned fmi2Discard)",
        Phase::Terminated => "terminated (after fmi2Terminate)",
        Phase::Fatal => "fatal (after fmi2Fatal was returned)",
    }
}

table! {
    FMI_2;
    Instantiated Initialization Event Continuous Terminated | Instantiated Initialization StepComplete StepFailed Terminated;
    //                                                                model exchange
    //                                                                instantiated
    //                                                                | Initialization Mode
    //                                                                | | Event Mode
    //                                                                | | | Continuous-Time Mode
    //                                                                | | | | terminated
    //                                                                | | | | |   co-simulation
    //                                                                | | | | |   instantiated
    //                                                                | | | | |   | Initialization Mode
    //                                                                | | | | |   | | step complete
    //                                                                | | | | |   | | | step failed
    //                                                                | | | | |   | | | | terminated
    SET_DEBUG_LOGGING                  fmi2SetDebugLogging:           x x x x x | x x x x x;
    FREE_INSTANCE                      fmi2FreeInstance:              x x x x x | x x x x x;
    SETUP_EXPERIMENT                   fmi2SetupExperiment:           x - - - - | x - - - -;
    ENTER_INITIALIZATION_MODE          fmi2EnterInitializationMode:   x - - - - | x - - - -;
    EXIT_INITIALIZATION_MODE           fmi2ExitInitializationMode:    - x - - - | - x - - -;
    TERMINATE                          fmi2Terminate:                 - - x x - | - - x x -;
    RESET                              fmi2Reset:                     x x x x x | x x x x x;
    GET_REAL                           fmi2GetReal:                   x x x x x | x x x x x;
    GET_INTEGER                        fmi2GetInteger:                x x x x x | x x x x x;
    GET_BOOLEAN                        fmi2GetBoolean:                x x x x x | x x x x x;
    GET_STRING                         fmi2GetString:                 x x x x x | x x x x x;
    SET_REAL                           fmi2SetReal:                   x x x x - | x x x - -;
    SET_INTEGER                        fmi2SetInteger:                x x x - - | x x x - -;
    SET_BOOLEAN                        fmi2SetBoolean:                x x x - - | x x x - -;
    SET_STRING                         fmi2SetString:                 x x x - - | x x x - -;
    GET_FMU_STATE                      fmi2GetFMUstate:               x x x x x | x x x x x;
    SET_FMU_STATE                      fmi2SetFMUstate:               x x x x x | x x x x x;
    FREE_FMU_STATE                     fmi2FreeFMUstate:              x x x x x | x x x x x;
    SERIALIZED_FMU_STATE_SIZE          fmi2SerializedFMUstateSize:    x x x x x | x x x x x;
    SERIALIZE_FMU_STATE                fmi2SerializeFMUstate:         x x x x x | x x x x x;
    DE_SERIALIZE_FMU_STATE             fmi2DeSerializeFMUstate:       x x x x x | x x x x x;
    GET_DIRECTIONAL_DERIVATIVE         fmi2GetDirectionalDerivative:  - x x x x | - x x x x;
    ENTER_EVENT_MODE                   fmi2EnterEventMode:            - - x x - | - - - - -;
    NEW_DISCRETE_STATES                fmi2NewDiscreteStates:         - - x - - | - - - - -;
    ENTER_CONTINUOUS_TIME_MODE         fmi2EnterContinuousTimeMode:   - - x - - | - - - - -;
    COMPLETED_INTEGRATOR_STEP          fmi2CompletedIntegratorStep:   - - - x - | - - - - -;
    SET_TIME                           fmi2SetTime:                   - - x x - | - - - - -;
    SET_CONTINUOUS_STATES              fmi2SetContinuousStates:       - - - x - | - - - - -;
    GET_EVENT_INDICATORS               fmi2GetEventIndicators:        - x x x x | - - - - -;
    GET_CONTINUOUS_STATES              fmi2GetContinuousStates:       - x x x x | - - - - -;
    GET_DERIVATIVES                    fmi2GetDerivatives:            - x x x x | - - - - -;
    GET_NOMINALS_OF_CONTINUOUS_STATES  fmi2GetNominalsOfContinuousStates:
                                                                      x - x x x | - - - - -;
    SET_REAL_INPUT_DERIVATIVES         fmi2SetRealInputDerivatives:   - - - - - | x x x - -;
    GET_REAL_OUTPUT_DERIVATIVES        fmi2GetRealOutputDerivatives:  - - - - - | - - x x x;
    DO_STEP                            fmi2DoStep:                    - - - - - | - - x - -;
    CANCEL_STEP                        fmi2CancelStep:                - - - - - | - - - - -;
    GET_STATUS                         fmi2GetStatus:                 - - - - - | - - x x x;
    GET_REAL_STATUS                    fmi2GetRealStatus:             - - - - - | - - x x x;
    GET_INTEGER_STATUS                 fmi2GetIntegerStatus:          - - - - - | - - x x x;
    GET_BOOLEAN_STATUS                 fmi2GetBooleanStatus:          - - - - - | - - x x x;
    GET_STRING_STATUS                  fmi2GetStringStatus:           - - - - - | - - x x x;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_survive_their_numbers() {
        for state in GET_FMU_STATE.legal.iter() {
            assert_eq!(GET_FMU_STATE.legal.state(state.to_bits()), Some(state));
            assert_eq!(State::new(state.kind(), state.phase()), state);
        }
        let fatal = State::new(Kind::CoSimulation, Phase::Fatal);
        for bits in [0, 3, fatal.to_bits(), State::new(Kind::CoSimulation, Phase::Event).to_bits()] {
            assert_eq!(GET_FMU_STATE.legal.state(bits), None);
        }
    }

    #[test]
    fn refusals_say_what_to_do() {
        let event = State::new(Kind::ModelExchange, Phase::Event);
        let step = State::new(Kind::CoSimulation, Phase::StepComplete);
        assert!(DO_STEP.refusal(event).contains("function for co-simulation"));
        assert!(SET_TIME.refusal(step).contains("function for model exchange"));
        assert!(SETUP_EXPERIMENT.refusal(step).contains("call it in: instantiated (after"));
        assert!(CANCEL_STEP.refusal(step).contains("never one to cancel"));
        assert!(DO_STEP.refusal(step.at(Phase::Fatal)).contains("only fmi2FreeInstance"));
    }
}
