//! A strut or a tyre alone: one end clamped, the other one moved.

use std::borrow::Cow;
use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::{Clevis, ClevisState, switched_on};
use crate::elements::{Control, ControlState, Hysteresis, HysteresisState, Load, Strut, Tire};
use crate::signals::RoadMotion;

/// The setup with which TUM 4.3.1 and 4.3.2 measure one element: the upper end is clamped, the lower one is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementDyno {
    element: Element,
    controlled_by: ControlledBy,
    lift_off: bool,
}

/// What is clamped in.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Element {
    /// Spring and damper between body and wheel (TUM 4.3.1)
    Strut,
    /// Tyre (TUM 4.3.2)
    Tire,
}

/// What sets a damper.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum ControlledBy {
    /// Nothing
    Nothing,
    /// Current of its coil
    Current,
    /// Voltage at its coil
    Voltage,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What is clamped in
    #[set(start = Element::Strut)]
    element: Element,
    /// Strut: what sets its damper
    #[set(start = ControlledBy::Nothing)]
    controlled_by: ControlledBy,
    /// Tyre: it can leave the plate instead of pulling at it
    #[set(name = "tire.lift_off", start = true)]
    lift_off: bool,
}

/// What the elements are made of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Strut
    // On a bench, and beside another maker's model, a damper may be without a spring.
    #[var(min(stiffness = 0.0))]
    pub strut: Strut<R>,
    /// Tyre
    // Beside another maker's model, the spring is that model's.
    #[var(min(stiffness = 0.0))]
    pub tire: Tire<R>,
    /// Mass whose weight is on the tyre where its deflection is zero
    #[var(unit = KG, start = 390.0, min = 1e-3)]
    pub carried_mass: R,
    /// Memory of the strut
    pub hysteresis: Hysteresis<R>,
    /// What sets its damper
    pub control: Control<R>,
    /// What the strut is clamped in
    pub clevis: Clevis<R>,
}

/// What strut and clevis remember.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Memory of the strut
    pub hysteresis: HysteresisState<R>,
    /// What sets its damper
    pub control: ControlState<R>,
    /// What the strut is clamped in
    pub clevis: ClevisState<R>,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Tyre
    pub tire: Load<R>,
    /// Number of effects that are on beside asymmetry, Coulomb friction and quadratic rate
    #[var(unit = ONE)]
    pub active_effects: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Lower end
    pub motion: RoadMotion<R>,
    /// What sets the damper
    pub control: Coil<R>,
}

/// What drives a damper's coil.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Coil<R> {
    /// Current (controlled_by Current)
    #[var(unit = A)]
    pub current: R,
    /// Voltage (controlled_by Voltage)
    #[var(unit = V)]
    pub voltage: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Force that moves the lower end, less the static load; positive upwards, so that it compresses
    #[var(unit = N)]
    pub force: R,
    /// Deflection: upper above lower end
    #[var(unit = M)]
    pub deflection: R,
}

impl Model for ElementDyno {
    const ABOUT: About = About {
        name: "ElementDyno",
        summary: "Test bench for one strut or tyre: upper end clamped, lower end moved, force measured",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "x = -motion.position, v = -motion.velocity: upper less lower end",
                source: "TUM 4.3.1",
            },
            Equation {
                text: "strut: F = -(k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v/v_0) + F_p)",
                source: "TUM eq. 12, 14; asymmetry derived from Table 9; F_p: port of diagnosis",
            },
            Equation {
                text: "further effects of the strut and its memory: as in QuarterCar",
                source: "docs/effects.md: 02-14, 32, G",
            },
            Equation {
                text: "loose clevis: x - e and dz(e, g)/T for x and v of the strut, e' = v - dz(e, g)/T, T = 0.5 ms",
                source: "docs/effects.md: 12c",
            },
            Equation {
                text: "controlled: d + d_s m for d and F_y + F_s m for F_y, m = s/(1 + kappa s), T s' + s = |i|/i_r or |u|/u_r",
                source: "Spencer et al., J. Eng. Mech. 123 (1997); docs/effects.md: 32m to 32ns",
            },
            Equation {
                text: "tyre: F = k_t c + q c^2 + d_t c' + F_t tanh(c'/v_0) + s f(c) + F_0t, c = -x, F >= -F_0",
                source: "TUM eq. 5, 4.3.2, Table 7; curve: docs/effects.md: G; F_0t: port of diagnosis",
            },
        ],
        notes: &[
            "force is what must push the lower end up: positive in compression, for the tyre the same as wheel.force \
             of a rig.",
            "TUM 4.3.1 reads a friction of 94 N from a hysteresis measured at 2 mm/s. Its own friction law (eq. 12) with \
             its own k_f = 125 s/m is at tanh(0.25) there, 24 % of its force: 94 N would show as 23 N, the 115 N of \
             Table 10 as 28 N. For 99 % of it k_f must be 1320 s/m. k_f = 125 s/m is a value for the simulation of fast \
             motion; the set TumStrutDyno has a k_f of 10000 s/m and shows what was measured.",
            "TUM's characteristics are lost figures. The strut's two rates are those of Table 9, the tyre's those of \
             Table 7; counted from static equilibrium the tyre's rate is 149693 N/m there and 152186 N/m, as the text \
             has it, 0.316 mm further in.",
            "Effects beyond TUM's are off at their start values; active_effects counts the ones that are on. A tyre has \
             none of the strut's memory. A positive strut.preload pulls the ends together and shows as a negative force. \
             A positive tire.preload presses on the plate and shows as a positive force.",
            "A tyre that has left the plate comes back at the deflection at which its spring carries nothing.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[
                ("motion.position", Stimulus::Sine { amplitude: 0.02, frequency: 1.0 }),
                ("motion.velocity", Stimulus::Cosine { amplitude: 0.125_663_706_143_591_74, frequency: 1.0 }),
            ],
            plot: &["force", "deflection"],
            // The kinks of a loose clevis ask for it.
            tolerance: 1e-8,
        },
        ..About::DEFAULT
    };

    bundles! { settings: Options, parameters: Parameters, derived: Derived, input: Input, state: State, output: Output }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self {
            element: options.element,
            controlled_by: options.controlled_by,
            lift_off: options.lift_off,
        })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        Derived {
            tire: p.tire.load(p.carried_mass),
            active_effects: p.strut.active_effects()
                + p.tire.active_effects()
                + p.hysteresis.active_effects()
                + p.control.active_effects()
                + switched_on([p.clevis.gap]),
        }
    }

    fn check(&self, p: &Parameters<f64>, derived: &Derived<f64>) -> Result<(), String> {
        match self.element {
            Element::Tire if self.lift_off => p.tire.check_lift_off("tire", &derived.tire),
            Element::Tire => Ok(()),
            Element::Strut => p.hysteresis.check(p.strut.damping),
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (RoadMotion { position, velocity }, p) = (now.input.motion, now.parameters);
        let (deflection, further) = (-position, now.derived.active_effects);
        let (force, state) = match self.element {
            Element::Strut => {
                let ([left, speed], clevis) = p.clevis.behind(now.state.clevis, [deflection, -velocity]);
                let motion = [now.time, left, speed];
                let (strut, control) = match self.share(now.input.control, p) {
                    Some(share) => p.control.acting_on(&p.strut, now.state.control, share),
                    None => (Cow::Borrowed(&p.strut), Control::rest()),
                };
                let (force, hysteresis) =
                    strut.force_with_states(&p.hysteresis, &now.state.hysteresis, motion, further);
                (-force, State { hysteresis, control, clevis })
            }
            Element::Tire => {
                let force = p.tire.force(position, velocity, further);
                let held =
                    if self.lift_off { now.derived.tire.lift_off().applied(force, position) } else { force };
                let clevis = ClevisState { deflection: R::from(0.0) };
                (held, State { hysteresis: HysteresisState::rest(), control: Control::rest(), clevis })
            }
        };
        (state, Output { force, deflection })
    }
}

impl ElementDyno {
    /// The bench with a tyre that cannot leave the plate.
    pub fn of_a_tire() -> Self {
        Self { element: Element::Tire, controlled_by: ControlledBy::Nothing, lift_off: false }
    }

    /// Share of the rated current; none if nothing sets the damper.
    #[inline]
    fn share<R: Real>(&self, coil: Coil<R>, p: &Parameters<R>) -> Option<R> {
        match self.controlled_by {
            ControlledBy::Nothing => None,
            ControlledBy::Current => Some(coil.current / p.control.rated_current),
            ControlledBy::Voltage => Some(coil.voltage / p.control.rated_voltage),
        }
    }
}

#[cfg(test)]
mod tests;
