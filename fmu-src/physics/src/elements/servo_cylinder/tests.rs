use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Bundle, Declarations};

use super::*;

fn declared<R: Real>() -> ServoCylinder<R> {
    let declared = Declarations::of::<ServoCylinder<f64>>();
    Bundle::from_fn(|i| R::from(declared[i].start))
}

fn flow(law: ValveLaw, position: f64, pressure: f64) -> Flow<f64> {
    let cylinder = declared::<f64>();
    cylinder.flow(law, &cylinder.hydraulics(), position, pressure)
}

/// Flow and its slopes by spool position and by pressure.
fn slopes(law: ValveLaw, position: f64, pressure: f64) -> [f64; 3] {
    let cylinder = declared::<Dual64>();
    let hydraulics = cylinder.hydraulics();
    let [by_position, by_pressure] = [(1.0, 0.0), (0.0, 1.0)].map(|(u, p)| {
        cylinder.flow(law, &hydraulics, Dual64::new(position, u), Dual64::new(pressure, p)).load
    });
    [by_position.re, by_position.eps, by_pressure.eps]
}

#[test]
fn coefficients_are_those_of_the_document_but_for_a_power_of_ten() {
    let hydraulics = declared::<f64>().hydraulics();
    assert!((hydraulics.coefficient / 44.4495e12 - 1.0).abs() < 1e-6);
    // 40 mm piston on a 25 mm rod over a stroke of 60 mm: V_t as printed, A_a but for 3e-5.
    let ring = std::f64::consts::PI / 4.0 * (0.04_f64.powi(2) - 0.025_f64.powi(2));
    assert!((ring * 0.06 / 45.9458e-6 - 1.0).abs() < 1e-6);
    assert!((ring / 0.765_786e-3 - 1.0).abs() > 2e-5);
    // Not printed: what eq. 2.23 gives.
    assert!((hydraulics.coefficient * hydraulics.flow_gain / 4.981_71e13 - 1.0).abs() < 1e-6);
    assert!((hydraulics.stall_force - 9189.4).abs() < 0.1);
}

#[test]
fn the_plane_of_the_regression_is_equation_2_24() {
    let alpha = declared::<f64>().hydraulics().coefficient;
    let plane = declared::<f64>().valve.regression;
    assert!((alpha * plane.flow_gain / 4.666e13 - 1.0).abs() < 1e-5);
    assert!((alpha * plane.pressure_coefficient / 341.2 - 1.0).abs() < 1e-5);
    assert_eq!(flow(ValveLaw::Regression, 0.0, 2e6).load, -2e6 * plane.pressure_coefficient);
    assert_eq!(flow(ValveLaw::Regression, 1e-4, 0.0).load, 1e-4 * plane.flow_gain);
}

/// Least squares of the nonlinear flow times α over points (u_1, P_r) scaled by 0.25 mm and 7 MPa.
fn regression(points: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let alpha = declared::<f64>().hydraulics().coefficient;
    let [mut uu, mut up, mut pp, mut qu, mut qp] = [0.0; 5];
    for (u, p) in points {
        let q = alpha * flow(ValveLaw::Nonlinear, 0.25e-3 * u, 7e6 * p).load;
        (uu, up, pp, qu, qp) = (uu + u * u, up + u * p, pp + p * p, qu + q * u, qp + q * p);
    }
    let determinant = uu * pp - up * up;
    [(qu * pp - qp * up) / determinant / 0.25e-3, (qp * uu - qu * up) / determinant / 7e6]
}

#[test]
fn the_printed_regression_is_not_that_of_equation_2_18() {
    let grid = (0..201)
        .flat_map(|i| (0..201).map(move |j| (f64::from(i - 100) / 100.0, f64::from(j - 100) / 100.0)));
    let sines = (0..100_001).map(|i| {
        let t = f64::from(i) * 2e-3;
        ((1.618 * t).sin(), t.sin())
    });
    for ([gain, pressure], expected) in
        [(regression(grid), [4.905e13, -268.3]), (regression(sines), [4.868e13, -342.6])]
    {
        assert!(
            (gain / expected[0] - 1.0).abs() < 1e-3 && (pressure - expected[1]).abs() < 0.5,
            "{gain} {pressure}"
        );
        assert!((gain / 4.666e13 - 1.0).abs() > 0.04);
    }
}

#[test]
fn the_linear_law_has_the_slopes_of_the_nonlinear_one_at_rest() {
    for position in [0.0, 1e-12, -1e-12] {
        let [_, by_position, by_pressure] = slopes(ValveLaw::Nonlinear, position, 0.0);
        let [_, linear, none] = slopes(ValveLaw::Linear, position, 0.0);
        assert!((by_position / linear - 1.0).abs() < 1e-12 && by_pressure.abs() < 1e-15 && none == 0.0);
    }
}

#[test]
fn at_the_balance_of_pressures_the_slopes_are_finite() {
    let full = 0.5e-3;
    for (position, pressure) in [(full, 12e6), (-full, -12e6), (0.0, 12e6), (0.0, -12e6)] {
        let [flow, by_position, by_pressure] = slopes(ValveLaw::Nonlinear, position, pressure);
        assert_eq!(flow, 0.0);
        // Laminar: the secant to the turbulent flow at 0.1 MPa, k_q u/P_z · sqrt(P_z/0.1 MPa).
        let steepest = 1.120_76 * full / 12e6 * (12.0_f64 / 0.1).sqrt();
        assert!(by_position.is_finite() && by_pressure.abs() <= steepest * 1.001, "{by_pressure} {steepest}");
    }
}

#[test]
fn a_load_above_the_supply_pressure_drives_the_oil_back() {
    let there = flow(ValveLaw::Nonlinear, 0.2e-3, 12e6 - 3e6);
    let back = flow(ValveLaw::Nonlinear, 0.2e-3, 12e6 + 3e6);
    assert!(there.load > 0.0 && (there.load + back.load).abs() < 1e-12 * there.load);
    assert!(back.supply < 0.0);
}

const LAWS: [ValveLaw; 3] = [ValveLaw::Nonlinear, ValveLaw::Linear, ValveLaw::Regression];

proptest! {
    #[test]
    fn the_nonlinear_flow_is_equation_2_9(position in -0.5e-3..0.5e-3_f64, pressure in -11.8e6..11.8e6_f64) {
        let printed = position * 15.708e-3 * 0.611 * ((12e6 - position.signum() * pressure) / 880.0).sqrt();
        let Flow { load, supply } = flow(ValveLaw::Nonlinear, position, pressure);
        prop_assert!((load - printed).abs() <= 1e-12 * printed.abs());
        prop_assert!((supply - printed.abs()).abs() <= 1e-12 * printed.abs());
    }

    #[test]
    fn an_overlap_closes_the_valve_and_takes_so_much_of_every_opening(
        position in -0.5e-3..0.5e-3_f64, pressure in -11.8e6..11.8e6_f64, index in 0..3_usize,
    ) {
        let mut lapped = declared::<f64>();
        lapped.spool.overlap = 0.05e-3;
        let hydraulics = lapped.hydraulics();
        let found = lapped.flow(LAWS[index], &hydraulics, position, pressure);
        let opening = position - position.clamp(-0.05e-3, 0.05e-3);
        prop_assert_eq!(found, flow(LAWS[index], opening, pressure));
        prop_assert_eq!(lapped.flow(ValveLaw::Nonlinear, &hydraulics, 0.04e-3, pressure).load, 0.0);
    }

    #[test]
    fn a_valve_makes_no_energy(position in -0.5e-3..0.5e-3_f64, pressure in -20e6..20e6_f64) {
        // Beyond the supply pressure a law without a root has no bound.
        for law in LAWS.into_iter().filter(|law| *law == ValveLaw::Nonlinear || pressure.abs() <= 12e6) {
            let Flow { load, supply } = flow(law, position, pressure);
            prop_assert!(pressure * load <= 12e6 * supply + 1e-9, "{law:?}");
        }
    }

    #[test]
    fn compressed_oil_takes_what_the_piston_gives_less_the_leakage(
        pressure in -20e6..20e6_f64, velocity in -1.0..1.0_f64, q in -1e-3..1e-3_f64,
    ) {
        let cylinder = declared::<f64>();
        let hydraulics = cylinder.hydraulics();
        let rate = cylinder.pressure_rate(&hydraulics, q, velocity, pressure);
        // d/dt P²/(2 α)
        let stored = pressure * rate / hydraulics.coefficient;
        let given = pressure * q - cylinder.force(pressure) * velocity;
        let leaked = 15e-12 * pressure * pressure;
        prop_assert!((stored - given + leaked).abs() < 1e-9 * (1.0 + given.abs() + leaked));
        let energy = |change: f64| cylinder.energy(&hydraulics, pressure + change);
        // A central difference, exact for a square.
        let slope = (energy(1e5) - energy(-1e5)) / 2e5;
        prop_assert!((slope * rate - stored).abs() < 1e-6 * (1e-3 + stored.abs()));
    }

    #[test]
    fn the_spool_never_passes_its_stop(voltage in -50.0..50.0_f64, position in -0.5e-3..0.5e-3_f64) {
        let cylinder = declared::<f64>();
        prop_assert!(cylinder.spool_rate(voltage, 0.5e-3) <= 0.0);
        prop_assert!(cylinder.spool_rate(voltage, -0.5e-3) >= 0.0);
        // Eq. 2.13 within the stroke.
        if voltage.abs() <= 20.0 {
            let rate = cylinder.spool_rate(voltage, position);
            prop_assert!((2.32e-3 * rate + position - 0.025e-3 * voltage).abs() < 1e-15);
        }
    }
}

#[test]
fn constants_of_the_cylinder_are_added_to_force_and_flow() {
    let mut cylinder = declared::<f64>();
    (cylinder.cylinder.preload, cylinder.cylinder.flow_offset) = (10.0, 2e-6);
    let hydraulics = cylinder.hydraulics();
    // 0.765786e-3 m2 times 1 MPa, less 10 N.
    assert!((cylinder.force(1e6) - 755.786).abs() < 1e-9);
    for law in LAWS {
        let (with, without) = (cylinder.flow(law, &hydraulics, 1e-4, 2e6), flow(law, 1e-4, 2e6));
        assert!((with.load - without.load - 2e-6).abs() < 1e-18 && with.supply == without.supply, "{law:?}");
    }
}

#[test]
fn a_laminar_flow_without_load_is_refused() {
    let mut cylinder = declared::<f64>();
    assert_eq!(cylinder.check("actuator."), Ok(()));
    cylinder.valve.laminar_pressure = 13e6;
    let error = cylinder.check("actuator.").unwrap_err();
    assert!(error.contains("actuator.valve.laminar_pressure = 13000000 Pa"), "{error}");
}
