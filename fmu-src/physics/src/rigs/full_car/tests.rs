use num_dual::Dual64;
use proptest::prelude::*;
use std::f64::consts::TAU;
use strut_model::{Bundle, Declarations, Interface, Lanes};

use super::*;
use crate::GRAVITY;
use crate::effects::{Asymmetry, Coulomb, LiftOff};
use crate::rigs::{QuarterCar, quarter_car};

const CAR: FullCar = FullCar { lift_off: true };

/// The declared values: a linear car.
fn declared() -> Parameters<f64> {
    let declared = Declarations::of::<Parameters<f64>>();
    Bundle::from_fn(|i| declared[i].start)
}

/// A car that is alike nowhere, without effects.
fn lopsided() -> Parameters<f64> {
    let mut p = declared();
    p.roll_inertia = 520.0;
    p.unsprung_mass = UnsprungMass { front: 42.0, rear: 38.0 };
    p.geometry = Geometry { front: 1.2, rear: 1.5, left: 0.8, right: 0.7 };
    p.anti_roll_bar.front.stiffness = 8e3;
    for strut in [&mut p.strut.front_left, &mut p.strut.front_right] {
        (strut.stiffness, strut.damping) = (20e3, 1400.0);
    }
    for strut in [&mut p.strut.rear_left, &mut p.strut.rear_right] {
        (strut.stiffness, strut.damping) = (24e3, 1700.0);
    }
    for tire in [&mut p.tire.rear_left, &mut p.tire.rear_right] {
        tire.stiffness = 210e3;
    }
    p
}

/// The same with effects of each kind on.
fn nonlinear() -> Parameters<f64> {
    let mut p = lopsided();
    for strut in [&mut p.strut.front_left, &mut p.strut.front_right] {
        strut.asymmetry = Asymmetry { ratio: 0.3, smoothing: 0.005 };
        strut.coulomb = Coulomb { force: 110.0, velocity: 0.008 };
        strut.orifice.coefficient = 300.0;
    }
    for strut in [&mut p.strut.rear_left, &mut p.strut.rear_right] {
        strut.asymmetry = Asymmetry { ratio: 0.25, smoothing: 0.01 };
        strut.coulomb = Coulomb { force: 90.0, velocity: 0.01 };
        strut.knee.ratio = -0.4;
    }
    for tire in [&mut p.tire.front_left, &mut p.tire.front_right] {
        tire.coulomb = Coulomb { force: 60.0, velocity: 0.008 };
        tire.quadratic = 1.5e6;
    }
    for tire in [&mut p.tire.rear_left, &mut p.tire.rear_right] {
        tire.quadratic = 2e6;
    }
    p
}

/// Takes away what makes heat of motion.
fn without_losses(p: &mut Parameters<f64>) {
    let Corners { front_left, front_right, rear_left, rear_right } = &mut p.strut;
    for strut in [front_left, front_right, rear_left, rear_right] {
        (strut.damping, strut.coulomb.force, strut.orifice.coefficient) = (0.0, 0.0, 0.0);
    }
    let Corners { front_left, front_right, rear_left, rear_right } = &mut p.tire;
    for tire in [front_left, front_right, rear_left, rear_right] {
        (tire.damping, tire.coulomb.force) = (0.0, 0.0);
    }
}

fn evaluate<R: Real>(car: FullCar, p: &Parameters<R>, x: [R; 14], u: [R; 12]) -> (State<R>, Output<R>) {
    car.equations(Instant {
        time: R::from(0.0),
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &car.derive(p),
        memory: &strut_model::NoVariables,
        tick: 0,
    })
}

fn list<R: Copy, B: Bundle<R>>(bundle: &B) -> Vec<R> {
    let mut list = Vec::new();
    bundle.for_each(|_, number| list.push(number));
    list
}

/// States that make every effect speak: wheels up to 30 mm off the road, body corners some 50 mm off.
fn states() -> impl Strategy<Value = [f64; 14]> {
    let scales = [0.03, 0.5, 0.03, 0.5, 0.03, 0.5, 0.03, 1.0, 0.03, 1.0, 0.03, 1.0, 0.03, 1.0];
    prop::array::uniform14(-1.0..1.0_f64).prop_map(move |x| std::array::from_fn(|i| scales[i] * x[i]))
}

/// Road and forces.
fn inputs() -> impl Strategy<Value = [f64; 12]> {
    prop::array::uniform12(-1.0..1.0_f64)
        .prop_map(|u| std::array::from_fn(|i| u[i] * if i < 8 { [0.02, 0.3][i % 2] } else { 1e3 }))
}

#[test]
fn names_are_those_of_the_corners() {
    let interface = Interface::of::<FullCar>(None, None).unwrap();
    for name in [
        "road.front_left.position",
        "road.rear_right.velocity",
        "actuator.front_right.force",
        "heave.position",
        "roll.angle",
        "pitch.speed",
        "heave.acceleration",
        "roll.acceleration",
        "wheel.rear_left.velocity",
        "wheel.rear_left.force",
        "suspension.front_right.velocity",
        "tire.rear_right.deflection",
        "tire.rear_right.static_load",
        "strut.front_left.coulomb.force",
        "tire.rear_right.stiffness",
        "anti_roll_bar.rear.stiffness",
        "geometry.left",
        "unsprung_mass.front",
    ] {
        assert!(interface.variable(name).is_some(), "{name}");
    }
}

#[test]
fn static_equilibrium_is_rest() {
    let (rates, output) = evaluate(CAR, &nonlinear(), [0.0; 14], [0.0; 12]);
    rates.for_each(|_, rate| assert_eq!(rate, 0.0));
    output.for_each(|_, value| assert_eq!(value, 0.0));
}

#[test]
fn the_tyres_carry_the_car() {
    let p = lopsided();
    let loads = CAR.derive(&p).tire.to_array().map(|load| load.static_load);
    assert!((loads.iter().sum::<f64>() - (1400.0 + 160.0) * GRAVITY).abs() < 1e-9);
    // What the struts carry of it has no moment.
    let wheels = [42.0, 42.0, 38.0, 38.0];
    let sum = p.geometry.resultant(std::array::from_fn(|i| loads[i] - wheels[i] * GRAVITY));
    assert!(sum.roll.abs() < 1e-9 && sum.pitch.abs() < 1e-9);
}

#[test]
fn wheels_in_the_air_fall_with_what_the_struts_leave_of_gravity() {
    // Everything 100 mm up, nothing between the masses: the struts still carry their static loads.
    let mut x = [0.0; 14];
    for i in [0, 6, 8, 10, 12] {
        x[i] = 0.1;
    }
    let p = nonlinear();
    let (_, output) = evaluate(CAR, &p, x, [0.0; 12]);
    assert_eq!(output.heave.acceleration, 0.0);
    let loads = CAR.derive(&p).tire.to_array();
    for (i, wheel) in output.wheel.to_array().into_iter().enumerate() {
        let mass = [42.0, 42.0, 38.0, 38.0][i];
        assert!((wheel.acceleration + loads[i].static_load / mass).abs() < 1e-9);
    }
}

/// Undamped natural frequencies and shapes (heave, roll, pitch, wheels) of the lopsided car, from masses and a
/// stiffness matrix that was put together spring by spring, by scipy.linalg.eigh.
const MODES: [(f64, [f64; 7]); 4] = [
    (1.105336664, [1.0, -0.1011002338, -0.545757545, 0.1397139788, 0.1630473754, 0.0103873616, 0.0260640358]),
    (
        1.358047697,
        [0.8883402609, -0.2200265564, 1.0, -0.0552492885, -0.0042433101, 0.2296194922, 0.2638747595],
    ),
    (1.692596147, [0.0553783408, 1.0, 0.0198466678, 0.1243352697, -0.1091784881, 0.092483066, -0.0642416234]),
    (11.943035939, [-9.5649e-6, -0.0186454257, 8.8337e-6, 1.0, -0.9976916235, -0.0178771451, 0.0156507863]),
];

#[test]
fn constant_forces_act_on_one_corner() {
    let changes = |put: fn(&mut Parameters<f64>)| {
        let mut loaded = declared();
        put(&mut loaded);
        evaluate(CAR, &loaded, [0.0; 14], [0.0; 12]).1
    };
    let output = changes(|p| p.strut.rear_left.preload = 10.0);
    // That corner is pulled down by 10 N, 1.35 m behind the centre and 0.78 m left of it.
    assert!((output.heave.acceleration + 10.0 / 1400.0).abs() < 1e-12);
    assert!((output.pitch.acceleration + 1.35 * 10.0 / 2300.0).abs() < 1e-12);
    assert!((output.roll.acceleration + 0.78 * 10.0 / 500.0).abs() < 1e-12);
    assert_eq!(output.wheel.to_array().map(|wheel| wheel.acceleration), [0.0, 0.0, 0.25, 0.0]);
    let output = changes(|p| p.tire.front_right.preload = 10.0);
    assert_eq!(output.wheel.to_array().map(|wheel| wheel.acceleration), [0.0, 0.25, 0.0, 0.0]);
    assert_eq!(output.wheel.to_array().map(|wheel| wheel.force), [0.0, 10.0, 0.0, 0.0]);
}

#[test]
fn the_undamped_modes_are_those_of_the_stiffness_matrix() {
    let mut p = lopsided();
    without_losses(&mut p);
    for (frequency, shape) in MODES {
        // A millimetre of it: no wheel leaves the road.
        let x = std::array::from_fn(|i| if i % 2 == 0 { 1e-3 * shape[i / 2] } else { 0.0 });
        let (rates, _) = evaluate(CAR, &p, x, [0.0; 12]);
        let square = (TAU * frequency).powi(2);
        for (i, rate) in list(&rates).into_iter().enumerate() {
            let expected = if i % 2 == 0 { 0.0 } else { -square * x[i - 1] };
            assert!((rate - expected).abs() < 1e-8 * square, "{frequency} Hz, {i}: {rate} {expected}");
        }
    }
}

#[test]
fn uncoupled_modes_are_those_of_one_mass_on_its_springs() {
    let derived = CAR.derive(&lopsided());
    let frequency = |stiffness: f64, mass: f64| (stiffness / mass).sqrt() / TAU;
    // k x² or k y² by hand; the bar's deflection difference is the track times the angle.
    let roll = (20e3 + 24e3) * (0.8 * 0.8 + 0.7 * 0.7) + 8e3 * 1.5 * 1.5;
    let pitch = 2.0 * (20e3 * 1.2 * 1.2 + 24e3 * 1.5 * 1.5);
    for (mode, expected) in [
        (derived.heave, frequency(2.0 * 44e3, 1400.0)),
        (derived.roll, frequency(roll, 520.0)),
        (derived.pitch, frequency(pitch, 2300.0)),
        (derived.wheel.front_left, frequency(200e3, 42.0)),
        (derived.wheel.rear_right, frequency(210e3, 38.0)),
    ] {
        assert!((mode.natural_frequency / expected - 1.0).abs() < 1e-12);
    }
    assert!((derived.heave.damping_ratio - 6200.0 / (2.0 * (88e3_f64 * 1400.0).sqrt())).abs() < 1e-12);
    assert!((derived.dynamic_index - 2300.0 / (1400.0 * 1.2 * 1.5)).abs() < 1e-12);
}

#[test]
fn a_parabola_that_never_reaches_zero_load_is_refused() {
    let mut p = nonlinear();
    p.tire.rear_right.quadratic = 1e7;
    let error = CAR.check(&p, &CAR.derive(&p)).unwrap_err();
    assert!(error.contains("tire.rear_right.quadratic = 10000000 N/m2"), "{error}");
    assert_eq!(FullCar { lift_off: false }.check(&p, &CAR.derive(&p)), Ok(()));
}

/// Kinetic energy and that of all springs, the road being flat. A tyre in the air has only its weight's.
fn energy<R: Real>(p: &Parameters<R>, loads: [Load<R>; 4], x: &[R; 14]) -> R {
    let body =
        p.sprung_mass * x[1].squared() + p.roll_inertia * x[3].squared() + p.pitch_inertia * x[5].squared();
    let heights = p.geometry.at_corners(Modal { heave: x[0], roll: x[2], pitch: x[4] });
    let (wheel, speed) = ([x[6], x[8], x[10], x[12]], [x[7], x[9], x[11], x[13]]);
    let (struts, tires, masses) = (p.strut.each(), p.tire.each(), p.unsprung_mass.at_corners());
    let deflection: [R; 4] = std::array::from_fn(|i| heights[i] - wheel[i]);
    let mut sum = body * 0.5;
    for i in 0..4 {
        let c = -wheel[i];
        let spring =
            |c: R| tires[i].stiffness * c.squared() * 0.5 + tires[i].quadratic * c.squared() * c / 3.0;
        let LiftOff { load, compression } = loads[i].lift_off();
        let tire = (c - compression).select(spring(c), spring(compression) - load * (c - compression));
        sum += (masses[i] * speed[i].squared() + struts[i].stiffness * deflection[i].squared()) * 0.5 + tire;
    }
    let bars = p.anti_roll_bar;
    sum + (bars.front.stiffness * (deflection[0] - deflection[1]).squared()
        + bars.rear.stiffness * (deflection[2] - deflection[3]).squared())
        * 0.5
}

/// The power that a resting road and resting actuators leave: the energy's exact derivative along the motion.
fn power(p: &Parameters<f64>, x: [f64; 14]) -> f64 {
    let (rates, _) = evaluate(CAR, p, x, [0.0; 12]);
    let rates = list(&rates);
    let numbers = list(p);
    let constant: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::from(numbers[i]));
    let moving = std::array::from_fn(|i| Dual64::new(x[i], rates[i]));
    energy(&constant, CAR.derive(&constant).tire.to_array(), &moving).eps
}

proptest! {
    #[test]
    fn energy_never_rises(x in states()) {
        let power = power(&nonlinear(), x);
        prop_assert!(power <= 1e-7, "{power}");
    }

    #[test]
    fn without_damping_energy_stays(x in states()) {
        let mut p = nonlinear();
        without_losses(&mut p);
        let power = power(&p, x);
        prop_assert!(power.abs() <= 1e-7, "{power}");
    }

    #[test]
    fn without_effects_motions_and_inputs_superpose(
        xs in [states(), states()], us in [inputs(), inputs()], factor in -2.0..2.0_f64,
    ) {
        let (car, p) = (FullCar { lift_off: false }, lopsided());
        let each: Vec<Vec<f64>> = (0..2).map(|k| {
            let (rates, output) = evaluate(car, &p, xs[k], us[k]);
            [list(&rates), list(&output)].concat()
        }).collect();
        let (rates, output) = evaluate(
            car, &p,
            std::array::from_fn(|i| xs[0][i] + factor * xs[1][i]),
            std::array::from_fn(|i| us[0][i] + factor * us[1][i]),
        );
        for (i, sum) in [list(&rates), list(&output)].concat().into_iter().enumerate() {
            let expected = each[0][i] + factor * each[1][i];
            prop_assert!((sum - expected).abs() < 1e-8, "{i}: {sum} {expected}");
        }
    }

    /// Newton and Euler for the whole: only roads push, and actuators push on nothing but the car itself.
    #[test]
    fn forces_inside_the_car_cancel(x in states(), u in inputs()) {
        let p = nonlinear();
        let (_, output) = evaluate(CAR, &p, x, u);
        let (wheels, masses) = (output.wheel.to_array(), [42.0, 42.0, 38.0, 38.0]);
        let inertia: [f64; 4] = std::array::from_fn(|i| wheels[i].force - masses[i] * wheels[i].acceleration);
        let sum = p.geometry.resultant(inertia);
        for (rate, found) in [
            (p.sprung_mass * output.heave.acceleration, sum.heave),
            (p.roll_inertia * output.roll.acceleration, sum.roll),
            (p.pitch_inertia * output.pitch.acceleration, sum.pitch),
        ] {
            prop_assert!((rate - found).abs() < 1e-7, "{rate} {found}");
        }
    }

    /// With the dynamic index of one each end is a quarter car, effects and lift-off included.
    #[test]
    fn with_equal_sides_and_index_one_the_ends_are_quarter_cars(
        ends in prop::array::uniform2((prop::array::uniform4(-0.03..0.03_f64), prop::array::uniform3(-0.02..0.02_f64))),
    ) {
        let mut p = nonlinear();
        let (front, rear) = (p.geometry.front, p.geometry.rear);
        p.pitch_inertia = p.sprung_mass * front * rear;
        // Equal sides: the wheels at the same distance.
        (p.geometry.left, p.geometry.right) = (0.75, 0.75);
        let [(xf, uf), (xr, ur)] = ends;
        let modal = |f: f64, r: f64| [(rear * f + front * r) / (front + rear), (r - f) / (front + rear)];
        let ([height, angle], [velocity, speed]) = (modal(xf[0], xr[0]), modal(xf[1], xr[1]));
        let x = [
            height, velocity, 0.0, 0.0, angle, speed,
            xf[2], xf[3], xf[2], xf[3], xr[2], xr[3], xr[2], xr[3],
        ];
        let (f, r) = (1e4 * uf[2], 1e4 * ur[2]);
        let u = [uf[0], uf[1], uf[0], uf[1], ur[0], ur[1], ur[0], ur[1], f, f, r, r];
        let (_, output) = evaluate(CAR, &p, x, u);
        prop_assert!(output.roll.acceleration.abs() < 1e-9);

        let corner = p.geometry.at_corners(Modal {
            heave: output.heave.acceleration, roll: 0.0, pitch: output.pitch.acceleration,
        });
        let shares = [0.5 * p.sprung_mass * rear / 2.7, 0.5 * p.sprung_mass * front / 2.7];
        let masses = [p.unsprung_mass.front, p.unsprung_mass.rear];
        let wheels = output.wheel.to_array();
        for (end, (x, u)) in ends.into_iter().enumerate() {
            let quarter = quarter(shares[end], masses[end], p.strut.each()[2 * end], p.tire.each()[2 * end]);
            let (_, expected) = alone(&quarter, x, [u[0], u[1], 1e4 * u[2]]);
            let wheel = wheels[2 * end];
            for (found, expected) in [
                (corner[2 * end], expected.body.acceleration),
                (wheel.acceleration, expected.wheel.acceleration),
                (wheel.force, expected.wheel.force),
            ] {
                prop_assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_distributed_demand_moves_what_it_is_meant_for(demand in prop::array::uniform3(-1e3..1e3_f64)) {
        let p = lopsided();
        let [heave, roll, pitch] = demand;
        let forces = p.geometry.distribution(Modal { heave, roll, pitch });
        let u = std::array::from_fn(|i| if i < 8 { 0.0 } else { forces[i - 8] });
        let (_, output) = evaluate(CAR, &p, [0.0; 14], u);
        prop_assert!((output.heave.acceleration - heave / 1400.0).abs() < 1e-12);
        prop_assert!((output.roll.acceleration - roll / 520.0).abs() < 1e-11);
        prop_assert!((output.pitch.acceleration - pitch / 2300.0).abs() < 1e-11);
    }

    #[test]
    fn the_equations_say_the_same_in_every_scalar(x in states(), u in inputs()) {
        let p = nonlinear();
        let (rates, output) = evaluate(CAR, &p, x, u);
        let plain = [list(&rates), list(&output)].concat();
        let numbers = list(&p);
        let lanes: Parameters<Lanes> = Bundle::from_fn(|i| Lanes::from(numbers[i]));
        let (rates, output) = evaluate(CAR, &lanes, x.map(Lanes::from), u.map(Lanes::from));
        let lanes: Vec<[f64; 4]> = [list(&rates), list(&output)].concat().into_iter().map(Lanes::to_array).collect();
        let duals: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::from(numbers[i]));
        let (rates, output) = evaluate(CAR, &duals, x.map(Dual64::from), u.map(Dual64::from));
        let duals = [list(&rates), list(&output)].concat();
        for ((plain, lanes), dual) in plain.into_iter().zip(lanes).zip(duals) {
            let close = |other: f64| (other - plain).abs() <= 1e-9 * (1.0 + plain.abs());
            prop_assert!(lanes.into_iter().all(close) && close(dual.re), "{plain} {lanes:?} {dual}");
        }
    }
}

fn quarter(sprung: f64, unsprung: f64, strut: &Strut<f64>, tire: &Tire<f64>) -> quarter_car::Parameters<f64> {
    let declared = Declarations::of::<quarter_car::Parameters<f64>>();
    let start: quarter_car::Parameters<f64> = Bundle::from_fn(|i| declared[i].start);
    quarter_car::Parameters {
        sprung_mass: sprung,
        unsprung_mass: unsprung,
        strut: *strut,
        tire: *tire,
        ..start
    }
}

fn alone(
    p: &quarter_car::Parameters<f64>,
    x: [f64; 4],
    u: [f64; 3],
) -> (quarter_car::State<f64>, quarter_car::Output<f64>) {
    let car = QuarterCar::prepare(&Settings::starts(), None).unwrap();
    car.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|i| x.get(i).copied().unwrap_or(0.0)),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &car.derive(p),
        memory: &strut_model::NoVariables,
        tick: 0,
    })
}
