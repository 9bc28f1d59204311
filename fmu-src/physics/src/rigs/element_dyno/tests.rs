use std::f64::consts::TAU;

use strut_model::Value;

use super::*;
use crate::testing::Bench;

type Dyno = Bench<ElementDyno>;

/// The force at a position and a velocity of the lower end.
fn force(dyno: &mut Dyno, position: f64, velocity: f64) -> f64 {
    dyno.set("motion.position", position);
    dyno.set("motion.velocity", velocity);
    dyno.get("force")
}

/// Half the width of the hysteresis of a triangle of 2 mm/s, and the mean slope of its two branches.
fn triangle(dyno: &mut Dyno) -> (f64, f64) {
    let positions: Vec<f64> = (-40..=40).map(|k| f64::from(k) * 1e-3).collect();
    let up: Vec<f64> = positions.iter().map(|x| force(dyno, *x, 2e-3)).collect();
    let down: Vec<f64> = positions.iter().map(|x| force(dyno, *x, -2e-3)).collect();
    let half_widths: Vec<f64> = up.iter().zip(&down).map(|(up, down)| 0.5 * (up - down)).collect();
    assert!(half_widths.iter().all(|width| (width - half_widths[0]).abs() < 1e-9));
    (half_widths[0], 0.5 * (up[80] - up[0] + down[80] - down[0]) / 0.08)
}

#[test]
fn a_slow_triangle_shows_94_newtons_of_friction_and_the_spring_rate() {
    let mut dyno = Dyno::published("TumStrutDyno").initialized();
    let (half_width, rate) = triangle(&mut dyno);
    // The damper adds 2 mm/s times the mean of its rates.
    assert!((half_width - 94.0 - 2e-3 * 757.5).abs() < 0.01, "{half_width}");
    assert!((rate - 8250.0).abs() < 1e-6, "{rate}");
}

#[test]
fn the_printed_k_f_would_show_a_quarter_of_the_friction() {
    let mut dyno = Dyno::published("TumStrutDyno")
        .start("strut.coulomb.velocity", 1.0 / 125.0)
        .start("strut.damping", 0.0)
        .initialized();
    let (half_width, _) = triangle(&mut dyno);
    assert!((half_width / 94.0 - 0.245).abs() < 5e-4, "{half_width}");
    // What the note says: 99 % need 1320 s/m.
    let mut dyno = Dyno::published("TumStrutDyno")
        .start("strut.coulomb.velocity", 1.0 / 1320.0)
        .start("strut.damping", 0.0)
        .initialized();
    assert!((triangle(&mut dyno).0 / 94.0 - 0.99).abs() < 5e-4);
}

#[test]
fn a_coil_sets_damping_and_yield_force_by_its_current_or_its_voltage() {
    let dyno = |by: ControlledBy| {
        Dyno::new()
            .choose("controlled_by", Value::Integer(by as i32 + 1))
            .start("strut.damping", 1000.0)
            .start("strut.yield.velocity", 1e-3)
            .start("control.rated_current", 2.0)
            .start("control.rated_voltage", 5.0)
            .start("control.damping", 500.0)
            .start("control.yield_force", 300.0)
            .start("control.arrived", 0.4)
            .initialized()
    };
    // Moved up by 0.1 m/s; 1 A of 2 A, and -2 V of 5 V.
    for (by, expected) in [
        (ControlledBy::Nothing, 100.0),
        (ControlledBy::Current, 100.0 + 0.5 * (50.0 + 300.0)),
        (ControlledBy::Voltage, 100.0 + 0.4 * (50.0 + 300.0)),
    ] {
        let mut dyno = dyno(by);
        dyno.set("control.current", 1.0);
        dyno.set("control.voltage", -2.0);
        let found = force(&mut dyno, 0.0, 0.1);
        assert!((found - expected).abs() < 1e-9, "{by:?}: {found}");
    }
}

#[test]
fn a_chirp_shows_both_rates_of_the_damper() {
    let mut dyno = Dyno::published("TumStrutDyno").initialized();
    let (mut compression, mut rebound) = (Vec::new(), Vec::new());
    for k in 0..20_000 {
        // 20 mm, 0 to 5 Hz in 20 s.
        let t = f64::from(k) * 1e-3;
        let (position, velocity) =
            (0.02 * (TAU * 0.125 * t * t).sin(), 0.02 * TAU * 0.25 * t * (TAU * 0.125 * t * t).cos());
        let damper = force(&mut dyno, position, velocity) - 8250.0 * position;
        if velocity > 0.05 {
            compression.push((velocity, damper));
        } else if velocity < -0.05 {
            rebound.push((velocity, damper));
        }
    }
    for (points, rate) in [(compression, 521.0), (rebound, 994.0)] {
        let found = slope(&points);
        assert!((found / rate - 1.0).abs() < 1e-3, "{found}");
    }
}

/// Slope of the straight line nearest to points.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn the_tyre_is_the_polynomial_of_table_7_and_its_linearisation_that_of_the_text() {
    let mut dyno = Dyno::published("TumTireDyno").initialized();
    for position in [-8e-3, -1e-3, 0.0, 2e-3, 9e-3] {
        let exact = 149_693.0 * position + 3.94e6 * position * position;
        assert!((force(&mut dyno, position, 0.0) - exact).abs() < 1e-9, "{position}");
    }
    let mut rate = |x: f64| (force(&mut dyno, x + 1e-6, 0.0) - force(&mut dyno, x - 1e-6, 0.0)) / 2e-6;
    assert!((rate(0.0) - 149_693.0).abs() < 0.1);
    assert!((rate(0.316e-3) - 152_186.0).abs() < 5.0);
}

#[test]
fn a_plate_that_falls_away_leaves_the_tyre_behind() {
    let mut dyno = Dyno::published("TumTireDyno").initialized();
    let load = 113.48 * crate::GRAVITY;
    assert!((force(&mut dyno, -0.03, 0.0) + load).abs() < 1e-9);
    let mut tied =
        Dyno::published("TumTireDyno").choose("tire.lift_off", Value::Boolean(false)).initialized();
    assert!(force(&mut tied, -0.03, 0.0) > -load);
}

#[test]
fn a_tyre_that_never_leaves_is_refused_if_it_is_the_tyre() {
    let with = |element| {
        Dyno::new()
            .choose("element", Value::Integer(element))
            .start("tire.quadratic", 1e7)
            .initialize()
            .map_err(|error| error.to_string())
    };
    assert_eq!(with(1), Ok(()));
    let error = with(2).unwrap_err();
    assert!(error.contains("tire.quadratic = 10000000 N/m2"), "{error}");
}

#[test]
fn presliding_friction_builds_up_over_the_way_after_a_reversal() {
    let mut dyno = Dyno::new()
        .start("strut.damping", 0.0)
        .start("hysteresis.presliding.force", 60.0)
        .start("hysteresis.presliding.stiffness", 1e5)
        .initialized();
    // Down, so that the strut is drawn out: 1.2 mm in 60 ms; then up again as far.
    dyno.set("motion.velocity", -0.02);
    dyno.step(0.06);
    let first = 60.0 * (1.0 - (-2.0_f64).exp());
    assert!((dyno.get("force") + first).abs() < 1e-4, "{}", dyno.get("force"));
    dyno.set("motion.velocity", 0.02);
    dyno.step(0.06);
    let second = 60.0 - (60.0 + first) * (-2.0_f64).exp();
    assert!((dyno.get("force") - second).abs() < 1e-4, "{}", dyno.get("force"));
}

#[test]
fn a_maxwell_branch_relaxes_and_a_preload_does_not() {
    let mut dyno = Dyno::new()
        .start("strut.damping", 0.0)
        .start("strut.preload", 110.0)
        .start("hysteresis.maxwell.stiffness", 2e4)
        .start("hysteresis.maxwell.time", 0.01)
        .initialized();
    dyno.set("motion.velocity", 0.1);
    dyno.step(0.01);
    dyno.set("motion.velocity", 0.0);
    let shed = 2e4 * 0.1 * 0.01 * (1.0 - (-1.0_f64).exp());
    assert!((dyno.get("force") - (shed - 110.0)).abs() < 1e-4, "{}", dyno.get("force"));
    dyno.step(0.2);
    assert!((dyno.get("force") + 110.0).abs() < 1e-4);
}

#[test]
fn a_preload_shows_as_the_element_s_own_force() {
    for (set, port, expected) in
        [("TumStrutDyno", "strut.preload", -10.0), ("TumTireDyno", "tire.preload", 10.0)]
    {
        let mut loaded = Dyno::published(set).start(port, 10.0).initialized();
        let mut neutral = Dyno::published(set).initialized();
        let change = force(&mut loaded, 2e-3, 0.1) - force(&mut neutral, 2e-3, 0.1);
        assert!((change - expected).abs() < 1e-9, "{port}: {change}");
    }
}

#[test]
fn a_tyre_has_none_of_the_strut_s_memory() {
    let mut dyno = Dyno::published("TumTireDyno").start("hysteresis.maxwell.stiffness", 2e4).initialized();
    let tyre = force(&mut dyno, 1e-3, 0.1);
    dyno.step(0.01);
    assert_eq!(dyno.get("hysteresis.maxwell.deflection"), 0.0);
    assert_eq!(dyno.get("force"), tyre);
}

proptest::proptest! {
    #[test]
    fn neither_element_brings_energy_in(x in -0.008..0.04_f64, v in -2.0..2.0_f64) {
        for set in ["TumStrutDyno", "TumTireDyno"] {
            let mut dyno = Dyno::published(set).initialized();
            let dissipated = (force(&mut dyno, x, v) - force(&mut dyno, x, 0.0)) * v;
            proptest::prop_assert!(dissipated >= 0.0);
        }
    }
}
