//! A host that calls the functions as a C program would.

pub mod models;

use std::{
    ffi::{CStr, CString, c_void},
    marker::PhantomData,
    ptr,
};

use strut_fmi::{
    fmi2::{functions as f, state_table as table, types::*},
    shared,
};
use strut_model::{Interface, Model};

pub const ME: RawType = 0;
pub const CS: RawType = 1;

/// A message as the logger got it.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: Status,
    pub category: String,
    /// The format, which a host prints.
    pub format: String,
}

/// The logger's fixed arguments. Rust cannot define a variadic function, but on the platforms that the
/// tests run on the fixed arguments of one arrive as those of any other.
unsafe extern "C" fn record(
    environment: *mut c_void,
    instance: Text,
    status: Status,
    category: Text,
    format: Text,
) {
    // SAFETY: the environment is the host's list, texts come from the library.
    unsafe {
        assert!(!instance.is_null() && !category.is_null() && !format.is_null());
        let text = |pointer| CStr::from_ptr(pointer).to_str().unwrap().to_owned();
        let message =
            Message { instance: text(instance), status, category: text(category), format: text(format) };
        (*environment.cast::<Vec<Message>>()).push(message);
    }
}

/// Callbacks that record into a list.
pub fn callbacks(messages: *mut Vec<Message>) -> CallbackFunctions {
    // SAFETY: see `record`.
    let logger = unsafe {
        std::mem::transmute::<unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text), Logger>(record)
    };
    CallbackFunctions {
        logger: Some(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: messages.cast(),
    }
}

/// The identifier of a model with its declared start values.
pub fn guid<M: Model>() -> CString {
    CString::new(Interface::of::<M>(None, None).unwrap().guid()).unwrap()
}

/// The reference of a variable.
pub fn reference<M: Model>(name: &str) -> u32 {
    Interface::of::<M>(None, None).unwrap().variable(name).unwrap_or_else(|| panic!("no {name}")).reference
}

/// An instance and what it has told.
pub struct Host<M: Model> {
    pub c: Component,
    messages: *mut Vec<Message>,
    model: PhantomData<M>,
}

impl<M: Model> Drop for Host<M> {
    fn drop(&mut self) {
        // SAFETY: both came from the constructor.
        unsafe {
            shared::free_instance::<M>(&table::FREE_INSTANCE, self.c);
            drop(Box::from_raw(self.messages));
        }
    }
}

macro_rules! forward_shared {
    ($($name:ident $line:ident($($argument:ident: $ty:ty),*);)*) => {$(
        pub fn $name(&self, $($argument: $ty),*) -> Status {
            // SAFETY: the instance is ours; the tests hand over what the function asks for.
            unsafe { shared::$name::<M>(&table::$line, self.c, $($argument),*) }
        }
    )*};
}

macro_rules! forward {
    ($($name:ident($($argument:ident: $ty:ty),*);)*) => {$(
        pub fn $name(&self, $($argument: $ty),*) -> Status {
            // SAFETY: the instance is ours; the tests hand over what the function asks for.
            unsafe { f::$name::<M>(self.c, $($argument),*) }
        }
    )*};
}

impl<M: Model> Host<M> {
    pub fn new(kind: RawType) -> Self {
        let messages = Box::into_raw(Box::default());
        let callbacks = callbacks(messages);
        let guid = guid::<M>();
        // SAFETY: all pointers live.
        let c = unsafe {
            f::instantiate::<M>(
                c"test".as_ptr(),
                kind,
                guid.as_ptr(),
                ptr::null(),
                &raw const callbacks,
                FALSE,
                TRUE,
            )
        };
        let host = Self { c, messages, model: PhantomData };
        assert!(!c.is_null(), "{:?}", host.messages());
        host
    }

    /// In Step Complete or, for model exchange, Event Mode.
    pub fn initialized(kind: RawType) -> Self {
        let host = Self::new(kind);
        host.initialize();
        host
    }

    pub fn initialize(&self) {
        assert_eq!(self.setup_experiment(FALSE, 0.0, 0.0, FALSE, 0.0), Status::Ok);
        assert_eq!(self.enter_initialization_mode(), Status::Ok);
        assert_eq!(self.exit_initialization_mode(), Status::Ok);
    }

    pub fn messages(&self) -> Vec<Message> {
        // SAFETY: the list lives as long as the host and is not being written to now.
        unsafe { std::mem::take(&mut *self.messages) }
    }

    /// The only message since the last question.
    pub fn message(&self) -> Message {
        let messages = self.messages();
        assert_eq!(messages.len(), 1, "{messages:?}");
        messages[0].clone()
    }

    pub fn real(&self, name: &str) -> f64 {
        let mut value = f64::NAN;
        assert_eq!(self.get_real(&reference::<M>(name), 1, &mut value), Status::Ok, "{name}");
        value
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        self.set_real(&reference::<M>(name), 1, &value)
    }

    /// Everything that can be read as a real number, as bits.
    pub fn bits(&self) -> Vec<u64> {
        let count = (0..).take_while(|reference| self.get_real(reference, 1, &mut 0.0) == Status::Ok).count();
        self.messages();
        let references: Vec<u32> = (0..count as u32).collect();
        let mut values = vec![0.0; count];
        assert_eq!(self.get_real(references.as_ptr(), count, values.as_mut_ptr()), Status::Ok);
        values.into_iter().map(f64::to_bits).collect()
    }

    /// Steps of 7 ms under a changing force; the bits after each.
    pub fn run(&self, from: usize, steps: usize) -> Vec<Vec<u64>> {
        let step = |index: usize| {
            let time = index as f64 * 0.007;
            if M::ABOUT.name != "Configured" {
                assert_eq!(self.set("force", (3.0 * time).sin()), Status::Ok);
            }
            assert_eq!(self.do_step(time, 0.007, TRUE), Status::Ok, "{:?}", self.messages());
            self.bits()
        };
        (from..from + steps).map(step).collect()
    }

    pub fn save(&self) -> FmuState {
        let mut state = ptr::null_mut();
        assert_eq!(self.get_fmu_state(&mut state), Status::Ok);
        state
    }

    pub fn serialize(&self, state: FmuState) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(self.serialized_fmu_state_size(state, &mut size), Status::Ok);
        let mut bytes = vec![0_u8; size];
        assert_eq!(self.serialize_fmu_state(state, bytes.as_mut_ptr(), size), Status::Ok);
        bytes
    }

    pub fn deserialize(&self, bytes: &[u8]) -> (Status, FmuState) {
        let mut state = ptr::null_mut();
        let status = self.de_serialize_fmu_state(bytes.as_ptr(), bytes.len(), &mut state);
        (status, state)
    }

    forward_shared! {
        exit_initialization_mode EXIT_INITIALIZATION_MODE();
        terminate TERMINATE();
        reset RESET();
        get_fmu_state GET_FMU_STATE(state: *mut FmuState);
        set_fmu_state SET_FMU_STATE(state: FmuState);
        free_fmu_state FREE_FMU_STATE(state: *mut FmuState);
        serialized_fmu_state_size SERIALIZED_FMU_STATE_SIZE(state: FmuState, size: *mut Size);
        serialize_fmu_state SERIALIZE_FMU_STATE(state: FmuState, bytes: *mut Byte, size: Size);
        de_serialize_fmu_state DE_SERIALIZE_FMU_STATE(bytes: *const Byte, size: Size, state: *mut FmuState);
        enter_event_mode ENTER_EVENT_MODE();
        enter_continuous_time_mode ENTER_CONTINUOUS_TIME_MODE();
        set_time SET_TIME(time: Real);
        set_continuous_states SET_CONTINUOUS_STATES(x: *const Real, n: Size);
        get_derivatives GET_DERIVATIVES(x: *mut Real, n: Size);
        get_event_indicators GET_EVENT_INDICATORS(x: *mut Real, n: Size);
        get_continuous_states GET_CONTINUOUS_STATES(x: *mut Real, n: Size);
        get_nominals_of_continuous_states GET_NOMINALS_OF_CONTINUOUS_STATES(x: *mut Real, n: Size);
    }

    forward! {
        set_debug_logging(on: Boolean, n: Size, categories: *const Text);
        setup_experiment(tolerance_defined: Boolean, tolerance: Real, start: Real, stop_defined: Boolean, stop: Real);
        enter_initialization_mode();
        get_real(vr: *const u32, n: Size, value: *mut Real);
        get_integer(vr: *const u32, n: Size, value: *mut Integer);
        get_boolean(vr: *const u32, n: Size, value: *mut Boolean);
        get_string(vr: *const u32, n: Size, value: *mut Text);
        set_real(vr: *const u32, n: Size, value: *const Real);
        set_integer(vr: *const u32, n: Size, value: *const Integer);
        set_boolean(vr: *const u32, n: Size, value: *const Boolean);
        set_string(vr: *const u32, n: Size, value: *const Text);
        get_directional_derivative(unknowns: *const u32, n: Size, knowns: *const u32, m: Size, seed: *const Real, result: *mut Real);
        new_discrete_states(info: *mut EventInfo);
        completed_integrator_step(no_set: Boolean, event: *mut Boolean, end: *mut Boolean);
        set_real_input_derivatives(vr: *const u32, n: Size, order: *const Integer, value: *const Real);
        get_real_output_derivatives(vr: *const u32, n: Size, order: *const Integer, value: *mut Real);
        do_step(point: Real, size: Real, no_set: Boolean);
        cancel_step();
        get_status(kind: RawStatusKind, value: *mut Status);
        get_real_status(kind: RawStatusKind, value: *mut Real);
        get_integer_status(kind: RawStatusKind, value: *mut Integer);
        get_boolean_status(kind: RawStatusKind, value: *mut Boolean);
        get_string_status(kind: RawStatusKind, value: *mut Text);
    }
}
