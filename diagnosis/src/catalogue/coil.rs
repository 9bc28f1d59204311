//! Effects of a coil that sets a strut's damper. A lag or a saturation changes what has to be found first, and what was found acts
//! beside the trajectory: so each is a law of its own that contains the plain one.

use super::strut::{YIELD_SLOPE, YIELD_VELOCITY};
use super::{Effect, Element, PLAIN, Part, Replaced, Scale, addend, part};
use crate::signal::distortion::Fault;

/// What drives it.
const COIL: Option<&str> = Some("control.");
/// A lag of the damper is none of the sensor that measures what sets it.
const LATE: Option<Replaced> = Some(Replaced { inputs: "control.", distortion: Fault::Lag });

const DAMPING: Part = part("control.damping", Scale::DAMPING, (-1.0, 10.0), &[0.1]);
const YIELD: [Part; 4] = [
    part("control.yield_force", Scale::FORCE, (-10.0, 10.0), &[0.3]),
    addend("strut.yield.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
    YIELD_VELOCITY,
    YIELD_SLOPE,
];
const LAG: Part = part("control.lag", Scale::ONE, (1e-4, 0.5), &[0.003, 0.02]);
const YIELD_BEHIND_LAG: [Part; 5] = yield_with(LAG);
const SATURATING_YIELD: [Part; 5] = yield_with(part("control.saturation", Scale::ONE, (0.0, 5.0), &[0.3]));

const fn yield_with(more: Part) -> [Part; 5] {
    let [amount, addend, velocity, slope] = YIELD;
    [amount, addend, velocity, slope, more]
}

pub(super) const EFFECTS: &[Effect] = &[
    Effect {
        id: "32m",
        element: Element::STRUT,
        name: "controllable damping",
        equation: "F = (d + d_s s) v, s = |i|/i_r",
        driven: COIL,
        parts: &[DAMPING],
        literature: &["Spencer1997", "Dixon2007"],
        experiment: "hold several currents, and sweep the velocity with each",
        ..PLAIN
    },
    Effect {
        id: "32mt",
        element: Element::STRUT,
        name: "controllable damping behind a lag",
        equation: "F = (d + d_s s) v, T s' = |i|/i_r - s",
        contains: &["32m"],
        replaces: LATE,
        driven: COIL,
        parts: &[DAMPING, LAG],
        literature: &["Spencer1997", "Dixon2007"],
        experiment: "step the current at a constant velocity",
        ..PLAIN
    },
    Effect {
        id: "32n",
        element: Element::STRUT,
        name: "controllable yield force",
        equation: "F = (F_y + F_s s) tanh(v/v_y + beta x), s = |i|/i_r",
        contains: &["01", "02", "05s", "32f", "32m"],
        driven: COIL,
        parts: &YIELD,
        literature: &["Spencer1997", "Kwok2006"],
        experiment: "hold several currents, and move slowly to and fro with each",
        ..PLAIN
    },
    Effect {
        id: "32nt",
        element: Element::STRUT,
        name: "controllable yield force behind a lag",
        equation: "F = (F_y + F_s s) tanh(v/v_y + beta x), T s' = |i|/i_r - s",
        contains: &["01", "02", "05s", "32f", "32m", "32mt", "32n"],
        replaces: LATE,
        driven: COIL,
        parts: &YIELD_BEHIND_LAG,
        literature: &["Spencer1997", "Kwok2006"],
        experiment: "step the current at a constant velocity",
        ..PLAIN
    },
    Effect {
        id: "32ns",
        element: Element::STRUT,
        name: "controllable yield force that saturates",
        equation: "F = (F_y + F_s s/(1 + kappa s)) tanh(v/v_y + beta x), s = |i|/i_r",
        contains: &["01", "02", "05s", "32f", "32m", "32n"],
        driven: COIL,
        parts: &SATURATING_YIELD,
        literature: &["Kennelly1891", "Spencer1997"],
        experiment: "compare equal steps of a small and of a large current",
        ..PLAIN
    },
];
