use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Dependencies, Error, Lanes, Simulation};

use super::*;
use crate::GRAVITY;

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
    car.equations(Now {
        time: R::from(0.0),
        // What the strut remembers is at rest.
        state: &Bundle::from_fn(|i| x.get(i).copied().unwrap_or(R::from(0.0))),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &car.derive(p),
        memory: &strut_model::Nothing,
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

/// Table 10 with every effect that there is.
fn every_effect() -> Parameters<f64> {
    let mut p = table_10();
    p.strut.stribeck.force = 40.0;
    p.strut.load_dependence.slope = 6.0;
    (p.strut.r#yield.force, p.strut.r#yield.slope) = (50.0, 20.0);
    p.strut.knee.ratio = -0.4;
    p.strut.orifice.coefficient = 300.0;
    p.strut.fade.ratio = 0.3;
    (p.strut.spring.quadratic, p.strut.spring.cubic) = (2e4, 1e6);
    (p.strut.stop.stiffness, p.strut.stop.rebound_clearance) = (2e5, 0.01);
    p.strut.preload = 12.0;
    p.strut.linkage.slope = 2.0;
    (p.strut.curve.scale, p.strut.curve.over_velocity[7]) = (1.0, 15.0);
    (p.guide.damping, p.guide.curve.scale, p.guide.curve.over_velocity[4]) = (30.0, 1.0, -5.0);
    (p.wheel_guide.damping, p.wheel_guide.coulomb.force) = (20.0, 10.0);
    (p.tire.curve.scale, p.tire.curve.over_deflection[6]) = (1.0, 25.0);
    (p.hysteresis.presliding.force, p.hysteresis.presliding.exponent) = (60.0, 1.5);
    p.hysteresis.maxwell.stiffness = 2e4;
    (p.hysteresis.mount.gap, p.hysteresis.mount.compliance) = (0.5e-3, 2e-6);
    p
}

/// The rates of 7 states at rest but for the last three, and the outputs.
fn with_memory<R: Real>(p: &Parameters<R>, x: [R; 7], u: [R; 3]) -> Vec<R> {
    let (rates, output) = CAR.equations(Now {
        time: R::from(50.0),
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &CAR.derive(p),
        memory: &strut_model::Nothing,
        tick: 0,
    });
    list(&rates).into_iter().chain(list(&output)).collect()
}

#[test]
fn every_parameter_reaches_the_motion() {
    let p: Parameters<Dependencies> = Bundle::from_fn(Dependencies::on);
    let reached = with_memory(&p, [0.0.into(); 7], [0.0.into(); 3]);
    for (i, declared) in strut_model::Declarations::of::<Parameters<f64>>().into_iter().enumerate() {
        assert!(reached.iter().any(|set| set.contains(i)), "{}", declared.name);
    }
}

#[test]
fn guides_act_on_their_own_mass_alone() {
    let x = [0.0, 0.2, 0.0, -0.3];
    let mut p = parameters(100.0, 20.0, 8400.0, 707.0, 150e3);
    let acceleration = |p: &Parameters<f64>| {
        let (_, output) = evaluate(CAR, p, x, [0.0; 3]);
        (output.body.acceleration, output.wheel.acceleration)
    };
    let neutral = acceleration(&p);
    p.guide.damping = 50.0;
    assert!((acceleration(&p).0 - (neutral.0 - 50.0 * 0.2 / 100.0)).abs() < 1e-12);
    assert!((acceleration(&p).1 - neutral.1).abs() < 1e-12);
    p.guide.damping = 0.0;
    (p.wheel_guide.damping, p.wheel_guide.coulomb.force) = (40.0, 8.0);
    assert!((acceleration(&p).0 - neutral.0).abs() < 1e-12);
    assert!((acceleration(&p).1 - (neutral.1 + (40.0 * 0.3 + 8.0) / 20.0)).abs() < 1e-9);
}

#[test]
fn a_mount_of_no_damper_is_refused() {
    let mut p = table_10();
    p.hysteresis.mount.compliance = 1e-6;
    assert_eq!(CAR.check(&p, &CAR.derive(&p)), Ok(()));
    p.strut.damping = 0.0;
    let error = CAR.check(&p, &CAR.derive(&p)).unwrap_err();
    assert!(error.contains("strut.damping = 0 N.s/m"), "{error}");
}

/// A road of 3 Hz over a rough one of 17 Hz; what the strut remembers at every millisecond of a second.
fn remembered(changes: &[(&str, f64)]) -> Vec<[f64; 3]> {
    let mut rig = crate::testing::Bench::<QuarterCar>::published("TumQuarterVehicle");
    for (name, value) in changes {
        rig = rig.start(name, *value);
    }
    let road = |t: f64| 8e-3 * (std::f64::consts::TAU * 3.0 * t).sin() + 1e-3 * (107.0 * t).sin();
    rig.initialized().follow("road.position", road, 1e-3, 1000, |rig| {
        ["presliding.friction", "maxwell.deflection", "mount.deflection"]
            .map(|name| rig.get(&format!("hysteresis.{name}")))
    })
}

#[test]
fn presliding_friction_reaches_its_limit_and_keeps_to_it() {
    // With n = 3, 1 − f/F falls as 1/√(1 + 2 s) over the way s in F/σ: some 20 mm leave an eighth.
    for (exponent, reached) in [(0.3, 59.99), (1.0, 59.9), (3.0, 50.0)] {
        let friction = remembered(&[
            ("hysteresis.presliding.force", 60.0),
            ("hysteresis.presliding.exponent", exponent),
        ]);
        let largest = friction.iter().map(|[friction, ..]| friction.abs()).fold(0.0, f64::max);
        assert!(largest > reached && largest <= 60.0 * (1.0 + 1e-6), "{exponent}: {largest}");
    }
}

#[test]
fn what_is_off_does_not_move() {
    let moved = remembered(&[("hysteresis.maxwell.stiffness", 2e4)]);
    assert!(moved.iter().all(|[friction, _, bush]| *friction == 0.0 && *bush == 0.0));
    assert!(moved.iter().any(|[_, branch, _]| branch.abs() > 1e-4));
    let moved = remembered(&[("hysteresis.mount.gap", 1e-3)]);
    assert!(moved.iter().all(|[friction, branch, _]| *friction == 0.0 && *branch == 0.0));
    // From one side of the play to the other, and into the bush.
    assert!(moved.iter().any(|[.., bush]| *bush > 1e-3) && moved.iter().any(|[.., bush]| *bush < -1e-3));
    assert!(remembered(&[]).iter().flatten().all(|state| *state == 0.0));
}

proptest! {
    #[test]
    fn every_effect_says_the_same_in_every_scalar(
        x in prop::array::uniform4(-0.03..0.03_f64),
        memory in prop::array::uniform3(-1.0..1.0_f64),
        u in prop::array::uniform3(-0.01..0.01_f64),
        seeds in prop::collection::vec(-1.0..1.0_f64, <Parameters<f64> as Bundle<f64>>::LEN),
    ) {
        let nominal = list(&every_effect());
        let x = [x[0], 10.0 * x[1], x[2], 10.0 * x[3], 60.0 * memory[0], 0.01 * memory[1], 1e-3 * memory[2]];
        let plain = with_memory(&every_effect(), x, u);
        let lanes: Parameters<Lanes> = Bundle::from_fn(|i| Lanes::from(nominal[i]));
        let lanes = with_memory(&lanes, x.map(Lanes::from), u.map(Lanes::from));
        for (number, plain) in lanes.into_iter().flat_map(Lanes::to_array).zip(plain.iter().flat_map(|a| [a; 4])) {
            prop_assert!((number - plain).abs() <= 1e-9 * (1.0 + plain.abs()), "{number} {plain}");
        }
        // The derivative along any change of all parameters, where it is the same from both sides.
        let h = 1e-6;
        let changed = |h: f64| -> Parameters<f64> { Bundle::from_fn(|i| nominal[i] * (1.0 + h * seeds[i])) };
        let [before, after] = [changed(-h), changed(h)].map(|p| with_memory(&p, x, u));
        let duals: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::new(nominal[i], nominal[i] * seeds[i]));
        let duals = with_memory(&duals, x.map(Dual64::from), u.map(Dual64::from));
        for (i, dual) in duals.into_iter().enumerate() {
            prop_assert!((dual.re - plain[i]).abs() <= 1e-9 * (1.0 + plain[i].abs()));
            let [left, right] = [(plain[i] - before[i]) / h, (after[i] - plain[i]) / h];
            let smooth = (left - right).abs() < 1e-3 * (1.0 + left.abs());
            prop_assert!(!smooth || (dual.eps - 0.5 * (left + right)).abs() < 1e-2 * (1.0 + left.abs()), "{i}: {dual} {left}");
        }
    }

    #[test]
    fn effects_that_are_varied_from_zero_have_finite_derivatives(
        x in prop::array::uniform4(-0.03..0.03_f64),
        u in prop::array::uniform3(-0.01..0.01_f64),
    ) {
        // All at once, at rest and in motion, from what they are when off.
        let nominal = list(&table_10());
        let p: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::new(nominal[i], 1.0));
        for x in [[0.0; 4], x] {
            let x: [f64; 7] = std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
            let plain = with_memory(&table_10(), x, u);
            for (number, plain) in with_memory(&p, x.map(Dual64::from), u.map(Dual64::from)).into_iter().zip(plain) {
                // States of effects that are being varied move; all else is as it was.
                prop_assert!(number.re.is_finite() && number.eps.is_finite(), "{number} {plain}");
            }
            let outputs = with_memory(&p, x.map(Dual64::from), u.map(Dual64::from));
            for (number, plain) in outputs.into_iter().zip(with_memory(&table_10(), x, u)).skip(7) {
                prop_assert!((number.re - plain).abs() < 1e-9 * (1.0 + plain.abs()));
            }
        }
    }
}
