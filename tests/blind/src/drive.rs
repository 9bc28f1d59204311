//! A carriage on a guide. A linear drive's motor moves it, as a position loop commands; a mass on a spring is pushed by a force
//! that answers nothing.

use std::f64::consts::TAU;

use crate::car::{Frame, Motion, RATE};
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
    /// A spring to the ground, in N/m and N/m³.
    pub spring: [f64; 2],
    /// A mass that swings on the carriage.
    pub absorber: Option<Frame>,
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

/// Position, velocity, stretch of the cable; position and velocity of the absorber's mass.
type State = [f64; 5];

impl Drive {
    fn rates(&self, state: &State, motor: f64, friction: f64) -> State {
        let [x, v, stretch, absorber, absorber_velocity] = *state;
        let wave = |(size, period, phase): (f64, f64, f64)| size * (TAU * x / period + phase).sin();
        let mut force = motor * (1.0 + self.ripple.map_or(0.0, wave));
        force -= self.cogging.map_or(0.0, wave) + self.constant_load + self.damping * v + friction;
        force -= x * (self.spring[0] + self.spring[1] * x * x);
        let give = self.cable.map_or(0.0, |(stiffness, time)| {
            force -= stiffness * stretch;
            v - stretch / time
        });
        let absorbed = self.absorber.map_or(0.0, |it| {
            let rate = it.acceleration(absorber - x, absorber_velocity - v);
            force -= it.mass * rate;
            rate
        });
        [v, force / self.mass, give, absorber_velocity, absorbed]
    }

    /// Follows `reference`, in m, for `duration` seconds. The motor's force is the [`Motion::command`]; of the rest
    /// only the [`Motion::body`] moves.
    pub fn run(&self, reference: &Profile, duration: f64) -> Motion {
        let (mut sum, mut motor) = (0.0, 0.0);
        self.moved_by(duration, |k, state| {
            if k % HELD == 0 {
                let (wanted, rate) = reference.at(k as f64 / RATE);
                let (force, added) = self.control.command(sum, (wanted - state[0], rate - state[1]));
                (motor, sum) = (force, sum + added);
            }
            [motor; 3]
        })
    }

    /// Is pushed by a force in N for `duration` seconds, which is the [`Motion::command`].
    pub fn pushed(&self, force: &Profile, duration: f64) -> Motion {
        let after = |k: usize, steps: f64| force.at((k as f64 + steps) / RATE).0;
        self.moved_by(duration, |k, _| [0.0, 0.5, 1.0].map(|steps| after(k, steps)))
    }

    /// Is moved by a force, told for beginning, middle and end of each step by its number and the state there.
    fn moved_by(&self, duration: f64, mut motor: impl FnMut(usize, &State) -> [f64; 3]) -> Motion {
        let step = 1.0 / RATE;
        let mut state: State = [0.0; 5];
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        for k in 0..=(duration * RATE).round() as usize {
            let [now, half, next] = motor(k, &state);
            let held = friction.iter().sum();
            let ahead =
                |rates: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + step * rates[i]) };
            let first = self.rates(&state, now, held);
            motion.command.push(now);
            motion.body.push(state[0]);
            motion.body_velocity.push(state[1]);
            motion.body_acceleration.push(first[1]);

            let second = self.rates(&ahead(&first, 0.5 * step), half, held);
            let third = self.rates(&ahead(&second, 0.5 * step), half, held);
            let fourth = self.rates(&ahead(&third, step), next, held);
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

    fn sprung() -> Drive {
        Drive { mass: 12.0, spring: [6000.0, 0.0], ..Drive::default() }
    }

    /// 12 N on 6 N/mm of spring, slowly: 2 mm; with 10⁹ N/m³ beside it 1.470 mm, as x³ + 6·10⁻⁶ x = 12·10⁻⁹.
    #[test]
    fn a_spring_holds_the_mass() {
        let held = |cubic: f64| {
            let slow = Profile::new(12.0, |t| 12.0 * (0.5 - 0.5 * (TAU * 0.5 * (t / 6.0).min(1.0)).cos()));
            let drive = Drive { spring: [6000.0, cubic], damping: 200.0, ..sprung() };
            *drive.pushed(&slow, 12.0).body.last().unwrap()
        };
        assert!((held(0.0) - 2e-3).abs() < 1e-9, "{} m", held(0.0));
        let x = held(1e9);
        assert!((6000.0 * x + 1e9 * x.powi(3) - 12.0).abs() < 1e-6 && (x - 1.4703e-3).abs() < 1e-6, "{x} m");
    }

    /// What was stored in spring, mass and absorber stays there.
    #[test]
    fn a_mass_with_an_absorber_and_a_cubic_spring_keeps_its_energy() {
        let absorber = Frame { mass: 2.0, frequency: 4.0, damping_ratio: 0.0 };
        let drive = Drive { spring: [6000.0, 5e6], absorber: Some(absorber), ..sprung() };
        let push = Profile::new(6.0, |t| if t < 1.0 { 80.0 * (TAU * 3.0 * t).sin() } else { 0.0 });
        let motion = drive.pushed(&push, 6.0);
        // What the absorber does not carry of the mass's force; its state follows from the mass's motion.
        let (mut y, mut rate) = (0.0, 0.0);
        let mut energies = vec![];
        for k in 0..motion.body.len() {
            let (x, v, a) = (motion.body[k], motion.body_velocity[k], motion.body_acceleration[k]);
            let pulled = motion.command[k] - 12.0 * a - 6000.0 * x - 5e6 * x.powi(3);
            let own = absorber.acceleration(y - x, rate - v);
            assert!((pulled - 2.0 * own).abs() < 0.05, "{pulled} N for {} N", 2.0 * own);
            let stiffness = 2.0 * (TAU * 4.0_f64).powi(2);
            let stored = 12.0 * v * v + 2.0 * rate * rate + 6000.0 * x * x + 2.5e6 * x.powi(4);
            energies.push(0.5 * (stored + stiffness * (y - x).powi(2)));
            rate += own / RATE;
            y += rate / RATE;
        }
        let (before, after) = (energies[40_000], energies[motion.body.len() - 1]);
        assert!(before > 0.1 && (after / before - 1.0).abs() < 0.02, "{before} J, {after} J");
    }
}
