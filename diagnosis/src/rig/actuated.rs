//! What the diagnosis has to know of rigs with an actuator of their own, and of actuators alone.

use crate::catalogue::Element;
use crate::plant::models;

use super::kinds::STRUT_FORCE;
use super::{ElementSignals, Excitation, ForceOf, Kind, Missing};

pub(super) const SERVO_SUSPENSION: Kind = Kind {
    plant: models::servo_suspension,
    model: "ServoSuspension",
    base: &[
        "sprung_mass",
        "unsprung_mass",
        "strut.stiffness",
        "strut.damping",
        "tire.stiffness",
        "tire.damping",
        // The gain of the flow: the supply's pressure and the valve's orifices act in the same way.
        "actuator.spool.gain",
        "actuator.spool.time_constant",
        "actuator.fluid.bulk_modulus",
        "actuator.cylinder.leakage",
    ],
    elements: &[
        ElementSignals {
            element: Element::Strut,
            deflection: "suspension.deflection",
            velocity: Some("suspension.velocity"),
            force: STRUT_FORCE,
        },
        ElementSignals {
            element: Element::Guide,
            deflection: "body.position",
            velocity: Some("body.velocity"),
            force: STRUT_FORCE,
        },
        ElementSignals {
            element: Element::Tire,
            deflection: "tire.deflection",
            velocity: None,
            force: ForceOf::Output("wheel.force"),
        },
        ElementSignals {
            element: Element::Valve,
            deflection: "spool.position",
            velocity: None,
            force: ForceOf::Output("actuator.force"),
        },
    ],
    aliases: &[
        ("road.position", &["road"]),
        ("voltage", &["valve.voltage", "actuator.voltage", "command", "u"]),
        ("pressure", &["load.pressure", "actuator.pressure", "pressure.difference"]),
        ("actuator.force", &["force"]),
        ("suspension.deflection", &["deflection"]),
        ("spool.position", &["spool"]),
    ],
    shown: &[],
    trivial: &[],
    opposed: None,
    missing: &[
        Missing {
            quantity: "force missing on the body",
            output: "body.acceleration",
            factor: Some(("sprung_mass", -1.0)),
            over: &[Element::Strut, Element::Guide],
        },
        Missing {
            quantity: "force missing in the tyre",
            output: "wheel.force",
            factor: None,
            over: &[Element::Tire],
        },
    ],
    // A closed valve holds the oil: what has once flowed in leaks away in seconds.
    section: 10.0,
    drives: &[],
    excitation: &[
        Excitation { input: "voltage", amplitude: 1.0, band: (0.5, 40.0) },
        Excitation { input: "road.position", amplitude: 3e-3, band: (0.5, 15.0) },
    ],
};

pub(super) const PUMP_ACTUATOR: Kind = Kind {
    plant: models::pump_hydraulic_actuator,
    model: "PumpHydraulicActuator",
    base: &[
        "pump.displacement",
        "motor.inertia",
        "gas.charge_pressure",
        "gas.exponent",
        // The valves' characteristics, point by point; the points at rest stay where they are.
        "valve.compression.pressure_drop[2]",
        "valve.compression.pressure_drop[3]",
        "valve.compression.pressure_drop[4]",
        "valve.compression.pressure_drop[6]",
        "valve.compression.pressure_drop[7]",
        "valve.compression.pressure_drop[8]",
        "valve.rebound.pressure_drop[2]",
        "valve.rebound.pressure_drop[3]",
        "valve.rebound.pressure_drop[4]",
        "valve.rebound.pressure_drop[6]",
        "valve.rebound.pressure_drop[7]",
        "valve.rebound.pressure_drop[8]",
    ],
    elements: &[ElementSignals {
        element: Element::Pump,
        // What turns without an end has no deflection; the force stands for the pressure that drives a leak.
        deflection: "force",
        velocity: Some("motor.speed"),
        force: ForceOf::Input("motor.torque"),
    }],
    aliases: &[
        ("suspension.velocity", &["velocity"]),
        ("motor.torque", &["torque"]),
        ("motor.speed", &["speed"]),
        ("force", &["actuator.force"]),
    ],
    shown: &[],
    trivial: &["motor.power"],
    opposed: None,
    missing: &[],
    // The gas's volume is what the pump and the piston have moved: it drifts with their errors.
    section: 10.0,
    drives: &[],
    excitation: &[
        Excitation { input: "suspension.velocity", amplitude: 0.4, band: (0.5, 12.0) },
        Excitation { input: "motor.torque", amplitude: 1.5, band: (0.5, 12.0) },
    ],
};

pub(super) const SAS_RIG: Kind = Kind {
    plant: models::sas_rig,
    model: "SasRig",
    base: &[
        "spring.stiffness",
        "body_arm.inertia",
        "body_arm.gravity_moment",
        "wheel_arm.inertia",
        "tire.stiffness",
        "tire.damping",
    ],
    elements: &[
        ElementSignals {
            element: Element::Pivot,
            deflection: "relative.angle",
            velocity: Some("relative.speed"),
            force: ForceOf::Moment("spring.force", "spring.body_arm_mount"),
        },
        ElementSignals {
            element: Element::Tire,
            deflection: "tire.compression",
            velocity: None,
            force: ForceOf::Output("tire.force"),
        },
    ],
    aliases: &[
        ("brake.torque", &["torque"]),
        ("eccentric.height", &["eccentric"]),
        ("body_arm.angle", &["body.angle", "gamma"]),
        ("wheel_arm.angle", &["wheel.angle", "alpha_1"]),
        ("relative.angle", &["alpha_2"]),
    ],
    shown: &[],
    trivial: &[],
    opposed: None,
    missing: &[Missing {
        quantity: "moment missing on the body arm",
        output: "body_arm.acceleration",
        factor: Some(("body_arm.inertia", -1.0)),
        over: &[Element::Pivot],
    }],
    // Without a brake the arms swing nearly undamped: a small error of frequency turns the phase in time.
    section: 10.0,
    drives: &[],
    excitation: &[
        Excitation { input: "brake.torque", amplitude: 0.6, band: (0.4, 10.0) },
        Excitation { input: "eccentric.height", amplitude: 2e-3, band: (0.4, 10.0) },
    ],
};
