//! Effects in the tyre.

use super::{Effect, Element, LIFT_OFF, Onset, PLAIN, Prevalence, Replaced, Scale, TIMES, part};
use crate::signal::distortion::Fault;

pub(super) const EFFECTS: &[Effect] = &[
    Effect {
        id: "19",
        element: Element::TIRE,
        name: "progressive tyre",
        equation: "F = q c^2",
        parts: &[part("tire.quadratic", Scale::QUADRATIC, (-5.0, 5.0), &[0.05])],
        literature: &["Pacejka2012", "TUM"],
        experiment: "compare two static loads",
        ..PLAIN
    },
    Effect {
        id: "20",
        element: Element::TIRE,
        name: "lift-off",
        equation: "F >= -F_0",
        onset: Onset::Threshold,
        setting: Some(LIFT_OFF),
        literature: &["Pacejka2012", "TUM"],
        experiment: "drop the wheel, or drive over a large bump",
        ..PLAIN
    },
    Effect {
        id: "21",
        element: Element::TIRE,
        name: "tyre friction",
        equation: "F = F_t tanh(c'/v_0)",
        parts: &[
            part("tire.coulomb.force", Scale::FORCE, (0.0, 5.0), &[0.1]),
            part("tire.coulomb.velocity", Scale::VELOCITY, (1e-3, 1.0), &[0.05]),
        ],
        literature: &["Gent2006"],
        experiment: "sweep the frequency",
        ..PLAIN
    },
    Effect {
        id: "22",
        element: Element::TIRE,
        name: "enveloping (low-pass of the road)",
        equation: "T z' = z_r - z, F = f(z - z_u)",
        prevalence: Prevalence::Background,
        replaces: Some(Replaced { inputs: "road", distortion: Fault::Lag }),
        parts: &[part("enveloping.time", Scale::ONE, (5e-4, 0.05), TIMES)],
        literature: &["Captain1979", "Pacejka2012"],
        experiment: "drive over a step, and compare with a second sensor of the road",
        ..PLAIN
    },
];
