//! The semi-active rig of AGH: wheel arm and body arm on one pivot, a spring and a brake between them, the tyre on an eccentric
//! (Kogut eq. 13, 14, with the brake's torque on the wheel arm turned over: as printed it would feed energy in).

use crate::car::{Actuator, Motion, RATE};
use crate::excitation::Profile;
use crate::friction::{Contact, settle};
use crate::random::Random;

/// Both arms, what is between them, and the tyre.
#[derive(Clone, Debug, Default)]
pub struct Sas {
    /// Of the wheel arm, in kg m² (I_1).
    pub wheel_inertia: f64,
    /// Gravity's on the level wheel arm, in N m (M_1).
    pub wheel_moment: f64,
    /// From the pivot to the wheel's centre, in m (R).
    pub length: f64,
    /// By which the wheel's centre is below the spring's mount, in rad (β).
    pub offset: f64,
    /// Of the body arm, in kg m² (I_2).
    pub body_inertia: f64,
    /// Gravity's on the level body arm, in N m (M_2).
    pub body_moment: f64,
    /// Of the spring, in N/m (k_s).
    pub stiffness: f64,
    /// Of the spring without load, in m (l_s0).
    pub free_length: f64,
    /// From the pivot to the spring on wheel arm and body arm, in m (r_s1, r_s2); also its levers, as eq. 13 prints them.
    pub mounts: [f64; 2],
    /// From the pivot down to the eccentric's axis, in m (H).
    pub depth: f64,
    /// Of the rim, in m (r).
    pub rim_radius: f64,
    /// Of the tyre without load, in m (l_t0).
    pub thickness: f64,
    /// Of the tyre, in N/m (k_t).
    pub tire_stiffness: f64,
    /// Of the tyre, in N/m².
    pub tire_quadratic: f64,
    /// Of the tyre, in N s/m (b_t over its lever).
    pub tire_damping: f64,
    /// Of the eccentric at rest, in m (u_1 at α_0 = 0).
    pub height: f64,
    /// Dry friction between the arms: torques in N m.
    pub contacts: Vec<Contact>,
    /// Brake whose torque is commanded.
    pub actuator: Actuator,
    /// What the brake has without current, in N m s/rad (k_MR(0)); a command adds to it. None where the torque itself is commanded.
    pub drag: Option<f64>,
    /// Viscous friction of the pivot's bearings, in N m s/rad. Clutter.
    pub bearings: f64,
    /// A part of the tyre's rubber that gives way: stiffness in N/m and time in s. Clutter.
    pub relaxing: Option<(f64, f64)>,
}

/// Angle and speed of wheel arm and body arm, stretch of what relaxes.
type State = [f64; 5];

/// What acts at one instant: height and rise of the eccentric, torque of brake and friction.
type Outside = ((f64, f64), f64);

impl Sas {
    /// With the parameters that `of` tells by their names, and the brake's drag.
    pub fn new(of: impl Fn(&str) -> f64) -> Self {
        Self {
            wheel_inertia: of("wheel_arm.inertia"),
            wheel_moment: of("wheel_arm.gravity_moment"),
            length: of("wheel_arm.length"),
            offset: of("wheel_arm.offset"),
            body_inertia: of("body_arm.inertia"),
            body_moment: of("body_arm.gravity_moment"),
            stiffness: of("spring.stiffness"),
            free_length: of("spring.free_length"),
            mounts: [of("spring.wheel_arm_mount"), of("spring.body_arm_mount")],
            depth: of("eccentric.depth"),
            rim_radius: of("wheel.rim_radius"),
            thickness: of("wheel.tire_thickness"),
            tire_stiffness: of("tire.stiffness"),
            tire_damping: of("tire.damping"),
            height: of("rest.eccentric_height"),
            // b(0) I = 0.1921 1/s · 1.37 kg m² of Table 1 and 3.1.2.
            drag: Some(0.2632),
            ..Self::default()
        }
    }

    /// Adds the small effects that no model knows, `level` times.
    pub fn clutter(&mut self, level: f64, random: &mut Random) {
        self.bearings = level * random.between(0.003, 0.01);
        let share = level * random.between(0.02, 0.05);
        self.relaxing = Some((share * self.tire_stiffness, random.between(0.005, 0.015)));
    }

    /// By how much the spring is shorter than without load, in m (eq. 14).
    fn pressed(&self, wheel: f64, body: f64) -> f64 {
        let [one, other] = self.mounts;
        self.free_length - (one * one + other * other - 2.0 * one * other * (body - wheel).cos()).sqrt()
    }

    /// By how much the tyre is thinner than without load, in m (eq. 14), and its lever (∂l_t/∂α_1 = −lever), in m.
    fn squeezed(&self, wheel: f64, height: f64) -> (f64, f64) {
        let (sine, cosine) = (self.offset - wheel).sin_cos();
        let gap = self.depth - self.rim_radius - height - self.length * sine;
        (self.thickness - gap, self.length * cosine)
    }

    /// The tyre's static force, in N.
    fn tire(&self, squeezed: f64) -> f64 {
        squeezed * (self.tire_stiffness + self.tire_quadratic * squeezed)
    }

    /// Torques in N m on wheel arm and body arm, of the tyre's force in N, the spring and gravity (eq. 13).
    fn torques(&self, [wheel, body]: [f64; 2], (tire, lever): (f64, f64)) -> [f64; 2] {
        let spring = self.stiffness * self.pressed(wheel, body);
        [
            tire * lever - spring * self.mounts[0] - self.wheel_moment * (self.offset - wheel).cos(),
            spring * self.mounts[1] - self.body_moment * body.cos(),
        ]
    }

    /// Angles of wheel arm and body arm at which nothing moves, and the tyre's force there.
    pub fn rest(&self) -> ([f64; 2], f64) {
        let at = |angles: [f64; 2]| {
            let (squeezed, lever) = self.squeezed(angles[0], self.height);
            self.torques(angles, (self.tire(squeezed), lever))
        };
        // Newton's method, from the printed equilibrium on; slopes are central differences.
        let mut angles = [-0.195, 0.354];
        for _ in 0..20 {
            let slope = |number: usize| {
                let moved = |way: f64| {
                    let mut angles = angles;
                    angles[number] += way;
                    at(angles)
                };
                let (after, before) = (moved(1e-6), moved(-1e-6));
                [0, 1].map(|row| (after[row] - before[row]) / 2e-6)
            };
            let (torques, one, other) = (at(angles), slope(0), slope(1));
            let area = one[0] * other[1] - one[1] * other[0];
            angles[0] -= (torques[0] * other[1] - torques[1] * other[0]) / area;
            angles[1] -= (torques[1] * one[0] - torques[0] * one[1]) / area;
        }
        (angles, self.tire(self.squeezed(angles[0], self.height).0))
    }

    /// Rates, and the force with which the tyre presses on the eccentric.
    fn rates(&self, state: &State, ((height, rise), between): Outside) -> (State, f64) {
        let [wheel, wheel_speed, body, body_speed, stretch] = *state;
        let (squeezed, lever) = self.squeezed(wheel, height);
        let squeezing = rise - lever * wheel_speed;
        let mut force = self.tire(squeezed) + self.tire_damping * squeezing;
        let relaxed = self.relaxing.map_or(0.0, |(stiffness, time)| {
            force += stiffness * stretch;
            squeezing - stretch / time
        });
        // It does not pull.
        let force = force.max(0.0);
        let [on_wheel, on_body] = self.torques([wheel, body], (force, lever));
        let resisting = between + self.bearings * (body_speed - wheel_speed);
        let accelerations =
            [(on_wheel + resisting) / self.wheel_inertia, (on_body - resisting) / self.body_inertia];
        ([wheel_speed, accelerations[0], body_speed, accelerations[1], relaxed], force)
    }

    /// The brake's torque that is commanded, in N m.
    fn commanded(&self, command: &Profile, time: f64, state: &State) -> f64 {
        let commanded = command.at(time).0;
        self.drag.map_or(commanded, |drag| (drag + commanded) * (state[3] - state[1]))
    }

    /// Runs for `duration` seconds from rest: the eccentric `lift` m above its rest, the brake commanded `command`: what it
    /// has beyond its drag, in N m s/rad, or its torque in N m.
    pub fn run(&self, lift: &Profile, command: &Profile, duration: f64) -> Motion {
        let ([wheel, body], _) = self.rest();
        self.run_from([wheel, 0.0, body, 0.0, 0.0], lift, command, duration)
    }

    fn run_from(&self, start: State, lift: &Profile, command: &Profile, duration: f64) -> Motion {
        let step = 1.0 / RATE;
        let mut state = start;
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        for k in 0..=(duration * RATE).round() as usize {
            let time = k as f64 * step;
            motion.command.push(self.commanded(command, time, &state));
            let held: f64 = friction.iter().sum();
            let rates = |time: f64, state: &State| {
                // A torque that comes late was commanded in an earlier step.
                let made = if self.actuator.delay > 0.0 {
                    between(&motion.command, (time - self.actuator.delay) * RATE)
                } else {
                    self.commanded(command, time, state)
                };
                let (lift, rise) = lift.at(time);
                self.rates(state, ((self.height + lift, rise), self.actuator.made_of(made) + held))
            };
            let ahead =
                |rates: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + step * rates[i]) };
            let (first, tire) = rates(time, &state);

            let (second, _) = rates(time + 0.5 * step, &ahead(&first, 0.5 * step));
            let (third, _) = rates(time + 0.5 * step, &ahead(&second, 0.5 * step));
            let (fourth, _) = rates(time + step, &ahead(&third, step));
            motion.tire_force.push(tire);
            for (name, value) in [
                ("eccentric.height", self.height + lift.at(time).0),
                ("brake.torque", motion.command[k]),
                ("body_arm.angle", state[2]),
                ("relative.angle", state[2] - state[0]),
                ("body_arm.acceleration", first[3]),
                ("wheel_arm.acceleration", first[1]),
            ] {
                motion.signals.entry(name).or_default().push(value);
            }

            state = std::array::from_fn(|i| {
                state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
            });
            let mut speeds = [state[3], state[1]];
            let inertias = [self.body_inertia, self.wheel_inertia];
            settle(&self.contacts, &mut friction, [state[2], state[0]], &mut speeds, inertias, step);
            // The correction acted during the step, on average for half of it.
            state[2] += 0.5 * step * (speeds[0] - state[3]);
            state[0] += 0.5 * step * (speeds[1] - state[1]);
            [state[3], state[1]] = speeds;
        }
        motion
    }
}

/// Among samples, straight lines between them; before the first one rest.
fn between(samples: &[f64], place: f64) -> f64 {
    if place < 0.0 {
        return 0.0;
    }
    let at = |k: usize| samples.get(k).or(samples.last()).copied().unwrap_or_default();
    at(place as usize) + place.fract() * (at(place as usize + 1) - at(place as usize))
}

#[cfg(test)]
mod tests;
