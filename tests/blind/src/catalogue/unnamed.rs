//! What can be hidden and has no number anywhere.

use super::{ANY, Entry, Place, Role, SHAPE, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        variable: "suspension.deflection",
        ..entry(
            "U1",
            "hump of force over the deflection",
            Place::Strut,
            &[
                drawn("height", "N", (40.0, 90.0), Role::Signed, (-400.0, 400.0)),
                of(Scale::Deflection, drawn("centre", "m", (-0.25, 0.25), SHAPE, ANY)),
                of(Scale::Deflection, drawn("width", "m", (0.12, 0.25), SHAPE, ANY)),
            ],
        )
    },
    Entry {
        variable: "suspension.deflection",
        ..entry(
            "U2",
            "damping that changes over the deflection",
            Place::Strut,
            &[
                drawn("height", "1", (0.6, 1.2), ZERO, (0.0, 4.0)),
                of(Scale::Deflection, drawn("centre", "m", (-0.25, 0.25), SHAPE, ANY)),
                of(Scale::Deflection, drawn("width", "m", (0.15, 0.3), SHAPE, ANY)),
            ],
        )
    },
    Entry {
        variable: "suspension.velocity",
        ..entry(
            "U3",
            "friction that grows with the distance from the middle",
            Place::Strut,
            &[drawn("slope", "N/m", (6e3, 1.6e4), ZERO, (0.0, 1e5))],
        )
    },
    Entry {
        variable: "wheel.velocity",
        ..entry(
            "U4",
            "friction of the wheel's guide that comes and goes over its travel",
            Place::WheelGuide,
            &[
                drawn("force", "N", (60.0, 140.0), ZERO, (0.0, 600.0)),
                of(Scale::Travel, drawn("period", "m", (0.3, 0.6), SHAPE, ANY)),
            ],
        )
    },
    Entry {
        variable: "time",
        ..entry(
            "U5",
            "resonance of a sensor",
            Place::Sensor,
            &[
                drawn("frequency", "Hz", (25.0, 60.0), Role::Inverse, (8.0, 300.0)),
                drawn("damping_ratio", "1", (0.1, 0.3), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "time",
        ..entry(
            "U6",
            "high-pass of a sensor",
            Place::Sensor,
            &[drawn("high_pass", "Hz", (0.3, 1.0), ZERO, (0.0, 10.0))],
        )
    },
];
