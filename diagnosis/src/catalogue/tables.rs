//! Effects without a name: tables that compete with the named ones.

use super::{Element, Prevalence, Scale};
use crate::plant::Plant;

/// What a table's points are, wherever it stands.
#[derive(Debug)]
pub struct Unnamed {
    /// Its number.
    pub id: &'static str,
    /// What the points are.
    pub quantity: &'static str,
    /// Their unit.
    pub unit: &'static str,
    /// What the points' numbers are in.
    pub point: Scale,
    /// Smallest and largest value of a point.
    pub bounds: (f64, f64),
    /// How common it is.
    pub prevalence: Prevalence,
    /// Where such tables are published, by keys of the literature.
    pub literature: &'static [&'static str],
    /// What separates it from others.
    pub experiment: &'static str,
}

/// An effect without a name, over a variable: a table in the plant.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// What its points are.
    pub law: &'static Unnamed,
    /// The element that it acts on.
    pub element: Element,
    /// What it is over.
    pub variable: &'static str,
    /// The parameter that switches it on.
    pub switch: &'static str,
    /// The parameter that is the range of the variable, to both sides.
    pub range: &'static str,
    /// The parameter that is the table: its points are `table[1]`, `table[2]`, …
    pub points: &'static str,
    /// What the variable's numbers are in.
    pub scale: Scale,
}

impl Table {
    /// Whether a plant can have it.
    pub fn is_in(&self, plant: &Plant) -> bool {
        let points = format!("{}[1]", self.points);
        plant.parameter(self.switch).is_some() && plant.parameter(&points).is_some()
    }

    /// The unit of its points in a plant.
    pub fn unit(&self, plant: &Plant) -> &'static str {
        plant
            .parameter(&format!("{}[1]", self.points))
            .map_or("", |index| plant.parameters[index].unit.symbol)
    }

    /// What it is called.
    pub fn name(&self) -> String {
        format!("unnamed {} over {}", self.law.quantity, self.variable)
    }

    /// Its law in plain text.
    pub fn equation(&self) -> String {
        format!("a table over {}", self.variable)
    }
}

/// What separates a table from a law: both agree where the records are.
const SWEEP: &str = "sweep the variable slowly through the covered range and beyond";

/// A force over a motion.
pub const FORCE: Unnamed = Unnamed {
    id: "G1",
    quantity: "force",
    unit: "N",
    point: Scale::FORCE,
    bounds: (-10.0, 10.0),
    prevalence: Prevalence::Background,
    literature: &["Masri1979", "Worden2001"],
    experiment: SWEEP,
};

/// A damping rate over a deflection.
pub const DAMPING: Unnamed =
    Unnamed { id: "G3", quantity: "damping rate", unit: "N.s/m", point: Scale::DAMPING, ..FORCE };

pub(super) const UNNAMED: &[&Unnamed] = &[&FORCE, &DAMPING];

pub(super) const TABLES: &[Table] = &[
    Table {
        law: &FORCE,
        element: Element::STRUT,
        variable: "deflection",
        switch: "strut.curve.scale",
        range: "strut.curve.deflection_range",
        points: "strut.curve.over_deflection",
        scale: Scale::DEFLECTION,
    },
    Table {
        law: &FORCE,
        element: Element::STRUT,
        variable: "velocity",
        switch: "strut.curve.scale",
        range: "strut.curve.velocity_range",
        points: "strut.curve.over_velocity",
        scale: Scale::VELOCITY,
    },
    Table {
        law: &FORCE,
        element: Element::GUIDE,
        variable: "velocity",
        switch: "guide.curve.scale",
        range: "guide.curve.velocity_range",
        points: "guide.curve.over_velocity",
        scale: Scale::VELOCITY,
    },
    Table {
        law: &FORCE,
        element: Element::TIRE,
        variable: "deflection",
        switch: "tire.curve.scale",
        range: "tire.curve.deflection_range",
        points: "tire.curve.over_deflection",
        scale: Scale::DEFLECTION,
    },
    Table {
        law: &DAMPING,
        element: Element::STRUT,
        variable: "deflection",
        switch: "strut.curve.scale",
        range: "strut.curve.deflection_range",
        points: "strut.curve.damping",
        scale: Scale::DEFLECTION,
    },
    Table {
        law: &FORCE,
        element: Element::ACTUATOR,
        variable: "force",
        switch: "actuator.curve.scale",
        range: "actuator.curve.force_range",
        points: "actuator.curve.over_force",
        scale: Scale::FORCE,
    },
];
