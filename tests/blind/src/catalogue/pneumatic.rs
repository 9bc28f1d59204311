//! What can be hidden in a pneumatic cylinder with its valve and its guide.

use super::{Entry, Place, Role, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "15c",
        "another viscous friction of a cylinder's guide",
        Place::Guide,
        &[of(Scale::Base, drawn("guide.damping", "N.s/m", (0.3, 0.6), Role::AroundOne, (0.2, 1.8)))],
    ),
    // A share of the full opening.
    entry(
        "28c",
        "spool overlap (dead band) of a pneumatic valve",
        Place::Cylinder,
        &[drawn("actuator.spool.overlap", "1", (0.02, 0.05), ZERO, (0.0, 0.1))],
    ),
    // A data sheet is that far off where hoses and fittings are left out.
    entry(
        "29c",
        "another conductance of a pneumatic valve",
        Place::Cylinder,
        &[of(
            Scale::Base,
            drawn("actuator.valve.conductance", "m5/(N.s)", (0.12, 0.12), Role::AroundOne, (0.88, 1.12)),
        )],
    ),
    // At a bar between the chambers some 1 to 2 % of what flows choked through the fully open valve.
    entry(
        "30c",
        "leakage between the chambers of a pneumatic cylinder",
        Place::Cylinder,
        &[drawn("actuator.cylinder.leakage", "m5/(N.s)", (4e-10, 1.2e-9), ZERO, (0.0, 2e-8))],
    ),
];
