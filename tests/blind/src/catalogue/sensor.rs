//! What can be hidden in a sensor.

use super::{Entry, Place, RATE_ERROR, Role, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "33",
        "offset of a sensor",
        Place::Sensor,
        &[
            of(Scale::Signal, drawn("offset", "", (0.3, 1.0), Role::Signed, (-5.0, 5.0))),
            of(Scale::Signal, drawn("drift", "/s", (0.0, 0.02), Role::Signed, (-0.2, 0.2))),
        ],
    ),
    entry(
        "34",
        "gain of a sensor",
        Place::Sensor,
        &[drawn("gain", "1", (0.08, 0.25), Role::AroundOne, (0.6, 1.4))],
    ),
    entry("35", "lag of a sensor", Place::Sensor, &[drawn("lag", "s", (0.003, 0.012), ZERO, (0.0, 0.05))]),
    entry(
        "36",
        "time skew of a sensor",
        Place::Sensor,
        &[drawn("skew", "s", (0.003, 0.010), Role::Signed, (-0.02, 0.02))],
    ),
    entry(
        "37",
        "quantisation of a sensor",
        Place::Sensor,
        &[of(Scale::Signal, drawn("quantum", "", (0.1, 0.3), ZERO, (0.0, 1.0)))],
    ),
    entry(
        "38",
        "saturation of a sensor",
        Place::Sensor,
        &[of(Scale::Signal, drawn("range", "", (1.0, 1.5), Role::Inverse, (0.5, 3.0)))],
    ),
    entry(
        "38d",
        "dropouts of a sensor",
        Place::Sensor,
        &[drawn("dropout", "1", (0.003, 0.01), ZERO, (0.0, 0.02))],
    ),
    entry(
        "40",
        "error of a sensor's sample rate",
        Place::Sensor,
        &[drawn("rate", "1", (0.002, 0.006), Role::Signed, (-RATE_ERROR, RATE_ERROR))],
    ),
    // Faster than half of any record's sampling rate, and after every filter.
    entry(
        "40a",
        "aliasing in a sensor",
        Place::Sensor,
        &[
            of(Scale::Signal, drawn("alias", "", (0.05, 0.2), ZERO, (0.0, 0.5))),
            drawn("alias_frequency", "Hz", (1030.0, 1150.0), Role::Shape, (1030.0, 1150.0)),
        ],
    ),
    entry(
        "41",
        "inertia of the wheel's force cell",
        Place::Sensor,
        &[drawn("force_cell.mass", "kg", (3.0, 8.0), ZERO, (0.0, 10.0))],
    ),
    entry(
        "41h",
        "hysteresis of the wheel's force cell",
        Place::Sensor,
        &[of(Scale::Signal, drawn("force_cell.hysteresis", "", (0.06, 0.15), ZERO, (0.0, 0.6)))],
    ),
    entry(
        "42",
        "gain and lag of the road's sensor",
        Place::Sensor,
        &[
            drawn("gain", "1", (0.08, 0.2), Role::AroundOne, (0.6, 1.4)),
            drawn("lag", "s", (0.002, 0.008), ZERO, (0.0, 0.02)),
        ],
    ),
];
