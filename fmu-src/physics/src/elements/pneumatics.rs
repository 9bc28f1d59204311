//! A double-acting air cylinder behind a proportional valve of five ports.
//!
//! Flows are volumes of air at the reference atmosphere of ISO 8778 (100 kPa, 20 °C), as data sheets give them. The air in
//! the chambers is taken to be as warm.

use strut_model::{Real, Variables};

use crate::effects::{Stop, behind_backlash, dead_zone, with_constant};

/// Pressure of the reference atmosphere, ISO 8778: 100 kPa.
const REFERENCE_PRESSURE: f64 = 1e5;

/// Pressure of the air around the cylinder, the standard atmosphere of ISO 2533.
pub(crate) const AMBIENT_PRESSURE: f64 = 101_325.0;

/// Cylinder, valve and air; no published rig gives them all, so the declared values are of a cylinder of 32 mm.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PneumaticServo<R> {
    /// Lines to the valve
    pub supply: AirSupply<R>,
    /// Air
    pub air: Air<R>,
    /// Cylinder
    pub cylinder: AirCylinder<R>,
    /// Valve
    pub valve: AirValve<R>,
    /// Spool of the valve
    pub spool: AirSpool<R>,
}

/// What the valve lies between. Pressures are absolute.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirSupply<R> {
    /// Pressure of the supply, absolute
    #[var(unit = PA, start = 7e5, min = 1e5)]
    pub pressure: R,
    /// Pressure behind the exhaust, absolute
    #[var(unit = PA, start = AMBIENT_PRESSURE, min = 1e3)]
    pub exhaust_pressure: R,
}

/// How the temperature of the air follows its compression: exponents between 1 (constant temperature) and 1.4 (no
/// heat through the walls).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Air<R> {
    /// Exponent of what flows in (α_in)
    #[var(unit = ONE, start = 1.4, min = 1.0, max = 1.4)]
    pub filling_exponent: R,
    /// Exponent of what flows out (α_out)
    #[var(unit = ONE, start = 1.0, min = 1.0, max = 1.4)]
    pub emptying_exponent: R,
    /// Exponent of the compression by the piston (α)
    #[var(unit = ONE, start = 1.2, min = 1.0, max = 1.4)]
    pub compression_exponent: R,
}

/// The cylinder. Chamber A drives the piston towards positive positions; the rod goes through chamber B.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirCylinder<R> {
    /// Area of the piston
    #[var(unit = M2, start = 8.042e-4, min = 1e-8)]
    pub area: R,
    /// Area of the rod; zero for a rod on both sides, or none
    #[var(unit = M2, start = 1.131e-4, min = 0.0)]
    pub rod_area: R,
    /// Stroke, half of it to either side of position zero
    #[var(unit = M, start = 0.2, min = 1e-4)]
    pub stroke: R,
    /// Rate of the ends on which the piston runs beyond its stroke
    #[var(unit = N_PER_M, start = 2e5, min = 0.0)]
    pub end_stiffness: R,
    /// Chamber A
    pub chamber_a: AirChamber<R>,
    /// Chamber B
    pub chamber_b: AirChamber<R>,
    /// Laminar leakage past the piston: flow of one pascal between the chambers
    #[var(unit = M5_PER_N_S, start = 0.0, min = 0.0)]
    pub leakage: R,
}

/// A chamber of the cylinder.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirChamber<R> {
    /// Volume with the piston at this end, hose included
    #[var(unit = M3, start = 2e-5, min = 1e-9)]
    pub dead_volume: R,
    /// Constant flow into the chamber, at a constant temperature
    #[var(unit = M3_PER_S, start = 0.0, port)]
    pub flow_offset: R,
}

/// The valve's edges, ISO 6358-1:2013.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirValve<R> {
    /// Sonic conductance of an edge, fully open (C)
    #[var(unit = M5_PER_N_S, start = 1e-8, min = 1e-13)]
    pub conductance: R,
    /// Ratio of pressures below which the flow is as fast as sound (b)
    #[var(unit = ONE, start = 0.3, min = 0.0, max = 0.6)]
    pub critical_ratio: R,
    /// Ratio of pressures above which the flow is laminar, so that its slope stays finite
    #[var(unit = ONE, start = 0.999, min = 0.9, max = 0.99999)]
    pub laminar_ratio: R,
}

/// The spool with its coil and controller, a lag. Its position is a share of its stroke, which is how far an edge is open.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirSpool<R> {
    /// Opening of one volt
    #[var(unit = PER_V, start = 0.2, min = 1e-6)]
    pub gain: R,
    /// Time constant
    #[var(unit = S, start = 5e-3, min = 1e-6)]
    pub time_constant: R,
    /// Opening to either side within which the valve stays closed
    #[var(unit = ONE, start = 0.0, min = 0.0, max = 1.0)]
    pub overlap: R,
    /// Half the backlash with which the opening follows the spool, half the width of the valve's hysteresis
    #[var(unit = ONE, start = 0.0, min = 0.0, max = 1.0)]
    pub hysteresis: R,
}

/// Pressures in the chambers, absolute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressures<R> {
    /// In chamber A.
    pub a: R,
    /// In chamber B.
    pub b: R,
}

/// Flows in m³/s at the reference atmosphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirFlows<R> {
    /// Through the valve into chamber A.
    pub a: R,
    /// Through the valve into chamber B.
    pub b: R,
    /// Past the piston, from chamber A to chamber B.
    pub leak: R,
    /// Out of the supply.
    pub supply: R,
}

impl<R: Real> AirCylinder<R> {
    /// The areas of the piston in chambers A and B.
    #[inline]
    fn areas(&self) -> [R; 2] {
        [self.area, self.area - self.rod_area]
    }
}

impl<R: Real> PneumaticServo<R> {
    /// Rate of the spool: it stops at the ends of its stroke.
    #[inline]
    pub fn spool_rate(&self, voltage: R, position: R) -> R {
        let one = R::from(1.0);
        ((self.spool.gain * voltage).clamp(-one, one) - position) / self.spool.time_constant
    }

    /// How far the valve is open at a position of the spool, and the rate of what follows it.
    #[inline]
    pub fn opening(&self, position: R, follower: R) -> (R, R) {
        let (followed, rate) = behind_backlash(self.spool.hysteresis, follower, position);
        let overlap = self.spool.overlap;
        (if overlap.vanishes() { followed } else { dead_zone(followed, overlap) }, rate)
    }

    /// The flows at an opening. A positive one lets air into chamber A and out of chamber B.
    #[inline]
    pub fn flows(&self, opening: R, at: &Pressures<R>) -> AirFlows<R> {
        let AirSupply { pressure: supply, exhaust_pressure: exhaust } = self.supply;
        let before_a = opening.select(supply, exhaust);
        let before_b = opening.select(exhaust, supply);
        let conductance = self.valve.conductance * opening.abs();
        let (to_a, to_b) =
            (conductance * self.through(before_a, at.a), conductance * self.through(before_b, at.b));
        let leak = self.cylinder.leakage * (at.a - at.b);
        AirFlows { a: to_a, b: to_b, leak, supply: opening.select(to_a, to_b) }
    }

    /// What flows from one pressure to another through an edge, over its conductance: p_1 ψ(p_2/p_1), ISO 6358-1:2013, with
    /// ψ = 1 up to the critical ratio b, and sqrt(1 − ((r − b)/(1 − b))²) beyond it. Above the laminar ratio it goes to
    /// zero along a straight line.
    #[inline]
    fn through(&self, before: R, behind: R) -> R {
        let one = R::from(1.0);
        let AirValve { critical_ratio: b, laminar_ratio, .. } = self.valve;
        let drop = before - behind;
        let (high, low) = (drop.select(before, behind), drop.select(behind, before));
        let ratio = low / high;
        let subsonic = (ratio.min(laminar_ratio) - b).max(R::from(0.0)) / (one - b);
        let laminar = ((one - ratio) / (one - laminar_ratio)).min(one);
        let flow = high * (one - subsonic.squared()).sqrt() * laminar;
        drop.select(flow, -flow)
    }

    /// Rates of the pressures, Richer and Hurmuzlu 2000: what flows in and out, each with its own exponent, and what the piston
    /// compresses.
    #[inline]
    pub fn pressure_rates(
        &self,
        flows: &AirFlows<R>,
        at: &Pressures<R>,
        position: R,
        velocity: R,
    ) -> Pressures<R> {
        let half = self.cylinder.stroke * 0.5;
        let [area_a, area_b] = self.cylinder.areas();
        let Air { filling_exponent, emptying_exponent, compression_exponent } = self.air;
        let carried = |flow: R| flow.select(filling_exponent, emptying_exponent) * flow;
        let rate = |chamber: &AirChamber<R>, area: R, way: R, speed: R, flows: [R; 2], pressure: R| {
            // A chamber that the piston has closed keeps its dead volume.
            let volume = chamber.dead_volume + area * way.max(R::from(0.0));
            let compressed = compression_exponent * pressure * area * way.select(speed, R::from(0.0));
            let flow = with_constant(carried(flows[0]) + carried(flows[1]), chamber.flow_offset);
            (flow * REFERENCE_PRESSURE - compressed) / volume
        };
        let AirCylinder { chamber_a, chamber_b, .. } = &self.cylinder;
        Pressures {
            a: rate(chamber_a, area_a, half + position, velocity, [flows.a, -flows.leak], at.a),
            b: rate(chamber_b, area_b, half - position, -velocity, [flows.b, flows.leak], at.b),
        }
    }

    /// The force of the air on the piston: on its sides, and on the end of the rod.
    #[inline]
    pub fn force(&self, at: &Pressures<R>) -> R {
        let [area_a, area_b] = self.cylinder.areas();
        area_a * at.a - area_b * at.b - self.cylinder.rod_area * AMBIENT_PRESSURE
    }

    /// The force of an end against a piston that runs on it.
    #[inline]
    pub fn end_force(&self, position: R) -> R {
        let half = self.cylinder.stroke * 0.5;
        let stiffness = self.cylinder.end_stiffness;
        Stop { stiffness, compression_clearance: half, rebound_clearance: half }.force(position)
    }
}

impl PneumaticServo<f64> {
    /// Refuses what does not go together; `prefix` is what comes before the names of its parameters.
    ///
    /// # Errors
    /// A sentence with names, values and what must hold.
    pub fn check(&self, prefix: &str) -> Result<(), String> {
        let AirCylinder { area, rod_area, .. } = self.cylinder;
        if rod_area >= area {
            return Err(format!(
                "{prefix}cylinder.rod_area = {rod_area} m2 must be smaller than {prefix}cylinder.area = {area} m2, which \
                 is the piston's"
            ));
        }
        let AirSupply { pressure, exhaust_pressure } = self.supply;
        if exhaust_pressure < pressure {
            return Ok(());
        }
        Err(format!(
            "{prefix}supply.exhaust_pressure = {exhaust_pressure} Pa must be smaller than {prefix}supply.pressure = \
             {pressure} Pa; both are absolute"
        ))
    }
}

#[cfg(test)]
mod tests;
