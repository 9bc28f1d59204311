//! What is refused, what fails, and that neither leaves traces.

use crate::common::*;
use strut_integrators::{IntegrationError, Integrator, InvalidSettings, Method, Settings, SolverStats};

/// After an error the state is as it was, and the integrator as good as before.
fn check_failure(
    method: Method,
    start: [f64; 1],
    rates: impl FnMut(f64, f64) -> f64,
    expected: fn(IntegrationError) -> bool,
) {
    let mut integrator = integrator(method, 1e-6, 1.0);
    integrator.advance(&mut Scalar(|_, _| 0.0), 0.0, 0.5, &mut [1.0]).expect("harmless");
    let step = integrator.save().nth(1);
    integrator.invalidate();
    let mut x = start;
    let error = integrator.advance(&mut Scalar(rates), 0.5, 2.5, &mut x).expect_err("must fail");
    assert!(expected(error), "{method:?}: {error:?}");
    assert_eq!(x[0].to_bits(), start[0].to_bits());
    assert_eq!(integrator.save().nth(1), step);
    let mut x = [1.0];
    integrator.advance(&mut Scalar(|_, x: f64| -x), 0.5, 1.5, &mut x).expect("recovers");
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
            |error| matches!(error, NotFinite { t: 0.5, component: 0 }),
        );
        check_failure(
            method,
            [1.0],
            |t, _| (1.5 - t).sqrt(),
            |error| matches!(error, NotFinite { t, component: 0 } if (t - 1.5).abs() < 1e-6),
        );
        check_failure(method, [f64::INFINITY], |_, _| 1.0, |error| matches!(error, NotFinite { t: 0.5, .. }));
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
    integrator.advance(&mut Linear([[0.0]]), -1.0, 0.0, &mut [1.0]).expect("harmless");
    integrator.invalidate();
    let mut x = [1.0];
    integrator.advance(&mut system, 0.0, h, &mut x).expect("with a shorter step");
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
    assert_eq!(error, Err(IntegrationError::NotFinite { t: 0.0, component: 0 }));
}

#[test]
fn the_number_of_steps_is_limited() {
    for method in Method::ALL {
        let settings = Settings { max_steps: 5, ..Settings::new(1e-8, &[1.0; 2]) };
        let mut integrator = Integrator::new(method, settings).expect("usable settings");
        let mut x = [1.0, 0.0];
        let error = integrator.advance(&mut oscillator(), 0.0, 10.0, &mut x);
        assert!(matches!(error, Err(IntegrationError::TooManySteps { limit: 5, .. })));
        assert_eq!(x, [1.0, 0.0]);
    }
}

#[test]
fn meaningless_times_are_refused() {
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    for method in Method::ALL {
        let mut integrator = integrator(method, 1e-6, 1.0);
        for (t0, t1) in [(1.0, 0.0), (nan, 1.0), (0.0, nan), (0.0, infinite), (-infinite, 0.0)] {
            let error = integrator.advance(&mut Linear([[1.0]]), t0, t1, &mut [1.0]);
            assert!(matches!(error, Err(IntegrationError::InvalidInterval { .. })));
        }
        assert_eq!(integrator.work(), SolverStats::default());
    }
}

#[test]
fn meaningless_settings_are_refused() {
    let good = Settings::new(1e-6, &[1.0, 2.0]);
    let refused = |settings| Integrator::new(Method::Explicit, settings).expect_err("unusable");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            refused(Settings { relative_tolerance: bad, ..good }),
            InvalidSettings::RelativeTolerance(_)
        ));
        assert!(matches!(
            refused(Settings { absolute_tolerance: [1.0, bad], ..good }),
            InvalidSettings::AbsoluteTolerance { component: 1, .. }
        ));
        if bad != f64::INFINITY {
            assert!(matches!(refused(Settings { max_step: bad, ..good }), InvalidSettings::MaxStep(_)));
        }
    }
    assert_eq!(refused(Settings { max_steps: 0, ..good }), InvalidSettings::MaxSteps);
    let mut integrator = Integrator::new(Method::Explicit, good).expect("usable settings");
    integrator.set_settings(Settings { max_steps: 0, ..good }).expect_err("unusable");
    assert_eq!(integrator.settings(), &good);
    integrator.set_settings(Settings { max_steps: 7, ..good }).expect("usable settings");
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
    for (index, word) in [(0, 2), (1, f64::NAN.to_bits()), (1, (-1.0_f64).to_bits()), (2, 0)] {
        let mut words = words.clone();
        words[index] = word;
        assert!(target.load(&mut words.into_iter()).is_none());
    }
    assert_eq!(target, fresh);
    // What follows in a longer snapshot is left for the next reader.
    let mut reader = words.iter().copied().chain([42]);
    assert!(target.load(&mut reader).is_some());
    assert_eq!((target.save().collect::<Vec<_>>(), reader.next()), (words, Some(42)));
}
