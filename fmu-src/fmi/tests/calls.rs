//! Every function in every state, and calls at random.

use std::ptr;

use crate::common::{models::*, *};
use proptest::prelude::*;
use strut_fmi::{
    fmi2::{
        state_table::{FREE_INSTANCE, FUNCTIONS, RESET},
        types::*,
    },
    shared::{self, Kind, Phase, State},
};
use strut_model::Model;

/// Calls a function with arguments that are right, or as right as can be.
fn call<M: Model>(host: &Host<M>, name: &str) -> Status {
    let (mut real, mut integer, mut text, mut size) = (0.0, 0, ptr::null(), 0);
    let (mut status, mut yes, mut end) = (Status::Ok, 0, 0);
    let mut info: EventInfo = EventInfo {
        new_discrete_states_needed: 0,
        terminate_simulation: 0,
        nominals_of_continuous_states_changed: 0,
        values_of_continuous_states_changed: 0,
        next_event_time_defined: 0,
        next_event_time: 0.0,
    };
    let force = reference::<M>("force");
    let signal = reference::<M>("signal");
    match name {
        "fmi2SetDebugLogging" => host.set_debug_logging(TRUE, 0, ptr::null()),
        "fmi2SetupExperiment" => host.setup_experiment(FALSE, 0.0, 0.0, FALSE, 0.0),
        "fmi2EnterInitializationMode" => host.enter_initialization_mode(),
        "fmi2ExitInitializationMode" => host.exit_initialization_mode(),
        "fmi2Terminate" => host.terminate(),
        "fmi2Reset" => host.reset(),
        "fmi2GetReal" => host.get_real(&force, 1, &mut real),
        "fmi2GetInteger" => host.get_integer(&0, 1, &mut integer),
        "fmi2GetBoolean" => host.get_boolean(ptr::null(), 0, &mut integer),
        "fmi2GetString" => host.get_string(ptr::null(), 0, &mut text),
        "fmi2SetReal" => host.set_real(&force, 1, &0.0),
        "fmi2SetInteger" => host.set_integer(ptr::null(), 0, &0),
        "fmi2SetBoolean" => host.set_boolean(ptr::null(), 0, &0),
        "fmi2SetString" => host.set_string(ptr::null(), 0, &text),
        "fmi2GetFMUstate" => host.get_fmu_state(&mut ptr::null_mut()),
        "fmi2SetFMUstate"
        | "fmi2FreeFMUstate"
        | "fmi2SerializedFMUstateSize"
        | "fmi2SerializeFMUstate"
        | "fmi2DeSerializeFMUstate" => {
            let mut state = ptr::null_mut();
            let saved = host.get_fmu_state(&mut state);
            if saved != Status::Ok {
                return saved;
            }
            match name {
                "fmi2SetFMUstate" => host.set_fmu_state(state),
                "fmi2FreeFMUstate" => host.free_fmu_state(&mut state),
                "fmi2SerializedFMUstateSize" => host.serialized_fmu_state_size(state, &mut size),
                _ => host.deserialize(&host.serialize(state)).0,
            }
        }
        "fmi2GetDirectionalDerivative" => {
            host.get_directional_derivative(&signal, 1, &force, 1, &1.0, &mut real)
        }
        "fmi2EnterEventMode" => host.enter_event_mode(),
        "fmi2NewDiscreteStates" => host.new_discrete_states(&mut info),
        "fmi2EnterContinuousTimeMode" => host.enter_continuous_time_mode(),
        "fmi2CompletedIntegratorStep" => host.completed_integrator_step(TRUE, &mut yes, &mut end),
        "fmi2SetTime" => host.set_time(0.0),
        "fmi2SetContinuousStates" => host.set_continuous_states(&0.5, 1),
        "fmi2GetEventIndicators" => host.get_event_indicators(&mut real, 1),
        "fmi2GetContinuousStates" => host.get_continuous_states(&mut real, 1),
        "fmi2GetDerivatives" => host.get_derivatives(&mut real, 1),
        "fmi2GetNominalsOfContinuousStates" => host.get_nominals_of_continuous_states(&mut real, 1),
        "fmi2SetRealInputDerivatives" => host.set_real_input_derivatives(&force, 1, &1, &0.0),
        "fmi2GetRealOutputDerivatives" => host.get_real_output_derivatives(&signal, 1, &1, &mut real),
        "fmi2DoStep" => host.do_step(0.0, 0.1, TRUE),
        "fmi2CancelStep" => host.cancel_step(),
        "fmi2GetStatus" => host.get_status(0, &mut status),
        "fmi2GetRealStatus" => host.get_real_status(2, &mut real),
        "fmi2GetIntegerStatus" => host.get_integer_status(0, &mut integer),
        "fmi2GetBooleanStatus" => host.get_boolean_status(3, &mut integer),
        "fmi2GetStringStatus" => host.get_string_status(1, &mut text),
        other => panic!("the test does not know {other}"),
    }
}

/// An instance in a state.
fn in_state(state: State) -> Host<Fragile> {
    let host = Host::<Fragile>::new(state.kind() as RawType);
    let ok = |status| assert_eq!(status, Status::Ok);
    if state.phase() == Phase::Instantiated {
        return host;
    }
    ok(host.setup_experiment(FALSE, 0.0, 0.0, FALSE, 0.0));
    ok(host.enter_initialization_mode());
    if state.phase() == Phase::Initialization {
        return host;
    }
    ok(host.exit_initialization_mode());
    match state.phase() {
        Phase::Continuous => ok(host.enter_continuous_time_mode()),
        Phase::StepFailed => {
            ok(host.set("force", 1e200));
            assert_eq!(host.do_step(0.0, 1e3, TRUE), Status::Discard);
        }
        Phase::Terminated => ok(host.terminate()),
        _ => {}
    }
    host.messages();
    host
}

fn states() -> impl Iterator<Item = State> {
    strut_fmi::fmi2::state_table::GET_FMU_STATE.legal.iter()
}

#[test]
fn every_function_is_legal_where_the_table_says_so_and_nowhere_else() {
    // What the standard lets one ask, but a synchronous instance cannot answer.
    let unanswered = ["fmi2GetStatus", "fmi2GetIntegerStatus", "fmi2GetStringStatus"];
    assert_eq!(states().count(), 10);
    for state in states() {
        for function in FUNCTIONS.iter().filter(|function| function.name != "fmi2FreeInstance") {
            let host = in_state(state);
            let status = call(&host, function.name);
            let expected = match (function.legal.contains(state), unanswered.contains(&function.name)) {
                (false, _) => Status::Error,
                (true, true) => Status::Discard,
                (true, false) => Status::Ok,
            };
            assert_eq!(status, expected, "{} in {state:?}: {:?}", function.name, host.messages());
            if expected == Status::Error {
                let message = host.message();
                assert!(message.format.starts_with(function.name), "{message:?}");
                assert_eq!((message.category.as_str(), message.status), ("logStatusError", Status::Error));
                // Nothing has changed: what was legal still is.
                assert_eq!(call(&host, "fmi2SetDebugLogging"), Status::Ok);
                assert_eq!(call(&host, "fmi2Reset"), Status::Ok);
            }
        }
    }
}

#[test]
fn a_saved_state_contains_its_place_in_the_state_machine() {
    for state in states() {
        let host = in_state(state);
        let saved = host.save();
        assert_eq!(host.reset(), Status::Ok);
        assert_eq!(host.set_fmu_state(saved), Status::Ok);
        let probe = if state.kind() == Kind::CoSimulation { "fmi2DoStep" } else { "fmi2SetTime" };
        let legal = FUNCTIONS.iter().find(|function| function.name == probe).unwrap().legal.contains(state);
        assert_eq!(call(&host, probe) == Status::Ok, legal, "{state:?}");
    }
}

#[test]
fn no_instance_is_an_error() {
    let host = Host::<Decay>::new(CS);
    let mut strange = [7_u64; 64];
    for pointer in [ptr::null_mut(), strange.as_mut_ptr().cast(), host.c.wrapping_byte_add(1)] {
        // SAFETY: null, misaligned or readable memory that is no instance.
        unsafe {
            assert_eq!(shared::reset::<Decay>(&RESET, pointer), Status::Error);
            shared::free_instance::<Decay>(&FREE_INSTANCE, pointer);
        }
    }
}

#[test]
fn a_panic_ends_at_the_border() {
    let host = Host::<Fragile>::initialized(CS);
    let mut value = 0.0;
    assert_eq!(host.set("force", 13.0), Status::Ok);
    assert_eq!(host.do_step(0.0, 0.1, TRUE), Status::Fatal);
    let message = host.message();
    assert_eq!((message.category.as_str(), message.status), ("logStatusFatal", Status::Fatal));
    assert!(message.format.contains("100 %% unlucky %%s"), "{message:?}");
    for function in FUNCTIONS.iter().filter(|function| function.name != "fmi2FreeInstance") {
        assert_eq!(call(&host, function.name), Status::Fatal, "{}", function.name);
    }
    assert_eq!(host.get_real(&0, 1, &mut value), Status::Fatal);
    let other = Host::<Fragile>::initialized(CS);
    assert_eq!(other.do_step(0.0, 0.1, TRUE), Status::Ok);
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..2.0,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(-0.0),
        1 => any::<f64>(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any sequence of calls, legal or not, with any numbers, ends in a status and leaves an instance
    /// that resets to a fresh one.
    #[test]
    fn no_sequence_of_calls_does_harm(
        kind in 0..2,
        calls in prop::collection::vec((0..FUNCTIONS.len() + 6, any_number(), any_number(), 0_u32..9), 0..40),
    ) {
        let host = Host::<Hybrid>::new(kind);
        let fresh = { let fresh = Host::<Hybrid>::initialized(kind); fresh.bits() };
        let mut state = ptr::null_mut();
        for (index, a, b, vr) in calls {
            let status = match index.checked_sub(FUNCTIONS.len()) {
                None if FUNCTIONS[index].name == "fmi2FreeInstance" => continue,
                None => call(&host, FUNCTIONS[index].name),
                Some(0) => host.set_real(&vr, 1, &a),
                Some(1) => host.setup_experiment(TRUE, a, b, TRUE, a + b),
                // Real steps: a long one is a matter of minutes.
                Some(2) => host.do_step(0.1 * f64::from(vr), if b.abs() < 1.0 { b } else { f64::NAN }, TRUE),
                Some(3) => host.get_fmu_state(&mut state),
                Some(4) => host.set_fmu_state(state),
                _ => host.set_real_input_derivatives(&vr, 1, &(vr as i32 - 1), &b),
            };
            prop_assert_ne!(status, Status::Fatal);
            prop_assert_ne!(status, Status::Pending);
            // A call that succeeds may still tell what the integration has cost.
            let complaints = host.messages().iter().filter(|told| told.status != Status::Ok).count();
            prop_assert_eq!(status == Status::Ok, complaints == 0);
        }
        prop_assert_eq!(host.reset(), Status::Ok);
        host.initialize();
        prop_assert_eq!(host.bits(), fresh);
    }
}
