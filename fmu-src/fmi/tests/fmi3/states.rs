//! Every function in every state.

use std::ptr;

use strut_fmi::{
    fmi3::{
        functions as f,
        state_table::{FUNCTIONS, GET_FMU_STATE},
        types::*,
    },
    shared::{self, Function, Kind, Phase, State},
};

use super::{host::Host, reference};
use crate::common::models::Decay;

/// Calls a function with arguments that are right.
fn call(host: &Host<Decay>, function: &Function) -> Status {
    let c = host.component;
    let (mut real, mut boolean, mut size, mut state) = (0.5, 0, 0, ptr::null_mut());
    let (force, signal) = (reference::<Decay>("force"), reference::<Decay>("signal"));
    // SAFETY: the component is ours, and every argument lives.
    unsafe {
        match function.name {
            "fmi3SetDebugLogging" => host.set_debug_logging(true, &[]),
            "fmi3EnterInitializationMode" => host.enter_initialization_mode(None, 0.0, None),
            "fmi3ExitInitializationMode" => host.exit_initialization_mode(),
            "fmi3EnterEventMode" => host.enter_event_mode(),
            "fmi3EnterStepMode" => host.enter_step_mode(),
            "fmi3Terminate" => host.terminate(),
            "fmi3Reset" => host.reset(),
            "fmi3GetFloat64" => f::get_float64::<Decay>(c, &force, 1, &mut real, 1),
            "fmi3SetFloat64" => f::set_float64::<Decay>(c, &force, 1, &real, 1),
            "fmi3GetInt32" => f::get_int32::<Decay>(c, ptr::null(), 0, ptr::null_mut(), 0),
            "fmi3SetInt32" => f::set_int32::<Decay>(c, ptr::null(), 0, ptr::null(), 0),
            "fmi3GetInt64" => f::get_int64::<Decay>(c, ptr::null(), 0, ptr::null_mut(), 0),
            "fmi3SetInt64" => f::set_int64::<Decay>(c, ptr::null(), 0, ptr::null(), 0),
            "fmi3GetBoolean" => f::get_boolean::<Decay>(c, ptr::null(), 0, ptr::null_mut(), 0),
            "fmi3SetBoolean" => f::set_boolean::<Decay>(c, ptr::null(), 0, ptr::null(), 0),
            "fmi3GetString" => f::get_string::<Decay>(c, ptr::null(), 0, ptr::null_mut(), 0),
            "fmi3SetString" => f::set_string::<Decay>(c, ptr::null(), 0, ptr::null(), 0),
            "fmi3GetFMUState" => shared::get_fmu_state::<Decay>(function, c, &mut state),
            name if name.ends_with("FMUState") || name.ends_with("FMUStateSize") => {
                let bytes = host.bytes();
                assert_eq!(shared::get_fmu_state::<Decay>(&GET_FMU_STATE, c, &mut state), Status::Ok);
                match name {
                    "fmi3SetFMUState" => shared::set_fmu_state::<Decay>(function, c, state),
                    "fmi3FreeFMUState" => shared::free_fmu_state::<Decay>(function, c, &mut state),
                    "fmi3SerializedFMUStateSize" => {
                        shared::serialized_fmu_state_size::<Decay>(function, c, state, &mut size)
                    }
                    "fmi3SerializeFMUState" => Status::Ok,
                    _ => shared::de_serialize_fmu_state::<Decay>(
                        function,
                        c,
                        bytes.as_ptr(),
                        bytes.len(),
                        &mut state,
                    ),
                }
            }
            "fmi3GetDirectionalDerivative" => {
                host.directional(&[signal], &[force], &[1.0], 1).err().unwrap_or(Status::Ok)
            }
            "fmi3GetAdjointDerivative" => {
                host.adjoint(&[signal], &[force], &[1.0], 1).err().unwrap_or(Status::Ok)
            }
            "fmi3UpdateDiscreteStates" => host.update().err().unwrap_or(Status::Ok),
            "fmi3EnterContinuousTimeMode" => host.enter_continuous_time_mode(),
            "fmi3CompletedIntegratorStep" => {
                let mut end = 0;
                f::completed_integrator_step::<Decay>(c, TRUE, &mut boolean, &mut end)
            }
            "fmi3SetTime" => shared::set_time::<Decay>(function, c, 0.0),
            "fmi3SetContinuousStates" => shared::set_continuous_states::<Decay>(function, c, &real, 1),
            "fmi3GetContinuousStateDerivatives" => {
                shared::get_derivatives::<Decay>(function, c, &mut real, 1)
            }
            "fmi3GetEventIndicators" => shared::get_event_indicators::<Decay>(function, c, &mut real, 1),
            "fmi3GetContinuousStates" => shared::get_continuous_states::<Decay>(function, c, &mut real, 1),
            "fmi3GetNominalsOfContinuousStates" => {
                shared::get_nominals_of_continuous_states::<Decay>(function, c, &mut real, 1)
            }
            "fmi3GetNumberOfEventIndicators" => f::get_number_of_event_indicators::<Decay>(c, &mut size),
            "fmi3GetNumberOfContinuousStates" => f::get_number_of_continuous_states::<Decay>(c, &mut size),
            "fmi3GetOutputDerivatives" => f::get_output_derivatives::<Decay>(c, &signal, 1, &1, &mut real, 1),
            "fmi3DoStep" => host.do_step(0.0, 0.1).err().unwrap_or(Status::Ok),
            // Types that no FMU has, and what no FMU offers.
            _ if function.legal.iter().count() > 0 => f::absent::<Decay>(function, c, 0),
            _ => f::never::<Decay>(function, c),
        }
    }
}

/// An instance in a state.
fn in_state(state: State) -> Host<Decay> {
    let host = match state.kind() {
        Kind::ModelExchange => Host::model_exchange(),
        Kind::CoSimulation => Host::with_events(true, true),
    };
    let ok = |status| assert_eq!(status, Status::Ok);
    if state.phase() == Phase::Instantiated {
        return host;
    }
    ok(host.enter_initialization_mode(None, 0.0, None));
    if state.phase() == Phase::Initialization {
        return host;
    }
    ok(host.exit_initialization_mode());
    match state.phase() {
        Phase::Continuous => ok(host.enter_continuous_time_mode()),
        Phase::StepComplete => ok(host.enter_step_mode()),
        Phase::Terminated => ok(host.terminate()),
        _ => {}
    }
    host
}

#[test]
fn every_function_is_legal_where_the_table_says_so_and_nowhere_else() {
    assert_eq!(GET_FMU_STATE.legal.iter().count(), 10);
    for state in GET_FMU_STATE.legal.iter() {
        for function in FUNCTIONS.iter().filter(|function| function.name != "fmi3FreeInstance") {
            let host = in_state(state);
            let status = call(&host, function);
            let legal = function.legal.contains(state);
            let expected = if legal { Status::Ok } else { Status::Error };
            assert_eq!(status, expected, "{} in {state:?}: {}", function.name, host.last_message());
            if !legal {
                assert!(host.last_message().starts_with(function.name), "{}", host.last_message());
                // Nothing has changed: what was legal still is.
                assert_eq!(host.reset(), Status::Ok);
            }
        }
    }
}
