//! A library of FMI 2.0 behind functions without `unsafe`: here, in [`exchange`](super::exchange), in
//! [`three`](super::three), in [`memory`] and in [`logger`] is all of it.
//!
//! What the library does with its memory is beyond anyone's control. That is why it is loaded in a process
//! of its own.

#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null_mut;

use super::exchange::Functions;
use super::{logger, memory};

/// What a call came to: fmi2OK is 0, fmi2Error 3, fmi2Fatal 4.
pub type Status = c_int;

/// A status of our own: the function is not there, or an instance is missing.
pub const ABSENT: Status = -1;

pub(super) type Component = *mut c_void;
type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`. The logger is variadic; the further arguments are left alone, which the
/// calling conventions of C allow.
#[repr(C)]
struct Callbacks {
    logger: Logger,
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    environment: *mut c_void,
}

/// An error with what the system says of it.
fn words(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), |source| format!("{error}: {source}"))
}

/// Loads a library's file.
///
/// # Errors
/// If the system cannot: in its words.
pub(super) fn open(path: &Path) -> Result<libloading::Library, String> {
    // SAFETY: its initialisers run, whatever they do: this process is there for that.
    #[cfg(unix)]
    let library = unsafe {
        use libloading::os::unix;
        // All symbols at once, as importers load it.
        unix::Library::open(Some(path), unix::RTLD_NOW | unix::RTLD_LOCAL).map(libloading::Library::from)
    };
    // SAFETY: as above.
    #[cfg(not(unix))]
    let library = unsafe { libloading::Library::new(path) };
    library.map_err(|error| words(&error))
}

/// A library's word on a version or platform; none if the function is not there or says nothing.
pub(super) fn word(library: &libloading::Library, function: &str) -> Option<String> {
    // SAFETY: all functions of this kind have no arguments and return a C string that is never freed.
    unsafe {
        let function = library.get::<unsafe extern "C" fn() -> *const c_char>(function).ok()?;
        let text = function();
        (!text.is_null()).then(|| CStr::from_ptr(text).to_string_lossy().into_owned())
    }
}

/// A loaded library.
pub struct Library {
    pub(super) library: libloading::Library,
    // Instances keep a pointer to it.
    callbacks: Box<Callbacks>,
    /// What an integration calls all the time.
    pub(super) exchange: Functions,
}

// SAFETY: the library's functions may be called from any thread, and the callbacks are never changed.
unsafe impl Send for Library {}
// SAFETY: as above.
unsafe impl Sync for Library {}

/// An instance; it is not freed by itself.
#[derive(Clone, Copy)]
pub struct Instance(pub(super) Component);

// SAFETY: an instance may be used by any thread, though by one at a time.
unsafe impl Send for Instance {}

/// A saved state.
#[derive(Clone, Copy)]
pub struct Saved(*mut c_void);

/// Calls a function of the library: `fmi2Status` as result, the instance as first argument.
macro_rules! call {
    ($library:expr, $name:expr, $instance:expr, ($($ty:ty),*), $($argument:expr),*) => {{
        // SAFETY: the function has the type that the standard gives it, and the arguments are those that it wants.
        match unsafe { $library.get::<unsafe extern "C" fn(Component $(, $ty)*) -> Status>($name) } {
            // SAFETY: as above; the pointers are to memory that outlives the call.
            Ok(function) => unsafe { function($instance.0 $(, $argument)*) },
            Err(_) => ABSENT,
        }
    }};
}

pub(super) use call;

impl Library {
    /// Loads a library.
    ///
    /// # Errors
    /// If the system cannot: in its words.
    pub fn load(path: &Path) -> Result<Self, String> {
        let library = open(path)?;
        let callbacks = Box::new(Callbacks {
            logger: logger::log,
            allocate: memory::allocate,
            free: memory::free,
            step_finished: None,
            environment: null_mut(),
        });
        let exchange = Functions::of(&library);
        Ok(Self { library, callbacks, exchange })
    }

    /// The library's word on a version or platform; none if the function is not there or says nothing.
    pub fn word(&self, function: &str) -> Option<String> {
        word(&self.library, function)
    }

    /// Makes an instance; none if the library refuses, or has no such function.
    pub fn instantiate(
        &self,
        co_simulation: bool,
        guid: &str,
        resources: &str,
        logging: bool,
    ) -> Option<Instance> {
        type Function = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Component;
        let text = |text: &str| CString::new(text).ok();
        let (name, guid, resources) = (text("instance")?, text(guid)?, text(resources)?);
        // SAFETY: the type is the standard's; the texts live through the call, the callbacks as long as the library.
        let component = unsafe {
            let function = self.library.get::<Function>("fmi2Instantiate").ok()?;
            function(
                name.as_ptr(),
                c_int::from(co_simulation),
                guid.as_ptr(),
                resources.as_ptr(),
                &raw const *self.callbacks,
                0,
                c_int::from(logging),
            )
        };
        (!component.is_null()).then_some(Instance(component))
    }

    /// Frees an instance.
    pub fn free(&self, instance: Instance) {
        // SAFETY: the type is the standard's; the instance is not used afterwards.
        unsafe {
            if let Ok(function) = self.library.get::<unsafe extern "C" fn(Component)>("fmi2FreeInstance") {
                function(instance.0);
            }
        }
    }

    /// Frees no instance: a null pointer.
    pub fn free_nothing(&self) {
        self.free(Instance(null_mut()));
    }

    /// A function with the instance as its only argument.
    pub fn plain(&self, function: &str, instance: Instance) -> Status {
        call!(self.library, function, instance, (),)
    }

    /// `fmi2SetupExperiment`.
    pub fn set_up(
        &self,
        instance: Instance,
        start: f64,
        stop: Option<f64>,
        tolerance: Option<f64>,
    ) -> Status {
        let defined = |value: Option<f64>| (c_int::from(value.is_some()), value.unwrap_or(0.0));
        let ((has_stop, stop), (has_tolerance, tolerance)) = (defined(stop), defined(tolerance));
        call!(
            self.library,
            "fmi2SetupExperiment",
            instance,
            (c_int, f64, f64, c_int, f64),
            has_tolerance,
            tolerance,
            start,
            has_stop,
            stop
        )
    }

    /// `fmi2GetInteger` or `fmi2GetBoolean`.
    pub fn integers(
        &self,
        function: &str,
        instance: Instance,
        references: &[u32],
        values: &mut [i32],
    ) -> Status {
        let count = references.len().min(values.len());
        call!(
            self.library,
            function,
            instance,
            (*const u32, usize, *mut c_int),
            references.as_ptr(),
            count,
            values.as_mut_ptr()
        )
    }

    /// `fmi2GetString`: a text that is null, or not encoded in UTF-8, is none.
    pub fn texts(&self, instance: Instance, references: &[u32], values: &mut Vec<Option<String>>) -> Status {
        let mut pointers: Vec<*const c_char> = vec![std::ptr::null(); references.len()];
        let status = call!(
            self.library,
            "fmi2GetString",
            instance,
            (*const u32, usize, *mut *const c_char),
            references.as_ptr(),
            references.len(),
            pointers.as_mut_ptr()
        );
        if (0..=1).contains(&status) {
            values.extend(pointers.into_iter().map(|text| {
                // SAFETY: what is not null is a C string until the next call, by the standard.
                let text = (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) })?;
                text.to_str().ok().map(str::to_owned)
            }));
        }
        status
    }

    /// `fmi2SetRealInputDerivatives`: first derivatives.
    pub fn set_input_derivatives(&self, instance: Instance, references: &[u32], rates: &[f64]) -> Status {
        let count = references.len().min(rates.len());
        let orders = vec![1; count];
        call!(
            self.library,
            "fmi2SetRealInputDerivatives",
            instance,
            (*const u32, usize, *const c_int, *const f64),
            references.as_ptr(),
            count,
            orders.as_ptr(),
            rates.as_ptr()
        )
    }

    /// `fmi2GetRealOutputDerivatives` of one order.
    pub fn output_derivatives(
        &self,
        instance: Instance,
        references: &[u32],
        order: c_int,
        values: &mut [f64],
    ) -> Status {
        let count = references.len().min(values.len());
        let orders = vec![order; count];
        call!(
            self.library,
            "fmi2GetRealOutputDerivatives",
            instance,
            (*const u32, usize, *const c_int, *mut f64),
            references.as_ptr(),
            count,
            orders.as_ptr(),
            values.as_mut_ptr()
        )
    }

    /// `fmi2DoStep`.
    pub fn step(&self, instance: Instance, time: f64, size: f64) -> Status {
        call!(self.library, "fmi2DoStep", instance, (f64, f64, c_int), time, size, 1)
    }

    /// `fmi2GetFMUstate` into a new state, or over one that is there.
    pub fn save(&self, instance: Instance, over: Option<Saved>) -> (Status, Saved) {
        let mut state = over.map_or(null_mut(), |Saved(state)| state);
        let status = call!(self.library, "fmi2GetFMUstate", instance, (*mut *mut c_void), &raw mut state);
        (status, Saved(state))
    }

    /// `fmi2SetFMUstate`.
    pub fn restore(&self, instance: Instance, state: Saved) -> Status {
        call!(self.library, "fmi2SetFMUstate", instance, (*mut c_void), state.0)
    }

    /// `fmi2FreeFMUstate`, and whether the pointer is null then.
    pub fn free_state(&self, instance: Instance, mut state: Saved) -> (Status, bool) {
        let status = call!(self.library, "fmi2FreeFMUstate", instance, (*mut *mut c_void), &raw mut state.0);
        (status, state.0.is_null())
    }

    /// A state as bytes.
    pub fn serialize(&self, instance: Instance, state: Saved) -> (Status, Vec<u8>) {
        let mut size = 0;
        let status = call!(
            self.library,
            "fmi2SerializedFMUstateSize",
            instance,
            (*mut c_void, *mut usize),
            state.0,
            &raw mut size
        );
        if !(0..=1).contains(&status) {
            return (status, Vec::new());
        }
        let mut bytes = vec![0; size];
        let status = call!(
            self.library,
            "fmi2SerializeFMUstate",
            instance,
            (*mut c_void, *mut u8, usize),
            state.0,
            bytes.as_mut_ptr(),
            size
        );
        (status, bytes)
    }

    /// A state from bytes.
    pub fn deserialize(&self, instance: Instance, bytes: &[u8]) -> (Status, Saved) {
        let mut state: *mut c_void = null_mut();
        let status = call!(
            self.library,
            "fmi2DeSerializeFMUstate",
            instance,
            (*const u8, usize, *mut *mut c_void),
            bytes.as_ptr(),
            bytes.len(),
            &raw mut state
        );
        (status, Saved(state))
    }
}
