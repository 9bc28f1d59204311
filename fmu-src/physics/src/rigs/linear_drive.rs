//! A linear positioning drive: a mass on a guide, behind an amplifier. It runs forward, from the force to the motion, or
//! inversely, from the motion to the force.

use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::Progression;
use crate::elements::DriveGuide;

/// A carriage on a guide whose motor gives the force that is asked for. What commands it stays outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearDrive {
    drive: Drive,
}

/// What says how large the motor's force is.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// The force itself
    Force,
    /// The command to an amplifier that controls the motor's current
    Command,
    /// The motion that is imposed on the carriage (inverse dynamics)
    Motion,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What says how large the motor's force is
    #[set(start = Drive::Force)]
    drive: Drive,
}

/// What the drive is made of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Moving mass: carriage, rod and what turns with them
    #[var(unit = KG, start = 20.0, min = 1e-6)]
    pub moving_mass: R,
    /// Guide
    pub guide: DriveGuide<R>,
    /// Spring to the ground
    pub ground_spring: GroundSpring<R>,
    /// Static load, positive against positive positions
    #[var(unit = N, start = 0.0, port)]
    pub constant_load: R,
    /// Amplifier
    pub amplifier: Amplifier<R>,
}

/// A spring between carriage and ground.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct GroundSpring<R> {
    /// Rate (below zero what pushes it further, as a weight above a joint does)
    #[var(unit = N_PER_M, start = 0.0)]
    pub stiffness: R,
    /// Curvature of its characteristic
    pub progression: Progression<R>,
}

impl<R: Real> GroundSpring<R> {
    /// The force that pulls the carriage back.
    #[inline]
    fn force(&self, position: R) -> R {
        self.stiffness * position + self.progression.force(position)
    }
}

/// An amplifier that controls the motor's current.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Amplifier<R> {
    /// Force for one volt of command
    #[var(unit = N_PER_V, start = 1.0)]
    pub gain: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Force of the motor (setting Force)
    #[var(unit = N)]
    pub force: R,
    /// Command to the amplifier (setting Command)
    #[var(unit = V)]
    pub command: R,
    /// External force on the carriage
    pub load: Load<R>,
    /// Motion of the carriage (setting Motion)
    pub motion: ImposedMotion<R>,
}

/// A motion that is imposed on the carriage. Its three signals belong together: each is the rate of the one before.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ImposedMotion<R> {
    /// Position
    #[var(unit = M)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
}

/// What acts on the carriage apart from the motor.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Force, positive towards positive positions
    #[var(unit = N)]
    pub force: R,
}

/// States: the motion that the forces make, or the integral of the imposed motion (setting Motion).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Carriage
    pub carriage: CarriageMotion<R>,
}

/// Motion of the carriage.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct CarriageMotion<R> {
    /// Position
    #[var(unit = M, nominal = 0.1)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub velocity: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Force that the guide resists with
    #[var(unit = N)]
    pub resistance: R,
    /// Position
    #[var(unit = M)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Motor
    pub motor: MotorForce<R>,
}

/// What the motor does.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct MotorForce<R> {
    /// Force of the motor; in the setting Motion, the force that the motion takes
    #[var(unit = N)]
    pub force: R,
}

impl Model for LinearDrive {
    const ABOUT: About = About {
        name: "LinearDrive",
        summary: "Linear positioning drive: mass on a guide with friction, breakaway and cogging; force or amplifier's \
            command in, position out; or motion in, force out",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "m x'' = F - s(x) - g(x, x') - F_0 + load.force, F = force or gain command",
                source: "momentum",
            },
            Equation {
                text: "setting Motion: F = m x'' + s(x) + g(x, x') + F_0 - load.force, x, x', x'' = motion",
                source: "inverse dynamics; Siciliano et al., Robotics (2009), section 7.5",
            },
            Equation { text: "s = k x + k_2 x^2 + k_3 x^3", source: "docs/effects.md: 08, 08n" },
            Equation {
                text: "g = d x' + [F_c + F_b exp(-(x'/v_s)^2)] tanh(x'/v_0) + A sin(2 pi x/p + phi) + c f(x')",
                source: "TUM eq. 12; docs/effects.md: 02, 15, 16, 27, G",
            },
        ],
        notes: &[
            "A rig for records of a positioning drive in closed loop: what the loop asked for is measured, so that the \
             loop itself need not be known. A motor whose voltage is measured, with resistance and inductance, is \
             ExcitationMotor.",
            "With the setting Motion it gives the feedforward force of a motion, and the force to compare where a motion \
             was measured: a drive with much friction and little mass amplifies every error of the force when it is \
             simulated forward.",
            "No source gives numbers of such a drive: the declared mass and gain are to be replaced by those of a data \
             sheet.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            // Friction's zero crossing and the kinks of an unnamed force ask for it.
            tolerance: 1e-8,
            stimuli: &[("force", Stimulus::Sine { amplitude: 40.0, frequency: 1.0 })],
            plot: &["position", "velocity", "acceleration"],
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { drive: options.drive })
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        dynamics(self.drive, now.parameters, now.state, now.input)
    }
}

/// Rates and outputs of a drive that is driven in this way, along an axis or about it.
#[inline]
pub(super) fn dynamics<R: Real>(
    drive: Drive,
    p: &Parameters<R>,
    state: &State<R>,
    input: &Input<R>,
) -> (State<R>, Output<R>) {
    let CarriageMotion { position, velocity } = match drive {
        Drive::Force | Drive::Command => state.carriage,
        Drive::Motion => CarriageMotion { position: input.motion.position, velocity: input.motion.velocity },
    };
    let resistance = p.guide.resistance(position, velocity);
    let held = p.ground_spring.force(position) + resistance + p.constant_load - input.load.force;
    let driven = |force: R| ((force - held) / p.moving_mass, force);
    let (acceleration, force) = match drive {
        Drive::Force => driven(input.force),
        Drive::Command => driven(p.amplifier.gain * input.command),
        Drive::Motion => (input.motion.acceleration, p.moving_mass * input.motion.acceleration + held),
    };
    let rates = CarriageMotion { position: velocity, velocity: acceleration };
    (
        State { carriage: rates },
        Output { acceleration, resistance, position, velocity, motor: MotorForce { force } },
    )
}

#[cfg(test)]
mod tests {
    use strut_model::Value;

    use super::*;
    use crate::testing::Bench;

    type Bare = Bench<LinearDrive>;

    #[test]
    fn without_friction_a_constant_force_gives_half_a_t_squared() {
        let mut drive = Bare::new().initialized();
        drive.set("force", 40.0);
        drive.step(0.5);
        assert!((drive.get("position") - 0.5 * 2.0 * 0.25).abs() < 1e-9);
        assert_eq!(drive.get("acceleration"), 2.0);
    }

    #[test]
    fn a_constant_load_holds_the_carriage_back() {
        let mut drive = Bare::new().start("constant_load", 10.0).initialized();
        // 10 N on 20 kg.
        assert_eq!(drive.get("acceleration"), -0.5);
    }

    #[test]
    fn a_hardening_spring_holds_it_back_more_than_a_straight_one() {
        let mut drive = Bare::new()
            .start("ground_spring.stiffness", 1000.0)
            .start("ground_spring.progression.quadratic", 2000.0)
            .start("ground_spring.progression.cubic", 50_000.0)
            .start("carriage.position", 0.1)
            .initialized();
        // 100 N, 20 N and 50 N on 20 kg.
        assert!((drive.get("acceleration") + 8.5).abs() < 1e-12);
    }

    #[test]
    fn the_amplifier_makes_newtons_of_volts() {
        let mut drive = Bare::new()
            .choose("drive", Value::Integer(Drive::Command as i32 + 1))
            .start("amplifier.gain", 35.0)
            .initialized();
        drive.set("command", 2.0);
        drive.set("force", 1000.0);
        assert!((drive.get("acceleration") - 3.5).abs() < 1e-12);
    }

    #[test]
    fn breakaway_adds_to_the_sliding_friction_and_cogging_repeats_itself() {
        let mut drive = Bare::new()
            .start("guide.coulomb.force", 20.0)
            .start("guide.coulomb.velocity", 1e-5)
            .start("guide.stribeck.force", 8.0)
            .start("guide.stribeck.velocity", 0.05)
            .start("guide.cogging.force", 6.0)
            .start("carriage.position", 0.006)
            .start("carriage.velocity", 1e-3)
            .initialized();
        assert!((drive.get("resistance") - (28.0 + 6.0)).abs() < 0.01);
    }

    #[test]
    fn in_steady_motion_the_force_is_the_resistance() {
        let mut drive = Bare::new()
            .start("guide.damping", 200.0)
            .start("guide.coulomb.force", 20.0)
            .start("constant_load", -3.0)
            .initialized();
        drive.set("force", 57.0);
        drive.step(3.0);
        assert!((drive.get("velocity") - (57.0 - 20.0 + 3.0) / 200.0).abs() < 1e-9);
    }

    /// The force that the inverse asks for moves the carriage as it was imposed.
    #[test]
    fn the_inverse_gives_the_force_that_makes_the_motion() {
        let bench = |drive: Drive| {
            Bare::new()
                .choose("drive", Value::Integer(drive as i32 + 1))
                .start("guide.damping", 60.0)
                .start("guide.coulomb.force", 15.0)
                .start("guide.cogging.force", 5.0)
                .start("ground_spring.stiffness", 400.0)
                .start("constant_load", -3.0)
                .start("carriage.position", 0.02)
                .start("carriage.velocity", 0.3)
                .initialized()
        };
        let mut inverse = bench(Drive::Motion);
        inverse.set("load.force", 2.0);
        for (signal, value) in [("position", 0.02), ("velocity", 0.3), ("acceleration", 1.7)] {
            inverse.set(&format!("motion.{signal}"), value);
        }
        let force = inverse.get("motor.force");
        let mut forward = bench(Drive::Force);
        forward.set("load.force", 2.0);
        forward.set("force", force);
        assert!((forward.get("acceleration") - 1.7).abs() < 1e-12, "{}", forward.get("acceleration"));
        assert_eq!(forward.get("motor.force"), force);
        // The carriage follows the imposed motion.
        inverse.step(0.1);
        assert!((inverse.get("carriage.position") - 0.05).abs() < 1e-9);
        assert_eq!(inverse.get("position"), 0.02);
    }
}
