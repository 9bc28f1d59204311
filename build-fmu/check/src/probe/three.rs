//! Co-simulation in FMI 3.0, as far as experiments and signs need it.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_void};
use std::path::Path;
use std::ptr::{null, null_mut};

use super::library::{Component, Status, call, open, word};
use super::{ABSENT, Act, Instance, Outcome, logger};
use crate::description::Version;

type Logger = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// A library with its instance.
pub struct Stage {
    library: libloading::Library,
    instance: Option<Instance>,
    /// Tolerance, start and stop, which the initialisation begins with.
    times: (Option<f64>, f64, Option<f64>),
}

impl Stage {
    /// Loads a library.
    ///
    /// # Errors
    /// If the system cannot: in its words.
    pub fn load(path: &Path) -> Result<Self, String> {
        Ok(Self { library: open(path)?, instance: None, times: (None, 0.0, None) })
    }

    /// The version that the library tells.
    pub fn version(&self) -> Option<String> {
        word(&self.library, "fmi3GetVersion")
    }

    /// Does one thing.
    pub fn perform(&mut self, act: &Act) -> Outcome {
        let function = act.function(Version::Three);
        if let Act::Instantiate { guid, resources, logging, .. } = act {
            self.instance = self.instantiate(&function, guid, resources, *logging);
            return Outcome::of(if self.instance.is_some() { 0 } else { 3 });
        }
        let Some(instance) = self.instance else { return Outcome::of(ABSENT) };
        let mut reals = Vec::new();
        let status = match act {
            Act::SetUp { start, stop, tolerance } => {
                self.times = (*tolerance, *start, *stop);
                0
            }
            Act::Plain(name) if name == "EnterInitializationMode" => self.initialize(&function, instance),
            Act::Plain(_) => call!(self.library, function.as_str(), instance, (),),
            Act::Free => {
                self.free(&function, instance);
                0
            }
            Act::Reals(references) => {
                reals = vec![0.0; references.len()];
                let count = references.len();
                call!(
                    self.library,
                    function.as_str(),
                    instance,
                    (*const u32, usize, *mut f64, usize),
                    references.as_ptr(),
                    count,
                    reals.as_mut_ptr(),
                    count
                )
            }
            Act::SetReals(references, values) => {
                let count = references.len().min(values.len());
                call!(
                    self.library,
                    function.as_str(),
                    instance,
                    (*const u32, usize, *const f64, usize),
                    references.as_ptr(),
                    count,
                    values.as_ptr(),
                    count
                )
            }
            Act::Step(time, size) => self.step(&function, instance, *time, *size),
            _ => ABSENT,
        };
        Outcome { reals: reals.into_iter().map(f64::to_bits).collect(), ..Outcome::of(status) }
    }

    fn instantiate(&self, function: &str, token: &str, resources: &str, logging: bool) -> Option<Instance> {
        type Function = unsafe extern "C" fn(
            *const c_char,
            *const c_char,
            *const c_char,
            bool,
            bool,
            bool,
            bool,
            *const u32,
            usize,
            *mut c_void,
            Option<Logger>,
            *const c_void,
        ) -> Component;
        let text = |text: &str| CString::new(text).ok();
        let (name, token, resources) = (text("instance")?, text(token)?, text(resources)?);
        // Events and early returns are the FMU's own affair: steps end where they are to.
        let (visible, event_mode, early_return) = (false, false, false);
        // SAFETY: the type is the standard's, and the texts live through the call.
        let component = unsafe {
            let function = self.library.get::<Function>(function).ok()?;
            function(
                name.as_ptr(),
                token.as_ptr(),
                resources.as_ptr(),
                visible,
                logging,
                event_mode,
                early_return,
                null(),
                0,
                null_mut(),
                Some(logger::log_of_three),
                null(),
            )
        };
        (!component.is_null()).then_some(Instance(component))
    }

    fn initialize(&self, function: &str, instance: Instance) -> Status {
        let (tolerance, start, stop) = self.times;
        call!(
            self.library,
            function,
            instance,
            (bool, f64, f64, bool, f64),
            tolerance.is_some(),
            tolerance.unwrap_or(0.0),
            start,
            stop.is_some(),
            stop.unwrap_or(0.0)
        )
    }

    fn step(&self, function: &str, instance: Instance, time: f64, size: f64) -> Status {
        let (mut event, mut terminate, mut early, mut reached) = (false, false, false, time);
        let status = call!(
            self.library,
            function,
            instance,
            (f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64),
            time,
            size,
            true,
            &raw mut event,
            &raw mut terminate,
            &raw mut early,
            &raw mut reached
        );
        // Who wants to be ended has not come to the end of the experiment.
        if terminate && (0..=1).contains(&status) { 2 } else { status }
    }

    fn free(&mut self, function: &str, instance: Instance) {
        // SAFETY: the type is the standard's; the instance is not used afterwards.
        unsafe {
            if let Ok(function) = self.library.get::<unsafe extern "C" fn(Component)>(function) {
                function(instance.0);
            }
        }
        self.instance = None;
    }
}
