//! What the diagnosis has to know of positioning drives.

use crate::catalogue::Element;
use crate::plant::models;

use super::kinds::LONG;
use super::{Aliases, DrivenBy, ElementSignals, Excitation, ForceOf, Inverse, Kind, Missing, driven};

const MISSING_ON_THE_MASS: Missing = Missing {
    quantity: "force missing on the moving mass",
    output: "acceleration",
    factor: Some(("moving_mass", -1.0)),
    over: &[Element::Guide],
};

const MISSING_IN_THE_MOTOR: Missing = Missing {
    quantity: "force missing on the moving mass",
    output: "motor.force",
    factor: None,
    over: &[Element::Guide],
};

const POSITION: Aliases = ("position", POSITIONS);
const VELOCITY: Aliases = ("velocity", &["speed", "v", "measured.velocity"]);
const ACCELERATION: Aliases = ("acceleration", &["a"]);
const POSITIONS: &[&str] = &["position", "displacement", "x", "q", "measured.position", "motor.position"];
const LOAD: Aliases = ("load.force", &["external.force"]);

const FORCES: &[&str] = &["force.command", "commanded.force", "control.force", "force", "motor.force"];
const VOLTAGES: &[&str] = &["voltage.command", "control.voltage", "voltage", "motor.voltage", "u"];

const SET_POINTS: &[&str] = &[
    "position.command",
    "commanded.position",
    "reference.position",
    "position.reference",
    "desired.position",
    "set.point",
    "setpoint",
    "reference",
    "command",
];

pub(super) const LINEAR_DRIVE: Kind = Kind {
    plant: models::linear_drive,
    model: "LinearDrive",
    // The amplifier's gain is not told from mass and friction together: it is taken as known. A constant force drives a mass
    // that nothing holds ever further from where it was: whatever else is looked for would have to make up for it.
    base: &["moving_mass", "guide.damping", "constant_load"],
    elements: &[ElementSignals {
        element: Element::Guide,
        deflection: "position",
        velocity: Some("velocity"),
        force: ForceOf::Output("motor.force"),
    }],
    aliases: &[POSITION, VELOCITY, ACCELERATION, LOAD, ("motor.force", FORCES)],
    shown: &[("position", "carriage.position"), ("velocity", "carriage.velocity")],
    trivial: &["resistance"],
    opposed: None,
    missing: &[MISSING_ON_THE_MASS, MISSING_IN_THE_MOTOR],
    // Behind a force the position drifts wherever nothing holds it: over a second, errors are still of what happens then.
    section: 1.0,
    drives: &[
        DrivenBy { trivial: &["motor.force"], ..driven("drive", "Force", "force", FORCES) },
        DrivenBy { trivial: &["motor.force"], ..driven("drive", "Command", "command", VOLTAGES) },
        DrivenBy {
            // What turns has its weight, which takes a force that follows the position.
            base: &["ground_spring.stiffness"],
            trivial: &["position", "velocity", "acceleration"],
            inverse: Some(Inverse {
                force: "motor.force",
                position: "motion.position",
                acceleration: "motion.acceleration",
                instead: "acceleration",
            }),
            section: Some(LONG),
            ..driven("drive", "Motion", "motion.position", POSITIONS)
        },
    ],
    excitation: &[
        Excitation { input: "force", amplitude: 60.0, band: (0.4, 12.0) },
        Excitation { input: "command", amplitude: 60.0, band: (0.4, 12.0) },
    ],
};

pub(super) const EXCITATION_MOTOR: Kind = Kind {
    plant: models::excitation_motor,
    model: "ExcitationMotor",
    base: &["moving_mass", "base_spring.stiffness"],
    elements: &[ElementSignals {
        element: Element::Guide,
        deflection: "position",
        velocity: Some("velocity"),
        force: ForceOf::Output("force"),
    }],
    aliases: &[
        POSITION,
        VELOCITY,
        ACCELERATION,
        ("current", &["i", "motor.current"]),
        ("force", &["motor.force"]),
        LOAD,
    ],
    shown: &[],
    trivial: &["following_error", "stroke.reserve", "speed.reserve", "power"],
    opposed: None,
    missing: &[MISSING_ON_THE_MASS],
    // Behind a force or a voltage the position drifts wherever nothing holds it.
    section: 5.0,
    // A measured force or voltage says more of the motor than a set point, which a loop of unknown make follows.
    drives: &[
        driven("drive", "Force", "command.force", FORCES),
        DrivenBy {
            base: &["force_constant", "resistance"],
            ..driven("drive", "Voltage", "command.voltage", VOLTAGES)
        },
        DrivenBy {
            base: &["position_loop.gain", "velocity_loop.proportional", "velocity_loop.integral"],
            ..driven("drive", "Position", "command.position", SET_POINTS)
        },
    ],
    excitation: &[
        Excitation { input: "command.position", amplitude: 0.012, band: (0.4, 8.0) },
        Excitation { input: "command.force", amplitude: 60.0, band: (0.4, 12.0) },
        Excitation { input: "command.voltage", amplitude: 30.0, band: (0.4, 12.0) },
    ],
};
