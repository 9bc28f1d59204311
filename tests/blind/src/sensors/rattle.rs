//! An accelerometer with a loose screw. Dry friction carries it along; beyond that it slides through its clearance and rings at the
//! stop.

use std::f64::consts::TAU;

use crate::car::RATE;

/// A sensor with clearance in its mounting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rattle {
    /// Clearance to each side, in m; zero is a tight screw.
    pub gap: f64,
    /// Acceleration up to which friction carries the sensor along, in m/s².
    pub friction: f64,
    /// Natural frequency of the sensor at the stop, in Hz.
    pub frequency: f64,
    /// Damping there, over the critical one.
    pub damping_ratio: f64,
}

impl Rattle {
    /// Steps of its motion in one of the rig's.
    const FINER: usize = 4;

    /// Acceleration by the stops at a place in the clearance in m and a velocity in m/s. A stop pushes and never pulls.
    fn pushed(&self, place: f64, velocity: f64) -> f64 {
        let omega = TAU * self.frequency;
        let beyond = place - place.clamp(-self.gap, self.gap);
        if beyond == 0.0 {
            return 0.0;
        }
        let push = omega * (omega * beyond + 2.0 * self.damping_ratio * velocity);
        if push * beyond > 0.0 { -push } else { 0.0 }
    }

    /// The acceleration of the sensor on a seat with this acceleration, both in m/s².
    pub fn felt(&self, acceleration: &[f64]) -> Vec<f64> {
        if self.gap <= 0.0 {
            return acceleration.to_vec();
        }
        let step = 1.0 / (RATE * Self::FINER as f64);
        // Against its seat.
        let (mut place, mut velocity) = (0.0, 0.0);
        let seated = |seat: &f64| {
            let mut mean = 0.0;
            for _ in 0..Self::FINER {
                let pushed = self.pushed(place, velocity);
                let free = velocity + step * (pushed - seat);
                // Friction stops the sliding as far as it can.
                let rubbed = (-free / step).clamp(-self.friction, self.friction);
                velocity = free + step * rubbed;
                place += step * velocity;
                mean += (pushed + rubbed) / Self::FINER as f64;
            }
            mean
        };
        acceleration.iter().map(seated).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::rms;

    const LOOSE: Rattle = Rattle { gap: 1e-4, friction: 0.5, frequency: 200.0, damping_ratio: 0.1 };

    fn sine(size: f64) -> Vec<f64> {
        (0..80_000).map(|k| size * (TAU * 2.0 * f64::from(k) / RATE).sin()).collect()
    }

    #[test]
    fn friction_carries_it_along_and_a_tight_screw_always_does() {
        for (rattle, size) in [(LOOSE, 0.49), (Rattle { gap: 0.0, ..LOOSE }, 5.0)] {
            let (seat, felt) = (sine(size), rattle.felt(&sine(size)));
            let apart = seat.iter().zip(felt).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(apart < 1e-9, "{apart} m/s²");
        }
    }

    /// From rest at the one end, 2 m/s² less the friction's 0.5 take it through 0.2 mm to 24.5 mm/s; half a period of ringing
    /// later it turns, with up to ω v.
    #[test]
    fn it_rings_at_the_end_of_its_clearance() {
        let mut seat = vec![2.0; 4000];
        seat.extend([-2.0; 4000]);
        let felt = Rattle { damping_ratio: 0.0, ..LOOSE }.felt(&seat);
        let most = felt[4000..].iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        let due = TAU * 200.0 * (2.0 * 1.5 * 2e-4_f64).sqrt();
        assert!((most / due - 1.0).abs() < 0.1, "{most} m/s² for {due} m/s²");
        let first = felt[4000..].iter().position(|a| a.abs() > 3.0).unwrap();
        let time = (2.0 * 2e-4 / 1.5_f64).sqrt() * RATE;
        assert!((first as f64 - time).abs() < 20.0, "after {first} steps for {time}");
    }

    /// It stays within its clearance; it feels its seat's acceleration and short bursts.
    #[test]
    fn it_stays_with_its_seat() {
        let (seat, felt) = (sine(3.0), LOOSE.felt(&sine(3.0)));
        let mut apart = (0.0_f64, 0.0_f64);
        for (seat, felt) in seat.iter().zip(&felt) {
            apart.1 += (felt - seat) / RATE;
            apart.0 += apart.1 / RATE;
            assert!(apart.0.abs() < 3e-4, "{} m", apart.0);
        }
        let errors: Vec<f64> = seat.iter().zip(&felt).map(|(a, b)| b - a).collect();
        let large = errors.iter().filter(|error| error.abs() > 2.0 * rms(&errors)).count();
        assert!(rms(&errors) > 1.0 && large < errors.len() / 10, "{} m/s², {large}", rms(&errors));
    }
}
