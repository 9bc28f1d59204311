//! The catalogue of causes: which parameters they switch on, how large they may be, what they are confused with.

mod guided;
pub mod naming;
mod periphery;
mod strut;
mod tables;
mod tire;

use crate::plant::Plant;

pub use tables::Table;

/// Bounds of the velocity at which friction is regularised, in an element's usual velocities: below, a rig that really sticks
/// is met no better, and equations become too stiff.
const FRICTION_VELOCITY: (f64, f64) = (5e-3, 1.0);

/// A cause with a name.
#[derive(Clone, Copy, Debug)]
pub struct Cause {
    /// Its number.
    pub id: &'static str,
    /// The element that it acts on.
    pub element: Element,
    /// What it is called.
    pub name: &'static str,
    /// Its law in plain text.
    pub equation: &'static str,
    /// Numbers of causes that it contains as a limit: they are preferred where they explain nearly as much.
    pub contains: &'static [&'static str],
    /// A setting that has to be on.
    pub setting: Option<&'static str>,
    /// Its parameters; the first one is how much of it there is.
    pub parts: &'static [Part],
    /// What separates it from the causes that it is most often confused with.
    pub experiment: &'static str,
}

impl Cause {
    /// Whether its law is over the velocity of its element, not the deflection alone.
    pub fn is_over_velocity(&self) -> bool {
        self.parts.iter().any(|part| part.scale.velocity != 0)
    }
}

/// Where a cause acts; its parameters are measured in that element's own forces and motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Element {
    /// Between body and wheel.
    Strut,
    /// Between body and ground.
    Guide,
    /// Between wheel and ground.
    WheelGuide,
    /// Between wheel and road.
    Tire,
    /// Between two arms that turn about it: forces are moments in N.m, deflections angles in rad.
    Pivot,
    /// From a command to the force; it deflects and moves as the strut does.
    Actuator,
    /// The valve of a hydraulic actuator: it deflects as its spool does.
    Valve,
    /// The pump of a hydraulic actuator, with its motor: torques in N.m for forces, speeds in rad/s.
    Pump,
    /// What carries the guides, and swings with the body.
    Frame,
    /// The cell that measures the wheel's force.
    ForceCell,
}

impl Element {
    /// As in parameters' names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strut => "strut",
            Self::Guide => "guide",
            Self::WheelGuide => "wheel_guide",
            Self::Tire => "tire",
            Self::Pivot => "pivot",
            Self::Actuator => "actuator",
            Self::Valve => "valve",
            Self::Pump => "pump",
            Self::Frame => "frame",
            Self::ForceCell => "wheel.force",
        }
    }

    /// Whether it measures, so that the plant is not at fault.
    pub fn is_sensor(self) -> bool {
        self == Self::ForceCell
    }
}

/// A parameter of a cause.
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
}

/// Powers of an element's typical force, deflection and velocity that a parameter's numbers are in: what is large and
/// what is small depends on the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    force: i32,
    deflection: i32,
    velocity: i32,
}

impl Scale {
    /// The parameter's own unit.
    pub const ONE: Self = Self { force: 0, deflection: 0, velocity: 0 };
    /// A force.
    pub const FORCE: Self = Self { force: 1, ..Self::ONE };
    /// A deflection.
    pub const DEFLECTION: Self = Self { deflection: 1, ..Self::ONE };
    /// A velocity.
    pub const VELOCITY: Self = Self { velocity: 1, ..Self::ONE };
    /// Per deflection.
    pub const PER_DEFLECTION: Self = Self { deflection: -1, ..Self::ONE };
    /// A stiffness.
    pub const STIFFNESS: Self = Self { force: 1, deflection: -1, velocity: 0 };
    /// A compliance.
    pub const COMPLIANCE: Self = Self { force: -1, deflection: 1, velocity: 0 };
    /// A force over a deflection squared.
    pub const QUADRATIC: Self = Self { force: 1, deflection: -2, velocity: 0 };
    /// A force over a deflection cubed.
    pub const CUBIC: Self = Self { force: 1, deflection: -3, velocity: 0 };
    /// A damping rate.
    pub const DAMPING: Self = Self { force: 1, deflection: 0, velocity: -1 };
    /// The time that a change of a force takes.
    pub const SLOWNESS: Self = Self { force: -1, deflection: 1, velocity: -1 };
    /// A force over a velocity squared.
    pub const ORIFICE: Self = Self { force: 1, deflection: 0, velocity: -2 };

    /// In SI units.
    pub fn of(self, typical: &Typical) -> f64 {
        typical.force.powi(self.force)
            * typical.deflection.powi(self.deflection)
            * typical.velocity.powi(self.velocity)
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
}

/// A parameter of a cause.
const fn part(parameter: &'static str, scale: Scale, bounds: (f64, f64), probes: &'static [f64]) -> Part {
    Part { parameter, scale, bounds, probes, within: None, addend: false }
}

/// A parameter that adds something of its own to what the first one does.
const fn addend(parameter: &'static str, scale: Scale, bounds: (f64, f64), probes: &'static [f64]) -> Part {
    Part { addend: true, ..part(parameter, scale, bounds, probes) }
}

/// A parameter of a law that repeats itself, or begins to act, within so many typical magnitudes.
const fn within(part: Part, scale: Scale, most: f64) -> Part {
    Part { within: Some((scale, most)), ..part }
}

/// Every named cause that acts through a plant's parameters.
pub fn causes(plant: &Plant) -> impl Iterator<Item = &'static Cause> {
    let has = |cause: &&Cause| {
        cause.parts.iter().all(|part| plant.parameter(part.parameter).is_some())
            && cause.setting.is_none_or(|setting| plant.setting(setting).is_some())
    };
    let all = [strut::CAUSES, tire::CAUSES, guided::CAUSES, periphery::CAUSES];
    all.into_iter().flatten().filter(has)
}

/// Every cause without a name that a plant can have.
pub fn tables(plant: &Plant) -> impl Iterator<Item = &'static Table> {
    let has = |table: &&Table| {
        plant.parameter(table.switch).is_some() && plant.parameter(&format!("{}[1]", table.points)).is_some()
    };
    tables::TABLES.iter().filter(has)
}
