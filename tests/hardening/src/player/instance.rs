//! An instance, what is known of it, and what it says.

use std::collections::HashMap;
use std::ffi::{CStr, CString, c_void};
use std::ptr;

use strut_fmi::fmi2::types::{CallbackFunctions, Component, FmuState, Logger, Status, Text};
use strut_fmi::fmi3::types::LogMessage;

use crate::api::{Api, Own, Three, Two};
use crate::call::{Fault, Handles};
use crate::package::Package;
use crate::standard::{Purpose, State};

/// What follows from the calls so far.
#[derive(Clone, Debug)]
pub struct Known {
    /// What the instance is for.
    pub purpose: Purpose,
    /// What its host handles.
    pub handles: Handles,
    /// Its state; none after a forged state was restored.
    pub state: Option<State>,
    /// Its time in seconds.
    pub time: f64,
    /// Its stop time in seconds.
    pub stop: f64,
    /// Whether nothing was set but what a rig may see: then nothing fails.
    pub tame: bool,
}

impl Known {
    /// After an instantiation or a reset.
    pub fn fresh(purpose: Purpose, handles: Handles) -> Self {
        Self {
            purpose,
            handles,
            state: Some(State::Instantiated),
            time: 0.0,
            stop: f64::INFINITY,
            tame: true,
        }
    }
}

/// What the logger was told.
#[derive(Debug, Default)]
struct Messages {
    complaints: usize,
    last: String,
    /// What is wrong with a message.
    wrong: Option<String>,
}

/// An instance.
#[derive(Debug)]
pub struct Instance {
    /// The component.
    pub component: Component,
    /// What follows from the calls so far.
    pub known: Known,
    /// What is known of the saved states, by their addresses.
    pub saved: HashMap<usize, Known>,
    /// The serialised state after instantiation.
    pub fresh: Vec<u8>,
    free: unsafe extern "C" fn(Component),
    /// The reference of time, where it is one.
    clock: Option<u32>,
    messages: *mut Messages,
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the component is ours and not used any more; neither are the messages after it.
        unsafe {
            (self.free)(self.component);
            drop(Box::from_raw(self.messages));
        }
    }
}

/// The logger's fixed arguments. Rust cannot define a variadic function, but on the platforms that this
/// runs on the fixed arguments of one arrive as those of any other.
unsafe extern "C" fn record(
    environment: *mut c_void,
    name: Text,
    status: Status,
    category: Text,
    format: Text,
) {
    // SAFETY: the environment is the instance's messages, which outlive it.
    let messages = unsafe { &mut *environment.cast::<Messages>() };
    let mut text = |pointer: Text| {
        if pointer.is_null() {
            messages.wrong = Some("a null pointer instead of a text".into());
            return String::new();
        }
        // SAFETY: not null; the library's texts end with a zero.
        let text = unsafe { CStr::from_ptr(pointer) };
        text.to_str().map_or_else(
            |_| {
                messages.wrong = Some(format!("{text:?} is not UTF-8"));
                String::new()
            },
            str::to_owned,
        )
    };
    let (name, category, format) = (text(name), text(category), text(format));
    if format.replace("%%", "").contains('%') {
        messages.wrong = Some(format!("{format:?} asks for arguments that are not there"));
    }
    if !category.starts_with("log") || !(name.is_empty() || name == NAME.to_str().unwrap_or_default()) {
        messages.wrong = Some(format!("category {category:?} of instance {name:?}"));
    }
    messages.complaints += usize::from(status != Status::Ok);
    messages.last = format;
}

/// The logger of FMI 3.0.
unsafe extern "C" fn record_three(environment: *mut c_void, status: Status, category: Text, message: Text) {
    // What the other one checks of a format holds for any text with its signs doubled.
    let text = if message.is_null() {
        String::new()
    } else {
        // SAFETY: not null; the library's texts end with a zero.
        unsafe { CStr::from_ptr(message) }.to_string_lossy().replace('%', "%%")
    };
    let format = CString::new(text).unwrap_or_default();
    let format = if message.is_null() { ptr::null() } else { format.as_ptr() };
    // SAFETY: as it comes from the library, with a text that lives.
    unsafe { record(environment, NAME.as_ptr(), status, category, format) }
}

const NAME: &CStr = c"r\xc3\xa4der <&>";

/// What an instance is made from.
struct Start {
    name: Text,
    guid: Text,
    resources: Text,
    logging: bool,
    fault: Fault,
    messages: *mut Messages,
}

impl Start {
    fn two(&self, two: &Two, purpose: Purpose) -> Component {
        // SAFETY: a variadic function's fixed arguments, see `record`.
        let logger = unsafe {
            std::mem::transmute::<unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text), Logger>(record)
        };
        let callbacks = CallbackFunctions {
            logger: Some(logger),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: self.messages.cast(),
        };
        let resources = match self.fault {
            Fault::ForeignResources => c"http://example.org/".as_ptr(),
            _ => self.resources,
        };
        let kind = match (self.fault, purpose) {
            (Fault::UnknownType, _) => 2,
            (_, Purpose::ModelExchange) => 0,
            (_, Purpose::CoSimulation) => 1,
        };
        let callbacks: *const CallbackFunctions =
            if self.fault == Fault::NoCallbacks { ptr::null() } else { &raw const callbacks };
        let logging = i32::from(self.logging);
        // SAFETY: all pointers are null or live.
        unsafe { (two.instantiate)(self.name, kind, self.guid, resources, callbacks, 0, logging) }
    }

    fn three(&self, three: &Three, purpose: Purpose, handles: Handles) -> Component {
        let Self { name, guid, logging, .. } = *self;
        let resources = match self.fault {
            // A path that is no text.
            Fault::ForeignResources => c"\xff\xfe".as_ptr(),
            _ => self.resources,
        };
        let [logging, events, early] = [logging, handles.events, handles.early_return].map(u8::from);
        let (environment, log, none) = (self.messages.cast(), Some(record_three as LogMessage), ptr::null());
        // Nothing that is needed is missing without a logger: intermediate updates are refused instead.
        let intermediate = usize::from(self.fault == Fault::NoCallbacks);
        // SAFETY: all pointers are null or live.
        unsafe {
            match (self.fault, purpose) {
                (Fault::UnknownType, _) => (three.instantiate_scheduled_execution)(
                    name,
                    guid,
                    resources,
                    0,
                    logging,
                    environment,
                    log,
                    none,
                    none,
                    none,
                ),
                (Fault::NoCallbacks, _) | (_, Purpose::CoSimulation) => (three.instantiate_co_simulation)(
                    name,
                    guid,
                    resources,
                    0,
                    logging,
                    events,
                    early,
                    &0,
                    intermediate,
                    environment,
                    log,
                    none,
                ),
                (_, Purpose::ModelExchange) => {
                    (three.instantiate_model_exchange)(name, guid, resources, 0, logging, environment, log)
                }
            }
        }
    }
}

impl Instance {
    /// Instantiates; none if the library gives no instance.
    pub fn new(
        api: Api,
        package: &Package,
        (purpose, handles): (Purpose, Handles),
        logging: bool,
        fault: Fault,
    ) -> Result<Option<Self>, String> {
        let messages = Box::into_raw(Box::<Messages>::default());
        let name = match fault {
            Fault::NoName => ptr::null(),
            Fault::EmptyName => c"".as_ptr(),
            _ => NAME.as_ptr(),
        };
        let guid = match fault {
            Fault::NoGuid => ptr::null(),
            Fault::WrongGuid => c"{00000000-0000-0000-0000-000000000000}".as_ptr(),
            _ => package.guid.as_ptr(),
        };
        let own = package.resources();
        let start = Start { name, guid, resources: own.as_ptr(), logging, fault, messages };
        let component = match &api.own {
            Own::Two(two) => start.two(two, purpose),
            Own::Three(three) => start.three(three, purpose, handles),
        };
        // SAFETY: ours, and nobody writes to it now.
        let told = unsafe { &*messages };
        let wrong = told.wrong.clone();
        let silent = component.is_null() && fault != Fault::NoCallbacks && told.complaints == 0;
        if component.is_null() {
            // SAFETY: without an instance nobody refers to them.
            drop(unsafe { Box::from_raw(messages) });
            return match wrong {
                Some(wrong) => Err(wrong),
                None if silent => Err("refused, but said nothing".into()),
                None => Ok(None),
            };
        }
        let mut instance = Self {
            component,
            known: Known::fresh(purpose, handles),
            saved: HashMap::new(),
            fresh: Vec::new(),
            free: api.common.free_instance,
            clock: package.time(),
            messages,
        };
        instance.fresh = instance.bytes(api)?;
        Ok(Some(instance))
    }

    /// Forgets what was said.
    pub fn forget_messages(&mut self) {
        // SAFETY: ours, and nobody else uses it now.
        unsafe { *self.messages = Messages::default() };
    }

    /// Whether what was said fits what was returned.
    pub fn check_messages(&mut self, status: Status) -> Result<(), String> {
        let three = self.clock.is_some();
        // SAFETY: ours, and nobody else uses it now.
        let Messages { complaints, wrong, .. } = unsafe { &*self.messages };
        if let Some(wrong) = wrong {
            return Err(format!("told the logger {wrong}"));
        }
        let right = match status {
            Status::Ok => *complaints == 0,
            Status::Discard => *complaints <= 1,
            // FMI 3.0 logs warnings on request.
            Status::Warning if three => *complaints <= 1,
            Status::Warning | Status::Error | Status::Fatal | Status::Pending => *complaints > 0,
        };
        if right { Ok(()) } else { Err(format!("returned {status:?} with {complaints} complaints")) }
    }

    /// The last message.
    pub fn last_message(&self) -> &str {
        // SAFETY: ours, and nobody writes to it now.
        unsafe { &(*self.messages).last }
    }

    /// The complete state as bytes.
    pub fn bytes(&self, api: Api) -> Result<Vec<u8>, String> {
        let mut state = ptr::null_mut();
        // SAFETY: the component is ours, the state is to be made and freed.
        let bytes = unsafe {
            let status = (api.common.get_fmu_state)(self.component, &raw mut state);
            if status != Status::Ok {
                return Err(format!("leaves an instance of which get FMU state says {status:?}"));
            }
            self.bytes_of(api, state)?
        };
        // SAFETY: as above.
        let freed = unsafe { (api.common.free_fmu_state)(self.component, &raw mut state) };
        if freed == Status::Ok && state.is_null() {
            Ok(bytes)
        } else {
            Err(format!("leaves a state that is freed with {freed:?}"))
        }
    }

    /// A saved state as bytes.
    pub fn bytes_of(&self, api: Api, state: FmuState) -> Result<Vec<u8>, String> {
        let mut size = 0;
        // SAFETY: the component is ours, the array is as long as it says.
        unsafe {
            let told = (api.common.serialized_fmu_state_size)(self.component, state, &raw mut size);
            let mut bytes = vec![0_u8; size];
            let written = (api.common.serialize_fmu_state)(self.component, state, bytes.as_mut_ptr(), size);
            if (told, written) == (Status::Ok, Status::Ok) {
                return Ok(bytes);
            }
            Err(format!("leaves a state that is not serialised: {told:?}, {written:?}"))
        }
    }

    /// Goes to the state of some bytes.
    pub fn restore(&mut self, api: Api, bytes: &[u8]) -> Result<(), String> {
        let mut state = ptr::null_mut();
        // SAFETY: the component is ours, the array is as long as it says.
        let (read, set, freed) = unsafe {
            let read = (api.common.de_serialize_fmu_state)(
                self.component,
                bytes.as_ptr(),
                bytes.len(),
                &raw mut state,
            );
            let set = (api.common.set_fmu_state)(self.component, state);
            (read, set, (api.common.free_fmu_state)(self.component, &raw mut state))
        };
        if (read, set, freed) == (Status::Ok, Status::Ok, Status::Ok) {
            return Ok(());
        }
        Err(format!("leaves a state that goes to no other instance: {read:?}, {set:?}, {freed:?}"))
    }

    /// The last successful time, if the instance tells it now.
    pub fn time(&self, api: Api) -> Option<f64> {
        let mut time = f64::NAN;
        // SAFETY: the component is ours.
        let status = unsafe {
            match (&api.own, self.clock) {
                (Own::Two(two), _) => (two.get_real_status)(self.component, 2, &raw mut time),
                (Own::Three(three), Some(clock)) => {
                    (three.get_float64)(self.component, &raw const clock, 1, &raw mut time, 1)
                }
                (Own::Three(_), None) => return None,
            }
        };
        (status == Status::Ok).then_some(time)
    }

    /// After a forged state the time is what the instance says.
    pub fn time_if_unknown(&mut self, api: Api) {
        if self.known.state.is_none() {
            self.known.time = self.time(api).unwrap_or(0.0);
        }
    }
}
