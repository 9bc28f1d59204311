use std::f64::consts::TAU;

use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Settings};

use super::SpringLever::{Exact, Perpendicular, Printed};
use super::*;
use crate::actuators::MrRotaryBrake;

mod energy;

const PRINTED: SasRig = SasRig { locked: false, lever: Printed, lift_off: false };
const LEVERS: [SpringLever; 3] = [Printed, Perpendicular, Exact];
/// What the eccentric's lowest position is, eq. 15.
const LOWEST: f64 = 0.04;
/// b(0) I of 3.1.2: the brake without current.
const IDLE: f64 = 0.1921 * 1.37;

fn parameters() -> Parameters<f64> {
    starts()
}

fn starts<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    Bundle::from_fn(|i| declared[i].start)
}

fn evaluate<R: Real>(rig: SasRig, p: &Parameters<R>, x: [R; 4], u: [R; 3]) -> (State<R>, Output<R>) {
    rig.equations(Instant {
        time: R::from(0.0),
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &rig.derive(p),
        memory: &strut_model::NoVariables,
        tick: 0,
    })
}

/// The rates of angle and speed of both arms under a linear brake.
fn rates(rig: SasRig, p: &Parameters<f64>, x: [f64; 4], damping: f64, height: [f64; 2]) -> [f64; 4] {
    let torque = damping * (x[3] - x[1]);
    let (rates, _) = evaluate(rig, p, x, [torque, height[0], height[1]]);
    [rates.wheel_arm.angle, rates.wheel_arm.speed, rates.body_arm.angle, rates.body_arm.speed]
}

fn at_rest(rig: SasRig, p: &Parameters<f64>) -> [f64; 4] {
    let rest = rig.derive(p).rest;
    [rest.wheel_arm_angle, 0.0, rest.body_arm_angle, 0.0]
}

/// The eccentric of eq. 15 at a constant frequency.
fn eccentric(frequency: f64, t: f64) -> [f64; 2] {
    let (turn, omega) = (TAU * frequency * t, TAU * frequency);
    [0.0425 - 0.0025 * turn.cos(), 0.0025 * omega * turn.sin()]
}

/// States every 10 ms, by the classical Runge–Kutta method at 1 ms.
fn motion(start: [f64; 4], seconds: usize, f: impl Fn([f64; 4], f64) -> [f64; 4]) -> Vec<[f64; 4]> {
    let h = 1e-3;
    let (mut x, mut list) = (start, Vec::new());
    for step in 0..1000 * seconds {
        if step % 10 == 0 {
            list.push(x);
        }
        let t = step as f64 * h;
        let moved = |k: [f64; 4], h: f64| -> [f64; 4] { std::array::from_fn(|i| x[i] + h * k[i]) };
        let k1 = f(x, t);
        let k2 = f(moved(k1, 0.5 * h), t + 0.5 * h);
        let k3 = f(moved(k2, 0.5 * h), t + 0.5 * h);
        let k4 = f(moved(k3, h), t + h);
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    list
}

/// From rest, on the eccentric.
fn driven(rig: SasRig, damping: f64, frequency: f64, seconds: usize) -> Vec<[f64; 4]> {
    let p = parameters();
    motion(at_rest(rig, &p), seconds, |x, t| rates(rig, &p, x, damping, eccentric(frequency, t)))
}

/// Half the range of the body arm's angle.
fn amplitude(states: &[[f64; 4]]) -> f64 {
    let angles = || states.iter().map(|x| x[2]);
    0.5 * (angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min))
}

#[test]
fn it_rests_where_3_2_2_says() {
    let p = parameters();
    let rest = PRINTED.derive(&p).rest;
    // Printed [-0.195 0 0.3540]; the second is 1.1 mrad off.
    assert!((rest.wheel_arm_angle + 0.195).abs() < 5e-4 && (rest.body_arm_angle - 0.354).abs() < 1.2e-3);
    assert!((rest.tire_force - 261.0).abs() < 0.05, "{rest:?}");
    for lever in LEVERS {
        let rig = SasRig { lever, ..PRINTED };
        let x = at_rest(rig, &p);
        rates(rig, &p, x, IDLE, [LOWEST, 0.0]).iter().for_each(|rate| assert!(rate.abs() < 1e-9, "{rate}"));
    }
    // One lever for both arms: the wheel arm's printed angle does not come out.
    let one_lever = SasRig { lever: Perpendicular, ..PRINTED }.derive(&p).rest;
    assert!(
        (one_lever.wheel_arm_angle + 0.1921).abs() < 5e-5 && (one_lever.tire_force - 195.25).abs() < 0.01
    );
}

#[test]
fn the_declared_start_is_rest() {
    let start: State<f64> = starts();
    let rest = PRINTED.derive(&parameters()).rest;
    assert!((start.wheel_arm.angle - rest.wheel_arm_angle).abs() < 1e-12, "{rest:?}");
    assert!((start.body_arm.angle - rest.body_arm_angle).abs() < 1e-12, "{rest:?}");
}

#[test]
fn the_constants_are_those_of_3_2_2() {
    let p = parameters();
    let tire_lever = p.wheel_arm.length * (p.wheel_arm.offset + 0.195).cos();
    for (what, found, printed, tolerance) in [
        ("k_s", p.spring.stiffness, 3.79e3, 5.0),
        ("k_t", p.tire.stiffness, 1.09e5, 500.0),
        ("b_t", p.tire.damping * tire_lever, 305.27, 1.0),
        ("a_1", p.tire.stiffness * p.wheel_arm.length / p.wheel_arm.inertia, 1.08e5, 500.0),
        ("a_2", p.tire.damping * tire_lever / p.wheel_arm.inertia, 1.44e3, 5.0),
        ("a_3", p.wheel_arm.gravity_moment / p.wheel_arm.inertia, 9.81 / 0.21, 0.01),
        // Cut off, not rounded: 4927 and 4.726.
        ("a_4", p.spring.stiffness * p.spring.wheel_arm_mount / p.wheel_arm.inertia, 4.92e3, 10.0),
        ("k_1", 1.0 / p.wheel_arm.inertia, 4.72, 0.01),
        ("a_5", p.spring.stiffness * p.spring.body_arm_mount / p.body_arm.inertia, 528.57, 1e-9),
        ("a_6", p.body_arm.gravity_moment / p.body_arm.inertia, 22.07, 1e-9),
    ] {
        assert!((found - printed).abs() < tolerance, "{what}: {found} {printed}");
    }
}

#[test]
fn the_wheel_is_where_3_2_2_measured_it() {
    let p = parameters();
    for (angle, height, compression, tolerance) in [(-0.19, 0.04, 0.0015, 2e-4), (-0.167, 0.045, 0.002, 5e-5)]
    {
        let contact = Contact::new(&p, angle, height);
        assert!((contact.compression - compression).abs() < tolerance, "{}", contact.compression);
    }
}

#[test]
fn with_the_wheel_arm_locked_it_is_the_rig_of_part_one() {
    let rig = SasRig { locked: true, ..PRINTED };
    let p = parameters();
    let derived = rig.derive(&p);
    // x_10 = 0.57 rad; by eq. 20 with the arm at -0.19 rad it is "approximately 0.36 rad".
    assert!((derived.rest.body_arm_angle - 0.57).abs() < 1e-4, "{derived:?}");
    assert!((derived.body_arm.natural_frequency - 1.4715).abs() < 1e-4, "{derived:?}");
    let x20 = 0.3586;
    let (tilted, _) = evaluate(rig, &p, [-0.19, 0.0, x20, 0.0], [0.0, LOWEST, 0.0]);
    assert!(tilted.body_arm.speed.abs() < 3e-3 && (x20 - 0.36).abs() < 5e-3, "{tilted:?}");
    // Eq. 3, and an arm that does not move whatever presses on it.
    let x = [0.0, 0.0, 0.8, -0.5];
    let found = rates(rig, &p, x, IDLE, [0.045, 0.3]);
    let length = |g: f64| (0.275_f64.powi(2) + 0.191_f64.powi(2) - 2.0 * 0.275 * 0.191 * g.cos()).sqrt();
    let expected = 528.57 * (0.189 - length(0.8)) - 22.07 * 0.8_f64.cos() + 0.1921 * 0.5;
    assert!((found[3] - expected).abs() < 1e-9);
    assert_eq!(&found[..3], &[0.0, 0.0, -0.5]);
}

/// Frequency in hertz and damping ratio with which the body arm swings when it is let go 1 mrad off rest.
fn free_oscillation(rig: SasRig, damping: f64) -> (f64, f64) {
    let p = parameters();
    let rest = at_rest(rig, &p);
    let start = [rest[0], 0.0, rest[2] + 1e-3, 0.0];
    let angles: Vec<f64> = motion(start, 8, |x, _| rates(rig, &p, x, damping, [LOWEST, 0.0]))
        .iter()
        .map(|x| x[2] - rest[2])
        .collect();
    // Upward passages, between samples, and the largest value of the period behind each.
    let passages: Vec<f64> = (1..angles.len())
        .filter(|&i| angles[i - 1] < 0.0 && angles[i] >= 0.0)
        .map(|i| i as f64 - angles[i] / (angles[i] - angles[i - 1]))
        .collect();
    let swing = |i: usize| {
        let period = &angles[passages[i] as usize..passages[i + 1] as usize];
        period.iter().copied().fold(0.0, f64::max) - period.iter().copied().fold(0.0, f64::min)
    };
    let count = passages.len() - 2;
    let period = (passages[count] - passages[0]) * 0.01 / count as f64;
    let decrement = (swing(0) / swing(count)).ln() / count as f64;
    (1.0 / period, decrement / decrement.hypot(TAU))
}

#[test]
fn the_body_swings_at_its_resonance() {
    // From the eigenvalues of a separate linearisation: -0.1198 ± 9.1933i and, exact, -0.1069 ± 8.5063i.
    let (frequency, ratio) = free_oscillation(PRINTED, IDLE);
    assert!((frequency - 1.4632).abs() < 1e-3 && (ratio - 0.0130).abs() < 2e-4, "{frequency} {ratio}");
    let (frequency, ratio) = free_oscillation(SasRig { lever: Exact, ..PRINTED }, IDLE);
    assert!((frequency - 1.3538).abs() < 1e-3 && (ratio - 0.0126).abs() < 2e-4, "{frequency} {ratio}");
    // Without the wheel arm's give it is the frequency that is declared.
    let locked = SasRig { locked: true, ..PRINTED };
    let (frequency, _) = free_oscillation(locked, 0.0);
    let declared = locked.derive(&parameters()).body_arm.natural_frequency;
    assert!((frequency - declared).abs() < 1e-3, "{frequency} {declared}");
}

#[test]
fn at_1_35_hertz_the_body_swings_up_as_in_figure_3() {
    let states = driven(PRINTED, IDLE, 1.35, 6);
    let seconds: Vec<f64> = states.chunks(100).map(amplitude).collect();
    assert!(seconds[..4].is_sorted() && seconds[3] > 3.0 * seconds[0], "{seconds:?}");
}

/// The brake's damping rate at a duty cycle, once its field is there.
fn brake(duty: f64) -> f64 {
    let brake = MrRotaryBrake::prepare(&<MrRotaryBrake as Model>::Settings::starts(), None).unwrap();
    let p = starts();
    let (_, output) = brake.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|_| duty),
        input: &Bundle::from_fn(|_| duty),
        parameters: &p,
        derived: &brake.derive(&p),
        memory: &strut_model::NoVariables,
        tick: 0,
    });
    output.damping
}

#[test]
fn more_current_leaves_less_of_the_swing_as_in_figures_15_to_17() {
    // On the eccentric at 1.6 Hz, in the steady state.
    let swings = [0.0, 0.3, 0.7, 1.0].map(|duty| amplitude(&driven(PRINTED, brake(duty), 1.6, 60)[5500..]));
    for (swing, expected) in swings.iter().zip([0.0709, 0.0597, 0.0469, 0.0419]) {
        assert!((swing - expected).abs() < 1e-4, "{swings:?}");
    }
}

#[test]
fn full_current_makes_the_body_follow_the_eccentric_as_in_figure_17() {
    // How far the mean frequency of the first ten seconds, by passages through rest, is off 1.6 Hz: without
    // current the body's own frequency goes on beside it.
    let spread = |duty: f64| {
        let states = driven(PRINTED, brake(duty), 1.6, 12);
        let rest = states[0][2];
        let passages: Vec<f64> = (200..states.len())
            .filter(|&i| states[i - 1][2] < rest && states[i][2] >= rest)
            .map(|i| i as f64 - (states[i][2] - rest) / (states[i][2] - states[i - 1][2]))
            .collect();
        let periods = passages.windows(2).map(|pair| (pair[1] - pair[0]) * 0.01);
        periods.map(|period| (1.0 / period - 1.6).abs()).fold(0.0, f64::max)
    };
    assert!(spread(0.0) > 0.1 && spread(1.0) < 0.03, "{} {}", spread(0.0), spread(1.0));
}

#[test]
fn the_wheel_would_jump_near_the_resonance_only() {
    let lightest = |frequency: f64| {
        let p = parameters();
        let states = driven(PRINTED, IDLE, frequency, 20);
        let force = |(i, x): (usize, &[f64; 4])| {
            let [height, velocity] = eccentric(frequency, i as f64 * 0.01);
            evaluate(PRINTED, &p, *x, [0.0, height, velocity]).1.tire.force
        };
        states.iter().enumerate().map(force).fold(f64::MAX, f64::min)
    };
    for (frequency, jumps) in [(1.0, false), (1.2, false), (1.45, true), (1.8, false)] {
        let force = lightest(frequency);
        assert_eq!(force < 0.0, jumps, "{frequency} Hz: {force} N");
    }
}

#[test]
fn a_tyre_that_can_leave_the_eccentric_never_pulls() {
    let rig = SasRig { lift_off: true, ..PRINTED };
    let p = parameters();
    let x = at_rest(rig, &p);
    // The eccentric falls away by 3 mm at once; the tyre was compressed by 2.4 mm.
    let (rates, output) = evaluate(rig, &p, x, [0.0, LOWEST - 0.003, 0.0]);
    assert!(output.tire.force == 0.0 && output.tire.compression < 0.0);
    let falling =
        -evaluate(PRINTED, &p, x, [0.0, LOWEST, 0.0]).1.tire.force * 0.21 * (0.234 - x[0]).cos() / 0.2116;
    assert!((rates.wheel_arm.speed - falling).abs() < 1e-6, "{} {falling}", rates.wheel_arm.speed);
}

/// Changes parameters.
type Change = fn(&mut Parameters<f64>);

#[test]
fn constants_act_where_their_equations_say() {
    let x = [-0.19, 0.3, 0.4, -0.5];
    let signals = |p: &Parameters<f64>| {
        let (rates, output) = evaluate(PRINTED, p, x, [0.3, LOWEST, 0.02]);
        [rates.wheel_arm.speed * 0.2116, rates.body_arm.speed * 1.37, output.tire.force]
    };
    let p = parameters();
    let lever = 0.21 * (0.234_f64 + 0.19).cos();
    let with: [(Change, [f64; 3]); 4] = [
        (|p| p.wheel_arm.load = 2.0, [-2.0, 0.0, 0.0]),
        (|p| p.body_arm.load = 2.0, [0.0, -2.0, 0.0]),
        (|p| p.pivot.preload = 2.0, [2.0, -2.0, 0.0]),
        (|p| p.tire.preload = 10.0, [10.0 * lever, 0.0, 10.0]),
    ];
    for (put, expected) in with {
        let mut loaded = p;
        put(&mut loaded);
        for ((found, neutral), change) in signals(&loaded).into_iter().zip(signals(&p)).zip(expected) {
            assert!((found - neutral - change).abs() < 1e-9, "{found} {neutral} {change}");
        }
    }
}

#[test]
fn with_loads_and_preloads_it_rests_elsewhere() {
    let mut p = parameters();
    (p.wheel_arm.load, p.body_arm.load, p.pivot.preload, p.tire.preload) = (-0.5, 1.0, 0.4, 20.0);
    let x = at_rest(PRINTED, &p);
    assert!((x[2] - at_rest(PRINTED, &parameters())[2]).abs() > 1e-3);
    rates(PRINTED, &p, x, IDLE, [LOWEST, 0.0]).iter().for_each(|rate| assert!(rate.abs() < 1e-9, "{rate}"));
}

/// States around where the arms move.
fn somewhere() -> impl Strategy<Value = [f64; 4]> {
    [-0.25..-0.1_f64, -1.0..1.0_f64, 0.0..0.9_f64, -3.0..3.0_f64]
}

proptest! {
    #[test]
    fn rest_is_found_for_other_rigs_too(
        stiffness in 0.8..5.0_f64,
        load in 0.2..1.2_f64,
        tire in 0.2..5.0_f64,
        lever in 0..3_usize,
    ) {
        let mut p = parameters();
        p.spring.stiffness *= stiffness;
        p.body_arm.gravity_moment *= load;
        p.tire.stiffness *= tire;
        let rig = SasRig { lever: LEVERS[lever], ..PRINTED };
        let x = at_rest(rig, &p);
        for rate in rates(rig, &p, x, IDLE, [LOWEST, 0.0]) {
            prop_assert!(rate.abs() < 1e-7, "{rate} at {x:?}");
        }
        prop_assert_eq!(rig.check(&p, &rig.derive(&p)), Ok(()));
    }

    #[test]
    fn derivatives_are_slopes(x in somewhere(), i in 0..4_usize, lever in 0..3_usize) {
        let p = parameters();
        let rig = SasRig { lever: LEVERS[lever], ..PRINTED };
        let mut list = Vec::new();
        p.for_each(|_, number| list.push(Dual64::from(number)));
        let lifted: Parameters<Dual64> = Bundle::from_fn(|i| list[i]);
        let mut dual = x.map(Dual64::from);
        dual[i] = dual[i].derivative();
        let (exact, _) = evaluate(rig, &lifted, dual, [0.3, LOWEST, 0.02].map(Dual64::from));
        let h = 1e-6;
        let at = |h: f64| {
            let mut x = x;
            x[i] += h;
            evaluate(rig, &p, x, [0.3, LOWEST, 0.02]).0
        };
        let (up, down) = (at(h), at(-h));
        for (exact, up, down) in [
            (exact.wheel_arm.speed, up.wheel_arm.speed, down.wheel_arm.speed),
            (exact.body_arm.speed, up.body_arm.speed, down.body_arm.speed),
        ] {
            let slope = (up - down) / (2.0 * h);
            prop_assert!((exact.eps - slope).abs() < 1e-5 * (100.0 + slope.abs()), "{} {slope}", exact.eps);
        }
    }
}

#[test]
fn a_rig_that_cannot_be_is_refused() {
    let check = |p: Parameters<f64>| PRINTED.check(&p, &PRINTED.derive(&p)).unwrap_err();
    let mut p = parameters();
    p.eccentric.depth = 0.4;
    assert!(check(p).contains("must be larger than eccentric.depth = 0.4 m"));
    let mut p = parameters();
    p.spring.body_arm_mount = 0.275;
    assert!(
        check(p).contains("spring.wheel_arm_mount = 0.275 m and spring.body_arm_mount = 0.275 m must differ")
    );
    let mut p = parameters();
    p.spring.stiffness = 1000.0;
    assert!(check(p).contains("spring.stiffness = 1000 N/m"));
    assert_eq!(PRINTED.check(&parameters(), &PRINTED.derive(&parameters())), Ok(()));
}
