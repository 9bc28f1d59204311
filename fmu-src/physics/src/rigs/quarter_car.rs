//! A body and a wheel above a road: the rig of TUM, Quanser, Konieczny and Ajala.
//!
//! With every effect at its neutral value it is the linear quarter car of TUM eq. 2–9, Quanser eq. 2.7–2.11,
//! Konieczny eq. 2.14–2.15 (f_s being the actuator force) and Ajala eq. 27; with effects it is the gray-box
//! model of TUM 4.3–4.4. Which rig it is, is a matter of parameters.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::{Enveloping, EnvelopingState, FrameMode, FrameState, behind_backlash, switched_on};
use crate::elements::{
    Actuation, ActuationState, Corner, Guide, Hysteresis, HysteresisState, Load, Mode, Strut, Tire,
    WheelGuide,
};
use crate::signals::{Acceleration, Deflection, Motion, Pushing, RoadMotion, Travel, WheelMotion};

/// A quarter of a car, or a test rig of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuarterCar {
    lift_off: bool,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Tyre: it can leave the road instead of pulling at it
    #[set(name = "tire.lift_off", start = true)]
    lift_off: bool,
}

/// What the rig is made of. The declared values are those of a mid-size car's corner (assumed: body 1.2 Hz,
/// damping ratio 0.27, wheel 11 Hz, as textbooks give them); published rigs are parameter sets.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sprung mass, the body (m_c, M_s, m_2, m_a)
    #[var(unit = KG, start = 350.0, min = 1e-3)]
    pub sprung_mass: R,
    /// Unsprung mass, the wheel (m_w, M_us, m_1, m_r)
    #[var(unit = KG, start = 40.0, min = 1e-3)]
    pub unsprung_mass: R,
    /// Strut
    pub strut: Strut<R>,
    /// Vertical guide of the body
    pub guide: Guide<R>,
    /// Tyre
    pub tire: Tire<R>,
    /// Vertical guide of the wheel
    pub wheel_guide: WheelGuide<R>,
    /// Memory of the strut
    pub hysteresis: Hysteresis<R>,
    /// From the actuator's command to its force
    pub actuator: Actuation<R>,
    /// Frame that swings with the body
    pub frame: FrameMode<R>,
    /// Tyre on short bumps
    pub enveloping: Enveloping<R>,
    /// Cell that measures the wheel's force
    pub force_cell: ForceCell<R>,
}

/// What a force cell in a wheel does not show: what is outside of it has to be accelerated, too, and friction in it holds its
/// reading where it was (docs/effects.md, 41).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ForceCell<R> {
    /// Part of the unsprung mass between tyre and cell; zero: the cell measures the tyre's force
    #[var(unit = KG, start = 0.0, min = 0.0)]
    pub mass: R,
    /// Half the backlash with which the reading follows the force, half the width of the cell's hysteresis
    #[var(unit = N, start = 0.0, min = 0.0)]
    pub hysteresis: R,
}

/// What a force cell remembers.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ForceCellState<R> {
    /// What the reading has followed to, a band's edge or anywhere within the band
    #[var(unit = N, nominal = 100.0)]
    pub follower: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Road under the tyre
    pub road: RoadMotion<R>,
    /// Actuator between body and wheel
    pub actuator: Pushing<R>,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Body
    pub body: Motion<R>,
    /// Wheel
    pub wheel: Motion<R>,
    /// Memory of the strut
    pub hysteresis: HysteresisState<R>,
    /// On the way from the actuator's command to its force
    pub actuator: ActuationState<R>,
    /// Frame that swings with the body
    pub frame: FrameState<R>,
    /// What the tyre sees of the road
    pub enveloping: EnvelopingState<R>,
    /// Cell that measures the wheel's force
    pub force_cell: ForceCellState<R>,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body
    pub body: Acceleration<R>,
    /// Wheel
    pub wheel: WheelMotion<R>,
    /// Suspension
    pub suspension: Travel<R>,
    /// Tyre
    pub tire: Deflection<R>,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Body alone on the strut
    pub body: Mode<R>,
    /// Wheel alone
    pub wheel: Mode<R>,
    /// Tyre
    pub tire: Load<R>,
    /// Number of effects that are on beside asymmetry, quadratic rate, and Coulomb friction of strut, guide and tyre
    #[var(unit = ONE)]
    pub active_effects: R,
}

impl Model for QuarterCar {
    const ABOUT: About = About {
        name: "QuarterCar",
        summary: "A body on a strut, a wheel on a tyre: linear quarter car or, with its effects on, \
            nonlinear test rig",
        kind: Kind::Rig,
        equations: &[
            Equation { text: "m_s a_s = -F_strut + F_act - F_guide", source: "TUM eq. 2; guide: 4.3.3" },
            Equation { text: "m_u a_u = F_strut - F_act + F_tire - F_wheel_guide", source: "TUM eq. 3" },
            Equation {
                text: "F_strut = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v/v_0), x = z_s - \
                    z_u, v = x'",
                source: "TUM eq. 12, 14; asymmetry derived from Table 9",
            },
            Equation {
                text: "further effects of the strut: + k_2 x^2 + k_3 x^3 + k_b (<x - x_r> - <-x - x_c>) + c v |v| + F_b \
                    exp(-(v/v_b)^2) tanh(v/v_0) + F_y tanh(v/v_y + b x) + F_p + s (f_1(x) + f_2(v) + f_3(x) v); F_c becomes F_c \
                    <1 + beta x>, d becomes d (1 - a (1 - exp(-t/T))), v in the damper becomes v + rho dz(v, v_k); < > \
                    = max( , 0), dz a dead zone",
                source: "docs/effects.md: 08, 09, 06, 02, 32, offset, G; 11, 10, 05",
            },
            Equation {
                text: "linkage: F_strut = i F(x + i_1 x^2/2, i v), i = 1 + i_1 x",
                source: "docs/effects.md: 14; power is kept",
            },
            Equation {
                text: "presliding friction: + f, f = dz(y, sigma b), y' = sigma v g(1 - sgn(v) f/F), g(u) = |u|^n sgn(u)",
                source: "Dahl 1968; docs/effects.md: 03",
            },
            Equation { text: "Maxwell branch: + k_1 xi, xi' = v - xi/tau", source: "docs/effects.md: 07" },
            Equation {
                text: "mount: the damper's force is dz(e, g)/c, e' = v - u, u the velocity of the damper with that \
                    force",
                source: "docs/effects.md: 12, 13",
            },
            Equation {
                text: "F_guide = F_g tanh(z_s'/v_0) + d_g z_s' + s f(z_s') + F_0g, F_wheel_guide = F_w tanh(z_u'/v_0) + d_w \
                    z_u' + F_0w",
                source: "TUM eq. 12; damping, curve and wheel: docs/effects.md: 15-17, G; F_0g, F_0w: ports of diagnosis",
            },
            Equation {
                text: "F_tire = k_t c + q c^2 + d_t c' + F_t tanh(c'/v_0) + s f(c) + F_0t, c = z_r - z_u",
                source: "TUM eq. 5, 4.3.2, Table 7; curve: docs/effects.md: G; F_0t: port of diagnosis",
            },
            Equation {
                text: "F_act = R(S(k T(D(u))) + s f(k T(D(u)))): delay D (1 - t s/2 + t^2 s^2/12)/(1 + t s/2 + t^2 \
                    s^2/12), lag T' y' + y = u, limit S(F) = F - r dz(F, F_m), slew limit R(F) = y + T y', T y' = clamp(F - y, \
                    -T/c, T/c), T = 0.5 ms, slowness c",
                source: "docs/effects.md: 23-26, G",
            },
            Equation {
                text: "frame: + m_f (w^2 y + 2 z w y') on the body, y'' + 2 z w y' + w^2 y = -a_s, w = 2 pi f",
                source: "docs/effects.md: 18",
            },
            Equation {
                text: "enveloping: the tyre sees T_e z' = z_r - z instead of z_r",
                source: "docs/effects.md: 22",
            },
            Equation {
                text: "force cell: wheel.force = F - clamp(F - y, -h, h), T y' = dz(F - y, h), T = 0.5 ms, F = F_tire - m_c a_u",
                source: "docs/effects.md: 41",
            },
            Equation {
                text: "with lift-off: F_tire >= -F_0, and F_tire = -F_0 for c <= c_l, F_0 = (m_s + m_u) g",
                source: "the tyre cannot pull",
            },
        ],
        notes: &[
            "Positions count upwards from static equilibrium. A positive actuator force pushes body and \
             wheel apart; a positive wheel force presses on the road.",
            "TUM eq. 12 prints Δv1 = ẋ_c for F_f,1 and Δv2 = ẋ_c − ẋ_w for F_f,2. Its text and tables make \
             F_f,1 (115 N) the strut's friction and F_f,2 (20 N) that of the guides, so the velocities are \
             exchanged here.",
            "TUM eq. 9 prints 1 as the last entry of E; with eq. 3 it is d_w/m_w, which is what this model \
             has.",
            "TUM's damper characteristic is a lost figure: two rates joined smoothly stand for it.",
            "The uncoupled natural frequencies and damping ratios are sqrt(k/m_s), d/(2 sqrt(k m_s)), \
             sqrt(k_t/m_u) and d/(2 sqrt((k + k_t) m_u)), which reproduce TUM's Tables 9 and 10.",
            "TUM's tyre polynomial (149693 N/m, 3.94e6 N/m2) and its linearised rate of 152186 N/m agree \
             only if it is taken about static equilibrium (the rate is met 0.3 mm off it), so the \
             compression counts from there.",
            "TUM's tables contradict themselves: Table 9, measured, prints 758 N.s/m but damping ratios of \
             769 N.s/m, and 1.51 Hz where spring and mass make 1.528 Hz; Table 7, optimised, includes the \
             strut spring in the wheel frequency 12.92 Hz, unlike the others (12.57 Hz), and its wheel \
             ratio 0.212 does not fit its chassis ratio 0.47 (0.222). Table 10 prints c_c = i^-2 times the \
             spring rate where eq. 13 has i^2.",
            "Effects are off at their start values. Those beyond TUM's are what a difference between measurement and \
             model is looked for in; active_effects counts the ones that are on.",
            "The unnamed forces f are straight lines between eleven equally spaced points and held beyond them; that of \
             the tyre is over the compression, road above wheel.",
            "Asymmetry, knee and fade are the damper's and go through its mount; orifice, frictions and all else act \
             beside it. Play without compliance stands on a compliance of 1e-6 m/N. For n other than 1, g is rounded \
             within 1 % of the limit: u ((u^2 + 1e-4)/(1 + 1e-4))^((n - 1)/2).",
            "A stiff Maxwell branch, a mount much stiffer than 1e6 N/m or steep presliding friction make the equations \
             stiff: solver.method = Rosenbrock is then the faster one.",
            "Static equilibrium is that without preloads and unnamed forces.",
            "At lift-off the tyre's damping ends and at landing it begins at once, as in any point contact.",
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            // The loosest at which all reference solutions are met within 1e-6, lift-off and landing included;
            // without these 1e-6 would do.
            tolerance: 1e-8,
            stimuli: &[("road.position", Stimulus::Step { at: 0.5, height: 0.01 })],
            plot: &[
                "body.position",
                "wheel.position",
                "body.acceleration",
                "suspension.deflection",
                "wheel.force",
            ],
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Input,
        state: State,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { lift_off: options.lift_off })
    }

    /// Uncoupled modes by the formulas behind TUM's Tables 9 and 10.
    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let (strut, tire) = (p.strut, p.tire);
        let both = strut.stiffness + tire.stiffness;
        Derived {
            body: Mode::of(p.sprung_mass, strut.stiffness, strut.stiffness, strut.damping),
            wheel: Mode::of(p.unsprung_mass, tire.stiffness, both, strut.damping),
            tire: tire.load(p.sprung_mass + p.unsprung_mass),
            active_effects: strut.active_effects()
                + p.guide.active_effects()
                + tire.active_effects()
                + p.wheel_guide.active_effects()
                + p.hysteresis.active_effects()
                + p.actuator.active_effects()
                + switched_on([p.frame.mass, p.enveloping.time, p.force_cell.mass, p.force_cell.hysteresis]),
        }
    }

    fn check(&self, p: &Parameters<f64>, derived: &Derived<f64>) -> Result<(), String> {
        p.hysteresis.check(p.strut.damping)?;
        if self.lift_off { p.tire.check_lift_off("tire", &derived.tire) } else { Ok(()) }
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, wheel, hysteresis, .. }, p) = (*now.state, now.parameters);
        let further = now.derived.active_effects;
        let (actuator, on_its_way) = p.actuator.force(now.state.actuator, now.input.actuator.force, further);
        let (road, enveloping) = p.enveloping.seen(now.state.enveloping, now.input.road);
        let corner = Corner {
            unsprung_mass: p.unsprung_mass,
            tire: &p.tire,
            lift_off: if self.lift_off { Some(now.derived.tire.lift_off()) } else { None },
            further,
        };
        let mut memory = HysteresisState::rest();
        let mut moving = corner.between(body, wheel, road, actuator, |deflection, velocity| {
            let motion = [now.time, deflection, velocity];
            let (force, rates) = p.strut.force_with_states(&p.hysteresis, &hysteresis, motion, further);
            memory = rates;
            force
        });
        let on_body = p.guide.added_to(|| moving.strut_force, body.velocity, further);
        // The reciprocal does not wait for the force as the quotient would.
        let mut acceleration = (actuator - on_body) * (R::from(1.0) / p.sprung_mass);
        let mut frame = FrameMode::rest();
        let mut follower = R::from(0.0);
        if !further.vanishes() {
            moving.wheel.acceleration -= p.wheel_guide.resistance(wheel.velocity) / p.unsprung_mass;
            let pressing = moving.wheel.force - p.force_cell.mass * moving.wheel.acceleration;
            (moving.wheel.force, follower) =
                behind_backlash(p.force_cell.hysteresis, now.state.force_cell.follower, pressing);
            if !p.frame.mass.vanishes() {
                let pull = p.frame.pull(now.state.frame);
                acceleration += p.frame.mass * pull / p.sprung_mass;
                frame = p.frame.rates(now.state.frame, pull, acceleration);
            }
        }

        let rates = State {
            body: Motion { position: body.velocity, velocity: acceleration },
            wheel: Motion { position: wheel.velocity, velocity: moving.wheel.acceleration },
            hysteresis: memory,
            actuator: on_its_way,
            frame,
            enveloping,
            force_cell: ForceCellState { follower },
        };
        let output = Output {
            body: Acceleration { acceleration },
            wheel: moving.wheel,
            suspension: moving.suspension,
            tire: moving.tire,
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
