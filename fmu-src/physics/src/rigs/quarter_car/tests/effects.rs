//! What lies beyond the effects of the published rigs.

use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Dependencies, Lanes, NoVariables, Value};

use super::*;
use crate::testing::{Bench, harmonic};

type Rig = Bench<QuarterCar>;

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
    (p.guide.preload, p.wheel_guide.preload, p.tire.preload) = (6.0, -4.0, 9.0);
    (p.tire.curve.scale, p.tire.curve.over_deflection[6]) = (1.0, 25.0);
    (p.hysteresis.presliding.force, p.hysteresis.presliding.exponent) = (60.0, 1.5);
    p.hysteresis.maxwell.stiffness = 2e4;
    (p.hysteresis.mount.gap, p.hysteresis.mount.compliance) = (0.5e-3, 2e-6);
    (p.strut.curve.over_deflection[6], p.strut.curve.damping[4]) = (8.0, 90.0);
    (p.actuator.gain, p.actuator.delay, p.actuator.lag) = (0.9, 3e-3, 2e-3);
    (p.actuator.saturation.ratio, p.actuator.saturation.force) = (0.7, 2.0);
    p.actuator.slew.slowness = 1e-4;
    (p.actuator.curve.scale, p.actuator.curve.over_force[6]) = (1.0, 3.0);
    (p.frame.mass, p.enveloping.time) = (2.0, 5e-3);
    (p.force_cell.mass, p.force_cell.hysteresis) = (4.0, 3.0);
    p
}

/// Number of states.
const STATES: usize = <State<f64> as Bundle<f64>>::LEN;

/// The rates of all states and the outputs.
fn with_memory<R: Real>(p: &Parameters<R>, x: [R; STATES], u: [R; 3]) -> Vec<R> {
    let (rates, output) = CAR.equations(Instant {
        time: R::from(50.0),
        state: &Bundle::from_fn(|i| x[i]),
        input: &Bundle::from_fn(|i| u[i]),
        parameters: p,
        derived: &CAR.derive(p),
        memory: &NoVariables,
        tick: 0,
    });
    list(&rates).into_iter().chain(list(&output)).collect()
}

#[test]
fn every_parameter_reaches_the_motion() {
    let p: Parameters<Dependencies> = Bundle::from_fn(Dependencies::on);
    let reached = with_memory(&p, [0.0.into(); STATES], [0.0.into(); 3]);
    for (i, declared) in Declarations::of::<Parameters<f64>>().into_iter().enumerate() {
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

/// Changes parameters.
type Change = fn(&mut Parameters<f64>);

#[test]
fn constant_forces_act_where_their_equations_say() {
    // In motion and in contact, 100 kg above 20 kg.
    let x = [0.001, 0.2, 0.002, -0.3];
    let p = parameters(100.0, 20.0, 8400.0, 707.0, 150e3);
    let signals = |p: &Parameters<f64>| {
        let (_, output) = evaluate(CAR, p, x, [0.0; 3]);
        [output.body.acceleration, output.wheel.acceleration, output.wheel.force]
    };
    let with: [(Change, [f64; 3]); 4] = [
        (|p| p.strut.preload = 10.0, [-0.1, 0.5, 0.0]),
        (|p| p.guide.preload = 10.0, [-0.1, 0.0, 0.0]),
        (|p| p.wheel_guide.preload = 10.0, [0.0, -0.5, 0.0]),
        (|p| p.tire.preload = 10.0, [0.0, 0.5, 10.0]),
    ];
    for (put, expected) in with {
        let mut loaded = p;
        put(&mut loaded);
        for ((found, neutral), change) in signals(&loaded).into_iter().zip(signals(&p)).zip(expected) {
            assert!((found - neutral - change).abs() < 1e-10, "{found} {neutral} {change}");
        }
    }
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

/// TUM's rig with other parameters.
fn rig(changes: &[(&str, f64)]) -> Rig {
    changes.iter().fold(Rig::published("TumQuarterVehicle"), |rig, (name, value)| rig.start(name, *value))
}

/// A road of 3 Hz over a rough one of 17 Hz; some variables at every millisecond of a second.
fn on_a_road<const N: usize>(rig: Rig, variables: [&str; N]) -> Vec<[f64; N]> {
    let road = |t: f64| 8e-3 * (std::f64::consts::TAU * 3.0 * t).sin() + 1e-3 * (107.0 * t).sin();
    let read = |rig: &mut Rig| variables.map(|name| rig.get(name));
    rig.initialized().follow("road.position", road, 1e-3, 1000, read)
}

/// What the strut remembers on that road.
fn remembered(changes: &[(&str, f64)]) -> Vec<[f64; 3]> {
    let names = ["presliding.friction", "maxwell.deflection", "mount.deflection"];
    let names = names.map(|name| format!("hysteresis.{name}"));
    on_a_road(rig(changes), names.each_ref().map(String::as_str))
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
    // From one side of the backlash to the other, and into the bush.
    assert!(moved.iter().any(|[.., bush]| *bush > 1e-3) && moved.iter().any(|[.., bush]| *bush < -1e-3));
    assert!(remembered(&[]).iter().flatten().all(|state| *state == 0.0));
}

#[test]
fn a_late_actuator_is_late_by_its_delay_and_its_lag() {
    // What moves is the force that acts; both rigs answer it alike, so that their phases differ by the actuator's.
    let driven = |changes: &[(&str, f64)]| {
        let force = |t: f64| 200.0 * (std::f64::consts::TAU * 5.0 * t).sin();
        // A velocity: the steps of the held force, of which another part arrives through a delay, are not in it.
        let read = |rig: &mut Rig| rig.get("body.velocity");
        let linear =
            ["strut.coulomb.force", "guide.coulomb.force", "strut.asymmetry.ratio", "tire.quadratic"];
        let changes: Vec<_> =
            linear.map(|name| (name, 0.0)).into_iter().chain(changes.iter().copied()).collect();
        let found = rig(&changes).initialized().follow("actuator.force", force, 1e-3, 4000, read);
        harmonic(&found[3000..], 0.0, 1e-3, 5.0)
    };
    let (amplitude, phase) = driven(&[]);
    let omega = std::f64::consts::TAU * 5.0;
    for (changes, gain, late) in [
        (vec![("actuator.delay", 0.008)], 1.0, omega * 0.008),
        (vec![("actuator.lag", 0.006)], 1.0 / (omega * 0.006).hypot(1.0), (omega * 0.006).atan()),
        (vec![("actuator.gain", 0.8)], 0.8, 0.0),
    ] {
        let (found, at) = driven(&changes);
        assert!((found / amplitude - gain).abs() < 2e-3, "{changes:?}: {}", found / amplitude);
        assert!((phase - at - late).abs() < 2e-3, "{changes:?}: {} {late}", phase - at);
    }
}

#[test]
fn a_force_cell_leaves_out_what_is_outside_of_it() {
    let cells = |mass: f64| {
        on_a_road(rig(&[("force_cell.mass", mass)]), ["wheel.force", "wheel.acceleration", "body.position"])
    };
    for (whole, part) in cells(0.0).into_iter().zip(cells(5.0)) {
        assert!((whole[0] - part[0] - 5.0 * part[1]).abs() < 1e-6 * (1.0 + whole[0].abs()));
        assert!((whole[2] - part[2]).abs() < 1e-12);
    }
}

#[test]
fn a_force_cell_with_hysteresis_hangs_behind_by_half_of_it_wherever_the_force_goes_on() {
    let cells = |hysteresis: f64| {
        on_a_road(rig(&[("force_cell.hysteresis", hysteresis)]), ["wheel.force", "body.position"])
    };
    let behind: Vec<f64> = cells(0.0)
        .into_iter()
        .zip(cells(30.0))
        .map(|([force, body], [shown, moved])| {
            // Each run has steps of its own.
            assert!((body - moved).abs() < 1e-6);
            force - shown
        })
        .collect();
    let reached = |of: &f64| behind.iter().filter(|it| (*it - of).abs() < 0.1).count();
    assert!(behind.iter().all(|it| it.abs() < 30.1));
    // For most of the time: it goes over from one side to the other while the force turns.
    assert!(reached(&30.0) + reached(&-30.0) > behind.len() / 2, "{} {}", reached(&30.0), reached(&-30.0));
}

#[test]
fn a_frame_far_below_its_resonance_is_part_of_the_body() {
    let mass = Rig::published("TumQuarterVehicle").get("sprung_mass");
    let positions = |changes: &[(&str, f64)]| on_a_road(rig(changes), ["body.position"]);
    let heavier = positions(&[("sprung_mass", mass + 3.0)]);
    let framed = positions(&[("frame.mass", 3.0), ("frame.frequency", 400.0), ("frame.damping_ratio", 0.5)]);
    let bare = positions(&[]);
    let apart = |a: &[[f64; 1]], b: &[[f64; 1]]| {
        a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max)
    };
    assert!(apart(&framed, &heavier) < 0.02 * apart(&bare, &heavier));
}

/// The implicit method has its Jacobian from dual numbers: it would not converge with wrong ones.
#[test]
fn both_methods_of_integration_lead_to_the_same_with_memory() {
    let run = |method| {
        let rig = rig(&[
            ("hysteresis.presliding.force", 60.0),
            ("hysteresis.maxwell.stiffness", 2e4),
            ("hysteresis.mount.compliance", 2e-6),
            ("hysteresis.mount.gap", 3e-4),
            ("solver.tolerance", 1e-10),
        ]);
        on_a_road(
            rig.choose("solver.method", Value::Integer(method)),
            ["body.position", "wheel.position", "hysteresis.mount.deflection"],
        )
    };
    for (explicit, implicit) in run(1).into_iter().zip(run(2)) {
        for (a, b) in explicit.into_iter().zip(implicit) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
}

proptest! {
    #[test]
    fn every_effect_says_the_same_in_every_scalar(
        x in prop::array::uniform4(-0.03..0.03_f64),
        memory in prop::array::uniform11(-1.0..1.0_f64),
        u in prop::array::uniform3(-0.01..0.01_f64),
        seeds in prop::collection::vec(-1.0..1.0_f64, <Parameters<f64> as Bundle<f64>>::LEN),
    ) {
        let nominal = list(&every_effect());
        let motion = [x[0], 10.0 * x[1], x[2], 10.0 * x[3]];
        let magnitudes = [60.0, 0.01, 1e-3, 5.0, 5.0, 5.0, 5.0, 1e-4, 0.01, 0.01, 50.0];
        let x = std::array::from_fn(|i| if i < 4 { motion[i] } else { magnitudes[i - 4] * memory[i - 4] });
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
            let x: [f64; STATES] = std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
            let plain = with_memory(&table_10(), x, u);
            for (number, plain) in with_memory(&p, x.map(Dual64::from), u.map(Dual64::from)).into_iter().zip(plain) {
                // States of effects that are being varied move; all else is as it was.
                prop_assert!(number.re.is_finite() && number.eps.is_finite(), "{number} {plain}");
            }
            let outputs = with_memory(&p, x.map(Dual64::from), u.map(Dual64::from));
            for (number, plain) in outputs.into_iter().zip(with_memory(&table_10(), x, u)).skip(STATES) {
                prop_assert!((number.re - plain).abs() < 1e-9 * (1.0 + plain.abs()));
            }
        }
    }
}
