//! What can be hidden in a semi-active rig of two arms.

use super::{Entry, Place, ZERO, drawn, entry};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "01p",
        "friction of the pivot",
        Place::Pivot,
        &[drawn("pivot.coulomb.torque", "N.m", (0.1, 0.3), ZERO, (0.0, 1.5))],
    ),
    // Its compression counts from the unloaded tyre, and is some 2 mm at rest.
    entry(
        "19p",
        "progressive tyre on an eccentric",
        Place::Tire,
        &[drawn("tire.quadratic", "N/m2", (1e7, 3e7), ZERO, (0.0, 2e8))],
    ),
];
