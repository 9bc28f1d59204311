//! The electrohydraulic actuator of the AGH rig.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Method, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::elements::{Cylinder, Fluid, Hydraulics, ServoCylinder, ServoValve, Spool, Supply, ValveLaw};
use crate::signals::TravelRate;

mod load;
use load::{Load, LoadMemory, Pressed};

/// A cylinder that a servovalve controls, Konieczny 2.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoHydraulicActuator {
    law: ValveLaw,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Law of the flow through the valve
    #[set(start = ValveLaw::Nonlinear)]
    law: ValveLaw,
}

/// What the actuator is made of: that of [`ServoCylinder`], and what it knows of its load.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
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
    /// Load, as estimated
    pub load: Load<R>,
}

impl<R: Real> Parameters<R> {
    fn cylinder(&self) -> ServoCylinder<R> {
        let Self { supply, fluid, cylinder, valve, spool, .. } = *self;
        ServoCylinder { supply, fluid, cylinder, valve, spool }
    }
}

/// What is remembered from one communication point to the next.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Memory<R> {
    /// Load
    pub load: LoadMemory<R>,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Control voltage of the valve (v)
    #[var(unit = V)]
    pub voltage: R,
    /// Suspension
    pub suspension: TravelRate<R>,
}

/// What goes on inside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Pressure difference of the chambers, positive if it drives body and wheel apart (P_r)
    #[var(unit = PA, nominal = 1e6, output)]
    pub pressure: R,
    /// Spool
    pub spool: SpoolState<R>,
}

/// The spool of the valve.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct SpoolState<R> {
    /// Displacement from the middle, positive if it lets body and wheel be driven apart (u_1)
    #[var(unit = M, nominal = 1e-4, output)]
    pub position: R,
    /// Where the opening has followed it to, a band's edge or anywhere within the band
    #[var(unit = M, nominal = 1e-4)]
    pub follower: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Force that pushes body and wheel apart (f_s)
    #[var(unit = N)]
    pub force: R,
    /// Supply
    pub supply: SupplyOutput<R>,
}

/// What the supplying unit gives.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct SupplyOutput<R> {
    /// Flow out of the supply, negative where the load drives oil back
    #[var(unit = M3_PER_S)]
    pub flow: R,
    /// Power out of the supply (P_z Q_z)
    #[var(unit = W)]
    pub power: R,
}

/// Equations of cylinder and valve, wherever they are built in.
pub(crate) const EQUATIONS: &[Equation] = &[
    Equation { text: "f_s = A_a P_r - F_0c", source: "Konieczny eq. 2.12; F_0c: port of diagnosis" },
    Equation {
        text: "P_r' = alpha (Q + Q_0 - A_a v - C_tm P_r), alpha = 4 E/(V_t + V_p), v = z_2' - z_1'",
        source: "Konieczny eq. 2.3-2.8, 2.11; Q_0: port of diagnosis",
    },
    Equation {
        text: "nonlinear: Q = u_1 l C_d sqrt((P_z - sign(u_1) P_r)/rho)",
        source: "Konieczny eq. 2.9",
    },
    Equation { text: "linear: Q = u_1 l C_d sqrt(P_z/rho)", source: "Konieczny eq. 2.23" },
    Equation { text: "regression: alpha Q = 4.666e13 u_1 - 341.2 P_r", source: "Konieczny eq. 2.24" },
    Equation { text: "tau u_1' + u_1 = k_sv v, |k_sv v| <= u_1max", source: "Konieczny eq. 2.13" },
    Equation {
        text: "spool.overlap d, spool.hysteresis h: in Q u_1 becomes dz(u_1 - clamp(u_1 - y, -h, h), d), T y' = dz(u_1 - y, h), T \
            = 0.5 ms, dz a dead zone",
        source: "docs/effects.md: 28",
    },
    Equation {
        text: "supply: Q_z = sign(u_1) Q, of the regression |u_1| 4.666e13/alpha; power P_z Q_z",
        source: "Konieczny 3",
    },
];

/// What must be known about cylinder and valve, wherever they are built in.
pub(crate) const NOTES: &[&str] = &[
    "Where the root of eq. 2.9 ends: a load pressure above that of the supply drives the oil back through \
     the open valve, so that the flow is -sqrt(-s) there; within laminar_pressure (assumed: 0.1 MPa, where a \
     gap of 0.05 mm has a Reynolds number near 20) of the balance the flow is laminar, proportional to the \
     pressure drop. That keeps every slope finite. Beyond the supply pressure the low chamber would \
     cavitate, which eq. 2.9 excludes: read such pressures as a warning.",
    "Balance: the supply gives P_z Q_z, of which the valve turns Q_z (P_z - sign(u_1) P_r) into heat, the \
     leakage C_tm P_r^2; P_r^2/(2 alpha) is the energy of the compressed oil. With the spool in the middle \
     nothing brings energy in.",
    "The stroke of the spool limits what the pilot stage aims at, so that the spool nears its stop as it \
     nears any position. The time constant is given for a supply of 12 MPa.",
    "Konieczny prints alpha = 44.4495 N/m5; 4 E/(V_t + V_p) of the printed values is 44.4495e12 N/m5.",
    "Konieczny prints C_d = pi/pi + 2; it is pi/(pi + 2) = 0.611.",
    "Konieczny prints A_a = 0.765786e-3 m2, but V_t = 45.9458e-6 m3 is h = 0.06 m times 0.765763e-3 m2, \
     which is the ring of a 40 mm piston on a 25 mm rod: the last two digits of A_a are misprinted (3e-5 of \
     it). The printed value is kept.",
    "Konieczny eq. 2.6 and 2.9 print the leakage and the flow of the valve each as equal to A_a v. They hold \
     together only as the balance eq. 2.11: Q = A_a v + C_tm P_r + P_r'/alpha. (Eq. 2.10 is eq. 2.9 times \
     alpha A_a, not times a derivative of a force.) The units of eq. 2.8 are right: N/s.",
    "Konieczny eq. 2.21 has |P_r| where eq. 2.18 has sign(u_1) P_r. They agree only while pressure and spool \
     have the same sign; with opposite signs the flow is larger than without load, not smaller.",
    "Konieczny eq. 2.24, said to be a regression over +-7 MPa and +-0.25 mm, does not come out of eq. 2.18: \
     evenly spaced points give 4.905e13 u_1 - 268.3 P_r, sines of these amplitudes 4.868e13 u_1 - 342.6 P_r, \
     and eq. 2.23 4.982e13 u_1. The printed plane is kept for the choice Regression.",
];

impl Model for ServoHydraulicActuator {
    const ABOUT: About = About {
        name: "ServoHydraulicActuator",
        summary: "Double-acting hydraulic cylinder with a servovalve: voltage to force, at the speed that the \
            suspension has",
        kind: Kind::Actuator,
        equations: &[
            EQUATIONS[0],
            EQUATIONS[1],
            EQUATIONS[2],
            EQUATIONS[3],
            EQUATIONS[4],
            EQUATIONS[5],
            EQUATIONS[6],
            EQUATIONS[7],
            Equation {
                text: "with load.mass m > 0, at t_k = k T: v in P_r' becomes v + T (F_k/m + a_k)/2; force between t_k and \
                    t_(k+1): F = A_a P - F_0c, P = P_r + T/2 alpha (Q + Q_0 - A_a (w + T/2 (F/m + a_k)) - C_tm P), w = v_k \
                    + T (F_k/m + a_k)",
                source: "ours: v and P at the middle of the interval to come, by the implicit midpoint rule",
            },
            Equation {
                text: "F_k = force before t_k, a_k = (a_(k-1) + (v_k - v_(k-1))/T - F_(k-1)/m)/2; at the start w = v_0, a_0 \
                    = 0",
                source: "ours: what the force does not explain of the load's acceleration",
            },
        ],
        notes: &[
            NOTES[0],
            NOTES[1],
            NOTES[2],
            NOTES[3],
            NOTES[4],
            NOTES[5],
            NOTES[6],
            NOTES[7],
            NOTES[8],
            "load.mass is for masters that hold force and velocity through a step of load.interval: oil and masses then \
             swing across the boundary, and with KoniecznyQuarterCar that is unstable from 0.5 ms on. With m = m_1 m_2/(m_1 \
             + m_2) = 10.1 kg it is stable in steps up to 2 ms, and in steps of 1 ms if m is right within -30 and +20 %. \
             The force is then the one that is best held in the interval that begins, half of it ahead of A_a P_r. At 1 ms \
             positions and force come within 1 % of those of KoniecznyServoSuspension, the pressure within 7 %, falling \
             with the square of the step. Leave it at zero for model exchange and for masters that give slopes, iterate or \
             use derivatives.",
        ],
        experiment: Experiment {
            stop: 1.0,
            step: 1e-3,
            stimuli: &[
                ("voltage", Stimulus::Sine { amplitude: 3.0, frequency: 5.0 }),
                ("suspension.velocity", Stimulus::Sine { amplitude: 0.1, frequency: 5.0 }),
            ],
            plot: &["force", "spool.position", "supply.power"],
            // Kinks at the spool's middle ask for it; the linear law would do with 1e-6.
            tolerance: 1e-7,
        },
        method: Method::Explicit,
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Hydraulics,
        input: Input,
        state: State,
        memory: Memory,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { law: options.law })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Hydraulics<R> {
        p.cylinder().hydraulics()
    }

    fn check(&self, p: &Parameters<f64>, _: &Hydraulics<f64>) -> Result<(), String> {
        p.cylinder().check("")
    }

    fn period(p: &Parameters<f64>) -> Option<f64> {
        (p.load.mass > 0.0).then_some(p.load.interval)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let (load, velocity) = (&now.parameters.load, now.input.suspension.velocity);
        // Before the first one nothing is known but the velocity at the start.
        let known = if now.tick == 0 {
            LoadMemory { velocity, force: R::from(0.0), acceleration: R::from(0.0) }
        } else {
            now.memory.load
        };
        let (cylinder, State { pressure, spool }) = (now.parameters.cylinder(), *now.state);
        let (opening, _) = cylinder.followed(spool.position, spool.follower);
        let flow = cylinder.flow(self.law, now.derived, opening, pressure).load;
        let force = load.force(&cylinder, now.derived, Pressed { pressure, flow }, &known, now.tick);
        Memory { load: load.remember(&known, now.tick, velocity, force) }
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { pressure, spool }, u, p) = (*now.state, now.input, now.parameters.cylinder());
        let (load, memory) = (&now.parameters.load, &now.memory.load);
        let (opening, follower) = p.followed(spool.position, spool.follower);
        let flow = p.flow(self.law, now.derived, opening, pressure);
        let velocity = u.suspension.velocity;
        let velocity = load.choose(|| velocity + load.gain(memory), velocity);
        let rates = State {
            pressure: p.pressure_rate(now.derived, flow.load, velocity, pressure),
            spool: SpoolState { position: p.spool_rate(u.voltage, spool.position), follower },
        };
        let supply = SupplyOutput { flow: flow.supply, power: p.supply.pressure * flow.supply };
        let pressed = Pressed { pressure, flow: flow.load };
        let force = load.force(&p, now.derived, pressed, memory, now.tick);
        (rates, Output { force, supply })
    }
}

#[cfg(test)]
mod tests;
