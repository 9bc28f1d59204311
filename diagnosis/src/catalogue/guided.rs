//! Causes in the guides of drives and in pivots.

use super::{Cause, Element, Scale, part};

pub(super) const CAUSES: &[Cause] = &[
    Cause {
        id: "33",
        element: Element::Guide,
        name: "constant force",
        equation: "F = F_0",
        contains: &[],
        setting: None,
        parts: &[part("constant_load", Scale::FORCE, (-10.0, 10.0), &[0.1])],
        experiment: "hold several positions: what remains of the force at all of them is the load's",
    },
    Cause {
        id: "01",
        element: Element::Pivot,
        name: "pivot friction",
        equation: "T = T_p tanh(w/w_0)",
        contains: &[],
        setting: None,
        parts: &[
            part("pivot.coulomb.torque", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("pivot.coulomb.speed", Scale::VELOCITY, (1e-3, 1.0), &[0.02, 0.2]),
        ],
        experiment: "let the arm swing freely: friction ends its swings after equal steps of amplitude",
    },
];
