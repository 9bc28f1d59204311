//! Reading and writing variables of every type, and what is refused.

use std::{ffi::CStr, ptr, thread};

use crate::common::{models::*, *};
use strut_fmi::fmi2::types::*;

#[test]
fn settings_of_every_type_are_read_written_and_take_effect() {
    let host = Host::<Configured>::new(CS);
    assert_eq!(host.set_integer([0_u32, 1].as_ptr(), 2, [2, 5].as_ptr()), Status::Ok);
    assert_eq!(host.set_boolean(&2, 1, &7), Status::Ok);
    assert_eq!(host.set_string(&3, 1, &c"grün".as_ptr()), Status::Ok);
    host.initialize();
    let (mut numbers, mut flag, mut texts) = ([0; 2], 0, [ptr::null(); 2]);
    assert_eq!(host.get_integer([1_u32, 0].as_ptr(), 2, numbers.as_mut_ptr()), Status::Ok);
    assert_eq!(host.get_boolean(&2, 1, &mut flag), Status::Ok);
    assert_eq!(host.get_string([4_u32, 3].as_ptr(), 2, texts.as_mut_ptr()), Status::Ok);
    // SAFETY: the strings live until the next question for strings.
    let texts = texts.map(|text| unsafe { CStr::from_ptr(text) });
    assert_eq!((numbers, flag, texts), ([5, 2], TRUE, [c"", c"grün"]));
    assert_eq!(host.real("signal"), 105.25);
    // Tunable ones take effect at once.
    assert_eq!(host.set_boolean(&2, 1, &FALSE), Status::Ok);
    assert_eq!(host.real("signal"), 5.25);
}

#[test]
fn what_is_refused_is_named() {
    let host = Host::<Configured>::initialized(CS);
    let mut text = ptr::null();
    let told = |status, part: &str| {
        assert_eq!(status, Status::Error);
        let message = host.message().format;
        assert!(message.contains(part), "{message}");
    };
    told(host.set_integer(&0, 1, &2), "shape");
    told(host.get_integer(&2, 1, &mut 0), "reference 2 is no integer variable");
    told(host.get_string(&99, 1, &mut text), "99");
    told(host.set_string(&3, 1, &ptr::null()), "null pointer");
    told(host.set_string(&3, 1, &c"\xff".as_ptr()), "UTF-8");
    told(host.set_string(&3, 1, ptr::null()), "value is a null pointer");
    told(host.get_real(ptr::null(), 3, &mut 0.0), "vr is a null pointer: give the address of 3 values");
    told(host.get_real(&0, 1, ptr::null_mut()), "value is a null pointer");
    told(host.get_real(&0, usize::MAX, &mut 0.0), "cannot be an array");
    told(host.get_real(&9, 1, &mut 0.0), "reference 9 is no real variable of Configured");
    told(host.set("signal", 1.0), "`signal` cannot be set: it is an output");
    assert_eq!(host.get_real(ptr::null(), 0, ptr::null_mut()), Status::Ok);
    let host = Host::<Decay>::new(CS);
    for (name, value) in
        [("force", f64::NAN), ("force", f64::INFINITY), ("rate", -1.0), ("position", f64::NAN)]
    {
        assert_eq!(host.set(name, value), Status::Error);
        assert!(host.message().format.contains(name));
    }
    host.initialize();
    for (name, value) in [("gain", 2.0), ("position", 2.0), ("der(position)", 1.0)] {
        assert_eq!(host.set(name, value), Status::Error, "{name}");
        assert!(host.message().format.contains(name));
    }
    assert_eq!(host.set("rate", 1.0), Status::Ok);
}

#[test]
fn refused_settings_may_be_mended() {
    let host = Host::<Configured>::new(CS);
    assert_eq!(host.set_string(&3, 1, &c"no".as_ptr()), Status::Ok);
    assert_eq!(host.enter_initialization_mode(), Status::Ok);
    assert_eq!(host.exit_initialization_mode(), Status::Error);
    assert!(host.message().format.contains("`label` cannot be \"no\""));
    assert_eq!(host.set_string(&3, 1, &c"yes".as_ptr()), Status::Ok);
    assert_eq!(host.exit_initialization_mode(), Status::Ok);
}

#[test]
fn experiments_are_checked() {
    let host = Host::<Decay>::new(CS);
    for (start, stop) in [(f64::NAN, 1.0), (f64::INFINITY, 1.0), (0.0, f64::NAN), (1.0, 1.0), (1.0, 0.0)] {
        assert_eq!(host.setup_experiment(FALSE, 0.0, start, TRUE, stop), Status::Error, "{start} {stop}");
        assert!(host.message().format.contains("time"));
    }
    for tolerance in [0.0, -1.0, f64::NAN, 1.0] {
        assert_eq!(host.setup_experiment(TRUE, tolerance, 2.0, FALSE, 0.0), Status::Warning, "{tolerance}");
        let message = host.message();
        assert_eq!(message.category, "logStatusWarning");
    }
    assert_eq!(host.setup_experiment(TRUE, 1e-9, 2.0, FALSE, 0.0), Status::Ok);
    assert_eq!(host.enter_initialization_mode(), Status::Ok);
    assert_eq!(host.real("solver.tolerance"), 1e-9);
    assert_eq!(host.exit_initialization_mode(), Status::Ok);
    assert_eq!(host.do_step(2.0, 0.1, TRUE), Status::Ok);
}

#[test]
fn instances_in_many_threads_do_not_disturb_each_other() {
    let alone = Host::<Hybrid>::initialized(CS).run(0, 40);
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                let hosts: Vec<_> = (0..5).map(|_| Host::<Hybrid>::initialized(CS)).collect();
                for host in &hosts {
                    assert_eq!(host.run(0, 40), alone);
                }
            });
        }
    });
}

#[test]
fn steps_allocate_nothing() {
    fn check<M: strut_model::Model>() {
        let host = Host::<M>::initialized(CS);
        let force = reference::<M>("force");
        let signal = reference::<M>("signal");
        let counted = allocation_counter::measure(|| {
            for step in 0..100 {
                let time = 0.013 * f64::from(step);
                let mut value = 0.0;
                assert_eq!(host.set_real(&force, 1, &time), Status::Ok);
                assert_eq!(host.set_real_input_derivatives(&force, 1, &1, &1.0), Status::Ok);
                assert_eq!(host.do_step(time, 0.013, TRUE), Status::Ok);
                assert_eq!(host.get_real(&signal, 1, &mut value), Status::Ok);
            }
        });
        assert_eq!((counted.count_total, counted.bytes_total), (0, 0), "{}", M::ABOUT.name);
    }
    check::<Decay>();
    check::<Controller>();
    check::<Hybrid>();
}

#[test]
fn start_values_are_read_before_initialisation() {
    for kind in [ME, CS] {
        let host = Host::<Decay>::new(kind);
        for (name, start) in [("force", 0.0), ("position", 1.0), ("rate", 2.0), ("gain", 1.0)] {
            assert_eq!(host.real(name), start, "{name}");
        }
        assert_eq!(host.set("position", 3.0), Status::Ok);
        assert_eq!(host.real("position"), 3.0);
        for name in ["signal", "der(position)"] {
            assert_eq!(host.get_real(&reference::<Decay>(name), 1, &mut 0.0), Status::Error);
            let message = host.message().format;
            assert!(message.contains(name) && message.contains("Initialization Mode"), "{message}");
        }
        let host = Host::<Configured>::new(kind);
        let (mut numbers, mut flag, mut text) = ([0; 2], 7, ptr::null());
        assert_eq!(host.get_integer([0_u32, 1].as_ptr(), 2, numbers.as_mut_ptr()), Status::Ok);
        assert_eq!(host.get_boolean(&2, 1, &mut flag), Status::Ok);
        assert_eq!(host.get_string(&3, 1, &mut text), Status::Ok);
        // SAFETY: the string lives until the next question for strings.
        let text = unsafe { CStr::from_ptr(text) };
        assert_eq!((numbers, flag, text), ([1, 3], TRUE, c"räder"));
    }
}

#[test]
fn states_are_set_one_by_one_while_an_importer_integrates() {
    let host = Host::<Decay>::initialized(ME);
    assert_eq!(host.set("position", 3.0), Status::Error);
    assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
    assert_eq!(host.set("position", 3.0), Status::Ok);
    assert_eq!((host.real("position"), host.real("signal"), host.real("der(position)")), (3.0, 9.0, -6.0));
    let mut state = 0.0;
    assert_eq!(host.get_continuous_states(&mut state, 1), Status::Ok);
    assert_eq!(state, 3.0);
    assert_eq!(host.set("position", f64::NAN), Status::Error);
    assert_eq!(host.set("rate", 1.0), Status::Error);
    assert_eq!(host.set("signal", 1.0), Status::Error);
    assert_eq!(host.real("position"), 3.0);
    let host = Host::<Decay>::initialized(CS);
    assert_eq!(host.set("position", 3.0), Status::Error);
    assert!(host.message().format.contains("Continuous-Time Mode only"));
}
