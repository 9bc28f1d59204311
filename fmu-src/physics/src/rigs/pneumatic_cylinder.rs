//! A carriage on a guide that an air cylinder drives, behind a proportional valve.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use super::linear_drive::{CarriageMotion, Load};
use crate::elements::{AMBIENT_PRESSURE, DriveGuide, PneumaticServo, Pressures};

/// A pneumatic positioning drive: voltage of the valve in, pressures and motion out. What commands it stays outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PneumaticCylinder;

/// What the drive is made of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Moving mass: carriage, rod and piston
    #[var(unit = KG, start = 8.0, min = 1e-6)]
    pub moving_mass: R,
    /// Guide, with the seals of piston and rod
    pub guide: DriveGuide<R>,
    /// Static load, positive against positive positions
    #[var(unit = N, start = 0.0, port)]
    pub constant_load: R,
    /// Cylinder and valve
    pub actuator: PneumaticServo<R>,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Control voltage of the valve; a positive one drives towards positive positions
    #[var(unit = V)]
    pub voltage: R,
    /// External force on the carriage
    pub load: Load<R>,
}

/// The motion, the air in the chambers and the spool.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Carriage
    pub carriage: CarriageMotion<R>,
    /// Chamber A
    pub chamber_a: ChamberState<R>,
    /// Chamber B
    pub chamber_b: ChamberState<R>,
    /// Spool
    pub spool: OpeningState<R>,
}

/// The air in a chamber.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ChamberState<R> {
    /// Pressure, absolute
    #[var(unit = PA, start = AMBIENT_PRESSURE, nominal = 1e5, output)]
    pub pressure: R,
}

/// The spool of the valve.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct OpeningState<R> {
    /// Position from the middle as a share of its stroke, positive if it fills chamber A
    #[var(unit = ONE, nominal = 0.1, output)]
    pub position: R,
    /// Where the opening has followed it to, a band's edge or anywhere within the band
    #[var(unit = ONE, nominal = 0.1)]
    pub follower: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Position
    #[var(unit = M)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Cylinder
    pub actuator: AirForce<R>,
    /// Supply
    pub supply: AirConsumption<R>,
}

/// What the air does.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirForce<R> {
    /// Force of the air on the piston and on the end of the rod
    #[var(unit = N)]
    pub force: R,
}

/// What the supply gives.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AirConsumption<R> {
    /// Flow out of the supply, at 100 kPa and 20 °C
    #[var(unit = M3_PER_S)]
    pub flow: R,
}

impl Model for PneumaticCylinder {
    const ABOUT: About = About {
        name: "PneumaticCylinder",
        summary: "Pneumatic positioning drive: mass on a guide, double-acting cylinder, proportional valve; voltage in, \
            pressures and position out",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "m x'' = A_A p_A - A_B p_B - A_r p_amb - g(x, x') - s(x) - F_0 + load.force",
                source: "momentum; s: the ends of the stroke",
            },
            Equation {
                text: "V_A p_A' = p_0 [e(q_A) + e(-q_L) + q_0A] - alpha p_A A_A x', V_A = V_0A + A_A (L/2 + x); V_B p_B' = p_0 [e(q_B) + \
                    e(q_L) + q_0B] + alpha p_B A_B x', V_B = V_0B + A_B (L/2 - x); e(q) = alpha_in q for q > 0, alpha_out q for q < 0",
                source: "Richer2000, equation of the chambers; q_0: ports of diagnosis",
            },
            Equation {
                text: "u > 0: q_A = C u f(p_s, p_A), q_B = C u f(p_e, p_B); u < 0: q_A = C |u| f(p_e, p_A), q_B = C |u| f(p_s, \
                    p_B)",
                source: "Beater2007; flows at p_0 = 100 kPa and 20 degrees Celsius",
            },
            Equation {
                text: "f(p_1, p_2) = p_1 sqrt(1 - (max(r - b, 0)/(1 - b))^2), r = p_2/p_1 <= 1; f(p_2, p_1) = -f(p_1, p_2)",
                source: "ISO6358",
            },
            Equation { text: "q_L = G (p_A - p_B)", source: "Beater2007; laminar" },
            Equation { text: "T y' = clamp(k v, -1, 1) - y", source: "ours: lag of the first order" },
            Equation {
                text: "u = dz(y - clamp(y - z, -h, h), d), T_z z' = dz(y - z, h), T_z = 0.5 ms, dz a dead zone",
                source: "docs/effects.md: 28",
            },
            Equation {
                text: "g = d x' + [F_c + F_b exp(-(x'/v_s)^2)] tanh(x'/v_0) + A sin(2 pi x/p + phi) + c f(x')",
                source: "TUM eq. 12; docs/effects.md: 02, 15, 16, 27, G",
            },
        ],
        notes: &[
            "The air in the chambers is as warm as the room, 20 degrees Celsius, but for what the exponents say of it: 1.4 for \
             what flows in, 1 for what flows out and 1.2 for what the piston compresses came nearest to the \
             measurements of Richer2000.",
            "Above the laminar ratio the flow goes to zero along a straight line, since the slope of ISO 6358's law has no end \
             there.",
            "Pressures are absolute. A gauge shows 101325 Pa less: a column of the record's map can add them.",
            "Beyond the ends of the stroke a closed chamber keeps its dead volume, and the piston runs on a spring.",
            "No source gives all numbers of such a drive. The declared ones are of a cylinder of 32 mm with a rod of 12 mm: \
             replace them by those of your data sheets.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            // The kinks of the valve ask for it: masters that count time in another way choose other steps.
            tolerance: 1e-9,
            stimuli: &[("voltage", Stimulus::Sine { amplitude: 1.0, frequency: 1.0 })],
            plot: &["position", "chamber_a.pressure", "chamber_b.pressure", "actuator.force"],
        },
        ..About::DEFAULT
    };

    bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn check(&self, p: &Parameters<f64>, _: &NoVariables) -> Result<(), String> {
        p.actuator.check("actuator.")
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (p, State { carriage, chamber_a, chamber_b, spool }) = (now.parameters, *now.state);
        let CarriageMotion { position, velocity } = carriage;
        let pressures = Pressures { a: chamber_a.pressure, b: chamber_b.pressure };
        let (opening, follower) = p.actuator.opening(spool.position, spool.follower);
        let flows = p.actuator.flows(opening, &pressures);
        let rates = p.actuator.pressure_rates(&flows, &pressures, position, velocity);

        let force = p.actuator.force(&pressures);
        let guided = p.guide.resistance(position, velocity) + p.actuator.end_force(position);
        let held = guided + p.constant_load - now.input.load.force;
        let acceleration = (force - held) / p.moving_mass;
        (
            State {
                carriage: CarriageMotion { position: velocity, velocity: acceleration },
                chamber_a: ChamberState { pressure: rates.a },
                chamber_b: ChamberState { pressure: rates.b },
                spool: OpeningState {
                    position: p.actuator.spool_rate(now.input.voltage, spool.position),
                    follower,
                },
            },
            Output {
                acceleration,
                position,
                velocity,
                actuator: AirForce { force },
                supply: AirConsumption { flow: flows.supply },
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Bench;

    type Bare = Bench<PneumaticCylinder>;

    #[test]
    fn without_pressure_and_voltage_it_stands_still() {
        let mut drive = Bare::new().initialized();
        drive.step(0.5);
        assert!(drive.get("position").abs() < 1e-12);
        assert_eq!(drive.get("supply.flow"), 0.0);
    }

    #[test]
    fn one_bar_more_in_chamber_a_pushes_as_its_area() {
        let mut drive = Bare::new().start("chamber_a.pressure", 201_325.0).initialized();
        assert!((drive.get("actuator.force") - 80.42).abs() < 1e-9);
        assert!((drive.get("acceleration") - 80.42 / 8.0).abs() < 1e-9);
    }

    /// At a constant temperature p V is the mass of the air: it leaks from chamber to chamber and does not get less.
    #[test]
    fn behind_a_closed_valve_the_air_stays() {
        let mut drive = Bare::new()
            .start("actuator.air.filling_exponent", 1.0)
            .start("actuator.air.compression_exponent", 1.0)
            .start("actuator.cylinder.leakage", 1e-9)
            .start("chamber_a.pressure", 5e5)
            .start("chamber_b.pressure", 3e5)
            .initialized();
        let air = |drive: &mut Bare| {
            let position = drive.get("position");
            drive.get("chamber_a.pressure") * (2e-5 + 8.042e-4 * (0.1 + position))
                + drive.get("chamber_b.pressure") * (2e-5 + 6.911e-4 * (0.1 - position))
        };
        let before = air(&mut drive);
        for force in [-80.0, 150.0] {
            drive.set("load.force", force);
            drive.step(0.3);
            assert!((air(&mut drive) / before - 1.0).abs() < 1e-7, "{} {before}", air(&mut drive));
        }
        assert!(drive.get("position").abs() > 0.01);
    }

    #[test]
    fn the_ends_of_the_stroke_hold_the_piston() {
        let mut drive = Bare::new().start("guide.damping", 100.0).initialized();
        drive.set("voltage", 5.0);
        drive.step(3.0);
        // 5.99 bar above the room's pressure on 8.042 cm2 are 481 N, on 0.2 MN/m.
        let force = drive.get("actuator.force");
        assert!((force - (7e5 - 101_325.0) * 8.042e-4).abs() < 1.0, "{force}");
        assert!((drive.get("position") - 0.1 - force / 2e5).abs() < 1e-6);
    }
}
