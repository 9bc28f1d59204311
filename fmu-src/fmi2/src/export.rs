//! The macro that makes a library an FMU's.

/// Exports every function of FMI 2.0 for a model, and the model's [`Entry`](strut_model::Entry) as `ENTRY`.
///
/// This is the whole of an FMU's library crate, a `cdylib`:
///
/// ```text
/// //! QuarterCar as an FMU.
/// strut_fmi2::export_fmu!(strut_physics::rigs::QuarterCar);
/// ```
///
/// The functions have to be made there: symbols of a dependency are not exported from a `cdylib`.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        /// The model, for catalogues.
        pub const ENTRY: $crate::Entry = $crate::Entry::of::<$model>();

        const _: () = {
            use $crate::types::*;

            $crate::export_fmu! { @plain
                fmi2GetTypesPlatform() -> Text = types_platform;
                fmi2GetVersion() -> Text = version;
            }
            $crate::export_fmu! { @generic $model;
                fmi2Instantiate(name: Text, kind: RawType, guid: Text, resources: Text, functions: *const CallbackFunctions, visible: Boolean, logging_on: Boolean) -> Component = instantiate;
                fmi2FreeInstance(c: Component) -> () = free_instance;
                fmi2SetDebugLogging(c: Component, logging_on: Boolean, n: Size, categories: *const Text) -> Status = set_debug_logging;
                fmi2SetupExperiment(c: Component, tolerance_defined: Boolean, tolerance: Real, start: Real, stop_defined: Boolean, stop: Real) -> Status = setup_experiment;
                fmi2EnterInitializationMode(c: Component) -> Status = enter_initialization_mode;
                fmi2ExitInitializationMode(c: Component) -> Status = exit_initialization_mode;
                fmi2Terminate(c: Component) -> Status = terminate;
                fmi2Reset(c: Component) -> Status = reset;

                fmi2GetReal(c: Component, vr: *const ValueReference, n: Size, value: *mut Real) -> Status = get_real;
                fmi2GetInteger(c: Component, vr: *const ValueReference, n: Size, value: *mut Integer) -> Status = get_integer;
                fmi2GetBoolean(c: Component, vr: *const ValueReference, n: Size, value: *mut Boolean) -> Status = get_boolean;
                fmi2GetString(c: Component, vr: *const ValueReference, n: Size, value: *mut Text) -> Status = get_string;
                fmi2SetReal(c: Component, vr: *const ValueReference, n: Size, value: *const Real) -> Status = set_real;
                fmi2SetInteger(c: Component, vr: *const ValueReference, n: Size, value: *const Integer) -> Status = set_integer;
                fmi2SetBoolean(c: Component, vr: *const ValueReference, n: Size, value: *const Boolean) -> Status = set_boolean;
                fmi2SetString(c: Component, vr: *const ValueReference, n: Size, value: *const Text) -> Status = set_string;
                fmi2GetDirectionalDerivative(c: Component, unknowns: *const ValueReference, n: Size, knowns: *const ValueReference, m: Size, seed: *const Real, sensitivity: *mut Real) -> Status = get_directional_derivative;

                fmi2GetFMUstate(c: Component, state: *mut FmuState) -> Status = get_fmu_state;
                fmi2SetFMUstate(c: Component, state: FmuState) -> Status = set_fmu_state;
                fmi2FreeFMUstate(c: Component, state: *mut FmuState) -> Status = free_fmu_state;
                fmi2SerializedFMUstateSize(c: Component, state: FmuState, size: *mut Size) -> Status = serialized_fmu_state_size;
                fmi2SerializeFMUstate(c: Component, state: FmuState, bytes: *mut Byte, size: Size) -> Status = serialize_fmu_state;
                fmi2DeSerializeFMUstate(c: Component, bytes: *const Byte, size: Size, state: *mut FmuState) -> Status = de_serialize_fmu_state;

                fmi2EnterEventMode(c: Component) -> Status = enter_event_mode;
                fmi2NewDiscreteStates(c: Component, info: *mut EventInfo) -> Status = new_discrete_states;
                fmi2EnterContinuousTimeMode(c: Component) -> Status = enter_continuous_time_mode;
                fmi2CompletedIntegratorStep(c: Component, no_set_state: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean) -> Status = completed_integrator_step;
                fmi2SetTime(c: Component, time: Real) -> Status = set_time;
                fmi2SetContinuousStates(c: Component, x: *const Real, n: Size) -> Status = set_continuous_states;
                fmi2GetDerivatives(c: Component, derivatives: *mut Real, n: Size) -> Status = get_derivatives;
                fmi2GetEventIndicators(c: Component, indicators: *mut Real, n: Size) -> Status = get_event_indicators;
                fmi2GetContinuousStates(c: Component, x: *mut Real, n: Size) -> Status = get_continuous_states;
                fmi2GetNominalsOfContinuousStates(c: Component, nominals: *mut Real, n: Size) -> Status = get_nominals_of_continuous_states;

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
        };
    };
    (@plain $($name:ident() -> $result:ty = $function:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> $result {
            $crate::functions::$function()
        }
    )*};
    (@generic $model:ty; $($name:ident($($argument:ident: $ty:ty),*) -> $result:ty = $function:ident;)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $ty),*) -> $result {
            // SAFETY: the host calls as the standard says, which is what the function asks for.
            unsafe { $crate::functions::$function::<$model>($($argument),*) }
        }
    )*};
}
