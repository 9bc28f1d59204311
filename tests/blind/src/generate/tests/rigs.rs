//! What the records of other rigs than TUM's hold.

use super::*;

#[test]
fn the_rig_with_a_valve_obeys_newton_and_stays_within_its_stroke() {
    let made = clean(Plant::ServoQuarter, vec![Hidden::new("30")]);
    let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
    assert_eq!(of("actuator.cylinder.leakage"), made.truth.effects[0].parameters[0].value);
    assert!(of("actuator.cylinder.leakage") > 25e-12, "it is enlarged");
    assert_eq!(of("actuator.supply.pressure"), 12e6);
    for table in made.train.iter().chain(&made.test) {
        let column = |name| table.column(name).unwrap();
        for (k, force) in column("wheel.force").iter().enumerate() {
            let inertia = of("sprung_mass") * column("body.acceleration")[k]
                + of("unsprung_mass") * column("wheel.acceleration")[k];
            assert!((inertia - force).abs() < 1e-7, "{inertia} N, {force} N");
            assert!(column("suspension.deflection")[k].abs() < 0.03, "{}", table.name);
        }
    }
}

#[test]
fn the_drives_record_holds_the_resistance() {
    let made = clean(Plant::LinearDrive, vec![Hidden::new("33g")]);
    let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
    let load = made.truth.effects[0].parameters[0].value;
    assert_eq!(made.truth.oracle, Oracle::default());
    for table in made.train.iter().chain(&made.test) {
        let (force, x) = (table.column("force").unwrap(), table.column("position").unwrap());
        // The momentum's balance over whole stretches: no derivative of the position but at their ends.
        for (a, b) in [(1000, 3000), (2000, 5500)] {
            let velocity = |k: usize| (x[k + 1] - x[k - 1]) * 500.0;
            let impulse: f64 =
                (a + 1..b).map(|k| force[k] * 1e-3).sum::<f64>() + (force[a] + force[b]) * 5e-4;
            let due = of("moving_mass") * (velocity(b) - velocity(a))
                + of("guide.damping") * (x[b] - x[a])
                + load * (b - a) as f64 * 1e-3;
            assert!((impulse - due).abs() < 0.02 * load.abs(), "{}: {impulse} N s for {due} N s", table.name);
        }
    }
}

/// The balance of the forces on the mass is in every record: motor, spring, guide, and what is hidden.
#[test]
fn a_mass_on_a_spring_obeys_newton() {
    let made = clean(Plant::GuidedMass, vec![Hidden::new("08n")]);
    let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
    assert_eq!(of("ground_spring.stiffness"), 6000.0, "it was measured before");
    let cubic = made.truth.effects[0].parameters[0].value;
    for table in made.train.iter().chain(&made.test) {
        let [force, x, a] = ["force", "position", "acceleration"].map(|name| table.column(name).unwrap());
        let mut largest = 0.0_f64;
        for k in 10..force.len() - 10 {
            let velocity = (x[k + 1] - x[k - 1]) * 500.0;
            let held = of("ground_spring.stiffness") * x[k] + cubic * x[k].powi(3);
            let due = of("moving_mass") * a[k] + of("guide.damping") * velocity + held;
            // Central differences are a little slow, and the filter takes the cube of what it sees as it is.
            assert!(
                (force[k] - due).abs() < 0.02 * rms(force) + 0.1,
                "{}: {} N for {due} N",
                table.name,
                force[k]
            );
            largest = largest.max(cubic * x[k].abs().powi(3));
        }
        assert!(largest > 0.1 * rms(force), "{}: {largest} N", table.name);
    }
    let sound = clean(Plant::GuidedMass, vec![]);
    for left in &sound.truth.oracle.exact {
        assert!(left.value < 1e-9, "{} of {}", left.value, left.name);
    }
}

fn rest_of(table: &Table, name: &str) -> f64 {
    table.column(name).unwrap()[0]
}

/// A gas that was charged otherwise is at that pressure from the beginning, and rests without a force.
#[test]
fn the_pump_actuator_starts_at_its_charge_pressure() {
    let made = clean(Plant::PumpDyno, vec![Hidden::new("32a")]);
    let charge = made.truth.base.iter().find(|value| value.name == "gas.charge_pressure").unwrap().value;
    assert_eq!(charge, made.truth.effects[0].parameters[0].value);
    assert!(charge < 2.75e6, "{charge} Pa");
    for table in made.train.iter().chain(&made.test) {
        for (name, rest) in [("pressure.compression", charge), ("pressure.rebound", charge), ("force", 0.0)] {
            assert!((rest_of(table, name) - rest).abs() < 1e-6 * charge, "{name}: {}", rest_of(table, name));
        }
        let least = table.column("pressure.rebound").unwrap().iter().fold(f64::INFINITY, |a, b| a.min(*b));
        assert!(least > 1e6, "{}: {least} Pa", table.name);
    }
}

#[test]
fn another_characteristic_is_told_point_by_point() {
    let (sound, made) = (clean(Plant::PumpDyno, vec![]), clean(Plant::PumpDyno, vec![Hidden::new("32b")]));
    let factor = made.truth.effects[0].parameters[0].value;
    for (before, after) in sound.truth.base.iter().zip(&made.truth.base) {
        let due = if before.table() == "valve.rebound.pressure_drop" { factor } else { 1.0 };
        assert_eq!(after.value, due * before.value, "{}", after.name);
    }
}

/// Newton's law of the body arm, in the record: Kogut eq. 13.
#[test]
fn the_sum_of_the_torques_on_the_body_arm_is_in_the_record() {
    let made = clean(Plant::SasRig, vec![Hidden::new("19p")]);
    let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
    let (one, other) = (of("spring.wheel_arm_mount"), of("spring.body_arm_mount"));
    for table in made.train.iter().chain(&made.test) {
        assert!((rest_of(table, "eccentric.height") - 0.04).abs() < 1e-12);
        let column = |name| table.column(name).unwrap();
        let size = rms(column("body_arm.acceleration"));
        for (k, acceleration) in column("body_arm.acceleration").iter().enumerate() {
            let angle = column("body_arm.angle")[k];
            let square = one * one + other * other - 2.0 * one * other * column("relative.angle")[k].cos();
            let spring = of("spring.stiffness") * (of("spring.free_length") - square.sqrt());
            let torque = spring * other - of("body_arm.gravity_moment") * angle.cos();
            let due = (torque - column("brake.torque")[k]) / of("body_arm.inertia");
            // The filter takes what is linear as it is, and little of the rest.
            assert!(
                (acceleration - due).abs() < 1e-3 * size,
                "{acceleration} rad/s² for {due} rad/s² at {k}"
            );
        }
    }
}

/// The balance of the forces on a cylinder's mass, in the record, and what its loop keeps it within.
#[test]
fn a_cylinders_mass_obeys_newton_within_its_stroke() {
    for id in ["15c", "28c", "30c"] {
        let made = clean(Plant::PneumaticCylinder, vec![Hidden::new(id)]);
        let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
        let told = &made.truth.effects[0].parameters[0];
        if id == "15c" {
            assert!(of("guide.damping") == told.value && (told.value / 40.0 - 1.0).abs() > 0.2);
        } else {
            assert!(
                ["actuator.spool.overlap", "actuator.cylinder.leakage"].contains(&told.name.as_str()),
                "{}",
                told.name
            );
        }
        for table in made.train.iter().chain(&made.test) {
            let names = ["position", "acceleration", "chamber_a.pressure", "chamber_b.pressure"];
            let [x, a, one, other] = names.map(|name| table.column(name).unwrap());
            assert!(table.column("valve.voltage").unwrap().iter().all(|volts| volts.abs() <= 5.1));
            for k in 10..x.len() - 10 {
                assert!(x[k].abs() < 0.09, "{}: {} m", table.name, x[k]);
                let inside = |pressure: f64| (1.013e5..7.1e5).contains(&pressure);
                assert!(inside(one[k]) && inside(other[k]), "{}: {} Pa, {} Pa", table.name, one[k], other[k]);
                let push = 8.042_477e-4 * one[k] - 6.911_504e-4 * other[k] - 1.130_973e-4 * 1.013e5;
                // Central differences are a little slow.
                let resisted = of("moving_mass") * a[k] + of("guide.damping") * (x[k + 1] - x[k - 1]) * 500.0;
                assert!((push - resisted).abs() < 0.1, "{}: {push} N, {resisted} N at {k}", table.name);
            }
        }
    }
}

/// What the brake or the motor does to its command is told as a fault of that signal, of a gain the change.
#[test]
fn a_command_that_no_actuator_takes_has_the_fault_itself() {
    for (plant, command) in [(Plant::PumpDyno, "motor.torque"), (Plant::SasRig, "brake.torque")] {
        let told = |id: &str| clean(plant, vec![Hidden::new(id)]).truth.effects[0].parameters[0].clone();
        let (delay, gain) = (told("23"), told("25"));
        assert_eq!([delay.name, gain.name], [format!("{command}.delay"), format!("{command}.gain")]);
        assert!(
            delay.value > 3e-3 && (0.05..0.3).contains(&gain.value.abs()),
            "{} {}",
            delay.value,
            gain.value
        );
    }
}

/// Who knows all is off by nothing: a command that answers the motion, and a height that does not begin at zero, too.
#[test]
fn an_oracle_of_another_rig_leaves_nothing() {
    for (plant, id) in [
        (Plant::PumpDyno, "30p"),
        (Plant::PumpDyno, "23"),
        (Plant::SasRig, "01p"),
        (Plant::SasRig, "25"),
        (Plant::PneumaticCylinder, "28c"),
    ] {
        let made = clean(plant, vec![Hidden::new(id)]);
        for left in &made.truth.oracle.exact {
            let all = made.test.iter().map(|table| swing(table.column(&left.name).unwrap()));
            let size = all.fold(0.0, f64::max);
            assert!(left.value < 1e-3 * size, "{plant:?} {id}: {} of {}, {size}", left.value, left.name);
        }
        let recorded = made
            .truth
            .oracle
            .recorded
            .iter()
            .find(|left| left.name.ends_with("angle") || ["force", "position"].contains(&&*left.name));
        let size = swing(made.test[0].column(&recorded.unwrap().name).unwrap());
        assert!(recorded.unwrap().value < 0.01 * size, "{plant:?} {id}: {recorded:?} of {size}");
    }
}
