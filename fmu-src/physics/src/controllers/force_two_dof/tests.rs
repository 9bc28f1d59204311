use proptest::prelude::*;
use strut_model::{Bundle, Declarations};

use super::*;

pub fn starts<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    Bundle::from_fn(|i| declared[i].start)
}

const CONTROLLER: ForceTwoDof = ForceTwoDof { order: 2 };
/// 2π A_0/V_c of the declared actuator.
const GEAR: f64 = TAU * 9.4e-4 / 12e-6;
const MASS: f64 = GEAR * GEAR * 3.3e-4;

fn tick(p: &Parameters<f64>, memory: &Memory<f64>, input: &Input<f64>) -> Memory<f64> {
    CONTROLLER.tick(Instant {
        time: 0.0,
        state: &NoVariables,
        input,
        parameters: p,
        derived: &NoVariables,
        memory,
        tick: 0,
    })
}

/// The equivalent mechanical system (26) under control, told how z_e moves: the forces at the samples.
fn controlled(
    p: &Parameters<f64>,
    stiffness: f64,
    reference: impl Fn(f64) -> f64,
    deflection: impl Fn(f64) -> f64,
    samples: usize,
) -> Vec<f64> {
    let (mut memory, mut z, mut v) = (starts(), 0.0_f64, 0.0_f64);
    let (fine, damping) = (5e-5, 1413.76);
    // z_e is minus the deflection.
    let force = |z: f64, v: f64, t: f64| {
        let rate = (deflection(t + 1e-7) - deflection(t - 1e-7)) / 2e-7;
        damping * (-rate - v) + stiffness * (-deflection(t) - z)
    };
    (0..samples)
        .map(|k| {
            let t = k as f64 * 1e-3;
            let input = Input {
                force_reference: reference(t),
                actuator: Pushing { force: force(z, v, t) },
                suspension: Deflection { deflection: deflection(t) },
                motor: Speed { speed: -GEAR * v },
            };
            memory = tick(p, &memory, &input);
            for i in 0..20 {
                v += fine * (force(z, v, t + f64::from(i) * fine) - GEAR * memory.motor.torque) / MASS;
                z += fine * v;
            }
            force(z, v, t + 1e-3)
        })
        .collect()
}

/// Amplitude of a frequency in whole periods of samples.
fn amplitude(forces: &[f64], frequency: f64) -> f64 {
    let (mut a, mut b) = (0.0, 0.0);
    for (k, force) in forces.iter().enumerate() {
        let (sine, cosine) = (TAU * frequency * k as f64 * 1e-3).sin_cos();
        a += force * sine;
        b += force * cosine;
    }
    2.0 * a.hypot(b) / forces.len() as f64
}

#[test]
fn slow_references_are_tracked() {
    let p = starts();
    for frequency in [0.5, 1.0, 2.0, 5.0] {
        let forces =
            controlled(&p, p.plant.stiffness, |t| 200.0 * (TAU * frequency * t).sin(), |_| 0.0, 14_000);
        let gain = amplitude(&forces[10_000..], frequency) / 200.0;
        assert!((gain - 1.0).abs() < 0.03, "{frequency} Hz: {gain}");
    }
}

/// Eq. 39 to 42: the force of a deflection is that of the passive actuator times |G_hp|.
#[test]
fn deflections_below_the_cut_off_make_no_force_and_others_the_passive_one() {
    let p: Parameters<f64> = starts();
    for (frequency, tolerance) in [(1.0, 0.04), (4.0, 0.08), (12.0, 0.1)] {
        let forces =
            controlled(&p, p.plant.stiffness, |_| 0.0, |t| 0.005 * (TAU * frequency * t).sin(), 30_000);
        let found = amplitude(&forces[26_000..], frequency) / 0.005;
        let passive = p.plant.stiffness.hypot(p.plant.damping * TAU * frequency);
        let high_pass = (frequency / frequency.hypot(p.disturbance.cut_off)).powi(2);
        assert!(
            (found / passive - high_pass).abs() < tolerance,
            "{frequency} Hz: {} {high_pass}",
            found / passive
        );
    }
}

#[test]
fn the_feedback_of_the_force_corrects_a_wrong_model() {
    let p: Parameters<f64> = starts();
    let mut without = p;
    (without.force.proportional, without.force.integral) = (0.0, 0.0);
    // A spring a third stiffer than the controller believes.
    let stiffness = 1.33 * p.plant.stiffness;
    let end = |p: &Parameters<f64>| *controlled(p, stiffness, |_| 300.0, |_| 0.0, 30_000).last().unwrap();
    assert!(end(&without) > 1.25 * 300.0, "{}", end(&without));
    assert!((end(&p) / 300.0 - 1.0).abs() < 1e-3, "{}", end(&p));
}

/// s = K_ss (c s + k), the loop that eq. 35 and 36 make of v = K_ss (F_ref - F_a), has its poles on the right for
/// positive gains as printed; with the sign of this controller on the left.
#[test]
fn with_the_printed_sign_the_feedback_of_the_force_is_unstable() {
    let p: Parameters<f64> = starts();
    let stable = |sign: f64| {
        let (kp, ki) = (sign * p.force.proportional, sign * p.force.integral);
        let (c, k) = (p.plant.damping, p.plant.stiffness);
        // (1 - K_p c) s² - (K_p k + K_i c) s - K_i k: both roots are on the left if all have one sign.
        let polynomial = [1.0 - kp * c, -(kp * k + ki * c), -ki * k];
        polynomial.iter().all(|number| *number > 0.0) || polynomial.iter().all(|number| *number < 0.0)
    };
    assert!(!stable(1.0) && stable(-1.0));
}

#[test]
fn at_the_torque_limit_no_integral_winds_up() {
    let mut p: Parameters<f64> = starts();
    p.torque.limit = 0.5;
    // For four seconds more is wanted than the motor has, then nothing.
    let forces = controlled(&p, p.plant.stiffness, |t| if t < 4.0 { 2000.0 } else { 0.0 }, |_| 0.0, 7_000);
    assert!((forces[3_999] - 0.5 * GEAR).abs() < 1.0, "{}", forces[3_999]);
    // What the limit has cut from the transients the weak feedback has to bring back.
    assert!(forces[4_500..].iter().all(|force| force.abs() < 0.15 * 0.5 * GEAR), "{}", forces[4_500]);
}

proptest! {
    #[test]
    fn the_torque_keeps_to_its_limit(
        references in prop::collection::vec(-1e4..1e4_f64, 1..40), deflection in -0.1..0.1_f64,
        speed in -300.0..300.0_f64,
    ) {
        let (p, mut memory) = (starts(), starts());
        for force_reference in references {
            let input = Input {
                force_reference,
                actuator: Pushing { force: 0.0 },
                suspension: Deflection { deflection },
                motor: Speed { speed },
            };
            memory = tick(&p, &memory, &input);
            prop_assert!(memory.motor.torque.abs() <= 8.0 + 1e-12);
        }
    }
}

#[test]
fn an_order_that_there_is_not_is_refused() {
    let error = ForceTwoDof::prepare(&Options { order: 7 }, None).unwrap_err();
    assert!(error.contains("disturbance.order = 7"), "{error}");
}
