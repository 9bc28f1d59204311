use super::*;
use crate::Plant;
use crate::excitation::multisine;
use crate::friction::Limit;
use crate::rig::{Rig, start};

fn cylinder() -> Pneumatic {
    Rig::new(Plant::PneumaticCylinder, &start(Plant::PneumaticCylinder)).pneumatic
}

/// As heavy as if it was blocked, or moved by somebody else.
fn held() -> Pneumatic {
    Pneumatic { mass: 1e12, ..cylinder() }
}

/// The states from one on, for some seconds, under a command over time.
fn states(of: &Pneumatic, from: State, seconds: f64, command: impl Fn(f64) -> f64) -> Vec<State> {
    let mut friction = vec![0.0; of.contacts.len()];
    let mut all = vec![from];
    for k in 0..(seconds * RATE).round() as usize {
        let (state, command) = (all[k], command(k as f64 / RATE));
        let first = of.rates(&state, command, friction.iter().sum());
        all.push(of.advanced(&state, &first, command, &mut friction));
    }
    all
}

fn last(of: &Pneumatic, from: State, seconds: f64, volts: f64) -> State {
    *states(of, from, seconds, |_| volts).last().unwrap()
}

/// 1e-8 m³/(s Pa) · 7 bar · 100 kPa/(287 J/(kg K) · 293.15 K) = 8.32005 g/s.
#[test]
fn a_flow_is_choked_up_to_its_critical_ratio_and_laminar_near_one() {
    let of = cylinder();
    for (opening, down, due) in [
        (1.0, 1.013e5, 8.320_05e-3),
        (1.0, 2.1e5, 8.320_05e-3),
        (0.5, 2.1e5, 4.160_03e-3),
        // Half of the way to equal pressures: √(1 − ¼).
        (1.0, 4.55e5, 7.205_38e-3),
        (1.0, 7e5, 0.0),
    ] {
        let flow = of.edge(opening, 7e5, down);
        assert!((flow - due).abs() < 1e-8, "{flow} kg/s for {due} kg/s");
        assert_eq!(of.edge(opening, down, 7e5), -flow);
    }
    // ψ(0.999) = √(1 − (0.699/0.7)²) = 0.053433; halfway from there to one it is half as large.
    let [ends, half] = [0.999, 0.9995].map(|ratio| of.edge(1.0, 7e5, 7e5 * ratio));
    assert!((ends / 8.320_05e-3 - 0.053_433).abs() < 1e-6 && (half / ends - 0.5).abs() < 1e-9);
    let beyond = of.edge(1.0, 7e5, 7e5 * (0.999 + 1e-9));
    assert!((beyond / ends - 1.0).abs() < 1e-5);
}

#[test]
fn rest_stays_rest_under_a_load() {
    let of = Pneumatic { load: 50.0, ..cylinder() };
    let motion = of.run(&Profile::still(), &Profile::still(), 1.0);
    for (name, rest) in [("position", 0.0), ("valve.voltage", 0.0), ("chamber_a.pressure", 5.4e5)] {
        let away = motion.signals[name].iter().fold(0.0_f64, |most, x| most.max((x - rest).abs()));
        assert!(away < 1e-9, "{name}: {away}");
    }
    let force = 5.4e5 * 8.042_477e-4 - of.still()[3] * 6.911_504e-4 - 1.013e5 * 1.130_973e-4;
    assert!((force - 50.0).abs() < 1e-3, "{force} N");
}

/// From 100.425 to 140.637 cm³ at 5 cm: 0.714070^1.2 · 5.4 bar.
#[test]
fn a_shut_valve_keeps_the_air() {
    let [_, _, one, other, _] = held().still();
    let moved = last(&held(), [0.0, 0.1, one, other, 0.0], 0.5, 0.0);
    assert!((moved[0] - 0.05).abs() < 1e-9 && (moved[2] - 360_481.0).abs() < 10.0, "{} Pa", moved[2]);
    // From 89.115 to 54.557 cm³.
    assert!((moved[3] / other - 1.801_75).abs() < 1e-4, "{} Pa", moved[3]);
}

/// The mass swings on the air in both chambers, and loses nothing.
#[test]
fn a_mass_on_shut_chambers_keeps_its_energy() {
    let of = Pneumatic { damping: 0.0, load: 30.0, ..cylinder() };
    let mut from = of.still();
    from[1] = 0.8;
    let energy = |state: &State| {
        let [one, other] = of.volumes(state[0]);
        let air = (state[2] * one + state[3] * other) / (EXPANSION - 1.0);
        air + 4.0 * state[1] * state[1] + ((of.areas[0] - of.areas[1]) * 1.013e5 + 30.0) * state[0]
    };
    let all = states(&of, from, 2.0, |_| 0.0);
    let most = all.iter().fold(0.0_f64, |most, state| most.max(state[0]));
    assert!(most > 0.02, "{most} m");
    for state in &all {
        assert!((energy(state) - energy(&from)).abs() < 1e-6, "{} J", energy(state) - energy(&from));
    }
}

/// What the air brought is in the chambers and the mass, or was lost in the guide.
#[test]
fn the_energy_balance_closes() {
    let contacts = vec![Contact { along: [1.0, 0.0], limit: Limit::Coulomb(30.0) }];
    let of = Pneumatic { contacts, load: 20.0, leakage: 2e-9 / DENSITY, overlap: 0.03, ..cylinder() };
    let stored = |state: &State| {
        let [one, other] = of.volumes(state[0]);
        let air = (state[2] * one + state[3] * other) / 0.2;
        air + 4.0 * state[1] * state[1] + ((of.areas[0] - of.areas[1]) * 1.013e5 + 20.0) * state[0]
    };
    let powers = |state: &State| {
        let opening = state[4] - state[4].clamp(-0.03, 0.03);
        let leak = 2e-9 * (state[2] - state[3]);
        let flows = [of.inflow(opening, state[2]), -leak, of.inflow(-opening, state[3]), leak];
        let brought = flows.map(|flow| 287.0 * 293.15 / 0.2 * flow * if flow > 0.0 { 1.4 } else { 1.0 });
        (brought.iter().sum::<f64>(), 40.0 * state[1].powi(2) + 30.0 * state[1].abs())
    };
    let all = states(&of, of.still(), 3.0, |t| (2.0 * PI * 2.0 * t).cos());
    assert!(all.iter().all(|state| state[0].abs() < 0.1), "it stays within its stroke");
    let sum = |of: &dyn Fn(&State) -> f64| -> f64 {
        all.windows(2).map(|pair| 0.5 * (of(&pair[0]) + of(&pair[1])) / RATE).sum()
    };
    let (brought, lost) = (sum(&|it| powers(it).0), sum(&|it| powers(it).1));
    let gained = stored(all.last().unwrap()) - stored(&all[0]);
    assert!(lost > 10.0, "{lost} J");
    let missing = brought - lost - gained;
    assert!(missing.abs() < 1e-3 * lost, "{brought} J brought, {lost} J lost, {gained} J stored");
}

/// 1.4 · 100 kPa · C · 7 bar/V_A = 97.585 bar/s into chamber A; out of chamber B e^(−t/89.115 ms), with V_B/(100 kPa · C).
#[test]
fn chambers_fill_and_empty_at_the_choked_rate() {
    let from = [0.0, 0.0, 1.013e5, 6e5, 1.0];
    let filled = last(&held(), from, 0.01, 5.0);
    assert!((filled[2] - 1.013e5 - 97_585.5).abs() < 5.0, "{} Pa", filled[2]);
    let emptied = last(&held(), from, 0.04, 5.0);
    assert!((emptied[3] - 383_010.0).abs() < 20.0, "{} Pa", emptied[3]);
}

#[test]
fn an_open_valve_brings_one_chamber_to_the_supply_and_the_other_to_the_air() {
    for (volts, one, other) in [(5.0, 7e5, 1.013e5), (-5.0, 1.013e5, 7e5), (9.0, 7e5, 1.013e5)] {
        let end = last(&held(), held().still(), 3.0, volts);
        assert!((end[2] - one).abs() < 1.0 && (end[3] - other).abs() < 1.0, "{end:?}");
        assert!((end[4] - volts.signum()).abs() < 1e-9, "no more than fully open: {}", end[4]);
    }
}

/// R T K (1.4/V_A + 1/V_B) = 21.170/s: what flows in counts 1.4 times.
#[test]
fn a_leak_makes_the_pressures_equal() {
    let of = Pneumatic { leakage: 1e-8 / DENSITY, ..held() };
    let from = of.still();
    let apart = |state: &State| state[3] - state[2];
    let later = last(&of, from, 0.05, 0.0);
    let share = apart(&later) / apart(&from);
    assert!((share - (-0.05_f64 * 21.170).exp()).abs() < 1e-4, "{share}");
    assert!(apart(&last(&of, from, 2.0, 0.0)).abs() < 1.0);
    // With the valve open to one side it has to feed the leak.
    let fed = last(&of, from, 5.0, 5.0);
    let leak = 1e-8 * (fed[2] - fed[3]);
    let [into, out] = [of.inflow(1.0, fed[2]), of.inflow(-1.0, fed[3])];
    assert!((1.4 * into - leak).abs() < 1e-8 && (out + 1.4 * leak).abs() < 1e-8, "{into} {out} {leak}");
}

#[test]
fn the_opening_lags_behind_the_command_and_does_nothing_within_its_overlap() {
    let of = Pneumatic { overlap: 0.04, ..held() };
    let opened = last(&of, of.still(), 0.005, 1.0);
    assert!((opened[4] - 0.2 * (1.0 - (-1.0_f64).exp())).abs() < 1e-8, "{}", opened[4]);
    let rate = |of: &Pneumatic, opening: f64| of.rates(&[0.0, 0.0, 5e5, 5e5, opening], 0.0, 0.0);
    assert_eq!(rate(&of, 0.03)[2..4], [0.0; 2]);
    for (wide, narrow) in [(0.10, 0.06), (-0.10, -0.06)] {
        let (one, other) = (rate(&of, wide), rate(&held(), narrow));
        assert!((one[2] - other[2]).abs() < 1e-6 && one[2] * wide > 0.0 && one[3] * wide < 0.0);
    }
}

#[test]
fn friction_holds_the_mass_up_to_its_limit() {
    let contacts = vec![Contact { along: [1.0, 0.0], limit: Limit::Coulomb(40.0) }];
    let of = Pneumatic { contacts, ..cylinder() };
    let moved = |force: f64| {
        let mut from = of.still();
        from[2] += force / of.areas[0];
        states(&of, from, 0.5, |_| 0.0).iter().fold(0.0_f64, |most, state| most.max(state[0].abs()))
    };
    assert!(moved(39.0) < 1e-12 && moved(45.0) > 1e-4, "{} m, {} m", moved(39.0), moved(45.0));
}

#[test]
fn the_loop_follows_and_keeps_within_its_limits() {
    let motion = cylinder().run(&Profile::new(6.0, |_| 0.03), &Profile::still(), 6.0);
    let x = &motion.signals["position"];
    assert!(x.iter().all(|x| *x < 0.033), "it hardly swings over");
    assert!((x[60_000] - 0.03).abs() < 1e-3 && (x[120_000] - 0.03).abs() < 1e-4, "{} m", x[60_000]);
    let strong = multisine(&mut Random::new(3, "test"), 2.0, 0.0, 30.0);
    let motion = Pneumatic { mass: 1e6, ..cylinder() }.run(&Profile::still(), &strong, 2.0);
    let most = motion.command.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert_eq!(most, 5.0);
    assert_eq!(motion.signals["valve.voltage"], motion.command);
}

/// 1 kPa for a gram a second: less comes in, and less gets out.
#[test]
fn hoses_and_silencer_resist() {
    let (plain, of) = (cylinder(), Pneumatic { hoses: [1e6, 1e6], ..cylinder() });
    let [into, out] = [1.0, -1.0].map(|opening| of.inflow(opening, 5.4e5) / plain.inflow(opening, 5.4e5));
    assert!((0.97..0.999).contains(&into), "{into}");
    // Choked, the flow does not depend on the pressure behind it.
    assert_eq!(out, 1.0);
    assert!(of.inflow(-1.0, 1.2e5) / plain.inflow(-1.0, 1.2e5) < 0.999);
}
