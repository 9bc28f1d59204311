//! A double-acting pneumatic cylinder behind a proportional 5/3 valve; its rod moves a mass on a level guide. Flows are those of
//! ISO 6358-1:2013, pressures those of Richer and Hurmuzlu (J. Dyn. Sys. Meas. Control 122, 2000, 416–425); Beater has both
//! (Pneumatic Drives, Springer 2007). A position loop drives the valve, with a dither on top.

use std::f64::consts::PI;

use crate::car::{Motion, RATE};
use crate::excitation::Profile;
use crate::friction::{Contact, settle};
use crate::random::Random;

/// Gas constant of air, in J/(kg K).
const GAS: f64 = 287.0;
/// Of the air everywhere, and of the reference atmosphere, in K.
const TEMPERATURE: f64 = 293.15;
/// Density of air at 100 kPa and 293.15 K, in kg/m³ (ρ_0).
const DENSITY: f64 = 1e5 / (GAS * TEMPERATURE);
/// Ratio of pressures from which on a flow is laminar: the root would end there with an infinite slope.
const LAMINAR: f64 = 0.999;
/// How much an inflow counts (α_in): between 1, isothermal, and 1.4, adiabatic.
const INFLOW: f64 = 1.4;
/// The same of an outflow (α_out).
const OUTFLOW: f64 = 1.0;
/// The same of a volume's rate of change (α).
const EXPANSION: f64 = 1.2;

/// Valve, cylinder, mass and loop. Of what there is twice, chamber A comes first: its pressure pushes the rod out.
#[derive(Clone, Debug)]
pub struct Pneumatic {
    /// Of load, rod and piston, in kg.
    pub mass: f64,
    /// Viscous friction of the guide, in N s/m.
    pub damping: f64,
    /// Dry friction of the guide.
    pub contacts: Vec<Contact>,
    /// Against positive positions, in N.
    pub load: f64,
    /// Of the piston, in m².
    pub areas: [f64; 2],
    /// In m; the position counts from its middle.
    pub stroke: f64,
    /// Beyond the stroke, hoses included, in m³.
    pub dead_volumes: [f64; 2],
    /// Absolute, in Pa.
    pub supply: f64,
    /// Absolute, in Pa.
    pub ambient: f64,
    /// Of each edge of the fully open valve, in m³/(s Pa) (C).
    pub conductance: f64,
    /// Ratio of pressures below which a flow is choked (b).
    pub critical_ratio: f64,
    /// Opening for a volt, in 1/V; at 1 the valve is fully open.
    pub gain: f64,
    /// Of the opening, in s.
    pub time_constant: f64,
    /// Opening to each side through which nothing flows.
    pub overlap: f64,
    /// From chamber to chamber, in m³/(s Pa) of air as dense as before the valve at 100 kPa.
    pub leakage: f64,
    /// Pressure in chamber A at rest, in Pa; that in chamber B holds the balance.
    pub rest: f64,
    /// Of the position; none where the voltage itself is given.
    pub control: Option<Loop>,
    /// Pressure that is lost in the supply's hose and in the silencer of the exhaust, in Pa s/kg. Clutter.
    pub hoses: [f64; 2],
}

/// A position controller: proportional, with a little feedback of velocity and acceleration, as the air swings with the mass and
/// hardly anything damps that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// In V/m.
    pub proportional: f64,
    /// In V s/m.
    pub velocity: f64,
    /// In V s²/m.
    pub acceleration: f64,
    /// Largest command to each side, in V.
    pub most: f64,
}

impl Loop {
    /// The command in V, by an error of the position in m, a velocity in m/s, an acceleration in m/s² and a dither in V.
    fn command(&self, error: f64, velocity: f64, acceleration: f64, dither: f64) -> f64 {
        let asked = self.proportional * error - self.velocity * velocity - self.acceleration * acceleration;
        (asked + dither).clamp(-self.most, self.most)
    }
}

/// Position, velocity, pressures of both chambers, opening of the valve.
type State = [f64; 5];

/// What flows by ratio of the pressures, over what flows choked (ψ).
fn choked_share(ratio: f64, critical: f64) -> f64 {
    let subsonic = |ratio: f64| (1.0 - ((ratio - critical) / (1.0 - critical)).powi(2)).sqrt();
    if ratio <= critical {
        1.0
    } else if ratio <= LAMINAR {
        subsonic(ratio)
    } else {
        subsonic(LAMINAR) * (1.0 - ratio) / (1.0 - LAMINAR)
    }
}

impl Pneumatic {
    /// With the parameters that `of` tells by their names. All that a drawing, a manometer or a data sheet tells exactly has no name:
    /// a bore of 32 mm, a rod of 12 mm, and the rest.
    pub fn new(of: impl Fn(&str) -> f64) -> Self {
        let circle = |diameter: f64| 0.25 * PI * diameter * diameter;
        Self {
            mass: of("moving_mass"),
            damping: of("guide.damping"),
            contacts: vec![],
            load: 0.0,
            areas: [circle(0.032), circle(0.032) - circle(0.012)],
            stroke: 0.2,
            dead_volumes: [2e-5; 2],
            supply: 7e5,
            ambient: 1.013e5,
            conductance: of("actuator.valve.conductance"),
            critical_ratio: 0.3,
            gain: 0.2,
            time_constant: 5e-3,
            overlap: 0.0,
            leakage: 0.0,
            rest: 5.4e5,
            control: Some(Loop { proportional: 20.0, velocity: 1.0, acceleration: 0.06, most: 5.0 }),
            hoses: [0.0; 2],
        }
    }

    /// Adds the small effects that no model knows, `level` times.
    pub fn clutter(&mut self, level: f64, random: &mut Random) {
        self.hoses = [random.between(3e5, 1.2e6), random.between(3e5, 1.2e6)].map(|loss| level * loss);
    }

    /// Mass flow through an edge of the valve from one pressure to the other, in kg/s.
    fn edge(&self, opening: f64, from: f64, to: f64) -> f64 {
        let through = |up: f64, down: f64| {
            self.conductance * opening * DENSITY * up * choked_share(down / up, self.critical_ratio)
        };
        if from >= to { through(from, to) } else { -through(to, from) }
    }

    /// Mass flow through the valve into a chamber, in kg/s: by an opening from the supply, by a negative one from the exhaust.
    fn inflow(&self, opening: f64, pressure: f64) -> f64 {
        let (port, loss) =
            if opening > 0.0 { (self.supply, self.hoses[0]) } else { (self.ambient, self.hoses[1]) };
        let free = self.edge(opening.abs(), port, pressure);
        // What hose and silencer take of the pressure is little, and is counted from the flow without them.
        if loss > 0.0 { self.edge(opening.abs(), port - loss * free, pressure) } else { free }
    }

    /// Of both chambers, in m³.
    fn volumes(&self, x: f64) -> [f64; 2] {
        let [one, other] = [0.5 * self.stroke + x, 0.5 * self.stroke - x];
        [self.dead_volumes[0] + self.areas[0] * one, self.dead_volumes[1] + self.areas[1] * other]
    }

    /// On the mass by the air alone, in N.
    fn push(&self, pressures: [f64; 2]) -> f64 {
        let [one, other] = self.areas;
        one * pressures[0] - other * pressures[1] - (one - other) * self.ambient
    }

    /// At rest in the middle, the valve shut.
    fn still(&self) -> State {
        let other = (self.push([self.rest, 0.0]) - self.load) / self.areas[1];
        [0.0, 0.0, self.rest, other, 0.0]
    }

    /// Rates at a command in V, against `friction` in N.
    fn rates(&self, state: &State, command: f64, friction: f64) -> State {
        let [x, v, one, other, spool] = *state;
        let opening = spool - spool.clamp(-self.overlap, self.overlap);
        let leak = DENSITY * self.leakage * (one - other);
        let rate = |pressure: f64, volume: f64, growth: f64, flows: [f64; 2]| {
            let weighted = |flow: f64| flow * if flow > 0.0 { INFLOW } else { OUTFLOW };
            let carried = GAS * TEMPERATURE * flows.into_iter().map(weighted).sum::<f64>();
            (carried - EXPANSION * pressure * growth) / volume
        };
        let [volume, other_volume] = self.volumes(x);
        let force = self.push([one, other]) - self.load - self.damping * v - friction;
        [
            v,
            force / self.mass,
            rate(one, volume, self.areas[0] * v, [self.inflow(opening, one), -leak]),
            rate(other, other_volume, -self.areas[1] * v, [self.inflow(-opening, other), leak]),
            ((self.gain * command).clamp(-1.0, 1.0) - spool) / self.time_constant,
        ]
    }

    /// The state a step later, of `first` the rates at its beginning; `friction` is what each contact carries.
    fn advanced(&self, state: &State, first: &State, command: f64, friction: &mut [f64]) -> State {
        let step = 1.0 / RATE;
        let held = friction.iter().sum();
        let ahead =
            |rates: &State, step: f64| -> State { std::array::from_fn(|i| state[i] + step * rates[i]) };
        let second = self.rates(&ahead(first, 0.5 * step), command, held);
        let third = self.rates(&ahead(&second, 0.5 * step), command, held);
        let fourth = self.rates(&ahead(&third, step), command, held);
        let mut next: State = std::array::from_fn(|i| {
            state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        });
        // The guide stands: a second body that nothing moves.
        let mut velocities = [next[1], 0.0];
        settle(&self.contacts, friction, [next[0], 0.0], &mut velocities, [self.mass, f64::INFINITY], step);
        next[0] += 0.5 * step * (velocities[0] - next[1]);
        next[1] = velocities[0];
        next
    }

    /// Follows `reference`, in m, for `duration` seconds; the valve is commanded what the loop asks for and a dither in V, without a
    /// loop the dither alone.
    pub fn run(&self, reference: &Profile, dither: &Profile, duration: f64) -> Motion {
        let mut state = self.still();
        let mut friction = vec![0.0; self.contacts.len()];
        let mut motion = Motion::default();
        for k in 0..=(duration * RATE).round() as usize {
            let (time, held) = (k as f64 / RATE, friction.iter().sum());
            let [wanted, dither] = [reference, dither].map(|profile| profile.at(time).0);
            // The mass does not feel the command at once, but through the opening.
            let acceleration = self.rates(&state, 0.0, held)[1];
            let command = self
                .control
                .map_or(dither, |control| control.command(wanted - state[0], state[1], acceleration, dither));
            let first = self.rates(&state, command, held);
            motion.command.push(command);
            for (name, value) in [
                ("valve.voltage", command),
                ("position", state[0]),
                ("acceleration", first[1]),
                ("chamber_a.pressure", state[2]),
                ("chamber_b.pressure", state[3]),
            ] {
                motion.signals.entry(name).or_default().push(value);
            }
            state = self.advanced(&state, &first, command, &mut friction);
        }
        motion
    }
}

#[cfg(test)]
mod tests;
