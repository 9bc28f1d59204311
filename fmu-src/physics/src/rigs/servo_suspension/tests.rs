mod motion;

use nalgebra::SMatrix;
use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Declarations, NoVariables, Value};

use super::*;
use crate::actuators::ServoHydraulicActuator;
use crate::rigs::QuarterCar;

/// The values of the document.
const KONIECZNY: [(&str, f64); 6] = [
    ("sprung_mass", 86.0),
    ("unsprung_mass", 11.5),
    ("strut.stiffness", 8652.0),
    ("strut.damping", 1161.2),
    ("tire.stiffness", 37_412.0),
    ("tire.damping", 72.0),
];

fn parameters<R: Real>(changes: &[(&str, f64)]) -> Parameters<R> {
    let mut declared = Declarations::of::<Parameters<f64>>();
    for (name, value) in KONIECZNY.iter().chain(changes) {
        declared.iter_mut().find(|declaration| declaration.name == *name).unwrap().start = *value;
    }
    Bundle::from_fn(|i| R::from(declared[i].start))
}

/// States: z_2, z_2', z_1, q, P_r, u_1, without hysteresis of the valve; inputs: v, w, w'.
fn evaluate<R: Real>(law: ValveLaw, p: &Parameters<R>, x: [R; 6], u: [R; 3]) -> (State<R>, Output<R>) {
    let suspension = ServoSuspension { law };
    suspension.equations(Instant {
        time: R::from(0.0),
        state: &Bundle::from_fn(|i| x.get(i).copied().unwrap_or(R::from(0.0))),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &suspension.derive(p),
        memory: &NoVariables,
        tick: 0,
    })
}

fn list<R: Copy, B: Bundle<R>>(bundle: &B) -> Vec<R> {
    let mut list = Vec::new();
    bundle.for_each(|_, number| list.push(number));
    list
}

/// Rates by states and by the inputs v, w, w', at rest.
fn linearised(law: ValveLaw) -> (SMatrix<f64, 6, 6>, SMatrix<f64, 6, 3>) {
    let p = parameters::<Dual64>(&[]);
    let column = |seed: usize| -> Vec<f64> {
        let variable = |i: usize| Dual64::new(0.0, f64::from(i == seed));
        let (x, u) = (std::array::from_fn(variable), std::array::from_fn(|i| variable(6 + i)));
        list(&evaluate(law, &p, x, u).0).iter().map(|rate: &Dual64| rate.eps).collect()
    };
    let columns: Vec<Vec<f64>> = (0..9).map(column).collect();
    (SMatrix::from_fn(|i, j| columns[j][i]), SMatrix::from_fn(|i, j| columns[6 + j][i]))
}

#[test]
fn linearised_it_is_equation_2_17_in_every_entry() {
    let [m2, m1, k2, b2, k1, b1] = KONIECZNY.map(|(_, value)| value);
    let (aa, ctm, tau, ksv) = (0.765_786e-3, 15e-12, 2.32e-3, 0.025e-3);
    let alpha = 4.0 * 1.4e9 / (45.9458e-6 + 80.0398e-6);
    // A_Φ Φ of eq. 2.23.
    let phi = alpha * 15.708e-3 * 0.611 * (12e6_f64 / 880.0).sqrt();
    let s = b1 / m1 + b2 / m1 + b2 / m2;
    #[rustfmt::skip]
    let printed = SMatrix::<f64, 6, 6>::from_row_slice(&[
        0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
        -b1 * b2 / (m1 * m2), 0.0, b2 / m2 * s - k2 / m2, -b2 / m2, aa / m2, 0.0,
        b1 / m1, 0.0, -s, 1.0, 0.0, 0.0,
        k1 / m1, 0.0, -(k1 / m1 + k2 / m1 + k2 / m2), 0.0, aa / m1 + aa / m2, 0.0,
        -aa * alpha * b1 / m1, 0.0, aa * alpha * s, -aa * alpha, -ctm * alpha, phi,
        // Five entries are printed.
        0.0, 0.0, 0.0, 0.0, 0.0, -1.0 / tau,
    ]);
    #[rustfmt::skip]
    let printed_input = SMatrix::<f64, 6, 2>::from_row_slice(&[
        0.0, 0.0,
        0.0, b1 * b2 / (m1 * m2),
        0.0, -b1 / m1,
        0.0, -k1 / m1,
        0.0, aa * alpha * b1 / m1,
        ksv / tau, 0.0,
    ]);
    // The document's states from ours: x_3 = z_2 − z_1, x_4 = z_2' − q + (b_2/m_1 + b_2/m_2) x_3.
    let c = b2 / m1 + b2 / m2;
    #[rustfmt::skip]
    let to_printed = SMatrix::<f64, 6, 6>::from_row_slice(&[
        1.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
        1.0, 0.0, -1.0, 0.0, 0.0, 0.0,
        c, 1.0, -c, -1.0, 0.0, 0.0,
        0.0, 0.0, 0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ]);
    for law in [ValveLaw::Linear, ValveLaw::Nonlinear] {
        let (state, input) = linearised(law);
        let state = to_printed * state * to_printed.try_inverse().unwrap();
        let input = to_printed * input;
        for row in 0..6 {
            // A difference of large numbers is known to the rounding of these.
            let scale = printed.row(row).amax();
            for column in 0..6 {
                let (found, expected) = (state[(row, column)], printed[(row, column)]);
                assert!((found - expected).abs() <= 1e-12 * scale, "A {row} {column}: {found} {expected}");
            }
            for column in 0..2 {
                let (found, expected) = (input[(row, column)], printed_input[(row, column)]);
                assert!((found - expected).abs() <= 1e-12 * scale, "B {row} {column}: {found} {expected}");
            }
            assert_eq!(input[(row, 2)], 0.0, "the road's velocity moves nothing");
        }
    }
}

#[test]
fn oil_and_masses_make_a_mode_of_252_hertz_with_a_damping_ratio_of_0_24() {
    let (state, _) = linearised(ValveLaw::Nonlinear);
    let values = state.complex_eigenvalues();
    let close = |re: f64, im: f64, digits: f64| {
        values.iter().any(|value| (value.re - re).abs() < digits && (value.im - im).abs() < digits)
    };
    assert!(close(-392.904, 1580.622, 1e-3) && close(-0.7285, 19.5490, 1e-4), "{values}");
    assert!(close(-431.034, 0.0, 1e-3) && close(-0.21495, 0.0, 1e-5), "{values}");
    // Uncoupled, as it stands among the parameters.
    let mode = ServoSuspension { law: ValveLaw::Linear }.derive(&parameters::<f64>(&[])).hydraulic_mode;
    assert!(
        (mode.natural_frequency - 255.2).abs() < 0.1 && (mode.damping_ratio - 0.2437).abs() < 1e-4,
        "{mode:?}"
    );
    // Eq. 2.24 damps more.
    let regression = linearised(ValveLaw::Regression).0.complex_eigenvalues();
    assert!(regression.iter().any(|value| (value.re + 563.275).abs() < 1e-2), "{regression}");
}

/// Every effect at work.
const EFFECTS: [(&str, f64); 8] = [
    ("strut.asymmetry.ratio", 0.3),
    ("strut.coulomb.force", 60.0),
    ("guide.coulomb.force", 20.0),
    ("tire.coulomb.force", 30.0),
    ("tire.quadratic", 1e5),
    ("strut.orifice.coefficient", 300.0),
    ("strut.knee.ratio", -0.4),
    ("guide.damping", 30.0),
];

/// Kinetic energy, that of both springs over a road at `w`, and that of the oil.
fn energy(p: &Parameters<f64>, [z2, v2, z1, q, pressure, _]: [f64; 6], w: f64) -> f64 {
    let (x, c) = (z2 - z1, w - z1);
    let v1 = q + p.tire.damping * c / p.unsprung_mass;
    0.5 * (p.sprung_mass * v2 * v2 + p.unsprung_mass * v1 * v1 + p.strut.stiffness * x * x)
        + 0.5 * p.tire.stiffness * c * c
        + p.tire.quadratic * c * c * c / 3.0
        + p.actuator.energy(&p.actuator.hydraulics(), pressure)
}

/// What the energy grows by in a second.
fn power(p: &Parameters<f64>, x: [f64; 6], rates: &State<f64>, w: f64) -> f64 {
    let rates = list(rates);
    // Each state by a part of its own magnitude.
    let h = 1e-7;
    let moved = |h: f64| std::array::from_fn(|i| x[i] + h * rates[i]);
    (energy(p, moved(h), w) - energy(p, moved(-h), w)) / (2.0 * h)
}

const LAWS: [ValveLaw; 3] = [ValveLaw::Nonlinear, ValveLaw::Linear, ValveLaw::Regression];

fn any_state() -> impl Strategy<Value = [f64; 6]> {
    let scale = [0.05, 1.0, 0.05, 1.0, 11e6, 0.5e-3];
    prop::array::uniform6(-1.0..1.0_f64).prop_map(move |x| std::array::from_fn(|i| x[i] * scale[i]))
}

proptest! {
    /// Eq. 2.14 and 2.15 with f_s = A_a P_r are the quarter car; and eq. 2.11 the actuator that is apart.
    #[test]
    fn rig_and_actuator_apart_say_the_same(
        x in any_state(), voltage in -10.0..10.0_f64, road in prop::array::uniform2(-0.05..0.05_f64), index in 0..3_usize,
    ) {
        let p = parameters::<f64>(&EFFECTS);
        let (rates, output) = evaluate(LAWS[index], &p, x, [voltage, road[0], 20.0 * road[1]]);
        let mut options = crate::rigs::quarter_car::Options::starts();
        Settings::set(&mut options, 0, Value::Boolean(false)).unwrap();
        let car = QuarterCar::prepare(&options, None).unwrap();
        let declared = Declarations::of::<crate::rigs::quarter_car::Parameters<f64>>();
        let of_car = crate::rigs::quarter_car::Parameters {
            sprung_mass: p.sprung_mass,
            unsprung_mass: p.unsprung_mass,
            strut: p.strut,
            guide: p.guide,
            tire: p.tire,
            ..Bundle::from_fn(|i| declared[i].start)
        };
        let v1 = output.wheel.velocity;
        let (expected, measured) = car.equations(Instant {
            time: 0.0,
            state: &Bundle::from_fn(|i| [x[0], x[1], x[2], v1].get(i).copied().unwrap_or(0.0)),
            input: &Bundle::from_fn(|i| [road[0], 20.0 * road[1], output.actuator.force][i]),
            parameters: &of_car,
            derived: &car.derive(&of_car),
            memory: &NoVariables,
            tick: 0,
        });
        let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-12 * scale;
        prop_assert!(close(rates.body.velocity, expected.body.velocity, 1e3));
        prop_assert!(close(output.wheel.acceleration, expected.wheel.velocity, 1e4));
        prop_assert!(close(output.wheel.force, measured.wheel.force, 1e4));
        prop_assert_eq!(output.tire, measured.tire);
        prop_assert_eq!((rates.body.position, rates.wheel.position), (x[1], v1));
        prop_assert_eq!(output.suspension, measured.suspension);
        // q = z_1' + b_1 (z_1 − w)/m_1 along the motion, whatever the road's velocity.
        let b = p.tire.damping / p.unsprung_mass;
        let rate = output.wheel.acceleration + b * (v1 - 20.0 * road[1]);
        prop_assert!(close(rates.wheel.undamped_velocity, rate, 1e4));

        let hydraulics = p.actuator.hydraulics();
        let flow = p.actuator.flow(LAWS[index], &hydraulics, x[5], x[4]).load;
        let printed = hydraulics.coefficient
            * (flow * 0.765_786e-3 - 0.765_786e-3_f64.powi(2) * output.suspension.velocity - 0.765_786e-3 * 15e-12 * x[4]);
        prop_assert!(close(rates.pressure * 0.765_786e-3, printed, 1e8));
    }

    /// With the valve closed nothing but losses; with it open at most what the supply gives.
    #[test]
    fn no_state_brings_energy_in(x in any_state(), w in -0.05..0.05_f64, index in 0..3_usize, effects in any::<bool>()) {
        let p = parameters::<f64>(if effects { &EFFECTS } else { &[] });
        let closed = std::array::from_fn(|i| if i == 5 { 0.0 } else { x[i] });
        for x in [closed, x] {
            let (rates, output) = evaluate(LAWS[index], &p, x, [0.0, w, 0.0]);
            let power = power(&p, x, &rates, w);
            // The rounding of energies of some thousand joules over 0.1 µs.
            prop_assert!(power <= output.supply.power + 1e-4 * (1.0 + output.supply.power.abs()) + 1.0, "{power} {output:?}");
            if x[5] == 0.0 {
                prop_assert_eq!(output.supply.power, 0.0);
            }
        }
    }

    #[test]
    fn at_rest_in_any_place_nothing_moves(w in -0.1..0.1_f64, index in 0..3_usize, effects in any::<bool>()) {
        let p = parameters::<f64>(if effects { &EFFECTS } else { &[] });
        let (rates, output) = evaluate(LAWS[index], &p, [w, 0.0, w, 0.0, 0.0, 0.0], [0.0, w, 0.0]);
        prop_assert!(list(&rates).into_iter().all(|rate| rate == 0.0), "{rates:?}");
        prop_assert_eq!((output.wheel.force, output.supply.power), (0.0, 0.0));
    }

    /// A lasting voltage: the valve gives what leaks, the strut carries what the pressure makes.
    #[test]
    fn a_lasting_voltage_has_an_equilibrium(pressure in -9e6..9e6_f64, index in 0..3_usize) {
        let p = parameters::<f64>(&[]);
        let deflection = 0.765_786e-3 * pressure / 8652.0;
        let leak = 15e-12 * pressure;
        let position = match LAWS[index] {
            ValveLaw::Nonlinear => leak / (15.708e-3 * 0.611 * ((12e6 - pressure.abs()) / 880.0).sqrt()),
            ValveLaw::Linear => leak / (15.708e-3 * 0.611 * (12e6_f64 / 880.0).sqrt()),
            ValveLaw::Regression => (leak + p.actuator.valve.regression.pressure_coefficient * pressure)
                / p.actuator.valve.regression.flow_gain,
        };
        let voltage = position / 0.025e-3;
        let (rates, _) = evaluate(LAWS[index], &p, [deflection, 0.0, 0.0, 0.0, pressure, position], [voltage, 0.0, 0.0]);
        let scale = [1.0, 100.0, 1.0, 1000.0, 1e10, 1.0];
        for (rate, scale) in list(&rates).into_iter().zip(scale) {
            prop_assert!(rate.abs() <= 1e-12 * scale, "{rates:?}");
        }
    }
}

#[test]
fn constants_act_where_their_equations_say() {
    let signals = |changes: &[(&str, f64)]| {
        let p = parameters::<f64>(changes);
        let x = [0.01, 0.2, 0.005, -0.3, 1e6, 1e-4];
        let (rates, output) = evaluate(ValveLaw::Nonlinear, &p, x, [1.0, 0.002, 0.1]);
        let flow = rates.pressure / p.actuator.hydraulics().coefficient;
        let Output { body, wheel, actuator, .. } = output;
        [body.acceleration, wheel.acceleration, wheel.force, actuator.force, flow]
    };
    let (body, wheel) = (10.0 / 86.0, 10.0 / 11.5);
    for (port, value, expected) in [
        ("strut.preload", 10.0, [-body, wheel, 0.0, 0.0, 0.0]),
        ("guide.preload", 10.0, [-body, 0.0, 0.0, 0.0, 0.0]),
        ("wheel_guide.preload", 10.0, [0.0, -wheel, 0.0, 0.0, 0.0]),
        ("tire.preload", 10.0, [0.0, wheel, 10.0, 0.0, 0.0]),
        ("actuator.cylinder.preload", 10.0, [-body, wheel, 0.0, -10.0, 0.0]),
        ("actuator.cylinder.flow_offset", 2e-6, [0.0, 0.0, 0.0, 0.0, 2e-6]),
    ] {
        let found = signals(&[(port, value)]).into_iter().zip(signals(&[]));
        for ((found, neutral), change) in found.zip(expected) {
            let error = (found - neutral - change).abs();
            assert!(error < 1e-12 * (1.0 + neutral.abs() / 1e-3), "{port}: {found} {neutral} {change}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let error = ServoSuspension { law: ValveLaw::Linear };
    let p = parameters::<f64>(&[("actuator.valve.laminar_pressure", 20e6)]);
    let error = error.check(&p, &error.derive(&p)).unwrap_err();
    assert!(error.contains("actuator.supply.pressure = 12000000 Pa"), "{error}");
}
