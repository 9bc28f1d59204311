//! FMI 3.0, where it is not as FMI 2.0.

mod host;
mod states;

use std::ptr;

use self::host::Host;
use crate::common::{self, models::*};
use strut_fmi::fmi3::types::*;
use strut_model::{Interface, Model};

/// References and number of values of variables: real ones and arrays.
fn reference<M: Model>(name: &str) -> u32 {
    let interface = Interface::of::<M>(None, None).unwrap();
    let position = interface.variables.iter().position(|variable| variable.name == name).unwrap();
    position as u32
}

#[test]
fn an_array_is_one_variable_with_as_many_values_as_it_has_elements() {
    let host = Host::<Tabled>::co_simulation();
    let (weight, offset) = (reference::<Tabled>("weight[1]"), reference::<Tabled>("offset"));
    let references = [offset, weight];
    assert_eq!(host.float64(&references, 4), Ok(vec![1.0, 1.0, 2.0, 3.0]));
    assert_eq!(host.set(&references, &[5.0, 6.0, 7.0, 8.0]), Status::Ok);
    assert_eq!(host.float64(&[weight], 3), Ok(vec![6.0, 7.0, 8.0]));
    for (references, values) in
        [(&[weight][..], 1), (&[weight], 2), (&[weight + 1], 1), (&[offset], 2), (&[], 1)]
    {
        assert_eq!(host.float64(references, values), Err(Status::Error), "{references:?}");
        assert_eq!(host.set(references, &vec![9.0; values]), Status::Error, "{references:?}");
    }
    assert_eq!(host.set(&[weight], &[1.0, -1.0, 2.0]), Status::Error, "out of bounds");
    assert!(host.last_message().contains("weight[2]"), "{}", host.last_message());
}

#[test]
fn time_and_event_indicators_can_be_read_and_not_set() {
    let interface = Interface::of::<Stopped>(None, None).unwrap();
    let (numbering, count) = (interface.numbering(), interface.event_indicators as u32);
    let host = Host::<Stopped>::model_exchange();
    assert_eq!(host.float64(&[numbering.indicators], 1), Err(Status::Error), "not yet calculated");
    host.initialize(0.25);
    assert_eq!(host.float64(&[numbering.time], 1), Ok(vec![0.25]));
    let references: Vec<u32> = (numbering.indicators..numbering.indicators + count).collect();
    assert_eq!(host.float64(&references, references.len()), Ok(host.event_indicators(references.len())));
    for reference in [numbering.time, numbering.indicators] {
        assert_eq!(host.set(&[reference], &[0.0]), Status::Error);
    }
    assert_eq!(host.float64(&[numbering.time + 1], 1), Err(Status::Error));
    assert_eq!(host.numbers(), (1, references.len()));
}

#[test]
fn each_setting_has_its_own_type() {
    let host = Host::<Configured>::co_simulation();
    let [shape, count, switch, label] = ["shape", "count", "switch", "label"].map(reference::<Configured>);
    assert_eq!((host.int64(shape), host.int32(count)), (Ok(1), Ok(3)));
    assert_eq!((host.boolean(switch), host.string(label)), (Ok(true), Ok("räder".into())));
    assert_eq!(host.set_int64(shape, 2), Status::Ok);
    assert_eq!(host.int64(shape), Ok(2));
    for wrong in [3, 0, i64::MAX, i64::from(u32::MAX) + 2] {
        assert_eq!(host.set_int64(shape, wrong), Status::Error, "{wrong}");
    }
    assert_eq!(host.int32(shape), Err(Status::Error), "an enumeration is no Int32");
    assert_eq!(host.int64(count), Err(Status::Error), "an Int32 is no enumeration");
    assert_eq!(host.boolean(label), Err(Status::Error));
    assert_eq!(host.int32(reference::<Configured>("signal")), Err(Status::Error));
    assert_eq!(host.string(switch), Err(Status::Error));
}

#[test]
fn directional_and_adjoint_derivatives_are_the_same_jacobian() {
    let host = Host::<Tabled>::co_simulation();
    host.initialize(2.0);
    let time = Interface::of::<Tabled>(None, None).unwrap().numbering().time;
    let [force, position, weight, signal, rate] =
        ["force", "position", "weight[1]", "signal", "der(position)"].map(reference::<Tabled>);
    assert_eq!(host.set(&[force], &[0.5]), Status::Ok);
    let (unknowns, knowns) = ([signal, rate], [force, position, weight, time]);
    // Columns: force, position, three weights, time; x = 1, u = 0.5, t = 2, weights 1, 2, 3.
    let jacobian = [[6.0, 2.0, 0.0, 1.0, 1.0, 1.5], [1.0, -1.0, -1.0, 0.0, 0.0, 0.0]];
    for column in 0..6 {
        let mut seed = [0.0; 6];
        seed[column] = 1.0;
        assert_eq!(
            host.directional(&unknowns, &knowns, &seed, 2),
            Ok(jacobian.map(|row| row[column]).to_vec())
        );
    }
    for (row, expected) in jacobian.iter().enumerate() {
        let mut seed = [0.0; 2];
        seed[row] = 1.0;
        assert_eq!(host.adjoint(&unknowns, &knowns, &seed, 6), Ok(expected.to_vec()));
    }
    assert_eq!(host.directional(&unknowns, &knowns, &[1.0; 4], 2), Err(Status::Error), "six seeds are right");
    assert_eq!(host.adjoint(&unknowns, &knowns, &[f64::NAN; 2], 6), Err(Status::Error));
    assert_eq!(host.directional(&[time], &[force], &[1.0], 1), Err(Status::Error));
}

#[test]
fn a_host_that_handles_events_gets_to_each_tick() {
    let plain = Host::<Hybrid>::co_simulation();
    plain.initialize(0.0);
    assert_eq!(plain.do_step(0.0, 0.025), Ok((false, false, 0.025)), "the ticks are inside");
    let host = Host::<Hybrid>::with_events(true, true);
    host.initialize(0.0);
    assert_eq!(host.update(), Ok((false, Some(0.01))));
    assert_eq!(host.enter_step_mode(), Status::Ok);
    let mut reached = Vec::new();
    let mut time = 0.0;
    while time < 0.025 {
        let (event, early, now) = host.do_step(time, 0.025 - time).unwrap();
        assert_eq!((event, early), (now < 0.025, now < 0.025));
        time = now;
        reached.push(now);
        if event {
            assert_eq!(host.enter_event_mode(), Status::Ok);
            assert_eq!(host.update(), Ok((false, Some(0.01 * (reached.len() + 1) as f64))));
            assert_eq!(host.enter_step_mode(), Status::Ok);
        }
    }
    assert_eq!(reached, [0.01, 0.02, 0.025]);
    let outputs = ["position", "signal"].map(reference::<Hybrid>);
    assert_eq!(host.float64(&outputs, 2), plain.float64(&outputs, 2));
    // A tick at the end of a step is announced, too.
    let late = Host::<Hybrid>::with_events(true, false);
    late.initialize(0.0);
    assert_eq!(late.update(), Ok((false, Some(0.01))));
    assert_eq!(late.enter_step_mode(), Status::Ok);
    assert_eq!(late.do_step(0.0, 0.01), Ok((true, false, 0.01)));
    assert_eq!(late.do_step(0.01, 0.015), Ok((false, false, 0.025)), "who does not care may go on");
    assert_eq!(late.float64(&outputs, 2), plain.float64(&outputs, 2));
}

#[test]
fn a_step_that_is_wrong_is_not_made_up_to_a_tick() {
    let host = Host::<Hybrid>::with_events(true, true);
    assert_eq!(host.enter_initialization_mode(None, 0.0, Some(1.0)), Status::Ok);
    assert_eq!(host.exit_initialization_mode(), Status::Ok);
    assert_eq!(host.enter_step_mode(), Status::Ok);
    for (point, size) in [(0.0, f64::INFINITY), (0.0, f64::NAN), (0.0, 2.0), (0.5, 0.1), (0.0, -1.0)] {
        assert_eq!(host.do_step(point, size), Err(Status::Error), "{point} {size}");
    }
    assert_eq!(host.do_step(0.0, 1.0), Ok((true, true, 0.01)));
}

#[test]
fn event_mode_has_to_be_asked_for() {
    let host = Host::<Hybrid>::co_simulation();
    host.initialize(0.0);
    assert_eq!(host.enter_event_mode(), Status::Error);
    assert!(host.last_message().contains("eventModeUsed"), "{}", host.last_message());
}

#[test]
fn states_may_be_set_at_events_of_model_exchange_only() {
    let position = reference::<Decay>("position");
    let host = Host::<Decay>::model_exchange();
    host.initialize(0.0);
    assert_eq!(host.set(&[position], &[0.25]), Status::Ok);
    assert_eq!(host.float64(&[position], 1), Ok(vec![0.25]));
    let host = Host::<Decay>::with_events(true, false);
    host.initialize(0.0);
    assert_eq!(host.set(&[position], &[0.25]), Status::Error);
}

#[test]
fn both_versions_take_the_same_steps_and_states() {
    let two = common::Host::<Hybrid>::initialized(common::CS);
    let three = Host::<Hybrid>::co_simulation();
    three.initialize(0.0);
    let force = reference::<Hybrid>("force");
    let count = Interface::of::<Hybrid>(None, None).unwrap().numbering().settings as usize;
    let references: Vec<u32> = (0..count as u32).collect();
    let bits = |values: Vec<f64>| -> Vec<u64> { values.into_iter().map(f64::to_bits).collect() };
    for (index, expected) in two.run(0, 20).into_iter().enumerate() {
        let time = index as f64 * 0.007;
        assert_eq!(three.set(&[force], &[(3.0 * time).sin()]), Status::Ok);
        three.do_step(time, 0.007).unwrap();
        assert_eq!(bits(three.float64(&references, count).unwrap()), expected);
    }
    assert_eq!(three.bytes(), two.serialize(two.save()), "a state goes from one version to the other");
}

#[test]
fn an_instance_of_one_version_is_none_of_the_other() {
    let (two, three) = (common::Host::<Decay>::new(common::CS), Host::<Decay>::co_simulation());
    // SAFETY: the components are instances, of another version than the functions.
    unsafe {
        use strut_fmi::{fmi2, fmi3, shared};
        assert_eq!(shared::reset::<Decay>(&fmi3::state_table::RESET, two.c), Status::Error);
        assert_eq!(shared::reset::<Decay>(&fmi2::state_table::RESET, three.component), Status::Error);
        shared::free_instance::<Decay>(&fmi2::state_table::FREE_INSTANCE, three.component);
    }
    assert_eq!(three.reset(), Status::Ok);
}

#[test]
fn warnings_are_told_to_those_who_ask() {
    for (logging, told) in [(false, 0), (true, 1)] {
        let host = Host::<Decay>::logging(logging);
        assert_eq!(host.enter_initialization_mode(Some(1e3), 0.0, None), Status::Warning);
        assert_eq!(host.messages().len(), told);
        assert_eq!(host.enter_initialization_mode(None, 0.0, None), Status::Error);
        assert_eq!(host.messages().len(), told + 1, "errors are always logged");
    }
    let host = Host::<Decay>::logging(false);
    assert_eq!(host.set_debug_logging(true, &[c"logStatusWarning"]), Status::Ok);
    assert_eq!(host.enter_initialization_mode(Some(1e3), 0.0, None), Status::Warning);
    assert_eq!(host.messages().len(), 1);
}

#[test]
fn what_is_not_offered_is_refused_with_a_reason() {
    let guid = common::guid::<Decay>();
    let mut messages: Vec<String> = Vec::new();
    let environment = (&raw mut messages).cast();
    // SAFETY: all pointers live.
    unsafe {
        use strut_fmi::fmi3::functions as f;
        let (name, token, log) = (c"a".as_ptr(), guid.as_ptr(), Some(host::RECORD));
        let (none, nobody): (Text, Callback) = (ptr::null(), ptr::null());
        assert!(
            f::instantiate_scheduled_execution::<Decay>(
                name,
                token,
                none,
                0,
                0,
                environment,
                log,
                nobody,
                nobody,
                nobody
            )
            .is_null()
        );
        let wanted = [0_u32];
        let (wanted, one) = (wanted.as_ptr(), 1);
        assert!(
            f::instantiate_co_simulation::<Decay>(
                name,
                token,
                ptr::null(),
                0,
                0,
                0,
                0,
                wanted,
                one,
                environment,
                log,
                nobody
            )
            .is_null()
        );
        assert!(
            f::instantiate_model_exchange::<Decay>(
                name,
                c"{x}".as_ptr(),
                ptr::null(),
                0,
                0,
                environment,
                log
            )
            .is_null()
        );
    }
    assert!(messages[0].contains("no scheduled execution"), "{messages:?}");
    assert!(messages[1].contains("no intermediate updates"), "{messages:?}");
    assert!(messages[2].contains("the GUID \"{x}\" is not"), "{messages:?}");
}
