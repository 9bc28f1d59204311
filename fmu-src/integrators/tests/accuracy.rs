//! Every method on every kind of problem, against exact or reference solutions.

use crate::common::*;
use strut_integrators::{Integrator, Method, Settings, System};

/// End time and end state of a problem in the reference file.
fn reference<const N: usize>(name: &str) -> (f64, [f64; N]) {
    let line = include_str!("reference/reference.csv")
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix(','))
        .expect("a reference of that name");
    let mut numbers = line.split(',').map(|number| number.parse().expect("a number"));
    let end = numbers.next().expect("an end time");
    (end, std::array::from_fn(|_| numbers.next().expect("N states")))
}

/// The error after steps of a given, fixed length: the tolerance is beyond reach.
fn fixed_step_error<const N: usize>(
    method: Method,
    system: &mut impl System<[f64; N]>,
    steps: u32,
    end: f64,
    start: [f64; N],
    exact: [f64; N],
) -> f64 {
    let mut settings = Settings::new(1e6, &[1.0; N]);
    settings.max_step = end / f64::from(steps);
    let mut integrator = Integrator::new(method, settings).expect("usable settings");
    let mut x = start;
    // One unmeasured call lets the step grow to its limit.
    integrator.advance(system, 0.0, end, &mut x).expect("a harmless system");
    x = start;
    integrator.invalidate();
    let before = integrator.work().accepted;
    integrator.advance(system, 0.0, end, &mut x).expect("a harmless system");
    assert_eq!(integrator.work().accepted - before, u64::from(steps));
    difference(&x, &exact, 1.0)
}

/// The order that the error shows from `steps` to twice as many.
fn order<const N: usize>(
    method: Method,
    system: &mut impl System<[f64; N]>,
    steps: u32,
    start: [f64; N],
    exact: [f64; N],
) -> f64 {
    let mut error = |steps| fixed_step_error(method, system, steps, 2.0, start, exact);
    let order = (error(steps) / error(2 * steps)).log2();
    println!("{method:?}: {order:.2}");
    order
}

#[test]
fn order_is_five_on_an_autonomous_problem() {
    for method in Method::ALL {
        assert!(order(method, &mut Curved, 20, [1.0, 1.0, 0.0], Curved::exact(2.0)) > 4.8);
        assert!(order(method, &mut Curved, 40, [1.0, 1.0, 0.0], Curved::exact(2.0)) > 4.8);
    }
}

#[test]
fn order_is_five_where_the_rates_depend_on_time() {
    for method in Method::ALL {
        let mut system = Forced { stiffness: 2.0 };
        let exact = system.exact(2.0, 1.5);
        assert!(order(method, &mut system, 80, [1.5], exact) > 4.8);
    }
}

/// The order of many Rosenbrock methods falls to one or two here; Rodas5P keeps nearly four.
#[test]
fn order_hardly_suffers_from_stiffness() {
    let mut system = Forced { stiffness: 1e6 };
    let order = order(Method::Rosenbrock, &mut system, 10, [1.0], [2.0_f64.cos()]);
    assert!(order > 3.6, "{order}");
}

/// The stability function at infinity is zero: a transient far too fast for the step is gone after
/// one.
#[test]
fn rosenbrock_is_l_stable() {
    let mut settings = Settings::new(1e6, &[1.0]);
    settings.max_step = 1.0;
    let mut x = [1.0];
    let mut integrator = Integrator::new(Method::Rosenbrock, settings).expect("usable settings");
    integrator.advance(&mut Linear([[-1e-9]]), 0.0, 1.0, &mut x).expect("hardly moves");
    integrator.invalidate();
    integrator.advance(&mut Linear([[-1e9]]), 1.0, 2.0, &mut x).expect("one step");
    assert!(x[0].abs() < 1e-7, "{x:?}");
}

#[test]
fn an_oscillator_keeps_its_energy_to_the_tolerance() {
    for method in Method::ALL {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            for calls in [1, 100_000] {
                let mut x = [1.0, 0.0];
                run(&mut integrator(method, tolerance, 1.0), &mut oscillator(), 100.0, calls, &mut x);
                let omega = std::f64::consts::TAU;
                let energy = x[0] * x[0] + (x[1] / omega).powi(2);
                let lost = (energy - 1.0).abs();
                println!("{method:?} {tolerance} {calls}: {lost:.2e}, {x:?}");
                // A few thousand steps.
                assert!(lost < 300.0 * tolerance, "{method:?} {tolerance} {calls}: {lost}");
                assert!((x[0] - 1.0).abs() < 300.0 * tolerance && x[1].abs() < 3000.0 * tolerance);
            }
        }
    }
}

fn check_reference<const N: usize>(
    methods: &[Method],
    name: &str,
    system: &mut impl System<[f64; N]>,
    start: [f64; N],
    nominal: [f64; N],
    allowed: f64,
) {
    let (end, exact) = reference::<N>(name);
    for &method in methods {
        for tolerance in [1e-5, 1e-8, 1e-10] {
            let settings = Settings { max_steps: 1_000_000, ..Settings::new(tolerance, &nominal) };
            let mut integrator = Integrator::new(method, settings).expect("usable settings");
            let mut x = start;
            run(&mut integrator, system, end, 1, &mut x);
            let error = difference(&x, &exact, 0.0);
            println!("{name} {method:?} {tolerance}: {:.1} {:?}", error / tolerance, integrator.work());
            assert!(error < allowed * tolerance, "{name} {method:?} {tolerance}: {error}");
        }
    }
}

#[test]
fn van_der_pol_mild_and_stiff() {
    let (mild, stiff) = ("van der pol mu 1", "van der pol mu 1000");
    check_reference(&Method::ALL, mild, &mut VanDerPol(1.0), [2.0, 0.0], [1.0; 2], 200.0);
    let method = [Method::Rosenbrock];
    check_reference(&method, stiff, &mut VanDerPol(1e3), [2.0, 0.0], [1.0; 2], 2000.0);
}

#[test]
fn robertson() {
    let nominal = [1.0, 1e-5, 1.0];
    let method = [Method::Rosenbrock];
    check_reference(&method, "robertson", &mut Robertson, [1.0, 0.0, 0.0], nominal, 200.0);
}

#[test]
fn hires() {
    let mut start = [0.0; 8];
    (start[0], start[7]) = (1.0, 0.0057);
    check_reference(&Method::ALL, "hires", &mut Hires, start, [1e-3; 8], 200.0);
}

#[test]
fn dry_friction() {
    check_reference(&Method::ALL, "friction", &mut Friction, [0.0; 2], [0.1; 2], 200.0);
}

#[test]
fn a_stiff_forced_solution_is_followed() {
    for stiffness in [1.0, 1e3, 1e6] {
        let mut x = [1.0];
        let mut system = Forced { stiffness };
        run(&mut integrator(Method::Rosenbrock, 1e-8, 1.0), &mut system, 10.0, 1, &mut x);
        assert!((x[0] - 10.0_f64.cos()).abs() < 1e-6, "{stiffness}: {x:?}");
    }
}

/// Kinks and jumps whose place the integrator is not told: the error stays within some tolerances
/// for each, whether the calls or the tolerance limit the steps, and wherever in a step they fall.
#[test]
fn lift_off_and_touch_down() {
    for damping in [0.0, 4.0] {
        let bounce = |phase: u32| Bounce { omega: 40.0 + 0.37 * f64::from(phase), damping };
        for method in Method::ALL {
            for tolerance in [1e-5, 1e-7, 1e-9] {
                for calls in [1, 2000] {
                    let mut worst = 0.0_f64;
                    let mut work = 0;
                    for phase in 0..10 {
                        let mut system = bounce(phase);
                        let (exact, changes) = system.exact(2.0, 2.0);
                        assert!(changes >= 8);
                        let mut x = [0.0, 2.0];
                        let mut integrator = integrator(method, tolerance, 1.0);
                        run(&mut integrator, &mut system, 2.0, calls, &mut x);
                        worst = worst.max(difference(&x, &exact, 0.1) / f64::from(changes));
                        work += integrator.work().rates;
                    }
                    println!("{damping} {method:?} {tolerance} {calls}: {:.1} {work}", worst / tolerance);
                    assert!(worst < 100.0 * tolerance, "{damping} {method:?} {tolerance} {worst}");
                }
            }
        }
    }
}
