//! The functions of FMI 2.0 or FMI 3.0 as a host finds them in a shared library.

use std::path::Path;

use libloading::{Library, Symbol};
use strut_fmi::fmi2::types::{Component, FmuState, Real, Size, Status, Text, ValueReference};
use strut_fmi::{fmi2::types as fmi2, fmi3::types as fmi3};

use crate::standard::Version;

/// A function by its name.
fn find<'a, T>(library: &'a Library, name: &str) -> Result<Symbol<'a, T>, String> {
    // SAFETY: the types below are those of the standard's headers.
    let found = unsafe { library.get(name.as_bytes()) };
    found.map_err(|error| format!("{name}: {error}"))
}

macro_rules! api {
    ($(#[$doc:meta])* $api:ident; $($field:ident: $name:ident($($ty:ty),*) -> $result:ty;)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        #[allow(missing_docs, reason = "the standard explains them")]
        pub struct $api {
            $(pub $field: unsafe extern "C" fn($($ty),*) -> $result,)*
        }

        impl $api {
            fn of(library: &Library) -> Result<Self, String> {
                Ok(Self { $($field: *find(library, stringify!($name))?,)* })
            }
        }
    };
}

macro_rules! common {
    ($($field:ident: $two:ident $three:ident($($ty:ty),*) -> $result:ty;)*) => {
        /// What both versions have with the same arguments.
        #[derive(Clone, Copy)]
        #[allow(missing_docs, reason = "the standard explains them")]
        pub struct Common {
            $(pub $field: unsafe extern "C" fn($($ty),*) -> $result,)*
        }

        impl Common {
            fn of(library: &Library, version: Version) -> Result<Self, String> {
                let three = version == Version::Three;
                Ok(Self {
                    $($field: *find(library, if three { stringify!($three) } else { stringify!($two) })?,)*
                })
            }
        }
    };
}

/// What only one version has, or with other arguments.
#[derive(Clone, Copy)]
pub enum Own {
    /// FMI 2.0
    Two(Two),
    /// FMI 3.0
    Three(Three),
}

/// Every function, by its address.
#[derive(Clone, Copy)]
pub struct Api {
    /// What both versions have.
    pub common: Common,
    /// What only the version has.
    pub own: Own,
}

impl Api {
    /// Finds the functions; they may be called as long as the library is loaded.
    ///
    /// # Errors
    /// The first function that is missing.
    pub fn of(library: &Library, version: Version) -> Result<Self, String> {
        let own = match version {
            Version::Two => Own::Two(Two::of(library)?),
            Version::Three => Own::Three(Three::of(library)?),
        };
        Ok(Self { common: Common::of(library, version)?, own })
    }

    /// The functions that FMI 2.0 alone has.
    ///
    /// # Panics
    /// If they are those of FMI 3.0.
    pub fn two(&self) -> &Two {
        match &self.own {
            Own::Two(two) => two,
            Own::Three(_) => panic!("these are the functions of FMI 3.0"),
        }
    }
}

common! {
    free_instance: fmi2FreeInstance fmi3FreeInstance(Component) -> ();
    exit_initialization_mode: fmi2ExitInitializationMode fmi3ExitInitializationMode(Component) -> Status;
    terminate: fmi2Terminate fmi3Terminate(Component) -> Status;
    reset: fmi2Reset fmi3Reset(Component) -> Status;
    get_fmu_state: fmi2GetFMUstate fmi3GetFMUState(Component, *mut FmuState) -> Status;
    set_fmu_state: fmi2SetFMUstate fmi3SetFMUState(Component, FmuState) -> Status;
    free_fmu_state: fmi2FreeFMUstate fmi3FreeFMUState(Component, *mut FmuState) -> Status;
    serialized_fmu_state_size: fmi2SerializedFMUstateSize fmi3SerializedFMUStateSize(Component, FmuState, *mut Size) -> Status;
    serialize_fmu_state: fmi2SerializeFMUstate fmi3SerializeFMUState(Component, FmuState, *mut u8, Size) -> Status;
    de_serialize_fmu_state: fmi2DeSerializeFMUstate fmi3DeserializeFMUState(Component, *const u8, Size, *mut FmuState) -> Status;
    enter_event_mode: fmi2EnterEventMode fmi3EnterEventMode(Component) -> Status;
    enter_continuous_time_mode: fmi2EnterContinuousTimeMode fmi3EnterContinuousTimeMode(Component) -> Status;
    set_time: fmi2SetTime fmi3SetTime(Component, Real) -> Status;
    set_continuous_states: fmi2SetContinuousStates fmi3SetContinuousStates(Component, *const Real, Size) -> Status;
    get_derivatives: fmi2GetDerivatives fmi3GetContinuousStateDerivatives(Component, *mut Real, Size) -> Status;
    get_event_indicators: fmi2GetEventIndicators fmi3GetEventIndicators(Component, *mut Real, Size) -> Status;
    get_continuous_states: fmi2GetContinuousStates fmi3GetContinuousStates(Component, *mut Real, Size) -> Status;
    get_nominals: fmi2GetNominalsOfContinuousStates fmi3GetNominalsOfContinuousStates(Component, *mut Real, Size) -> Status;
}

api! {
    /// What only FMI 2.0 has.
    Two;
    instantiate: fmi2Instantiate(Text, fmi2::RawType, Text, Text, *const fmi2::CallbackFunctions, i32, i32) -> Component;
    set_debug_logging: fmi2SetDebugLogging(Component, i32, Size, *const Text) -> Status;
    setup_experiment: fmi2SetupExperiment(Component, i32, Real, Real, i32, Real) -> Status;
    enter_initialization_mode: fmi2EnterInitializationMode(Component) -> Status;
    get_real: fmi2GetReal(Component, *const ValueReference, Size, *mut Real) -> Status;
    get_integer: fmi2GetInteger(Component, *const ValueReference, Size, *mut i32) -> Status;
    get_boolean: fmi2GetBoolean(Component, *const ValueReference, Size, *mut i32) -> Status;
    get_string: fmi2GetString(Component, *const ValueReference, Size, *mut Text) -> Status;
    set_real: fmi2SetReal(Component, *const ValueReference, Size, *const Real) -> Status;
    set_integer: fmi2SetInteger(Component, *const ValueReference, Size, *const i32) -> Status;
    set_boolean: fmi2SetBoolean(Component, *const ValueReference, Size, *const i32) -> Status;
    set_string: fmi2SetString(Component, *const ValueReference, Size, *const Text) -> Status;
    get_directional_derivative: fmi2GetDirectionalDerivative(Component, *const ValueReference, Size, *const ValueReference, Size, *const Real, *mut Real) -> Status;
    new_discrete_states: fmi2NewDiscreteStates(Component, *mut fmi2::EventInfo) -> Status;
    completed_integrator_step: fmi2CompletedIntegratorStep(Component, i32, *mut i32, *mut i32) -> Status;
    set_real_input_derivatives: fmi2SetRealInputDerivatives(Component, *const ValueReference, Size, *const i32, *const Real) -> Status;
    get_real_output_derivatives: fmi2GetRealOutputDerivatives(Component, *const ValueReference, Size, *const i32, *mut Real) -> Status;
    do_step: fmi2DoStep(Component, Real, Real, i32) -> Status;
    cancel_step: fmi2CancelStep(Component) -> Status;
    get_status: fmi2GetStatus(Component, fmi2::RawStatusKind, *mut Status) -> Status;
    get_real_status: fmi2GetRealStatus(Component, fmi2::RawStatusKind, *mut Real) -> Status;
    get_integer_status: fmi2GetIntegerStatus(Component, fmi2::RawStatusKind, *mut i32) -> Status;
    get_boolean_status: fmi2GetBooleanStatus(Component, fmi2::RawStatusKind, *mut i32) -> Status;
    get_string_status: fmi2GetStringStatus(Component, fmi2::RawStatusKind, *mut Text) -> Status;
}

api! {
    /// What only FMI 3.0 has.
    Three;
    instantiate_model_exchange: fmi3InstantiateModelExchange(Text, Text, Text, u8, u8, *mut std::ffi::c_void, Option<fmi3::LogMessage>) -> Component;
    instantiate_co_simulation: fmi3InstantiateCoSimulation(Text, Text, Text, u8, u8, u8, u8, *const ValueReference, Size, *mut std::ffi::c_void, Option<fmi3::LogMessage>, fmi3::IntermediateUpdate) -> Component;
    instantiate_scheduled_execution: fmi3InstantiateScheduledExecution(Text, Text, Text, u8, u8, *mut std::ffi::c_void, Option<fmi3::LogMessage>, fmi3::Callback, fmi3::Callback, fmi3::Callback) -> Component;
    set_debug_logging: fmi3SetDebugLogging(Component, u8, Size, *const Text) -> Status;
    enter_initialization_mode: fmi3EnterInitializationMode(Component, u8, Real, Real, u8, Real) -> Status;
    get_float64: fmi3GetFloat64(Component, *const ValueReference, Size, *mut Real, Size) -> Status;
    get_int32: fmi3GetInt32(Component, *const ValueReference, Size, *mut i32, Size) -> Status;
    get_int64: fmi3GetInt64(Component, *const ValueReference, Size, *mut i64, Size) -> Status;
    get_boolean: fmi3GetBoolean(Component, *const ValueReference, Size, *mut u8, Size) -> Status;
    get_string: fmi3GetString(Component, *const ValueReference, Size, *mut Text, Size) -> Status;
    set_float64: fmi3SetFloat64(Component, *const ValueReference, Size, *const Real, Size) -> Status;
    set_int32: fmi3SetInt32(Component, *const ValueReference, Size, *const i32, Size) -> Status;
    set_int64: fmi3SetInt64(Component, *const ValueReference, Size, *const i64, Size) -> Status;
    set_boolean: fmi3SetBoolean(Component, *const ValueReference, Size, *const u8, Size) -> Status;
    set_string: fmi3SetString(Component, *const ValueReference, Size, *const Text, Size) -> Status;
    get_uint16: fmi3GetUInt16(Component, *const ValueReference, Size, *mut u16, Size) -> Status;
    set_float32: fmi3SetFloat32(Component, *const ValueReference, Size, *const f32, Size) -> Status;
    get_directional_derivative: fmi3GetDirectionalDerivative(Component, *const ValueReference, Size, *const ValueReference, Size, *const Real, Size, *mut Real, Size) -> Status;
    get_adjoint_derivative: fmi3GetAdjointDerivative(Component, *const ValueReference, Size, *const ValueReference, Size, *const Real, Size, *mut Real, Size) -> Status;
    get_output_derivatives: fmi3GetOutputDerivatives(Component, *const ValueReference, Size, *const i32, *mut Real, Size) -> Status;
    update_discrete_states: fmi3UpdateDiscreteStates(Component, *mut u8, *mut u8, *mut u8, *mut u8, *mut u8, *mut Real) -> Status;
    completed_integrator_step: fmi3CompletedIntegratorStep(Component, u8, *mut u8, *mut u8) -> Status;
    get_number_of_continuous_states: fmi3GetNumberOfContinuousStates(Component, *mut Size) -> Status;
    enter_configuration_mode: fmi3EnterConfigurationMode(Component) -> Status;
    evaluate_discrete_states: fmi3EvaluateDiscreteStates(Component) -> Status;
    enter_step_mode: fmi3EnterStepMode(Component) -> Status;
    do_step: fmi3DoStep(Component, Real, Real, u8, *mut u8, *mut u8, *mut u8, *mut Real) -> Status;
}

/// Loads a shared library.
///
/// # Errors
/// In the loader's words.
pub fn load(path: &Path) -> Result<Library, String> {
    // SAFETY: the start-up code of a Rust library does no harm.
    unsafe { Library::new(path) }.map_err(|error| format!("{}: {error}", path.display()))
}
