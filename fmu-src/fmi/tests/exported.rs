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
use strut_fmi::fmi2::types::*;

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

/// Every function of FMI 3.0, as `fmi3Functions.h` lists them.
const STANDARD_3: [&str; 75] = [
    "fmi3GetVersion",
    "fmi3SetDebugLogging",
    "fmi3InstantiateModelExchange",
    "fmi3InstantiateCoSimulation",
    "fmi3InstantiateScheduledExecution",
    "fmi3FreeInstance",
    "fmi3EnterInitializationMode",
    "fmi3ExitInitializationMode",
    "fmi3EnterEventMode",
    "fmi3Terminate",
    "fmi3Reset",
    "fmi3GetFloat32",
    "fmi3GetFloat64",
    "fmi3GetInt8",
    "fmi3GetUInt8",
    "fmi3GetInt16",
    "fmi3GetUInt16",
    "fmi3GetInt32",
    "fmi3GetUInt32",
    "fmi3GetInt64",
    "fmi3GetUInt64",
    "fmi3GetBoolean",
    "fmi3GetString",
    "fmi3GetBinary",
    "fmi3GetClock",
    "fmi3SetFloat32",
    "fmi3SetFloat64",
    "fmi3SetInt8",
    "fmi3SetUInt8",
    "fmi3SetInt16",
    "fmi3SetUInt16",
    "fmi3SetInt32",
    "fmi3SetUInt32",
    "fmi3SetInt64",
    "fmi3SetUInt64",
    "fmi3SetBoolean",
    "fmi3SetString",
    "fmi3SetBinary",
    "fmi3SetClock",
    "fmi3GetNumberOfVariableDependencies",
    "fmi3GetVariableDependencies",
    "fmi3GetFMUState",
    "fmi3SetFMUState",
    "fmi3FreeFMUState",
    "fmi3SerializedFMUStateSize",
    "fmi3SerializeFMUState",
    "fmi3DeserializeFMUState",
    "fmi3GetDirectionalDerivative",
    "fmi3GetAdjointDerivative",
    "fmi3EnterConfigurationMode",
    "fmi3ExitConfigurationMode",
    "fmi3GetIntervalDecimal",
    "fmi3GetIntervalFraction",
    "fmi3GetShiftDecimal",
    "fmi3GetShiftFraction",
    "fmi3SetIntervalDecimal",
    "fmi3SetIntervalFraction",
    "fmi3SetShiftDecimal",
    "fmi3SetShiftFraction",
    "fmi3EvaluateDiscreteStates",
    "fmi3UpdateDiscreteStates",
    "fmi3EnterContinuousTimeMode",
    "fmi3CompletedIntegratorStep",
    "fmi3SetTime",
    "fmi3SetContinuousStates",
    "fmi3GetContinuousStateDerivatives",
    "fmi3GetEventIndicators",
    "fmi3GetContinuousStates",
    "fmi3GetNominalsOfContinuousStates",
    "fmi3GetNumberOfEventIndicators",
    "fmi3GetNumberOfContinuousStates",
    "fmi3EnterStepMode",
    "fmi3GetOutputDerivatives",
    "fmi3DoStep",
    "fmi3ActivateModelPartition",
];

/// The example's library, which `cargo test` builds before it runs the tests.
fn library() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let name = format!("{}decay{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let path = test.parent().unwrap().parent().unwrap().join("examples").join(name);
    assert!(path.exists(), "{} is missing: run `cargo build -p strut-fmi --example decay`", path.display());
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
fn exactly_the_functions_of_the_standards_are_exported() {
    let library = open(&library());
    let nm = Command::new("nm").args(["-D", "--defined-only"]).arg(self::library()).output().unwrap();
    let listed = String::from_utf8(nm.stdout).unwrap();
    let tables = [strut_fmi::fmi2::state_table::FUNCTIONS, strut_fmi::fmi3::state_table::FUNCTIONS];
    // The tables list those that work on an instance.
    let own = [
        &["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate"][..],
        &[
            "fmi3GetVersion",
            "fmi3InstantiateModelExchange",
            "fmi3InstantiateCoSimulation",
            "fmi3InstantiateScheduledExecution",
        ],
    ];
    for ((standard, prefix), (table, own)) in
        [(&STANDARD[..], "fmi2"), (&STANDARD_3, "fmi3")].into_iter().zip(tables.into_iter().zip(own))
    {
        for name in standard {
            assert!(!symbol(library, name).is_null(), "{name} is missing");
        }
        let sorted = |mut names: Vec<&str>| -> Vec<String> {
            names.sort_unstable();
            names.into_iter().map(str::to_owned).collect()
        };
        let exported = listed.split_whitespace().filter(|word| word.starts_with(prefix)).collect();
        let standard = sorted(standard.to_vec());
        assert_eq!(sorted(exported), standard);
        let listed = table.iter().map(|function| function.name).chain(own.iter().copied()).collect();
        assert_eq!(sorted(listed), standard);
    }
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
