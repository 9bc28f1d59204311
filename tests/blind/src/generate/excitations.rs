//! What moves the rigs in each record.

use crate::case::{Case, Plant};
use crate::excitation::{Profile, bumps, multisine, prbs, road, steps, sweep, triangle};
use crate::random::Random;
use crate::rig::Rig;

/// A record to be made.
#[derive(Clone)]
pub(super) struct Excitation {
    /// Its name in the file's.
    pub(super) name: &'static str,
    /// The road, the motion of a dyno's end, or what a drive shall follow; in m.
    pub(super) road: Profile,
    /// What the actuator is commanded.
    pub(super) command: Profile,
}

/// The records to learn from, and those to judge with.
pub(super) fn excitations(case: &Case, plain: &Rig) -> (Vec<Excitation>, Vec<Excitation>) {
    let random = &mut Random::new(case.seed, "excitation");
    let time = case.reach();
    let still = Profile::still;
    let mut all = match case.plant {
        // Fast enough for what a damper does at speed. It never stands still for long: what friction holds there is a matter
        // of what was before.
        Plant::StrutDyno | Plant::MrDyno => [
            ("multisine", multisine(random, time, 0.8, 0.015), still()),
            ("triangle", triangle(time, 4.0, 0.012).plus(&multisine(random, time, 1.3, 0.003)), still()),
            ("bumps", bumps(random, time, 0.015).plus(&multisine(random, time, 1.3, 0.005)), still()),
            ("road", road(random, time, 0.015), still()),
            ("sweep", sweep(time, 1.0, 0.012), still()),
        ],
        // Enough for the friction of its strut, 115 N, to be overcome nearly all the time.
        Plant::PublishedQuarter => [
            ("multisine", multisine(random, time, 0.9, 0.025), still()),
            ("prbs", multisine(random, time, 0.9, 0.012), forces(case, random, 220.0)),
            ("bumps", bumps(random, time, 0.010), multisine(random, time, 0.3, 250.0)),
            ("road", road(random, time, 0.025), multisine(random, time, 0.6, 150.0)),
            ("sweep", still(), sweep(time, 0.0, 250.0)),
        ],
        Plant::LinearQuarter | Plant::RegulatedQuarter => [
            ("multisine", multisine(random, time, 0.5, 0.010), still()),
            ("prbs", multisine(random, time, 0.5, 0.005), forces(case, random, 150.0)),
            ("bumps", bumps(random, time, 0.010), multisine(random, time, 0.3, 120.0)),
            ("road", road(random, time, 0.010), still()),
            ("sweep", still(), sweep(time, 0.0, 150.0)),
        ],
        // The shut valve nearly locks the suspension, and a constant voltage would drive it to its end.
        Plant::ServoQuarter => [
            ("multisine", multisine(random, time, 0.5, 0.006), multisine(random, time, 0.3, 2.0)),
            ("steps", multisine(random, time, 0.5, 0.003), steps(random, time, 0.04, 1.5)),
            ("bumps", bumps(random, time, 0.006), multisine(random, time, 0.3, 1.5)),
            ("road", road(random, time, 0.006), multisine(random, time, 0.6, 1.0)),
            ("sweep", still(), sweep(time, 0.0, 1.5)),
        ],
        Plant::LinearDrive => [
            ("multisine", multisine(random, time, 1.6, 0.10), still()),
            ("triangle", triangle(time, 5.0, 0.10).plus(&multisine(random, time, 1.6, 0.01)), still()),
            ("bumps", bumps(random, time, 0.01), still()),
            ("road", road(random, time, 0.02), still()),
            ("sweep", sweep(time, 1.5, 0.08), still()),
        ],
    }
    .map(|(name, road, command)| Excitation { name, road, command });
    if case.plant.is_car() {
        let lifting = case.effects.iter().any(|hidden| hidden.id == "20");
        for excitation in &mut all {
            limit_pull(case, plain, excitation, lifting);
        }
    }
    let mut train = Vec::from(all);
    let test = train.split_off(2);
    (train, test)
}

/// Two levels of force; many where the actuator saturates, as of two levels a saturation is a gain, and a slew limit takes as
/// long for each change as a lag.
fn forces(case: &Case, random: &mut Random, size: f64) -> Profile {
    let limited = case.effects.iter().any(|hidden| ["26", "26s"].contains(&hidden.id.as_str()));
    if limited { steps(random, case.reach(), 0.025, size) } else { prbs(random, case.reach(), 0.025, size) }
}

/// Scales the road such that the tyre keeps a fifth of its static load, or, if it shall leave the road, such that
/// the wheel flies well above it.
fn limit_pull(case: &Case, plain: &Rig, excitation: &mut Excitation, lifting: bool) {
    if excitation.road.is_still() {
        return;
    }
    let car = &plain.car;
    let load = car.load();
    // Several times, as the relation is not linear: a wheel in the air flies far.
    for _ in 0..8 {
        let motion = plain.run(&excitation.road, &excitation.command, case.reach());
        let pull = motion.road.iter().zip(&motion.wheel).fold(0.0_f64, |most, (z, w)| most.max(w - z));
        let share = pull * car.tire_stiffness / load;
        let factor = match () {
            () if lifting && !(1.2..2.5).contains(&share) => (1.6 / share).sqrt().clamp(0.7, 2.0),
            () if !lifting && share > 0.8 => 0.75 / share,
            () => break,
        };
        excitation.road = excitation.road.scaled(factor);
    }
}
