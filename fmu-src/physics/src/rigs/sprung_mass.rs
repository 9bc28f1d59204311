//! One mass on a strut whose lower end is moved: a seat, an isolated machine, or the body of a car above a wheel whose motion
//! is measured.

use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::elements::{Actuation, ActuationState, Guide, Hysteresis, HysteresisState, Mode, Strut};
use crate::signals::{Acceleration, Motion, Pushing, Travel};

/// A mass on a moved base. Where the base's motion is not measured, the deflection itself may drive it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SprungMass {
    drive: Drive,
}

/// The measured motion.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Position and velocity of the base
    Motion,
    /// Acceleration of the base
    Acceleration,
    /// Deflection of the strut and its rate; what moves the base stays open
    Deflection,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// The measured motion
    #[set(start = Drive::Motion)]
    drive: Drive,
}

/// What it is made of. The declared values are those of QuarterCar's body.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sprung mass: body, seat with its load, or machine
    #[var(unit = KG, start = 350.0, min = 1e-3)]
    pub sprung_mass: R,
    /// Strut
    pub strut: Strut<R>,
    /// Guide of the mass
    pub guide: Guide<R>,
    /// Memory of the strut
    pub hysteresis: Hysteresis<R>,
    /// From the actuator's command to its force
    pub actuator: Actuation<R>,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Motion of the base (settings Motion and Acceleration)
    pub motion: BaseMotion<R>,
    /// Deflection of the strut (setting Deflection)
    pub imposed: Travel<R>,
    /// Actuator between base and mass
    pub actuator: Pushing<R>,
}

/// How a base is moved. Its signals belong together: each is the rate of the one before.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct BaseMotion<R> {
    /// Height (setting Motion)
    #[var(unit = M)]
    pub position: R,
    /// Velocity, positive upwards (setting Motion)
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Acceleration, positive upwards (setting Acceleration)
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Mass
    pub body: Motion<R>,
    /// Base, from its acceleration; at rest in the other settings
    pub base: Integrated<R>,
    /// Memory of the strut
    pub hysteresis: HysteresisState<R>,
    /// On the way from the actuator's command to its force
    pub actuator: ActuationState<R>,
}

/// What an acceleration makes.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Integrated<R> {
    /// Height
    #[var(unit = M, nominal = 0.01)]
    pub position: R,
    /// Velocity, positive upwards
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub velocity: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Mass
    pub body: Acceleration<R>,
    /// Strut
    pub suspension: Travel<R>,
    /// Base
    pub base: Pressed<R>,
}

/// What acts on a base.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pressed<R> {
    /// Force of strut and actuator on the base less the static load, positive if it presses
    #[var(unit = N)]
    pub force: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Mass on the strut
    pub body: Mode<R>,
    /// Number of effects that are on beside asymmetry, quadratic rate, and Coulomb friction of strut and guide
    #[var(unit = ONE)]
    pub active_effects: R,
}

impl Model for SprungMass {
    const ABOUT: About = About {
        name: "SprungMass",
        summary: "One mass on a strut above a base that is moved: a seat, an isolator, or a car's body above a wheel whose \
            motion or deflection is measured",
        kind: Kind::Rig,
        equations: &[
            Equation { text: "m a = -F_strut + F_act - F_guide", source: "TUM eq. 2; guide: 4.3.3" },
            Equation {
                text: "settings Motion and Acceleration: x = z_s - z_b, v = x'; z_b'' = motion.acceleration or z_b = \
                    motion.position",
                source: "base excitation; TUM eq. 3 with the wheel's motion given",
            },
            Equation {
                text: "setting Deflection: x = imposed.deflection, v = imposed.velocity",
                source: "inverse of TUM eq. 2: of the motion only the body's acceleration is left to be compared",
            },
            Equation {
                text: "F_strut = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v/v_0)",
                source: "TUM eq. 12, 14; asymmetry derived from Table 9",
            },
            Equation {
                text: "further effects of strut, its memory, guide and actuator: as in QuarterCar",
                source: "docs/effects.md",
            },
        ],
        notes: &[
            "A suspension without a road: in a car on a road that nobody measured, the deflection and the body's acceleration \
             judge strut and guide. Tyre and wheel are not in the model.",
            "With the base's motion given it is a seat, an isolator or a machine's foot, and a quarter car whose wheel is \
             imposed.",
            "A base whose acceleration is measured drifts as the sensor's offset makes it, and the mass with it: their \
             difference, the deflection, does not drift.",
            "In the setting Deflection the mass goes its own way from its initial motion; its absolute motion matters to the \
             guide alone.",
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            // As for QuarterCar without lift-off.
            tolerance: 1e-8,
            stimuli: &[
                ("motion.position", Stimulus::Sine { amplitude: 0.01, frequency: 1.5 }),
                ("motion.velocity", Stimulus::Cosine { amplitude: 0.094_247_779_607_693_79, frequency: 1.5 }),
            ],
            plot: &["body.position", "body.acceleration", "suspension.deflection", "base.force"],
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
        Ok(Self { drive: options.drive })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let Strut { stiffness, damping, .. } = p.strut;
        Derived {
            body: Mode::of(p.sprung_mass, stiffness, stiffness, damping),
            active_effects: p.strut.active_effects()
                + p.guide.active_effects()
                + p.hysteresis.active_effects()
                + p.actuator.active_effects(),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.hysteresis.check(p.strut.damping)
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, base, hysteresis, actuator }, p, input) = (*now.state, now.parameters, now.input);
        let further = now.derived.active_effects;
        let zero = R::from(0.0);
        let above = |position: R, velocity: R| Travel {
            deflection: body.position - position,
            velocity: body.velocity - velocity,
        };
        let at_rest = Integrated { position: zero, velocity: zero };
        let (suspension, integrated) = match self.drive {
            Drive::Motion => (above(input.motion.position, input.motion.velocity), at_rest),
            Drive::Acceleration => (
                above(base.position, base.velocity),
                Integrated { position: base.velocity, velocity: input.motion.acceleration },
            ),
            Drive::Deflection => (input.imposed, at_rest),
        };
        let (pushing, on_its_way) = p.actuator.force(actuator, input.actuator.force, further);
        let motion = [now.time, suspension.deflection, suspension.velocity];
        let (strut, memory) = p.strut.force_with_states(&p.hysteresis, &hysteresis, motion, further);
        let on_body = p.guide.added_to(|| strut, body.velocity, further);
        let acceleration = (pushing - on_body) * (R::from(1.0) / p.sprung_mass);
        let rates = State {
            body: Motion { position: body.velocity, velocity: acceleration },
            base: integrated,
            hysteresis: memory,
            actuator: on_its_way,
        };
        let output = Output {
            body: Acceleration { acceleration },
            suspension,
            base: Pressed { force: pushing - strut },
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
