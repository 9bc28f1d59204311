//! A rotary positioning drive. It has the equations of the linear one, with angles for lengths and torques for forces.

use std::path::Path;

use strut_model::{
    About, Bundle, Choice, Declaration, Declarations, Equation, Experiment, Instant, Kind, Model,
    NoVariables, Real, Settings, Stimulus,
    unit::{self, Unit},
};

use super::linear_drive::{self as linear, Drive};

/// A shaft on bearings whose motor gives the torque that is asked for. What commands it stays outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryDrive {
    drive: Drive,
}

/// What says how large the motor's torque is.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum DrivenBy {
    /// The torque itself
    Torque,
    /// The command to an amplifier that controls the motor's current
    Command,
    /// The motion that is imposed on the shaft (inverse dynamics)
    Motion,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What says how large the motor's torque is
    #[set(start = DrivenBy::Torque)]
    drive: DrivenBy,
}

/// Variables of the linear drive, declared as of one that turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning<B>(B);

impl<R, B: Bundle<R>> Bundle<R> for Turning<B> {
    const LEN: usize = B::LEN;
    type Array = B::Array;

    #[inline]
    fn gather(next: &mut impl FnMut() -> R) -> Self {
        Self(B::gather(next))
    }

    #[inline]
    fn scatter(&self, put: &mut impl FnMut(R)) {
        self.0.scatter(put);
    }

    #[inline]
    fn combine<const N: usize>(&self, others: [&Self; N], f: &mut impl FnMut(&R, [&R; N]) -> R) -> Self {
        Self(self.0.combine(others.map(|it| &it.0), f))
    }

    fn declare(declarations: &mut Declarations) {
        let mut linear = Declarations::default();
        B::declare(&mut linear);
        linear.into_list().iter().map(turned).for_each(|it| declarations.variable(it));
    }
}

/// What a unit becomes about an axis.
const UNITS: [(Unit, Unit); 10] = [
    (unit::KG, unit::KG_M2),
    (unit::M, unit::RAD),
    (unit::M_PER_S, unit::RAD_PER_S),
    (unit::M_PER_S2, unit::RAD_PER_S2),
    (unit::N, unit::N_M),
    (unit::N_PER_M, unit::N_M_PER_RAD),
    (unit::N_PER_M2, unit::N_M_PER_RAD2),
    (unit::N_PER_M3, unit::N_M_PER_RAD3),
    (unit::N_S_PER_M, unit::N_M_S_PER_RAD),
    (unit::N_PER_V, unit::N_M_PER_V),
];

/// Names that are others here; an effect's parameters keep theirs, by which the diagnosis knows them.
const NAMES: [(&str, &str); 6] = [
    ("moving_mass", "inertia"),
    ("force", "torque"),
    ("load.force", "load.torque"),
    ("motor.force", "motor.torque"),
    ("carriage.position", "shaft.position"),
    ("carriage.velocity", "shaft.velocity"),
];

/// Words that are others in descriptions.
const WORDS: [(&str, &str); 14] = [
    ("Moving mass: carriage, rod and what turns with them", "Moment of inertia of all that turns"),
    ("Motion of the carriage", "Motion of the shaft"),
    ("External force on the carriage", "External torque on the shaft"),
    ("Static load", "Static torque"),
    ("Guide", "Bearings"),
    ("guide", "bearings"),
    ("Carriage", "Shaft"),
    ("carriage", "shaft"),
    ("Force", "Torque"),
    ("force", "torque"),
    ("Position", "Angle"),
    ("position", "angle"),
    ("Stroke", "Angle"),
    ("the bearings resists", "the bearings resist"),
];

/// Start values that are of another order about an axis.
const STARTS: [(&str, f64); 5] = [
    ("inertia", 0.01),
    ("guide.coulomb.velocity", 0.1),
    ("guide.stribeck.velocity", 0.1),
    ("guide.curve.velocity_range", 10.0),
    ("guide.cogging.period", std::f64::consts::FRAC_PI_6),
];

/// Smallest moment of inertia in kg·m²: a small motor's rotor has 1e-7.
const LEAST_INERTIA: f64 = 1e-12;

/// The declaration of a variable of the linear drive, turned.
fn turned(linear: &Declaration) -> Declaration {
    let name = NAMES.iter().find(|(from, _)| *from == linear.name).map_or(linear.name.as_str(), |(_, to)| to);
    let start = STARTS.iter().find(|(of, _)| *of == name).map_or(linear.start, |(_, start)| *start);
    let unit = UNITS.iter().find(|(from, _)| *from == linear.unit).map_or(linear.unit, |(_, to)| *to);
    let doc = WORDS.iter().fold(linear.doc.clone(), |doc, (from, to)| doc.replace(from, to));
    let min = if name == "inertia" { Some(LEAST_INERTIA) } else { linear.min };
    Declaration { name: name.to_owned(), doc, unit, start, min, ..linear.clone() }
}

impl Model for RotaryDrive {
    const ABOUT: About = About {
        name: "RotaryDrive",
        summary: "Rotary positioning drive: inertia on bearings with friction, breakaway and cogging; torque or amplifier's \
            command in, angle out; or motion in, torque out",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "J w' = T - s(q) - g(q, w) - T_0 + load.torque, w = q', T = torque or gain command",
                source: "angular momentum",
            },
            Equation {
                text: "setting Motion: T = J w' + s(q) + g(q, w) + T_0 - load.torque, q, w, w' = motion",
                source: "inverse dynamics; Siciliano et al., Robotics (2009), section 7.5",
            },
            Equation { text: "s = k q + k_2 q^2 + k_3 q^3", source: "docs/effects.md: 08, 08n" },
            Equation {
                text: "g = d w + [T_c + T_b exp(-(w/w_s)^2)] tanh(w/w_0) + A sin(2 pi q/p + phi) + c f(w)",
                source: "TUM eq. 12, turned; docs/effects.md: 02, 15, 16, 27, G",
            },
        ],
        notes: &[
            "The equations are those of LinearDrive, and so are the names of the effects' parameters: \
             guide.coulomb.force is a torque in N.m here.",
            "Angles and speeds are those of the shaft on which the inertia counts; behind a gear, all are on one side of \
             it.",
            "No source gives numbers of such a drive: the declared inertia and gain are to be replaced by those of a data \
             sheet.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            // Friction's zero crossing and the kinks of an unnamed torque ask for it.
            tolerance: 1e-8,
            stimuli: &[("torque", Stimulus::Sine { amplitude: 0.2, frequency: 1.0 })],
            plot: &["position", "velocity", "acceleration"],
        },
        ..About::DEFAULT
    };

    type Settings = Options;
    type Parameters<R: Real> = Turning<linear::Parameters<R>>;
    type Derived<R: Real> = NoVariables;
    type Input<R: Real> = Turning<linear::Input<R>>;
    type State<R: Real> = Turning<linear::State<R>>;
    type Memory<R: Real> = NoVariables;
    type Output<R: Real> = Turning<linear::Output<R>>;

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        let drive = match options.drive {
            DrivenBy::Torque => Drive::Force,
            DrivenBy::Command => Drive::Command,
            DrivenBy::Motion => Drive::Motion,
        };
        Ok(Self { drive })
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (Self::State<R>, Self::Output<R>) {
        let (state, output) = linear::dynamics(self.drive, &now.parameters.0, &now.state.0, &now.input.0);
        (Turning(state), Turning(output))
    }
}

#[cfg(test)]
mod tests {
    use strut_model::Value;

    use super::*;
    use crate::testing::Bench;

    type Bare = Bench<RotaryDrive>;

    #[test]
    fn a_constant_torque_turns_it_ever_faster() {
        let mut drive = Bare::new().initialized();
        drive.set("torque", 0.2);
        drive.step(0.5);
        // 0.2 N.m on 0.01 kg.m2 for half a second.
        assert!((drive.get("velocity") - 10.0).abs() < 1e-9 && (drive.get("position") - 2.5).abs() < 1e-9);
    }

    #[test]
    fn the_inverse_gives_the_torque_of_a_motion() {
        let mut drive = Bare::new()
            .choose("drive", Value::Integer(DrivenBy::Motion as i32 + 1))
            .start("guide.coulomb.force", 0.05)
            .start("guide.coulomb.velocity", 1e-4)
            .start("guide.damping", 0.002)
            .initialized();
        drive.set("motion.velocity", 30.0);
        drive.set("motion.acceleration", 5.0);
        assert!((drive.get("motor.torque") - (0.05 + 0.06 + 0.05)).abs() < 1e-12);
    }

    /// No variable keeps a length or a force, and no description speaks of one.
    #[test]
    fn all_variables_are_turned() {
        let all = [
            Declarations::of::<Turning<linear::Parameters<f64>>>(),
            Declarations::of::<Turning<linear::Input<f64>>>(),
            Declarations::of::<Turning<linear::State<f64>>>(),
            Declarations::of::<Turning<linear::Output<f64>>>(),
        ]
        .concat();
        for Declaration { name, doc, unit, .. } in all {
            assert!(UNITS.iter().all(|(linear, _)| *linear != unit), "{name} is in {}", unit.symbol);
            for word in ["orce", "osition", "arriage", "uide", "stroke", "mass", "tatic load"] {
                assert!(!doc.contains(word), "{name}: {doc}");
            }
        }
    }
}
