//! The semi-active suspension rig of AGH: two arms on one axis, a spring and a brake between them, the wheel on
//! an eccentric.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::{RotaryCoulomb, with_constant};
use crate::signals::{BrakeTorque, EccentricMotion};

use self::contact::{Contact, Eccentric, Wheel, WheelTire};
use self::rest::Rest;
use self::spring::Spring;

pub use self::spring::SpringLever;

mod contact;
mod rest;
mod spring;

/// The rig of Kogut eq. 13 and, with the wheel arm locked, that of eq. 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SasRig {
    locked: bool,
    lever: SpringLever,
    lift_off: bool,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Wheel arm: it is locked where it stands at the start (Kogut 3.1)
    #[set(name = "wheel_arm.locked", start = false)]
    locked: bool,
    /// Spring: with which levers its force turns the arms
    #[set(name = "spring.lever", start = SpringLever::Printed)]
    lever: SpringLever,
    /// Tyre: it can leave the eccentric instead of pulling at it
    #[set(name = "tire.lift_off", start = false)]
    lift_off: bool,
}

/// What the rig is made of. The declared values are Kogut's.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Wheel arm
    pub wheel_arm: WheelArm<R>,
    /// Body arm
    pub body_arm: BodyArm<R>,
    /// Spring between the arms
    pub spring: Spring<R>,
    /// Pivot
    pub pivot: Pivot<R>,
    /// Wheel
    pub wheel: Wheel<R>,
    /// Tyre
    pub tire: WheelTire<R>,
    /// Eccentric
    pub eccentric: Eccentric<R>,
    /// Equilibrium that is calculated
    pub rest: RestAt<R>,
}

/// The arm with the wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelArm<R> {
    /// Moment of inertia about the pivot (I_1 = m_1 R^2)
    #[var(unit = KG_M2, start = 0.2116, min = 1e-6)]
    pub inertia: R,
    /// Moment of gravity with the wheel's centre level with the pivot (M_1 = m_1 g R)
    #[var(unit = N_M, start = 46.71 * 0.2116)]
    pub gravity_moment: R,
    /// Constant torque on the arm, opposing upward motion
    #[var(unit = N_M, start = 0.0, port)]
    pub load: R,
    /// Distance of the wheel's centre from the pivot (R)
    #[var(unit = M, start = 0.21, min = 1e-3)]
    pub length: R,
    /// Angle by which the wheel's centre is below the line to the spring's mount (beta)
    #[var(unit = RAD, start = 0.234)]
    pub offset: R,
}

/// The arm that stands for the body.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct BodyArm<R> {
    /// Moment of inertia about the pivot (I_2, in part one I)
    #[var(unit = KG_M2, start = 1.37, min = 1e-6)]
    pub inertia: R,
    /// Moment of gravity with the arm horizontal (M_2 = a_6 I_2, in part one M)
    #[var(unit = N_M, start = 22.07 * 1.37)]
    pub gravity_moment: R,
    /// Constant torque on the arm, opposing upward motion
    #[var(unit = N_M, start = 0.0, port)]
    pub load: R,
}

/// What both arms turn about.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pivot<R> {
    /// Constant torque that pulls the arms together
    #[var(unit = N_M, start = 0.0, port)]
    pub preload: R,
    /// Friction between the arms
    pub coulomb: RotaryCoulomb<R>,
}

/// Under which circumstances the arms rest.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct RestAt<R> {
    /// Height of the eccentric (u_1 at alpha_0 = 0); it does not act on the motion
    #[var(unit = M, start = 0.04)]
    pub eccentric_height: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Brake between the arms
    pub brake: BrakeTorque<R>,
    /// Eccentric under the tyre
    pub eccentric: EccentricMotion<R>,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Wheel arm
    pub wheel_arm: WheelArmMotion<R>,
    /// Body arm
    pub body_arm: BodyArmMotion<R>,
}

/// Of the wheel arm.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelArmMotion<R> {
    /// Angle above the horizontal (alpha_1, x_1); starts at the equilibrium of the declared parameters
    #[var(unit = RAD, start = -0.195_243_333_051, nominal = 0.01, output)]
    pub angle: R,
    /// Speed, positive upwards (x_2)
    #[var(unit = RAD_PER_S, nominal = 0.1, output)]
    pub speed: R,
}

/// Of the body arm.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct BodyArmMotion<R> {
    /// Angle above the horizontal (gamma, x_3); starts at the equilibrium of the declared parameters
    #[var(unit = RAD, start = 0.352_884_408_306, nominal = 0.1, output)]
    pub angle: R,
    /// Speed, positive upwards (x_4)
    #[var(unit = RAD_PER_S, nominal = 1.0, output)]
    pub speed: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Wheel arm
    pub wheel_arm: Acceleration<R>,
    /// Body arm
    pub body_arm: Acceleration<R>,
    /// Body arm against wheel arm
    pub relative: Relative<R>,
    /// Spring
    pub spring: Pressed<R>,
    /// Tyre
    pub tire: Pressed<R>,
}

/// Of an arm.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Acceleration<R> {
    /// Acceleration, positive upwards
    #[var(unit = RAD_PER_S2)]
    pub acceleration: R,
}

/// Between the arms.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Relative<R> {
    /// Angle of the body arm above the wheel arm (alpha_2 = gamma - alpha_1)
    #[var(unit = RAD)]
    pub angle: R,
    /// Speed of the body arm less that of the wheel arm
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}

/// Spring or tyre.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pressed<R> {
    /// By how much it is shorter or thinner than without load (l_s, l_t)
    #[var(unit = M)]
    pub compression: R,
    /// Force, positive if it pushes its ends apart
    #[var(unit = N)]
    pub force: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Static equilibrium
    pub rest: Rest<R>,
    /// Body arm
    pub body_arm: Mode<R>,
}

/// An arm that moves alone.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Mode<R> {
    /// Undamped natural frequency about equilibrium, the wheel arm held
    #[var(unit = HZ)]
    pub natural_frequency: R,
}

impl Model for SasRig {
    const ABOUT: About = About {
        name: "SasRig",
        summary: "Semi-active suspension rig: wheel arm and body arm on one axis, a spring and a brake between \
            them, the wheel on an eccentric",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "I_1 a_1'' = F_t R cos(b - a_1) - h_1 F_s - M_1 cos(b - a_1) + T - T_01",
                source: "Kogut eq. 13, first line, corrected; T_01: port of diagnosis",
            },
            Equation {
                text: "I_2 g'' = h_2 F_s - M_2 cos(g) - T - T_02",
                source: "Kogut eq. 13, second line; eq. 1; T_02: port of diagnosis",
            },
            Equation {
                text: "F_s = k_s l_s, l_s = l_s0 - sqrt(r_s1^2 + r_s2^2 - 2 r_s1 r_s2 cos(g - a_1))",
                source: "Kogut eq. 14, 17",
            },
            Equation {
                text: "h_1 = r_s1, h_2 = r_s2 (Printed); h_1 = h_2 = r_s2 (Perpendicular); h_1 = h_2 = r_s1 r_s2 \
                    sin(g - a_1)/(l_s0 - l_s) (Exact)",
                source: "Kogut eq. 13; 3.1.1; derived",
            },
            Equation {
                text: "F_t = k_t l_t + q l_t^2 + d_t l_t' + F_t0 tanh(l_t'/v_0) + F_0t, l_t = l_t0 - (H - r - u_1 - \
                    R sin(b - a_1))",
                source: "Kogut eq. 14, 18; effects of TUM 4.3.2 and eq. 12; F_0t: port of diagnosis",
            },
            Equation {
                text: "T = brake.torque + T_p tanh((g' - a_1')/w_0) + T_0p",
                source: "Kogut eq. 13: k_MR(u_2) (g' - a_1'); friction: TUM eq. 12; T_0p: port of diagnosis",
            },
        ],
        notes: &[
            "Angles count upwards from the horizontal, as in the source, not from equilibrium. The states start \
             at the equilibrium of the declared parameters; another start is the start value of \
             wheel_arm.angle, body_arm.angle and their speeds. The equilibrium of other parameters, loads and \
             preloads included, is calculated as rest.wheel_arm_angle and rest.body_arm_angle, to be read in \
             initialisation mode.",
            "Kogut eq. 13 and 16 print the brake's torque with one sign, + k_MR(α̇1 - γ̇), in both lines. On the \
             wheel arm that makes the power k_MR(α̇1² - γ̇²), which is not always a loss; it must be - k_MR(α̇1 - \
             γ̇) there, so that both together take k_MR(α̇1 - γ̇)². At the printed damping the wheel arm's motion \
             hardly shows it, since the tyre damps that arm two hundred times as much.",
            "Kogut eq. 13 lets the spring's force turn the wheel arm with the lever r_s1 and the body arm with \
             r_s2. Both arms turn about one axis, so the lever is one and the same, r_s1 r_s2 sin(γ - \
             α1)/length: 0.183 m at rest, where 0.191 m and 0.275 m are printed. With different levers the spring \
             is not conservative: around a closed course of both angles it does the work k_s (r_s2 - r_s1) times \
             the integral of l_s dα1. The printed form is the default because the printed steady state belongs to \
             it: α1 = -0.195 rad comes out as -0.1952 (-0.1921 with one lever), and the body arm's moment is what \
             k_s was identified with. What it costs is seen by what turns the eccentric, not by the body arm: the \
             load on the eccentric at rest is 261 N instead of 195 N. Perpendicular keeps the body arm's moment \
             and conserves energy; Exact with the same k_s lowers the body's frequency from 1.46 to 1.35 Hz.",
            "Kogut's b_t multiplies a velocity and gives a moment, so that its 305 are N.s; the lever of the \
             tyre's force is left out. Here the tyre has a damping rate in N.s/m and the same lever for spring and \
             damper: b_t/(R cos(β - α1)) at rest. Up to the eccentric's highest position the lever grows by \
             1.2 %.",
            "Printed misprints: in 3.1.1 r_s1 is named twice where r_s2 is meant, and I_1 and M_1 where eq. 1 has \
             I and M of the body arm; in 3.2.1 u_2(α0 = 0) = 0.04 m is u_1; in eq. 16 the wheel arm's l_s(x1, x2) \
             is l_s(x1, x3); the steady state of 3.2.2 has three entries for four states. Its body angle of 0.3540 \
             rad comes out as 0.3529: the printed parameters are rounded.",
            "As in the source the tyre pulls at the eccentric where it would leave it, which near the body's \
             resonance it does; tire.lift_off lets it jump. Its compression counts from the tyre without load.",
            "Everything is turned about the axis of the wheel arm, as in the source; the device's body arm and \
             brake have an axis of their own.",
        ],
        experiment: Experiment {
            stop: 10.0,
            step: 1e-3,
            tolerance: 1e-7,
            stimuli: &[
                ("eccentric.height", Stimulus::Sine { amplitude: 0.0025, frequency: 1.35 }),
                ("eccentric.velocity", Stimulus::Cosine { amplitude: 0.021_206, frequency: 1.35 }),
            ],
            plot: &["wheel_arm.angle", "body_arm.angle", "relative.speed", "tire.force"],
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Input,
        state: State,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { locked: options.locked, lever: options.lever, lift_off: options.lift_off })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let rest = self.rest(p);
        let spring = p.spring.at(rest.body_arm_angle - rest.wheel_arm_angle, self.lever);
        let [_, spring_rate] = spring.rates;
        let stiffness = spring_rate - p.body_arm.gravity_moment * rest.body_arm_angle.sin();
        // Not the root of a number below zero: an arm that falls over has no frequency.
        let square = (stiffness / p.body_arm.inertia).max(R::from(1e-12));
        Derived { rest, body_arm: Mode { natural_frequency: square.sqrt() / TAU } }
    }

    fn check(&self, p: &Parameters<f64>, derived: &Derived<f64>) -> Result<(), String> {
        let (r1, r2) = (p.spring.wheel_arm_mount, p.spring.body_arm_mount);
        if r1 == r2 {
            return Err(format!(
                "spring.wheel_arm_mount = {r1} m and spring.body_arm_mount = {r2} m must differ: the spring would \
                 have no length where the arms meet"
            ));
        }
        let reach =
            p.wheel_arm.length + p.wheel.rim_radius + p.wheel.tire_thickness + p.rest.eccentric_height;
        if reach <= p.eccentric.depth {
            return Err(format!(
                "the wheel cannot reach the eccentric: wheel_arm.length + wheel.rim_radius + \
                 wheel.tire_thickness + rest.eccentric_height = {reach} m must be larger than eccentric.depth = \
                 {} m",
                p.eccentric.depth
            ));
        }
        if self.is_rest(p, &derived.rest) {
            return Ok(());
        }
        Err(format!(
            "there is no position of rest with the body arm above the wheel arm: with spring.stiffness = {} N/m \
             and spring.free_length = {} m the spring does not carry body_arm.gravity_moment = {} N.m; stiffen \
             or lengthen the spring",
            p.spring.stiffness, p.spring.free_length, p.body_arm.gravity_moment
        ))
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { wheel_arm: wheel, body_arm: body }, u, p) = (*now.state, now.input, now.parameters);
        let wheel_speed = if self.locked { R::from(0.0) } else { wheel.speed };
        let (angle, speed) = (body.angle - wheel.angle, body.speed - wheel_speed);

        let spring = p.spring.at(angle, self.lever);
        let between = with_constant(p.pivot.coulomb.added_to(|| u.brake.torque, speed), p.pivot.preload);
        let contact = Contact::new(p, wheel.angle, u.eccentric.height);
        let thinning = u.eccentric.velocity - contact.lever * wheel_speed;
        let tire = p.tire.force(contact.compression, thinning, self.lift_off);

        let on_wheel_arm =
            tire * contact.lever - spring.on_wheel_arm - p.wheel_arm.gravity_moment * contact.cosine
                + between;
        let on_body_arm = spring.on_body_arm - p.body_arm.gravity_moment * body.angle.cos() - between;
        let on_wheel_arm = with_constant(on_wheel_arm, -p.wheel_arm.load);
        let on_body_arm = with_constant(on_body_arm, -p.body_arm.load);
        let wheel_acceleration = if self.locked { R::from(0.0) } else { on_wheel_arm / p.wheel_arm.inertia };
        let body_acceleration = on_body_arm / p.body_arm.inertia;

        let rates = State {
            wheel_arm: WheelArmMotion { angle: wheel_speed, speed: wheel_acceleration },
            body_arm: BodyArmMotion { angle: body.speed, speed: body_acceleration },
        };
        let output = Output {
            wheel_arm: Acceleration { acceleration: wheel_acceleration },
            body_arm: Acceleration { acceleration: body_acceleration },
            relative: Relative { angle, speed },
            spring: Pressed { compression: spring.compression, force: spring.force },
            tire: Pressed { compression: contact.compression, force: tire },
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
