//! Going back, going on elsewhere, and starting afresh: always bit for bit.

use std::ptr;

use crate::common::{models::*, *};
use proptest::prelude::*;
use strut_fmi::fmi2::types::*;
use strut_model::Model;

/// A run, rewound to each third of it, in the same instance and as bytes in another.
fn rewinds<M: Model>(prepare: impl Fn(&Host<M>)) {
    let host = Host::<M>::new(CS);
    prepare(&host);
    host.initialize();
    let mut saved = Vec::new();
    let mut path = Vec::new();
    for part in 0..3 {
        let state = host.save();
        saved.push((state, host.serialize(state)));
        path.extend(host.run(part * 5, 5));
    }
    for (part, (state, bytes)) in saved.iter().enumerate().rev() {
        assert_eq!(host.set_fmu_state(*state), Status::Ok);
        assert_eq!(host.run(part * 5, 5), path[part * 5..part * 5 + 5], "rewound");
        // A fresh instance has had other parameters and another solver.
        let other = Host::<M>::new(CS);
        let (status, restored) = other.deserialize(bytes);
        assert_eq!(status, Status::Ok);
        assert_eq!(other.set_fmu_state(restored), Status::Ok);
        assert_eq!(other.run(part * 5, 5), path[part * 5..part * 5 + 5], "as bytes");
        assert_eq!(other.serialize(other.save()), host.serialize(host.save()));
    }
}

#[test]
fn every_model_continues_bit_for_bit() {
    rewinds::<Decay>(|host| assert_eq!(host.set("rate", 3.0), Status::Ok));
    rewinds::<Controller>(|host| assert_eq!(host.set("period", 0.003), Status::Ok));
    rewinds::<Hybrid>(|_| {});
    rewinds::<Configured>(|host| assert_eq!(host.set_integer(&1, 1, &9), Status::Ok));
}

#[test]
fn the_method_and_the_tolerance_are_part_of_the_state() {
    rewinds::<Hybrid>(|host| {
        assert_eq!(host.set_integer(&reference::<Hybrid>("solver.method"), 1, &2), Status::Ok);
        assert_eq!(host.set("solver.tolerance", 1e-3), Status::Ok);
    });
}

#[test]
fn a_state_saved_between_a_change_and_the_next_step_contains_the_change() {
    let host = Host::<Decay>::initialized(CS);
    assert_eq!(host.set("rate", 5.0), Status::Ok);
    assert_eq!(host.set_real_input_derivatives(&0, 1, &1, &2.0), Status::Ok);
    let state = host.save();
    assert_eq!(host.do_step(0.0, 0.5, TRUE), Status::Ok);
    let after = host.bits();
    assert_eq!(host.set("rate", 1.0), Status::Ok);
    assert_eq!(host.do_step(0.5, 0.5, TRUE), Status::Ok);
    assert_eq!(host.set_fmu_state(state), Status::Ok);
    assert_eq!(host.do_step(0.0, 0.5, TRUE), Status::Ok);
    assert_eq!(host.bits(), after);
}

#[test]
fn reset_makes_a_fresh_instance_even_after_a_failure() {
    fn check<M: Model>(spoil: impl Fn(&Host<M>)) {
        let fresh = Host::<M>::new(CS);
        let used = Host::<M>::new(CS);
        spoil(&used);
        used.messages();
        assert_eq!(used.reset(), Status::Ok);
        assert_eq!(used.serialize(used.save()), fresh.serialize(fresh.save()));
        fresh.initialize();
        used.initialize();
        assert_eq!(used.run(0, 8), fresh.run(0, 8));
    }
    check::<Hybrid>(|host| {
        host.set("period", 0.5);
        host.setup_experiment(TRUE, 1e-3, 5.0, TRUE, 6.0);
        host.enter_initialization_mode();
        host.exit_initialization_mode();
        host.do_step(5.0, 0.7, TRUE);
        host.terminate();
    });
    check::<Fragile>(|host| {
        host.initialize();
        host.set("force", 1e200);
        assert_eq!(host.do_step(0.0, 1e3, TRUE), Status::Discard);
    });
    check::<Configured>(|host| {
        host.set_string(&3, 1, &c"no".as_ptr());
        host.enter_initialization_mode();
        assert_eq!(host.exit_initialization_mode(), Status::Error);
    });
}

#[test]
fn a_pointer_to_a_saved_state_is_reused_freed_and_looked_up() {
    let host = Host::<Decay>::initialized(CS);
    let mut state = host.save();
    let first = state;
    assert_eq!(host.do_step(0.0, 0.1, TRUE), Status::Ok);
    assert_eq!(host.get_fmu_state(&mut state), Status::Ok);
    assert_eq!(state, first);
    assert_eq!(host.do_step(0.1, 0.1, TRUE), Status::Ok);
    assert_eq!(host.set_fmu_state(state), Status::Ok);
    assert_eq!(host.do_step(0.1, 0.1, TRUE), Status::Ok);
    assert_eq!(host.free_fmu_state(&mut state), Status::Ok);
    assert!(state.is_null());
    assert_eq!(host.free_fmu_state(&mut state), Status::Ok);
    let other = Host::<Decay>::initialized(CS);
    for (mut wrong, part) in
        [(first, "was freed"), (other.save(), "serialize it"), (ptr::null_mut(), "is none")]
    {
        assert_eq!(host.set_fmu_state(wrong), Status::Error);
        assert!(host.message().format.contains(part));
        assert_eq!(host.serialized_fmu_state_size(wrong, &mut 0), Status::Error);
        if !wrong.is_null() {
            assert_eq!(host.free_fmu_state(&mut wrong), Status::Error);
            assert_eq!(host.get_fmu_state(&mut wrong), Status::Error);
        }
        host.messages();
    }
    assert_eq!(host.get_fmu_state(ptr::null_mut()), Status::Error);
}

#[test]
fn bytes_of_another_kind_or_length_are_refused() {
    let host = Host::<Decay>::initialized(CS);
    let state = host.save();
    let bytes = host.serialize(state);
    let mut short = vec![0_i8; bytes.len() - 1];
    assert_eq!(host.serialize_fmu_state(state, short.as_mut_ptr().cast(), short.len()), Status::Error);
    assert!(host.message().format.contains("fmi2SerializedFMUstateSize"));
    let exchange = Host::<Decay>::initialized(ME);
    assert_eq!(exchange.deserialize(&bytes).0, Status::Error);
    assert!(exchange.message().format.contains("model exchange and co-simulation"));
    let stranger = Host::<Hybrid>::initialized(CS);
    assert_eq!(stranger.deserialize(&bytes).0, Status::Error);
    assert!(stranger.message().format.contains("another GUID"));
}

proptest! {
    #[test]
    fn damaged_and_foreign_bytes_are_errors(
        bytes: Vec<u8>,
        place: prop::sample::Index,
        change in 1_u8..,
    ) {
        let host = Host::<Configured>::initialized(CS);
        let (status, state) = host.deserialize(&bytes);
        prop_assert_eq!((status, state), (Status::Error, ptr::null_mut()));
        let mut damaged = host.serialize(host.save());
        let len = damaged.len();
        damaged[place.index(len)] ^= change;
        prop_assert_eq!(host.deserialize(&damaged).0, Status::Error);
        prop_assert_eq!(host.do_step(0.0, 0.1, TRUE), Status::Ok);
    }
}
