//! A well-behaved host, for tests that are about numbers and memory.

#![allow(dead_code, reason = "each test uses its own part")]

use std::ffi::c_void;
use std::ptr;

use strut_fmi::fmi2::types::*;
use strut_hardening::api::Api;
use strut_hardening::package::{Kind, Package};

pub fn package(name: &str) -> Package {
    Package::open(&strut::fmus().join(name).with_extension("fmu")).expect("the FMU is built")
}

pub fn package_of_fmi_3(name: &str) -> Package {
    let fmu = strut::fmus().join("fmi3").join(name).with_extension("fmu");
    Package::open(&fmu).expect("the FMU is built")
}

/// An instance for co-simulation; it may go from thread to thread.
pub struct Slave {
    pub api: Api,
    component: *mut c_void,
}

// SAFETY: instances share nothing, and this one is used by one thread at a time.
unsafe impl Send for Slave {}

impl Drop for Slave {
    fn drop(&mut self) {
        // SAFETY: ours, and not used any more.
        unsafe { (self.api.common.free_instance)(self.component) }
    }
}

impl Slave {
    /// An initialised instance.
    pub fn new(api: Api, package: &Package) -> Self {
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::null_mut(),
        };
        let resources = package.resources();
        // SAFETY: all pointers live; without a logger nothing is called back.
        let component = unsafe {
            (api.two().instantiate)(
                c"slave".as_ptr(),
                1,
                package.guid.as_ptr(),
                resources.as_ptr(),
                &raw const callbacks,
                FALSE,
                FALSE,
            )
        };
        assert!(!component.is_null(), "{} gives no instance", package.name);
        let slave = Self { api, component };
        // SAFETY: the component is ours, here and below.
        unsafe {
            assert_eq!((api.two().setup_experiment)(component, FALSE, 0.0, 0.0, FALSE, 0.0), Status::Ok);
            assert_eq!((api.two().enter_initialization_mode)(component), Status::Ok);
            assert_eq!((api.common.exit_initialization_mode)(component), Status::Ok);
        }
        slave
    }

    /// Sets all inputs, makes a step and reads every real variable, as bits.
    pub fn step(&mut self, package: &Package, from: f64, size: f64, input: f64) -> Vec<u64> {
        let real = |pick: fn(&&strut_hardening::package::Variable) -> bool| -> Vec<u32> {
            let reals = package.variables.iter().filter(|variable| variable.kind == Kind::Real);
            reals.filter(pick).map(|variable| variable.reference).collect()
        };
        let inputs = real(|variable| variable.is_input());
        let told = real(|variable| variable.causality != "parameter");
        let given = vec![input; inputs.len()];
        let mut values = vec![0.0; told.len()];
        // SAFETY: arrays are as long as is said.
        unsafe {
            let c = self.component;
            let set = (self.api.two().set_real)(c, inputs.as_ptr(), inputs.len(), given.as_ptr());
            assert_eq!(set, Status::Ok);
            assert_eq!((self.api.two().do_step)(c, from, size, TRUE), Status::Ok);
            let got = (self.api.two().get_real)(c, told.as_ptr(), told.len(), values.as_mut_ptr());
            assert_eq!(got, Status::Ok);
        }
        values.into_iter().map(f64::to_bits).collect()
    }
}
