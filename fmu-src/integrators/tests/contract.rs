//! What an integrator promises to its caller, whatever the method.

use crate::common::*;
use strut_integrators::{Integrator, Method, Settings, SolverStats};

/// Evaluations that a step costs.
fn rates_per_step(method: Method) -> u64 {
    match method {
        Method::Explicit => 6,
        Method::Rosenbrock => 8,
    }
}

#[test]
fn the_last_evaluation_is_at_the_end() {
    for method in Method::ALL {
        // Loose and tight: with one step per call, with several, and with rejected ones.
        for (tolerance, calls) in [(1e-4, 1000), (1e-10, 20), (1e-6, 1)] {
            let mut system = Watched::new(Friction);
            let mut integrator = integrator(method, tolerance, 1.0);
            let mut x = [0.0; 2];
            for i in 0..calls {
                let time = |i: u32| f64::from(i) / f64::from(calls);
                integrator.advance(&mut system, time(i), time(i + 1), &mut x).expect("harmless");
                assert_eq!(system.last, Some((time(i + 1), x)));
            }
            let work = integrator.work();
            assert_eq!((work.rates, work.jacobians), (system.rates, system.jacobians));
            assert!(calls == 1000 || work.rejected > 0);
        }
    }
}

#[test]
fn a_call_of_no_length_evaluates_once() {
    for method in Method::ALL {
        let mut system = Watched::new(Friction);
        let mut integrator = integrator(method, 1e-6, 1.0);
        let mut x = [0.1, 0.2];
        integrator.advance(&mut system, 3.0, 3.0, &mut x).expect("nothing to do");
        assert_eq!((x, system.last, system.rates), ([0.1, 0.2], Some((3.0, x)), 1));
    }
}

#[test]
fn the_last_derivative_opens_the_next_call() {
    for method in Method::ALL {
        let mut system = Watched::new(Friction);
        let mut integrator = integrator(method, 1e-4, 1.0);
        let mut x = [0.0, 0.0];
        run(&mut integrator, &mut system, 0.1, 100, &mut x);
        let mut cost = |integrator: &mut Integrator<[f64; 2]>, t0: f64| {
            let before = system.rates;
            integrator.advance(&mut system, t0, t0 + 1e-3, &mut x).expect("harmless");
            system.rates - before
        };
        let step = rates_per_step(method);
        assert_eq!(cost(&mut integrator, 0.1), step);
        // A caller who adds up in another way.
        assert_eq!(cost(&mut integrator, (0.1 + 1e-3) * (1.0 + f64::EPSILON)), step);
        integrator.invalidate();
        assert_eq!(cost(&mut integrator, 0.102), step + 1);
        // A caller who jumps in time.
        assert_eq!(cost(&mut integrator, 0.2), step + 1);
        integrator.reset();
        assert_eq!(integrator.work(), SolverStats::default());
        assert!(cost(&mut integrator, 0.201) >= step + 2);
    }
}

/// A short call must not shorten the steps of later ones, nor a call just over a step end in a
/// sliver.
#[test]
fn the_end_of_a_call_leaves_the_step_size_alone() {
    for method in Method::ALL {
        let mut settings = Settings::new(1e-3, &[1.0]);
        settings.max_step = 1e-3;
        let mut integrator = Integrator::new(method, settings).expect("usable settings");
        let mut system = Linear([[-1.0]]);
        let mut t = 0.0;
        let mut x = [1.0];
        let mut steps = |length: f64| {
            let before = integrator.work().accepted;
            integrator.advance(&mut system, t, t + length, &mut x).expect("harmless");
            t += length;
            integrator.work().accepted - before
        };
        steps(0.1);
        assert_eq!(steps(1e-9), 1);
        assert_eq!(steps(1e-3), 1);
        assert_eq!(steps(1.005e-3), 1);
        assert_eq!(steps(1.1e-3), 2);
        assert_eq!(steps(1e-12), 1);
        assert_eq!(steps(10e-3), 10);
    }
}

#[test]
fn idle_states_do_not_loosen_the_tolerance() {
    for method in Method::ALL {
        let omega = std::f64::consts::TAU;
        let mut padded = [[0.0; 8]; 8];
        (padded[3][6], padded[6][3]) = (1.0, -omega * omega);
        let mut alone = integrator(method, 1e-6, 1.0);
        let mut among = integrator(method, 1e-6, 1.0);
        let mut x = [1.0, 0.0];
        let mut y = [0.0; 8];
        y[3] = 1.0;
        run(&mut alone, &mut oscillator(), 10.0, 7, &mut x);
        run(&mut among, &mut Linear(padded), 10.0, 7, &mut y);
        assert!(difference(&x, &[y[3], y[6]], 1.0) < 1e-9);
        assert_eq!(alone.work(), among.work());
    }
}

/// A jump in the middle of a long call, after short ones that gave the controller no reason to look.
#[test]
fn a_jump_after_idle_calls_is_caught() {
    for method in Method::ALL {
        for place in 1..20 {
            let jump = 1.0 + 5e-4 * f64::from(place);
            let mut system = Scalar(|t: f64, _| if t < jump { 0.0 } else { 1.0 });
            let mut integrator = integrator(method, 1e-6, 1.0);
            let mut x = [0.0];
            run(&mut integrator, &mut system, 1.0, 1000, &mut x);
            integrator.advance(&mut system, 1.0, 1.01, &mut x).expect("a jump is no obstacle");
            assert!((x[0] - (1.01 - jump)).abs() < 1e-6, "{method:?} {place}: {x:?}");
        }
    }
}

/// How much work typical tasks are. To be changed knowingly.
#[test]
fn work_is_as_expected() {
    let short_calls = |method| {
        let mut integrator = integrator(method, 1e-6, 1.0);
        run(&mut integrator, &mut oscillator(), 1.0, 1000, &mut [1.0, 0.0]);
        integrator.work()
    };
    let one_call = |method| {
        let mut integrator = integrator(method, 1e-6, 1.0);
        run(&mut integrator, &mut VanDerPol(1.0), 20.0, 1, &mut [2.0, 0.0]);
        integrator.work()
    };
    // One step more than calls: the very first is cautious. Two rates more: it needs them.
    let explicit = SolverStats { rates: 6 * 1001 + 2, accepted: 1001, ..SolverStats::default() };
    assert_eq!(short_calls(Method::Explicit), explicit);
    let rosenbrock = SolverStats {
        rates: 8 * 1001 + 2,
        accepted: 1001,
        jacobians: 1001,
        inversions: 1001,
        ..SolverStats::default()
    };
    assert_eq!(short_calls(Method::Rosenbrock), rosenbrock);
    let explicit = SolverStats { rates: 2018, accepted: 310, rejected: 26, ..SolverStats::default() };
    assert_eq!(one_call(Method::Explicit), explicit);
    let rosenbrock =
        SolverStats { rates: 2738, jacobians: 284, accepted: 284, rejected: 58, inversions: 342 };
    assert_eq!(one_call(Method::Rosenbrock), rosenbrock);
}
