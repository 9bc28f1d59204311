//! A body and a wheel above a road: the rig of TUM, Quanser, Konieczny and Ajala.
//!
//! With every effect at its neutral value it is the linear quarter car of TUM eq. 2–9, Quanser eq. 2.7–2.11,
//! Konieczny eq. 2.14–2.15 (f_s being the actuator force) and Ajala eq. 27; with effects it is the gray-box
//! model of TUM 4.3–4.4. Which rig it is, is a matter of parameters.

use std::f64::consts::TAU;
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Kind, Model, Now, Real, Settings, Stimulus, Variables, bundles,
};

use crate::GRAVITY;
use crate::effects::Coulomb;
use crate::elements::{Strut, Tire};
use crate::signals::{Deflection, RoadMotion, Travel};

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
}

/// The guide that keeps the body upright on a rig.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Guide<R> {
    /// Friction
    pub coulomb: Coulomb<R>,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Road under the tyre
    pub road: RoadMotion<R>,
    /// Actuator between body and wheel
    pub actuator: Actuator<R>,
}

/// The actuator.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Actuator<R> {
    /// Force, positive if it pushes body and wheel apart (F, F_c, f_s, F_a)
    #[var(unit = N)]
    pub force: R,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Body
    pub body: Motion<R>,
    /// Wheel
    pub wheel: Motion<R>,
}

/// Of one mass.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Motion<R> {
    /// Height above static equilibrium
    #[var(unit = M, nominal = 0.01, output)]
    pub position: R,
    /// Velocity, positive upwards
    #[var(unit = M_PER_S, nominal = 0.1, output)]
    pub velocity: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body
    pub body: Acceleration<R>,
    /// Wheel
    pub wheel: WheelOutput<R>,
    /// Suspension
    pub suspension: Travel<R>,
    /// Tyre
    pub tire: Deflection<R>,
}

/// Of the body.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Acceleration<R> {
    /// Acceleration, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
}

/// Of the wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelOutput<R> {
    /// Acceleration, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Dynamic wheel load, positive if it presses on the road (F_dyn)
    #[var(unit = N)]
    pub force: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Body alone on the strut
    pub body: Mode<R>,
    /// Wheel alone
    pub wheel: Mode<R>,
    /// Tyre
    pub tire: TireDerived<R>,
}

/// A mass that moves alone, as TUM's Tables 7, 9 and 10 have it.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Mode<R> {
    /// Undamped natural frequency, uncoupled
    #[var(unit = HZ)]
    pub natural_frequency: R,
    /// Damping ratio, uncoupled
    #[var(unit = ONE)]
    pub damping_ratio: R,
}

/// Of the tyre.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct TireDerived<R> {
    /// Load at static equilibrium
    #[var(unit = N)]
    pub static_load: R,
    /// Deflection (wheel above road) at which the tyre's spring carries nothing
    #[var(unit = M)]
    pub lift_off_deflection: R,
}

impl Model for QuarterCar {
    const ABOUT: About = About {
        name: "QuarterCar",
        summary: "A body on a strut, a wheel on a tyre: linear quarter car or, with its effects on, \
            nonlinear test rig",
        kind: Kind::Rig,
        equations: &[
            Equation { text: "m_s a_s = -F_strut + F_act - F_guide", source: "TUM eq. 2; guide: 4.3.3" },
            Equation { text: "m_u a_u = F_strut - F_act + F_tire", source: "TUM eq. 3" },
            Equation {
                text: "F_strut = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v/v_0), x = z_s - \
                    z_u, v = x'",
                source: "TUM eq. 12, 14; asymmetry derived from Table 9",
            },
            Equation { text: "F_guide = F_g tanh(z_s'/v_0)", source: "TUM eq. 12" },
            Equation {
                text: "F_tire = k_t c + q c^2 + d_t c' + F_t tanh(c'/v_0), c = z_r - z_u",
                source: "TUM eq. 5, 4.3.2, Table 7",
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
        let mode = |frequency_rate: R, damping_rate: R, mass: R| Mode {
            natural_frequency: (frequency_rate / mass).sqrt() / TAU,
            damping_ratio: p.strut.damping / ((damping_rate * mass).sqrt() * 2.0),
        };
        let static_load = (p.sprung_mass + p.unsprung_mass) * GRAVITY;
        Derived {
            body: mode(p.strut.stiffness, p.strut.stiffness, p.sprung_mass),
            wheel: mode(p.tire.stiffness, p.strut.stiffness + p.tire.stiffness, p.unsprung_mass),
            tire: TireDerived { static_load, lift_off_deflection: -p.tire.lift_off(static_load).compression },
        }
    }

    fn check(&self, p: &Parameters<f64>, derived: &Derived<f64>) -> Result<(), String> {
        let (spring, load) = (p.tire.spring(), derived.tire.static_load);
        if !self.lift_off || spring.reaches(load) {
            return Ok(());
        }
        Err(format!(
            "the tyre would never leave the road: with tire.stiffness = {} N/m and tire.quadratic = {} N/m2 \
             its force never falls to the static load of {load} N below rest; lift-off needs tire.quadratic \
             < tire.stiffness^2 / (4 · load) = {} N/m2, or set tire.lift_off to false",
            p.tire.stiffness,
            p.tire.quadratic,
            p.tire.stiffness.powi(2) / (4.0 * load)
        ))
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Now<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, wheel }, p) = (*now.state, now.parameters);
        let (road, actuator) = (now.input.road, now.input.actuator.force);

        let (deflection, velocity) = (body.position - wheel.position, body.velocity - wheel.velocity);
        let strut = p.strut.force(deflection, velocity);
        let on_body = p.guide.coulomb.added_to(|| strut, body.velocity);
        let tire = self.tire_force(road.position - wheel.position, road.velocity - wheel.velocity, now);

        // Reciprocals, which do not wait for the forces as quotients would.
        let (per_sprung, per_unsprung) = (R::from(1.0) / p.sprung_mass, R::from(1.0) / p.unsprung_mass);
        let body_acceleration = (actuator - on_body) * per_sprung;
        let wheel_acceleration = (strut - actuator + tire) * per_unsprung;

        let rates = State {
            body: Motion { position: body.velocity, velocity: body_acceleration },
            wheel: Motion { position: wheel.velocity, velocity: wheel_acceleration },
        };
        let output = Output {
            body: Acceleration { acceleration: body_acceleration },
            wheel: WheelOutput { acceleration: wheel_acceleration, force: tire },
            suspension: Travel { deflection, velocity },
            tire: Deflection { deflection: wheel.position - road.position },
        };
        (rates, output)
    }
}

impl QuarterCar {
    #[inline]
    fn tire_force<R: Real>(&self, compression: R, velocity: R, now: Now<'_, Self, R>) -> R {
        let force = now.parameters.tire.force(compression, velocity);
        if !self.lift_off {
            return force;
        }
        let derived = now.derived.tire;
        let lift_off =
            crate::effects::LiftOff { load: derived.static_load, compression: -derived.lift_off_deflection };
        lift_off.applied(force, compression)
    }
}

#[cfg(test)]
mod tests;
