//! The catalogue of effects: the one home of all that is known of each. An entry states number, place, name, law, parameters
//! with their bounds, special cases, how common the effect is, when it acts, literature, and the experiment that separates it.

mod coil;
mod element;
mod guided;
pub mod naming;
mod page;
mod periphery;
mod placed;
mod signals;
mod strut;
mod tables;
mod tire;

#[cfg(test)]
mod tests;

use crate::plant::Plant;
use crate::signal::distortion::Fault;

use placed::placed;

pub use element::{Element, ElementKind};
pub use page::page;
pub use placed::{first_of, is_joint, joints, joints_of};
pub use signals::{Bounds, Distortion, RESPONSE, Signal, distortion, distortions};
pub use tables::{Table, Unnamed};

/// The setting that lets a tyre leave the road.
pub const LIFT_OFF: &str = "tire.lift_off";
/// Delays and time constants of signals in seconds from which they are looked for: a signal with edges shows a late one only nearby.
pub const TIMES: &[f64] = &[1e-3, 2.5e-3, 6e-3, 15e-3];

/// Bounds of the velocity at which friction is regularised, in an element's usual velocities: below, a rig that really sticks
/// is met no better, and equations become too stiff.
const FRICTION_VELOCITY: (f64, f64) = (5e-3, 1.0);

/// An effect with a name that acts through a plant's parameters.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its number, unique within the element.
    pub id: &'static str,
    /// The element that it acts on.
    pub element: Element,
    /// What it is called.
    pub name: &'static str,
    /// Its law in plain text.
    pub equation: &'static str,
    /// Numbers of effects of its element that it contains as special cases. A special case is preferred where it explains
    /// nearly as much.
    pub contains: &'static [&'static str],
    /// When it acts.
    pub onset: Onset,
    /// How common it is.
    pub prevalence: Prevalence,
    /// The distortion of inputs that it stands for.
    pub replaces: Option<Replaced>,
    /// A setting that has to be on.
    pub setting: Option<&'static str>,
    /// What the names of the inputs begin with that drive it: nothing shows of it unless one of them moves.
    pub driven: Option<&'static str>,
    /// Its parameters; the first one is how much of it there is.
    pub parts: &'static [Part],
    /// Articles and books that state the law, by their keys of the literature.
    pub literature: &'static [&'static str],
    /// What separates it from the effects that it is most often confused with.
    pub experiment: &'static str,
}

/// An effect that acts always, that not every rig has, and that contains no other.
const PLAIN: Effect = Effect {
    id: "",
    element: Element::STRUT,
    name: "",
    equation: "",
    contains: &[],
    onset: Onset::Always,
    prevalence: Prevalence::Occasional,
    replaces: None,
    setting: None,
    driven: None,
    parts: &[],
    literature: &[],
    experiment: "",
};

/// When an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Onset {
    /// At all times.
    Always,
    /// Beyond a threshold only.
    Threshold,
    /// Near standstill only.
    Standstill,
}

/// How common an effect is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prevalence {
    /// Some rigs have it.
    Occasional,
    /// Every rig has it, and often enough of it to matter: dry friction of what slides.
    Expected,
    /// A background effect: every rig has a little of it. Such are memory and compliance of rubber, springs that are not
    /// quite straight, cogging, and the filters and timing of sensors.
    Background,
}

/// A distortion of inputs that an effect stands for: in a plant that has the effect, the distortion is not looked for.
#[derive(Clone, Copy, Debug)]
pub struct Replaced {
    /// What the inputs' names begin with.
    pub inputs: &'static str,
    /// The distortion.
    pub distortion: Fault,
}

impl Effect {
    /// Whether a plant can have it.
    pub fn is_in(&self, plant: &Plant) -> bool {
        self.parts.iter().all(|part| plant.parameter(part.parameter).is_some())
            && self.setting.is_none_or(|setting| plant.setting(setting).is_some())
    }

    /// Whether it is dry friction: a force against the motion, and the velocity within which it turns over. At rest it is
    /// whatever holds.
    pub fn is_friction(&self) -> bool {
        matches!(self.parts, [force, velocity] if force.scale == Scale::FORCE && velocity.scale == Scale::VELOCITY)
    }

    /// Whether its law is over the velocity of its element, not the deflection alone.
    pub fn is_over_velocity(&self) -> bool {
        self.parts.iter().any(|part| part.scale.velocity != 0)
    }
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// As in the plant.
    pub parameter: &'static str,
    /// What its numbers are in.
    pub scale: Scale,
    /// Smallest and largest value.
    pub bounds: (f64, f64),
    /// Values from which it is looked for.
    pub probes: &'static [f64],
    /// Largest value in the element's typical magnitudes, so that the law acts within the record.
    pub within: Option<(Scale, f64)>,
    /// Whether it is an amount beside the first parameter's: the law is a sum, of which either may be absent.
    pub addend: bool,
    /// What the element does where this threshold is passed.
    pub beyond: Option<Beyond>,
    /// Whether the law is another one at the least and at the largest value: friction that turns over beyond all velocities is
    /// damping.
    pub another_at: [bool; 2],
}

/// How a threshold is passed, and what that is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beyond {
    /// By a compression that is larger.
    Compression(&'static str),
    /// By a rebound that is larger.
    Rebound(&'static str),
    /// By a speed that is larger, in either direction.
    Speed(&'static str),
}

impl Beyond {
    /// What it is called.
    pub fn name(self) -> &'static str {
        let (Self::Compression(name) | Self::Rebound(name) | Self::Speed(name)) = self;
        name
    }

    /// Whether a deflection, in m and positive in rebound, or a velocity in m/s passes the threshold.
    pub fn is_passed(self, deflection: f64, velocity: f64, threshold: f64) -> bool {
        match self {
            Self::Compression(_) => deflection < -threshold,
            Self::Rebound(_) => deflection > threshold,
            Self::Speed(_) => velocity.abs() > threshold,
        }
    }
}

/// Powers of an element's typical force, deflection and velocity that a parameter's numbers are in: what is large and
/// what is small depends on the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    force: i32,
    deflection: i32,
    velocity: i32,
    pitch: i32,
}

impl Scale {
    /// The parameter's own unit.
    pub const ONE: Self = Self { force: 0, deflection: 0, velocity: 0, pitch: 0 };
    /// A pitch of poles or of a spindle.
    pub const PITCH: Self = Self { pitch: 1, ..Self::ONE };
    /// A force.
    pub const FORCE: Self = Self { force: 1, ..Self::ONE };
    /// A deflection.
    pub const DEFLECTION: Self = Self { deflection: 1, ..Self::ONE };
    /// A velocity.
    pub const VELOCITY: Self = Self { velocity: 1, ..Self::ONE };
    /// Per deflection.
    pub const PER_DEFLECTION: Self = Self { deflection: -1, ..Self::ONE };
    /// A stiffness.
    pub const STIFFNESS: Self = Self { force: 1, deflection: -1, velocity: 0, ..Self::ONE };
    /// A compliance.
    pub const COMPLIANCE: Self = Self { force: -1, deflection: 1, velocity: 0, ..Self::ONE };
    /// A force over a deflection squared.
    pub const QUADRATIC: Self = Self { force: 1, deflection: -2, velocity: 0, ..Self::ONE };
    /// A force over a deflection cubed.
    pub const CUBIC: Self = Self { force: 1, deflection: -3, velocity: 0, ..Self::ONE };
    /// A damping rate.
    pub const DAMPING: Self = Self { force: 1, deflection: 0, velocity: -1, ..Self::ONE };
    /// The time that a change of a force takes.
    pub const SLOWNESS: Self = Self { force: -1, deflection: 1, velocity: -1, ..Self::ONE };
    /// A force over a velocity squared.
    pub const ORIFICE: Self = Self { force: 1, deflection: 0, velocity: -2, ..Self::ONE };

    /// In SI units.
    pub fn of(self, typical: &Typical) -> f64 {
        typical.force.powi(self.force)
            * typical.deflection.powi(self.deflection)
            * typical.velocity.powi(self.velocity)
            * typical.pitch.powi(self.pitch)
    }
}

/// Typical magnitudes of an element, root mean square: force in N, deflection in m, velocity in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Typical {
    /// In N.
    pub force: f64,
    /// In m.
    pub deflection: f64,
    /// In m/s.
    pub velocity: f64,
    /// A metre's worth of a pitch: 1 along an axis; about one [`TURNED`] radians, as poles are further apart there.
    pub pitch: f64,
}

/// How many times larger the number of a pitch is in rad than in m: 60 poles a turn are a tenth of a radian, as linear motors have
/// some every centimetre.
pub const TURNED: f64 = 10.0;

/// A parameter of an effect.
const fn part(parameter: &'static str, scale: Scale, bounds: (f64, f64), probes: &'static [f64]) -> Part {
    Part {
        parameter,
        scale,
        bounds,
        probes,
        within: None,
        addend: false,
        beyond: None,
        another_at: [false; 2],
    }
}

/// A parameter that adds something of its own to what the first one does.
const fn addend(parameter: &'static str, scale: Scale, bounds: (f64, f64), probes: &'static [f64]) -> Part {
    Part { addend: true, ..part(parameter, scale, bounds, probes) }
}

/// A parameter of a law that repeats itself, or begins to act, within so many typical magnitudes.
const fn within(part: Part, scale: Scale, most: f64) -> Part {
    Part { within: Some((scale, most)), ..part }
}

/// A parameter within whose largest value the law has to bend, since it is another one from there on.
const fn bends(part: Part) -> Part {
    Part { another_at: [false, true], ..part }
}

/// The same within both ends.
const fn bends_between(part: Part) -> Part {
    Part { another_at: [true; 2], ..part }
}

/// A parameter that is a threshold.
const fn beyond(part: Part, beyond: Beyond) -> Part {
    Part { beyond: Some(beyond), ..part }
}

/// Every named effect that acts through parameters.
pub fn all() -> impl Iterator<Item = &'static Effect> {
    [strut::EFFECTS, coil::EFFECTS, tire::EFFECTS, guided::EFFECTS, periphery::EFFECTS].into_iter().flatten()
}

/// Every named effect that acts through a plant's parameters; of elements of which it has several, at each, and at several
/// at once.
pub fn effects(plant: &Plant) -> impl Iterator<Item = &'static Effect> {
    all().chain(placed(plant).flat_map(|it| it.effects)).filter(|effect| effect.is_in(plant))
}

/// Every effect without a name that a plant can have.
pub fn tables(plant: &Plant) -> impl Iterator<Item = &'static Table> {
    let placed = placed(plant).flat_map(|it| it.tables);
    tables::TABLES.iter().chain(placed).filter(|table| table.is_in(plant))
}

/// Whether an effect of the plant stands for a distortion of an input.
pub fn is_replaced(plant: &Plant, input: &str, fault: Fault) -> bool {
    let stands_for = |it: Replaced| it.distortion == fault && input.starts_with(it.inputs);
    effects(plant).filter_map(|effect| effect.replaces).any(stands_for)
}
