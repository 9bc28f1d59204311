//! What can be hidden and has no number anywhere.

use super::{ANY, Entry, Place, Role, SHAPE, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    Entry {
        variable: "suspension.deflection",
        depends_on: &["deflection"],
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
        depends_on: &["deflection", "velocity"],
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
        depends_on: &["velocity", "deflection"],
        ..entry(
            "U3",
            "friction that grows with the distance from the middle",
            Place::Strut,
            &[drawn("slope", "N/m", (6e3, 1.6e4), ZERO, (0.0, 1e5))],
        )
    },
    Entry {
        variable: "wheel.velocity",
        depends_on: &["velocity", "deflection"],
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
        depends_on: &["memory", "time"],
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
        depends_on: &["memory", "time"],
        ..entry(
            "U6",
            "high-pass of a sensor",
            Place::Sensor,
            &[drawn("high_pass", "Hz", (0.3, 1.0), ZERO, (0.0, 10.0))],
        )
    },
    Entry {
        variable: "acceleration",
        depends_on: &["acceleration"],
        ..entry(
            "U7",
            "inerter between body and wheel",
            Place::Strut,
            &[drawn("inertance", "kg", (1.0, 6.0), ZERO, (0.0, 15.0))],
        )
    },
    Entry {
        variable: "memory",
        depends_on: &["memory"],
        ..entry(
            "U8",
            "force of the strut that remembers as a fractional derivative does",
            Place::Strut,
            &[
                // At 1 rad/s.
                drawn("stiffness", "N/m", (1000.0, 3000.0), ZERO, (0.0, 4e4)),
                drawn("order", "1", (0.2, 0.6), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "memory",
        depends_on: &["memory", "acceleration"],
        ..entry(
            "U9",
            "absorber on the body",
            Place::Guide,
            &[
                // 2 to 15 % of the body.
                drawn("absorber.mass", "kg", (2.0, 8.0), ZERO, (0.0, 14.0)),
                // Below what a mode of the frame (18) has.
                drawn("absorber.frequency", "Hz", (2.0, 7.0), SHAPE, ANY),
                drawn("absorber.damping_ratio", "1", (0.02, 0.2), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "bursts",
        depends_on: &["bursts", "command"],
        ..entry(
            "U10",
            "drop-outs of the actuator",
            Place::Actuator,
            &[drawn("actuator.dropout.rate", "Hz", (0.3, 1.0), ZERO, (0.0, 6.0))],
        )
    },
    Entry {
        variable: "time",
        depends_on: &["time"],
        ..entry(
            "U11",
            "tyre whose stiffness changes as it turns",
            Place::Tire,
            &[
                drawn("tire.uneven.share", "1", (0.01, 0.04), ZERO, (0.0, 0.15)),
                drawn("tire.uneven.frequency", "Hz", (3.0, 12.0), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "deflection",
        depends_on: &["deflection", "velocity"],
        ..entry(
            "U12",
            "bypass of the damper about its middle, which chokes at speed",
            Place::Strut,
            &[
                drawn("share", "1", (0.5, 0.8), ZERO, (0.0, 0.97)),
                of(Scale::Deflection, drawn("centre", "m", (-0.15, 0.15), SHAPE, ANY)),
                of(Scale::Deflection, drawn("width", "m", (0.15, 0.35), SHAPE, ANY)),
                drawn("velocity", "m/s", (0.1, 0.4), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "bursts",
        depends_on: &["bursts", "acceleration"],
        ..entry(
            "U13",
            "loose sensor that rattles",
            Place::Sensor,
            &[
                drawn("gap", "m", (1e-6, 4e-6), ZERO, (0.0, 2e-3)),
                of(Scale::Signal, drawn("friction", "", (0.2, 0.6), SHAPE, ANY)),
                drawn("rattle_frequency", "Hz", (120.0, 300.0), SHAPE, ANY),
                drawn("rattle_damping", "1", (0.05, 0.15), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "time",
        depends_on: &["time"],
        ..entry(
            "U14",
            "part on the body that turns out of balance",
            Place::Guide,
            &[
                drawn("imbalance.moment", "kg.m", (0.005, 0.02), ZERO, (0.0, 0.2)),
                drawn("imbalance.frequency", "Hz", (4.0, 15.0), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "command",
        depends_on: &["command"],
        ..entry(
            "U15",
            "second path of the actuator's force to the body, which is late",
            Place::Guide,
            &[
                drawn("crosstalk.gain", "1", (0.08, 0.2), Role::Signed, (-0.5, 0.5)),
                drawn("crosstalk.delay", "s", (0.01, 0.04), SHAPE, ANY),
            ],
        )
    },
    Entry {
        variable: "memory",
        depends_on: &["memory", "acceleration"],
        ..entry(
            "U9m",
            "absorber on a mass",
            Place::Guide,
            &[
                drawn("absorber.mass", "kg", (0.5, 1.5), ZERO, (0.0, 4.0)),
                drawn("absorber.frequency", "Hz", (2.0, 9.0), SHAPE, ANY),
                drawn("absorber.damping_ratio", "1", (0.02, 0.2), SHAPE, ANY),
            ],
        )
    },
];
