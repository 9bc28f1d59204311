//! What can be hidden in a pump actuator.

use super::{Entry, Place, Role, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "30p",
        "leakage of the pump",
        Place::Pump,
        // Some 2 to 6 % of the flow.
        &[drawn("pump.leakage", "m5/(N.s)", (1e-11, 3e-11), ZERO, (0.0, 2e-10))],
    ),
    entry(
        "32a",
        "another charge pressure of the gas",
        Place::Pump,
        &[of(Scale::Base, drawn("gas.charge_pressure", "Pa", (0.7, 0.9), Role::From(1.0), (0.5, 1.0)))],
    ),
    entry(
        "32b",
        "another characteristic of the rebound valve",
        Place::Pump,
        &[drawn("valve.rebound.pressure_drop", "1", (0.2, 0.4), Role::AroundOne, (0.4, 1.6))],
    ),
    entry(
        "32c",
        "friction of the pump",
        Place::Pump,
        &[drawn("pump.coulomb.torque", "N.m", (0.08, 0.2), ZERO, (0.0, 0.6))],
    ),
];
