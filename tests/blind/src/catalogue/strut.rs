//! What can be hidden between body and wheel, or in a clamped strut.

use super::{ANY, Entry, Place, Role, SHAPE, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "01",
        "friction of the strut",
        Place::Strut,
        &[drawn("strut.coulomb.force", "N", (35.0, 80.0), ZERO, (0.0, 400.0))],
    ),
    entry(
        "02",
        "breakaway friction of the strut",
        Place::Strut,
        &[
            drawn("strut.coulomb.force", "N", (25.0, 50.0), ZERO, (0.0, 300.0)),
            drawn("strut.stribeck.force", "N", (20.0, 50.0), ZERO, (0.0, 300.0)),
            drawn("strut.stribeck.velocity", "m/s", (0.01, 0.04), SHAPE, ANY),
        ],
    ),
    entry(
        "03",
        "presliding friction of the strut",
        Place::Strut,
        &[
            drawn("hysteresis.presliding.force", "N", (40.0, 80.0), ZERO, (0.0, 400.0)),
            drawn("hysteresis.presliding.stiffness", "N/m", (2.5e4, 1.5e5), SHAPE, ANY),
        ],
    ),
    entry(
        "03b",
        "friction of the strut behind backlash",
        Place::Strut,
        &[
            drawn("hysteresis.presliding.force", "N", (40.0, 80.0), ZERO, (0.0, 400.0)),
            drawn("hysteresis.presliding.stiffness", "N/m", (5e4, 2e5), SHAPE, ANY),
            of(Scale::Deflection, drawn("hysteresis.presliding.gap", "m", (0.06, 0.15), SHAPE, ANY)),
        ],
    ),
    entry(
        "04",
        "asymmetry of the damper",
        Place::Strut,
        &[drawn("strut.asymmetry.ratio", "1", (0.25, 0.5), Role::Signed, (-0.8, 0.8))],
    ),
    entry(
        "05",
        "knee of the damper",
        Place::Strut,
        &[
            drawn("strut.knee.ratio", "1", (-0.75, -0.45), ZERO, (-0.9, 0.0)),
            drawn("strut.knee.velocity", "m/s", (0.05, 0.12), SHAPE, ANY),
        ],
    ),
    entry(
        "06",
        "orifice of the damper",
        Place::Strut,
        &[drawn("strut.orifice.coefficient", "N.s2/m2", (500.0, 1500.0), ZERO, (0.0, 5000.0))],
    ),
    entry(
        "07",
        "Maxwell branch of the strut",
        Place::Strut,
        &[
            drawn("hysteresis.maxwell.stiffness", "N/m", (1.5e4, 5e4), ZERO, (0.0, 3e5)),
            drawn("hysteresis.maxwell.time", "s", (0.006, 0.04), SHAPE, ANY),
        ],
    ),
    entry(
        "08",
        "curved spring",
        Place::Strut,
        &[
            drawn("strut.spring.quadratic", "N/m2", (2e5, 5e5), Role::Signed, (-1e6, 1e6)),
            drawn("strut.spring.cubic", "N/m3", (1e7, 5e7), ZERO, (0.0, 1e8)),
        ],
    ),
    entry(
        "09",
        "stops of the strut",
        Place::Strut,
        &[
            drawn("strut.stop.stiffness", "N/m", (3e4, 1.2e5), ZERO, (0.0, 1e6)),
            of(Scale::Deflection, drawn("strut.stop.clearance", "m", (0.45, 0.6), SHAPE, ANY)),
        ],
    ),
    entry(
        "10",
        "fade of the damper",
        Place::Strut,
        &[
            drawn("strut.fade.ratio", "1", (0.25, 0.5), ZERO, (0.0, 0.6)),
            drawn("strut.fade.time", "s", (4.0, 12.0), SHAPE, ANY),
        ],
    ),
    entry(
        "12",
        "backlash of the damper's bush",
        Place::Strut,
        &[
            drawn("hysteresis.mount.gap", "m", (3e-4, 1e-3), ZERO, (0.0, 4e-3)),
            drawn("hysteresis.mount.compliance", "m/N", (1e-6, 4e-6), SHAPE, ANY),
        ],
    ),
    entry(
        "13",
        "soft mount of the damper",
        Place::Strut,
        &[drawn("hysteresis.mount.compliance", "m/N", (8e-6, 2.5e-5), ZERO, (0.0, 1e-4))],
    ),
    entry(
        "14",
        "linkage",
        Place::Strut,
        &[drawn("strut.linkage.slope", "1/m", (3.0, 5.0), Role::Signed, (-12.0, 12.0))],
    ),
    entry(
        "32",
        "yield force of a magnetorheological damper",
        Place::Strut,
        &[
            drawn("strut.yield.force", "N", (40.0, 90.0), ZERO, (0.0, 400.0)),
            drawn("strut.yield.velocity", "m/s", (0.01, 0.03), SHAPE, ANY),
            drawn("strut.yield.slope", "1/m", (20.0, 60.0), SHAPE, ANY),
        ],
    ),
    entry(
        "32h",
        "yield force of a magnetorheological damper, with the hysteresis of a shaker's strokes",
        Place::Strut,
        &[
            drawn("strut.yield.force", "N", (150.0, 400.0), ZERO, (0.0, 1000.0)),
            drawn("strut.yield.velocity", "m/s", (0.02, 0.06), SHAPE, ANY),
            drawn("strut.yield.slope", "1/m", (80.0, 200.0), SHAPE, ANY),
        ],
    ),
];
