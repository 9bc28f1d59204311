//! The quarter vehicle on its rig, integrated at 20 kHz.

mod parts;

use std::collections::BTreeMap;

use crate::excitation::Profile;
use crate::friction::{Contact, Inertia, settle};
use crate::servo::Servo;
use crate::strut::{BRANCHES, INNER, Inner, Strut};
use crate::timed::{Bursts, Turning};

pub use parts::{Actuator, Crosstalk, Frame, Regulator};

/// Steps per second of all plants.
pub const RATE: f64 = 20_000.0;

/// Standard gravity, in m/s².
const GRAVITY: f64 = 9.806_65;

/// Body, strut, wheel, tyre.
#[derive(Clone, Debug, Default)]
pub struct Car {
    /// Body, in kg.
    pub sprung_mass: f64,
    /// Wheel, in kg.
    pub unsprung_mass: f64,
    /// Between them.
    pub strut: Strut,
    /// Inertance of an inerter between them, in kg.
    pub inertance: f64,
    /// Viscous friction of the body's guide, in N s/m.
    pub guide_damping: f64,
    /// Viscous friction of the wheel's guide, in N s/m.
    pub wheel_guide_damping: f64,
    /// Tyre, in N/m.
    pub tire_stiffness: f64,
    /// Tyre, in N/m².
    pub tire_quadratic: f64,
    /// Tyre, in N s/m.
    pub tire_damping: f64,
    /// Whether the tyre is glued to the road, as no tyre is: to see what leaving the road changes.
    pub tire_is_glued: bool,
    /// Time constant in s with which the tyre smooths the road; zero is none.
    pub enveloping: f64,
    /// A mass that swings on the body.
    pub frame: Option<Frame>,
    /// Dry friction.
    pub contacts: Vec<Contact>,
    /// Actuator whose force is commanded.
    pub actuator: Actuator,
    /// A servo valve and its cylinder instead: the command is a voltage.
    pub servo: Option<Servo>,
    /// Controllers that command a force from the motion of the car.
    pub regulator: Option<Regulator>,
    /// When the actuator makes no force of its command.
    pub dropouts: Bursts,
    /// A second path of the commanded force.
    pub crosstalk: Option<Crosstalk>,
    /// By which share the tyre's stiffness changes as the wheel turns.
    pub uneven_tire: Option<Turning>,
    /// Force on the body of a part that turns out of balance, in N.
    pub imbalance: Option<Turning>,
}

/// What a rig did, every 1/[`RATE`] seconds.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// In m.
    pub road: Vec<f64>,
    /// In m/s.
    pub road_velocity: Vec<f64>,
    /// The command: a force in N, or a voltage in V.
    pub command: Vec<f64>,
    /// In m.
    pub body: Vec<f64>,
    /// In m/s.
    pub body_velocity: Vec<f64>,
    /// In m/s².
    pub body_acceleration: Vec<f64>,
    /// In m.
    pub wheel: Vec<f64>,
    /// In m/s.
    pub wheel_velocity: Vec<f64>,
    /// In m/s².
    pub wheel_acceleration: Vec<f64>,
    /// Dynamic, in N; of a semi-active rig with its static part.
    pub tire_force: Vec<f64>,
    /// Difference of the cylinder's chambers, in Pa.
    pub pressure: Vec<f64>,
    /// Of pump actuators, semi-active rigs and pneumatic cylinders all that is measured, by the names and in the units of the record.
    pub signals: BTreeMap<&'static str, Vec<f64>>,
}

/// Positions and velocities of body and wheel, hidden states of the strut, force of the actuator; position and
/// velocity of the frame's mass, the road as the tyre smooths it, the cylinder's pressure, the valve's spool; the strut's memory.
type State = [f64; 10 + INNER];

/// Hidden states of the strut but for its memory.
const NEAR: usize = INNER - BRANCHES;

/// What acts from outside at one instant.
#[derive(Clone, Copy)]
struct Outside<'a> {
    time: f64,
    road: (f64, f64),
    /// What the actuator has made of its command, before its lag; with a valve the voltage.
    made: f64,
    friction: &'a [f64],
    /// Where the valve's opening was left at the step's beginning, in m.
    opening: f64,
    /// What has come through a second path, in N.
    crosstalk: f64,
}

impl Car {
    fn inertia(&self) -> Inertia {
        Inertia { masses: [self.sprung_mass, self.unsprung_mass], inertance: self.inertance }
    }

    /// What presses on the road at rest, in N.
    pub fn load(&self) -> f64 {
        let frame = self.frame.map_or(0.0, |frame| frame.mass);
        (self.sprung_mass + self.unsprung_mass + frame) * GRAVITY
    }

    /// Dynamic force that presses on the road; the tyre cannot pull unless it is glued. A tyre that is stiffer by a share `more`
    /// carries its static load by that share more, too.
    fn tire_force(&self, compression: f64, velocity: f64, more: f64) -> f64 {
        let spring = compression * (self.tire_stiffness + self.tire_quadratic * compression);
        let load = self.load();
        let uneven = more * (load + spring);
        if self.tire_is_glued {
            return spring + uneven + self.tire_damping * velocity;
        }
        // Beyond its vertex the parabola turns up again: there the tyre is long in the air.
        let turned =
            self.tire_quadratic > 0.0 && compression < -self.tire_stiffness / (2.0 * self.tire_quadratic);
        if turned || spring <= -load {
            return -load;
        }
        (spring + uneven + self.tire_damping * velocity).max(-load)
    }

    fn rates(&self, state: &State, outside: Outside<'_>) -> (State, f64) {
        let [body, body_velocity, wheel, wheel_velocity, _, _, _, _, lagged, ..] = *state;
        let [frame, frame_velocity, smoothed, pressure, spool] = std::array::from_fn(|i| state[9 + i]);
        let mut inner: Inner = [0.0; INNER];
        inner[..NEAR].copy_from_slice(&state[4..8]);
        inner[NEAR..].copy_from_slice(&state[14..]);
        let (x, v) = (body - wheel, body_velocity - wheel_velocity);
        // The lever turns deflection into the strut's own length, and its force back (virtual work).
        let lever = 1.0 + self.strut.linkage * x;
        let (passive, inner_rates) = self.strut.force(outside.time, self.strut.length(x), lever * v, &inner);
        let made = outside.made;
        let (mut active, lag_rate) =
            if self.actuator.lag > 0.0 { (lagged, (made - lagged) / self.actuator.lag) } else { (made, 0.0) };
        let (mut pressure_rate, mut spool_rate) = (0.0, 0.0);
        if let Some(servo) = &self.servo {
            active = servo.area * pressure;
            (pressure_rate, spool_rate) = servo.rates(outside.opening, [pressure, spool], made, lever * v);
        }
        let pulling = lever * (passive - active);
        let (ground, smoothed_rate) = if self.enveloping > 0.0 {
            let rate = (outside.road.0 - smoothed) / self.enveloping;
            ((smoothed, rate), rate)
        } else {
            (outside.road, 0.0)
        };
        let more = self.uneven_tire.map_or(0.0, |it| it.at(outside.time));
        let tire = self.tire_force(ground.0 - wheel, ground.1 - wheel_velocity, more);
        let mut on_body = -pulling - self.guide_damping * body_velocity;
        on_body += outside.crosstalk + self.imbalance.map_or(0.0, |it| it.at(outside.time));
        let mut on_wheel = pulling + tire - self.wheel_guide_damping * wheel_velocity;
        let frame_rate = self.frame.map_or(0.0, |it| {
            let rate = it.acceleration(frame - body, frame_velocity - body_velocity);
            on_body -= it.mass * rate;
            rate
        });
        for (contact, force) in self.contacts.iter().zip(outside.friction) {
            on_body -= contact.along[0] * force;
            on_wheel -= contact.along[1] * force;
        }
        let [body_rate, wheel_rate] = self.inertia().accelerations([on_body, on_wheel]);
        let mut rates = [0.0; 10 + INNER];
        rates[..4].copy_from_slice(&[body_velocity, body_rate, wheel_velocity, wheel_rate]);
        rates[4..8].copy_from_slice(&inner_rates[..NEAR]);
        rates[8..14].copy_from_slice(&[
            lag_rate,
            frame_velocity,
            frame_rate,
            smoothed_rate,
            pressure_rate,
            spool_rate,
        ]);
        rates[14..].copy_from_slice(&inner_rates[NEAR..]);
        (rates, tire)
    }

    /// Runs for `duration` seconds from `start`: positions and velocities of body and wheel.
    pub fn run(&self, road: &Profile, force: &Profile, duration: f64, start: [f64; 4]) -> Motion {
        let step = 1.0 / RATE;
        let count = (duration * RATE).round() as usize + 1;
        let mut state: State = [0.0; 10 + INNER];
        state[..4].copy_from_slice(&start);
        // The frame's mass moves with the body.
        state[9..11].copy_from_slice(&start[..2]);
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        let (mut now, mut opening) = (road.at(0.0), 0.0);
        // What the regulator commands in each step so far.
        let mut regulated = Vec::with_capacity(count);
        let command = |regulated: &[f64], time: f64| {
            // A hair later, so that the beginning of a step is not taken for the end of the one before.
            let own = if time < 0.0 { None } else { regulated.get((time * RATE + 1e-6) as usize) };
            force.at(time).0 + own.or(regulated.last().filter(|_| time >= 0.0)).copied().unwrap_or_default()
        };
        let mut halfway = self.actuator.made_of(force.at(-self.actuator.delay).0);
        for k in 0..count {
            let time = k as f64 * step;
            regulated.push(match (self.regulator, regulated.last()) {
                (Some(regulator), _) if k.is_multiple_of(Regulator::HELD) => {
                    regulator.force([state[0], state[1], state[2], state[3]], now.0)
                }
                (_, last) => last.copied().unwrap_or_default(),
            });
            let made = |time: f64| {
                let made = self.actuator.made_of(command(&regulated, time - self.actuator.delay));
                if self.dropouts.cover(time) { 0.0 } else { made }
            };
            let reached = |before: f64, time: f64| self.actuator.reached(before, made(time), 0.5 * step);
            let beginning = reached(halfway, time);
            halfway = reached(beginning, time + 0.5 * step);
            let outside = |time: f64, road, made, friction| {
                let second = |path: Crosstalk| path.gain * command(&regulated, time - path.delay);
                let crosstalk = self.crosstalk.map_or(0.0, second);
                Outside { time, road, made, friction, opening, crosstalk }
            };
            let (first, tire) = self.rates(&state, outside(time, now, beginning, &friction));
            motion.push(&state, &first, now, command(&regulated, time), tire);

            let (middle, end) = (road.at(time + 0.5 * step), road.at(time + step));
            let half = outside(time + 0.5 * step, middle, halfway, &friction);
            let (second, _) = self.rates(&advanced(&state, &first, 0.5 * step), half);
            let (third, _) = self.rates(&advanced(&state, &second, 0.5 * step), half);
            let last = outside(time + step, end, reached(halfway, time + step), &friction);
            let (fourth, _) = self.rates(&advanced(&state, &third, step), last);
            for i in 0..state.len() {
                state[i] += step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
            }
            now = end;
            if let Some(servo) = &self.servo {
                opening = servo.dragged(opening, state[13]);
            }
            if !self.contacts.is_empty() {
                let mut velocities = [state[1], state[3]];
                let (positions, inertia) = ([state[0], state[2]], self.inertia());
                settle(&self.contacts, &mut friction, positions, &mut velocities, inertia, step);
                // The correction acted during the step, on average for half of it.
                state[0] += 0.5 * step * (velocities[0] - state[1]);
                state[2] += 0.5 * step * (velocities[1] - state[3]);
                [state[1], state[3]] = velocities;
            }
        }
        motion
    }
}

fn advanced(state: &State, rates: &State, step: f64) -> State {
    let mut next = *state;
    for (value, rate) in next.iter_mut().zip(rates) {
        *value += step * rate;
    }
    next
}

impl Motion {
    fn push(&mut self, state: &State, rates: &State, road: (f64, f64), command: f64, tire: f64) {
        self.road.push(road.0);
        self.road_velocity.push(road.1);
        self.command.push(command);
        self.body.push(state[0]);
        self.body_velocity.push(state[1]);
        self.body_acceleration.push(rates[1]);
        self.wheel.push(state[2]);
        self.wheel_velocity.push(state[3]);
        self.wheel_acceleration.push(rates[3]);
        self.tire_force.push(tire);
        self.pressure.push(state[12]);
    }
}

#[cfg(test)]
mod tests;
