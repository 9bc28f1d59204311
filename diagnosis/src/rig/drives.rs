//! What the diagnosis has to know of positioning drives.

use crate::catalogue::Element;
use crate::plant::models;

use super::{Aliases, DrivenBy, ElementSignals, Excitation, ForceOf, Kind, Missing};

const MISSING: &[Missing] = &[Missing {
    quantity: "force missing on the moving mass",
    output: "acceleration",
    factor: Some(("moving_mass", -1.0)),
    over: &[Element::Guide],
}];

const POSITION: Aliases = ("position", &["displacement", "x", "q", "measured.position", "motor.position"]);
const VELOCITY: Aliases = ("velocity", &["speed", "v", "measured.velocity"]);
const ACCELERATION: Aliases = ("acceleration", &["a"]);
const LOAD: Aliases = ("load.force", &["external.force"]);

const FORCES: &[&str] = &["force.command", "commanded.force", "control.force", "force", "motor.force"];
const VOLTAGES: &[&str] = &["voltage.command", "control.voltage", "voltage", "motor.voltage", "u"];

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
        force: ForceOf::InputOrMoment("force", "acceleration", "moving_mass"),
    }],
    aliases: &[POSITION, VELOCITY, ACCELERATION, LOAD],
    trivial: &["resistance"],
    opposed: None,
    missing: MISSING,
    // Behind a force the position drifts wherever nothing holds it: over a second, errors are still of what happens then.
    section: 1.0,
    drives: &[
        DrivenBy { setting: "drive", item: "Force", input: "force", base: &[], columns: FORCES },
        DrivenBy { setting: "drive", item: "Command", input: "command", base: &[], columns: VOLTAGES },
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
    trivial: &["following_error", "stroke.reserve", "speed.reserve", "power"],
    opposed: None,
    missing: MISSING,
    // Behind a force or a voltage the position drifts wherever nothing holds it.
    section: 5.0,
    // A measured force or voltage says more of the motor than a set point, which a loop of unknown make follows.
    drives: &[
        DrivenBy { setting: "drive", item: "Force", input: "command.force", base: &[], columns: FORCES },
        DrivenBy {
            setting: "drive",
            item: "Voltage",
            input: "command.voltage",
            base: &["force_constant", "resistance"],
            columns: VOLTAGES,
        },
        DrivenBy {
            setting: "drive",
            item: "Position",
            input: "command.position",
            base: &["position_loop.gain", "velocity_loop.proportional", "velocity_loop.integral"],
            columns: &[
                "position.command",
                "commanded.position",
                "reference.position",
                "position.reference",
                "desired.position",
                "set.point",
                "setpoint",
                "reference",
                "command",
            ],
        },
    ],
    excitation: &[
        Excitation { input: "command.position", amplitude: 0.012, band: (0.4, 8.0) },
        Excitation { input: "command.force", amplitude: 60.0, band: (0.4, 12.0) },
        Excitation { input: "command.voltage", amplitude: 30.0, band: (0.4, 12.0) },
    ],
};
