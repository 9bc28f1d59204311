//! Causes in the tyre.

use super::{Cause, Element, Scale, part};

pub(super) const CAUSES: &[Cause] = &[
    Cause {
        id: "19",
        element: Element::Tire,
        name: "progressive tyre",
        equation: "F = q c^2",
        contains: &[],
        setting: None,
        parts: &[part("tire.quadratic", Scale::QUADRATIC, (-5.0, 5.0), &[0.05])],
        experiment: "compare two static loads",
    },
    Cause {
        id: "20",
        element: Element::Tire,
        name: "lift-off",
        equation: "F >= -F_0",
        contains: &[],
        setting: Some("tire.lift_off"),
        parts: &[],
        experiment: "drop the wheel, or drive over a large bump",
    },
    Cause {
        id: "21",
        element: Element::Tire,
        name: "tyre friction",
        equation: "F = F_t tanh(c'/v_0)",
        contains: &[],
        setting: None,
        parts: &[
            part("tire.coulomb.force", Scale::FORCE, (0.0, 5.0), &[0.1]),
            part("tire.coulomb.velocity", Scale::VELOCITY, (1e-3, 1.0), &[0.05]),
        ],
        experiment: "sweep the frequency",
    },
    Cause {
        id: "22",
        element: Element::Tire,
        name: "enveloping (low-pass of the road)",
        equation: "T z' = z_r - z, F = f(z - z_u)",
        contains: &[],
        setting: None,
        parts: &[part("enveloping.time", Scale::ONE, (5e-4, 0.05), &[3e-3])],
        experiment: "drive over a step, and compare with a second sensor of the road",
    },
];
