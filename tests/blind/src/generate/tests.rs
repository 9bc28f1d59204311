mod rigs;

use super::*;
use crate::case::{Hidden, Sensors};
use crate::catalogue::{Entry, Place};

fn short(effects: Vec<Hidden>) -> Case {
    Case { duration: 6.0, ..Case::standard("test", effects, 11) }
}

fn worst_pull(table: &Table) -> f64 {
    table.column("wheel.force").unwrap().iter().fold(0.0_f64, |least, f| least.min(*f))
}

#[test]
fn a_seed_gives_the_same_data_again() {
    let case = short(vec![Hidden::new("01")]);
    let (one, other) = (generate(&case).unwrap(), generate(&case).unwrap());
    assert_eq!(one.train, other.train);
    assert_eq!(one.test, other.test);
    assert_eq!(one.truth, other.truth);
    assert_ne!(one.train, generate(&Case { seed: 12, ..case }).unwrap().train);
}

#[test]
fn tables_have_the_names_of_the_fmu() {
    let heads = |sensors| {
        let made = generate(&Case { sensors, ..short(vec![]) }).unwrap();
        made.train[0].csv().lines().next().unwrap().to_owned()
    };
    let full = "time [s],road.position [m],actuator.force [N],body.acceleration [m/s2],wheel.acceleration [m/s2],\
                suspension.deflection [m],wheel.force [N]";
    assert_eq!(heads(Sensors::Full), full);
    assert_eq!(
        heads(Sensors::Poor),
        "time [s],road.position [m],actuator.force [N],body.acceleration [m/s2],suspension.deflection [m]"
    );
    assert_eq!(
        heads(Sensors::NoRoad),
        full.replace("road.position [m],", "").replace(",wheel.force [N]", "")
    );
}

/// Without effects, noise and clutter the records obey Newton's law with the true masses.
#[test]
fn the_sum_of_the_forces_is_in_the_record() {
    let case = Case { noise_db: None, clutter: 0, ..short(vec![]) };
    let made = generate(&case).unwrap();
    let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
    for table in made.train.iter().chain(&made.test) {
        let column = |name| table.column(name).unwrap();
        let force = column("wheel.force");
        for (k, force) in force.iter().enumerate() {
            let inertia = of("sprung_mass") * column("body.acceleration")[k]
                + of("unsprung_mass") * column("wheel.acceleration")[k];
            assert!((inertia - force).abs() < 1e-8 * (1.0 + rms(column("wheel.force"))), "{inertia} {force}");
        }
    }
}

/// Who knows all but the clutter misses the noise, and with clutter more; who is driven by what was recorded, what the
/// inputs' noise makes of the motion.
#[test]
fn an_oracle_leaves_the_noise_and_the_clutter() {
    let oracle = |clutter| {
        let truth = generate(&Case { clutter, ..short(vec![Hidden::new("01")]) }).unwrap().truth;
        [truth.oracle.exact, truth.oracle.recorded].map(|by| {
            by.iter().zip(&truth.noise).map(|(left, noise)| left.value / noise.value).collect::<Vec<f64>>()
        })
    };
    let ([without, driven], [with, _]) = (oracle(0), oracle(1));
    assert!(without.iter().all(|ratio| (ratio - 1.0).abs() < 0.05), "{without:?}");
    // The deflection, and not the road.
    assert!(with[4] > 3.0 && with[0] < 1.05, "{with:?}");
    // A tyre's force is its stiffness times the road's noise, and more; the body hardly follows.
    assert!(driven[5] > 1.05 && driven[4] < 1.5, "{driven:?}");
}

/// The damper makes force of the motion's noise, which comes on top of the cell's own.
#[test]
fn an_oracle_with_the_recorded_motion_of_a_dyno_makes_force_of_its_noise() {
    let case = Case { plant: Plant::StrutDyno, clutter: 0, ..short(vec![Hidden::new("08")]) };
    let truth = generate(&case).unwrap().truth;
    let of = |name: &str| truth.base.iter().find(|value| value.name == name).unwrap().value;
    let noise = |name: &str| truth.noise.iter().find(|value| value.name == name).unwrap().value;
    let left = |by: &[Value]| by.iter().find(|value| value.name == "force").unwrap().value;
    // Central differences of white noise, straight lines between them, the filter: its power times the integral of
    // sin²(2πf) sinc⁴(πf) over |f| < 0.4, with f in periods per sample.
    let velocity = noise("motion.position") * case.rate * 0.31719_f64.sqrt();
    let due = (of("strut.damping") * velocity).hypot(noise("force"));
    assert!(
        (left(&truth.oracle.recorded) / due - 1.0).abs() < 0.1,
        "{} N for {due} N",
        left(&truth.oracle.recorded)
    );
    assert!((left(&truth.oracle.exact) / noise("force") - 1.0).abs() < 0.05);
}

#[test]
fn the_standstill_shows_the_noise_that_was_asked_for() {
    let made = generate(&Case { duration: 20.0, ..short(vec![]) }).unwrap();
    for noise in &made.truth.noise {
        let columns = made.train.iter().map(|table| table.column(&noise.name).unwrap());
        let mean = columns.clone().map(|all| rms(all).powi(2)).sum::<f64>() / 2.0;
        assert!((mean.sqrt() / noise.value / 100.0 - 1.0).abs() < 0.05, "{}", noise.name);
        // Before the end the anti-alias filter already sees what comes.
        let still: Vec<f64> = columns.flat_map(|all| all[..480].to_vec()).collect();
        assert!((rms(&still) / noise.value - 1.0).abs() < 0.1, "{}", noise.name);
    }
}

#[test]
fn only_lift_off_lifts_off() {
    let lifted = generate(&short(vec![Hidden::new("20")])).unwrap();
    let kept = generate(&short(vec![])).unwrap();
    let of = |name: &str| kept.truth.base.iter().find(|value| value.name == name).unwrap().value;
    let load = (of("sprung_mass") + of("unsprung_mass")) * 9.806_65;
    for table in lifted.train.iter().filter(|table| table.name != "train-sweep") {
        assert!(worst_pull(table) < -0.95 * load, "{}: {} of {load} N", table.name, worst_pull(table));
    }
    for table in kept.train.iter().chain(&kept.test) {
        assert!(worst_pull(table) > -0.9 * load, "{}: {} N", table.name, worst_pull(table));
    }
}

/// The rig that an effect is hidden in.
fn plant_of(id: &str) -> Plant {
    match id {
        "26v" | "28" | "28h" | "29" | "30" => Plant::ServoQuarter,
        "02g" | "27" | "33g" => Plant::LinearDrive,
        "16m" | "08n" | "U9m" => Plant::GuidedMass,
        "30p" | "32a" | "32b" | "32c" => Plant::PumpDyno,
        "01p" | "19p" => Plant::SasRig,
        "15c" | "28c" | "29c" | "30c" => Plant::PneumaticCylinder,
        _ => Plant::LinearQuarter,
    }
}

/// An effect is at least twice as large as the small effects beside it.
fn outdoes_the_clutter(entry: &Entry) {
    let plant = plant_of(entry.id);
    let signal = match (entry.place, entry.id) {
        (Place::Sensor, "41" | "41h") => "wheel.force",
        (Place::Sensor, "42") => "road.position",
        (Place::Sensor, _) => "body.acceleration",
        _ => "",
    };
    // A damper does not fade in less.
    let duration = if entry.id == "10" { 8.0 } else { 4.0 };
    let case = Case { plant, duration, ..short(vec![Hidden::at(entry.id, signal)]) };
    let made = generate(&case).unwrap();
    let ratio = made.truth.effects[0].ratio.unwrap();
    for table in made.train.iter().chain(&made.test) {
        assert!(table.columns.iter().all(|column| column.2.iter().all(|x| x.is_finite())), "{}", entry.id);
    }
    // The parabola of a tyre that shall still lift off is bounded, and how far it lifts off is a matter of the road.
    let least = if ["19", "20"].contains(&entry.id) { 0.5 } else { 2.0 };
    assert!(ratio > least, "{}: {ratio}", entry.id);
}

#[test]
#[ignore = "takes minutes: `scripts/long-tests hiding`"]
fn every_effect_can_be_hidden() {
    // Part 2 of 3: every third, from the second on.
    let part = std::env::var("STRUT_PART").unwrap_or_else(|_| "1/1".into());
    let (number, parts) = part.split_once('/').expect("K/N");
    let [number, parts]: [usize; 2] = [number, parts].map(|it| it.parse().expect("a number"));
    crate::catalogue::entries().skip(number - 1).step_by(parts).for_each(outdoes_the_clutter);
}

/// One effect at each place of each rig.
#[test]
fn an_effect_at_each_place_outdoes_the_clutter() {
    let mut seen = Vec::new();
    for entry in crate::catalogue::entries() {
        let at = (plant_of(entry.id), entry.place);
        if !seen.contains(&at) {
            outdoes_the_clutter(entry);
            seen.push(at);
        }
    }
    assert!(seen.len() > 10, "{seen:?}");
}

#[test]
fn what_cannot_be_hidden_is_refused() {
    let refused = |case: &Case| generate(case).unwrap_err();
    assert!(refused(&short(vec![Hidden::new("99")])).contains("these can"));
    assert!(refused(&short(vec![Hidden::at("34", "engine.speed")])).contains("body.acceleration"));
    let dyno = Case { plant: Plant::StrutDyno, ..short(vec![Hidden::new("19")]) };
    assert!(refused(&dyno).contains("another plant"));
    assert!(refused(&short(vec![Hidden::new("28")])).contains("another plant"));
    assert!(refused(&short(vec![Hidden::at("41", "body.acceleration")])).contains("wheel.force"));
    assert!(refused(&Case { rate: 333.0, ..short(vec![]) }).contains("divides"));
}

/// Phases and bursts differ between records, and repeat if a record is made again.
#[test]
fn each_record_finds_other_times() {
    let made = |id: &str| clean(Plant::LinearQuarter, vec![Hidden::new(id)]);
    let (sound, uneven) = (clean(Plant::LinearQuarter, vec![]), made("U11"));
    let frequency = uneven.truth.effects[0].parameters[1].value;
    let tables = |of: &Generated| of.train.iter().chain(&of.test).cloned().collect::<Vec<_>>();
    let phases: Vec<f64> = tables(&uneven)
        .iter()
        .zip(tables(&sound))
        .map(|(uneven, sound)| {
            let force = |of: &Table| of.column("wheel.force").unwrap().to_vec();
            let off = force(uneven).into_iter().zip(force(&sound)).map(|(one, other)| one - other);
            let (sine, cosine) = off.enumerate().skip(2000).fold((0.0, 0.0), |sum, (k, off)| {
                let angle = std::f64::consts::TAU * frequency * k as f64 / 1000.0;
                (sum.0 + off * angle.sin(), sum.1 + off * angle.cos())
            });
            cosine.atan2(sine)
        })
        .collect();
    let apart = |phase: &f64| (phase - phases[0]).sin().abs();
    assert!(phases.iter().filter(|phase| apart(phase) > 0.2).count() >= 2, "{phases:?}");
    assert_eq!(uneven.train, made("U11").train);
}

#[test]
fn a_loose_sensor_is_an_accelerometer() {
    let refused = generate(&short(vec![Hidden::at("U13", "wheel.force")])).unwrap_err();
    assert!(refused.contains("accelerometer"), "{refused}");
    let dyno = Case { plant: Plant::StrutDyno, ..short(vec![Hidden::new("U7")]) };
    assert!(generate(&dyno).unwrap_err().contains("another plant"));
}

#[test]
fn the_dyno_and_the_published_rig_run() {
    for (plant, id) in [(Plant::StrutDyno, "01"), (Plant::StrutDyno, "32"), (Plant::PublishedQuarter, "06")] {
        let made = generate(&Case { plant, ..short(vec![Hidden::new(id)]) }).unwrap();
        assert_eq!((made.train.len(), made.test.len()), (2, 3));
        let last = made.train[0].columns.last().unwrap();
        assert!(rms(&last.2) > 1.0, "{plant:?} {}: {}", last.0, rms(&last.2));
    }
}

fn clean(plant: Plant, effects: Vec<Hidden>) -> Generated {
    generate(&Case { plant, noise_db: None, clutter: 0, ..short(effects) }).unwrap()
}

/// What the cell misses is its mass times the wheel's acceleration, and the wheel does not notice.
#[test]
fn the_cells_inertia_is_missing_in_the_wheels_force() {
    let plain = clean(Plant::LinearQuarter, vec![]);
    let made = clean(Plant::LinearQuarter, vec![Hidden::at("41", "wheel.force")]);
    let parameter = &made.truth.effects[0].parameters[0];
    assert_eq!(parameter.name, "force_cell.mass");
    for (table, plain) in made.test.iter().zip(&plain.test) {
        let of = |table: &Table, name| table.column(name).unwrap().to_vec();
        let wheel = of(table, "wheel.acceleration");
        assert_eq!(wheel, of(plain, "wheel.acceleration"));
        let forces = of(table, "wheel.force").into_iter().zip(of(plain, "wheel.force"));
        for ((force, plain), acceleration) in forces.zip(wheel) {
            assert!((plain - force - parameter.value * acceleration).abs() < 1e-8, "{plain} N, {force} N");
        }
    }
}

/// What the cell shows is off by its friction at most, and off by all of it for most of the time; the wheel does not notice.
#[test]
fn the_cells_friction_is_what_the_wheels_force_is_off_by() {
    let plain = clean(Plant::LinearQuarter, vec![]);
    let made = clean(Plant::LinearQuarter, vec![Hidden::at("41h", "wheel.force")]);
    let parameter = &made.truth.effects[0].parameters[0];
    assert_eq!((parameter.name.as_str(), parameter.unit.as_str()), ("force_cell.hysteresis", "N"));
    for (table, plain) in made.train.iter().zip(&plain.train) {
        let of = |table: &Table, name| table.column(name).unwrap().to_vec();
        assert_eq!(of(table, "wheel.acceleration"), of(plain, "wheel.acceleration"));
        let forces = of(table, "wheel.force").into_iter().zip(of(plain, "wheel.force"));
        let off: Vec<f64> = forces.map(|(shown, force)| (shown - force).abs() / parameter.value).collect();
        // The filter swings over a little where the force turns.
        assert!(off.iter().all(|it| *it < 1.1), "{}", table.name);
        let whole = off.iter().filter(|it| (*it - 1.0).abs() < 0.02).count();
        assert!(whole > off.len() / 4, "{}: {whole} of {}", table.name, off.len());
    }
}

/// The clock's error grows with the time, up to the last sample, and the other columns keep theirs.
#[test]
fn a_wrong_clock_sees_what_comes_later() {
    for seed in [11, 12] {
        let case = Case { noise_db: None, clutter: 0, seed, ..short(vec![Hidden::at("40", "wheel.force")]) };
        let made = generate(&case).unwrap();
        let of = |name: &str| made.truth.base.iter().find(|value| value.name == name).unwrap().value;
        let error = made.truth.effects[0].parameters[0].value;
        let table = &made.train[0];
        let column = |name| table.column(name).unwrap();
        assert_eq!(column("time").len(), case.samples());
        let (body, wheel) = (column("body.acceleration"), column("wheel.acceleration"));
        let newton = |k: usize| of("sprung_mass") * body[k] + of("unsprung_mass") * wheel[k];
        let force = column("wheel.force");
        for (k, force) in force.iter().enumerate().take(5900).skip(1000) {
            let place = k as f64 * (1.0 + error);
            let share = place.fract();
            let due = newton(place as usize) * (1.0 - share) + newton(place as usize + 1) * share;
            assert!((force - due).abs() < 0.02 * rms(column("wheel.force")), "{force} N for {due} N at {k}");
        }
    }
}

#[test]
fn the_clutters_magnets_are_in_the_true_stiffness() {
    let of = |clutter: u32| generate(&Case { clutter, ..short(vec![]) }).unwrap().truth.base;
    for (without, with) in of(0).into_iter().zip(of(1)) {
        assert_eq!(without.value != with.value, without.name == "strut.stiffness", "{}", without.name);
    }
}

/// Their covariance over the deflections' variance, of what was recorded.
#[test]
fn what_the_clutter_adds_to_the_stiffness_is_what_the_records_cover() {
    for (plant, column, sign) in
        [(Plant::LinearQuarter, "suspension.deflection", 1.0), (Plant::StrutDyno, "motion.position", -1.0)]
    {
        let of = |clutter| {
            generate(&Case { plant, clutter, noise_db: None, ..short(vec![Hidden::new("01")]) }).unwrap()
        };
        let (without, with) = (of(0), of(1));
        let plain = Rig::new(plant, &without.truth.base);
        let mut cluttered = plain.clone();
        cluttered.clutter_plant(1.0, &mut Random::new(11, "clutter"));
        let columns = with.train.iter().flat_map(|table| table.column(column).unwrap());
        let pairs: Vec<(f64, f64)> = columns
            .map(|x| sign * x)
            .map(|x| (x, cluttered.car.strut.spring(x) - plain.car.strut.spring(x)))
            .collect();
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / pairs.len() as f64;
        let (x, force) = (mean(&|it| it.0), mean(&|it| it.1));
        let due = mean(&|it| (it.0 - x) * (it.1 - force)) / mean(&|it| (it.0 - x).powi(2));
        let told =
            |made: &Generated| made.truth.base.iter().find(|it| it.name == "strut.stiffness").unwrap().value;
        let added = told(&with) - told(&without);
        assert!((added / due - 1.0).abs() < 0.01, "{plant:?}: {added} N/m for {due} N/m");
    }
}
