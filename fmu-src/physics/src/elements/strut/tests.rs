use super::*;
use crate::effects::{Maxwell, Mount, Presliding};
use proptest::prelude::*;
use strut_model::{Bundle, Declarations};

/// Declared start values: no effect is on.
fn neutral<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    B::from_fn(|i| declared[i].start)
}

fn strut(ratio: f64, force: f64) -> Strut<f64> {
    Strut {
        stiffness: 8400.0,
        damping: 707.0,
        asymmetry: Asymmetry { ratio, smoothing: 0.005 },
        coulomb: Coulomb { force, velocity: 0.008 },
        ..neutral()
    }
}

/// At time zero.
fn force(strut: &Strut<f64>, x: f64, v: f64) -> f64 {
    strut.force(0.0, x, v, strut.active_effects())
}

#[test]
fn the_spring_alone_is_equation_14() {
    assert_eq!(force(&strut(0.3, 115.0), 0.05, 0.0), 8400.0 * 0.05);
}

proptest! {
    #[test]
    fn with_neutral_effects_it_is_linear(x in -0.1..0.1_f64, v in -2.0..2.0_f64) {
        prop_assert_eq!(force(&strut(0.0, 0.0), x, v), 8400.0 * x + 707.0 * v);
    }

    #[test]
    fn what_is_not_spring_takes_energy(x in -0.1..0.1_f64, v in -2.0..2.0_f64, ratio in -0.9..0.9_f64) {
        let strut = strut(ratio, 115.0);
        prop_assert!((force(&strut, x, v) - force(&strut, x, 0.0)) * v >= 0.0);
    }

    #[test]
    fn with_active_effects_neutral_only_rounding_is_left(
        x in -0.1..0.1_f64,
        v in -2.0..2.0_f64,
        ratio in -0.9..0.9_f64,
    ) {
        let strut = strut(ratio, 115.0);
        let asked_for_each = strut.force(0.0, x, v, 1.0);
        prop_assert!((asked_for_each - force(&strut, x, v)).abs() < 1e-9);
        let (force, rates) = strut.force_with_states(&neutral(), &HysteresisState::rest(), [0.0, x, v], 1.0);
        prop_assert_eq!((force, rates), (asked_for_each, HysteresisState::rest()));
    }

    #[test]
    fn dampers_and_frictions_take_energy_behind_a_linkage_too(
        x in -0.1..0.1_f64,
        v in -2.0..2.0_f64,
        knee in -0.99..3.0_f64,
        slope in -5.0..5.0_f64,
    ) {
        let mut strut = every_effect();
        strut.knee.ratio = knee;
        strut.linkage.slope = slope;
        // What is not passive by itself.
        strut.r#yield.slope = 0.0;
        strut.curve.scale = 0.0;
        let at = |v| strut.force(30.0, x, v, strut.active_effects());
        prop_assert!((at(v) - at(0.0)) * v >= 0.0);
    }

    #[test]
    fn a_linkage_passes_power_on(x in -0.1..0.1_f64, v in -2.0..2.0_f64, slope in -5.0..5.0_f64) {
        let direct = Strut { linkage: Linkage { slope: 0.0 }, ..every_effect() };
        let linked = Strut { linkage: Linkage { slope }, ..direct };
        let (own_deflection, own_velocity) = (x + 0.5 * slope * x * x, (1.0 + slope * x) * v);
        let (at_wheel, at_strut) = (force(&linked, x, v) * v, force(&direct, own_deflection, own_velocity) * own_velocity);
        prop_assert!((at_wheel - at_strut).abs() <= 1e-12 * (1.0 + at_strut.abs()));
    }

    #[test]
    fn the_damper_s_velocity_is_that_of_its_force(v in -2.0..2.0_f64, time in 0.0..1e3_f64) {
        let strut = every_effect();
        prop_assert!((strut.damper_velocity(time, strut.damper(time, v)) - v).abs() < 1e-12);
    }

    /// The energy in the springs of Maxwell branch, presliding friction and mount grows by no more than is put in.
    #[test]
    fn what_a_strut_remembers_is_passive(
        v in -1.0..1.0_f64,
        friction in -60.0..60.0_f64,
        branch in -0.02..0.02_f64,
        bush in -3e-3..3e-3_f64,
    ) {
        let mut strut = every_effect();
        (strut.preload, strut.curve.scale, strut.linkage.slope) = (0.0, 0.0, 0.0);
        let (hysteresis, mut state) = (with_states(), HysteresisState::rest());
        state.presliding.friction = friction;
        state.maxwell.deflection = branch;
        state.mount.deflection = bush;
        // In the middle, where neither springs nor the yield force's slope do anything.
        let (force, rates) = strut.force_with_states(&hysteresis, &state, [5.0, 0.0, v], 1.0);
        let beyond_backlash = bush - bush.clamp(-hysteresis.mount.gap, hysteresis.mount.gap);
        let stored = friction / hysteresis.presliding.stiffness * rates.presliding.friction
            + hysteresis.maxwell.stiffness * branch * rates.maxwell.deflection
            + beyond_backlash / hysteresis.mount.compliance * rates.mount.deflection;
        prop_assert!(force * v - stored >= -1e-9 * (1.0 + stored.abs()), "{force} {v} {stored}");
    }
}

/// Every memoryless effect at once.
fn every_effect() -> Strut<f64> {
    let mut strut = strut(0.3, 115.0);
    strut.stribeck = Stribeck { force: 40.0, velocity: 0.02 };
    strut.load_dependence.slope = 6.0;
    strut.r#yield = YieldForce { force: 50.0, velocity: 0.03, slope: 20.0 };
    strut.knee = Knee { ratio: -0.4, velocity: 0.15 };
    strut.orifice.coefficient = 300.0;
    strut.fade = Fade { ratio: 0.3, time: 60.0 };
    strut.spring = Progression { quadratic: 2e4, cubic: 1e6 };
    strut.stop = Stop { stiffness: 2e5, compression_clearance: 0.03, rebound_clearance: 0.04 };
    strut.preload = 12.0;
    strut.linkage.slope = 2.0;
    strut.curve.scale = 1.0;
    strut.curve.over_deflection = std::array::from_fn(|i| (i * i) as f64);
    strut.curve.over_velocity = std::array::from_fn(|i| 3.0 * i as f64);
    strut
}

/// Every effect with a state at once.
fn with_states() -> Hysteresis<f64> {
    Hysteresis {
        presliding: Presliding { force: 60.0, stiffness: 2e5, exponent: 1.5, gap: 0.0 },
        maxwell: Maxwell { stiffness: 2e4, time: 0.02 },
        mount: Mount { gap: 0.5e-3, compliance: 2e-6 },
    }
}

#[test]
fn effects_add_up_as_they_are_written() {
    // 45 mm of compression at 0.4 m/s in rebound, after two minutes.
    let (t, x, v) = (120.0, -0.045, 0.4);
    let i = 1.0 + 2.0 * x;
    let (xs, vs) = (x + x * x, i * v);
    let kneed = vs - 0.4 * (vs - 0.15);
    let damper = 707.0
        * (1.0 - 0.3 * (1.0 - (-t / 60.0_f64).exp()))
        * (kneed + 0.3 * ((kneed * kneed + 25e-6_f64).sqrt() - 0.005));
    let friction = (115.0 * (1.0 + 6.0 * xs) + 40.0 * (-(vs / 0.02).powi(2)).exp()) * (vs / 0.008).tanh();
    let spring = 8400.0 * xs + 2e4 * xs * xs + 1e6 * xs.powi(3) + 2e5 * (xs + 0.03);
    let yielding = 50.0 * (vs / 0.03 + 20.0 * xs).tanh();
    // The curves' points are 10 mm and 0.1 m/s apart.
    let (over_x, over_v) = ((xs + 0.05) / 0.01, (vs + 0.5) / 0.1);
    let unnamed = over_x.floor().powi(2) + (2.0 * over_x.floor() + 1.0) * over_x.fract() + 3.0 * over_v;
    let expected = i * (spring + damper + friction + yielding + 300.0 * vs * vs + 12.0 + unnamed);
    let strut = every_effect();
    let found = strut.force(t, x, v, strut.active_effects());
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    assert_eq!(strut.active_effects(), 12.0);
}

#[test]
fn an_effect_that_is_on_counts_whichever_it_is() {
    assert_eq!(strut(0.3, 115.0).active_effects(), 0.0);
    assert_eq!(neutral::<Hysteresis<f64>>().active_effects(), 0.0);
    assert_eq!(with_states().active_effects(), 4.0);
}

#[test]
fn a_mount_without_play_lets_the_steady_damper_through() {
    let strut = Strut { damping: 1000.0, ..neutral() };
    let hysteresis = Hysteresis { mount: Mount { gap: 0.0, compliance: 1e-5 }, ..neutral() };
    let mut state = HysteresisState::rest();
    state.mount.deflection = 1e-5 * 1000.0 * 0.1;
    let (force, rates) = strut.force_with_states(&hysteresis, &state, [0.0, 0.0, 0.1], 1.0);
    assert!((force - 100.0).abs() < 1e-9 && rates.mount.deflection.abs() < 1e-15);
}

#[test]
fn a_mount_of_no_damper_is_refused() {
    let hysteresis = Hysteresis { mount: Mount { gap: 1e-3, compliance: 0.0 }, ..neutral() };
    assert_eq!(hysteresis.check(1.0), Ok(()));
    assert_eq!(neutral::<Hysteresis<f64>>().check(0.0), Ok(()));
    let error = hysteresis.check(0.0).unwrap_err();
    assert!(error.contains("hysteresis.mount.gap = 0.001 m") && error.contains("strut.damping"), "{error}");
}
