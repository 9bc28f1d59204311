//! Which function may be called in which state: sections 2.3, 3.2 and 4.2 of the standard.
//!
//! Configuration and Reconfiguration Mode are never reached, because there are no structural parameters; nor is Intermediate
//! Update Mode, because a step calls nobody back. A step that was discarded leaves the instance in Step Mode.
//!
//! More than the standard allows is one thing: the numbers of states and event indicators, which never change, may be asked
//! for at any time.

use crate::interface::state::{Function, Kind, Phase, State, StateSet, Version, bit, table};

/// FMI 3.0. A constant, so that its mark is one in the code of every call.
pub const FMI_3: Version = Version {
    mark: u64::from_le_bytes(*b"StrutFM3"),
    prefix: "fmi3",
    set_up: "fmi3EnterInitializationMode",
    get_state: "fmi3GetFMUState",
    de_serialize: "fmi3DeserializeFMUState",
    state_size: "fmi3SerializedFMUStateSize",
    optional_warnings: true,
    after_discard: "make a shorter step",
    never: "this FMU has no clocks, no structural parameters and none of the optional capabilities that its \
            modelDescription.xml does not name",
    explained,
};

fn explained(kind: Kind, phase: Phase) -> &'static str {
    match (phase, kind) {
        (Phase::Instantiated, _) => "Instantiated (after fmi3Instantiate… or fmi3Reset)",
        (Phase::Initialization, _) => "Initialization Mode (after fmi3EnterInitializationMode)",
        (Phase::Event, Kind::ModelExchange) => {
            "Event Mode (after fmi3ExitInitializationMode or fmi3EnterEventMode)"
        }
        (Phase::Event, Kind::CoSimulation) => {
            "Event Mode (with eventModeUsed, after fmi3ExitInitializationMode or fmi3EnterEventMode)"
        }
        (Phase::Continuous, _) => "Continuous-Time Mode (after fmi3EnterContinuousTimeMode)",
        (Phase::StepComplete | Phase::StepFailed, _) => {
            "Step Mode (after fmi3ExitInitializationMode or, with eventModeUsed, fmi3EnterStepMode)"
        }
        (Phase::Terminated, _) => "Terminated (after fmi3Terminate)",
        (Phase::Fatal, _) => "fatal (after fmi3Fatal was returned)",
    }
}

table! {
    FMI_3;
    Instantiated Initialization Event Continuous Terminated | Instantiated Initialization Event StepComplete Terminated;
    //                                                                model exchange
    //                                                                Instantiated
    //                                                                | Initialization Mode
    //                                                                | | Event Mode
    //                                                                | | | Continuous-Time Mode
    //                                                                | | | | Terminated
    //                                                                | | | | |   co-simulation
    //                                                                | | | | |   Instantiated
    //                                                                | | | | |   | Initialization Mode
    //                                                                | | | | |   | | Event Mode
    //                                                                | | | | |   | | | Step Mode
    //                                                                | | | | |   | | | | Terminated
    SET_DEBUG_LOGGING                  fmi3SetDebugLogging:           x x x x x | x x x x x;
    FREE_INSTANCE                      fmi3FreeInstance:              x x x x x | x x x x x;
    ENTER_INITIALIZATION_MODE          fmi3EnterInitializationMode:   x - - - - | x - - - -;
    EXIT_INITIALIZATION_MODE           fmi3ExitInitializationMode:    - x - - - | - x - - -;
    ENTER_EVENT_MODE                   fmi3EnterEventMode:            - - - x - | - - - x -;
    TERMINATE                          fmi3Terminate:                 - - x x - | - - x x -;
    RESET                              fmi3Reset:                     x x x x x | x x x x x;
    GET_FLOAT32                        fmi3GetFloat32:                x x x x x | x x x x x;
    GET_FLOAT64                        fmi3GetFloat64:                x x x x x | x x x x x;
    GET_INT8                           fmi3GetInt8:                   x x x x x | x x x x x;
    GET_UINT8                          fmi3GetUInt8:                  x x x x x | x x x x x;
    GET_INT16                          fmi3GetInt16:                  x x x x x | x x x x x;
    GET_UINT16                         fmi3GetUInt16:                 x x x x x | x x x x x;
    GET_INT32                          fmi3GetInt32:                  x x x x x | x x x x x;
    GET_UINT32                         fmi3GetUInt32:                 x x x x x | x x x x x;
    GET_INT64                          fmi3GetInt64:                  x x x x x | x x x x x;
    GET_UINT64                         fmi3GetUInt64:                 x x x x x | x x x x x;
    GET_BOOLEAN                        fmi3GetBoolean:                x x x x x | x x x x x;
    GET_STRING                         fmi3GetString:                 x x x x x | x x x x x;
    GET_BINARY                         fmi3GetBinary:                 x x x x x | x x x x x;
    GET_CLOCK                          fmi3GetClock:                  - - x - - | - - x - -;
    SET_FLOAT32                        fmi3SetFloat32:                x x x x - | x x x x -;
    SET_FLOAT64                        fmi3SetFloat64:                x x x x - | x x x x -;
    SET_INT8                           fmi3SetInt8:                   x x x - - | x x x x -;
    SET_UINT8                          fmi3SetUInt8:                  x x x - - | x x x x -;
    SET_INT16                          fmi3SetInt16:                  x x x - - | x x x x -;
    SET_UINT16                         fmi3SetUInt16:                 x x x - - | x x x x -;
    SET_INT32                          fmi3SetInt32:                  x x x - - | x x x x -;
    SET_UINT32                         fmi3SetUInt32:                 x x x - - | x x x x -;
    SET_INT64                          fmi3SetInt64:                  x x x - - | x x x x -;
    SET_UINT64                         fmi3SetUInt64:                 x x x - - | x x x x -;
    SET_BOOLEAN                        fmi3SetBoolean:                x x x - - | x x x x -;
    SET_STRING                         fmi3SetString:                 x x x - - | x x x x -;
    SET_BINARY                         fmi3SetBinary:                 x x x - - | x x x x -;
    SET_CLOCK                          fmi3SetClock:                  - - x - - | - - x - -;
    GET_NUMBER_OF_VARIABLE_DEPENDENCIES fmi3GetNumberOfVariableDependencies:
                                                                      - - - - - | - - - - -;
    GET_VARIABLE_DEPENDENCIES          fmi3GetVariableDependencies:   - - - - - | - - - - -;
    GET_FMU_STATE                      fmi3GetFMUState:               x x x x x | x x x x x;
    SET_FMU_STATE                      fmi3SetFMUState:               x x x x x | x x x x x;
    FREE_FMU_STATE                     fmi3FreeFMUState:              x x x x x | x x x x x;
    SERIALIZED_FMU_STATE_SIZE          fmi3SerializedFMUStateSize:    x x x x x | x x x x x;
    SERIALIZE_FMU_STATE                fmi3SerializeFMUState:         x x x x x | x x x x x;
    DE_SERIALIZE_FMU_STATE             fmi3DeserializeFMUState:       x x x x x | x x x x x;
    GET_DIRECTIONAL_DERIVATIVE         fmi3GetDirectionalDerivative:  - x x x x | - x x x x;
    GET_ADJOINT_DERIVATIVE             fmi3GetAdjointDerivative:      - x x x x | - x x x x;
    ENTER_CONFIGURATION_MODE           fmi3EnterConfigurationMode:    - - - - - | - - - - -;
    EXIT_CONFIGURATION_MODE            fmi3ExitConfigurationMode:     - - - - - | - - - - -;
    GET_INTERVAL_DECIMAL               fmi3GetIntervalDecimal:        - - - - - | - - - - -;
    GET_INTERVAL_FRACTION              fmi3GetIntervalFraction:       - - - - - | - - - - -;
    GET_SHIFT_DECIMAL                  fmi3GetShiftDecimal:           - - - - - | - - - - -;
    GET_SHIFT_FRACTION                 fmi3GetShiftFraction:          - - - - - | - - - - -;
    SET_INTERVAL_DECIMAL               fmi3SetIntervalDecimal:        - - - - - | - - - - -;
    SET_INTERVAL_FRACTION              fmi3SetIntervalFraction:       - - - - - | - - - - -;
    SET_SHIFT_DECIMAL                  fmi3SetShiftDecimal:           - - - - - | - - - - -;
    SET_SHIFT_FRACTION                 fmi3SetShiftFraction:          - - - - - | - - - - -;
    EVALUATE_DISCRETE_STATES           fmi3EvaluateDiscreteStates:    - - - - - | - - - - -;
    UPDATE_DISCRETE_STATES             fmi3UpdateDiscreteStates:      - - x - - | - - x - -;
    ENTER_CONTINUOUS_TIME_MODE         fmi3EnterContinuousTimeMode:   - - x - - | - - - - -;
    COMPLETED_INTEGRATOR_STEP          fmi3CompletedIntegratorStep:   - - - x - | - - - - -;
    SET_TIME                           fmi3SetTime:                   - - - x - | - - - - -;
    SET_CONTINUOUS_STATES              fmi3SetContinuousStates:       - - - x - | - - - - -;
    GET_CONTINUOUS_STATE_DERIVATIVES   fmi3GetContinuousStateDerivatives:
                                                                      - x x x x | - - - - -;
    GET_EVENT_INDICATORS               fmi3GetEventIndicators:        - x x x x | - - - - -;
    GET_CONTINUOUS_STATES              fmi3GetContinuousStates:       - x x x x | - - - - -;
    GET_NOMINALS_OF_CONTINUOUS_STATES  fmi3GetNominalsOfContinuousStates:
                                                                      - x x x x | - - - - -;
    GET_NUMBER_OF_EVENT_INDICATORS     fmi3GetNumberOfEventIndicators:
                                                                      x x x x x | - - - - -;
    GET_NUMBER_OF_CONTINUOUS_STATES    fmi3GetNumberOfContinuousStates:
                                                                      x x x x x | - - - - -;
    ENTER_STEP_MODE                    fmi3EnterStepMode:             - - - - - | - - x - -;
    GET_OUTPUT_DERIVATIVES             fmi3GetOutputDerivatives:      - - - - - | - - - x x;
    DO_STEP                            fmi3DoStep:                    - - - - - | - - - x -;
    ACTIVATE_MODEL_PARTITION           fmi3ActivateModelPartition:    - - - - - | - - - - -;
}
