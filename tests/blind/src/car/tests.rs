use std::f64::consts::TAU;

use super::*;
use crate::friction::Limit;

fn linear() -> Car {
    Car {
        sprung_mass: 94.38,
        unsprung_mass: 23.92,
        strut: Strut { stiffness: 8400.0, damping: 707.0, ..Strut::default() },
        tire_stiffness: 152_140.0,
        tire_damping: 50.0,
        ..Car::default()
    }
}

fn undamped() -> Car {
    let mut car = linear();
    car.strut.damping = 0.0;
    car.tire_damping = 0.0;
    car
}

fn free(car: &Car, duration: f64, start: [f64; 4]) -> Motion {
    car.run(&Profile::still(), &Profile::still(), duration, start)
}

fn energy(motion: &Motion, k: usize) -> f64 {
    let x = motion.body[k] - motion.wheel[k];
    0.5 * (94.38 * motion.body_velocity[k].powi(2)
        + 23.92 * motion.wheel_velocity[k].powi(2)
        + 8400.0 * x * x
        + 152_140.0 * motion.wheel[k].powi(2))
}

/// The tyre made rigid leaves the body alone on the strut: √(k/m).
#[test]
fn the_body_alone_swings_at_the_textbook_frequency() {
    let car = Car { unsprung_mass: 1e9, tire_stiffness: 1e12, ..undamped() };
    let motion = free(&car, 5.0, [0.01, 0.0, 0.0, 0.0]);
    let crossings: Vec<f64> = (1..motion.body.len())
        .filter(|&k| motion.body[k - 1] > 0.0 && motion.body[k] <= 0.0)
        .map(|k| {
            let (before, after) = (motion.body[k - 1], motion.body[k]);
            ((k - 1) as f64 + before / (before - after)) / RATE
        })
        .collect();
    let periods = crossings.len() - 1;
    let frequency = periods as f64 / (crossings[periods] - crossings[0]);
    assert!((frequency - (8400.0_f64 / 94.38).sqrt() / TAU).abs() < 1e-6, "{frequency} Hz");
}

#[test]
fn nothing_is_lost_without_dampers() {
    let motion = free(&undamped(), 5.0, [0.004, 0.0, -0.003, 0.0]);
    let last = motion.body.len() - 1;
    assert!((energy(&motion, last) / energy(&motion, 0) - 1.0).abs() < 1e-8);
}

/// What friction and dampers take is what the masses lose.
#[test]
fn the_energy_balance_closes() {
    let mut car = linear();
    car.contacts = vec![
        Contact { along: [1.0, -1.0], limit: Limit::Coulomb(60.0) },
        Contact { along: [1.0, 0.0], limit: Limit::Coulomb(20.0) },
    ];
    let motion = free(&car, 1.0, [0.0, 0.5, 0.0, -0.5]);
    let lost: f64 = (0..motion.body.len() - 1)
        .map(|k| {
            let power = |k: usize| {
                let v = motion.body_velocity[k] - motion.wheel_velocity[k];
                let tire = 50.0 * motion.wheel_velocity[k].powi(2);
                707.0 * v * v + 60.0 * v.abs() + 20.0 * motion.body_velocity[k].abs() + tire
            };
            0.5 * (power(k) + power(k + 1)) / RATE
        })
        .sum();
    let last = motion.body.len() - 1;
    let fallen = energy(&motion, 0) - energy(&motion, last);
    assert!((lost / fallen - 1.0).abs() < 1e-4, "{lost} J dissipated, {fallen} J lost");
}

#[test]
fn friction_holds_what_it_can_and_no_more() {
    let held = |load: f64| {
        let mut car = linear();
        car.contacts = vec![Contact { along: [1.0, -1.0], limit: Limit::Coulomb(60.0) }];
        // Slowly, so that it does not swing beyond the balance and stay there.
        let rising = Profile::new(8.0, |t| load * (0.5 - 0.5 * (0.5 * TAU * (t / 7.0).min(1.0)).cos()));
        let motion = car.run(&Profile::still(), &rising, 8.0, [0.0; 4]);
        motion.body.last().unwrap() - motion.wheel.last().unwrap()
    };
    assert!(held(59.0).abs() < 1e-7, "{} m", held(59.0));
    // Beyond the limit spring and friction share the load.
    assert!((held(100.0) - 40.0 / 8400.0).abs() < 2e-5, "{} m", held(100.0));
}

#[test]
fn a_delay_is_exact() {
    let force = Profile::new(2.0, |t| 100.0 * (TAU * 3.0 * t).sin());
    let now = linear().run(&Profile::still(), &force, 2.0, [0.0; 4]);
    let mut car = linear();
    car.actuator.delay = 7e-3;
    let later = car.run(&Profile::still(), &force, 2.0, [0.0; 4]);
    for k in 140..now.body.len() {
        assert!((later.body_acceleration[k] - now.body_acceleration[k - 140]).abs() < 1e-9);
    }
}

#[test]
fn a_tyre_does_not_pull() {
    let motion = free(&linear(), 1.0, [0.03, 0.0, 0.03, 0.0]);
    let load = (94.38 + 23.92) * GRAVITY;
    let least = motion.tire_force.iter().fold(0.0_f64, |least, f| least.min(*f));
    assert_eq!(least, -load);
}
