//! What can be hidden in guides, frame, tyre and actuator of a quarter car, and in a servo valve.

use super::{ANY, Entry, Place, Role, SHAPE, Scale, ZERO, drawn, entry, of};

pub(super) static ENTRIES: &[Entry] = &[
    entry(
        "15",
        "viscous friction of the body's guide",
        Place::Guide,
        &[drawn("guide.damping", "N.s/m", (60.0, 150.0), ZERO, (0.0, 400.0))],
    ),
    entry(
        "16",
        "friction of the body's guide",
        Place::Guide,
        &[drawn("guide.coulomb.force", "N", (20.0, 60.0), ZERO, (0.0, 150.0))],
    ),
    entry(
        "17",
        "friction of the wheel's guide",
        Place::WheelGuide,
        &[drawn("wheel_guide.coulomb.force", "N", (30.0, 90.0), ZERO, (0.0, 300.0))],
    ),
    entry(
        "18",
        "mode of the frame",
        Place::Frame,
        &[
            drawn("frame.mass", "kg", (4.0, 10.0), ZERO, (0.0, 30.0)),
            drawn("frame.frequency", "Hz", (25.0, 60.0), SHAPE, ANY),
            drawn("frame.damping_ratio", "1", (0.01, 0.05), SHAPE, ANY),
        ],
    ),
    entry(
        "19",
        "progressive tyre",
        Place::Tire,
        &[
            // Beyond 4.9e6 the parabola would never lift off.
            drawn("tire.quadratic", "N/m2", (2.5e6, 4.5e6), ZERO, (0.0, 4.8e6)),
        ],
    ),
    entry("20", "lift-off of the tyre", Place::Tire, &[]),
    entry(
        "21",
        "damping of the tyre",
        Place::Tire,
        &[drawn("tire.damping.added", "N.s/m", (100.0, 300.0), ZERO, (0.0, 500.0))],
    ),
    entry(
        "22",
        "enveloping of the road by the tyre",
        Place::Tire,
        &[drawn("enveloping.time", "s", (0.004, 0.012), ZERO, (0.0, 0.02))],
    ),
    entry(
        "23",
        "delay of the actuator",
        Place::Actuator,
        &[drawn("actuator.delay", "s", (0.004, 0.012), ZERO, (0.0, 0.015))],
    ),
    entry(
        "24",
        "lag of the actuator",
        Place::Actuator,
        &[drawn("actuator.lag", "s", (0.004, 0.015), ZERO, (0.0, 0.02))],
    ),
    entry(
        "25",
        "force constant of the actuator",
        Place::Actuator,
        &[drawn("actuator.gain", "1", (0.08, 0.15), Role::AroundOne, (0.7, 1.3))],
    ),
    entry(
        "26",
        "saturation of the actuator",
        Place::Actuator,
        &[of(
            Scale::Command,
            drawn("actuator.saturation.force", "N", (0.5, 0.8), Role::Inverse, (0.15, 1.0)),
        )],
    ),
    entry(
        "26v",
        "limit of the valve's voltage",
        Place::Actuator,
        &[of(Scale::Command, drawn("voltage.limit", "V", (0.5, 0.8), Role::Inverse, (0.15, 1.0)))],
    ),
    entry(
        "26s",
        "slew limit of the actuator",
        Place::Actuator,
        &[drawn("actuator.slew.slowness", "s/N", (5e-5, 1.5e-4), ZERO, (0.0, 1e-3))],
    ),
    entry(
        "28",
        "spool overlap (dead band)",
        Place::Actuator,
        &[drawn("actuator.spool.overlap", "m", (4e-6, 1e-5), ZERO, (0.0, 2.5e-5))],
    ),
    entry(
        "28h",
        "hysteresis of the valve",
        Place::Actuator,
        &[drawn("actuator.spool.hysteresis", "m", (4e-6, 1e-5), ZERO, (0.0, 2.5e-5))],
    ),
    entry(
        "29",
        "gain of the valve",
        Place::Actuator,
        &[of(Scale::Base, drawn("actuator.spool.gain", "m/V", (0.15, 0.3), Role::AroundOne, (0.6, 1.4)))],
    ),
    entry(
        "30",
        "leakage of the cylinder",
        Place::Actuator,
        &[of(
            Scale::Base,
            drawn("actuator.cylinder.leakage", "m5/(N.s)", (2.0, 4.0), Role::From(1.0), (1.0, 30.0)),
        )],
    ),
];
