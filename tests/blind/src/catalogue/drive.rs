//! What can be hidden in a linear drive, and in a mass on a spring.

use super::{ANY, Entry, Place, Role, SHAPE, ZERO, drawn, entry};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "02g",
        "breakaway friction of the drive's guide",
        Place::Guide,
        &[
            drawn("guide.coulomb.force", "N", (15.0, 35.0), ZERO, (0.0, 150.0)),
            drawn("guide.stribeck.force", "N", (10.0, 30.0), ZERO, (0.0, 150.0)),
            drawn("guide.stribeck.velocity", "m/s", (0.01, 0.04), SHAPE, ANY),
        ],
    ),
    entry(
        "27",
        "cogging of the motor",
        Place::Guide,
        &[
            drawn("guide.cogging.force", "N", (6.0, 20.0), ZERO, (0.0, 60.0)),
            drawn("guide.cogging.period", "m", (0.012, 0.04), SHAPE, ANY),
            drawn("guide.cogging.phase", "rad", (-3.0, 3.0), SHAPE, ANY),
        ],
    ),
    entry(
        "33g",
        "constant load of the drive",
        Place::Guide,
        &[drawn("constant_load", "N", (10.0, 30.0), Role::Signed, (-150.0, 150.0))],
    ),
    entry(
        "16m",
        "friction of the guide of a mass",
        Place::Guide,
        &[drawn("guide.coulomb.force", "N", (3.0, 10.0), ZERO, (0.0, 40.0))],
    ),
    entry(
        "08n",
        "cubic spring from a mass to the ground",
        Place::Guide,
        &[drawn("ground_spring.progression.cubic", "N/m3", (2e6, 8e6), ZERO, (0.0, 1e8))],
    ),
];
