use proptest::prelude::*;
use strut_model::{Bundle, Declarations};

use super::*;

fn servo() -> PneumaticServo<f64> {
    let declared = Declarations::of::<PneumaticServo<f64>>();
    Bundle::from_fn(|i| declared[i].start)
}

#[test]
fn a_choked_edge_passes_its_conductance_times_the_pressure_before_it() {
    // 1e-8 m3/(s.Pa) and 7 bar are 7 l/s, as below a ratio of 0.3 nothing behind the edge matters.
    for behind in [1e3, 1e5, 2.1e5] {
        let flows = servo().flows(1.0, &Pressures { a: behind, b: 3e5 });
        assert!((flows.a - 7e-3).abs() < 1e-15 && flows.supply == flows.a, "{flows:?}");
    }
}

#[test]
fn subsonic_flow_is_that_of_the_ellipse() {
    // ISO 6358-1:2013 with b = 0.3 at a ratio of 0.65: sqrt(1 - 0.25) of the choked flow.
    let flows = servo().flows(1.0, &Pressures { a: 0.65 * 7e5, b: 3e5 });
    assert!((flows.a / 7e-3 - 0.75_f64.sqrt()).abs() < 1e-12, "{flows:?}");
}

#[test]
fn a_positive_opening_fills_chamber_a_and_a_negative_one_chamber_b() {
    let at = Pressures { a: 3e5, b: 3e5 };
    let (to_a, to_b) = (servo().flows(0.5, &at), servo().flows(-0.5, &at));
    assert!(to_a.a > 0.0 && to_a.b < 0.0);
    assert_eq!((to_a.a, to_a.b, to_a.supply), (to_b.b, to_b.a, to_b.supply));
    assert_eq!(servo().flows(0.0, &at), AirFlows { a: 0.0, b: 0.0, leak: 0.0, supply: 0.0 });
}

#[test]
fn air_leaks_to_the_chamber_of_the_lower_pressure() {
    let mut servo = servo();
    servo.cylinder.leakage = 1e-11;
    let at = Pressures { a: 5e5, b: 2e5 };
    let flows = servo.flows(0.0, &at);
    assert!((flows.leak - 3e-6).abs() < 1e-18, "{flows:?}");
    // In chamber B it counts 1.4 times, over the volume of half the stroke.
    let rates = servo.pressure_rates(&flows, &at, 0.0, 0.0);
    assert!((rates.a + 0.3 / (2e-5 + 8.042e-5)).abs() < 1e-6, "{rates:?}");
    assert!((rates.b - 1.4 * 0.3 / (2e-5 + 6.911e-5)).abs() < 1e-6, "{rates:?}");
}

#[test]
fn overlap_keeps_the_valve_closed() {
    let mut servo = servo();
    servo.spool.overlap = 0.05;
    assert_eq!(servo.opening(0.04, 0.0).0, 0.0);
    assert!((servo.opening(-0.25, 0.0).0 + 0.2).abs() < 1e-15);
}

#[test]
fn the_spool_stops_at_the_ends_of_its_stroke() {
    assert_eq!(servo().spool_rate(5.0, 1.0), 0.0);
    assert_eq!(servo().spool_rate(50.0, 1.0), 0.0);
    assert!((servo().spool_rate(2.5, 0.0) - 100.0).abs() < 1e-12);
}

#[test]
fn at_the_ambient_pressure_the_air_does_not_push() {
    let at = Pressures { a: AMBIENT_PRESSURE, b: AMBIENT_PRESSURE };
    assert!(servo().force(&at).abs() < 1e-12);
    // One bar more in chamber A: 1e5 Pa times 8.042e-4 m2.
    assert!((servo().force(&Pressures { a: at.a + 1e5, ..at }) - 80.42).abs() < 1e-10);
}

#[test]
fn what_does_not_go_together_is_refused() {
    assert_eq!(servo().check("actuator."), Ok(()));
    let mut thick = servo();
    thick.cylinder.rod_area = 9e-4;
    assert!(
        thick
            .check("actuator.")
            .unwrap_err()
            .starts_with("actuator.cylinder.rod_area = 0.0009 m2 must be smaller")
    );
    let mut blocked = servo();
    blocked.supply.exhaust_pressure = 8e5;
    assert!(blocked.check("").unwrap_err().starts_with("supply.exhaust_pressure = 800000 Pa"));
}

proptest! {
    /// Without any flow, p V^α stays as it is while the piston moves: p'/p + α V'/V = 0.
    #[test]
    fn a_closed_chamber_is_polytropic(x in -0.09..0.09_f64, v in -1.0..1.0_f64, a in 1e5..7e5_f64, b in 1e5..7e5_f64) {
        let servo = servo();
        let still = AirFlows { a: 0.0, b: 0.0, leak: 0.0, supply: 0.0 };
        let rates = servo.pressure_rates(&still, &Pressures { a, b }, x, v);
        let volume_a = 2e-5 + 8.042e-4 * (0.1 + x);
        let volume_b = 2e-5 + 6.911e-4 * (0.1 - x);
        prop_assert!((rates.a / a + 1.2 * 8.042e-4 * v / volume_a).abs() < 1e-9);
        prop_assert!((rates.b / b - 1.2 * 6.911e-4 * v / volume_b).abs() < 1e-9);
    }

    /// Air flows from the higher pressure to the lower one, the more the further they are apart.
    #[test]
    fn flow_goes_downhill(before in 1e5..8e5_f64, behind in 1e5..8e5_f64, less in 0.5..1.0_f64) {
        let servo = servo();
        let flow = servo.through(before, behind);
        prop_assert!(flow * (before - behind) >= 0.0);
        prop_assert_eq!(flow, -servo.through(behind, before));
        prop_assert!(servo.through(before, behind * less) >= flow - 1e-9 * before);
    }
}
