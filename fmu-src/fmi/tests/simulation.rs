//! What comes out: steps, derivatives, events.

use std::ptr;

use crate::common::{models::*, *};
use strut_fmi::fmi2::types::*;
use strut_model::{Interface, Model};

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * (1.0 + b.abs()), "{a} is not {b}");
}

#[test]
fn a_life_in_co_simulation() {
    let host = Host::<Decay>::new(CS);
    assert_eq!(host.setup_experiment(TRUE, 1e-10, 1.0, TRUE, 2.0), Status::Ok);
    assert_eq!(host.set("rate", 3.0), Status::Ok);
    assert_eq!(host.enter_initialization_mode(), Status::Ok);
    assert_eq!(host.set("force", 6.0), Status::Ok);
    assert_eq!(host.real("der(position)"), 6.0 - 3.0);
    assert_eq!(host.exit_initialization_mode(), Status::Ok);
    // A clock that adds up and one that multiplies are both right.
    let mut time = 1.0;
    for _ in 0..10 {
        assert_eq!(host.do_step(time, 0.1, TRUE), Status::Ok, "{:?}", host.messages());
        time += 0.1;
    }
    close(host.real("position"), 2.0 - f64::exp(-3.0), 1e-8);
    assert_eq!(host.do_step(2.0, 0.1, TRUE), Status::Error);
    assert!(host.message().format.contains("stop time"));
    assert_eq!(host.terminate(), Status::Ok);
    close(host.real("signal"), (2.0 - f64::exp(-3.0)).powi(2), 1e-8);
}

#[test]
fn steps_that_lead_nowhere_are_refused_and_change_nothing() {
    let host = Host::<Hybrid>::initialized(CS);
    let before = host.bits();
    for (point, size, part) in [
        (0.0, -0.1, "positive"),
        (0.0, 0.0, "positive"),
        (0.0, f64::NAN, "positive"),
        (0.0, f64::INFINITY, "positive"),
        (f64::NAN, 0.1, "communication step"),
        (0.3, 0.1, "0.3 s is not where"),
        (0.0, 1e300, "make shorter steps"),
    ] {
        assert_eq!(host.do_step(point, size, TRUE), Status::Error, "{point} {size}");
        let message = host.message().format;
        assert!(message.contains(part) || point.is_nan(), "{message}");
    }
    assert_eq!(host.bits(), before);
    assert_eq!(host.do_step(0.0, 0.1, TRUE), Status::Ok);
}

#[test]
fn a_step_that_fails_is_discarded() {
    let host = Host::<Fragile>::initialized(CS);
    let (mut time, mut end) = (f64::NAN, TRUE);
    assert_eq!(host.do_step(0.0, 0.5, TRUE), Status::Ok);
    let before = host.bits();
    let saved = host.save();
    // x' = x² from x = 2 at 0.5 s is infinite at 1 s.
    assert_eq!(host.do_step(0.5, 1.0, TRUE), Status::Discard);
    let message = host.message();
    assert_eq!(message.category, "logStatusDiscard");
    assert_eq!(host.get_real_status(2, &mut time), Status::Ok);
    assert_eq!(host.get_boolean_status(3, &mut end), Status::Ok);
    assert_eq!((time, end), (0.5, FALSE));
    assert_eq!(host.bits(), before);
    assert_eq!(host.do_step(0.5, 0.1, TRUE), Status::Error);
    assert_eq!(host.set_fmu_state(saved), Status::Ok);
    assert_eq!(host.do_step(0.5, 0.4, TRUE), Status::Ok);
    close(host.real("position"), 10.0, 1e-4);
}

#[test]
fn status_questions_that_have_no_answer_say_where_to_ask() {
    let host = Host::<Decay>::initialized(CS);
    assert_eq!(host.get_real_status(3, &mut 0.0), Status::Discard);
    assert!(host.message().format.contains("fmi2GetBooleanStatus"));
    assert_eq!(host.get_boolean_status(2, &mut 0), Status::Discard);
    assert!(host.message().format.contains("fmi2GetRealStatus"));
    assert_eq!(host.get_status(4, &mut Status::Ok), Status::Error);
    assert_eq!(host.get_real_status(2, ptr::null_mut()), Status::Error);
}

#[test]
fn a_polynomial_input_is_integrated_exactly() {
    let host = Host::<Decay>::new(CS);
    // Set before the start time is known, they belong to the start time.
    let (vr, orders, rates) = ([0, 0], [1, 2], [3.0, 4.0]);
    assert_eq!(host.set("rate", 0.0), Status::Ok);
    assert_eq!(host.set_real_input_derivatives(vr.as_ptr(), 2, orders.as_ptr(), rates.as_ptr()), Status::Ok);
    assert_eq!(host.set("force", 2.0), Status::Ok);
    assert_eq!(host.setup_experiment(FALSE, 0.0, 10.0, FALSE, 0.0), Status::Ok);
    assert_eq!(host.enter_initialization_mode(), Status::Ok);
    assert_eq!(host.real("force"), 2.0);
    assert_eq!(host.exit_initialization_mode(), Status::Ok);
    assert_eq!(host.do_step(10.0, 0.5, TRUE), Status::Ok);
    close(host.real("position"), 1.0 + 2.0 * 0.5 + 3.0 * 0.125 + 4.0 / 6.0 * 0.125, 1e-14);
    close(host.real("force"), 2.0 + 3.0 * 0.5 + 4.0 * 0.125, 1e-15);
    for order in [0, 3, -1] {
        assert_eq!(host.set_real_input_derivatives(&0, 1, &order, &1.0), Status::Error);
    }
}

#[test]
fn derivatives_of_outputs_and_by_variables_are_those_of_the_equations() {
    let host = Host::<Decay>::initialized(CS);
    assert_eq!(host.set("force", 0.5), Status::Ok);
    let (x, rate, gain) = (host.real("position"), host.real("rate"), host.real("gain"));
    let mut slope = 0.0;
    assert_eq!(
        host.get_real_output_derivatives(&reference::<Decay>("signal"), 1, &1, &mut slope),
        Status::Ok
    );
    close(slope, 2.0 * gain * x * (0.5 - rate * x), 1e-15);
    assert_eq!(
        host.get_real_output_derivatives(&reference::<Decay>("signal"), 1, &2, &mut slope),
        Status::Error
    );

    let unknowns = ["signal", "der(position)"].map(reference::<Decay>);
    let knowns = ["force", "position"].map(reference::<Decay>);
    let (seed, mut found) = ([0.3, -0.7], [0.0; 2]);
    let derivative = |found: &mut [f64; 2]| {
        host.get_directional_derivative(
            unknowns.as_ptr(),
            2,
            knowns.as_ptr(),
            2,
            seed.as_ptr(),
            found.as_mut_ptr(),
        )
    };
    assert_eq!(derivative(&mut found), Status::Ok);
    // Central differences, in a model exchange instance, where states can be set.
    let other = Host::<Decay>::initialized(ME);
    assert_eq!(other.enter_continuous_time_mode(), Status::Ok);
    let at = |h: f64| {
        assert_eq!(other.set("force", 0.5 + h * seed[0]), Status::Ok);
        assert_eq!(other.set_continuous_states(&(x + h * seed[1]), 1), Status::Ok);
        [other.real("signal"), other.real("der(position)")]
    };
    let (plus, minus) = (at(1e-5), at(-1e-5));
    for i in 0..2 {
        close(found[i], (plus[i] - minus[i]) / 2e-5, 1e-9);
    }
    assert_eq!(
        host.get_directional_derivative(&unknowns[0], 1, &unknowns[0], 1, &1.0, &mut slope),
        Status::Error
    );
    assert_eq!(
        host.get_directional_derivative(&unknowns[0], 1, &knowns[0], 1, &f64::NAN, &mut slope),
        Status::Error
    );
}

fn event<M: Model>(host: &Host<M>) -> EventInfo {
    let mut info = EventInfo {
        new_discrete_states_needed: TRUE,
        terminate_simulation: TRUE,
        nominals_of_continuous_states_changed: TRUE,
        values_of_continuous_states_changed: TRUE,
        next_event_time_defined: TRUE,
        next_event_time: f64::NAN,
    };
    assert_eq!(host.new_discrete_states(&mut info), Status::Ok);
    assert_eq!([info.terminate_simulation, info.values_of_continuous_states_changed], [FALSE; 2]);
    assert_eq!(info.nominals_of_continuous_states_changed, FALSE);
    info
}

/// Integrates by the midpoint rule with steps of 0.1 ms, ticks included.
fn exchange<M: Model>(end: f64) -> Host<M> {
    let host = Host::<M>::initialized(ME);
    let info = event(&host);
    assert_eq!(info.new_discrete_states_needed, FALSE);
    assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
    let (mut next, mut x, mut rate) = (info.next_event_time, 0.0, 0.0);
    let has_states = host.get_continuous_states(&mut x, 1) == Status::Ok;
    let h = 1e-4;
    for step in 0..(end / h).round() as usize {
        let time = step as f64 * h;
        let mut stage = |time: f64, x: f64| {
            assert_eq!(host.set_time(time), Status::Ok);
            assert_eq!(host.set("force", 0.3), Status::Ok);
            assert_eq!(host.set_continuous_states(&x, 1), Status::Ok);
            assert_eq!(host.get_derivatives(&mut rate, 1), Status::Ok);
            rate
        };
        if has_states {
            let middle = x + 0.5 * h * stage(time, x);
            x += h * stage(time + 0.5 * h, middle);
            stage(time + h, x);
        } else {
            assert_eq!(host.set_time(time + h), Status::Ok);
            assert_eq!(host.set("force", 0.3), Status::Ok);
        }
        let (mut enter, mut stop) = (TRUE, TRUE);
        assert_eq!(host.completed_integrator_step(TRUE, &mut enter, &mut stop), Status::Ok);
        assert_eq!((enter, stop), (FALSE, FALSE));
        if info.next_event_time_defined == TRUE && time + h >= next - 1e-9 && time + h < end - 1e-9 {
            assert_eq!(host.enter_event_mode(), Status::Ok);
            next = event(&host).next_event_time;
            assert!(next > time + h);
            assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
        }
    }
    host
}

#[test]
fn model_exchange_and_co_simulation_agree() {
    fn check<M: Model>(names: &[&str]) {
        let stepped = Host::<M>::initialized(CS);
        for step in 0..10 {
            // The first tick is made at the initial event, before the input is set.
            assert_eq!(stepped.set("force", if step == 0 { 0.0 } else { 0.3 }), Status::Ok);
            let first = step == 0;
            assert_eq!(
                stepped.do_step(0.02 * f64::from(step), if first { 1e-6 } else { 0.02 }, TRUE),
                Status::Ok
            );
            if first {
                assert_eq!(stepped.set("force", 0.3), Status::Ok);
                assert_eq!(stepped.do_step(1e-6, 0.02 - 1e-6, TRUE), Status::Ok);
            }
        }
        let exchanged = exchange::<M>(0.2);
        for name in names {
            close(exchanged.real(name), stepped.real(name), 1e-6);
        }
    }
    check::<Decay>(&["position", "signal", "der(position)"]);
    check::<Controller>(&["signal"]);
    check::<Hybrid>(&["position", "signal", "der(position)"]);
}

#[test]
fn a_host_that_went_past_ticks_makes_up_for_them() {
    let host = Host::<Controller>::initialized(ME);
    assert_eq!(event(&host).next_event_time, 0.01);
    assert_eq!(host.set_time(0.025), Status::Ok);
    assert_eq!(event(&host).new_discrete_states_needed, TRUE);
    let last = event(&host);
    assert_eq!((last.new_discrete_states_needed, last.next_event_time_defined), (FALSE, TRUE));
    close(last.next_event_time, 0.03, 1e-15);
    assert_eq!(event(&Host::<Decay>::initialized(ME)).next_event_time_defined, FALSE);
}

#[test]
fn outside_integrators_are_told_what_they_need_and_what_they_got_wrong() {
    let host = Host::<Fragile>::initialized(ME);
    let mut value = 0.0;
    assert_eq!(host.get_nominals_of_continuous_states(&mut value, 1), Status::Ok);
    assert_eq!(value, 0.5);
    assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
    assert_eq!(host.set_continuous_states(&f64::NAN, 1), Status::Error);
    assert_eq!(host.set_continuous_states(&1.0, 2), Status::Error);
    assert_eq!(host.get_derivatives(ptr::null_mut(), 1), Status::Error);
    assert_eq!(host.get_event_indicators([0.0; 2].as_mut_ptr(), 2), Status::Error);
    assert_eq!(host.get_event_indicators(ptr::null_mut(), 1), Status::Error);
    // A model without kinks has one that never changes.
    assert_eq!(host.get_event_indicators(&mut value, 1), Status::Ok);
    assert_eq!(value, 1.0);
    assert_eq!(host.set_time(f64::INFINITY), Status::Error);
    host.messages();
    assert_eq!(host.set_continuous_states(&1e200, 1), Status::Ok);
    assert_eq!(host.get_derivatives(&mut value, 1), Status::Discard);
    assert!(host.message().format.contains("shorter step"));
}

#[test]
fn event_indicators_change_their_signs_at_the_kinks() {
    let host = Host::<Stopped>::initialized(ME);
    let count = Interface::of::<Stopped>(None, None).unwrap().event_indicators;
    assert_eq!(count, 3);
    assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
    let signs = |position: f64, force: f64| {
        let mut values = [f64::NAN; 3];
        assert_eq!(host.set_continuous_states(&position, 1), Status::Ok);
        assert_eq!(host.set("force", force), Status::Ok);
        assert_eq!(host.get_event_indicators(values.as_mut_ptr(), 3), Status::Ok);
        values.map(|value| value > 0.0)
    };
    // The force is held within 2 N, from below and from above; the stop begins at 0.5 m, and beyond.
    for (position, force, expected) in [
        (0.4, 1.0, [true, true, false]),
        (0.4, 2.0, [true, false, false]),
        (0.4, -2.5, [false, true, false]),
        (0.5, 0.0, [true, true, false]),
        (0.5 + 1e-12, 0.0, [true, true, true]),
    ] {
        assert_eq!(signs(position, force), expected, "{position} m, {force} N");
    }
    // Without a stop its condition is constant, and so does not stop an integrator.
    assert_eq!(host.enter_event_mode(), Status::Ok);
    assert_eq!(host.set("stiffness", 0.0), Status::Ok);
    assert_eq!(host.enter_continuous_time_mode(), Status::Ok);
    for position in [0.4, 0.6] {
        assert!(signs(position, 0.0)[2]);
    }
}
