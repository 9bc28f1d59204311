//! A host of FMI 3.0.

use std::{
    ffi::{CStr, c_void},
    marker::PhantomData,
    ptr,
};

use strut_fmi::{
    fmi3::{functions as f, state_table as table, types::*},
    shared,
};
use strut_model::Model;

use crate::common::guid;

unsafe extern "C" fn record(environment: *mut c_void, _: Status, category: Text, message: Text) {
    // SAFETY: the environment is the host's list, texts come from the library.
    unsafe {
        assert!(!category.is_null());
        (*environment.cast::<Vec<String>>()).push(CStr::from_ptr(message).to_str().unwrap().to_owned());
    }
}

/// Records into a list.
pub const RECORD: LogMessage = record;

/// Directional and adjoint derivatives have the same arguments.
type Derivative =
    unsafe fn(Component, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize) -> Status;

/// An instance and its messages.
pub struct Host<M: Model> {
    pub component: Component,
    messages: *mut Vec<String>,
    model: PhantomData<M>,
}

impl<M: Model> Drop for Host<M> {
    fn drop(&mut self) {
        // SAFETY: both came from the constructor.
        unsafe {
            shared::free_instance::<M>(&table::FREE_INSTANCE, self.component);
            drop(Box::from_raw(self.messages));
        }
    }
}

impl<M: Model> Host<M> {
    fn made(make: impl FnOnce(*const std::ffi::c_char, *mut c_void) -> Component) -> Self {
        let messages: *mut Vec<String> = Box::into_raw(Box::default());
        let host =
            Self { component: make(guid::<M>().as_ptr(), messages.cast()), messages, model: PhantomData };
        assert!(!host.component.is_null(), "{:?}", host.messages());
        host
    }

    pub fn model_exchange() -> Self {
        Self::made(|token, environment| {
            // SAFETY: all pointers live.
            unsafe {
                let (name, none) = (c"test".as_ptr(), ptr::null());
                f::instantiate_model_exchange::<M>(name, token, none, FALSE, TRUE, environment, Some(RECORD))
            }
        })
    }

    fn stepping(logging: bool, events: bool, early: bool) -> Self {
        Self::made(|token, environment| {
            let [logging, events, early] = [logging, events, early].map(Boolean::from);
            // SAFETY: all pointers live.
            unsafe {
                f::instantiate_co_simulation::<M>(
                    c"test".as_ptr(),
                    token,
                    ptr::null(),
                    FALSE,
                    logging,
                    events,
                    early,
                    ptr::null(),
                    0,
                    environment,
                    Some(RECORD),
                    ptr::null(),
                )
            }
        })
    }

    pub fn co_simulation() -> Self {
        Self::stepping(true, false, false)
    }

    pub fn with_events(events: bool, early: bool) -> Self {
        Self::stepping(true, events, early)
    }

    pub fn logging(on: bool) -> Self {
        Self::stepping(on, false, false)
    }

    /// All messages so far.
    pub fn messages(&self) -> Vec<String> {
        // SAFETY: the list lives as long as the host and is not being written to now.
        unsafe { (*self.messages).clone() }
    }

    pub fn last_message(&self) -> String {
        self.messages().last().cloned().unwrap_or_default()
    }

    pub fn initialize(&self, start: f64) {
        assert_eq!(self.enter_initialization_mode(None, start, None), Status::Ok);
        assert_eq!(self.exit_initialization_mode(), Status::Ok);
    }

    pub fn float64(&self, references: &[u32], count: usize) -> Result<Vec<f64>, Status> {
        let mut values = vec![f64::NAN; count];
        // SAFETY: arrays are as long as is said, here and below.
        let status = unsafe {
            let (vr, n) = (references.as_ptr(), references.len());
            f::get_float64::<M>(self.component, vr, n, values.as_mut_ptr(), count)
        };
        ok(status, values)
    }

    pub fn set(&self, references: &[u32], values: &[f64]) -> Status {
        let (vr, n) = (references.as_ptr(), references.len());
        // SAFETY: see above.
        unsafe { f::set_float64::<M>(self.component, vr, n, values.as_ptr(), values.len()) }
    }

    pub fn int32(&self, reference: u32) -> Result<i32, Status> {
        let mut value = -7;
        // SAFETY: see above.
        ok(unsafe { f::get_int32::<M>(self.component, &reference, 1, &mut value, 1) }, value)
    }

    pub fn int64(&self, reference: u32) -> Result<i64, Status> {
        let mut value = -7;
        // SAFETY: see above.
        let status = unsafe { f::get_int64::<M>(self.component, &reference, 1, &mut value, 1) };
        ok(status, value)
    }

    pub fn set_int64(&self, reference: u32, value: i64) -> Status {
        // SAFETY: see above.
        unsafe { f::set_int64::<M>(self.component, &reference, 1, &value, 1) }
    }

    pub fn boolean(&self, reference: u32) -> Result<bool, Status> {
        let mut value = 7;
        // SAFETY: see above.
        let status = unsafe { f::get_boolean::<M>(self.component, &reference, 1, &mut value, 1) };
        ok(status, value == TRUE)
    }

    pub fn string(&self, reference: u32) -> Result<String, Status> {
        let mut value = ptr::null();
        // SAFETY: see above; the library's text ends with a zero.
        unsafe {
            let status = f::get_string::<M>(self.component, &reference, 1, &mut value, 1);
            ok(status, ())?;
            Ok(CStr::from_ptr(value).to_str().unwrap().to_owned())
        }
    }

    pub fn directional(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        n: usize,
    ) -> Result<Vec<f64>, Status> {
        self.derivative(f::get_directional_derivative::<M>, (unknowns, knowns, seed), n)
    }

    pub fn adjoint(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        n: usize,
    ) -> Result<Vec<f64>, Status> {
        self.derivative(f::get_adjoint_derivative::<M>, (unknowns, knowns, seed), n)
    }

    fn derivative(
        &self,
        function: Derivative,
        (unknowns, knowns, seed): (&[u32], &[u32], &[f64]),
        n: usize,
    ) -> Result<Vec<f64>, Status> {
        let mut result = vec![f64::NAN; n];
        let (u, k) = ((unknowns.as_ptr(), unknowns.len()), (knowns.as_ptr(), knowns.len()));
        let (seed, m) = (seed.as_ptr(), seed.len());
        // SAFETY: see above.
        let status = unsafe { function(self.component, u.0, u.1, k.0, k.1, seed, m, result.as_mut_ptr(), n) };
        ok(status, result)
    }

    pub fn enter_initialization_mode(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Status {
        let defined = |it: Option<f64>| (Boolean::from(it.is_some()), it.unwrap_or(f64::NAN));
        let (tolerance, stop) = (defined(tolerance), defined(stop));
        // SAFETY: the component is ours, here and below.
        unsafe {
            f::enter_initialization_mode::<M>(self.component, tolerance.0, tolerance.1, start, stop.0, stop.1)
        }
    }

    pub fn set_debug_logging(&self, on: bool, categories: &[&CStr]) -> Status {
        let texts: Vec<Text> = categories.iter().map(|text| text.as_ptr()).collect();
        // SAFETY: see above.
        unsafe { f::set_debug_logging::<M>(self.component, Boolean::from(on), texts.len(), texts.as_ptr()) }
    }

    pub fn event_indicators(&self, n: usize) -> Vec<f64> {
        let mut values = vec![f64::NAN; n];
        let line = &table::GET_EVENT_INDICATORS;
        // SAFETY: see above.
        let status =
            unsafe { shared::get_event_indicators::<M>(line, self.component, values.as_mut_ptr(), n) };
        assert_eq!(status, Status::Ok);
        values
    }

    /// Numbers of continuous states and event indicators.
    pub fn numbers(&self) -> (usize, usize) {
        let (mut states, mut indicators) = (0, 0);
        // SAFETY: see above.
        unsafe {
            assert_eq!(f::get_number_of_continuous_states::<M>(self.component, &mut states), Status::Ok);
            assert_eq!(f::get_number_of_event_indicators::<M>(self.component, &mut indicators), Status::Ok);
        }
        (states, indicators)
    }

    /// Whether an event is to be handled, whether the step ended early, and when.
    pub fn do_step(&self, point: f64, size: f64) -> Result<(bool, bool, f64), Status> {
        let (mut event, mut end, mut early, mut time) = (7, 7, 7, f64::NAN);
        // SAFETY: see above.
        let status = unsafe {
            f::do_step::<M>(self.component, point, size, TRUE, &mut event, &mut end, &mut early, &mut time)
        };
        ok(status, (event == TRUE, early == TRUE, time))
    }

    /// Whether another update is needed, and when the next event is.
    pub fn update(&self) -> Result<(bool, Option<f64>), Status> {
        let ([mut again, mut end, mut nominals, mut states, mut defined], mut time) = ([7; 5], f64::NAN);
        // SAFETY: see above.
        let status = unsafe {
            f::update_discrete_states::<M>(
                self.component,
                &mut again,
                &mut end,
                &mut nominals,
                &mut states,
                &mut defined,
                &mut time,
            )
        };
        ok(status, (again == TRUE, (defined == TRUE).then_some(time)))
    }

    /// The present state as bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let (mut state, mut size) = (ptr::null_mut(), 0);
        // SAFETY: see above.
        unsafe {
            let c = self.component;
            let saved = shared::get_fmu_state::<M>(&table::GET_FMU_STATE, c, &mut state);
            let line = &table::SERIALIZED_FMU_STATE_SIZE;
            let told = shared::serialized_fmu_state_size::<M>(line, c, state, &mut size);
            let mut bytes = vec![0; size];
            let line = &table::SERIALIZE_FMU_STATE;
            let written = shared::serialize_fmu_state::<M>(line, c, state, bytes.as_mut_ptr(), size);
            assert_eq!([saved, told, written], [Status::Ok; 3]);
            bytes
        }
    }
}

/// What came back, if all is well.
fn ok<T>(status: Status, value: T) -> Result<T, Status> {
    if status == Status::Ok { Ok(value) } else { Err(status) }
}

macro_rules! own {
    ($($name:ident)*) => {
        impl<M: Model> Host<M> {$(
            pub fn $name(&self) -> Status {
                // SAFETY: the component is ours.
                unsafe { f::$name::<M>(self.component) }
            }
        )*}
    };
}
own! { enter_event_mode enter_step_mode }

macro_rules! common {
    ($($name:ident $line:ident)*) => {
        impl<M: Model> Host<M> {$(
            pub fn $name(&self) -> Status {
                // SAFETY: the component is ours.
                unsafe { shared::$name::<M>(&table::$line, self.component) }
            }
        )*}
    };
}
common! {
    exit_initialization_mode EXIT_INITIALIZATION_MODE
    terminate TERMINATE
    reset RESET
    enter_continuous_time_mode ENTER_CONTINUOUS_TIME_MODE
}
