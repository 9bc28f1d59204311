//! The functions of FMI 2.0 (FMI 2.0.4, `fmi2Functions.h`).

use crate::description::Kind;

/// Those of both interfaces.
pub const COMMON: &[&str] = &[
    "fmi2GetTypesPlatform",
    "fmi2GetVersion",
    "fmi2SetDebugLogging",
    "fmi2Instantiate",
    "fmi2FreeInstance",
    "fmi2SetupExperiment",
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2Terminate",
    "fmi2Reset",
    "fmi2GetReal",
    "fmi2GetInteger",
    "fmi2GetBoolean",
    "fmi2GetString",
    "fmi2SetReal",
    "fmi2SetInteger",
    "fmi2SetBoolean",
    "fmi2SetString",
    "fmi2GetFMUstate",
    "fmi2SetFMUstate",
    "fmi2FreeFMUstate",
    "fmi2SerializedFMUstateSize",
    "fmi2SerializeFMUstate",
    "fmi2DeSerializeFMUstate",
    "fmi2GetDirectionalDerivative",
];

/// Those of model exchange.
pub const MODEL_EXCHANGE: &[&str] = &[
    "fmi2EnterEventMode",
    "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode",
    "fmi2CompletedIntegratorStep",
    "fmi2SetTime",
    "fmi2SetContinuousStates",
    "fmi2GetDerivatives",
    "fmi2GetEventIndicators",
    "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates",
];

/// Those of co-simulation.
pub const CO_SIMULATION: &[&str] = &[
    "fmi2SetRealInputDerivatives",
    "fmi2GetRealOutputDerivatives",
    "fmi2DoStep",
    "fmi2CancelStep",
    "fmi2GetStatus",
    "fmi2GetRealStatus",
    "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus",
    "fmi2GetStringStatus",
];

/// Those that a library with these interfaces exports.
pub fn of(kinds: &[Kind]) -> impl Iterator<Item = &'static str> {
    let model_exchange = kinds.contains(&Kind::ModelExchange).then_some(MODEL_EXCHANGE);
    let co_simulation = kinds.contains(&Kind::CoSimulation).then_some(CO_SIMULATION);
    [Some(COMMON), model_exchange, co_simulation].into_iter().flatten().flatten().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_44() {
        assert_eq!(of(&[Kind::ModelExchange, Kind::CoSimulation]).count(), 44);
    }
}
