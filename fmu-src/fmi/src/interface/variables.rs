//! Reading variables.

use std::ffi::CString;

use strut_model::{Model, Value};

use super::{
    instance::Instance,
    log::Failure,
    state::Phase,
    types::{Real, Text, ValueReference},
};

/// Reads real variables; in the state Instantiated their start values, for nothing is calculated yet.
#[inline(always)]
pub fn read<M: Model>(
    instance: &mut Instance<M>,
    references: &[ValueReference],
    values: &mut [Real],
) -> Result<(), Failure> {
    if instance.state.phase() == Phase::Instantiated {
        return Ok(instance.simulation.real_before_initialization(references, values)?);
    }
    Ok(instance.simulation.real(references, values)?)
}

/// Hands out the texts of settings. They live until the next call or a reset.
pub fn hand_out<M: Model>(
    instance: &mut Instance<M>,
    settings: impl Iterator<Item = Result<u32, Failure>>,
    values: &mut [Text],
) -> Result<(), Failure> {
    let mut strings = Vec::with_capacity(values.len());
    for setting in settings {
        let setting = setting?;
        if let Value::Text(text) = instance.simulation.setting(setting, "string")? {
            strings.push(CString::new(text).map_err(|error| {
                Failure::error(format!("string {setting} contains a zero byte ({error}): set it without"))
            })?);
        }
    }
    instance.strings = strings;
    for (value, string) in values.iter_mut().zip(&instance.strings) {
        *value = string.as_ptr();
    }
    Ok(())
}
