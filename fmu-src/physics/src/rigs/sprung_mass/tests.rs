use std::f64::consts::TAU;

use strut_model::Value;

use super::*;
use crate::testing::Bench;

type Seat = Bench<SprungMass>;

fn bench(drive: Drive) -> Seat {
    Seat::new()
        .choose("drive", Value::Integer(drive as i32 + 1))
        .start("sprung_mass", 80.0)
        .start("strut.stiffness", 12e3)
        .start("strut.damping", 600.0)
}

/// Transmissibility of a base-excited mass (Rao, Mechanical Vibrations, 5th edition, eq. 3.68): a sine of the base comes
/// through as much as that.
#[test]
fn a_base_that_shakes_moves_the_mass_by_the_transmissibility() {
    let (mass, stiffness, damping, amplitude, hertz) = (80.0_f64, 12e3_f64, 600.0_f64, 0.01, 3.0);
    let omega = TAU * hertz;
    let ratio = omega / (stiffness / mass).sqrt();
    let twice = 2.0 * damping / (2.0 * (stiffness * mass).sqrt()) * ratio;
    let expected = ((1.0 + twice.powi(2)) / ((1.0 - ratio.powi(2)).powi(2) + twice.powi(2))).sqrt();
    let mut seat = bench(Drive::Motion).initialized();
    let mut largest: f64 = 0.0;
    let step = 1e-3;
    for k in 0..4000 {
        let time = f64::from(k) * step;
        // The inputs hold over a step: their middle is what acts.
        let middle = omega * (time + 0.5 * step);
        seat.set("motion.position", amplitude * middle.sin());
        seat.set("motion.velocity", amplitude * omega * middle.cos());
        seat.step(step);
        if time > 3.0 {
            largest = largest.max(seat.get("body.position").abs());
        }
    }
    assert!((largest / amplitude / expected - 1.0).abs() < 2e-3, "{} {expected}", largest / amplitude);
}

/// Whichever of its signals says how it moves.
#[test]
fn the_three_drives_agree_on_what_the_mass_does() {
    let (deflection, velocity) = (0.012, -0.2);
    let friction = |seat: Seat| seat.start("strut.coulomb.force", 30.0).start("guide.damping", 20.0);
    let mut given = friction(bench(Drive::Motion)).start("body.velocity", 0.1).initialized();
    given.set("motion.position", -deflection);
    given.set("motion.velocity", 0.1 - velocity);
    let mut integrated = friction(bench(Drive::Acceleration))
        .start("body.velocity", 0.1)
        .start("base.position", -deflection)
        .start("base.velocity", 0.1 - velocity)
        .initialized();
    let mut imposed = friction(bench(Drive::Deflection)).start("body.velocity", 0.1).initialized();
    imposed.set("imposed.deflection", deflection);
    imposed.set("imposed.velocity", velocity);
    for seat in [&mut given, &mut integrated, &mut imposed] {
        seat.set("actuator.force", 15.0);
        assert!((seat.get("suspension.deflection") - deflection).abs() < 1e-15);
        let force = 12e3 * deflection + 600.0 * velocity + 30.0 * (velocity / 0.008_f64).tanh();
        let acceleration = (15.0 - force - 20.0 * 0.1) / 80.0;
        assert!((seat.get("body.acceleration") - acceleration).abs() < 1e-12);
        assert!((seat.get("base.force") - (15.0 - force)).abs() < 1e-9);
    }
}

/// Newton's third law over a whole motion: what presses on the base is what the mass does not keep.
#[test]
fn an_accelerated_base_carries_the_mass_along() {
    let mut seat = bench(Drive::Acceleration).initialized();
    seat.set("motion.acceleration", 0.5);
    seat.step(6.0);
    // In steady motion the strut accelerates the mass as the base is.
    assert!((seat.get("body.acceleration") - 0.5).abs() < 1e-6);
    assert!((seat.get("suspension.deflection") + 80.0 * 0.5 / 12e3).abs() < 1e-8);
    assert!((seat.get("base.force") - 80.0 * 0.5).abs() < 1e-4);
}
