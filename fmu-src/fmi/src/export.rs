//! The macro that makes a library an FMU's.

/// Exports every function of FMI 2.0 and FMI 3.0 for a model, and the model's [`Entry`](strut_model::Entry) as `ENTRY`.
///
/// This is the whole of an FMU's library crate, a `cdylib`:
///
/// ```text
/// //! QuarterCar as an FMU.
/// strut_fmi::export_fmu!(strut_physics::rigs::QuarterCar);
/// ```
///
/// The functions have to be made there: symbols of a dependency are not exported from a `cdylib`. What both versions share
/// is a function of [`shared`](crate::shared) with the version's line of its state table.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        /// The model, for catalogues.
        pub const ENTRY: $crate::Entry = $crate::Entry::of::<$model>();

        const _: () = {
            use $crate::fmi2::types::*;

            $crate::export_fmu! { @plain fmi2;
                fmi2GetTypesPlatform() -> Text = types_platform;
                fmi2GetVersion() -> Text = version;
            }
            $crate::export_fmu! { @own fmi2 $model;
                fmi2Instantiate(name: Text, kind: RawType, guid: Text, resources: Text, functions: *const CallbackFunctions, visible: Boolean, logging_on: Boolean) -> Component = instantiate;
                fmi2SetDebugLogging(c: Component, logging_on: Boolean, n: Size, categories: *const Text) -> Status = set_debug_logging;
                fmi2SetupExperiment(c: Component, tolerance_defined: Boolean, tolerance: Real, start: Real, stop_defined: Boolean, stop: Real) -> Status = setup_experiment;
                fmi2EnterInitializationMode(c: Component) -> Status = enter_initialization_mode;
                fmi2GetReal(c: Component, vr: *const ValueReference, n: Size, value: *mut Real) -> Status = get_real;
                fmi2GetInteger(c: Component, vr: *const ValueReference, n: Size, value: *mut Integer) -> Status = get_integer;
                fmi2GetBoolean(c: Component, vr: *const ValueReference, n: Size, value: *mut Boolean) -> Status = get_boolean;
                fmi2GetString(c: Component, vr: *const ValueReference, n: Size, value: *mut Text) -> Status = get_string;
                fmi2SetReal(c: Component, vr: *const ValueReference, n: Size, value: *const Real) -> Status = set_real;
                fmi2SetInteger(c: Component, vr: *const ValueReference, n: Size, value: *const Integer) -> Status = set_integer;
                fmi2SetBoolean(c: Component, vr: *const ValueReference, n: Size, value: *const Boolean) -> Status = set_boolean;
                fmi2SetString(c: Component, vr: *const ValueReference, n: Size, value: *const Text) -> Status = set_string;
                fmi2GetDirectionalDerivative(c: Component, unknowns: *const ValueReference, n: Size, knowns: *const ValueReference, m: Size, seed: *const Real, sensitivity: *mut Real) -> Status = get_directional_derivative;
                fmi2NewDiscreteStates(c: Component, info: *mut EventInfo) -> Status = new_discrete_states;
                fmi2CompletedIntegratorStep(c: Component, no_set_state: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean) -> Status = completed_integrator_step;
                fmi2SetRealInputDerivatives(c: Component, vr: *const ValueReference, n: Size, order: *const Integer, value: *const Real) -> Status = set_real_input_derivatives;
                fmi2GetRealOutputDerivatives(c: Component, vr: *const ValueReference, n: Size, order: *const Integer, value: *mut Real) -> Status = get_real_output_derivatives;
                fmi2DoStep(c: Component, point: Real, size: Real, no_set_state: Boolean) -> Status = do_step;
                fmi2CancelStep(c: Component) -> Status = cancel_step;
                fmi2GetStatus(c: Component, kind: RawStatusKind, value: *mut Status) -> Status = get_status;
                fmi2GetRealStatus(c: Component, kind: RawStatusKind, value: *mut Real) -> Status = get_real_status;
                fmi2GetIntegerStatus(c: Component, kind: RawStatusKind, value: *mut Integer) -> Status = get_integer_status;
                fmi2GetBooleanStatus(c: Component, kind: RawStatusKind, value: *mut Boolean) -> Status = get_boolean_status;
                fmi2GetStringStatus(c: Component, kind: RawStatusKind, value: *mut Text) -> Status = get_string_status;
            }
            $crate::export_fmu! { @shared fmi2 $model;
                fmi2FreeInstance(c: Component) -> () = free_instance, FREE_INSTANCE;
                fmi2ExitInitializationMode(c: Component) -> Status = exit_initialization_mode, EXIT_INITIALIZATION_MODE;
                fmi2Terminate(c: Component) -> Status = terminate, TERMINATE;
                fmi2Reset(c: Component) -> Status = reset, RESET;
                fmi2GetFMUstate(c: Component, state: *mut FmuState) -> Status = get_fmu_state, GET_FMU_STATE;
                fmi2SetFMUstate(c: Component, state: FmuState) -> Status = set_fmu_state, SET_FMU_STATE;
                fmi2FreeFMUstate(c: Component, state: *mut FmuState) -> Status = free_fmu_state, FREE_FMU_STATE;
                fmi2SerializedFMUstateSize(c: Component, state: FmuState, size: *mut Size) -> Status = serialized_fmu_state_size, SERIALIZED_FMU_STATE_SIZE;
                fmi2SerializeFMUstate(c: Component, state: FmuState, bytes: *mut Byte, size: Size) -> Status = serialize_fmu_state, SERIALIZE_FMU_STATE;
                fmi2DeSerializeFMUstate(c: Component, bytes: *const Byte, size: Size, state: *mut FmuState) -> Status = de_serialize_fmu_state, DE_SERIALIZE_FMU_STATE;
                fmi2EnterEventMode(c: Component) -> Status = enter_event_mode, ENTER_EVENT_MODE;
                fmi2EnterContinuousTimeMode(c: Component) -> Status = enter_continuous_time_mode, ENTER_CONTINUOUS_TIME_MODE;
                fmi2SetTime(c: Component, time: Real) -> Status = set_time, SET_TIME;
                fmi2SetContinuousStates(c: Component, x: *const Real, n: Size) -> Status = set_continuous_states, SET_CONTINUOUS_STATES;
                fmi2GetDerivatives(c: Component, derivatives: *mut Real, n: Size) -> Status = get_derivatives, GET_DERIVATIVES;
                fmi2GetEventIndicators(c: Component, indicators: *mut Real, n: Size) -> Status = get_event_indicators, GET_EVENT_INDICATORS;
                fmi2GetContinuousStates(c: Component, x: *mut Real, n: Size) -> Status = get_continuous_states, GET_CONTINUOUS_STATES;
                fmi2GetNominalsOfContinuousStates(c: Component, nominals: *mut Real, n: Size) -> Status = get_nominals_of_continuous_states, GET_NOMINALS_OF_CONTINUOUS_STATES;
            }
        };

        const _: () = {
            use $crate::fmi3::types::*;

            $crate::export_fmu! { @plain fmi3;
                fmi3GetVersion() -> Text = version;
            }
            $crate::export_fmu! { @own fmi3 $model;
                fmi3InstantiateModelExchange(name: Text, token: Text, resources: Text, visible: Boolean, logging_on: Boolean, environment: ComponentEnvironment, log: Option<LogMessage>) -> Component = instantiate_model_exchange;
                fmi3InstantiateCoSimulation(name: Text, token: Text, resources: Text, visible: Boolean, logging_on: Boolean, event_mode_used: Boolean, early_return_allowed: Boolean, intermediate: *const ValueReference, n: Size, environment: ComponentEnvironment, log: Option<LogMessage>, update: IntermediateUpdate) -> Component = instantiate_co_simulation;
                fmi3InstantiateScheduledExecution(name: Text, token: Text, resources: Text, visible: Boolean, logging_on: Boolean, environment: ComponentEnvironment, log: Option<LogMessage>, clock: Callback, lock: Callback, unlock: Callback) -> Component = instantiate_scheduled_execution;
                fmi3SetDebugLogging(c: Component, logging_on: Boolean, n: Size, categories: *const Text) -> Status = set_debug_logging;
                fmi3EnterInitializationMode(c: Component, tolerance_defined: Boolean, tolerance: Real, start: Real, stop_defined: Boolean, stop: Real) -> Status = enter_initialization_mode;
                fmi3EnterEventMode(c: Component) -> Status = enter_event_mode;

                fmi3GetFloat64(c: Component, vr: *const ValueReference, n: Size, values: *mut Real, n_values: Size) -> Status = get_float64;
                fmi3SetFloat64(c: Component, vr: *const ValueReference, n: Size, values: *const Real, n_values: Size) -> Status = set_float64;
                fmi3GetInt32(c: Component, vr: *const ValueReference, n: Size, values: *mut i32, n_values: Size) -> Status = get_int32;
                fmi3SetInt32(c: Component, vr: *const ValueReference, n: Size, values: *const i32, n_values: Size) -> Status = set_int32;
                fmi3GetInt64(c: Component, vr: *const ValueReference, n: Size, values: *mut i64, n_values: Size) -> Status = get_int64;
                fmi3SetInt64(c: Component, vr: *const ValueReference, n: Size, values: *const i64, n_values: Size) -> Status = set_int64;
                fmi3GetBoolean(c: Component, vr: *const ValueReference, n: Size, values: *mut Boolean, n_values: Size) -> Status = get_boolean;
                fmi3SetBoolean(c: Component, vr: *const ValueReference, n: Size, values: *const Boolean, n_values: Size) -> Status = set_boolean;
                fmi3GetString(c: Component, vr: *const ValueReference, n: Size, values: *mut Text, n_values: Size) -> Status = get_string;
                fmi3SetString(c: Component, vr: *const ValueReference, n: Size, values: *const Text, n_values: Size) -> Status = set_string;

                fmi3GetDirectionalDerivative(c: Component, unknowns: *const ValueReference, n: Size, knowns: *const ValueReference, m: Size, seed: *const Real, n_seed: Size, sensitivity: *mut Real, n_sensitivity: Size) -> Status = get_directional_derivative;
                fmi3GetAdjointDerivative(c: Component, unknowns: *const ValueReference, n: Size, knowns: *const ValueReference, m: Size, seed: *const Real, n_seed: Size, sensitivity: *mut Real, n_sensitivity: Size) -> Status = get_adjoint_derivative;
                fmi3GetOutputDerivatives(c: Component, vr: *const ValueReference, n: Size, orders: *const i32, values: *mut Real, n_values: Size) -> Status = get_output_derivatives;

                fmi3UpdateDiscreteStates(c: Component, again: *mut Boolean, terminate: *mut Boolean, nominals: *mut Boolean, states: *mut Boolean, next_defined: *mut Boolean, next: *mut Real) -> Status = update_discrete_states;
                fmi3CompletedIntegratorStep(c: Component, no_set_state: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean) -> Status = completed_integrator_step;
                fmi3GetNumberOfContinuousStates(c: Component, number: *mut Size) -> Status = get_number_of_continuous_states;
                fmi3GetNumberOfEventIndicators(c: Component, number: *mut Size) -> Status = get_number_of_event_indicators;
                fmi3EnterStepMode(c: Component) -> Status = enter_step_mode;
                fmi3DoStep(c: Component, point: Real, size: Real, no_set_state: Boolean, event_needed: *mut Boolean, terminate: *mut Boolean, early_return: *mut Boolean, reached: *mut Real) -> Status = do_step;
            }
            $crate::export_fmu! { @shared fmi3 $model;
                fmi3FreeInstance(c: Component) -> () = free_instance, FREE_INSTANCE;
                fmi3ExitInitializationMode(c: Component) -> Status = exit_initialization_mode, EXIT_INITIALIZATION_MODE;
                fmi3Terminate(c: Component) -> Status = terminate, TERMINATE;
                fmi3Reset(c: Component) -> Status = reset, RESET;
                fmi3EnterContinuousTimeMode(c: Component) -> Status = enter_continuous_time_mode, ENTER_CONTINUOUS_TIME_MODE;
                fmi3SetTime(c: Component, time: Real) -> Status = set_time, SET_TIME;
                fmi3SetContinuousStates(c: Component, x: *const Real, n: Size) -> Status = set_continuous_states, SET_CONTINUOUS_STATES;
                fmi3GetContinuousStateDerivatives(c: Component, derivatives: *mut Real, n: Size) -> Status = get_derivatives, GET_CONTINUOUS_STATE_DERIVATIVES;
                fmi3GetEventIndicators(c: Component, indicators: *mut Real, n: Size) -> Status = get_event_indicators, GET_EVENT_INDICATORS;
                fmi3GetContinuousStates(c: Component, x: *mut Real, n: Size) -> Status = get_continuous_states, GET_CONTINUOUS_STATES;
                fmi3GetNominalsOfContinuousStates(c: Component, nominals: *mut Real, n: Size) -> Status = get_nominals_of_continuous_states, GET_NOMINALS_OF_CONTINUOUS_STATES;
                fmi3GetFMUState(c: Component, state: *mut FmuState) -> Status = get_fmu_state, GET_FMU_STATE;
                fmi3SetFMUState(c: Component, state: FmuState) -> Status = set_fmu_state, SET_FMU_STATE;
                fmi3FreeFMUState(c: Component, state: *mut FmuState) -> Status = free_fmu_state, FREE_FMU_STATE;
                fmi3SerializedFMUStateSize(c: Component, state: FmuState, size: *mut Size) -> Status = serialized_fmu_state_size, SERIALIZED_FMU_STATE_SIZE;
                fmi3SerializeFMUState(c: Component, state: FmuState, bytes: *mut u8, size: Size) -> Status = serialize_fmu_state, SERIALIZE_FMU_STATE;
                fmi3DeserializeFMUState(c: Component, bytes: *const u8, size: Size, state: *mut FmuState) -> Status = de_serialize_fmu_state, DE_SERIALIZE_FMU_STATE;
            }
            $crate::export_fmu! { @absent $model;
                fmi3GetFloat32(c, vr, n, values: *mut f32, n_values: Size) = GET_FLOAT32;
                fmi3SetFloat32(c, vr, n, values: *const f32, n_values: Size) = SET_FLOAT32;
                fmi3GetInt8(c, vr, n, values: *mut i8, n_values: Size) = GET_INT8;
                fmi3SetInt8(c, vr, n, values: *const i8, n_values: Size) = SET_INT8;
                fmi3GetUInt8(c, vr, n, values: *mut u8, n_values: Size) = GET_UINT8;
                fmi3SetUInt8(c, vr, n, values: *const u8, n_values: Size) = SET_UINT8;
                fmi3GetInt16(c, vr, n, values: *mut i16, n_values: Size) = GET_INT16;
                fmi3SetInt16(c, vr, n, values: *const i16, n_values: Size) = SET_INT16;
                fmi3GetUInt16(c, vr, n, values: *mut u16, n_values: Size) = GET_UINT16;
                fmi3SetUInt16(c, vr, n, values: *const u16, n_values: Size) = SET_UINT16;
                fmi3GetUInt32(c, vr, n, values: *mut u32, n_values: Size) = GET_UINT32;
                fmi3SetUInt32(c, vr, n, values: *const u32, n_values: Size) = SET_UINT32;
                fmi3GetUInt64(c, vr, n, values: *mut u64, n_values: Size) = GET_UINT64;
                fmi3SetUInt64(c, vr, n, values: *const u64, n_values: Size) = SET_UINT64;
                fmi3GetBinary(c, vr, n, sizes: *mut Size, values: *mut Binary, n_values: Size) = GET_BINARY;
                fmi3SetBinary(c, vr, n, sizes: *const Size, values: *const Binary, n_values: Size) = SET_BINARY;
                fmi3GetClock(c, vr, n, values: *mut Boolean) = GET_CLOCK;
                fmi3SetClock(c, vr, n, values: *const Boolean) = SET_CLOCK;
            }
            $crate::export_fmu! { @never $model;
                fmi3GetNumberOfVariableDependencies(c, vr: ValueReference, n: *mut Size) = GET_NUMBER_OF_VARIABLE_DEPENDENCIES;
                fmi3GetVariableDependencies(c, dependent: ValueReference, elements: *mut Size, independents: *mut ValueReference, others: *mut Size, kinds: *mut RawKind, n: Size) = GET_VARIABLE_DEPENDENCIES;
                fmi3EnterConfigurationMode(c) = ENTER_CONFIGURATION_MODE;
                fmi3ExitConfigurationMode(c) = EXIT_CONFIGURATION_MODE;
                fmi3GetIntervalDecimal(c, vr: *const ValueReference, n: Size, intervals: *mut Real, qualifiers: *mut RawKind) = GET_INTERVAL_DECIMAL;
                fmi3GetIntervalFraction(c, vr: *const ValueReference, n: Size, counters: *mut u64, resolutions: *mut u64, qualifiers: *mut RawKind) = GET_INTERVAL_FRACTION;
                fmi3GetShiftDecimal(c, vr: *const ValueReference, n: Size, shifts: *mut Real) = GET_SHIFT_DECIMAL;
                fmi3GetShiftFraction(c, vr: *const ValueReference, n: Size, counters: *mut u64, resolutions: *mut u64) = GET_SHIFT_FRACTION;
                fmi3SetIntervalDecimal(c, vr: *const ValueReference, n: Size, intervals: *const Real) = SET_INTERVAL_DECIMAL;
                fmi3SetIntervalFraction(c, vr: *const ValueReference, n: Size, counters: *const u64, resolutions: *const u64) = SET_INTERVAL_FRACTION;
                fmi3SetShiftDecimal(c, vr: *const ValueReference, n: Size, shifts: *const Real) = SET_SHIFT_DECIMAL;
                fmi3SetShiftFraction(c, vr: *const ValueReference, n: Size, counters: *const u64, resolutions: *const u64) = SET_SHIFT_FRACTION;
                fmi3EvaluateDiscreteStates(c) = EVALUATE_DISCRETE_STATES;
                fmi3ActivateModelPartition(c, clock: ValueReference, time: Real) = ACTIVATE_MODEL_PARTITION;
            }
        };
    };
    (@plain $version:ident; $($name:ident() -> $result:ty = $function:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> $result {
            $crate::$version::functions::$function()
        }
    )*};
    (@own $version:ident $model:ty; $($name:ident($($argument:ident: $ty:ty),*) -> $result:ty = $function:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $ty),*) -> $result {
            // SAFETY: the host calls as the standard says, which is what the function asks for.
            unsafe { $crate::$version::functions::$function::<$model>($($argument),*) }
        }
    )*};
    (@shared $version:ident $model:ty;
     $($name:ident($($argument:ident: $ty:ty),*) -> $result:ty = $function:ident, $line:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $ty),*) -> $result {
            let line = &$crate::$version::state_table::$line;
            // SAFETY: the host calls as the standard says, which is what the function asks for.
            unsafe { $crate::shared::$function::<$model>(line, $($argument),*) }
        }
    )*};
    // Of types that no FMU has: the number of variables is all that counts.
    (@absent $model:ty; $($name:ident($c:ident, $vr:ident, $n:ident $(, $other:ident: $ty:ty)*) = $line:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($c: Component, _: *const ValueReference, $n: Size $(, _: $ty)*) -> Status {
            // SAFETY: the host calls as the standard says, which is what the function asks for.
            unsafe { $crate::fmi3::functions::absent::<$model>(&$crate::fmi3::state_table::$line, $c, $n) }
        }
    )*};
    // What no FMU offers.
    (@never $model:ty; $($name:ident($c:ident $(, $other:ident: $ty:ty)*) = $line:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($c: Component $(, _: $ty)*) -> Status {
            // SAFETY: the host calls as the standard says, which is what the function asks for.
            unsafe { $crate::fmi3::functions::never::<$model>(&$crate::fmi3::state_table::$line, $c) }
        }
    )*};
}
