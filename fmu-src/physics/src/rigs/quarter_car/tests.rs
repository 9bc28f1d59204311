use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Error, Lanes, Simulation};

use super::*;
use crate::GRAVITY;

mod effects;

fn parameters(
    sprung_mass: f64,
    unsprung_mass: f64,
    stiffness: f64,
    damping: f64,
    tire: f64,
) -> Parameters<f64> {
    let declared = strut_model::Declarations::of::<Parameters<f64>>();
    let start: Parameters<f64> = Bundle::from_fn(|i| declared[i].start);
    Parameters {
        sprung_mass,
        unsprung_mass,
        strut: Strut { stiffness, damping, ..start.strut },
        tire: Tire { stiffness: tire, ..start.tire },
        ..start
    }
}

/// Table 10, with 707 N s/m and the asymmetry of Table 9.
fn table_10() -> Parameters<f64> {
    let mut p = parameters(94.38, 23.92, 8400.0, 707.0, 152_140.0);
    p.strut.asymmetry.ratio = (994.0 - 521.0) / (994.0 + 521.0);
    p.strut.coulomb.force = 115.0;
    p.guide.coulomb.force = 20.0;
    p.tire.quadratic = 4_075_400.0;
    p
}

const CAR: QuarterCar = QuarterCar { lift_off: true };

fn evaluate<R: Real>(car: QuarterCar, p: &Parameters<R>, x: [R; 4], u: [R; 3]) -> (State<R>, Output<R>) {
    car.equations(Instant {
        time: R::from(0.0),
        // What the strut remembers is at rest.
        state: &Bundle::from_fn(|i| x.get(i).copied().unwrap_or(R::from(0.0))),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &car.derive(p),
        memory: &strut_model::NoVariables,
        tick: 0,
    })
}

#[test]
fn frequencies_and_damping_ratios_are_those_of_tables_9_and_10() {
    let [optimised, status_2010] =
        [parameters(91.23, 22.25, 6952.0, 1152.0, 178_000.0), table_10()].map(|p| CAR.derive(&p));
    for (found, printed, digits) in [
        (optimised.body.natural_frequency, 1.39, 0.005),
        (optimised.body.damping_ratio, 0.723, 5e-4),
        (optimised.wheel.natural_frequency, 14.24, 0.006),
        (optimised.wheel.damping_ratio, 0.284, 5e-4),
        (status_2010.body.natural_frequency, 1.5, 0.05),
        (status_2010.body.damping_ratio, 0.397, 5e-4),
        (status_2010.wheel.natural_frequency, 12.7, 0.05),
        (status_2010.wheel.damping_ratio, 0.18, 0.005),
    ] {
        assert!((found - printed).abs() < digits, "{found} {printed}");
    }
}

#[test]
fn static_equilibrium_is_rest() {
    let (rates, output) = evaluate(CAR, &table_10(), [0.0; 4], [0.0; 3]);
    rates.for_each(|_, rate| assert_eq!(rate, 0.0));
    output.for_each(|_, value| assert_eq!(value, 0.0));
}

#[test]
fn a_wheel_in_the_air_falls_with_what_the_strut_leaves_of_gravity() {
    // Both masses 50 mm up, nothing between them: the strut still carries its static load.
    let (_, output) = evaluate(CAR, &table_10(), [0.05, 0.0, 0.05, 0.0], [0.0; 3]);
    assert_eq!(output.body.acceleration, 0.0);
    assert!((output.wheel.acceleration + (94.38 + 23.92) * GRAVITY / 23.92).abs() < 1e-9);
}

#[test]
fn a_parabola_that_never_reaches_zero_load_is_refused() {
    let mut p = table_10();
    p.tire.quadratic = 6e6;
    let error = CAR.check(&p, &CAR.derive(&p)).unwrap_err();
    assert!(error.contains("tire.quadratic = 6000000 N/m2") && error.contains("tire.lift_off"), "{error}");
    assert_eq!(QuarterCar { lift_off: false }.check(&p, &CAR.derive(&p)), Ok(()));
}

/// Kinetic energy and that of both springs.
fn energy(p: &Parameters<f64>, x: &[f64]) -> f64 {
    let c = -x[2];
    0.5 * (p.sprung_mass * x[1] * x[1]
        + p.unsprung_mass * x[3] * x[3]
        + p.strut.stiffness * (x[0] - x[2]).powi(2))
        + 0.5 * p.tire.stiffness * c * c
        + p.tire.quadratic * c * c * c / 3.0
}

proptest! {
    #[test]
    fn forces_between_the_masses_cancel(
        x in prop::array::uniform4(-0.05..0.05_f64),
        u in prop::array::uniform3(-0.02..0.02_f64),
    ) {
        let mut p = table_10();
        p.guide.coulomb.force = 0.0;
        let (_, output) = evaluate(CAR, &p, x, [u[0], u[1], 1e4 * u[2]]);
        let momentum = p.sprung_mass * output.body.acceleration + p.unsprung_mass * output.wheel.acceleration;
        prop_assert!((momentum - output.wheel.force).abs() < 1e-8);
    }

    #[test]
    fn no_effect_brings_energy_in(x in prop::array::uniform4(-0.01..0.01_f64)) {
        let p = table_10();
        let car = QuarterCar { lift_off: false };
        let (rates, _) = evaluate(car, &p, x, [0.0; 3]);
        let h = 1e-6;
        let rate = [rates.body.position, rates.body.velocity, rates.wheel.position, rates.wheel.velocity];
        let moved = |h: f64| -> [f64; 4] { std::array::from_fn(|i| x[i] + h * rate[i]) };
        let power = (energy(&p, &moved(h)) - energy(&p, &moved(-h))) / (2.0 * h);
        prop_assert!(power <= 1e-6, "{power}");
    }

    #[test]
    fn the_neutral_car_is_the_matrix_of_quanser_equation_2_11(
        x in prop::array::uniform4(-0.05..0.05_f64),
        u in prop::array::uniform3(-0.02..0.02_f64),
    ) {
        let (ms, mus, ks, bs, kus, bus) = (2.45, 1.0, 900.0, 7.5, 2500.0, 5.0);
        let mut p = parameters(ms, mus, ks, bs, kus);
        p.tire.damping = bus;
        let [zs, vs, zus, vus] = x;
        let [zr, vr, fc] = u;
        let y = [zs - zus, vs, zus - zr, vus];
        let (rates, _) = evaluate(QuarterCar { lift_off: false }, &p, x, u);
        let body = (-ks * y[0] - bs * y[1] + bs * y[3] + fc) / ms;
        let wheel = (ks * y[0] + bs * y[1] - kus * y[2] - (bs + bus) * y[3] + bus * vr - fc) / mus;
        prop_assert!((rates.body.velocity - body).abs() < 1e-9 && (rates.wheel.velocity - wheel).abs() < 1e-9);
    }
}

#[test]
fn an_undamped_car_keeps_its_energy() {
    let mut simulation = Simulation::<QuarterCar>::new(None, None).unwrap();
    let interface = strut_model::Interface::of::<QuarterCar>(None, None).unwrap();
    for (name, value) in
        [("strut.damping", 0.0), ("tire.damping", 0.0), ("body.position", 0.03), ("solver.tolerance", 1e-11)]
    {
        let reference = interface.variable(name).unwrap().reference;
        simulation.set_real(&[reference], &[value], strut_model::Access::All).unwrap();
    }
    simulation.set_up(0.0, None).unwrap();
    simulation.initialize().unwrap();
    let p = parameters(350.0, 40.0, 22e3, 0.0, 200e3);
    let before = energy(&p, simulation.states());
    for step in 0..500 {
        simulation.step(f64::from(step) * 0.01, 0.01).unwrap();
    }
    let after = energy(&p, simulation.states());
    assert!((after / before - 1.0).abs() < 1e-8, "{before} {after}");
}

#[test]
fn a_mass_of_nothing_is_refused() {
    let mut simulation = Simulation::<QuarterCar>::new(None, None).unwrap();
    let interface = strut_model::Interface::of::<QuarterCar>(None, None).unwrap();
    let reference = interface.variable("sprung_mass").unwrap().reference;
    let error = simulation.set_real(&[reference], &[0.0], strut_model::Access::All).unwrap_err();
    assert!(matches!(error, Error::OutOfBounds { .. }), "{error}");
}

/// The numbers of a bundle.
fn list<R: Copy, B: Bundle<R>>(bundle: &B) -> Vec<R> {
    let mut list = Vec::new();
    bundle.for_each(|_, number| list.push(number));
    list
}

proptest! {
    /// Four parameter sets at once, and the derivative by a parameter, from the equations that `f64` runs.
    #[test]
    fn the_equations_say_the_same_in_every_scalar(
        x in prop::array::uniform4(-0.03..0.03_f64),
        u in prop::array::uniform3(-0.01..0.01_f64),
        factors in prop::array::uniform4(0.9..1.1_f64),
    ) {
        let nominal = list(&table_10());
        let scaled = |factor: f64| -> Parameters<f64> { Bundle::from_fn(|i| nominal[i] * factor) };
        let expected = factors.map(|factor| evaluate(CAR, &scaled(factor), x, u));

        let lanes: Parameters<Lanes> = Bundle::from_fn(|i| Lanes::new(factors.map(|factor| nominal[i] * factor)));
        let (rates, output) = evaluate(CAR, &lanes, x.map(Lanes::from), u.map(Lanes::from));
        let together: Vec<Lanes> = list(&rates).into_iter().chain(list(&output)).collect();
        for (lane, (rates, output)) in expected.iter().enumerate() {
            let alone: Vec<f64> = list(rates).into_iter().chain(list(output)).collect();
            for (a, b) in together.iter().map(|number| number.to_array()[lane]).zip(alone) {
                prop_assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} {b}");
            }
        }

        // Along the scaling of all parameters at once. Not across lift-off, where there is no derivative.
        let (h, factor) = (1e-6, factors[0]);
        let dual: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::new(nominal[i] * factor, nominal[i]));
        let (rates, output) = evaluate(CAR, &dual, x.map(Dual64::from), u.map(Dual64::from));
        let differences = [factor - h, factor + h].map(|factor| {
            let (rates, output) = evaluate(CAR, &scaled(factor), x, u);
            list(&rates).into_iter().chain(list(&output)).collect::<Vec<f64>>()
        });
        prop_assume!((x[2] - u[0] - CAR.derive(&scaled(factor)).tire.lift_off_deflection).abs() > 1e-4);
        prop_assume!((output.wheel.force.re + CAR.derive(&scaled(factor)).tire.static_load).abs() > 1.0);
        for (i, exact) in list(&rates).into_iter().chain(list(&output)).enumerate() {
            let slope = (differences[1][i] - differences[0][i]) / (2.0 * h);
            prop_assert!((exact.eps - slope).abs() < 1e-4 * (1.0 + slope.abs()), "{i}: {exact} {slope}");
        }
    }
}
