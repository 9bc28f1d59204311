//! Effects around strut and tyre: in the frame, in actuator, valve and pump, and in the cell that measures the
//! force.

use super::{Effect, Element, FRICTION_VELOCITY, Onset, PLAIN, Replaced, Scale, part};
use crate::signal::distortion::Fault;

/// Natural frequencies in Hz, so close that a lightly damped mode between two of them still shows.
const FREQUENCIES: &[f64] =
    &[10.0, 11.5, 13.2, 15.2, 17.5, 20.0, 23.0, 26.5, 30.5, 35.0, 40.0, 46.0, 53.0, 61.0, 70.0, 80.0];

pub(super) const EFFECTS: &[Effect] = &[
    Effect {
        id: "18",
        element: Element::FRAME,
        name: "test-rig resonance",
        equation: "F = m_f (w^2 y + 2 z w y'), y'' + 2 z w y' + w^2 y = -a_s",
        parts: &[
            part("frame.mass", Scale::ONE, (0.0, 50.0), &[1.0]),
            part("frame.frequency", Scale::ONE, (8.0, 95.0), FREQUENCIES),
            part("frame.damping_ratio", Scale::ONE, (2e-3, 0.4), &[0.06]),
        ],
        literature: &["DenHartog1956", "Ewins2000"],
        experiment: "dwell on sines about the resonance, and tap the frame",
        ..PLAIN
    },
    Effect {
        id: "26",
        element: Element::ACTUATOR,
        name: "saturation of the actuator",
        equation: "F = u - r dz(u, F_m)",
        onset: Onset::Threshold,
        replaces: Some(Replaced { inputs: "actuator.", distortion: Fault::Limit }),
        parts: &[
            part("actuator.saturation.ratio", Scale::ONE, (0.0, 1.0), &[0.5]),
            // A limit far below the usual forces would be a gain.
            part("actuator.saturation.force", Scale::FORCE, (0.8, 6.0), &[1.0, 1.5, 2.2]),
        ],
        literature: &["Slotine1991"],
        experiment: "repeat the run with half the command",
        ..PLAIN
    },
    Effect {
        id: "26s",
        element: Element::ACTUATOR,
        name: "slew limit of the actuator",
        equation: "|F'| <= 1/s",
        onset: Onset::Threshold,
        parts: &[part("actuator.slew.slowness", Scale::SLOWNESS, (0.0, 10.0), &[0.1, 0.3, 1.0])],
        literature: &["Hippe2006"],
        experiment: "command steps of several sizes: larger ones take longer",
        ..PLAIN
    },
    Effect {
        id: "28",
        element: Element::VALVE,
        name: "spool overlap (dead band)",
        equation: "opening = dz(x_v, delta)",
        parts: &[part("actuator.spool.overlap", Scale::DEFLECTION, (0.0, 2.0), &[0.1])],
        literature: &["Merritt1967", "Jelali2003"],
        experiment: "drive the valve by a random signal of small amplitude",
        ..PLAIN
    },
    Effect {
        id: "28h",
        element: Element::VALVE,
        name: "hysteresis of the valve",
        equation: "opening = x_v - clamp(x_v - y, -h, h), y dragged along by x_v from h on",
        parts: &[part("actuator.spool.hysteresis", Scale::DEFLECTION, (0.0, 1.0), &[0.1])],
        literature: &["Jelali2003", "Nordin2002"],
        experiment: "drive the valve slowly up and down with the pressures balanced, and compare the flows",
        ..PLAIN
    },
    Effect {
        id: "30",
        element: Element::PUMP,
        name: "leakage of the pump",
        equation: "q = C_l (p_k - p_r)",
        parts: &[part("pump.leakage", Scale::ONE, (0.0, 1e-10), &[1e-11])],
        literature: &["Merritt1967", "Konieczny"],
        experiment: "hold piston and motor under load: the force decays; hold the torque: the motor creeps",
        ..PLAIN
    },
    Effect {
        id: "32c",
        element: Element::PUMP,
        name: "friction of the pump",
        equation: "T = T_f tanh(w/w_f)",
        parts: &[
            part("pump.coulomb.torque", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("pump.coulomb.speed", Scale::VELOCITY, FRICTION_VELOCITY, &[0.02, 0.2]),
        ],
        literature: &["Merritt1967", "ArmstrongHelouvry1994"],
        experiment: "turn the motor slowly to and fro without load: the torques differ by twice the friction",
        ..PLAIN
    },
    Effect {
        id: "41",
        element: Element::FORCE_CELL,
        name: "inertia of the force cell",
        equation: "y = F_tire - m_c a_u",
        parts: &[part("force_cell.mass", Scale::ONE, (0.0, 60.0), &[1.0])],
        literature: &["McConnell2008"],
        experiment: "lift the wheel off the road and shake it: what the cell shows then is its own",
        ..PLAIN
    },
    Effect {
        id: "41h",
        element: Element::FORCE_CELL,
        name: "hysteresis of the force cell",
        equation: "y = F_tire - clamp(F_tire - y_0, -h, h), y_0 dragged along by F_tire from h on",
        parts: &[part("force_cell.hysteresis", Scale::FORCE, (0.0, 1.0), &[0.1])],
        literature: &["Doebelin2003"],
        experiment: "load the cell by weights up and down, without the wheel's motion",
        ..PLAIN
    },
];
