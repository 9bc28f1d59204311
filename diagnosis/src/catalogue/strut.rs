//! Effects in the strut and in the guides.

use super::{
    Beyond, Effect, Element, FRICTION_VELOCITY, Onset, PLAIN, Part, Prevalence, Replaced, Scale, addend,
    bends, bends_between, beyond, part,
};
use crate::signal::distortion::Fault;

/// Clearances of a stop: the strut reaches its ends now and then, at most.
const CLEARANCES: &[f64] = &[1.2, 1.8, 2.4, 3.2];

/// Bounds of the velocity at which friction in a strut is regularised. Above, it has less than its full force at typical velocities:
/// that is digressive damping.
const SLIDING_VELOCITY: (f64, f64) = (FRICTION_VELOCITY.0, 0.3);

/// Yield force: how it turns over.
pub(super) const YIELD_VELOCITY: Part =
    bends(part("strut.yield.velocity", Scale::VELOCITY, (1e-2, 3.0), &[0.1, 0.4]));
pub(super) const YIELD_SLOPE: Part =
    part("strut.yield.slope", Scale::PER_DEFLECTION, (-20.0, 20.0), &[-1.0, 1.0]);

pub(super) const EFFECTS: &[Effect] = &[
    Effect {
        id: "01",
        element: Element::STRUT,
        name: "Coulomb friction",
        equation: "F = F_c tanh(v/v_0)",
        prevalence: Prevalence::Expected,
        parts: &[
            part("strut.coulomb.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            bends(part("strut.coulomb.velocity", Scale::VELOCITY, SLIDING_VELOCITY, &[0.02, 0.2])),
        ],
        literature: &["ArmstrongHelouvry1994", "TUM"],
        experiment: "sweep the amplitude at one frequency, or drive a slow triangle",
        ..PLAIN
    },
    Effect {
        id: "02",
        element: Element::STRUT,
        name: "Stribeck friction",
        equation: "F = (F_c + (F_s - F_c) exp(-(v/v_s)^2)) tanh(v/v_0)",
        contains: &["01"],
        onset: Onset::Standstill,
        parts: &[
            // A peak that is narrower and higher than this imitates sticking.
            part("strut.stribeck.force", Scale::FORCE, (0.0, 2.0), &[0.1]),
            part("strut.stribeck.velocity", Scale::VELOCITY, (2e-2, 1.0), &[0.1]),
            part("strut.coulomb.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("strut.coulomb.velocity", Scale::VELOCITY, SLIDING_VELOCITY, &[0.02]),
        ],
        literature: &["ArmstrongHelouvry1994", "CanudasDeWit1995"],
        experiment: "creep through zero velocity below 5 mm/s",
        ..PLAIN
    },
    Effect {
        id: "03",
        element: Element::STRUT,
        name: "friction with presliding (Dahl)",
        equation: "F' = sigma v |1 - sgn(v) F/F_c|^n sgn(1 - sgn(v) F/F_c)",
        contains: &["01"],
        parts: &[
            part("hysteresis.presliding.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("hysteresis.presliding.stiffness", Scale::STIFFNESS, (1e-2, 1e3), &[0.5, 3.0, 20.0]),
            part("hysteresis.presliding.exponent", Scale::ONE, (0.2, 4.0), &[1.0]),
        ],
        literature: &["Dahl1968"],
        experiment: "drive a multisine of less than 0.2 mm stroke",
        ..PLAIN
    },
    Effect {
        id: "03b",
        element: Element::STRUT,
        name: "friction with presliding behind backlash",
        equation: "F = dz(y, sigma b), y' = sigma v |1 - sgn(v) F/F_c|^n sgn(1 - sgn(v) F/F_c)",
        contains: &["01", "03"],
        parts: &[
            part("hysteresis.presliding.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("hysteresis.presliding.stiffness", Scale::STIFFNESS, (1e-2, 1e3), &[0.5, 3.0, 20.0]),
            part("hysteresis.presliding.gap", Scale::DEFLECTION, (0.0, 1.0), &[0.05, 0.2, 0.6]),
            part("hysteresis.presliding.exponent", Scale::ONE, (0.2, 4.0), &[1.0]),
        ],
        literature: &["Dahl1968", "Nordin2002"],
        experiment: "reverse slowly at several places: the force rests at zero over the backlash",
        ..PLAIN
    },
    Effect {
        id: "04",
        element: Element::STRUT,
        name: "asymmetric damper",
        equation: "F = d (v + alpha |v|)",
        parts: &[part("strut.asymmetry.ratio", Scale::ONE, (-0.9, 0.9), &[0.2])],
        literature: &["Dixon2007"],
        experiment: "stand still, and compare the ride height with that in motion",
        ..PLAIN
    },
    Effect {
        id: "05",
        element: Element::STRUT,
        name: "damper knee",
        equation: "F = d (v + r dz(v, v_k))",
        onset: Onset::Threshold,
        parts: &[
            part("strut.knee.ratio", Scale::ONE, (-0.95, 5.0), &[-0.4]),
            // A knee far below the usual velocities would be friction.
            beyond(
                part("strut.knee.velocity", Scale::VELOCITY, (0.2, 3.0), &[0.3, 1.0]),
                Beyond::Speed("beyond the knee"),
            ),
        ],
        literature: &["Dixon2007"],
        experiment: "sweep the velocity",
        ..PLAIN
    },
    Effect {
        id: "05s",
        element: Element::STRUT,
        name: "digressive damping",
        equation: "F = F_y tanh(v/v_y)",
        parts: &[
            part("strut.yield.force", Scale::FORCE, (0.0, 10.0), &[0.3]),
            // What has its full force at lower velocities is friction.
            bends_between(part(
                "strut.yield.velocity",
                Scale::VELOCITY,
                (SLIDING_VELOCITY.1, 3.0),
                &[0.5, 1.0],
            )),
        ],
        literature: &["Dixon2007", "Heissing2011"],
        experiment: "sweep the velocity",
        ..PLAIN
    },
    Effect {
        id: "06",
        element: Element::STRUT,
        name: "orifice damping",
        equation: "F = c v |v|",
        parts: &[part("strut.orifice.coefficient", Scale::ORIFICE, (0.0, 10.0), &[0.1])],
        literature: &["Dixon2007", "Merritt1967"],
        experiment: "sweep the amplitude",
        ..PLAIN
    },
    Effect {
        id: "07",
        element: Element::STRUT,
        name: "Maxwell branch",
        equation: "F = k_1 xi, xi' = v - xi/tau",
        contains: &["13"],
        prevalence: Prevalence::Background,
        parts: &[
            part("hysteresis.maxwell.stiffness", Scale::STIFFNESS, (0.0, 100.0), &[0.1]),
            part("hysteresis.maxwell.time", Scale::ONE, (5e-4, 0.5), &[0.005, 0.03, 0.12]),
        ],
        literature: &["Christensen1982", "Lakes2009"],
        experiment: "excite by the road with the actuator off, and by the actuator with the road locked",
        ..PLAIN
    },
    Effect {
        id: "08",
        element: Element::STRUT,
        name: "nonlinear spring",
        equation: "F = k_2 x^2 + k_3 x^3",
        prevalence: Prevalence::Background,
        parts: &[
            part("strut.spring.cubic", Scale::CUBIC, (-5.0, 5.0), &[0.05]),
            addend("strut.spring.quadratic", Scale::QUADRATIC, (-5.0, 5.0), &[0.05]),
        ],
        literature: &["Worden2001"],
        experiment: "move through the whole stroke quasi-statically",
        ..PLAIN
    },
    Effect {
        id: "09",
        element: Element::STRUT,
        name: "bump or rebound stop",
        equation: "F = k_b (|x| - x_b) beyond x_b",
        onset: Onset::Threshold,
        prevalence: Prevalence::Background,
        parts: &[
            // What is softer than the spring beside it is a curved spring, and no stop.
            part("strut.stop.stiffness", Scale::STIFFNESS, (1.0, 300.0), &[2.0]),
            beyond(
                part("strut.stop.compression_clearance", Scale::DEFLECTION, (0.3, 20.0), CLEARANCES),
                Beyond::Compression("compression stop"),
            ),
            beyond(
                part("strut.stop.rebound_clearance", Scale::DEFLECTION, (0.3, 20.0), CLEARANCES),
                Beyond::Rebound("rebound stop"),
            ),
        ],
        literature: &["Worden2001", "Heissing2011"],
        experiment: "move slowly to both ends of the stroke",
        ..PLAIN
    },
    Effect {
        id: "10",
        element: Element::STRUT,
        name: "damper fade",
        equation: "d(t) = d (1 - alpha (1 - exp(-t/tau)))",
        parts: &[
            part("strut.fade.ratio", Scale::ONE, (0.0, 0.9), &[0.2]),
            part("strut.fade.time", Scale::ONE, (0.5, 2000.0), &[5.0, 50.0]),
        ],
        literature: &["Dixon2007", "Hryciow2022"],
        experiment: "repeat the run cold and hot",
        ..PLAIN
    },
    Effect {
        id: "11",
        element: Element::STRUT,
        name: "load-dependent friction",
        equation: "F = F_c (1 + beta x) tanh(v/v_0)",
        contains: &["01"],
        parts: &[
            part("strut.load_dependence.slope", Scale::PER_DEFLECTION, (-0.8, 0.8), &[0.3]),
            part("strut.coulomb.force", Scale::FORCE, (0.0, 10.0), &[0.1]),
            part("strut.coulomb.velocity", Scale::VELOCITY, SLIDING_VELOCITY, &[0.02]),
        ],
        literature: &["ArmstrongHelouvry1994"],
        experiment: "repeat with two preloads",
        ..PLAIN
    },
    Effect {
        id: "12",
        element: Element::STRUT,
        name: "backlash in a damper bush",
        equation: "F = dz(x - w, g)/c, w' = F/d",
        contains: &["13"],
        onset: Onset::Threshold,
        parts: &[
            part("hysteresis.mount.gap", Scale::DEFLECTION, (1e-4, 2.0), &[0.02, 0.045, 0.1, 0.2, 0.4]),
            part("hysteresis.mount.compliance", Scale::COMPLIANCE, (3e-3, 1.0), &[0.03]),
        ],
        literature: &["Nordin2002"],
        experiment: "compare small and large strokes",
        ..PLAIN
    },
    Effect {
        id: "12c",
        element: Element::STRUT,
        name: "play in the clevis",
        equation: "F = F_strut(x - e, u), u = dz(e, g)/T, e' = v - u, T = 0.5 ms",
        onset: Onset::Threshold,
        parts: &[part("clevis.gap", Scale::DEFLECTION, (1e-4, 1.0), &[0.02, 0.045, 0.1, 0.2])],
        literature: &["Nordin2002"],
        experiment: "turn round slowly at several places: over the play the force rests, whatever the stroke; take out a spring first",
        ..PLAIN
    },
    Effect {
        id: "13",
        element: Element::STRUT,
        name: "top-mount compliance",
        equation: "F = (x - w)/c, w' = F/d",
        prevalence: Prevalence::Background,
        parts: &[part("hysteresis.mount.compliance", Scale::COMPLIANCE, (3e-3, 10.0), &[0.02, 0.1, 0.5])],
        literature: &["Brennan2008", "Heissing2011"],
        experiment: "sweep to high frequencies",
        ..PLAIN
    },
    Effect {
        id: "14",
        element: Element::STRUT,
        name: "motion ratio",
        equation: "i = 1 + i_1 x on spring and damper",
        parts: &[part("strut.linkage.slope", Scale::PER_DEFLECTION, (-0.3, 0.3), &[0.05])],
        literature: &["Milliken1995"],
        experiment: "measure the wheel's travel over the strut's",
        ..PLAIN
    },
    Effect {
        id: "32f",
        element: Element::STRUT,
        name: "dry yield force with hysteresis",
        equation: "F = F_y tanh(v/v_y + beta x)",
        contains: &["01", "02", "05s"],
        parts: &[part("strut.yield.force", Scale::FORCE, (0.0, 10.0), &[0.3]), YIELD_VELOCITY, YIELD_SLOPE],
        literature: &["Kwok2006", "Spencer1997"],
        experiment: "hold the coil's voltage and compare slow and fast strokes",
        ..PLAIN
    },
    Effect {
        id: "33",
        element: Element::STRUT,
        name: "force offset",
        equation: "F = F_0",
        replaces: Some(Replaced { inputs: "actuator.force", distortion: Fault::Offset }),
        parts: &[part("strut.preload", Scale::FORCE, (-10.0, 10.0), &[0.1])],
        literature: &["Dixon2007", "Kwok2006"],
        experiment: "stand still with the force cell unloaded: what remains is the cell's",
        ..PLAIN
    },
    Effect {
        id: "15",
        element: Element::GUIDE,
        name: "viscous guide",
        equation: "F = d_g v_s",
        parts: &[part("guide.damping", Scale::DAMPING, (0.0, 5.0), &[0.1])],
        literature: &["ArmstrongHelouvry1994"],
        experiment: "sweep the amplitude",
        ..PLAIN
    },
    Effect {
        id: "16",
        element: Element::GUIDE,
        name: "guide friction",
        equation: "F = F_g tanh(v_s/v_0)",
        prevalence: Prevalence::Expected,
        parts: &[
            part("guide.coulomb.force", Scale::FORCE, (0.0, 5.0), &[0.1]),
            part("guide.coulomb.velocity", Scale::VELOCITY, FRICTION_VELOCITY, &[0.02, 0.2]),
        ],
        literature: &["ArmstrongHelouvry1994", "TUM"],
        experiment: "heave the body slowly",
        ..PLAIN
    },
    Effect {
        id: "15",
        element: Element::WHEEL_GUIDE,
        name: "viscous wheel guide",
        equation: "F = d_g v_u",
        parts: &[part("wheel_guide.damping", Scale::DAMPING, (0.0, 5.0), &[0.1])],
        literature: &["ArmstrongHelouvry1994"],
        experiment: "sweep the amplitude",
        ..PLAIN
    },
    Effect {
        id: "17",
        element: Element::WHEEL_GUIDE,
        name: "wheel-guide friction",
        equation: "F = F_g tanh(v_u/v_0)",
        prevalence: Prevalence::Expected,
        parts: &[
            part("wheel_guide.coulomb.force", Scale::FORCE, (0.0, 5.0), &[0.1]),
            part("wheel_guide.coulomb.velocity", Scale::VELOCITY, FRICTION_VELOCITY, &[0.02, 0.2]),
        ],
        literature: &["ArmstrongHelouvry1994", "TUM"],
        experiment: "compare excitation by the road and by the actuator",
        ..PLAIN
    },
];
