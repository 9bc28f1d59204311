//! What the diagnosis has to know of each model.

use crate::catalogue::Element;
use crate::plant::models;

use super::actuated::{PUMP_ACTUATOR, SAS_RIG, SERVO_SUSPENSION};
use super::drives::{EXCITATION_MOTOR, LINEAR_DRIVE};
use super::{ElementSignals, ForceOf, Kind, Missing};

/// Section of a plant that does not drift, in seconds: it bounds the memory.
pub(super) const LONG: f64 = 60.0;

pub(super) const STRUT_FORCE: ForceOf = ForceOf::SpringAndDamper("strut.stiffness", "strut.damping");

pub(super) const KINDS: &[Kind] = &[
    Kind {
        plant: models::quarter_car,
        model: "QuarterCar",
        base: &[
            "sprung_mass",
            "unsprung_mass",
            "strut.stiffness",
            "strut.damping",
            "tire.stiffness",
            "tire.damping",
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
                element: Element::WheelGuide,
                deflection: "wheel.position",
                velocity: Some("wheel.velocity"),
                force: STRUT_FORCE,
            },
            ElementSignals {
                element: Element::Tire,
                deflection: "tire.deflection",
                velocity: None,
                force: ForceOf::Output("wheel.force"),
            },
            ElementSignals {
                element: Element::Actuator,
                deflection: "suspension.deflection",
                velocity: Some("suspension.velocity"),
                force: ForceOf::Input("actuator.force"),
            },
            ElementSignals {
                element: Element::ForceCell,
                deflection: "tire.deflection",
                velocity: None,
                force: ForceOf::Output("wheel.force"),
            },
        ],
        aliases: &[("road.position", &["road"]), ("actuator.force", &["force"])],
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
        section: LONG,
        drives: &[],
        excitation: &[],
    },
    Kind {
        plant: models::element_dyno,
        model: "ElementDyno",
        base: &["strut.stiffness", "strut.damping", "strut.preload"],
        elements: &[ElementSignals {
            element: Element::Strut,
            deflection: "deflection",
            velocity: None,
            force: ForceOf::Output("force"),
        }],
        aliases: &[("motion.position", &["-deflection"]), ("motion.velocity", &["-velocity"])],
        shown: &[],
        trivial: &["deflection"],
        // A force that is recorded beside a deflection resists it.
        opposed: Some(("deflection", "force")),
        missing: &[Missing {
            quantity: "force missing in the strut",
            output: "force",
            factor: None,
            over: &[Element::Strut],
        }],
        section: LONG,
        drives: &[],
        excitation: &[],
    },
    SERVO_SUSPENSION,
    PUMP_ACTUATOR,
    SAS_RIG,
    EXCITATION_MOTOR,
    LINEAR_DRIVE,
];
