//! A double-acting cylinder behind a four-way servovalve.

use strut_model::{Choice, Real, Variables};

use crate::effects::{behind_backlash, dead_zone, with_constant};

/// How the flow through the valve follows from spool position and load pressure.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum ValveLaw {
    /// Sharp-edged orifices (Konieczny eq. 2.9)
    Nonlinear,
    /// Proportional to the spool position: the slopes at the working point of no pressure (Konieczny eq. 2.23)
    Linear,
    /// A plane through the characteristic, by regression over a range (Konieczny eq. 2.24)
    Regression,
}

/// Cylinder and valve of Konieczny 2.1; the declared values are those of the document.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ServoCylinder<R> {
    /// Supply
    pub supply: Supply<R>,
    /// Fluid
    pub fluid: Fluid<R>,
    /// Cylinder
    pub cylinder: Cylinder<R>,
    /// Valve
    pub valve: ServoValve<R>,
    /// Spool of the valve
    pub spool: Spool<R>,
}

/// The unit that supplies the actuator.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Supply<R> {
    /// Pressure above that of the return line (P_z)
    #[var(unit = PA, start = 12e6, min = 1e6, max = 16e6)]
    pub pressure: R,
}

/// The oil.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Fluid<R> {
    /// Density (ρ)
    #[var(unit = KG_PER_M3, start = 880.0, min = 1.0)]
    pub density: R,
    /// Bulk modulus (E)
    #[var(unit = PA, start = 1.4e9, min = 1e6)]
    pub bulk_modulus: R,
}

/// The cylinder, its rod on both sides.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<R> {
    /// Effective area of the piston (A_a)
    #[var(unit = M2, start = 0.765786e-3, min = 1e-7)]
    pub area: R,
    /// Volume of both chambers (V_t)
    #[var(unit = M3, start = 45.9458e-6, min = 1e-9)]
    pub volume: R,
    /// Volume of the hoses (V_p)
    #[var(unit = M3, start = 80.0398e-6, min = 0.0)]
    pub hose_volume: R,
    /// Leakage from chamber to chamber (C_tm)
    #[var(unit = M5_PER_N_S, start = 15e-12, min = 0.0)]
    pub leakage: R,
    /// Constant force of the piston that pulls body and wheel together
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
    /// Constant flow into the chamber that drives body and wheel apart, and out of the other one
    #[var(unit = M3_PER_S, start = 0.0, port)]
    pub flow_offset: R,
}

/// The valve's orifices.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ServoValve<R> {
    /// Discharge coefficient (C_d)
    #[var(unit = ONE, start = 0.611, min = 1e-3, max = 1.0)]
    pub discharge_coefficient: R,
    /// Perimeter of the spool: the width of an orifice (l = π d)
    #[var(unit = M, start = 15.708e-3, min = 1e-6)]
    pub perimeter: R,
    /// Pressure drop below which the flow is laminar, and proportional to it
    #[var(unit = PA, start = 0.1e6, min = 1.0)]
    pub laminar_pressure: R,
    /// Plane of the regression
    pub regression: Plane<R>,
}

/// A plane `Q = flow_gain · u_1 − pressure_coefficient · P_r`; the declared values are those of Konieczny eq.
/// 2.24 over its α.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Plane<R> {
    /// Flow of one metre of spool displacement (4.666e13/α)
    #[var(unit = M2_PER_S, start = 1.049_730, min = 1e-9)]
    pub flow_gain: R,
    /// Flow that one pascal of load pressure takes (341.2/α)
    #[var(unit = M5_PER_N_S, start = 7.676_12e-12, min = 0.0)]
    pub pressure_coefficient: R,
}

/// The spool with its pilot stage, a lag (Konieczny eq. 2.13).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Spool<R> {
    /// Displacement of one volt (k_sv)
    #[var(unit = M_PER_V, start = 0.025e-3, min = 1e-9)]
    pub gain: R,
    /// Time constant (τ); the declared one holds for a supply of 12 MPa
    #[var(unit = S, start = 2.32e-3, min = 1e-6)]
    pub time_constant: R,
    /// Largest displacement to either side (u_1max)
    #[var(unit = M, start = 0.5e-3, min = 1e-6)]
    pub stroke: R,
    /// Displacement to either side within which the valve stays closed
    #[var(unit = M, start = 0.0, min = 0.0)]
    pub overlap: R,
    /// Half the backlash with which the opening follows the spool, half the width of the valve's hysteresis
    #[var(unit = M, start = 0.0, min = 0.0)]
    pub hysteresis: R,
}

/// What follows from cylinder and valve.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Hydraulics<R> {
    /// Pressure of one cubic metre of oil forced in: 4 E/(V_t + V_p) (α)
    #[var(unit = N_PER_M5)]
    pub coefficient: R,
    /// Rate of the oil as a spring under the piston: α A_a²
    #[var(unit = N_PER_M)]
    pub stiffness: R,
    /// Flow of one metre of spool displacement without load: l C_d sqrt(P_z/ρ)
    #[var(unit = M2_PER_S)]
    pub flow_gain: R,
    /// Piston speed of one volt without load
    #[var(unit = M_PER_V_S)]
    pub velocity_gain: R,
    /// Force at which the supply pressure drives no more flow: A_a P_z
    #[var(unit = N)]
    pub stall_force: R,
}

/// Flows through the valve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow<R> {
    /// Into the chamber that drives body and wheel apart, and out of the other one; the cylinder's constant one included.
    pub load: R,
    /// Out of the supply.
    pub supply: R,
}

impl<R: Real> ServoCylinder<R> {
    /// What does not change while it works.
    pub fn hydraulics(&self) -> Hydraulics<R> {
        let Self { supply, fluid, cylinder, valve, spool } = *self;
        let coefficient = fluid.bulk_modulus * 4.0 / (cylinder.volume + cylinder.hose_volume);
        let flow_gain =
            valve.perimeter * valve.discharge_coefficient * (supply.pressure / fluid.density).sqrt();
        Hydraulics {
            coefficient,
            stiffness: coefficient * cylinder.area.squared(),
            flow_gain,
            velocity_gain: flow_gain * spool.gain / cylinder.area,
            stall_force: cylinder.area * supply.pressure,
        }
    }

    /// The force that pushes body and wheel apart, Konieczny eq. 2.12, less the piston's constant force.
    #[inline]
    pub fn force(&self, pressure: R) -> R {
        with_constant(self.cylinder.area * pressure, -self.cylinder.preload)
    }

    /// Rate of the spool position, Konieczny eq. 2.13.
    ///
    /// The stroke limits what the pilot stage aims at, so that the spool nears its stop as it nears any position.
    #[inline]
    pub fn spool_rate(&self, voltage: R, position: R) -> R {
        let target = (self.spool.gain * voltage).clamp(-self.spool.stroke, self.spool.stroke);
        (target - position) * (R::from(1.0) / self.spool.time_constant)
    }

    /// Rate of the pressure difference, Konieczny eq. 2.11 over A_a: what flows in and is neither displaced by the
    /// piston nor leaks must be compressed.
    #[inline]
    pub fn pressure_rate(&self, hydraulics: &Hydraulics<R>, flow: R, velocity: R, pressure: R) -> R {
        let cylinder = &self.cylinder;
        hydraulics.coefficient * (flow - cylinder.area * velocity - cylinder.leakage * pressure)
    }

    /// Where the spool stands as far as the opening is concerned, and the rate of what follows it.
    #[inline]
    pub fn followed(&self, position: R, follower: R) -> (R, R) {
        behind_backlash(self.spool.hysteresis, follower, position)
    }

    /// The flows at a spool position, as the opening follows it, and a pressure difference.
    #[inline]
    pub fn flow(&self, law: ValveLaw, hydraulics: &Hydraulics<R>, position: R, pressure: R) -> Flow<R> {
        let overlap = self.spool.overlap;
        let position = if overlap.vanishes() { position } else { dead_zone(position, overlap) };
        let flow = match law {
            ValveLaw::Nonlinear => self.orifices(hydraulics, position, pressure),
            ValveLaw::Linear => {
                Flow { load: hydraulics.flow_gain * position, supply: hydraulics.flow_gain * position.abs() }
            }
            ValveLaw::Regression => {
                let Plane { flow_gain, pressure_coefficient } = self.valve.regression;
                Flow {
                    load: flow_gain * position - pressure_coefficient * pressure,
                    supply: flow_gain * position.abs(),
                }
            }
        };
        Flow { load: with_constant(flow.load, self.cylinder.flow_offset), ..flow }
    }

    /// Konieczny eq. 2.9, `u_1 l C_d sqrt((P_z − sign(u_1) P_r)/ρ)`, with what a root leaves open.
    ///
    /// With the flow gain without load, `k_q = l C_d sqrt(P_z/ρ)`, it is `k_q u_1 sqrt(s)`, s = 1 − sign(u_1)
    /// P_r/P_z. A load pressure above that of the supply drives the oil back, `−sqrt(−s)`. Near s = 0 the flow is
    /// laminar, proportional to the pressure drop, so that the slope of the root stays finite.
    #[inline]
    fn orifices(&self, hydraulics: &Hydraulics<R>, position: R, pressure: R) -> Flow<R> {
        let (one, per_supply) = (R::from(1.0), R::from(1.0) / self.supply.pressure);
        let share = one - position.select(pressure, -pressure) * per_supply;
        let turbulent = share.abs().max(self.valve.laminar_pressure * per_supply);
        let through = hydraulics.flow_gain * share / turbulent.sqrt();
        Flow { load: position * through, supply: position.abs() * through }
    }

    /// The energy of the compressed oil at a pressure difference.
    pub fn energy(&self, hydraulics: &Hydraulics<R>, pressure: R) -> R {
        pressure.squared() / (hydraulics.coefficient * 2.0)
    }
}

impl ServoCylinder<f64> {
    /// Refuses what does not go together; `prefix` is what comes before the names of its parameters.
    ///
    /// # Errors
    /// A sentence with names, values and what must hold.
    pub fn check(&self, prefix: &str) -> Result<(), String> {
        if self.valve.laminar_pressure < self.supply.pressure {
            return Ok(());
        }
        Err(format!(
            "{prefix}valve.laminar_pressure = {} Pa must be smaller than {prefix}supply.pressure = {} Pa: \
             without load the flow is turbulent",
            self.valve.laminar_pressure, self.supply.pressure
        ))
    }
}

#[cfg(test)]
mod tests;
