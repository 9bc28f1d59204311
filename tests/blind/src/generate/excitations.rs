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
    /// The road, the motion of a dyno's end, what a drive or a pneumatic cylinder shall follow, the force on a mass in N, or the lift
    /// of an eccentric, in m; the velocity of a pump actuator's piston, in m/s.
    pub(super) road: Profile,
    /// What the actuator is commanded; a brake's rate beyond its drag, in N m s/rad; a dither on the voltage of a pneumatic
    /// valve, in V.
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
        // As fast as a damper is tested, within 6 cm.
        Plant::PumpDyno => {
            let fast = |profile: Profile| profile.rate().with_peak(0.4);
            [
                ("multisine", fast(multisine(random, time, 1.0, 1.0)), multisine(random, time, 0.4, 2.5)),
                ("steps", fast(multisine(random, time, 0.8, 1.0)), steps(random, time, 0.1, 2.0)),
                ("bumps", fast(bumps(random, time, 1.0)), multisine(random, time, 0.4, 2.0)),
                ("road", fast(road(random, time, 1.0)), multisine(random, time, 0.6, 2.0)),
                ("sweep", fast(sweep(time, 1.0, 1.0)), still()),
            ]
        }
        // The brake from its drag to its largest rate, k_MR(1) = 13.5 k_MR(0).
        Plant::SasRig => {
            let half = 0.5 * 12.5 * 0.2632;
            let braked = |changing: Profile| Profile::new(time, |_| half).plus(&changing);
            [
                ("multisine", multisine(random, time, 1.0, 6e-3), braked(still())),
                ("steps", multisine(random, time, 0.8, 5e-3), braked(steps(random, time, 0.2, half))),
                ("bumps", bumps(random, time, 4e-3), braked(multisine(random, time, 0.5, half))),
                ("road", road(random, time, 6e-3), braked(still())),
                ("sweep", sweep(time, 1.0, 4e-3), braked(steps(random, time, 1.0, half))),
            ]
        }
        // Up to 3 cm, at the resonance more.
        Plant::GuidedMass => [
            ("multisine", multisine(random, time, 0.3, 120.0), still()),
            ("prbs", prbs(random, time, 0.04, 50.0), still()),
            ("bumps", bumps(random, time, 150.0), still()),
            ("road", road(random, time, 120.0), still()),
            ("sweep", sweep(time, 0.0, 40.0), still()),
        ],
        // The loop alone is slow; with the dither the pressures change by a bar.
        Plant::PneumaticCylinder => {
            let followed = |random: &mut Random, peak: f64| multisine(random, time, 1.0, peak);
            [
                ("multisine", followed(random, 0.04), multisine(random, time, 0.0, 3.5)),
                ("prbs", followed(random, 0.05), prbs(random, time, 0.04, 1.8)),
                ("steps", steps(random, time, 0.5, 0.05), steps(random, time, 0.03, 3.0)),
                ("road", road(random, time, 0.04), multisine(random, time, 0.0, 3.0)),
                ("sweep", followed(random, 0.05), sweep(time, 0.0, 1.5)),
            ]
        }
        Plant::LinearDrive => [
            ("multisine", multisine(random, time, 1.6, 0.10), still()),
            ("triangle", triangle(time, 5.0, 0.10).plus(&multisine(random, time, 1.6, 0.01)), still()),
            ("bumps", bumps(random, time, 0.01), still()),
            ("road", road(random, time, 0.02), still()),
            ("sweep", sweep(time, 1.5, 0.08), still()),
        ],
    }
    .map(|(name, road, command)| Excitation { name, road, command });
    if case.plant == Plant::SasRig {
        all.iter_mut().for_each(|excitation| keep_contact(case, plain, excitation));
    }
    if case.plant == Plant::PneumaticCylinder {
        all.iter_mut().for_each(|excitation| keep_within(case, plain, excitation));
    }
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

/// Scales the road so that the tyre keeps a fifth of its static load, or, if it shall leave the road, so that
/// the wheel flies well above it.
fn limit_pull(case: &Case, plain: &Rig, excitation: &mut Excitation, lifting: bool) {
    if excitation.road.is_still() {
        return;
    }
    let car = &plain.car;
    let load = car.load();
    // Several times, as the relation is not linear: a wheel in the air flies far.
    for _ in 0..8 {
        let motion = plain.run(&excitation.road, &excitation.command, case.reach(), excitation.name);
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

/// Scales the lift of an eccentric so that the tyre keeps a fifth of its static load.
fn keep_contact(case: &Case, plain: &Rig, excitation: &mut Excitation) {
    let (_, load) = plain.sas.rest();
    for _ in 0..8 {
        let motion = plain.run(&excitation.road, &excitation.command, case.reach(), excitation.name);
        let least = motion.tire_force.iter().fold(load, |least, force| least.min(*force));
        let share = 1.0 - least / load;
        if share <= 0.8 {
            break;
        }
        excitation.road = excitation.road.scaled(0.75 / share);
    }
}

/// Scales the position that a pneumatic cylinder shall follow, and the dither on its valve's voltage, so that a fifth of the stroke is left at each
/// end and no chamber is pressed above the supply's pressure.
fn keep_within(case: &Case, plain: &Rig, excitation: &mut Excitation) {
    let cylinder = &plain.pneumatic;
    for _ in 0..8 {
        let motion = plain.run(&excitation.road, &excitation.command, case.reach(), excitation.name);
        let travel = motion.signals["position"].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let filled = ["chamber_a.pressure", "chamber_b.pressure"].map(|name| {
            let pressures = &motion.signals[name];
            let most = pressures.iter().copied().fold(0.0, f64::max);
            (most - pressures[0]) / (cylinder.supply - pressures[0])
        });
        let share = filled.into_iter().fold(travel / (0.4 * cylinder.stroke), f64::max);
        if share <= 1.0 {
            break;
        }
        let factor = 0.95 / share;
        excitation.road = excitation.road.scaled(factor);
        excitation.command = excitation.command.scaled(factor);
    }
}
