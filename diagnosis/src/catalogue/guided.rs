//! Effects in the guides of drives and in pivots.

use super::{Effect, Element, FRICTION_VELOCITY, Onset, PLAIN, Prevalence, Scale, addend, part, within};

/// Pole pitches and spindle pitches in m, as far as they are looked for: so close that over a stroke of some periods no phase is lost
/// between two of them.
const PERIODS: &[f64] = &[
    0.004, 0.0046, 0.0053, 0.0061, 0.007, 0.008, 0.0092, 0.0106, 0.0122, 0.014, 0.0161, 0.0185, 0.0213,
    0.0245, 0.028, 0.032, 0.037, 0.043, 0.049, 0.057, 0.066, 0.076, 0.088, 0.101, 0.117, 0.135, 0.156, 0.18,
];

pub(super) const EFFECTS: &[Effect] = &[
    Effect {
        id: "33",
        element: Element::GUIDE,
        name: "force offset",
        equation: "F = F_0",
        parts: &[part("constant_load", Scale::FORCE, (-10.0, 10.0), &[0.1])],
        literature: &["Janot2019"],
        experiment: "hold several positions: what remains of the force at all of them is the load's",
        ..PLAIN
    },
    Effect {
        id: "02",
        element: Element::GUIDE,
        name: "Stribeck friction of the guide",
        equation: "F = (F_c + (F_s - F_c) exp(-(v/v_s)^2)) tanh(v/v_0)",
        contains: &["16"],
        onset: Onset::Standstill,
        parts: &[
            part("guide.stribeck.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("guide.stribeck.velocity", Scale::VELOCITY, (5e-3, 1.0), &[0.1]),
            part("guide.coulomb.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("guide.coulomb.velocity", Scale::VELOCITY, FRICTION_VELOCITY, &[0.02]),
        ],
        literature: &["ArmstrongHelouvry1994", "CanudasDeWit1995"],
        experiment: "creep through zero velocity below 5 mm/s",
        ..PLAIN
    },
    Effect {
        id: "08",
        element: Element::GUIDE,
        name: "spring to the ground",
        equation: "F = k x",
        prevalence: Prevalence::Background,
        parts: &[part("ground_spring.stiffness", Scale::STIFFNESS, (0.0, 100.0), &[0.1])],
        literature: &["DenHartog1956"],
        experiment: "hold several positions, and compare the forces",
        ..PLAIN
    },
    Effect {
        id: "08n",
        element: Element::GUIDE,
        name: "nonlinear spring to the ground",
        equation: "F = k_2 x^2 + k_3 x^3",
        prevalence: Prevalence::Background,
        parts: &[
            part("ground_spring.progression.cubic", Scale::CUBIC, (-5.0, 5.0), &[0.05]),
            addend("ground_spring.progression.quadratic", Scale::QUADRATIC, (-5.0, 5.0), &[0.05]),
        ],
        literature: &["Worden2001"],
        experiment: "move through the whole stroke quasi-statically",
        ..PLAIN
    },
    Effect {
        id: "27",
        element: Element::GUIDE,
        name: "cogging",
        equation: "F = A sin(2 pi x/p + phi)",
        prevalence: Prevalence::Background,
        parts: &[
            part("guide.cogging.force", Scale::FORCE, (0.0, 5.0), &[0.1]),
            // At least one and a half periods in a stroke of about four root mean squares.
            within(part("guide.cogging.period", Scale::PITCH, (2e-3, 0.2), PERIODS), Scale::DEFLECTION, 2.7),
            part("guide.cogging.phase", Scale::ONE, (-10.0, 10.0), &[0.0, 1.6, 3.1, -1.6]),
        ],
        literature: &["Otten1997"],
        experiment: "traverse slowly, and draw the force over the position",
        ..PLAIN
    },
    Effect {
        id: "01",
        element: Element::PIVOT,
        name: "pivot friction",
        equation: "T = T_p tanh(w/w_0)",
        prevalence: Prevalence::Expected,
        parts: &[
            part("pivot.coulomb.torque", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("pivot.coulomb.speed", Scale::VELOCITY, (1e-3, 1.0), &[0.02, 0.2]),
        ],
        literature: &["ArmstrongHelouvry1994"],
        experiment: "let the arm swing freely: friction ends its swings after equal steps of amplitude",
        ..PLAIN
    },
];
