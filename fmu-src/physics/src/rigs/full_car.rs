//! A body on four struts and four wheels: the full car of Ajala's section 5.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::car::{Axles, Corners, Geometry, Modal, four};
use crate::elements::{AntiRollBar, Corner, Load, Mode, Moving, Strut, Tire};
use crate::signals::{Acceleration, Deflection, Motion, Pushing, RoadMotion, Travel, WheelMotion};

/// A car's vertical motion in seven degrees of freedom, Ajala Fig. 7: heave, roll and pitch of the body and four
/// wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullCar {
    lift_off: bool,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Tyres: they can leave the road instead of pulling at it
    #[set(name = "tire.lift_off", start = true)]
    lift_off: bool,
}

/// What the car is made of. The declared values are those of a mid-size car (assumed): at each corner what the
/// quarter car declares; radii of gyration of 0.60 m in roll and 1.28 m in pitch.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sprung mass, the body
    #[var(unit = KG, start = 1400.0, min = 1e-3)]
    pub sprung_mass: R,
    /// Moment of inertia of the body about its longitudinal axis
    #[var(unit = KG_M2, start = 500.0, min = 1e-3)]
    pub roll_inertia: R,
    /// Moment of inertia of the body about its lateral axis
    #[var(unit = KG_M2, start = 2300.0, min = 1e-3)]
    pub pitch_inertia: R,
    /// Unsprung mass, a wheel
    pub unsprung_mass: UnsprungMass<R>,
    /// Where the wheels are
    pub geometry: Geometry<R>,
    /// Strut
    pub strut: Corners<Strut<R>>,
    /// Anti-roll bars
    pub anti_roll_bar: Axles<AntiRollBar<R>>,
    /// Tyre
    pub tire: Corners<Tire<R>>,
}

/// Of one wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct UnsprungMass<R> {
    /// Of each front wheel
    #[var(unit = KG, start = 40.0, min = 1e-3)]
    pub front: R,
    /// Of each rear wheel
    #[var(unit = KG, start = 40.0, min = 1e-3)]
    pub rear: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Road under the tyre
    pub road: Corners<RoadMotion<R>>,
    /// Actuator between body and wheel
    pub actuator: Corners<Pushing<R>>,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Body's centre of mass
    pub heave: Motion<R>,
    /// Body, left side up
    pub roll: Rotation<R>,
    /// Body, rear up
    pub pitch: Rotation<R>,
    /// Wheel
    pub wheel: Corners<Motion<R>>,
}

/// Of the body about an axis.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Rotation<R> {
    /// Angle from static equilibrium
    #[var(unit = RAD, nominal = 0.01, output)]
    pub angle: R,
    /// Angular velocity
    #[var(unit = RAD_PER_S, nominal = 0.1, output)]
    pub speed: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body's centre of mass
    pub heave: Acceleration<R>,
    /// Body, left side up
    pub roll: AngularAcceleration<R>,
    /// Body, rear up
    pub pitch: AngularAcceleration<R>,
    /// Wheel
    pub wheel: Corners<WheelMotion<R>>,
    /// Suspension
    pub suspension: Corners<Travel<R>>,
    /// Tyre
    pub tire: Corners<Deflection<R>>,
}

/// Of the body about an axis.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AngularAcceleration<R> {
    /// Angular acceleration
    #[var(unit = RAD_PER_S2)]
    pub acceleration: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Body on its struts, rising
    pub heave: Mode<R>,
    /// Body on its struts and anti-roll bars, rolling
    pub roll: Mode<R>,
    /// Body on its struts, pitching
    pub pitch: Mode<R>,
    /// Wheel alone
    pub wheel: Corners<Mode<R>>,
    /// Pitch inertia over m l_f l_r; at one the ends of the car move like quarter cars that are not connected
    #[var(unit = ONE)]
    pub dynamic_index: R,
    /// Tyre
    pub tire: Corners<Load<R>>,
    /// Number of effects that are on beside asymmetry, Coulomb friction and quadratic rates
    #[var(unit = ONE)]
    pub active_effects: R,
}

impl Model for FullCar {
    const ABOUT: About = About {
        name: "FullCar",
        summary: "A car's vertical motion: heave, roll and pitch of the body and four wheels, linear or with the \
            effects of struts and tyres",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "m z_H'' = sum F_i, I_R phi_R'' = sum y_i F_i, I_P phi_P'' = -sum x_i F_i, F_i = F_act,i - \
                    F_strut,i",
                source: "Ajala Fig. 7",
            },
            Equation { text: "m_u z_u,i'' = F_strut,i - F_act,i + F_tire,i", source: "Ajala Fig. 7, eq. 27" },
            Equation { text: "z_i = z_H + y_i phi_R - x_i phi_P", source: "Ajala Fig. 7, small angles" },
            Equation {
                text: "x = l_f in front, -l_r at the rear; y = w_l on the left, -w_r on the right",
                source: "Ajala eq. 49",
            },
            Equation {
                text: "F_strut,i = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v/v_0) + F_p +- k_bar \
                    (x_left - x_right), x = z_i - z_u,i, v = x'",
                source: "TUM eq. 12, 14; anti-roll bar: linear torsion spring; F_p: port of diagnosis",
            },
            Equation {
                text: "F_tire,i = k_t c + q c^2 + d_t c' + F_t tanh(c'/v_0) + F_0t, c = z_r,i - z_u,i",
                source: "TUM eq. 5, 4.3.2, Table 7; F_0t: port of diagnosis",
            },
            Equation {
                text: "with lift-off: F_tire,i >= -F_0,i, and F_tire,i = -F_0,i for c <= c_l, F_0,fl = m g l_r \
                    w_r/((l_f + l_r)(w_l + w_r)) + m_u g, others alike",
                source: "the tyre cannot pull; heave column of Ajala eq. 49",
            },
        ],
        notes: &[
            "Positions and angles count from static equilibrium. Roll is positive if the left side rises, pitch if \
             the rear rises. A positive actuator force pushes body and wheel apart; a positive wheel force presses \
             on the road.",
            "Ajala draws the model (Fig. 7) and prints no equations of motion; they are those of a rigid body on the \
             quarter car of eq. 27 at each corner. The figure is lost; its letters are those of eq. 49.",
            "The vertical model has no roll or pitch axis: braking, cornering and the moment of the weight of a \
             body that has tilted are left out.",
            "Four supports of a rigid body leave open how static load is shared across the diagonals. It is shared \
             as eq. 49 shares a heave force, which for a car that is the same on the left and on the right is the \
             only way.",
            "Effects are neutral where they are not given: no anti-roll bars, no friction, symmetric dampers, linear \
             tyres. What strut and tyre have is the same as in QuarterCar, but for the \
             strut's memory.",
            "With a dynamic index of 1 and the same road and forces on the left and on the right, each end is the \
             quarter car of half the mass on its axle.",
            "The natural frequencies and damping ratios are uncoupled, by the formulas of TUM's tables: heave, roll \
             and pitch with the struts alone, on wheels that rest; the wheels with the body at rest.",
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            // As for QuarterCar: lift-off and landing ask for it.
            tolerance: 1e-8,
            stimuli: &[
                ("road.front_left.position", Stimulus::Step { at: 0.5, height: 0.01 }),
                ("road.rear_left.position", Stimulus::Step { at: 0.65, height: 0.01 }),
            ],
            plot: &[
                "heave.position",
                "roll.angle",
                "pitch.angle",
                "suspension.front_left.deflection",
                "wheel.rear_right.force",
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

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let Geometry { front, rear, left, right } = p.geometry;
        let zero = R::from(0.0);
        let (struts, tires) = (p.strut.each(), p.tire.each());
        // What a unit of each modal motion is met with: the forces that its deflections make, taken together.
        let modal = |rates: [R; 4], motion: Modal<R>| {
            let deflections = p.geometry.at_corners(motion);
            p.geometry.resultant(std::array::from_fn(|i| rates[i] * deflections[i]))
        };
        let (stiffnesses, dampings) =
            (struts.map(|strut| strut.stiffness), struts.map(|strut| strut.damping));
        let mode = |mass: R, motion: Modal<R>, of: fn(Modal<R>) -> R, bars: R| {
            let stiffness = of(modal(stiffnesses, motion)) + bars;
            Mode::of(mass, stiffness, stiffness, of(modal(dampings, motion)))
        };
        let rest = Modal { heave: zero, roll: zero, pitch: zero };
        let one = R::from(1.0);
        let bars =
            (p.anti_roll_bar.front.stiffness + p.anti_roll_bar.rear.stiffness) * (left + right).squared();
        let shares = p.geometry.distribution(Modal { heave: p.sprung_mass, ..rest });
        let wheels = p.unsprung_mass.at_corners();
        let wheel = |i: usize| {
            let (strut, tire) = (struts[i], tires[i]);
            Mode::of(wheels[i], tire.stiffness, strut.stiffness + tire.stiffness, strut.damping)
        };
        Derived {
            heave: mode(p.sprung_mass, Modal { heave: one, ..rest }, |sum| sum.heave, zero),
            roll: mode(p.roll_inertia, Modal { roll: one, ..rest }, |sum| sum.roll, bars),
            pitch: mode(p.pitch_inertia, Modal { pitch: one, ..rest }, |sum| sum.pitch, zero),
            wheel: std::array::from_fn(wheel).into(),
            dynamic_index: p.pitch_inertia / (p.sprung_mass * front * rear),
            tire: std::array::from_fn(|i| tires[i].load(shares[i] + wheels[i])).into(),
            active_effects: struts
                .iter()
                .map(|it| it.active_effects())
                .chain(tires.iter().map(|it| it.active_effects()))
                .fold(zero, |sum, it| sum + it),
        }
    }

    fn check(&self, p: &Parameters<f64>, derived: &Derived<f64>) -> Result<(), String> {
        if !self.lift_off {
            return Ok(());
        }
        let names = ["tire.front_left", "tire.front_right", "tire.rear_left", "tire.rear_right"];
        let loads = derived.tire.to_array();
        let mut tires = p.tire.each().into_iter().zip(names).zip(&loads);
        tires.try_for_each(|((tire, name), load)| tire.check_lift_off(name, load))
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, p) = (*now.state, now.parameters);
        let (heights, wheels) = (
            p.geometry.at_corners(Modal {
                heave: x.heave.position,
                roll: x.roll.angle,
                pitch: x.pitch.angle,
            }),
            x.wheel.each(),
        );
        let velocities = p.geometry.at_corners(Modal {
            heave: x.heave.velocity,
            roll: x.roll.speed,
            pitch: x.pitch.speed,
        });
        let pushing = {
            let Corners { front_left, front_right, rear_left, rear_right } = &now.input.actuator;
            let [fl, fr, rl, rr] = [front_left.force, front_right.force, rear_left.force, rear_right.force];
            let bars = &p.anti_roll_bar;
            let deflection = |i: usize| heights[i] - wheels[i].position;
            let deflections = |[left, right]: [usize; 2]| [deflection(left), deflection(right)];
            let [fl, fr] = bars.front.added_to([fl, fr], || deflections([0, 1]));
            let [rl, rr] = bars.rear.added_to([rl, rr], || deflections([2, 3]));
            [fl, fr, rl, rr]
        };
        let (roads, loads) = (now.input.road.each(), now.derived.tire.each());
        let (struts, masses, tires) = (p.strut.each(), p.unsprung_mass.at_corners(), p.tire.each());
        let further = now.derived.active_effects;
        let corners: [Moving<R>; 4] = four(|i| {
            let corner = Corner {
                unsprung_mass: masses[i],
                tire: tires[i],
                lift_off: if self.lift_off { Some(loads[i].lift_off()) } else { None },
                further,
            };
            let top = Motion { position: heights[i], velocity: velocities[i] };
            let strut = |deflection, velocity| struts[i].force(now.time, deflection, velocity, further);
            corner.between(top, *wheels[i], *roads[i], pushing[i], strut)
        });
        let sum = p.geometry.resultant(four(|i| pushing[i] - corners[i].strut_force));

        let one = R::from(1.0);
        let heave = Acceleration { acceleration: sum.heave * (one / p.sprung_mass) };
        let roll = AngularAcceleration { acceleration: sum.roll * (one / p.roll_inertia) };
        let pitch = AngularAcceleration { acceleration: sum.pitch * (one / p.pitch_inertia) };
        let turning = |rotation: Rotation<R>, by: AngularAcceleration<R>| Rotation {
            angle: rotation.speed,
            speed: by.acceleration,
        };
        let rates = State {
            heave: Motion { position: x.heave.velocity, velocity: heave.acceleration },
            roll: turning(x.roll, roll),
            pitch: turning(x.pitch, pitch),
            wheel: four(|i| Motion { position: wheels[i].velocity, velocity: corners[i].wheel.acceleration })
                .into(),
        };
        let output = Output {
            heave,
            roll,
            pitch,
            wheel: four(|i| corners[i].wheel).into(),
            suspension: four(|i| corners[i].suspension).into(),
            tire: four(|i| corners[i].tire).into(),
        };
        (rates, output)
    }
}

impl<R: Copy> UnsprungMass<R> {
    fn at_corners(&self) -> [R; 4] {
        [self.front, self.front, self.rear, self.rear]
    }
}

#[cfg(test)]
mod tests;
