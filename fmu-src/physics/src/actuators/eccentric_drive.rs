//! The eccentric that shakes the wheel of the semi-active rig, with its motor.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::{Pwm, PwmOptions, RotaryCoulomb};

/// Direct-current motor, gear and eccentric of Kogut 2.1, eq. 15.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EccentricDrive {
    pwm: Pwm,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    pwm: PwmOptions,
}

/// What the drive is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Motor
    pub motor: Motor<R>,
    /// Gear
    pub gear: Gear<R>,
    /// Eccentric
    pub eccentric: Eccentric<R>,
}

/// The motor, a flat one without iron in its rotor: it has no inductance to speak of.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Motor<R> {
    /// Voltage of the supply, at the motor with a duty cycle of one
    #[var(unit = V, start = 24.0, min = 1e-3)]
    pub supply_voltage: R,
    /// Resistance of rotor, brushes and output stage
    #[var(unit = OHM, start = 1.0, min = 1e-6)]
    pub resistance: R,
    /// Torque of one ampere, and voltage of one radian per second
    #[var(unit = N_M_PER_A, start = 0.07, min = 1e-6)]
    pub torque_constant: R,
    /// Moment of inertia of the rotor
    #[var(unit = KG_M2, start = 1.5e-4, min = 1e-9)]
    pub inertia: R,
}

/// The gear between motor and eccentric.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Gear<R> {
    /// Turns of the motor for one of the eccentric
    #[var(unit = ONE, start = 6.0, min = 1e-3)]
    pub ratio: R,
}

/// The small wheel that turns beside its centre.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Eccentric<R> {
    /// Height of its top above its axis, on the mean of a turn (eq. 15)
    #[var(unit = M, start = 0.0425, min = 1e-6)]
    pub mean_height: R,
    /// Distance of its centre from its axis (eq. 15)
    #[var(unit = M, start = 0.0025, min = 0.0)]
    pub eccentricity: R,
    /// Moment of inertia about its axis
    #[var(unit = KG_M2, start = 2.2e-4, min = 0.0)]
    pub inertia: R,
    /// Friction of bearings, gear and brushes, at the eccentric
    pub coulomb: RotaryCoulomb<R>,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Duty cycle of the motor's voltage, held between -1 and 1
    #[var(unit = ONE)]
    pub duty: R,
    /// Tyre on the eccentric
    pub tire: Load<R>,
}

/// What presses on the eccentric.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Force, positive if it presses
    #[var(unit = N)]
    pub force: R,
}

/// The motion.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Angle of the eccentric from its lowest position; it grows from turn to turn (alpha_0)
    #[var(unit = RAD, nominal = 1.0, output)]
    pub angle: R,
    /// Speed of the eccentric
    #[var(unit = RAD_PER_S, nominal = 10.0, output)]
    pub speed: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Height of the eccentric's top above its axis (u_1)
    #[var(unit = M)]
    pub height: R,
    /// Rate of change of the height
    #[var(unit = M_PER_S)]
    pub velocity: R,
    /// Load
    pub load: Torque<R>,
    /// Current of the motor
    #[var(unit = A)]
    pub current: R,
    /// Supply
    pub supply: Power<R>,
}

/// What the tyre has against a turn.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Torque<R> {
    /// Torque of the tyre on the eccentric, positive if it resists a positive speed
    #[var(unit = N_M)]
    pub torque: R,
}

/// What the motor takes.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Power<R> {
    /// Electrical power, negative where the motor brakes
    #[var(unit = W)]
    pub power: R,
}

/// What follows from the parameters, seen at the eccentric.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Speed with the whole voltage and without load or friction
    #[var(unit = RAD_PER_S)]
    pub no_load_speed: R,
    /// Torque with the whole voltage at standstill
    #[var(unit = N_M)]
    pub stall_torque: R,
    /// Moment of inertia
    #[var(unit = KG_M2)]
    pub inertia: R,
    /// Time constant of the speed
    #[var(unit = S)]
    pub time_constant: R,
}

impl Model for EccentricDrive {
    const ABOUT: About = About {
        name: "EccentricDrive",
        summary: "Eccentric under a wheel with its direct-current motor and gear: duty cycle in, height and velocity \
            out, loaded by the tyre",
        kind: Kind::Actuator,
        equations: &[
            Equation { text: "u_1 = h - e cos(a_0), u_1' = e sin(a_0) a_0'", source: "Kogut eq. 15" },
            Equation { text: "T_load = F_tire e sin(a_0)", source: "virtual work with eq. 15" },
            Equation {
                text: "i = (U duty - k n a_0')/R",
                source: "Kogut 2.1: direct-current motor with gear, PWM; law assumed",
            },
            Equation {
                text: "(n^2 J_m + J_e) a_0'' = n k i - T_load - T_f tanh(a_0'/w_0)",
                source: "balance of torques; friction: TUM eq. 12",
            },
            Equation {
                text: "duty: -1 to 1, in 2^bits - 1 steps to either side",
                source: "Kogut 2.1: 8 bits",
            },
        ],
        notes: &[
            "Kogut gives the eccentric but nothing of its motor. All values of motor, gear and friction are assumed: a \
             flat motor for 24 V at 3300 revolutions a minute, geared so that 6.5 Hz (Fig. 14) are within reach of a \
             no-load speed of 9.1 Hz. Flat motors have no iron in the rotor; with some 0.1 mH their current follows \
             within 0.1 ms, so that no inductance is modelled.",
            "The load at rest, 261 N on 2.5 mm, is 0.65 N.m to either side within each turn. Without a controller it \
             takes the frequency from 0.8 to 2.1 Hz within a turn at the duty cycle of 1.4 Hz: the \"huge impact\" \
             of 2.1.",
            "What the tyre gives back while it pushes the eccentric down is counted: the torque is the force times \
             du_1/da_0 in either direction.",
            "Eq. 15 is an approximation, as the source says: the wheel does not touch the eccentric at its top only.",
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            tolerance: 1e-7,
            stimuli: &[
                ("duty", Stimulus::Step { at: 0.0, height: 0.2 }),
                ("tire.force", Stimulus::Step { at: 0.0, height: 261.0 }),
            ],
            plot: &["height", "speed", "load.torque", "current"],
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
        Ok(Self { pwm: Pwm::new(&options.pwm)? })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let constant = p.motor.torque_constant * p.gear.ratio;
        let inertia = p.gear.ratio.squared() * p.motor.inertia + p.eccentric.inertia;
        Derived {
            no_load_speed: p.motor.supply_voltage / constant,
            stall_torque: constant * p.motor.supply_voltage / p.motor.resistance,
            inertia,
            time_constant: inertia * p.motor.resistance / constant.squared(),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        let Eccentric { mean_height, eccentricity, .. } = p.eccentric;
        if eccentricity < mean_height {
            return Ok(());
        }
        Err(format!(
            "eccentric.eccentricity = {eccentricity} m must be smaller than eccentric.mean_height = {mean_height} m: \
             the axis lies within the wheel"
        ))
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p) = (now.state, now.input, now.parameters);
        let constant = p.motor.torque_constant * p.gear.ratio;
        let voltage = p.motor.supply_voltage * self.pwm.made(u.duty, -1.0);
        let current = (voltage - constant * x.speed) / p.motor.resistance;

        let slope = p.eccentric.eccentricity * x.angle.sin();
        let load = u.tire.force * slope;
        let against = p.eccentric.coulomb.added_to(|| load, x.speed);
        let acceleration = (constant * current - against) / now.derived.inertia;

        let output = Output {
            height: p.eccentric.mean_height - p.eccentric.eccentricity * x.angle.cos(),
            velocity: slope * x.speed,
            load: Torque { torque: load },
            current,
            supply: Power { power: voltage * current },
        };
        (State { angle: x.speed, speed: acceleration }, output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};
    use strut_model::{Bundle, Declarations, NoVariables};

    fn parameters() -> Parameters<f64> {
        let declared = Declarations::of::<Parameters<f64>>();
        let mut p: Parameters<f64> = Bundle::from_fn(|i| declared[i].start);
        p.eccentric.coulomb.torque = 0.1;
        p
    }

    const DRIVE: EccentricDrive = EccentricDrive { pwm: Pwm::CONTINUOUS };

    fn evaluate(x: [f64; 2], duty: f64, force: f64) -> (State<f64>, Output<f64>) {
        let p = parameters();
        DRIVE.equations(Instant {
            time: 0.0,
            state: &Bundle::from_fn(|i| x[i]),
            input: &Input { duty, tire: Load { force } },
            parameters: &p,
            derived: &DRIVE.derive(&p),
            memory: &NoVariables,
            tick: 0,
        })
    }

    #[test]
    fn the_heights_are_those_of_equation_15() {
        for (angle, height) in [(0.0, 0.04), (PI / 2.0, 0.0425), (PI, 0.045), (TAU, 0.04)] {
            assert!((evaluate([angle, 1.0], 0.0, 0.0).1.height - height).abs() < 1e-15);
        }
    }

    #[test]
    fn figure_14_is_within_reach() {
        let derived = DRIVE.derive(&parameters());
        // 6.5 Hz and the largest load against it.
        let duty = 6.5 * TAU / derived.no_load_speed + (0.65 + 0.1) / derived.stall_torque;
        assert!(duty < 0.8, "{duty}");
        assert!((derived.time_constant - 0.032).abs() < 1e-3, "{derived:?}");
    }

    #[test]
    fn it_rests_at_its_lowest_position_under_load() {
        let (rates, output) = evaluate([0.0, 0.0], 0.0, 261.0);
        assert_eq!((rates.speed, output.velocity, output.load.torque), (0.0, 0.0, 0.0));
        // Off it, the load leads back; at the top it leads away.
        assert!(evaluate([0.1, 0.0], 0.0, 261.0).0.speed < 0.0);
        assert!(evaluate([PI + 0.1, 0.0], 0.0, 261.0).0.speed > 0.0);
    }

    #[test]
    fn an_axis_outside_the_wheel_is_refused() {
        let mut p = parameters();
        p.eccentric.eccentricity = 0.05;
        let error = DRIVE.check(&p, &DRIVE.derive(&p)).unwrap_err();
        assert!(error.contains("eccentric.eccentricity = 0.05 m"), "{error}");
        assert_eq!(DRIVE.check(&parameters(), &DRIVE.derive(&parameters())), Ok(()));
    }

    proptest! {
        #[test]
        fn the_velocity_is_the_rate_of_the_height(angle in -10.0..10.0_f64, speed in -50.0..50.0_f64) {
            let h = 1e-6;
            let height = |t: f64| evaluate([angle + speed * t, speed], 0.0, 0.0).1.height;
            let rate = (height(h) - height(-h)) / (2.0 * h);
            prop_assert!((evaluate([angle, speed], 0.0, 0.0).1.velocity - rate).abs() < 1e-8);
        }

        #[test]
        fn what_the_supply_gives_goes_into_heat_motion_and_the_tyre(
            angle in -10.0..10.0_f64,
            speed in -50.0..50.0_f64,
            duty in -1.0..1.0_f64,
            force in -200.0..600.0_f64,
        ) {
            let p = parameters();
            let (rates, output) = evaluate([angle, speed], duty, force);
            let heat = p.motor.resistance * output.current.powi(2) + 0.1 * (speed / p.eccentric.coulomb.speed).tanh() * speed;
            let motion = DRIVE.derive(&p).inertia * rates.speed * speed;
            let tire = force * output.velocity;
            prop_assert!((output.supply.power - heat - motion - tire).abs() < 1e-9 * (1.0 + heat));
        }
    }
}
