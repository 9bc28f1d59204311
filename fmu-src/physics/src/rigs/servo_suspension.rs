//! The rig of AGH Kraków with its electrohydraulic actuator: body, wheel, cylinder and valve in one.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Method, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::actuators::servo_hydraulic_actuator::{self as servo, SpoolState, SupplyOutput};
use crate::effects::switched_on;
use crate::elements::{Guide, Hydraulics, Mode, ServoCylinder, Strut, Tire, ValveLaw};
use crate::signals::{Acceleration, Deflection, Motion, Pushing, RoadMotion, Travel};

/// A quarter of a car with a servohydraulic actuator, Konieczny 2.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoSuspension {
    law: ValveLaw,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// Law of the flow through the valve
    #[set(name = "actuator.law", start = ValveLaw::Nonlinear)]
    law: ValveLaw,
}

/// What the suspension is made of. The declared masses and springs are those of the quarter car, the declared
/// actuator is Konieczny's.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Sprung mass, the body (m_2)
    #[var(unit = KG, start = 350.0, min = 1e-3)]
    pub sprung_mass: R,
    /// Unsprung mass, the wheel (m_1)
    #[var(unit = KG, start = 40.0, min = 1e-3)]
    pub unsprung_mass: R,
    /// Strut beside the actuator
    pub strut: Strut<R>,
    /// Vertical guide of the body
    pub guide: Guide<R>,
    /// Tyre
    pub tire: Tire<R>,
    /// Vertical guide of the wheel
    pub wheel_guide: WheelPreload<R>,
    /// Actuator
    pub actuator: ServoCylinder<R>,
}

/// What acts between wheel and ground beside the tyre.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelPreload<R> {
    /// Constant force between wheel and ground, opposing upward motion
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Control voltage of the valve (v)
    #[var(unit = V)]
    pub voltage: R,
    /// Road under the tyre
    pub road: RoadMotion<R>,
}

/// The motion, and what goes on in the actuator.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Body
    pub body: Motion<R>,
    /// Wheel
    pub wheel: WheelState<R>,
    /// Pressure difference of the chambers, positive if it drives body and wheel apart (P_r)
    #[var(unit = PA, nominal = 1e6, output)]
    pub pressure: R,
    /// Spool
    pub spool: SpoolState<R>,
}

/// The wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelState<R> {
    /// Height above static equilibrium (z_1)
    #[var(unit = M, nominal = 0.01, output)]
    pub position: R,
    /// Velocity less what the tyre's damper has made of it: z_1' + b_1 (z_1 − w)/m_1
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub undamped_velocity: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body
    pub body: Acceleration<R>,
    /// Wheel
    pub wheel: Wheel<R>,
    /// Suspension
    pub suspension: Travel<R>,
    /// Tyre
    pub tire: Deflection<R>,
    /// Actuator
    pub actuator: Pushing<R>,
    /// Supply
    pub supply: SupplyOutput<R>,
}

/// Of the wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Wheel<R> {
    /// Velocity, positive upwards
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Acceleration, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Dynamic wheel load, positive if it presses on the road
    #[var(unit = N)]
    pub force: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Actuator
    pub actuator: Hydraulics<R>,
    /// Body and wheel against each other on the compressed oil
    pub hydraulic_mode: Mode<R>,
    /// Number of effects that are on beside asymmetry, Coulomb friction and quadratic rates
    #[var(unit = ONE)]
    pub active_effects: R,
}

impl Model for ServoSuspension {
    const ABOUT: About = About {
        name: "ServoSuspension",
        summary: "Body and wheel with a servohydraulic actuator between them: rig, cylinder and valve in one",
        kind: Kind::Rig,
        equations: &[
            Equation { text: "m_2 z_2'' = f_s - F_strut - F_guide", source: "Konieczny eq. 2.15" },
            Equation {
                text: "m_1 q' = F_strut - f_s + k_1 (w - z_1) + F_0t - F_0w, z_1' = q - b_1 (z_1 - w)/m_1",
                source: "Konieczny eq. 2.14, the tyre's damper integrated as in eq. 2.16; F_0t, F_0w: ports of diagnosis",
            },
            Equation {
                text: "F_strut = k_2 (z_2 - z_1) + b_2 (z_2' - z_1') + F_p, F_guide = F_g tanh(z_2'/v_0) + F_0g",
                source: "Konieczny eq. 2.14-2.15; effects as in QuarterCar; F_p, F_0g: ports of diagnosis",
            },
            servo::EQUATIONS[0],
            servo::EQUATIONS[1],
            servo::EQUATIONS[2],
            servo::EQUATIONS[3],
            servo::EQUATIONS[4],
            servo::EQUATIONS[5],
            servo::EQUATIONS[6],
            servo::EQUATIONS[7],
        ],
        notes: &[
            "The state holds the wheel's velocity without what the tyre's damper has done, q = z_1' + b_1 \
             (z_1 - w)/m_1, as x_4 of eq. 2.16 holds that of the suspension. So the motion follows from the \
             road's position alone: where it jumps by h, the wheel's velocity jumps by b_1 h/m_1, exactly. \
             The road's velocity is needed for wheel.force and wheel.acceleration (its share b_1 w'), and for \
             a friction in the tyre if there is one; where the road stands still or jumps, leave it at zero.",
            "Eq. 2.17 follows from eq. 2.14, 2.15 and 2.11 term by term (checked entry by entry against this \
             model, x_3 = z_2 - z_1 and x_4 = z_2' - q + (b_2/m_1 + b_2/m_2) x_3). As printed, row 6 of A has \
             five entries: a zero is missing before -1/tau.",
            "With Konieczny's values, linearised, the eigenvalues are -393 +- 1581i (the oil's spring between \
             body and wheel: 259 Hz, damped 252 Hz, damping ratio 0.24), -0.73 +- 19.5i (both masses on the \
             tyre: 3.1 Hz, 0.037), -431 (the spool) and -0.21. With a closed valve the actuator nearly locks \
             the suspension: it damps like A_a^2/C_tm = 39 kN.s/m, 34 times the damper. The identified model \
             (3.48 Hz, 0.34) is far better damped: a leakage thirty times as large would do that.",
            "Konieczny asks for modes near 1.5 Hz and 11 Hz; the predicted springs k_2 = 8000 N/m and k_1 = \
             44800 N/m give 1.54 and 10.8 Hz (sqrt(k_2/m_2), sqrt((k_1 + k_2)/m_1)), the used ones 1.60 and \
             10.1 Hz.",
            "The tyre of this model never leaves the road.",
            "actuator.cylinder.preload is part of actuator.force, strut.preload is not. Where that force is not measured, \
             both are the same.",
            servo::NOTES[0],
            servo::NOTES[1],
            servo::NOTES[2],
            servo::NOTES[3],
            servo::NOTES[4],
            servo::NOTES[5],
            servo::NOTES[6],
            servo::NOTES[7],
            servo::NOTES[8],
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            stimuli: &[
                ("road.position", Stimulus::Step { at: 0.5, height: 0.01 }),
                ("voltage", Stimulus::Step { at: 2.0, height: 0.5 }),
            ],
            plot: &["body.position", "wheel.position", "body.acceleration", "pressure", "supply.power"],
            // A tenth of it is needed for the kinks at the spool's middle: the linear law would do with 1e-6.
            tolerance: 1e-7,
        },
        // In two thirds of the time that Rosenbrock takes for the same error in steps of 1 ms: what is fast here swings,
        // and has to be followed anyway.
        method: Method::Explicit,
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
        Ok(Self { law: options.law })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let actuator = p.actuator.hydraulics();
        // Both masses between oil spring, damper and leakage; strut and tyre springs are soft beside the oil.
        let mobility = R::from(1.0) / p.sprung_mass + R::from(1.0) / p.unsprung_mass;
        let natural = (actuator.stiffness * mobility).sqrt();
        let decay = actuator.coefficient * p.actuator.cylinder.leakage + p.strut.damping * mobility;
        Derived {
            actuator,
            hydraulic_mode: Mode {
                natural_frequency: natural / std::f64::consts::TAU,
                damping_ratio: decay / (natural * 2.0),
            },
            active_effects: p.strut.active_effects()
                + p.guide.active_effects()
                + p.tire.active_effects()
                + switched_on([p.wheel_guide.preload]),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.actuator.check("actuator.")
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, wheel, pressure, spool }, p) = (*now.state, now.parameters);
        let (road, hydraulics) = (now.input.road, &now.derived.actuator);
        let (per_sprung, per_unsprung) = (R::from(1.0) / p.sprung_mass, R::from(1.0) / p.unsprung_mass);

        let compression = road.position - wheel.position;
        let wheel_velocity = wheel.undamped_velocity + p.tire.damping * per_unsprung * compression;
        let deflection = body.position - wheel.position;
        let velocity = body.velocity - wheel_velocity;
        let further = now.derived.active_effects;
        let strut = p.strut.force(now.time, deflection, velocity, further);
        let on_body = p.guide.added_to(|| strut, body.velocity, further);
        let approach = road.velocity - wheel_velocity;
        let undamped = p.tire.without_damping().force(compression, approach, further);
        let tire = undamped + p.tire.damping * approach;
        let force = p.actuator.force(pressure);
        let (opening, follower) = p.actuator.followed(spool.position, spool.follower);
        let flow = p.actuator.flow(self.law, hydraulics, opening, pressure);

        let body_acceleration = (force - on_body) * per_sprung;
        let between = strut - force;
        let on_wheel = if further.vanishes() { between } else { between - p.wheel_guide.preload };
        let rates = State {
            body: Motion { position: body.velocity, velocity: body_acceleration },
            wheel: WheelState {
                position: wheel_velocity,
                undamped_velocity: (on_wheel + undamped) * per_unsprung,
            },
            pressure: p.actuator.pressure_rate(hydraulics, flow.load, velocity, pressure),
            spool: SpoolState {
                position: p.actuator.spool_rate(now.input.voltage, spool.position),
                follower,
            },
        };
        let output = Output {
            body: Acceleration { acceleration: body_acceleration },
            wheel: Wheel {
                velocity: wheel_velocity,
                acceleration: (on_wheel + tire) * per_unsprung,
                force: tire,
            },
            suspension: Travel { deflection, velocity },
            tire: Deflection { deflection: -compression },
            actuator: Pushing { force },
            supply: SupplyOutput { flow: flow.supply, power: p.actuator.supply.pressure * flow.supply },
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
