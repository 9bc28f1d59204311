//! From instantiation to the simulation.

use std::{
    ffi::{CStr, CString, c_void},
    path::PathBuf,
    ptr,
};

use strut_model::Model;

use super::{
    state_table::{self as table, FMI_3},
    types::{
        Boolean, Callback, Component, ComponentEnvironment, FALSE, IntermediateUpdate, LogMessage, Real,
        Size, Status, Text, ValueReference,
    },
};
use crate::interface::{
    instance::{Handles, Instance, call},
    life_cycle,
    log::{Debugging, Failure, Log},
    pointer,
    resources::Origin,
    state::{Kind, Phase},
};

/// `fmi3GetVersion`.
pub fn version() -> Text {
    c"3.0".as_ptr()
}

/// Where the messages go, and whether more than errors.
#[derive(Clone, Copy)]
struct Logger {
    environment: ComponentEnvironment,
    log: Option<LogMessage>,
    on: bool,
}

impl Logger {
    fn log(self) -> Log {
        let send = move |status, category: &CStr, message: &str| {
            let Some(log) = self.log else { return };
            let message = escape(message);
            // SAFETY: the host gave the logger for these arguments; the strings end with a zero and outlive the call.
            unsafe { log(self.environment, status, category.as_ptr(), message.as_ptr()) }
        };
        Log::new(send, Debugging::all(self.on))
    }
}

/// A `#` would begin a value reference.
fn escape(message: &str) -> CString {
    let bytes: Vec<u8> = message.replace('#', "##").bytes().map(|byte| byte.max(1)).collect();
    CString::new(bytes).unwrap_or_default()
}

/// Makes an instance.
///
/// # Safety
/// Texts are null or end with a zero; the logger is of its declared type.
unsafe fn instantiate<M: Model>(
    function: &str,
    (name, token, resources): (Text, Text, Text),
    logger: Logger,
    (kind, handles): (Kind, Handles),
) -> Component {
    let start = || {
        // SAFETY: by the caller.
        let token =
            pointer::utf8(unsafe { pointer::text(token, "instantiationToken") }?, "instantiationToken")?;
        // SAFETY: by the caller.
        let folder = unsafe { pointer::optional(resources, "resourcePath") }?.map(PathBuf::from);
        Ok((kind, handles, Origin::find::<M>(token, folder, instantiate::<M> as *const c_void)?))
    };
    // SAFETY: by the caller.
    unsafe { life_cycle::instantiate::<M>((&FMI_3, function), name, |_| logger.log(), start) }
}

/// `fmi3InstantiateModelExchange`. Errors go to the logger, if there is one.
///
/// # Safety
/// Texts are null or end with a zero; the logger is null or of its declared type.
pub unsafe fn instantiate_model_exchange<M: Model>(
    name: Text,
    token: Text,
    resources: Text,
    _visible: Boolean,
    logging_on: Boolean,
    environment: ComponentEnvironment,
    log: Option<LogMessage>,
) -> Component {
    let logger = Logger { environment, log, on: logging_on != FALSE };
    // The host handles events: that is what model exchange is.
    let kind = (Kind::ModelExchange, Handles { events: true, early_return: false });
    // SAFETY: by the caller.
    unsafe { instantiate::<M>("fmi3InstantiateModelExchange", (name, token, resources), logger, kind) }
}

/// `fmi3InstantiateCoSimulation`. A host that wants intermediate updates is refused: there are none.
///
/// # Safety
/// As for [`instantiate_model_exchange`].
#[allow(clippy::too_many_arguments, reason = "the standard has them")]
pub unsafe fn instantiate_co_simulation<M: Model>(
    name: Text,
    token: Text,
    resources: Text,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    early_return_allowed: Boolean,
    _intermediate: *const ValueReference,
    n_intermediate: Size,
    environment: ComponentEnvironment,
    log: Option<LogMessage>,
    _update: IntermediateUpdate,
) -> Component {
    const NAME: &str = "fmi3InstantiateCoSimulation";
    let logger = Logger { environment, log, on: logging_on != FALSE };
    if n_intermediate > 0 {
        let message = "there are no intermediate updates (providesIntermediateUpdate is not set): give no \
                       requiredIntermediateVariables";
        logger.log().tell(NAME, &Failure::error(message));
        return ptr::null_mut();
    }
    let handles = Handles { events: event_mode_used != FALSE, early_return: early_return_allowed != FALSE };
    // SAFETY: by the caller.
    unsafe { instantiate::<M>(NAME, (name, token, resources), logger, (Kind::CoSimulation, handles)) }
}

/// `fmi3InstantiateScheduledExecution`, which no FMU offers.
///
/// # Safety
/// As for [`instantiate_model_exchange`].
#[allow(clippy::too_many_arguments, reason = "the standard has them")]
pub unsafe fn instantiate_scheduled_execution<M: Model>(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: ComponentEnvironment,
    log: Option<LogMessage>,
    _clock: Callback,
    _lock: Callback,
    _unlock: Callback,
) -> Component {
    let name = M::ABOUT.name;
    let message = format!(
        "{name} has no scheduled execution: instantiate it for co-simulation, where its sampled parts run by themselves"
    );
    Logger { environment, log, on: false }
        .log()
        .tell("fmi3InstantiateScheduledExecution", &Failure::error(message));
    ptr::null_mut()
}

/// `fmi3SetDebugLogging`.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; there are `n` categories that end with a zero.
pub unsafe fn set_debug_logging<M: Model>(
    component: Component,
    logging_on: Boolean,
    n: Size,
    categories: *const Text,
) -> Status {
    let on = logging_on != FALSE;
    // SAFETY: by the caller.
    unsafe { life_cycle::set_debug_logging::<M>(&table::SET_DEBUG_LOGGING, component, on, n, categories) }
}

/// `fmi3EnterInitializationMode`. A tolerance that no solver could keep is left aside with a warning.
///
/// # Safety
/// The component is as for [`set_debug_logging`].
pub unsafe fn enter_initialization_mode<M: Model>(
    component: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
        let set_up = life_cycle::set_up(instance, tolerance, start, (stop_defined != FALSE).then_some(stop));
        if !matches!(set_up, Err(Failure { status: Status::Error, .. })) {
            instance.enter(Phase::Initialization);
        }
        set_up
    };
    // SAFETY: by the caller.
    unsafe { call(component, &table::ENTER_INITIALIZATION_MODE, body) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_names_no_value_references() {
        assert_eq!(escape("#7 is 5 %"), CString::from(c"##7 is 5 %"));
        assert_eq!(escape("a\0b"), CString::from(c"a\x01b"));
    }
}
