//! The library as a host loads it.

#![cfg(target_os = "linux")]

use std::{
    ffi::{CStr, CString},
    fs,
    path::PathBuf,
    process::Command,
    ptr,
};

use libc::c_void;
use strut_fmi2::types::*;

/// Every function of FMI 2.0, as `fmi2Functions.h` lists them.
const STANDARD: [&str; 44] = [
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

/// The example's library, which `cargo test` builds before it runs the tests.
fn library() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let name = format!("{}decay{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let path = test.parent().unwrap().parent().unwrap().join("examples").join(name);
    assert!(path.exists(), "{} is missing: run `cargo build -p strut-fmi2 --example decay`", path.display());
    path
}

fn symbol(library: *mut c_void, name: &str) -> *mut c_void {
    let name = CString::new(name).unwrap();
    // SAFETY: the library is open.
    unsafe { libc::dlsym(library, name.as_ptr()) }
}

fn open(path: &std::path::Path) -> *mut c_void {
    let path = CString::new(path.to_str().unwrap()).unwrap();
    // SAFETY: the library's start-up code is Rust's, which does no harm.
    let library = unsafe { libc::dlopen(path.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
    assert!(!library.is_null());
    library
}

#[test]
fn exactly_the_functions_of_the_standard_are_exported() {
    let library = open(&library());
    for name in STANDARD {
        assert!(!symbol(library, name).is_null(), "{name} is missing");
    }
    let nm = Command::new("nm").args(["-D", "--defined-only"]).arg(self::library()).output().unwrap();
    let listed = String::from_utf8(nm.stdout).unwrap();
    let mut exported: Vec<&str> = listed.split_whitespace().filter(|word| word.starts_with("fmi2")).collect();
    let mut standard = STANDARD;
    exported.sort_unstable();
    standard.sort_unstable();
    assert_eq!(exported, standard);
    // The table lists those that work on an instance.
    let own = ["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate"];
    let mut listed: Vec<&str> =
        strut_fmi2::state_table::FUNCTIONS.iter().map(|function| function.name).collect();
    listed.extend(own);
    listed.sort_unstable();
    assert_eq!(listed, standard);
}

#[test]
fn a_library_without_a_resource_location_finds_the_parameters_beside_it() {
    type Instantiate = unsafe extern "C" fn(
        Text,
        RawType,
        Text,
        Text,
        *const CallbackFunctions,
        Boolean,
        Boolean,
    ) -> Component;
    type Step = unsafe extern "C" fn(Component) -> Status;
    type Get = unsafe extern "C" fn(Component, *const u32, usize, *mut f64) -> Status;
    type Version = unsafe extern "C" fn() -> Text;
    type Free = unsafe extern "C" fn(Component);

    let text = "fmu = 'F'\nmodel = 'Decay'\ntitle = 't'\nsource = 's'\n[values]\nlevel = { value = 4.0, unit = 'm' }\n";
    let fmu = tempfile::tempdir().unwrap();
    let binaries = fmu.path().join("binaries").join("linux64");
    fs::create_dir_all(&binaries).unwrap();
    fs::create_dir(fmu.path().join("resources")).unwrap();
    fs::write(fmu.path().join("resources").join("parameters.toml"), text).unwrap();
    let path = binaries.join("Decay.so");
    fs::copy(library(), &path).unwrap();
    let set = strut_model::ParameterSet::parse(text).unwrap();
    let guid = decay::ENTRY.interface(Some(&set), None).unwrap().guid();
    let guid = CString::new(guid).unwrap();

    let library = open(&path);
    let callbacks = CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::null_mut(),
    };
    // SAFETY: the functions have these types by the standard.
    unsafe {
        let instantiate: Instantiate = std::mem::transmute(symbol(library, "fmi2Instantiate"));
        let enter: Step = std::mem::transmute(symbol(library, "fmi2EnterInitializationMode"));
        let get: Get = std::mem::transmute(symbol(library, "fmi2GetReal"));
        let version: Version = std::mem::transmute(symbol(library, "fmi2GetVersion"));
        let platform: Version = std::mem::transmute(symbol(library, "fmi2GetTypesPlatform"));
        let free: Free = std::mem::transmute(symbol(library, "fmi2FreeInstance"));
        assert_eq!((CStr::from_ptr(version()), CStr::from_ptr(platform())), (c"2.0", c"default"));
        for kind in [0, 1] {
            let c = instantiate(
                c"a".as_ptr(),
                kind,
                guid.as_ptr(),
                ptr::null(),
                &raw const callbacks,
                FALSE,
                FALSE,
            );
            assert!(!c.is_null());
            assert_eq!(enter(c), Status::Ok);
            let mut level = 0.0;
            assert_eq!(get(c, &2, 1, &mut level), Status::Ok);
            assert_eq!(level, 4.0);
            free(c);
        }
    }
}

/// The example's source: its functions stay in this test's binary and disturb nothing.
#[path = "../examples/decay.rs"]
mod decay;
