//! A linear drive: a carriage on a guide, moved by a motor that a position loop commands.

use std::f64::consts::TAU;

use crate::car::{Motion, RATE};
use crate::excitation::Profile;
use crate::friction::{Contact, settle};

/// Steps of the integration in one of the loop: it runs at 2 kHz and holds its command meanwhile.
const HELD: usize = 10;

/// A carriage, its guide, its motor and its loop.
#[derive(Clone, Debug, Default)]
pub struct Drive {
    /// Moving, in kg.
    pub mass: f64,
    /// Viscous friction of the guide, in N s/m.
    pub damping: f64,
    /// Dry friction of the guide.
    pub contacts: Vec<Contact>,
    /// Amplitude in N, period in m and phase of the force against the motion that the magnets make without current.
    pub cogging: Option<(f64, f64, f64)>,
    /// Against positive positions, in N.
    pub constant_load: f64,
    /// A cable that is dragged along: stiffness in N/m and the time in s in which it gives way. Clutter.
    pub cable: Option<(f64, f64)>,
    /// How the motor's force differs from what its current tells: share, period in m and phase. Clutter.
    pub ripple: Option<(f64, f64, f64)>,
    /// Of the position.
    pub control: Loop,
}

/// A position controller: proportional, integral, derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loop {
    /// N/m.
    pub proportional: f64,
    /// N/(m s).
    pub integral: f64,
    /// N s/m.
    pub derivative: f64,
    /// Largest force of the motor, in N.
    pub most: f64,
}

impl Loop {
    /// For a carriage of `mass` kg: its poles near 8 Hz, well damped, and the rest of the error gone in half a second.
    pub fn for_mass(mass: f64) -> Self {
        let omega = TAU * 8.0;
        let proportional = mass * omega * omega;
        Self { proportional, integral: 2.0 * proportional, derivative: 1.6 * mass * omega, most: 1000.0 }
    }

    /// The force that it asks for, and what it adds to the integral of the error, in m s.
    fn command(&self, sum: f64, error: (f64, f64)) -> (f64, f64) {
        let wanted = self.proportional * error.0 + self.integral * sum + self.derivative * error.1;
        let force = wanted.clamp(-self.most, self.most);
        // It does not go on adding what the motor cannot give.
        (force, if force == wanted { error.0 * HELD as f64 / RATE } else { 0.0 })
    }
}

/// Position, velocity, stretch of the cable.
type State = [f64; 3];

impl Drive {
    fn rates(&self, state: &State, motor: f64, friction: f64) -> State {
        let [x, v, stretch] = *state;
        let wave = |(size, period, phase): (f64, f64, f64)| size * (TAU * x / period + phase).sin();
        let mut force = motor * (1.0 + self.ripple.map_or(0.0, wave));
        force -= self.cogging.map_or(0.0, wave) + self.constant_load + self.damping * v + friction;
        let give = self.cable.map_or(0.0, |(stiffness, time)| {
            force -= stiffness * stretch;
            v - stretch / time
        });
        [v, force / self.mass, give]
    }

    /// Follows `reference`, in m, for `duration` seconds. The motor's force is the [`Motion::command`]; of the rest
    /// only the [`Motion::body`] moves.
    pub fn run(&self, reference: &Profile, duration: f64) -> Motion {
        let step = 1.0 / RATE;
        let (mut state, mut sum, mut motor): (State, f64, f64) = ([0.0; 3], 0.0, 0.0);
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        for k in 0..=(duration * RATE).round() as usize {
            if k % HELD == 0 {
                let (wanted, rate) = reference.at(k as f64 * step);
                let (force, added) = self.control.command(sum, (wanted - state[0], rate - state[1]));
                (motor, sum) = (force, sum + added);
            }
            let held = friction.iter().sum();
            let ahead =
                |rates: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + step * rates[i]) };
            let first = self.rates(&state, motor, held);
            motion.command.push(motor);
            motion.body.push(state[0]);
            motion.body_velocity.push(state[1]);
            motion.body_acceleration.push(first[1]);

            let second = self.rates(&ahead(&first, 0.5 * step), motor, held);
            let third = self.rates(&ahead(&second, 0.5 * step), motor, held);
            let fourth = self.rates(&ahead(&third, step), motor, held);
            state = std::array::from_fn(|i| {
                state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
            });
            // The guide stands: a second body that nothing moves.
            let mut velocities = [state[1], 0.0];
            let masses = [self.mass, f64::INFINITY];
            settle(&self.contacts, &mut friction, [state[0], 0.0], &mut velocities, masses, step);
            state[0] += 0.5 * step * (velocities[0] - state[1]);
            state[1] = velocities[0];
        }
        motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::Limit;

    fn bare() -> Drive {
        Drive { mass: 20.0, damping: 40.0, control: Loop::for_mass(20.0), ..Drive::default() }
    }

    fn friction(limit: Limit) -> Vec<Contact> {
        vec![Contact { along: [1.0, 0.0], limit }]
    }

    /// There and back at 0.1 m/s: seconds from 5 to 6 of a triangle of 8 s that goes 0.2 m to each side.
    fn steady(drive: &Drive) -> (f64, Motion) {
        let motion = drive.run(&crate::excitation::triangle(8.0, 8.0, 0.2), 8.0);
        let (first, last) = (100_000, 120_000);
        let mean = motion.command[first..last].iter().sum::<f64>() / (last - first) as f64;
        (mean, motion)
    }

    #[test]
    fn at_a_steady_speed_the_motor_carries_the_resistance() {
        let (mean, motion) = steady(&Drive { constant_load: 7.0, ..bare() });
        let speed = motion.body_velocity[110_000];
        assert!((speed + 0.1).abs() < 1e-4, "{speed} m/s");
        assert!((mean - (7.0 - 40.0 * 0.1)).abs() < 0.01, "{mean} N");
        let (mean, _) = steady(&Drive { contacts: friction(Limit::Coulomb(25.0)), ..bare() });
        assert!((mean + 25.0 + 40.0 * 0.1).abs() < 0.01, "{mean} N");
    }

    #[test]
    fn breakaway_is_above_what_slides_and_is_not_smoothed() {
        let limit = Limit::Stribeck { at_rest: 40.0, sliding: 20.0, velocity: 0.02 };
        let (mean, motion) = steady(&Drive { contacts: friction(limit), ..bare() });
        assert!((mean + 20.0 + 4.0).abs() < 0.01, "{mean} N");
        // At the beginning the motor has to reach the breakaway before anything moves at all.
        let start = motion.body_velocity.iter().position(|v| v.abs() > 1e-9).unwrap();
        assert!((motion.command[start - 1] - 40.0).abs() < 0.5, "{} N", motion.command[start - 1]);
    }

    #[test]
    fn cogging_repeats_itself_over_the_position() {
        let (_, motion) = steady(&Drive { cogging: Some((12.0, 0.024, 0.3)), ..bare() });
        for k in (100_000..120_000).step_by(HELD) {
            let force =
                motion.command[k] - 20.0 * motion.body_acceleration[k] - 40.0 * motion.body_velocity[k];
            let told = 12.0 * (TAU * motion.body[k] / 0.024 + 0.3).sin();
            assert!((force - told).abs() < 1e-9, "{force} N for {told} N");
        }
    }
}
