//! What the host is told, when and how.

use std::{ffi::CString, fs, ptr};

use crate::common::{models::*, *};
use strut_fmi::{
    fmi2::{functions as f, state_table::FREE_INSTANCE, types::*},
    shared,
};
use strut_model::{LOG_CATEGORIES, Model};

/// Tries to instantiate; the message if it is refused.
fn instantiate<M: Model>(name: Text, kind: RawType, guid: Text, resources: Text) -> Result<(), Message> {
    let mut messages: Vec<Message> = Vec::new();
    let callbacks = callbacks(&raw mut messages);
    // SAFETY: all pointers live.
    unsafe {
        let c = f::instantiate::<M>(name, kind, guid, resources, &raw const callbacks, FALSE, FALSE);
        if !c.is_null() {
            shared::free_instance::<M>(&FREE_INSTANCE, c);
            return Ok(());
        }
        // The same without anybody to tell.
        let silent = CallbackFunctions { logger: None, ..callbacks };
        assert!(f::instantiate::<M>(name, kind, guid, resources, &raw const silent, FALSE, FALSE).is_null());
        assert!(f::instantiate::<M>(name, kind, guid, resources, ptr::null(), FALSE, FALSE).is_null());
    }
    assert_eq!(messages.len(), 1, "{messages:?}");
    Err(messages.remove(0))
}

#[test]
fn what_is_wrong_with_an_instantiation_is_named() {
    let guid = guid::<Decay>();
    let (name, right, none) = (c"car".as_ptr(), guid.as_ptr(), ptr::null());
    assert_eq!(instantiate::<Decay>(name, CS, right, none), Ok(()));
    assert_eq!(instantiate::<Decay>(name, ME, right, c"".as_ptr()), Ok(()));
    assert_eq!(instantiate::<Decay>(name, ME, right, c"file:///nowhere".as_ptr()), Ok(()));
    for (result, part) in [
        (instantiate::<Decay>(none, CS, right, none), "instanceName is a null pointer"),
        (instantiate::<Decay>(c"".as_ptr(), CS, right, none), "instanceName is empty"),
        (instantiate::<Decay>(name, 2, right, none), "fmuType 2"),
        (instantiate::<Decay>(name, CS, none, none), "fmuGUID is a null pointer"),
        (instantiate::<Decay>(name, CS, c"\xff".as_ptr(), none), "fmuGUID"),
        (instantiate::<Decay>(name, CS, c"{1}".as_ptr(), none), "do not belong together"),
        (instantiate::<Decay>(name, CS, right, c"http://a/b".as_ptr()), "scheme"),
        (instantiate::<Decay>(name, CS, right, c"file:///%ff".as_ptr()), "UTF-8"),
    ] {
        let message = result.unwrap_err();
        assert!(
            message.format.starts_with("fmi2Instantiate: ") && message.format.contains(part),
            "{message:?}"
        );
        assert_eq!((message.category.as_str(), message.status), ("logStatusError", Status::Error));
    }
}

#[test]
fn the_parameter_set_in_the_resources_is_used_and_belongs_to_the_guid() {
    let folder = tempfile::tempdir().unwrap();
    let resources = folder.path().join("my car ü");
    fs::create_dir(&resources).unwrap();
    let text = "fmu = 'F'\nmodel = 'Decay'\ntitle = 't'\nsource = 's'\n[values]\nrate = { value = 4.0, unit = '1/s' }\n";
    fs::write(resources.join("parameters.toml"), text).unwrap();
    let set = strut_model::ParameterSet::parse(text).unwrap();
    let right = strut_model::Interface::of::<Decay>(Some(&set), Some(&resources)).unwrap().guid();
    let right = CString::new(right).unwrap();
    let path = resources.to_str().unwrap();
    for uri in [
        path.to_owned(),
        format!("file://{path}"),
        format!("file://{}/", path.replace(' ', "%20").replace('ü', "%C3%BC")),
    ] {
        let uri = CString::new(uri).unwrap();
        assert_eq!(instantiate::<Decay>(c"a".as_ptr(), CS, right.as_ptr(), uri.as_ptr()), Ok(()));
    }
    let uri = CString::new(path).unwrap();
    let message =
        instantiate::<Decay>(c"a".as_ptr(), CS, guid::<Decay>().as_ptr(), uri.as_ptr()).unwrap_err();
    assert!(
        message.format.contains("start values of") && message.format.contains("parameters.toml"),
        "{message:?}"
    );
    let message = instantiate::<Decay>(c"a".as_ptr(), CS, right.as_ptr(), ptr::null()).unwrap_err();
    assert!(message.format.contains("no resource location was given"), "{message:?}");
    let message = instantiate::<Decay>(c"a".as_ptr(), CS, right.as_ptr(), c"/nowhere".as_ptr()).unwrap_err();
    assert!(message.format.contains("no parameters.toml in /nowhere"), "{message:?}");
    fs::write(resources.join("parameters.toml"), text.replace("rate", "rat")).unwrap();
    let message = instantiate::<Decay>(c"a".as_ptr(), CS, right.as_ptr(), uri.as_ptr()).unwrap_err();
    assert!(
        message.format.contains("does not fit Decay") && message.format.contains("`rate`?"),
        "{message:?}"
    );
    fs::write(resources.join("parameters.toml"), "100 % wrong").unwrap();
    let message = instantiate::<Decay>(c"a".as_ptr(), CS, right.as_ptr(), uri.as_ptr()).unwrap_err();
    assert!(message.format.contains("parameters.toml is no parameter set"), "{message:?}");
    assert!(message.format.contains("100 %% wrong"), "{message:?}");
}

#[test]
fn discarded_steps_are_told_if_debug_logging_is_on() {
    let host = Host::<Fragile>::initialized(CS);
    let told = || {
        let state = host.save();
        assert_eq!(host.do_step(0.0, 2.0, TRUE), Status::Discard);
        assert_eq!(host.set_fmu_state(state), Status::Ok);
        !host.messages().is_empty()
    };
    assert!(told());
    for (on, categories, expected) in [
        (FALSE, vec![], false),
        (TRUE, vec![c"logStatusDiscard"], true),
        (FALSE, vec![c"logStatusError", c"logStatusFatal", c"logStatusWarning"], true),
        (FALSE, vec![c"logAll"], false),
        (TRUE, vec![], true),
    ] {
        let pointers: Vec<Text> = categories.iter().map(|category| category.as_ptr()).collect();
        assert_eq!(host.set_debug_logging(on, pointers.len(), pointers.as_ptr()), Status::Ok);
        assert_eq!(told(), expected, "{on} {categories:?}");
    }
    assert_eq!(host.set_debug_logging(FALSE, 0, ptr::null()), Status::Ok);
    assert_eq!(host.do_step(0.0, -1.0, TRUE), Status::Error);
    assert_eq!(host.message().category, "logStatusError");
    assert_eq!(host.reset(), Status::Ok);
    host.initialize();
    assert!(told(), "as at fmi2Instantiate");
}

#[test]
fn what_the_integration_has_cost_is_told_at_the_end_if_debug_logging_is_on() {
    let costs = |on: Boolean, categories: &[&std::ffi::CStr]| {
        let host = Host::<Decay>::initialized(CS);
        let pointers: Vec<Text> = categories.iter().map(|category| category.as_ptr()).collect();
        assert_eq!(host.set_debug_logging(on, pointers.len(), pointers.as_ptr()), Status::Ok);
        assert_eq!(host.do_step(0.0, 0.001, TRUE), Status::Ok);
        assert_eq!(host.do_step(0.001, 0.001, TRUE), Status::Ok);
        assert_eq!(host.terminate(), Status::Ok);
        host.messages()
    };
    let told = costs(TRUE, &[c"logSolver"]);
    assert_eq!(told.len(), 1, "{told:?}");
    assert_eq!((told[0].category.as_str(), told[0].status), ("logSolver", Status::Ok));
    // Two to begin with, six a step.
    let expected = "fmi2Terminate: the integration took 2 steps and tried 0 that were too long, with 14 evaluations \
         of the rates and 0 Jacobians";
    assert_eq!(told[0].format, expected);
    assert_eq!(costs(TRUE, &[c"logAll"]), told);
    assert_eq!(costs(FALSE, &[c"logSolver"]), []);
    assert_eq!(costs(FALSE, &[c"logStatusDiscard"]), told, "it was on at fmi2Instantiate");
}

#[test]
fn unknown_categories_are_refused_and_the_known_ones_named() {
    let host = Host::<Decay>::new(CS);
    assert_eq!(host.set_debug_logging(TRUE, 1, &c"logEverything".as_ptr()), Status::Error);
    let message = host.message();
    assert!(message.format.contains("logEverything"));
    for (category, _) in LOG_CATEGORIES {
        assert!(message.format.contains(category), "{message:?}");
        let known = CString::new(*category).unwrap();
        assert_eq!(host.set_debug_logging(TRUE, 1, &known.as_ptr()), Status::Ok);
    }
    assert_eq!(host.set_debug_logging(TRUE, 1, &ptr::null()), Status::Error);
    assert_eq!(host.set_debug_logging(TRUE, 1, ptr::null()), Status::Error);
}

#[test]
fn messages_carry_the_instance_name_and_survive_being_formats() {
    let host = Host::<Configured>::new(CS);
    assert_eq!(host.set_debug_logging(TRUE, 1, &c"100 %s %n".as_ptr()), Status::Error);
    let message = host.message();
    assert_eq!(message.instance, "test");
    assert!(message.format.contains("100 %%s %%n"), "{message:?}");
}
