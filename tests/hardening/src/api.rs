//! The functions of FMI 2.0 as a host finds them in a shared library.

use std::path::Path;

use libloading::Library;
use strut_fmi::fmi2::types::*;

macro_rules! api {
    ($($field:ident: $name:ident($($ty:ty),*) -> $result:ty;)*) => {
        /// Every function, by its address.
        #[derive(Clone, Copy)]
        #[allow(missing_docs, reason = "the standard explains them")]
        pub struct Api {
            $(pub $field: unsafe extern "C" fn($($ty),*) -> $result,)*
        }

        impl Api {
            /// Finds the functions; they may be called as long as the library is loaded.
            ///
            /// # Errors
            /// The first function that is missing.
            pub fn of(library: &Library) -> Result<Self, String> {
                Ok(Self {
                    $($field: {
                        // SAFETY: the type is that of `fmi2FunctionTypes.h`.
                        let found = unsafe { library.get(concat!(stringify!($name), "\0").as_bytes()) };
                        *found.map_err(|error| format!(concat!(stringify!($name), ": {}"), error))?
                    },)*
                })
            }
        }
    };
}

api! {
    instantiate: fmi2Instantiate(Text, RawType, Text, Text, *const CallbackFunctions, Boolean, Boolean) -> Component;
    free_instance: fmi2FreeInstance(Component) -> ();
    set_debug_logging: fmi2SetDebugLogging(Component, Boolean, Size, *const Text) -> Status;
    setup_experiment: fmi2SetupExperiment(Component, Boolean, Real, Real, Boolean, Real) -> Status;
    enter_initialization_mode: fmi2EnterInitializationMode(Component) -> Status;
    exit_initialization_mode: fmi2ExitInitializationMode(Component) -> Status;
    terminate: fmi2Terminate(Component) -> Status;
    reset: fmi2Reset(Component) -> Status;
    get_real: fmi2GetReal(Component, *const ValueReference, Size, *mut Real) -> Status;
    get_integer: fmi2GetInteger(Component, *const ValueReference, Size, *mut Integer) -> Status;
    get_boolean: fmi2GetBoolean(Component, *const ValueReference, Size, *mut Boolean) -> Status;
    get_string: fmi2GetString(Component, *const ValueReference, Size, *mut Text) -> Status;
    set_real: fmi2SetReal(Component, *const ValueReference, Size, *const Real) -> Status;
    set_integer: fmi2SetInteger(Component, *const ValueReference, Size, *const Integer) -> Status;
    set_boolean: fmi2SetBoolean(Component, *const ValueReference, Size, *const Boolean) -> Status;
    set_string: fmi2SetString(Component, *const ValueReference, Size, *const Text) -> Status;
    get_directional_derivative: fmi2GetDirectionalDerivative(Component, *const ValueReference, Size, *const ValueReference, Size, *const Real, *mut Real) -> Status;
    get_fmu_state: fmi2GetFMUstate(Component, *mut FmuState) -> Status;
    set_fmu_state: fmi2SetFMUstate(Component, FmuState) -> Status;
    free_fmu_state: fmi2FreeFMUstate(Component, *mut FmuState) -> Status;
    serialized_fmu_state_size: fmi2SerializedFMUstateSize(Component, FmuState, *mut Size) -> Status;
    serialize_fmu_state: fmi2SerializeFMUstate(Component, FmuState, *mut Byte, Size) -> Status;
    de_serialize_fmu_state: fmi2DeSerializeFMUstate(Component, *const Byte, Size, *mut FmuState) -> Status;
    enter_event_mode: fmi2EnterEventMode(Component) -> Status;
    new_discrete_states: fmi2NewDiscreteStates(Component, *mut EventInfo) -> Status;
    enter_continuous_time_mode: fmi2EnterContinuousTimeMode(Component) -> Status;
    completed_integrator_step: fmi2CompletedIntegratorStep(Component, Boolean, *mut Boolean, *mut Boolean) -> Status;
    set_time: fmi2SetTime(Component, Real) -> Status;
    set_continuous_states: fmi2SetContinuousStates(Component, *const Real, Size) -> Status;
    get_derivatives: fmi2GetDerivatives(Component, *mut Real, Size) -> Status;
    get_event_indicators: fmi2GetEventIndicators(Component, *mut Real, Size) -> Status;
    get_continuous_states: fmi2GetContinuousStates(Component, *mut Real, Size) -> Status;
    get_nominals: fmi2GetNominalsOfContinuousStates(Component, *mut Real, Size) -> Status;
    set_real_input_derivatives: fmi2SetRealInputDerivatives(Component, *const ValueReference, Size, *const Integer, *const Real) -> Status;
    get_real_output_derivatives: fmi2GetRealOutputDerivatives(Component, *const ValueReference, Size, *const Integer, *mut Real) -> Status;
    do_step: fmi2DoStep(Component, Real, Real, Boolean) -> Status;
    cancel_step: fmi2CancelStep(Component) -> Status;
    get_status: fmi2GetStatus(Component, RawStatusKind, *mut Status) -> Status;
    get_real_status: fmi2GetRealStatus(Component, RawStatusKind, *mut Real) -> Status;
    get_integer_status: fmi2GetIntegerStatus(Component, RawStatusKind, *mut Integer) -> Status;
    get_boolean_status: fmi2GetBooleanStatus(Component, RawStatusKind, *mut Boolean) -> Status;
    get_string_status: fmi2GetStringStatus(Component, RawStatusKind, *mut Text) -> Status;
}

/// Loads a shared library.
///
/// # Errors
/// In the loader's words.
pub fn load(path: &Path) -> Result<Library, String> {
    // SAFETY: the start-up code of a Rust library does no harm.
    unsafe { Library::new(path) }.map_err(|error| format!("{}: {error}", path.display()))
}
