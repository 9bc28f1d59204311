//! What an integrator promises to its caller, whatever the method.

mod common;

use common::*;
use strut_integrators::{
    Array, IntegrationError, Integrator, InvalidSettings, Method, Settings, System, Work,
};

/// Evaluations that a step costs.
fn rates_per_step(method: Method) -> u64 {
    match method {
        Method::Explicit => 6,
        Method::Rosenbrock => 8,
    }
}

/// A system given by its rates; the derivative by state is numerical, that by time left out.
struct Scalar<F>(F);

impl<F: FnMut(f64, f64) -> f64> System<[f64; 1]> for Scalar<F> {
    fn rates(&mut self, t: f64, x: &[f64; 1]) -> [f64; 1] {
        [(self.0)(t, x[0])]
    }
    fn jacobian(&mut self, t: f64, x: &[f64; 1]) -> (<[f64; 1] as Array>::Square, [f64; 1]) {
        let d = 1e-6 * x[0].abs().max(1.0);
        jacobian(
            [[((self.0)(t, x[0] + d) - (self.0)(t, x[0] - d)) / (2.0 * d)]],
            [0.0],
        )
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
                integrator
                    .advance(&mut system, time(i), time(i + 1), &mut x)
                    .expect("harmless");
                assert_eq!(system.last, Some((time(i + 1), x)));
            }
            let work = integrator.work();
            assert_eq!(
                (work.rates, work.jacobians),
                (system.rates, system.jacobians)
            );
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
        integrator
            .advance(&mut system, 3.0, 3.0, &mut x)
            .expect("nothing to do");
        assert_eq!(
            (x, system.last, system.rates),
            ([0.1, 0.2], Some((3.0, x)), 1)
        );
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
            integrator
                .advance(&mut system, t0, t0 + 1e-3, &mut x)
                .expect("harmless");
            system.rates - before
        };
        let step = rates_per_step(method);
        assert_eq!(cost(&mut integrator, 0.1), step);
        // A caller who adds up in another way.
        assert_eq!(
            cost(&mut integrator, (0.1 + 1e-3) * (1.0 + f64::EPSILON)),
            step
        );
        integrator.invalidate();
        assert_eq!(cost(&mut integrator, 0.102), step + 1);
        // A caller who jumps in time.
        assert_eq!(cost(&mut integrator, 0.2), step + 1);
        integrator.reset();
        assert_eq!(integrator.work(), Work::default());
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
            integrator
                .advance(&mut system, t, t + length, &mut x)
                .expect("harmless");
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
            integrator
                .advance(&mut system, 1.0, 1.01, &mut x)
                .expect("a jump is no obstacle");
            assert!(
                (x[0] - (1.01 - jump)).abs() < 1e-6,
                "{method:?} {place}: {x:?}"
            );
        }
    }
}

/// After an error the state is as it was, and the integrator as good as before.
fn check_failure(
    method: Method,
    start: [f64; 1],
    rates: impl FnMut(f64, f64) -> f64,
    expected: fn(IntegrationError) -> bool,
) {
    let mut integrator = integrator(method, 1e-6, 1.0);
    integrator
        .advance(&mut Scalar(|_, _| 0.0), 0.0, 0.5, &mut [1.0])
        .expect("harmless");
    let step = integrator.save().nth(1);
    integrator.invalidate();
    let mut x = start;
    let error = integrator
        .advance(&mut Scalar(rates), 0.5, 2.5, &mut x)
        .expect_err("must fail");
    assert!(expected(error), "{method:?}: {error:?}");
    assert_eq!(x[0].to_bits(), start[0].to_bits());
    assert_eq!(integrator.save().nth(1), step);
    let mut x = [1.0];
    integrator
        .advance(&mut Scalar(|_, x: f64| -x), 0.5, 1.5, &mut x)
        .expect("recovers");
    assert!((x[0] - (-1.0_f64).exp()).abs() < 1e-5);
}

#[test]
fn failures_name_the_cause_and_leave_the_state() {
    use IntegrationError::{NotFinite, StepUnderflow};
    for method in Method::ALL {
        // At once, or on the way: the root ends at t = 1.5.
        check_failure(
            method,
            [1.0],
            |_, _| f64::NAN,
            |error| {
                matches!(
                    error,
                    NotFinite {
                        t: 0.5,
                        component: 0
                    }
                )
            },
        );
        check_failure(
            method,
            [1.0],
            |t, _| (1.5 - t).sqrt(),
            |error| matches!(error, NotFinite { t, component: 0 } if (t - 1.5).abs() < 1e-6),
        );
        check_failure(
            method,
            [f64::INFINITY],
            |_, _| 1.0,
            |error| matches!(error, NotFinite { t: 0.5, .. }),
        );
        // 1 / (1.5 - t).
        check_failure(
            method,
            [1.0],
            |_, x| x * x,
            |error| matches!(error, NotFinite { t, .. } | StepUnderflow { t, .. } if (t - 1.5).abs() < 1e-3),
        );
    }
}

/// A step for which 1 / (gamma h) is an eigenvalue has no solution; another one has.
#[test]
fn a_singular_matrix_is_only_a_rejected_step() {
    let gamma = 0.211_937_563_194_290_14;
    let h = 1e-3;
    let mut system = Linear([[1.0 / (gamma * h)]]);
    let mut integrator = integrator(Method::Rosenbrock, 1e-3, 1.0);
    integrator
        .advance(&mut Linear([[0.0]]), -1.0, 0.0, &mut [1.0])
        .expect("harmless");
    integrator.invalidate();
    let mut x = [1.0];
    integrator
        .advance(&mut system, 0.0, h, &mut x)
        .expect("with a shorter step");
    assert!(integrator.work().rejected > 0);
    assert!((x[0] / (1.0 / gamma).exp() - 1.0).abs() < 1e-2, "{x:?}");
}

#[test]
fn a_jacobian_that_is_not_finite_is_reported() {
    let mut integrator = integrator(Method::Rosenbrock, 1e-6, 1.0);
    let mut system = Scalar(|_, x: f64| if x == 1.0 { 0.0 } else { f64::NAN });
    let error = integrator.advance(&mut system, 0.0, 0.0, &mut [1.0]);
    assert_eq!(error, Ok(()));
    let error = integrator.advance(&mut system, 0.0, 1.0, &mut [1.0]);
    assert_eq!(
        error,
        Err(IntegrationError::NotFinite {
            t: 0.0,
            component: 0
        })
    );
}

#[test]
fn the_number_of_steps_is_limited() {
    for method in Method::ALL {
        let settings = Settings {
            max_steps: 5,
            ..Settings::new(1e-8, &[1.0; 2])
        };
        let mut integrator = Integrator::new(method, settings).expect("usable settings");
        let mut x = [1.0, 0.0];
        let error = integrator.advance(&mut oscillator(), 0.0, 10.0, &mut x);
        assert!(matches!(
            error,
            Err(IntegrationError::TooManySteps { limit: 5, .. })
        ));
        assert_eq!(x, [1.0, 0.0]);
    }
}

#[test]
fn meaningless_times_are_refused() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    for method in Method::ALL {
        let mut integrator = integrator(method, 1e-6, 1.0);
        for (t0, t1) in [
            (1.0, 0.0),
            (nan, 1.0),
            (0.0, nan),
            (0.0, infinite),
            (-infinite, 0.0),
        ] {
            let error = integrator.advance(&mut Linear([[1.0]]), t0, t1, &mut [1.0]);
            assert!(matches!(
                error,
                Err(IntegrationError::InvalidInterval { .. })
            ));
        }
        assert_eq!(integrator.work(), Work::default());
    }
}

#[test]
fn meaningless_settings_are_refused() {
    let good = Settings::new(1e-6, &[1.0, 2.0]);
    let refused = |settings| Integrator::new(Method::Explicit, settings).expect_err("unusable");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            refused(Settings {
                relative_tolerance: bad,
                ..good
            }),
            InvalidSettings::RelativeTolerance(_)
        ));
        assert!(matches!(
            refused(Settings {
                absolute_tolerance: [1.0, bad],
                ..good
            }),
            InvalidSettings::AbsoluteTolerance { component: 1, .. }
        ));
        if bad != f64::INFINITY {
            assert!(matches!(
                refused(Settings {
                    max_step: bad,
                    ..good
                }),
                InvalidSettings::MaxStep(_)
            ));
        }
    }
    assert_eq!(
        refused(Settings {
            max_steps: 0,
            ..good
        }),
        InvalidSettings::MaxSteps
    );
    let mut integrator = Integrator::new(Method::Explicit, good).expect("usable settings");
    integrator
        .set_settings(Settings {
            max_steps: 0,
            ..good
        })
        .expect_err("unusable");
    assert_eq!(integrator.settings(), &good);
    integrator
        .set_settings(Settings {
            max_steps: 7,
            ..good
        })
        .expect("usable settings");
    assert_eq!(integrator.settings().max_steps, 7);
}

#[test]
fn meaningless_words_are_refused() {
    let mut source = integrator::<2>(Method::Explicit, 1e-6, 1.0);
    run(&mut source, &mut oscillator(), 1.0, 10, &mut [1.0, 0.0]);
    let words: Vec<u64> = source.save().collect();
    assert_eq!(words.len(), 6);
    let mut target = integrator::<2>(Method::Explicit, 1e-6, 1.0);
    let fresh = target.clone();
    assert!(target.load(&mut words[..5].iter().copied()).is_none());
    for (index, word) in [
        (0, 2),
        (1, f64::NAN.to_bits()),
        (1, (-1.0_f64).to_bits()),
        (2, 0),
    ] {
        let mut words = words.clone();
        words[index] = word;
        assert!(target.load(&mut words.into_iter()).is_none());
    }
    assert_eq!(target, fresh);
    // What follows in a longer snapshot is left for the next reader.
    let mut reader = words.iter().copied().chain([42]);
    assert!(target.load(&mut reader).is_some());
    assert_eq!(
        (target.save().collect::<Vec<_>>(), reader.next()),
        (words, Some(42))
    );
}

/// How much work typical tasks are. To be changed knowingly.
#[test]
fn work_is_as_expected() {
    let short_calls = |method| {
        let mut integrator = integrator(method, 1e-6, 1.0);
        run(
            &mut integrator,
            &mut oscillator(),
            1.0,
            1000,
            &mut [1.0, 0.0],
        );
        integrator.work()
    };
    let one_call = |method| {
        let mut integrator = integrator(method, 1e-6, 1.0);
        run(
            &mut integrator,
            &mut VanDerPol(1.0),
            20.0,
            1,
            &mut [2.0, 0.0],
        );
        integrator.work()
    };
    // One step more than calls: the very first is cautious. Two rates more: it needs them.
    let explicit = Work {
        rates: 6 * 1001 + 2,
        accepted: 1001,
        ..Work::default()
    };
    assert_eq!(short_calls(Method::Explicit), explicit);
    let rosenbrock = Work {
        rates: 8 * 1001 + 2,
        accepted: 1001,
        jacobians: 1001,
        inversions: 1001,
        ..Work::default()
    };
    assert_eq!(short_calls(Method::Rosenbrock), rosenbrock);
    let explicit = Work {
        rates: 2018,
        accepted: 310,
        rejected: 26,
        ..Work::default()
    };
    assert_eq!(one_call(Method::Explicit), explicit);
    let rosenbrock = Work {
        rates: 2738,
        jacobians: 284,
        accepted: 284,
        rejected: 58,
        inversions: 342,
    };
    assert_eq!(one_call(Method::Rosenbrock), rosenbrock);
}
