//! A pump actuator alone: its piston is moved, its motor's torque commanded (Ajala eq. 1 to 9, with v = −ż_e positive in
//! rebound).

use std::f64::consts::TAU;

use crate::car::{Actuator, Motion, RATE};
use crate::excitation::Profile;
use crate::friction::{Contact, settle};
use crate::random::Random;

/// Points of a valve's characteristic.
pub const POINTS: usize = 9;

/// A valve's characteristic: straight between its points, and beyond them as before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Valve {
    /// Rising, in m³/s.
    pub flow: [f64; POINTS],
    /// What each flow costs, in Pa; rising.
    pub drop: [f64; POINTS],
}

impl Valve {
    /// What a flow in m³/s costs, in Pa.
    fn at(&self, flow: f64) -> f64 {
        let above = self.flow.iter().position(|point| *point > flow).unwrap_or(POINTS);
        let left = above.clamp(1, POINTS - 1) - 1;
        let share = (flow - self.flow[left]) / (self.flow[left + 1] - self.flow[left]);
        self.drop[left] + share * (self.drop[left + 1] - self.drop[left])
    }
}

/// Pump with motor, piston, and on each side a valve and gas; where there are two of them, that of compression comes first.
#[derive(Clone, Debug, Default)]
pub struct Pump {
    /// Volume of one revolution, in m³ (V_c).
    pub displacement: f64,
    /// Of motor and pump, in kg m² (J_m).
    pub inertia: f64,
    /// Of the piston, in m² (A_k, A_r).
    pub areas: [f64; 2],
    /// Pressure of the gas at rest, in Pa (p_0).
    pub charge: f64,
    /// Polytropic exponent of the gas (κ).
    pub exponent: f64,
    /// Of the gas at rest, in m³ (V_k0, V_r0).
    pub volumes: [f64; 2],
    /// Δp over the flow into the gas (eq. 7, 8).
    pub valves: [Valve; 2],
    /// From side to side through the pump, in m⁵/(N s).
    pub leakage: f64,
    /// Dry friction of motor and pump: torques in N m.
    pub contacts: Vec<Contact>,
    /// Motor whose torque is commanded.
    pub actuator: Actuator,
    /// Friction of the piston's seals in N, and the velocity in m/s at which half of it is there. Clutter.
    pub seals: Option<(f64, f64)>,
    /// Time in s in which the gas gets back to its walls' temperature. Clutter.
    pub cooling: Option<f64>,
}

/// Pressures and volumes of the gas, speed of the motor.
type State = [f64; 5];

impl Pump {
    /// With the parameters that `of` tells by their names.
    pub fn new(of: impl Fn(&str) -> f64) -> Self {
        let both = |name: &str| ["compression", "rebound"].map(|side| of(&name.replace('*', side)));
        let table = |name: &str| std::array::from_fn(|point| of(&format!("{name}[{}]", point + 1)));
        let valve = |side: &str| Valve {
            flow: table(&format!("valve.{side}.flow")),
            drop: table(&format!("valve.{side}.pressure_drop")),
        };
        Self {
            displacement: of("pump.displacement"),
            inertia: of("motor.inertia"),
            areas: both("piston.*_area"),
            charge: of("gas.charge_pressure"),
            exponent: of("gas.exponent"),
            volumes: both("gas.*_volume"),
            valves: [valve("compression"), valve("rebound")],
            ..Self::default()
        }
    }

    /// Adds the small effects that no model knows, `level` times.
    pub fn clutter(&mut self, level: f64, random: &mut Random) {
        self.seals = Some((level * random.between(4.0, 12.0), random.between(0.03, 0.1)));
        self.cooling = Some(random.between(10.0, 30.0) / level);
    }

    /// What a speed in rad/s moves, in m³/s (eq. 5 without leakage).
    fn moved(&self, speed: f64) -> f64 {
        self.displacement / TAU * speed
    }

    /// Flows into the gas at a flow of the pump and a velocity of the piston (eq. 9).
    fn gas_flows(&self, pumped: f64, velocity: f64) -> [f64; 2] {
        [pumped - velocity * self.areas[0], velocity * self.areas[1] - pumped]
    }

    /// Pressures on the piston (eq. 7).
    fn on_piston(&self, gas: [f64; 2], flows: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|side| gas[side] + self.valves[side].at(flows[side]))
    }

    /// The pump's flow, less what leaks back by the pressures on the piston that this very flow makes.
    fn pumped(&self, gas: [f64; 2], speed: f64, velocity: f64) -> f64 {
        let moved = self.moved(speed);
        if self.leakage == 0.0 {
            return moved;
        }
        // It rises with the flow, and is straight between the flows at which a valve's characteristic has a corner.
        let excess = |pumped: f64| {
            let [one, other] = self.on_piston(gas, self.gas_flows(pumped, velocity));
            pumped + self.leakage * (one - other) - moved
        };
        let corners = self.valves[0].flow.map(|flow| flow + velocity * self.areas[0]);
        let others = self.valves[1].flow.map(|flow| velocity * self.areas[1] - flow);
        let (mut below, mut above) = (None, None);
        for corner in corners.into_iter().chain(others) {
            let excess = excess(corner);
            if excess < 0.0 {
                below =
                    below.into_iter().chain([(corner, excess)]).reduce(|a, b| if a.0 > b.0 { a } else { b });
            } else {
                above =
                    above.into_iter().chain([(corner, excess)]).reduce(|a, b| if a.0 < b.0 { a } else { b });
            }
        }
        // Beyond the last corner it goes on as straight.
        let beside = |(corner, _): (f64, f64), way: f64| (corner + way, excess(corner + way));
        let (one, other) = match (below, above) {
            (Some(below), Some(above)) => (below, above),
            (Some(below), None) => (below, beside(below, 1e-3)),
            (None, Some(above)) => (beside(above, -1e-3), above),
            (None, None) => return moved,
        };
        one.0 - one.1 * (other.0 - one.0) / (other.1 - one.1)
    }

    /// Rates, and the pressures on the piston.
    fn rates(&self, state: &State, velocity: f64, torque: f64) -> (State, [f64; 2]) {
        let [compression, rebound, one, other, speed] = *state;
        let (gas, volumes) = ([compression, rebound], [one, other]);
        let flows = self.gas_flows(self.pumped(gas, speed, velocity), velocity);
        let pressures = self.on_piston(gas, flows);
        let rate = |side: usize| {
            // Eq. 2 and 3; what is warmer than its walls gets cold, and keeps its volume.
            let cooled = self.charge * self.volumes[side] / volumes[side];
            let cooling = self.cooling.map_or(0.0, |time| (gas[side] - cooled) / time);
            self.exponent * flows[side] * gas[side] / volumes[side] - cooling
        };
        // Eq. 4.
        let load = self.displacement / TAU * (pressures[0] - pressures[1]);
        ([rate(0), rate(1), -flows[0], -flows[1], (torque - load) / self.inertia], pressures)
    }

    /// The force that pushes body and wheel apart in N, less that at rest (eq. 6).
    fn force(&self, pressures: [f64; 2], velocity: f64) -> f64 {
        let rubbing = self.seals.map_or(0.0, |(force, scale)| force * velocity / (velocity.abs() + scale));
        (pressures[0] - self.charge) * self.areas[0] - (pressures[1] - self.charge) * self.areas[1] - rubbing
    }

    /// Runs for `duration` seconds: the piston at `velocity` m/s, the motor commanded `torque` N m.
    pub fn run(&self, velocity: &Profile, torque: &Profile, duration: f64) -> Motion {
        let step = 1.0 / RATE;
        let mut state: State = [self.charge, self.charge, self.volumes[0], self.volumes[1], 0.0];
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        for k in 0..=(duration * RATE).round() as usize {
            let time = k as f64 * step;
            let held: f64 = friction.iter().sum();
            let rates = |time: f64, state: &State| {
                let made = self.actuator.made_of(torque.at(time - self.actuator.delay).0);
                self.rates(state, velocity.at(time).0, made - held)
            };
            let ahead =
                |rates: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + step * rates[i]) };
            let (first, pressures) = rates(time, &state);
            let (moved, commanded) = (velocity.at(time).0, torque.at(time).0);
            motion.command.push(commanded);
            for (name, value) in [
                ("suspension.velocity", moved),
                ("motor.torque", commanded),
                ("force", self.force(pressures, moved)),
                ("motor.speed", state[4]),
                ("pressure.compression", state[0]),
                ("pressure.rebound", state[1]),
            ] {
                motion.signals.entry(name).or_default().push(value);
            }

            let (second, _) = rates(time + 0.5 * step, &ahead(&first, 0.5 * step));
            let (third, _) = rates(time + 0.5 * step, &ahead(&second, 0.5 * step));
            let (fourth, _) = rates(time + step, &ahead(&third, step));
            state = std::array::from_fn(|i| {
                state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
            });
            // The housing stands: a second body that nothing turns.
            let mut speeds = [state[4], 0.0];
            settle(&self.contacts, &mut friction, [0.0; 2], &mut speeds, [self.inertia, f64::INFINITY], step);
            state[4] = speeds[0];
        }
        motion
    }
}

#[cfg(test)]
mod tests;
