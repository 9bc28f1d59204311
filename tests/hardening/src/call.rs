//! A call with its arguments, as a value: generated, printed, left out, made again.

use std::ffi::CString;

use crate::package::Kind;
use crate::standard::Version;

/// Places for instances.
pub const INSTANCES: usize = 3;
/// Places for saved states.
pub const STATES: usize = 6;
/// Places for serialised states.
pub const BLOBS: usize = 4;

/// A call to the instance in one of the places.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// The place.
    pub instance: usize,
    /// What is called.
    pub action: Action,
    /// Whether the whole state is compared before and after, and a step made a second time elsewhere.
    pub checked: bool,
}

/// Which pointer of a call is null instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Null {
    /// None.
    None,
    /// The first, often the value references.
    First,
    /// The last, often the values.
    Last,
}

/// What the host of a co-simulation handles, in FMI 3.0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Handles {
    /// `eventModeUsed`
    pub events: bool,
    /// `earlyReturnAllowed`
    pub early_return: bool,
}

/// What is wrong with an instantiation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Fault {
    None,
    NoName,
    EmptyName,
    WrongGuid,
    NoGuid,
    UnknownType,
    ForeignResources,
    NoCallbacks,
}

/// What happens to bytes on their way.
#[derive(Clone, Debug, PartialEq)]
pub enum Damage {
    /// Nothing.
    None,
    /// A bit pattern over the byte at a fraction of the length.
    Flip(f64, u8),
    /// Only a fraction is left.
    Cut(f64),
    /// Bytes follow.
    Longer(usize),
    /// Eight bytes at a fraction of the length are replaced, and the checksum made right again: what no
    /// transmission does, but somebody might.
    Forge(f64, u64),
    /// Other bytes.
    Random(u64, usize),
}

/// A function with its arguments.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "the standard explains them")]
pub enum Action {
    Instantiate {
        cosimulation: bool,
        logging: bool,
        /// What the host of a co-simulation handles, in FMI 3.0.
        handles: Handles,
        fault: Fault,
    },
    FreeInstance,
    SetDebugLogging {
        on: bool,
        categories: Vec<Option<CString>>,
        null: Null,
    },
    /// In FMI 3.0 this enters Initialization Mode, too.
    SetupExperiment {
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    },
    EnterInitializationMode,
    ExitInitializationMode,
    Terminate,
    Reset,
    Get {
        kind: Kind,
        references: Vec<u32>,
        null: Null,
    },
    SetReal {
        values: Vec<(u32, f64)>,
        null: Null,
    },
    SetInteger {
        /// Of FMI 3.0's two.
        kind: Kind,
        values: Vec<(u32, i32)>,
        null: Null,
    },
    SetBoolean {
        values: Vec<(u32, i32)>,
        null: Null,
    },
    SetString {
        values: Vec<(u32, Option<CString>)>,
        null: Null,
    },
    GetDirectionalDerivative {
        unknowns: Vec<u32>,
        knowns: Vec<(u32, f64)>,
        null: Null,
    },
    GetAdjointDerivative {
        unknowns: Vec<(u32, f64)>,
        knowns: Vec<u32>,
        null: Null,
    },
    GetFmuState {
        state: usize,
        null: Null,
    },
    SetFmuState {
        state: usize,
    },
    FreeFmuState {
        state: usize,
        null: Null,
    },
    SerializedFmuStateSize {
        state: usize,
        null: Null,
    },
    /// The state, where its bytes go, and by how much the size is wrong.
    SerializeFmuState {
        state: usize,
        blob: usize,
        excess: isize,
        null: Null,
    },
    DeSerializeFmuState {
        blob: usize,
        damage: Damage,
        state: usize,
        null: Null,
    },
    EnterEventMode,
    NewDiscreteStates {
        null: Null,
    },
    EnterContinuousTimeMode,
    CompletedIntegratorStep {
        null: Null,
    },
    SetTime {
        time: f64,
    },
    /// The states, one after the other as often as needed, and by how much their number is wrong.
    SetContinuousStates {
        values: Vec<f64>,
        excess: isize,
        null: Null,
    },
    GetDerivatives {
        excess: isize,
        null: Null,
    },
    GetContinuousStates {
        excess: isize,
        null: Null,
    },
    GetNominals {
        excess: isize,
        null: Null,
    },
    GetEventIndicators {
        excess: isize,
        null: Null,
    },
    SetRealInputDerivatives {
        values: Vec<(u32, i32, f64)>,
        null: Null,
    },
    GetRealOutputDerivatives {
        orders: Vec<(u32, i32)>,
        null: Null,
    },
    /// A step that starts this much after the present time.
    DoStep {
        offset: f64,
        size: f64,
    },
    CancelStep,
    GetStatus {
        kind: i32,
        null: Null,
    },
    GetRealStatus {
        kind: i32,
        null: Null,
    },
    GetIntegerStatus {
        kind: i32,
        null: Null,
    },
    GetBooleanStatus {
        kind: i32,
        null: Null,
    },
    GetStringStatus {
        kind: i32,
        null: Null,
    },
    GetNumberOfContinuousStates {
        null: Null,
    },
    /// Of a type that no FMU has.
    GetUInt16 {
        references: Vec<u32>,
    },
    /// Of a type that no FMU has.
    SetFloat32 {
        references: Vec<u32>,
    },
    EnterConfigurationMode,
    EvaluateDiscreteStates,
    EnterStepMode,
}

impl Action {
    /// The function's C name; empty if the version has none.
    pub fn function(&self, version: Version) -> &'static str {
        use Action as A;
        let (two, three) = match self {
            A::Instantiate { .. } => ("fmi2Instantiate", "fmi3Instantiate"),
            A::FreeInstance => ("fmi2FreeInstance", "fmi3FreeInstance"),
            A::SetDebugLogging { .. } => ("fmi2SetDebugLogging", "fmi3SetDebugLogging"),
            A::SetupExperiment { .. } => ("fmi2SetupExperiment", "fmi3EnterInitializationMode"),
            A::EnterInitializationMode => ("fmi2EnterInitializationMode", "fmi3EnterInitializationMode"),
            A::ExitInitializationMode => ("fmi2ExitInitializationMode", "fmi3ExitInitializationMode"),
            A::Terminate => ("fmi2Terminate", "fmi3Terminate"),
            A::Reset => ("fmi2Reset", "fmi3Reset"),
            A::Get { kind: Kind::Real, .. } => ("fmi2GetReal", "fmi3GetFloat64"),
            A::Get { kind: Kind::Integer, .. } => ("fmi2GetInteger", "fmi3GetInt32"),
            A::Get { kind: Kind::Choice, .. } => ("", "fmi3GetInt64"),
            A::Get { kind: Kind::Boolean, .. } => ("fmi2GetBoolean", "fmi3GetBoolean"),
            A::Get { kind: Kind::Text, .. } => ("fmi2GetString", "fmi3GetString"),
            A::SetReal { .. } => ("fmi2SetReal", "fmi3SetFloat64"),
            A::SetInteger { kind: Kind::Choice, .. } => ("", "fmi3SetInt64"),
            A::SetInteger { .. } => ("fmi2SetInteger", "fmi3SetInt32"),
            A::SetBoolean { .. } => ("fmi2SetBoolean", "fmi3SetBoolean"),
            A::SetString { .. } => ("fmi2SetString", "fmi3SetString"),
            A::GetDirectionalDerivative { .. } => {
                ("fmi2GetDirectionalDerivative", "fmi3GetDirectionalDerivative")
            }
            A::GetFmuState { .. } => ("fmi2GetFMUstate", "fmi3GetFMUState"),
            A::SetFmuState { .. } => ("fmi2SetFMUstate", "fmi3SetFMUState"),
            A::FreeFmuState { .. } => ("fmi2FreeFMUstate", "fmi3FreeFMUState"),
            A::SerializedFmuStateSize { .. } => ("fmi2SerializedFMUstateSize", "fmi3SerializedFMUStateSize"),
            A::SerializeFmuState { .. } => ("fmi2SerializeFMUstate", "fmi3SerializeFMUState"),
            A::DeSerializeFmuState { .. } => ("fmi2DeSerializeFMUstate", "fmi3DeserializeFMUState"),
            A::EnterEventMode => ("fmi2EnterEventMode", "fmi3EnterEventMode"),
            A::NewDiscreteStates { .. } => ("fmi2NewDiscreteStates", "fmi3UpdateDiscreteStates"),
            A::EnterContinuousTimeMode => ("fmi2EnterContinuousTimeMode", "fmi3EnterContinuousTimeMode"),
            A::CompletedIntegratorStep { .. } => {
                ("fmi2CompletedIntegratorStep", "fmi3CompletedIntegratorStep")
            }
            A::SetTime { .. } => ("fmi2SetTime", "fmi3SetTime"),
            A::SetContinuousStates { .. } => ("fmi2SetContinuousStates", "fmi3SetContinuousStates"),
            A::GetDerivatives { .. } => ("fmi2GetDerivatives", "fmi3GetContinuousStateDerivatives"),
            A::GetContinuousStates { .. } => ("fmi2GetContinuousStates", "fmi3GetContinuousStates"),
            A::GetNominals { .. } => {
                ("fmi2GetNominalsOfContinuousStates", "fmi3GetNominalsOfContinuousStates")
            }
            A::GetEventIndicators { .. } => ("fmi2GetEventIndicators", "fmi3GetEventIndicators"),
            A::SetRealInputDerivatives { .. } => ("fmi2SetRealInputDerivatives", ""),
            A::GetRealOutputDerivatives { .. } => {
                ("fmi2GetRealOutputDerivatives", "fmi3GetOutputDerivatives")
            }
            A::DoStep { .. } => ("fmi2DoStep", "fmi3DoStep"),
            A::CancelStep => ("fmi2CancelStep", ""),
            A::GetStatus { .. } => ("fmi2GetStatus", ""),
            A::GetRealStatus { .. } => ("fmi2GetRealStatus", ""),
            A::GetIntegerStatus { .. } => ("fmi2GetIntegerStatus", ""),
            A::GetBooleanStatus { .. } => ("fmi2GetBooleanStatus", ""),
            A::GetStringStatus { .. } => ("fmi2GetStringStatus", ""),
            A::GetAdjointDerivative { .. } => ("", "fmi3GetAdjointDerivative"),
            A::GetNumberOfContinuousStates { .. } => ("", "fmi3GetNumberOfContinuousStates"),
            A::GetUInt16 { .. } => ("", "fmi3GetUInt16"),
            A::SetFloat32 { .. } => ("", "fmi3SetFloat32"),
            A::EnterConfigurationMode => ("", "fmi3EnterConfigurationMode"),
            A::EvaluateDiscreteStates => ("", "fmi3EvaluateDiscreteStates"),
            A::EnterStepMode => ("", "fmi3EnterStepMode"),
        };
        if version == Version::Two { two } else { three }
    }
}
