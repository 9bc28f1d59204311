//! Laws without a name: tables that compete with the named causes.

use super::{Element, Scale};

/// A force without a name, over a variable: a table in the plant.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// Its number.
    pub id: &'static str,
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
    /// What the points' numbers are in: a force, or a damping rate over the variable.
    pub point: Scale,
}

impl Table {
    /// What its points are, and their unit.
    pub fn quantity(&self) -> (&'static str, &'static str) {
        if self.point == Scale::DAMPING { ("damping rate", "N.s/m") } else { ("force", "N") }
    }
}

pub(super) const TABLES: &[Table] = &[
    Table {
        id: "G1",
        element: Element::Strut,
        variable: "deflection",
        switch: "strut.curve.scale",
        range: "strut.curve.deflection_range",
        points: "strut.curve.over_deflection",
        scale: Scale::DEFLECTION,
        point: Scale::FORCE,
    },
    Table {
        id: "G1",
        element: Element::Strut,
        variable: "velocity",
        switch: "strut.curve.scale",
        range: "strut.curve.velocity_range",
        points: "strut.curve.over_velocity",
        scale: Scale::VELOCITY,
        point: Scale::FORCE,
    },
    Table {
        id: "G1",
        element: Element::Guide,
        variable: "velocity",
        switch: "guide.curve.scale",
        range: "guide.curve.velocity_range",
        points: "guide.curve.over_velocity",
        scale: Scale::VELOCITY,
        point: Scale::FORCE,
    },
    Table {
        id: "G1",
        element: Element::Tire,
        variable: "deflection",
        switch: "tire.curve.scale",
        range: "tire.curve.deflection_range",
        points: "tire.curve.over_deflection",
        scale: Scale::DEFLECTION,
        point: Scale::FORCE,
    },
    Table {
        id: "G3",
        element: Element::Strut,
        variable: "deflection",
        switch: "strut.curve.scale",
        range: "strut.curve.deflection_range",
        points: "strut.curve.damping",
        scale: Scale::DEFLECTION,
        point: Scale::DAMPING,
    },
    Table {
        id: "G1",
        element: Element::Actuator,
        variable: "force",
        switch: "actuator.curve.scale",
        range: "actuator.curve.force_range",
        points: "actuator.curve.over_force",
        scale: Scale::FORCE,
        point: Scale::FORCE,
    },
];
